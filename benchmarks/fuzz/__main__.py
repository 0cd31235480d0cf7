"""Damaged cases, studies, motions, ensembles and study folders: each must be used, or refused in
one line.

python -m benchmarks.fuzz                            # 2,000 mutants, a table
python -m benchmarks.fuzz -n 20000 --seed 7          # others
python -m benchmarks.fuzz --subject motions --only 17  # one, its traceback shown
"""

from __future__ import annotations

import argparse
import collections
import sys
import time

from benchmarks.fuzz import SUBJECTS
from benchmarks.fuzz.watch import BAD, VERDICTS, watched


def main(argv=None) -> int:
    """Print the table; 0 where no mutant led to a traceback, a hang or a death, else 1."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.fuzz", description=__doc__.splitlines()[0]
    )
    parser.add_argument(
        "-n", type=int, default=2000, help="number of mutants (default: %(default)s)"
    )
    parser.add_argument(
        "--seed", type=int, default=1, help="of the random numbers (default: %(default)s)"
    )
    parser.add_argument(
        "--subject", choices=SUBJECTS, action="append", help="one of %(choices)s (default: each)"
    )
    parser.add_argument("--only", type=int, metavar="I", help="this mutant alone")
    args = parser.parse_args(argv)
    subjects, began, worst = args.subject or SUBJECTS, time.perf_counter(), []
    print(
        f"{'subject':<12}"
        + "".join(f"{verdict:>12}" for verdict in VERDICTS)
        + f"{'slowest [s]':>14}"
    )
    for place, subject in enumerate(subjects):
        count = args.n // len(subjects) + (place < args.n % len(subjects))
        numbers = [args.only] if args.only is not None else list(range(count))
        ends = list(watched(subject, numbers, args.seed))
        tally = collections.Counter(end.verdict for end in ends)
        print(
            f"{subject:<12}"
            + "".join(f"{tally[verdict]:>12}" for verdict in VERDICTS)
            + f"{max(end.wall_s for end in ends):>14.2f}",
            flush=True,
        )
        worst += [end for end in ends if end.verdict in BAD or args.only is not None]
    for end in worst:
        print(
            f"\n--subject {end.subject} --seed {args.seed} --only {end.number}: "
            f"{end.verdict}\n{end.told}"
        )
    print(f"{time.perf_counter() - began:.0f} s")
    return 1 if any(end.verdict in BAD for end in worst) else 0


if __name__ == "__main__":
    sys.exit(main())
