"""The result folder of an analysis: one process at a time, one case."""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fecolumn.case.case import Case
from fecolumn.foundation.atomic import disk_full, write_json
from fecolumn.foundation.files import Unreadable, read_json
from fecolumn.foundation.lock import open_lock
from fecolumn.foundation.schema import InputError

if TYPE_CHECKING:
    from mpi4py import MPI


@contextlib.contextmanager
def held(
    folder: Path,
    case: Case,
    comm: MPI.Intracomm,
    file: Path | str,
    chosen: dict[str, Any] | None = None,
) -> Iterator[Callable[[], None]]:
    """Hold the folder for one process; yields the function that makes it this case's, for when the
    analysis has started.

    chosen: how the case's step was chosen, which is kept with the case.

    Nothing is written where it is another case's, and what does not start leaves the folder free
    for any case.
    """
    refusal, lock, made, known = None, None, False, folder / "case.json"
    if comm.rank == 0:
        try:
            made = not folder.exists()
            _make(folder)
            refusal = _of_another_case(known, case)
            if refusal is None:
                lock = open_lock(folder / ".lock")
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                # its holder has just given the folder up
                if not os.path.samestat(os.fstat(lock.fileno()), os.stat(folder / ".lock")):
                    raise BlockingIOError
                # another run may have claimed the folder, and ended, since
                refusal = _of_another_case(known, case)
        except (BlockingIOError, FileNotFoundError):
            refusal = "-o", str(folder), "another run is writing into this folder"
        except (NotADirectoryError, FileExistsError):
            refusal = "-o", str(folder), "is a file; a folder is needed"
        except PermissionError:
            refusal = "-o", str(folder), "may not be written (permission denied)"
        except (Unreadable, KeyError, TypeError):
            refusal = "-o", str(folder), "its case.json is damaged; give a new folder"
        except OSError as error:
            if disk_full(error):
                raise
            refusal = (
                "-o",
                str(folder),
                f"cannot be written ({error.strerror}); give another folder",
            )
    refusal = comm.bcast(refusal)
    if refusal:
        raise InputError(file, *refusal)

    def claim() -> None:
        if lock and not known.is_file():
            told = {"dt_chosen": chosen} if chosen else {}
            # by the name of summary.json, and by the older one, which earlier versions read
            own = {"case_id": case.id, "id": case.id, "file": str(file)}
            write_json(known, {**own, "case": case.as_stated(), **told})

    try:
        yield claim
    finally:
        if lock:
            if [entry.name for entry in folder.iterdir()] == [".lock"]:
                (folder / ".lock").unlink()
                if made:
                    folder.rmdir()
            lock.close()


def _make(folder: Path) -> None:
    """Make a folder; a file system that holds no folders of users, such as /proc, refuses it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileNotFoundError as error:
        raise PermissionError(error.errno, error.strerror, str(folder)) from error


def _of_another_case(known: Path, case: Case) -> tuple[str, str, str] | None:
    """Why a folder, its case.json at `known`, is not this case's: as of InputError; else None."""
    folder, told = known.parent, None
    if known.is_file():
        other = read_json(known)["id"]
        if other != case.id:
            told = (
                f"holds the results of another case ({other}, this one is {case.id}); give a new "
                "folder"
            )
    elif any(folder.iterdir()) and not (folder / ".lock").exists():
        told = "must be a new or empty folder, or one of this case"
    return ("-o", str(folder), told) if told else None


def kept_choice(folder: Path) -> dict[str, Any] | None:
    """How the step of the case of a result folder was chosen, None where it was stated, or there
    is no case.
    """
    try:
        chosen = read_json(folder / "case.json").get("dt_chosen")
    except (OSError, Unreadable, AttributeError):
        return None
    return chosen if isinstance(chosen, dict) else None
