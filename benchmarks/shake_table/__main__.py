"""Which of 582 shake-table tests of a free-standing granite rock overturn it: a rigid body from its
scan against what was seen.

    ./containers/run python -m benchmarks.shake_table PATH [-o DIR] [-j N] [--dt S] [--tests
        11-135,600] [--mu 0.6] ...

PATH: a copy of the public repository ZhiangChen/virtual_shake_robot_pybullet, of which only data/
is read. No parameter is fitted to an outcome. What is done is kept: the same command goes on.
Writes tests.csv, outcomes.png and .pdf into DIR and prints accuracy and confusion beside the models
whose results the repository holds.

    ./containers/run python -m benchmarks.shake_table PATH --draws 32 -o results/shake_table_draws

computes each test with so many draws of what is not known of rock and table (`uncertain`), and
prints how well the probability of each outcome is told: Brier's score and a reliability diagram,
reliability.png, in place of outcomes.png; tests.csv has the probabilities.
"""

from __future__ import annotations

import argparse
import dataclasses
import sys
from pathlib import Path

import numpy as np

from benchmarks.kept import complete, found, keep_settings
from benchmarks.shake_table.campaign import Campaign, read_campaign
from benchmarks.shake_table.figure import draw, draw_reliability
from benchmarks.shake_table.probability import ensemble_report, reliability, told_by
from benchmarks.shake_table.rock import Stone
from benchmarks.shake_table.runs import COLUMNS, folder_name, run
from benchmarks.shake_table.scores import chance, confusion, table
from benchmarks.shake_table.uncertain import SEED, Setting, settings
from fecolumn.foundation.atomic import write_csv
from fecolumn.foundation.cores import usable_cores


def chosen(text: str | None, numbers: list[int]) -> set[int]:
    """Numbers of `numbers` that a list such as "11-135,600" names; all where there is none.

    Raises
    ------
    ValueError
        not such a list, or it names none of them.
    """
    if text is None:
        return set(numbers)
    wanted = set()
    for part in text.split(","):
        first, _, last = part.partition("-")
        try:
            wanted |= set(range(int(first), int(last or first) + 1))
        except ValueError:
            raise ValueError(
                f"--tests: '{part}' is no number and no range such as 11-135"
            ) from None
    if not wanted & set(numbers):
        raise ValueError(
            f"--tests {text}: none of them has a motion here; there are {len(numbers)} "
            f"from {min(numbers)} to {max(numbers)}"
        )
    return wanted & set(numbers)


def compute_draws(
    campaign: Campaign, numbers: set[int], draws: list[Setting], args
) -> dict[int, list[dict]]:
    """Rows of the tests of these numbers by draw; what the folder does not hold is computed unless
    only a report is asked for.
    """
    folder, tests = Path(args.output), [one for one in campaign.tests if one.number in numbers]
    jobs = {
        folder / folder_name(test, draw): (campaign, test, one.stone, args.dt, one.view)
        for draw, one in enumerate(draws)
        for test in tests
    }
    if not args.report:
        complete(run, jobs, args.jobs, "tests")
    return {
        draw: found(folder / folder_name(test, draw) for test in tests)
        for draw in range(len(draws))
    }


def main(arguments=None) -> None:
    stone = Stone(mass=353.802)
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.shake_table", description=__doc__.split("\n")[0]
    )
    parser.add_argument(
        "path", metavar="PATH", help="a copy of ZhiangChen/virtual_shake_robot_pybullet"
    )
    parser.add_argument("-o", "--output", metavar="DIR", default="results/shake_table")
    parser.add_argument(
        "-j",
        "--jobs",
        type=int,
        default=usable_cores(),
        help="tests at a time (default: %(default)s)",
    )
    parser.add_argument("--tests", metavar="LIST", help="only these, such as 11-135,600")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="only each N-th of them")
    parser.add_argument("--report", action="store_true", help="compute nothing, judge what is done")
    parser.add_argument(
        "--dt", type=float, default=1e-3, help="time step [s] (default: %(default)s)"
    )
    parser.add_argument(
        "--mu",
        type=float,
        default=stone.friction,
        help="coefficient of friction (default: %(default)s)",
    )
    parser.add_argument(
        "--mass",
        type=float,
        default=stone.mass,
        help="[kg] (default: %(default)s, which the repository states); nan: 2700 kg/m3 "
        "times the volume",
    )
    parser.add_argument(
        "--youngs",
        type=float,
        default=stone.youngs,
        help="modulus of the stone at its contact points [Pa] (default: %(default)g)",
    )
    parser.add_argument(
        "--softer",
        type=float,
        default=stone.softer,
        help="factor on the compliance of each contact point (default: %(default)s)",
    )
    parser.add_argument(
        "--restitution",
        type=float,
        default=stone.restitution,
        help="of a contact point, 0 to 1 (default: %(default)s)",
    )
    parser.add_argument(
        "--direction",
        type=float,
        default=0.0,
        help="of the table's positive displacement, from the scan's x to its y [deg] "
        "(default: %(default)s)",
    )
    parser.add_argument(
        "--draws",
        type=int,
        default=0,
        metavar="N",
        help="an ensemble of so many draws within the bounds of benchmarks/shake_table/"
        "uncertain.py; --mu, --youngs, --softer and --restitution do not matter then",
    )
    args = parser.parse_args(arguments)
    try:
        stone = Stone(
            mass=args.mass,
            youngs=args.youngs,
            softer=args.softer,
            friction=args.mu,
            restitution=args.restitution,
            direction=float(np.radians(args.direction)),
        )
        campaign, folder = read_campaign(args.path), Path(args.output)
        numbers = sorted(
            chosen(
                args.tests, sorted({test.number for test in campaign.tests} - set(campaign.missing))
            )
        )[:: max(args.every, 1)]
        keep_settings(
            folder,
            {
                "dt": args.dt,
                **({"draws": args.draws, "seed": SEED} if args.draws else {}),
                **{name: str(value) for name, value in dataclasses.asdict(stone).items()},
            },
        )
        if campaign.missing:
            print(
                f"{len(campaign.missing)} of {len(campaign.tests)} tests have no file "
                "of their motion and are left out",
                file=sys.stderr,
            )
        if args.draws:
            draws = compute_draws(campaign, set(numbers), settings(stone, args.draws, SEED), args)
        else:
            jobs = {
                folder / folder_name(test): (campaign, test, stone, args.dt)
                for test in campaign.tests
                if test.number in numbers
            }
            if not args.report:
                complete(run, jobs, args.jobs, "tests")
            rows = found(jobs)
    except (OSError, ValueError) as error:
        sys.exit(f"error: {error}")
    if args.draws:
        probabilities(campaign, draws, folder)
        return
    write_csv(folder / "tests.csv", [COLUMNS, *([row[name] for name in COLUMNS] for row in rows)])
    report(campaign, rows, folder)


def models_of(campaign: Campaign, numbers: list[int]) -> dict[str, list]:
    """What each model of the campaign's authors says of the tests of these numbers."""
    tests = {test.number: test for test in campaign.tests}
    return {
        f"discrete elements, {name}": [tests[number].computed[name] for number in numbers]
        for name in campaign.tests[0].computed
    }


def probabilities(campaign: Campaign, draws: dict[int, list[dict]], folder: Path) -> None:
    """Print how well the ensemble tells probabilities, write them and draw their diagram."""
    told = told_by(draws)
    if not told:
        sys.exit("error: no test was computed")
    write_csv(
        folder / "tests.csv",
        [list(told[0]), *(list(row.values()) for row in told)],
    )
    print(ensemble_report(draws, told, models_of(campaign, [row["test"] for row in told])))
    measured, probability = (
        np.array([row[name] for row in told], float) for name in ("measured", "probability")
    )
    draw_reliability(reliability(measured == 1, probability), folder / "reliability")
    print(f"wrote {folder}")


def report(campaign: Campaign, rows: list[dict], folder: Path) -> None:
    """Print the scores of the tests that were computed, draw the figure."""
    told = [row for row in rows if row["failed"] == ""]
    if len(told) < len(rows):
        print(
            f"{len(rows) - len(told)} of {len(rows)} tests failed and are left out: "
            f"{', '.join(str(row['test']) for row in rows if row['failed'])}",
            file=sys.stderr,
        )
    if not told:
        sys.exit("error: no test was computed")
    measured, ours = ([row[name] == 1 for row in told] for name in ("measured", "computed"))
    models = models_of(campaign, [row["test"] for row in told])
    print(f"{len(told)} tests\n")
    print(
        table(
            {
                "fecolumn": confusion(measured, ours),
                **{name: confusion(measured, those) for name, those in models.items()},
            }
        )
    )
    if models:
        best = max(models, key=lambda name: confusion(measured, models[name]).accuracy)
        print(
            f"\nfecolumn and {best}, the best of those, tell right equally often: p = "
            f"{chance(measured, ours, models[best]):.3g}"
        )
    print(
        "largest error of the energy balance over the kinetic energy: "
        f"{max(row['closure_rel'] for row in told):.2g}"
    )
    draw(told, folder / "outcomes")
    print(f"wrote {folder}")


if __name__ == "__main__":
    main()
