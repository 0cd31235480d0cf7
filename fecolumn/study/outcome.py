"""What became of an analysis that was handed to a worker."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from fecolumn.engines.summary import read_summary
from fecolumn.foundation.files import Unreadable

#: Words of an outcome. RETURNED: it was never begun, because its worker ended. DISK_FULL: nobody
#: can go on.
DONE, FAILED, RETURNED, DISK_FULL = "done", "failed", "returned", "full"


class Task(NamedTuple):
    """An analysis for a worker: its case, its result folder, and the file for what it says."""

    id: str
    case: object
    folder: Path
    log: Path


class TaskOutcome(NamedTuple):
    """The end of a task.

    Attributes
    ----------
    id
        of the analysis.
    word
        DONE, FAILED, RETURNED or DISK_FULL.
    reason
        why, unless DONE.
    wall_s
        wall time of the worker [s].
    started
        seconds since the epoch.
    machine
        where.
    summary
        JSON of its summary where it is DONE; version, overturned and slid_off are in it, too.
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


def finished_outcome(case_id: str, folder: Path, **more: Any) -> TaskOutcome | None:
    """DONE where the result folder holds a valid summary of this very analysis, else None."""
    try:
        summary = read_summary(folder, case_id)
    except Unreadable:
        return None
    return TaskOutcome(
        case_id,
        DONE,
        summary=json.dumps(summary),
        version=str(summary.get("version", "")),
        overturned=summary["overturned"],
        slid_off=bool(summary.get("slid_off")),
        **{"wall_s": float(summary["wall_s"]), **more},
    )


def outcomes_of_dead(
    tasks: Iterable[Task], reason: str, ready: bool = True
) -> Iterator[TaskOutcome]:
    """Outcomes of the tasks that a dead worker had, in their order.

    A task with a valid result is done. The first task without one has failed: it killed the worker.
    The tasks after it were never begun.

    Parameters
    ----------
    tasks
        that the worker had.
    reason
        how the worker died.
    ready
        whether the worker had begun; if not, no task killed it.
    """
    blamed = not ready
    for task in tasks:
        if done := finished_outcome(task.id, task.folder):
            yield done
        else:
            yield TaskOutcome(task.id, RETURNED if blamed else FAILED, reason)
            blamed = True
