"""python tests/recorded [CASE ...] [--check]: make the record of the cases anew, all or those
named; or say how far this code is off it.

Every case is run as it stands, on one thread of linear algebra; and three times on two threads, by
the kernels that OpenBLAS has for old processors, with bodies made anew, and with densities and
Young's moduli that differ by some 1e-14 of themselves. What these runs differ by from the first one
is what rounding errors make of it.
"""

from __future__ import annotations

import argparse
import os
import pickle
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path[:0] = [str(HERE.parents[1]), str(HERE.parent)]

import conftest  # noqa: E402, F401  bodies are made by the code under test, in a cache of their own
import numpy as np  # noqa: E402
import recording  # noqa: E402

from fecolumn.foundation.sources import PHYSICS  # noqa: E402


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python tests/recorded",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("case", nargs="*", help="names of cases, all unless given")
    parser.add_argument(
        "--check",
        action="store_true",
        help="write nothing, tell the largest difference of each case",
    )
    # file for the histories with other rounding errors
    parser.add_argument("--rounded", help=argparse.SUPPRESS)
    args = parser.parse_args()
    known = recording.cases()
    if unknown := [name for name in args.case if name not in known]:
        parser.error(f"no such case: {', '.join(unknown)}; known: {', '.join(known)}")
    chosen = {name: known[name] for name in args.case or known}
    if args.rounded:
        rows = {
            name: [recording.history(case, rounding) for rounding in recording.ROUNDINGS]
            for name, case in chosen.items()
        }
        Path(args.rounded).write_bytes(pickle.dumps(rows))
        return 0
    return check(chosen) if args.check else record(chosen, known)


def check(chosen: dict) -> int:
    """Tell how far this code is off the record; 1 where it is too far."""
    histories, _ = recording.read()
    far = 0
    for name, case in chosen.items():
        found = recording.differences(histories[name], recording.history(case))
        off = {column: values.max() for column, values in found.items()}
        worst = max(off, key=off.get)
        far += not off[worst] <= recording.TOLERANCE
        print(f"{off[worst]:8.1e} {worst:28s} {name}", flush=True)
    print(
        f"{len(chosen) - far} of {len(chosen)} cases are within {recording.TOLERANCE:.0e} of "
        "their peaks"
    )
    return int(far > 0)


def record(chosen: dict, known: dict) -> int:
    """Run the chosen cases as they are and with rounding errors, and write the record."""
    there = recording.RECORD.is_file() and recording.ABOUT.is_file()
    histories, about = recording.read() if there else ({}, {})
    with tempfile.TemporaryDirectory() as folder:
        file, ours, seconds = Path(folder) / "rounded", {}, {}
        command = [sys.executable, str(HERE), *chosen, "--rounded", str(file)]
        with subprocess.Popen(command, env=rounding_environment()) as other:  # beside this one
            for name, case in chosen.items():
                began = cpu()
                ours[name] = recording.history(case)
                seconds[name] = cpu() - began
        if other.returncode:
            raise SystemExit("the runs for rounding errors have failed: see above")
        rounded = pickle.loads(file.read_bytes())
    made_by = origin()
    moved = [
        name
        for name, rows in ours.items()
        if name in histories
        and recording.told(name, histories[name], rows, recording.tolerance_here(about[name]))
    ]
    for name, rows in ours.items():
        last = recording.third_impact(rows)
        histories[name], one = limited(name, recording.kept(rows, last), rounded[name])
        about[name] = one = one | {"ended_by": ended(one, last < len(rows["time"]))} | made_by
        print(
            f"{seconds[name]:6.2f} s {one['rows']:5d} rows to {one['end_s']:.3f} s, "
            f"{one['ended_by']}: {name}",
            flush=True,
        )
    # in the order of the cases; no others
    kept = {name: recording.thinned(histories[name]) for name in known if name in histories}
    recording.write(kept, about)
    size = recording.RECORD.stat().st_size
    print(f"{len(kept)} cases, {size / 1e3:.0f} kB in {recording.RECORD.name}")
    if moved:
        print(
            f"{len(moved)} cases move otherwise than before: {', '.join(moved)}. Count PHYSICS "
            f"({PHYSICS}) of fecolumn/foundation/sources.py up, once a version: what was measured "
            "so far is not of this code"
        )
    return 0


def limited(name: str, rows: dict, rounded: list[dict]) -> tuple[dict, dict]:
    """Rows until rounding errors of any run move them by BY_ROUNDING, and what is said of them."""
    each = [off for one in rounded for off in recording.differences(rows, one).values()]
    off = np.max(each, axis=0)
    moved = np.flatnonzero(~(off <= recording.BY_ROUNDING))
    n = int(moved[0]) if len(moved) else len(off)
    if n < recording.FEWEST:
        raise SystemExit(
            f"{name}: rounding errors alone move its history by {off.max():.0e} of "
            f"its peak, from step {n} on: record another case of this kind"
        )
    time = rows["time"]
    said = dict(
        rows=n,
        end_s=float(time[n - 1]),
        rounding=float(off[:n].max()),
        would_end_s=float(time[-1]),
        would_round=float(off.max()),
    )
    return {column: values[:n] for column, values in rows.items()}, said


def ended(one: dict, impacts: bool) -> str:
    """Why a history ends, in words."""
    if one["end_s"] < one["would_end_s"]:
        return f"rounding errors, which are {one['would_round']:.0e} at {one['would_end_s']:.3f} s"
    return "its third impact" if impacts else "its end"


def origin() -> dict:
    """Which code, processor and libraries make a record."""
    from fecolumn.foundation.sources import code

    command = ["git", "-C", str(HERE), "describe", "--always", "--abbrev=12", "--dirty"]
    commit = subprocess.run(command, capture_output=True, text=True).stdout.strip() or "unknown"
    return code() | {"commit": commit} | recording.here()


def rounding_environment() -> dict:
    """Environment of the runs for rounding errors: two threads, other kernels, a new cache."""
    own = {key: value for key, value in os.environ.items() if key != "FECOLUMN_CACHE"}
    return own | {"OMP_NUM_THREADS": "2", "OPENBLAS_CORETYPE": "Prescott"}


def cpu() -> float:
    """Processor time of this process and of those that it waited for [s]."""
    who = resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN
    return sum(sum(resource.getrusage(one)[:2]) for one in who)


if __name__ == "__main__":
    sys.exit(main())
