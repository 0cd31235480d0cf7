"""Does the distribution depend on the step, on alpha, and on what a step is made in parts for? 115
motions on the reference specimen.

    ./containers/run python -m benchmarks.substeps [-o DIR] [-j N] [--finest]

Three tables: a line for each setting; pairs of settings; and, under the motion as it is sampled at
0.02 s, what a fixed step of 0.02 s errs by: its landing (impacts found in the step), its rolling
(the rim followed in parts), or both; J is what impacts, contact and friction take. Of a pair: D,
the largest distance of the CDFs of u_max; its p, settings swapped within motions; the motions that
overturn in one setting alone, and McNemar's p of as many either way. No p is corrected for the
number of pairs. Resumed where it was stopped.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.beside import pair_cells, share_cells
from fecolumn.engines.ending import lost
from fecolumn.foundation.cores import usable_cores
from fecolumn.study.conclusion import settings_of
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study


class Setting(NamedTuple):
    """The four values that tell the ensembles apart."""

    dt_s: float
    alpha: float
    substeps: str
    resample_s: float = 0.0

    def __str__(self):
        parts = {"none": "fixed step", "rolling": "rolling substeps", "impacts": "impact substeps"}[
            self.substeps
        ]
        return (
            f"{self.dt_s:g} s, alpha {self.alpha:g}, "
            f"{parts}{f', motion sampled at {self.resample_s:g} s' if self.resample_s else ''}"
        )


KEYS = "integration.dt_s", "integration.alpha_hht", "integration.substeps", "motion.resample_s"
FIXED, ROLLING, IMPACTS = (Setting(0.02, -0.2, word) for word in ("none", "rolling", "impacts"))
SAMPLED, FINE, FINE_ROLLING = (
    Setting(1e-3, -0.2, "none", 0.02),
    Setting(1e-3, -0.2, "none"),
    Setting(1e-3, -0.2, "rolling"),
)
FINEST, FINEST_ROLLING = Setting(1e-4, -0.2, "none"), Setting(1e-4, -0.2, "rolling")
UNDAMPED, FINE_UNDAMPED = FIXED._replace(alpha=0), FINE._replace(alpha=0)
PAIRS = (
    (FIXED, FINE),
    (UNDAMPED, FINE_UNDAMPED),
    (FIXED, UNDAMPED),
    (FINE, FINE_UNDAMPED),
    (ROLLING, FINE_ROLLING),
    (FIXED, ROLLING),
    (FIXED, IMPACTS),
    (IMPACTS, ROLLING),
    (FINE, FINE_ROLLING),
    (FINE, FINEST),
    (FINE_ROLLING, FINEST_ROLLING),
    (ROLLING, FINEST_ROLLING),
    (FIXED, FINEST),
)
CAUSES = FIXED, ROLLING, IMPACTS, SAMPLED


def line(setting: Setting, runs: dict) -> str:
    """Of the table of settings: overturned, P, median peak, and steps, parts and impacts a
    motion.
    """
    steps, parts, impacts = (
        np.mean([run[key] for run in runs.values()]) for key in ("steps", "parts", "impacts")
    )
    share = " | ".join(share_cells(runs))
    return f"| {setting} | {share} | {steps:.0f} | {parts:.0f} | {impacts:.0f} |"


def tables(found: dict[Setting, dict]) -> str:
    """The three tables, of the settings that are done."""
    text = [
        "| setting | motions | overturned | P [%] | 95 % interval [%] | median u_max [mm] | steps "
        "| parts | impacts |",
        "|---|---:|---:|---:|---|---:|---:|---:|---:|",
    ]
    text += [line(setting, runs) for setting, runs in found.items()]
    text += [
        "",
        "| pair | D | p | overturn in the first alone | in the second alone | McNemar p |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    text += [
        f"| {first}; {second} | {' | '.join(pair_cells(found[first], found[second]))} |"
        for first, second in PAIRS
        if first in found and second in found
    ]
    if SAMPLED in found:
        there = {setting: found[setting] for setting in CAUSES if setting in found}
        energy = taken(list(there.values()))
        text += [
            "",
            f"| against {SAMPLED} | overturned | D | p | overturn in it alone | in the other alone "
            "| McNemar p | impacts | taken [J] |",
            "|---|---:|---:|---:|---:|---:|---:|---:|---:|",
        ]
        for (setting, runs), joules in zip(there.items(), energy):
            over, impacts = (
                sum(bool(run["overturned"]) for run in runs.values()),
                np.mean([run["impacts"] for run in runs.values()]),
            )
            cells = pair_cells(runs, found[SAMPLED]) if setting != SAMPLED else ("-",) * 5
            cells = " | ".join((*cells, f"{impacts:.0f}", f"{joules:.3f}"))
            text.append(f"| {setting} | {over} | {cells} |")
    return "\n".join(text)


def taken(settings: list[dict]) -> list[float]:
    """Energy [J] that impacts, contact and friction take of a motion, in each setting: means of
    those motions that are lost in none; nan where there is none.
    """
    common = [
        motion
        for motion in settings[0]
        if all(motion in runs and not lost(runs[motion]) for runs in settings)
    ]
    return [
        -float(
            np.mean(
                [
                    sum(
                        runs[motion]["energy_j"][term] for term in ("impact", "contact", "friction")
                    )
                    for motion in common
                ]
            )
        )
        if common
        else np.nan
        for runs in settings
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", "--output", metavar="DIR", default="results/substeps")
    parser.add_argument(
        "-j",
        "--jobs",
        metavar="N",
        type=int,
        default=usable_cores(),
        help="analyses at a time (default: %(default)s)",
    )
    parser.add_argument("--finest", action="store_true", help="the steps of 1e-4 s, too")
    args = parser.parse_args()
    found = {}
    for name in ("coarse", "fine", *(["finest"] if args.finest else [])):
        plan = read_plan(Path(__file__).with_name(f"{name}.toml"))
        rows = complete_study(plan, Path(args.output) / name, workers=args.jobs, retry_failed=True)
        found |= {
            Setting(*(values[key] for key in KEYS)): runs
            for values, runs in settings_of(plan, rows)
        }
        print(tables(found), end="\n\n", flush=True)


if __name__ == "__main__":
    main()
