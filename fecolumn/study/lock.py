"""Who may work in a study folder: one driver, or the tasks of one job array.

Locks are the kernel's (flock): they end with their process, however it ends, and Linux keeps them
over NFS, too.

    study.lock             one driver exclusively, or the tasks of an array together
    study-I-of-N.lock      task I of an array of N
    STEM.workers.lock      workers under MPI, which may outlive their driver by seconds
"""

from __future__ import annotations

import errno
import fcntl
import os
import socket
import time
from pathlib import Path
from typing import IO

from fecolumn.foundation.atomic import disk_full
from fecolumn.foundation.lock import is_held, open_lock
from fecolumn.foundation.schema import InputError

# Another driver that only looks holds a lock for an instant
_TRIES, _PAUSE_S = 10, 0.05
# mpirun ends the ranks of a job that lost one within seconds
_WORKERS_WAIT_S = 60.0


class FolderLock:
    """Right to work in a study folder.

    Parameters
    ----------
    folder
        of the study.
    share
        (index, size) of a task of a job array, None for a driver of the whole study.

    Raises
    ------
    InputError
        somebody else holds it; says who.
    """

    def __init__(self, folder: Path, share: tuple[int, int] | None) -> None:
        self._files: list[IO[str]] = []
        try:
            self._take(folder / "study.lock", shared=share is not None)
            if share:
                self._take(folder / f"{stem(share)}.lock")
                for other in folder.glob("study-*-of-*.lock"):
                    if not other.name.endswith(
                        (f"-of-{share[1]}.lock", ".workers.lock")
                    ) and is_held(other):
                        raise BlockingIOError
            for workers in (
                [folder / f"{stem(share)}.workers.lock"]
                if share
                else folder.glob("study*.workers.lock")
            ):
                _wait_until_free(workers)
        except BlockingIOError:
            self.close()
            raise InputError(
                folder,
                "",
                None,
                f"another driver works on this study ({_owners(folder) or 'just starting'}); "
                "wait for it or stop it",
            ) from None
        except OSError as error:
            self.close()
            if disk_full(error):
                raise
            if error.errno in (errno.EROFS, errno.EACCES, errno.EPERM):
                raise InputError(
                    folder, "", None, f"may not be written ({error.strerror}); give another folder"
                ) from None
            raise InputError(
                folder,
                "",
                None,
                f"cannot be locked ({error.strerror}); the file system must support flock",
            ) from None

    def _take(self, file: Path, shared: bool = False) -> None:
        lock = open_lock(file)
        self._files.append(lock)
        for left in reversed(range(_TRIES)):
            try:
                fcntl.flock(lock, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                if not left:
                    raise
                time.sleep(_PAUSE_S)
        if not shared:
            lock.truncate(0)
            lock.write(f"process {os.getpid()} on {socket.gethostname()}")
            lock.flush()

    def close(self) -> None:
        """Release the locks."""
        while self._files:
            self._files.pop().close()


def stem(share: tuple[int, int] | None) -> str:
    """Name of the files of a driver."""
    return f"study-{share[0]}-of-{share[1]}" if share else "study"


def hold_as_worker(folder: Path, share: tuple[int, int] | None) -> IO[str]:
    """The open lock that tells a later driver that this process may still write into the folder."""
    lock = open_lock(folder / f"{stem(share)}.workers.lock")
    fcntl.flock(lock, fcntl.LOCK_SH)
    return lock


def _wait_until_free(file: Path) -> None:
    end = time.monotonic() + _WORKERS_WAIT_S
    while file.exists():
        with open_lock(file) as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except BlockingIOError:
                if time.monotonic() > end:
                    raise
        time.sleep(_PAUSE_S)


def _owners(folder: Path) -> str:
    return ", ".join(
        sorted(
            text
            for file in folder.glob("study*.lock")
            if not file.name.endswith(".workers.lock")
            and is_held(file)
            and (text := file.read_text().strip())
        )
    )
