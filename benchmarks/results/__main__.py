"""Make benchmarks/RESULTS.md.

    python -m benchmarks.results [--check]

It is text.md with the tables of benchmarks/tables in their places. --check writes nothing and ends
with 1 where the file differs.
"""

from __future__ import annotations

import argparse
import sys

from benchmarks.results import RESULTS, results


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.results", description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing, compare")
    if not parser.parse_args().check:
        RESULTS.write_text(results(), encoding="utf-8")
    elif RESULTS.read_text(encoding="utf-8") != results():
        print(f"{RESULTS} is not what the tables give: python -m benchmarks.results makes it")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
