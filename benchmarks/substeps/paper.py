"""The study of Katsamakas and Vassiliou in both readings of a step: 115 motions x 3 time steps x 5
alphas, with the step as it is asked for and with rims followed in parts of it.

    ./containers/run python -m benchmarks.substeps.paper [-o DIR] [-j N] [--motions N]
        [--fixed | --rolling] [--report] [--keep]

Four tables. A line for each reading and step: how many overturn, by alpha; D of two steps, its p
(steps swapped within motions) and McNemar's p, by alpha; and of all pairs of alphas the largest D,
its p, the least p of any D, and the least p of McNemar. No p of these is corrected for the number
of pairs. A line for each claim of the paper: whether each reading supports it, judged as
`fecolumn report` judges, with p corrected.

The same command goes on where it was stopped. What benchmarks/tables/paper holds is not computed
again; --keep writes what is done there, --report computes nothing.
"""

from __future__ import annotations

import argparse
import itertools
import signal
import sys
from pathlib import Path

from benchmarks.beside import compared, markdown, told
from benchmarks.tables.study_rows import OUTCOME, worked_off
from fecolumn.foundation.cores import usable_cores
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.conclusion import settings_of
from fecolumn.study.plan import Plan, read_plan
from fecolumn.study.report.claim import Claim
from fecolumn.study.report.page import claims_of
from fecolumn.study.report.pair import read_pairs
from fecolumn.study.report.sweep import Setting, Sweep

READINGS = {"fixed step": "paper_study", "rolling substeps": "paper_parts"}
_OPTION = {"fixed step": "fixed", "rolling substeps": "rolling"}
_COMMAND = "python -m benchmarks.substeps.paper"
#: Of a summary, what is kept: its outcome, and what tells the cost
KEPT = *OUTCOME, "steps", "duration_s", "s_per_step", "iterations", "contact_iterations"
STEPS, ALPHAS = (0.02, 1e-3, 1e-4), (0, -0.05, -0.1, -0.2, -0.333)


def overturned(runs: dict) -> str:
    """Number, and share with its 95 % interval."""
    k, n = sum(bool(run["overturned"]) for run in runs.values()), len(runs)
    low, high = (100 * bound for bound in proportion_interval(k, n))
    return f"{k} of {n}; {100 * k / n:.1f} % ({low:.1f} to {high:.1f})"


def pair(first: dict, second: dict) -> str:
    """D, its p and McNemar's p."""
    distance, p, _, _, flips = compared(first, second)
    return f"{distance:.2f}; {told(p)}; {told(flips)}"


def tables(found: dict[tuple[str, float, float], dict]) -> str:
    """The first three tables, of the settings that are done.

    found: summaries by motion, by reading, step and alpha.
    """

    def line(name, cell, *steps):
        runs = [[found.get((name, dt, alpha)) for dt in steps] for alpha in ALPHAS]
        return [cell(*one) if all(one) else "" for one in runs]

    counts, steps, alphas = [], [], []
    for name in dict.fromkeys(reading for reading, _, _ in found):
        counts += [(f"{name}, {dt:g} s", *line(name, overturned, dt)) for dt in STEPS]
        steps += [
            (f"{name}, {one:g} and {other:g} s", *line(name, pair, one, other))
            for one, other in itertools.combinations(STEPS, 2)
        ]
        for dt in STEPS:
            there = [found[name, dt, alpha] for alpha in ALPHAS if (name, dt, alpha) in found]
            pairs = [compared(*two) for two in itertools.combinations(there, 2)]
            if pairs:
                widest, least = max(pairs), min(one[1] for one in pairs)
                flips = min(one[4] for one in pairs)
                cells = f"{widest[0]:.2f}", *map(told, (widest[1], least, flips))
                cells = str(len(pairs)), *cells
                alphas.append((f"{name}, {dt:g} s", *cells))
    heads = [f"alpha {alpha:g}" for alpha in ALPHAS]
    of_alphas = (
        "reading and step",
        "pairs of alphas",
        "largest D",
        "p of it",
        "least p",
        "least McNemar p",
    )
    return "\n\n".join(
        [
            markdown(("reading and step", *heads), counts),
            markdown(("D; p; McNemar p", *heads), steps),
            markdown(of_alphas, alphas),
        ]
    )


def claims(plan: Plan, rows: list[dict]) -> list[Claim]:
    """The claims of the paper put to a reading, as `fecolumn report` does."""
    settings = [Setting(values, len(runs), 0, runs) for values, runs in settings_of(plan, rows)]
    axes = {key: sorted({one.values[key] for one in settings}) for key in settings[0].values}
    limit = plan.case["overturn"]["displacement_m"]
    sweep = Sweep(Path(), plan.title, axes, tuple(settings), rows, len(rows), limit, plan.case)
    return claims_of(sweep, read_pairs(sweep))


def claims_table(found: dict[str, list[Claim]]) -> str:
    """A line for each claim of a reading."""
    head = "reading and claim", "of the paper", "here", "what was found"
    return markdown(
        head,
        [
            (f"{name}, {one.key}", one.paper, one.verdict, one.ours.replace("|", "/"))
            for name, claims in found.items()
            for one in claims
        ],
    )


def main(given=None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.substeps.paper", description=__doc__.split("\n")[0]
    )
    parser.add_argument("-o", "--output", metavar="DIR", default="results/paper")
    parser.add_argument("-j", "--jobs", metavar="N", type=int, default=usable_cores())
    parser.add_argument("--motions", metavar="N", type=int, default=115, help="the first of them")
    only = parser.add_mutually_exclusive_group()
    only.add_argument("--fixed", action="store_true", help="the step as it is asked for alone")
    only.add_argument("--rolling", action="store_true", help="substeps while the rim rolls alone")
    parser.add_argument("--report", action="store_true")
    parser.add_argument("--keep", action="store_true")
    args = parser.parse_args(given)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    found, judged, code = {}, {}, 0
    for name, file in READINGS.items():
        if args.fixed and name != "fixed step" or args.rolling and name == "fixed step":
            continue
        plan = read_plan(Path(__file__).parents[1] / f"{file}.toml")
        command, folder = f"{_COMMAND} --{_OPTION[name]} --keep", Path(args.output) / file
        rows, code = worked_off(f"paper/{file}", plan, folder, args, command, KEPT)
        for values, runs in settings_of(plan, rows):
            key = name, values["integration.dt_s"], values["integration.alpha_hht"]
            found[key] = runs
        if any(reading == name for reading, _, _ in found):
            judged[name] = claims(plan, rows)
        if code:
            break
    print(f"{tables(found)}\n\n{claims_table(judged)}" if found else "no analysis is done yet")
    return code


if __name__ == "__main__":
    sys.exit(main())
