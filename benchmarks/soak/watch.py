"""The driver's keeper: starts it until it has done all, kills it or a worker now and then, and
looks at its memory.
"""

from __future__ import annotations

import contextlib
import csv
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.soak.analysis import memory_mb, open_files

NAME = "driver.csv"
_LOOK_S = 10.0


def keep_running(folder: Path, numbers: list[int], kill_s: float) -> int:
    """Have all done; exit code of a driver that ends otherwise than killed from here.

    Parameters
    ----------
    folder, numbers
        arguments of `benchmarks.soak.drive`; `driver.csv` in the folder gets the driver's memory
        and what was killed.
    kill_s
        mean time between kills [s], 0 for none.
    """
    draw = random.Random()
    command = [sys.executable, "-m", "benchmarks.soak.drive", str(folder), *map(str, numbers)]
    with open(folder / NAME, "a", newline="") as table, open(folder / "driver.log", "a") as log:
        note = _Notes(table)
        while True:
            driver = subprocess.Popen(command, stdout=log, stderr=log)
            try:
                slain = _attend(driver, kill_s, draw, note)
            except BaseException:
                driver.terminate()
                driver.wait()
                raise
            if not slain:
                return driver.returncode


def _attend(driver, kill_s: float, draw, note) -> bool:
    """Look after a driver to its end; whether it was killed from here."""
    next_kill = time.monotonic() + _interval(kill_s, draw)
    while True:
        with contextlib.suppress(subprocess.TimeoutExpired):
            driver.wait(_LOOK_S)
            return False
        with contextlib.suppress(OSError):
            note(driver.pid, "driver", memory_mb(driver.pid), open_files(driver.pid))
        if time.monotonic() < next_kill:
            continue
        next_kill = time.monotonic() + _interval(kill_s, draw)
        victim = draw.choice([driver.pid, *_workers(driver.pid)])
        with contextlib.suppress(ProcessLookupError):
            os.kill(victim, signal.SIGKILL)
        note(victim, "driver killed" if victim == driver.pid else "worker killed", "", "")
        if victim == driver.pid:
            driver.wait()
            return True


def _interval(kill_s: float, draw) -> float:
    return draw.uniform(0.5, 1.5) * kill_s if kill_s else float("inf")


def _workers(pid: int) -> list[int]:
    """Children of the driver that do analyses: multiprocessing has one of its own."""
    found = []
    with contextlib.suppress(OSError):
        for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
            if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes():
                found.append(int(child))
    return found


class _Notes:
    """Rows of driver.csv: time [s], process, what, memory [MB], open files."""

    def __init__(self, table):
        self._table, self._writer = table, csv.writer(table, lineterminator="\n")

    def __call__(self, *row) -> None:
        self._writer.writerow([round(time.time(), 1), *row])
        self._table.flush()
