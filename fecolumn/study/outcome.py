"""What became of an analysis that was handed to a worker."""

from __future__ import annotations

import errno
import json
from pathlib import Path
from typing import NamedTuple

#: Words of an outcome. RETURNED: it was never begun, because its worker ended; FULL: the disk is, and nobody can go on.
DONE, FAILED, RETURNED, FULL = "done", "failed", "returned", "full"

# of the disk, of the user's quota, of the size a file may have
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


class Task(NamedTuple):
    """An analysis for a worker: its case, its result folder, and the file for what it says."""

    id: str
    case: object
    folder: Path
    log: Path


class Outcome(NamedTuple):
    """The end of a task.

    Attributes:
        id: of the analysis. word: DONE, FAILED, RETURNED or FULL. reason: why, unless DONE.
        wall_s: wall time of the worker [s]. started: seconds since the epoch. machine: where.
        summary: JSON of its summary where it is DONE; version, overturned and slid_off are in it, too.
    """

    id: str
    word: str
    reason: str = ""
    wall_s: float | None = None
    started: float | None = None
    machine: str | None = None
    summary: str | None = None
    version: str | None = None
    overturned: bool = False
    slid_off: bool = False


def finished(case_id: str, folder: Path, **more) -> Outcome | None:
    """DONE where the result folder holds a valid summary of this very analysis, else None."""
    try:
        summary = json.loads((folder / "summary.json").read_text())
    except (OSError, ValueError):
        return None
    if not isinstance(summary, dict) or summary.get("case_id") != case_id:
        return None
    return Outcome(case_id, DONE, summary=json.dumps(summary), version=summary.get("version"),
                   overturned=bool(summary.get("overturned")), slid_off=bool(summary.get("slid_off")), **{"wall_s": summary.get("wall_s"), **more})


def disk_full(error: BaseException | None) -> bool:
    """Whether a full disk, a quota or a limit on the size of files is behind an error."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in _FULL:
            return True
        error = error.__cause__ or error.__context__
    return False
