"""Models of one column beside each other, on the same 115 motions: the study models_beside.toml.

    ./containers/run python -m benchmarks.models [--own-mesh] [--full] [--motions N] [-o DIR] [-j N]
        [--report] [--keep]

Prints the table and draws one figure with all distributions, models.png and .pdf in DIR/beside or
DIR/own_mesh. D, p, McNemar's p and the same outcome are to full order where it is there, else to
the reduced engine, on the motions that both have. --full: the full order, too, motion after motion
when the others are done; hours. --own-mesh: the specimen's own mesh instead of a coarse one,
models_own_mesh.toml; its full order takes some ten hours of one core.

The same command goes on where it was stopped. What benchmarks/tables/models holds is not computed
again; --keep writes what is done there, --report computes nothing.
"""

from __future__ import annotations

import argparse
import signal
import sys
from pathlib import Path

import numpy as np

from benchmarks.beside import SHARE_HEAD, cost, markdown, pair_cells, share_cells
from benchmarks.tables.study_rows import OUTCOME, worked_off
from fecolumn.engines.ending import lost
from fecolumn.foundation.cores import usable_cores
from fecolumn.foundation.toml_file import read_toml
from fecolumn.pictures.figures.cdf_figure import CdfPanel, cdf_figure
from fecolumn.statistics.ecdf import ecdf
from fecolumn.study.conclusion import settings_of
from fecolumn.study.plan import Plan, plan_of

#: Study by its name in benchmarks/tables/models
STUDIES = {name: Path(__file__).with_name(f"models_{name}.toml") for name in ("beside", "own_mesh")}
#: Of a summary, what is kept
KEPT = *OUTCOME, "cpu_s"
ENGINE = "integration.engine"
LABELS = dict(
    housner="planar block",
    wobbling="rolling column",
    rigid="rigid body with contact",
    reduced="finite elements",
    full="finite elements, full order",
)
HEAD = (
    "engine",
    *SHARE_HEAD,
    "D",
    "p",
    "overturn in it alone",
    "in the other alone",
    "McNemar p",
    "same outcome [%]",
    "CPU of a motion [s]",
)


def plan(study: str, full: bool) -> Plan:
    """The study, or that of full order on the same motions."""
    tables = read_toml(STUDIES[study])
    if full:
        tables["axes"][ENGINE] = ["full"]
    return plan_of(tables, STUDIES[study])


def line(engine: str, runs: dict, reference: dict) -> tuple[str, ...]:
    """A row of the table: summaries by motion, of an engine and of what it is set beside."""
    beside = ("-",) * 6
    if runs is not reference:
        common = [motion for motion in runs if motion in reference]
        same = [runs[one]["overturned"] == reference[one]["overturned"] for one in common]
        share = f"{100 * np.mean(same):.0f}" if same else "-"
        beside = (*pair_cells(runs, reference), share)
    return (
        f"{LABELS[engine]} ({engine})",
        *share_cells(runs),
        *beside,
        cost(runs.values()),
    )


def table(found: dict[str, dict]) -> str:
    """Of summaries by motion by engine."""
    reference = found.get("full") or found["reduced"]
    return markdown(HEAD, [line(engine, runs, reference) for engine, runs in found.items()])


def main(given=None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.models", description=__doc__.split("\n")[0]
    )
    parser.add_argument("-o", "--output", metavar="DIR", default="results/models")
    parser.add_argument("-j", "--jobs", metavar="N", type=int, default=usable_cores())
    parser.add_argument("--motions", metavar="N", type=int, default=115, help="the first of them")
    parser.add_argument("--own-mesh", action="store_true", help="not a coarse one")
    parser.add_argument("--full", action="store_true", help="the full order, too: hours")
    parser.add_argument("--report", action="store_true")
    parser.add_argument("--keep", action="store_true")
    args = parser.parse_args(given)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    study, found, code = "own_mesh" if args.own_mesh else "beside", {}, 0
    output = Path(args.output) / study
    command = f"python -m benchmarks.models{' --own-mesh' * args.own_mesh} --full --keep"
    for full in (False, True)[: 1 + args.full]:
        whole, folder = plan(study, full), output / ("full" if full else "others")
        rows, code = worked_off(f"models/{study}", whole, folder, args, command, KEPT)
        found |= {values[ENGINE]: runs for values, runs in settings_of(whole, rows)}
        if code:
            break
    if "full" not in found and "reduced" not in found:
        print("neither full order nor the reduced engine has done an analysis yet")
        return code
    print(table(found))
    lines = [
        (
            f"{LABELS[engine]}, n = {len(runs)}",
            ecdf([run["u_max_m"] for run in runs.values()], [lost(run) for run in runs.values()]),
        )
        for engine, runs in found.items()
    ]
    panel = CdfPanel(f"one column under the same motions, {len(found)} models", tuple(lines))
    for file in cdf_figure([panel], output / "models"):
        print(f"wrote {file}")
    return code


if __name__ == "__main__":
    sys.exit(main())
