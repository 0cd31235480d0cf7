"""HDF5 files that are known to be whole before the HDF5 library reads them.

The library trusts what a file says of itself: one byte that has changed may end the process. A file
of ours ends with a seal, the checksum of all before it, which HDF5 does not look at. A file without
one is first read from end to end by another process.
"""

from __future__ import annotations

import functools
import hashlib
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

from fecolumn.foundation.files import Unreadable, read_bytes

_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_SEAL = b"\nfecolumn sha256 "
_MOST_BYTES = 4_000_000_000
_PATIENCE_S = 60.0
# links to other files and datasets that lie in them are no part of a file that can be checked
_READER = """
import resource, sys
resource.setrlimit(resource.RLIMIT_AS, (8 * 10**9, 8 * 10**9))
resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
import h5py

def read(item):
    for name in item.attrs:
        item.attrs[name]
    if isinstance(item, h5py.Dataset):
        if item.is_virtual or item.external:
            raise ValueError("its data lie in other files")
        if item.size and item.size * item.dtype.itemsize > 2 * 10**9:
            raise ValueError("a dataset of more than 2 GB")
        item[()]
        return
    for name in item:
        if not isinstance(item.get(name, getlink=True), h5py.HardLink):
            raise ValueError("it holds links")
        read(item[name])

try:
    with h5py.File(sys.argv[1], "r") as file:
        read(file)
except BaseException as error:
    print(" ".join(str(error).split())[:200] or type(error).__name__)
    sys.exit(1)
"""


def sealed(content: bytes) -> bytes:
    """Content of an HDF5 file with its seal."""
    return content + _SEAL + hashlib.sha256(content).hexdigest().encode() + b"\n"


def open_whole(path: Path | str) -> Any:
    """An HDF5 file open for reading, once it is known that it can be read.

    Raises
    ------
    Unreadable
        no such file, no HDF5 file, or damaged.
    """
    import h5py

    if fault := hdf5_fault(path):
        raise Unreadable(fault)
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise Unreadable(f"is no HDF5 file, or damaged ({error})") from None


def seal_fault(path: Path | str) -> str:
    """As `hdf5_fault`, of a file with a seal; empty of one without, which is not read further."""
    try:
        content = read_bytes(path, _MOST_BYTES)
    except Unreadable as error:
        return str(error)
    if not content.startswith(_SIGNATURE):
        return "is no HDF5 file"
    return _fault_of_sealed(content) if _has_seal(content) else ""


def _has_seal(content: bytes) -> bool:
    return content[len(content) - len(sealed(b"")) :].startswith(_SEAL)


def _fault_of_sealed(content: bytes) -> str:
    whole = sealed(content[: len(content) - len(sealed(b""))]) == content
    return "" if whole else "is damaged: it is not what its checksum says"


def hdf5_fault(path: Path | str) -> str:
    """What keeps a file from being read as HDF5, in words; empty where nothing does."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        status = None
    try:
        return _fault(str(path), status and (status.st_size, status.st_mtime_ns, status.st_ino))
    except Unreadable as error:
        return str(error)


@functools.lru_cache(maxsize=256)
def _fault(path: str, version: tuple[int, int, int] | None) -> str:
    """As `hdf5_fault`; `version` tells whether the file is still the one read before."""
    content = read_bytes(path, _MOST_BYTES)
    if not content.startswith(_SIGNATURE):
        return "is no HDF5 file"
    if _has_seal(content):
        return _fault_of_sealed(content)
    del content
    try:
        reader = subprocess.run(
            [sys.executable, "-c", _READER, path],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=_PATIENCE_S,
            text=True,
            errors="replace",
        )
    except subprocess.TimeoutExpired:
        return f"cannot be read as HDF5 within {_PATIENCE_S:g} s: damaged"
    if reader.returncode < 0:
        return (
            f"is damaged: reading it ended the reader by {signal.Signals(-reader.returncode).name}"
        )
    return f"is no HDF5 file, or damaged ({reader.stdout.strip()})" if reader.returncode else ""
