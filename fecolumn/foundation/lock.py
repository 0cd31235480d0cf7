"""Locks of the kernel (flock): they end with their process, however it ends, and Linux keeps them
over NFS, too.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any


def open_lock(file: Path | str) -> IO[str]:
    """A lock's file open for reading and writing, made if need be.

    Raises
    ------
    OSError
        it cannot be opened, or is a pipe or a device, which could hold its opener up.
    """
    handle = os.open(file, os.O_RDWR | os.O_CREAT | os.O_NONBLOCK | os.O_CLOEXEC, 0o666)
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise FileExistsError(
            errno.EEXIST, "a device or a pipe is in the place of a lock", str(file)
        )
    return open(handle, "r+")


@contextlib.contextmanager
def alone(path: Path) -> Iterator[None]:
    """Hold the right to make `path`; who comes second waits. It ends with the process that has it.

    if not path.exists():
        with alone(path):
            if not path.exists():
                ...
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    file = path.parent / f".{path.name}.lock"
    while True:
        lock = open_lock(file)
        fcntl.flock(lock, fcntl.LOCK_EX)
        if _still(lock, file):
            break
        # its last holder has taken the file away meanwhile: others lock another one by now
        lock.close()
    try:
        yield
    finally:
        with lock:
            file.unlink(missing_ok=True)


def is_held(file: Path) -> bool:
    """Whether a process holds the lock in `file` alone; one that was killed holds none, though its
    file may be left.
    """
    try:
        with open(os.open(file, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)) as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False


def _still(lock: IO[Any], file: Path) -> bool:
    """Whether an open lock is the one that goes by its name."""
    try:
        return os.path.samestat(os.fstat(lock.fileno()), os.stat(file))
    except FileNotFoundError:
        return False
