"""Files that appear whole or not at all, whatever is killed and however full the disk is."""

from __future__ import annotations

import contextlib
import csv
import errno
import io
import json
import os
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from fecolumn.foundation.sealed import sealed

if TYPE_CHECKING:
    import h5py

#: How the names of unfinished files begin, each followed by letters of its own. One that a killed
#: process left may be deleted.
UNFINISHED = ".writing-"

# of the disk, of the user's quota, of the size a file may have
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def disk_full(error: BaseException | None) -> bool:
    """Whether a full disk, a quota or a limit on the size of files is behind an error."""
    while error is not None:
        if isinstance(error, OSError) and error.errno in _FULL:
            return True
        error = error.__cause__ or error.__context__
    return False


def write_bytes(path: Path, content: bytes) -> None:
    """As `write_file`, of bytes."""
    write_file(path, lambda file: file.write(content))


def write_file(path: Path, fill: Callable[[BinaryIO], object]) -> None:
    """Write the file that `fill(file)` makes so that a reader, and a crash of the machine, sees the
    old content or the new, whoever else writes it, too.

    Raises
    ------
    OSError
        disk full, folder gone; the old file is kept.
    """
    handle, partial = tempfile.mkstemp(prefix=UNFINISHED, dir=path.parent)
    try:
        with open(handle, "wb") as file:
            os.fchmod(handle, 0o666 & ~_umask())
            fill(file)
            file.flush()
            os.fsync(handle)
        os.replace(partial, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(partial)
        raise


def _umask() -> int:
    """What new files of this process may not be, read without changing it for other threads."""
    with open("/proc/self/status") as status:
        return next(
            (int(line.split()[1], 8) for line in status if line.startswith("Umask:")), 0o022
        )


def write_json(path: Path, content: object) -> None:
    """Write JSON with a line for each key."""
    write_bytes(path, (json.dumps(content, indent=1) + "\n").encode())


def write_csv(path: Path, rows: Iterable[Iterable[object]]) -> None:
    """Write rows of cells as CSV, lines ended as Unix does: the same bytes everywhere."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    write_bytes(path, text.getvalue().encode())


def write_hdf5(
    path: Path,
    fill: Callable[[h5py.File], object],
    finish: Callable[[bytes], bytes] = sealed,
) -> None:
    """Write the HDF5 file that `fill(file)` makes, its bytes as `finish` returns them: with a seal.

    It is made in memory: HDF5 cannot take a full disk, and ends the process when it meets one.
    """
    import h5py

    with h5py.File(path.name, "w", driver="core", backing_store=False) as file:
        fill(file)
        file.flush()
        content = file.id.get_file_image()
    write_bytes(path, finish(content))
