"""What the study driver itself costs: many analyses that take almost no time.

    ./containers/run python -m benchmarks.driver [-n 100000] [-j 2] [-s SECONDS]

An analysis only writes its summary.json, or first sleeps for `-s` seconds. Prints analyses a
second, peak memory of the driver process at the start, in the middle and at the end, and the share
of time the workers were busy.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import tempfile
import time
from pathlib import Path

_ENTRY = "benchmarks.driver:run"
_ALPHAS = [0, -0.05, -0.1, -0.2, -0.3]


def run(case, folder, *, comm, file, quiet) -> dict:
    """An analysis of no content."""
    if pause := float(os.environ.get("DRIVER_BENCHMARK_SLEEP_S", 0)):
        time.sleep(pause)
    summary = {
        "case_id": folder.name,
        "version": "0",
        "u_max_m": 0.01,
        "overturned": False,
        "residual_slide_m": 0.0,
        "steps": 1,
        "wall_s": 1e-4,
        "s_per_step": 1e-4,
        "energy_closure_rel": 0.0,
    }
    partial = folder / "summary.json.partial"
    partial.write_text(json.dumps(summary))  # without waiting for the disk
    os.replace(partial, folder / "summary.json")
    return summary


class Watch:
    """A log that notes, whenever the driver writes a line into it, the time and the driver's
    memory.
    """

    def __init__(self):
        self.notes: list[tuple[float, float, str]] = []

    def isatty(self) -> bool:
        return True  # a line a second

    def write(self, line: str) -> None:
        self.notes.append((time.monotonic(), resident_mb(), line.strip()))

    def flush(self) -> None:
        pass


def resident_mb() -> float:
    """Memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def write_study(file: Path, analyses: int) -> None:
    """Study file of so many analyses, of the reference specimen under motions that are only
    named.
    """
    specimen = Path(__file__).parents[1] / "meshes" / "stout.toml"
    sources = json.dumps([f"none:{number}" for number in range(analyses // len(_ALPHAS))])
    file.write_text(
        f'case = "{specimen}"\n[axes]\n"integration.alpha_hht" = '
        f'{_ALPHAS}\n"motion.source" = {sources}\n'
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-n", type=int, default=100_000, help="analyses (default: %(default)s)")
    parser.add_argument("-j", type=int, default=2, help="workers (default: %(default)s)")
    parser.add_argument(
        "-s", type=float, default=0.0, help="seconds an analysis sleeps (default: %(default)s)"
    )
    args = parser.parse_args()
    from fecolumn.study.plan import read_plan
    from fecolumn.study.pool import LocalPool
    from fecolumn.study.run import drive
    from fecolumn.study.store import Store

    os.environ["DRIVER_BENCHMARK_SLEEP_S"] = str(args.s)
    folder, watch = Path(tempfile.mkdtemp(prefix="driver-benchmark-")), Watch()
    try:
        write_study(folder / "study.toml", args.n)
        began = time.monotonic()
        plan = read_plan(folder / "study.toml")
        planned = time.monotonic()
        before, cpu = resident_mb(), time.process_time()
        with Store(folder / "out", plan, _ENTRY) as store:
            progress = drive(store, LocalPool(args.j, _ENTRY, plan.file), watch)
        ended, cpu = time.monotonic(), time.process_time() - cpu
        first, last = watch.notes[0], watch.notes[-1]
        middle = watch.notes[len(watch.notes) // 2]
        n = len(plan.analyses)
        print(f"planned     {n} analyses in {planned - began:.1f} s")
        print(
            f"done        {progress.done} in {ended - planned:.1f} s, of them "
            f"{first[0] - planned:.1f} s to open the ledger; failed {progress.failed}"
        )
        print(
            f"rate        {n / (last[0] - first[0]):.0f} a second with {args.j} "
            f"workers; driver alone {n / cpu:.0f} a second of its own CPU time"
        )
        print(
            f"memory [MB] {before:.0f} planned, {first[1]:.0f} at the start, "
            f"{middle[1]:.0f} in the middle, {last[1]:.0f} at the end"
        )
        print(
            f"workers     {100 * progress.busy(last[0] - first[0]):.0f} % busy, start "
            "of the processes included"
        )
        again = time.monotonic()
        with Store(folder / "out", plan, _ENTRY) as store:
            assert not store.missing()
        print(f"again       nothing left to do, found in {time.monotonic() - again:.1f} s")
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
