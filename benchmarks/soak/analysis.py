"""An analysis as the driver's workers do it: a run, and what its process holds afterwards."""

from __future__ import annotations

import os
from pathlib import Path

from fecolumn import simulation
from fecolumn.engines.summary import write_sealed

ENTRY = "benchmarks.soak.analysis:run"
_done = 0


def run(case, folder, **options) -> dict:
    """Summary of `fecolumn.simulation.run`, with `process`: pid, analyses that this one has done,
    memory [MB] and open files.

    Its history, which a hundred thousand would fill a disk with, goes.
    """
    global _done
    summary = simulation.run(case, folder, **options)
    _done += 1
    summary["process"] = {
        "pid": os.getpid(),
        "done": _done,
        "memory_mb": memory_mb("self"),
        "open_files": open_files("self"),
    }
    (folder / "history.h5").unlink(missing_ok=True)
    return write_sealed(folder, summary)


def memory_mb(pid) -> float:
    """Memory of a process that is its own [MB]: without files that the operating system keeps
    mapped for all.
    """
    fields = Path(f"/proc/{pid}/statm").read_text().split()
    return round((int(fields[1]) - int(fields[2])) * os.sysconf("SC_PAGE_SIZE") / 1e6, 2)


def open_files(pid) -> int:
    """Number of open files of a process."""
    return len(os.listdir(f"/proc/{pid}/fd"))
