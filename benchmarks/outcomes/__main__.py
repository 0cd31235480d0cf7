"""A hundred thousand outcomes in one table, which `fecolumn.outcomes()` reads.

    ./containers/run python -m benchmarks.outcomes [-n ANALYSES] [-j N] [-o DIR] [--keep]

Of the analyses 68 % are planar rocking blocks, 22 % rolling columns, 8 % rigid and 2 % elastic
bodies with contact and friction; motions are near-fault ones, the Lick ensemble at three time
scales and pulses. The same command goes on where it was stopped. Writes DIR/outcomes.h5; --keep
also puts it in the place of the table that comes with the package,
fecolumn/study/results/outcomes.h5. Prints what became of each model, the size of the file, and a
fragility surface fitted to it by statsmodels.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

import numpy as np

from benchmarks.kept import complete, found
from benchmarks.outcomes import bodies, models
from benchmarks.outcomes.motions import motions_file
from benchmarks.outcomes.table import write
from fecolumn.foundation.cores import usable_cores
from fecolumn.study.results.outcomes import PACKAGED, outcomes

#: Share of the analyses of each model; rows of a part, in a file of its own.
SHARES = {models.BLOCK: 0.68, models.ROLLING: 0.22, bodies.RIGID: 0.08, bodies.ELASTIC: 0.02}
PARTS = {models.BLOCK: (models.planar_blocks, 2000), models.ROLLING: (models.rolling_columns, 250)}
#: Near-fault motions, with half as many others; of fewer analyses a fortieth.
NEAR_FAULT = 2000


def main(arguments=None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.outcomes",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "-n", type=int, default=104_000, metavar="ANALYSES", help="(default: %(default)s)"
    )
    parser.add_argument("-j", "--jobs", type=int, default=usable_cores(), help="at a time")
    parser.add_argument(
        "-o", "--output", metavar="DIR", type=Path, default=Path("results/outcomes")
    )
    parser.add_argument("--keep", action="store_true", help="as the table of the package")
    args = parser.parse_args(arguments)
    if args.n < 100:
        parser.error(f"-n {args.n}: must be at least 100")
    folder = args.output / f"{args.n}"
    file = motions_file(folder, min(NEAR_FAULT, max(args.n // 40, 15)))
    rows = [row for model in SHARES for row in _rows(model, args, file, folder)]
    table = folder / "outcomes.h5"
    write(table, rows, f"python -m benchmarks.outcomes -n {args.n}")
    if args.keep:
        shutil.copyfile(table, PACKAGED)
    print(told(table))
    return 0


def _rows(model: str, args, file: Path, folder: Path) -> list[dict]:
    count = round(SHARES[model] * args.n)
    print(model, file=sys.stderr, flush=True)
    if model not in PARTS:
        return bodies.rows_of(model, count, file, folder, args.jobs)
    function, size = PARTS[model]
    jobs = {
        folder / model.replace(" ", "-") / f"{part:04d}-{min(size, count - first)}.json": (
            file,
            part,
            min(size, count - first),
        )
        for part, first in enumerate(range(0, count, size))
    }
    complete(function, jobs, args.jobs, "parts")
    return [row for rows in found(jobs) for row in rows]


def told(table: Path) -> str:
    """Counts of the outcomes by model, the size of the file, a fragility surface."""
    frame = outcomes(file=table)
    counts = frame.groupby(["model", "outcome"], observed=False).size().unstack()
    head = ["model", "analyses", *map(str, counts.columns)]
    lines = [head, ["---", *["---:"] * (len(head) - 1)]]
    lines += [[name, *map(str, (row.sum(), *row))] for name, row in counts.iterrows()]
    text = "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)
    size = f"{table}: {table.stat().st_size / 1e6:.2f} MB, {len(frame)} analyses"
    return f"{text}\n\n{size}\n\n{surface(frame)}"


def surface(frame) -> str:
    """Parameters of P(overturned) = Phi(c x) of rigid bodies, x the logarithms of PGV over p R, of
    the slenderness and of the friction, as a table.
    """
    from statsmodels.discrete.discrete_model import Probit
    from statsmodels.tools import add_constant

    rigid = frame[frame.model == bodies.RIGID]
    radius = np.hypot(rigid.width_m, rigid.height_m) / 2
    x = np.column_stack(
        [
            np.log(rigid.pgv_m_s / (rigid.p_rad_s * radius)),
            np.log(rigid.slenderness_rad),
            np.log(rigid.friction),
        ]
    )
    fit = Probit((rigid.outcome == "overturned").to_numpy(float), add_constant(x)).fit(disp=False)
    lines = ["| ln of | parameter | standard error |", "|---|---:|---:|"]
    for name, value, error in zip(
        ("1", "PGV / (p R)", "slenderness", "friction"), fit.params, fit.bse
    ):
        lines.append(f"| {name} | {value:.3f} | {error:.3f} |")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
