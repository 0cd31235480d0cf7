"""The study of Katsamakas and Vassiliou in both readings of a step: 115 motions x 3 time steps x 5
alphas, with the step as it is asked for and with rims followed in parts of it.

    ./containers/run python -m benchmarks.substeps.paper [-o DIR] [-j N] [--motions N]
        [--literal | --parts]

Three tables, a line for each reading and step: how many overturn, by alpha; D of two steps, its p
(steps swapped within motions) and McNemar's p, by alpha; and of all pairs of alphas the largest D,
its p, and the least p of McNemar. No p is corrected for the number of pairs. Resumed where it was
stopped.
"""

from __future__ import annotations

import argparse
import itertools
import os
from pathlib import Path

from benchmarks.beside import compared, markdown, told
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.conclusion import settings_of
from fecolumn.study.plan import read_plan
from fecolumn.study.run import complete_study

READINGS = {"literal": "paper_study", "rim in parts": "paper_parts"}
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
    """The three tables, of the settings that are done: summaries by motion, by reading, step and
    alpha.
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
                widest = max(pairs)
                flips = min(one[4] for one in pairs)
                cells = str(len(pairs)), f"{widest[0]:.2f}", told(widest[1]), told(flips)
                alphas.append((f"{name}, {dt:g} s", *cells))
    heads = [f"alpha {alpha:g}" for alpha in ALPHAS]
    of_alphas = ("reading and step", "pairs of alphas", "largest D", "p of it", "least McNemar p")
    return "\n\n".join(
        [
            markdown(("reading and step", *heads), counts),
            markdown(("D; p; McNemar p", *heads), steps),
            markdown(of_alphas, alphas),
        ]
    )


def main(given=None) -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.substeps.paper", description=__doc__.split("\n")[0]
    )
    parser.add_argument("-o", "--output", metavar="DIR", default="results/paper")
    parser.add_argument("-j", "--jobs", metavar="N", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--motions", metavar="N", type=int, default=115, help="the first of them")
    only = parser.add_mutually_exclusive_group()
    only.add_argument("--literal", action="store_true", help="the step as it is asked for alone")
    only.add_argument("--parts", action="store_true", help="rims followed in parts of it alone")
    args = parser.parse_args(given)
    found = {}
    for name, file in READINGS.items():
        if args.literal and name != "literal" or args.parts and name == "literal":
            continue
        plan = read_plan(Path(__file__).parents[1] / f"{file}.toml")
        first = {f"lick:{number}" for number in range(1, args.motions + 1)}
        only = {one.id for one in plan.analyses if one.values["motion.source"] in first}
        folder = Path(args.output) / file
        rows = complete_study(plan, folder, workers=args.jobs, retry_failed=True, only=only)
        for values, runs in settings_of(plan, rows):
            key = name, values["integration.dt_s"], values["integration.alpha_hht"]
            found[key] = runs
    print(tables(found))


if __name__ == "__main__":
    main()
