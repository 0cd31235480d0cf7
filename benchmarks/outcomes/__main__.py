"""A hundred thousand outcomes in one table, which `fecolumn.outcomes()` reads.

    ./containers/run python -m benchmarks.outcomes [-n ANALYSES] [-j N] [-o DIR] [--keep]

Of the analyses 50 % are rigid and 28 % elastic bodies with contact and friction, 14 % planar
rocking blocks and 8 % rolling columns; motions are near-fault ones, the Lick ensemble at three time
scales and pulses. The same command goes on where it was stopped. Writes DIR/outcomes.h5; --keep
also puts it in the place of the table that comes with the package,
fecolumn/study/results/outcomes.h5. Prints what became of each model, the size of the file, and
fragility surfaces fitted to it by statsmodels.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

import numpy as np

from benchmarks.beside import markdown
from benchmarks.kept import complete, found
from benchmarks.outcomes import bodies, models
from benchmarks.outcomes.draws import DENSITY
from benchmarks.outcomes.motions import motions_file
from benchmarks.outcomes.table import write
from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.cores import usable_cores
from fecolumn.study.results.outcomes import PACKAGED, outcomes

#: Share of the analyses of each model; rows of a part, in a file of its own.
SHARES = {models.BLOCK: 0.14, models.ROLLING: 0.08, bodies.RIGID: 0.5, bodies.ELASTIC: 0.28}
PARTS = {models.BLOCK: (models.planar_blocks, 2000), models.ROLLING: (models.rolling_columns, 250)}
# A surface is fitted to this many bodies and more: its parameters are up to five
_FEWEST_BODIES = 10
#: Near-fault motions, with half as many others; of fewer analyses a fortieth.
NEAR_FAULT = 2000


def main(arguments=None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.outcomes",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "-n", type=int, default=130_000, metavar="ANALYSES", help="(default: %(default)s)"
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
    """Counts of the outcomes by model, the size of the file, fragility surfaces."""
    frame = outcomes(file=table)
    counts = frame.groupby(["model", "outcome"], observed=False).size().unstack()
    head = ["model", "analyses", *map(str, counts.columns)]
    rows = [[str(name), *map(str, (row.sum(), *row))] for name, row in counts.iterrows()]
    size = f"{table}: {table.stat().st_size / 1e6:.2f} MB, {len(frame)} analyses"
    head_of_surface = ["of", "parameter", "standard error"]
    fitted = [
        [f"{kind}, {name}", *numbers]
        for kind in (bodies.RIGID, bodies.ELASTIC)
        if _alike(frame[frame.model == kind]).nunique() >= _FEWEST_BODIES
        for name, *numbers in surface(frame, kind)
    ]
    return f"{markdown(head, rows)}\n\n{size}\n\n{markdown(head_of_surface, fitted)}"


def surface(frame, kind: str) -> list[list[str]]:
    """Parameters of P(overturned) = Phi(c x), x the logarithms of PGV over p R, of the slenderness,
    of the friction and, of elastic bodies, of E B / (rho g H^2): [name, parameter, standard error].
    Analyses of one motion, or of one body, are not independent: errors are those of clusters.
    """
    from statsmodels.discrete.discrete_model import Probit
    from statsmodels.tools import add_constant

    some = frame[frame.model == kind]
    radius = np.hypot(some.width_m, some.height_m) / 2
    x = {
        "PGV / (p R)": some.pgv_m_s / (some.p_rad_s * radius),
        "slenderness": some.slenderness_rad,
        "friction": some.friction,
    }
    if kind == bodies.ELASTIC:
        weight = DENSITY * GRAVITY * some.height_m**2
        x["E B / (rho g H^2)"] = some.youngs_modulus_pa * some.width_m / weight
    given = add_constant(np.log(np.column_stack(list(x.values()))))
    alike = [some.motion, _alike(some)]
    fit = Probit((some.outcome == "overturned").to_numpy(float), given).fit(
        disp=False, cov_type="cluster", cov_kwds={"groups": np.column_stack(alike)}
    )
    return [
        [name, f"{value:.3f}", f"{error:.3f}"]
        for name, value, error in zip(
            ("constant", *(f"ln {one}" for one in x)), fit.params, fit.bse
        )
    ]


def _alike(some):
    """Which body each analysis is of."""
    return some.groupby(["shape", "width_m", "height_m"], observed=True).ngroup()


if __name__ == "__main__":
    sys.exit(main())
