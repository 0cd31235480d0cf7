"""Models of one column beside each other, on the same 115 motions: the study models_beside.toml.

    ./containers/run python -m benchmarks.models [--full] [--motions N] [-o DIR] [-j N]

Prints the table and draws one figure with all distributions, models.png and .pdf in DIR. D, p,
McNemar's p and the same outcome are to full order where it is there, else to the reduced engine, on
the motions that both have. --full: the full order, too, motion after motion when the others are
done; hours, and what is done is kept.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import numpy as np

from benchmarks.beside import SHARE_HEAD, cost, markdown, pair_cells, share_cells
from fecolumn.engines.ending import lost
from fecolumn.foundation.toml_file import read_toml
from fecolumn.pictures.figures.cdf_figure import CdfPanel, cdf_figure
from fecolumn.statistics.ecdf import ecdf
from fecolumn.study.conclusion import settings_of
from fecolumn.study.plan import Plan, plan_of
from fecolumn.study.run import complete_study

STUDY = Path(__file__).with_name("models_beside.toml")
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


def plan(full: bool) -> Plan:
    """The study, or that of full order on the same motions."""
    tables = read_toml(STUDY)
    if full:
        tables["axes"][ENGINE] = ["full"]
    return plan_of(tables, STUDY)


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


def main(given=None) -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.models", description=__doc__.split("\n")[0]
    )
    parser.add_argument("-o", "--output", metavar="DIR", default="results/models")
    parser.add_argument("-j", "--jobs", metavar="N", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--motions", metavar="N", type=int, default=115, help="the first of them")
    parser.add_argument("--full", action="store_true", help="the full order, too: hours")
    args = parser.parse_args(given)
    first, found = {f"lick:{number}" for number in range(1, args.motions + 1)}, {}
    for full in (False, True)[: 1 + args.full]:
        whole = plan(full)
        only = {one.id for one in whole.analyses if one.values["motion.source"] in first}
        folder = Path(args.output) / ("full" if full else "others")
        rows = complete_study(whole, folder, workers=args.jobs, retry_failed=True, only=only)
        found |= {values[ENGINE]: runs for values, runs in settings_of(whole, rows)}
    print(table(found))
    lines = [
        (
            f"{LABELS[engine]}, n = {len(runs)}",
            ecdf([run["u_max_m"] for run in runs.values()], [lost(run) for run in runs.values()]),
        )
        for engine, runs in found.items()
    ]
    panel = CdfPanel(f"one column under the same motions, {len(found)} models", tuple(lines))
    for file in cdf_figure([panel], Path(args.output) / "models"):
        print(f"wrote {file}")


if __name__ == "__main__":
    main()
