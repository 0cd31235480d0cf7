"""Do the time step and alpha decide the distribution? Motions of the Lick ensemble, stage by stage,
until each pair of settings is told apart, or told alike within 0.1.

    ./containers/run python -m benchmarks.decided STUDY [-j N] [-o DIR] [--report] [--keep]

STUDY names a file of this folder, such as own_mesh. Prints the pairs that differ in one axis:
motions in both, verdict, how many overturn, D (the largest distance of their distributions), up to
where the data leave room for it, p of D, how many overturn in one setting alone, McNemar's p. No
p is corrected; the verdicts are, for pairs and looks (`fecolumn.study.sequential`). A second table
has the claims of Katsamakas and Vassiliou on peaks and distributions, put to all motions that are
done.

The same command goes on where it was stopped. What benchmarks/tables/decided holds is not computed
again; --keep writes what is done there, --report computes nothing and judges the stages that are
done.
"""

from __future__ import annotations

import argparse
import signal
import sys
from pathlib import Path
from typing import Any

from benchmarks.beside import markdown, pair_cells
from benchmarks.substeps.paper import claims, claims_table
from benchmarks.tables.study_rows import keep_rows, kept_rows
from fecolumn.cli import main as fecolumn
from fecolumn.foundation.cores import usable_cores
from fecolumn.study.conclusion import settings_of
from fecolumn.study.plan import Plan, read_plan
from fecolumn.study.run import StudyError, complete_study, stop_code
from fecolumn.study.sequential import Rule, Verdict, progress_text, until_decided
from fecolumn.study.store import DONE

HERE = Path(__file__).parent
STUDIES = sorted(file.stem for file in HERE.glob("*.toml"))
#: Motions of these studies, made unless they are there
MOTIONS = HERE.parents[1] / "results" / "lick1000.h5"
HEAD = (
    "settings",
    "motions",
    "verdict",
    "overturned at the first",
    "at the second",
    "D",
    "at most",
    "p",
    "at the first alone",
    "at the second alone",
    "McNemar p",
)


def table(plan: Plan, rows: list[dict[str, Any]], verdicts: list[Verdict], rule: Rule) -> str:
    """The pairs of settings, of the motions by which they are judged."""
    runs = {repr(values): found for values, found in settings_of(plan, rows)}
    lines = []
    for verdict in verdicts:
        pair = verdict.pair
        first, second = (runs[repr(values)] for values in pair.settings)
        common = [motion for motion in first if motion in second][: pair.n]
        sides = [{motion: one[motion] for motion in common} for one in (first, second)]
        distance, *rest = pair_cells(*sides)
        lines.append(
            (
                " and ".join(pair.names),
                pair.n,
                verdict.judged(rule),
                *(sum(run["overturned"] for run in side.values()) for side in sides),
                distance,
                f"{pair.bound:.3f}",
                *rest,
            )
        )
    return markdown(HEAD, lines)


def main(given=None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.decided",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("study", choices=STUDIES, metavar="STUDY", help=", ".join(STUDIES))
    parser.add_argument("-j", "--jobs", type=int, default=usable_cores(), metavar="N")
    parser.add_argument("-o", "--output", metavar="DIR", type=Path, default=Path("results/decided"))
    parser.add_argument(
        "--most", type=int, default=Rule().most, metavar="N", help="motions at most"
    )
    parser.add_argument("--report", action="store_true")
    parser.add_argument("--keep", action="store_true")
    args = parser.parse_args(given)
    if not MOTIONS.exists():
        MOTIONS.parent.mkdir(exist_ok=True)
        fecolumn(["motions", "make", "seeded", "-n", "1000", "-o", str(MOTIONS)])
    plan, rule = read_plan(HERE / f"{args.study}.toml"), Rule(most=args.most)
    rule.check("benchmarks.decided")
    kept, folder = kept_rows(f"decided/{args.study}", plan), args.output / args.study
    signal.signal(signal.SIGTERM, signal.default_int_handler)

    def work(only: set[str]) -> list[dict[str, Any]]:
        todo = only - kept.keys()
        if args.report:
            rows = complete_study(plan, folder, only=set())
            if todo - {row["id"] for row in rows if row["state"] == DONE}:
                raise _Unfinished
        else:
            rows = complete_study(plan, folder, workers=args.jobs, retry_failed=True, only=todo)
        return [kept.get(row["id"], row) for row in rows]

    code, verdicts = 0, []
    try:
        for motions, verdicts, _ in until_decided(plan, rule, work):
            print(progress_text(motions, verdicts), file=sys.stderr, flush=True)
    except _Unfinished:
        pass
    except (KeyboardInterrupt, StudyError) as error:
        code = stop_code(error)
    rows = [kept.get(row["id"], row) for row in complete_study(plan, folder, only=set())]
    if args.keep:
        command = f"python -m benchmarks.decided {args.study} --keep"
        keep_rows(f"decided/{args.study}", plan, rows, command)
    if verdicts:
        # what a run took is not kept: claims d1 and d2 are left out
        judged = [one for one in claims(plan, rows) if not one.key.startswith("d")]
        print(f"{table(plan, rows, verdicts, rule)}\n\n{claims_table({args.study: judged})}")
    else:
        print("no stage is done yet")
    return code


class _Unfinished(Exception):
    """A stage is not done, and nothing is to be computed."""


if __name__ == "__main__":
    sys.exit(main())
