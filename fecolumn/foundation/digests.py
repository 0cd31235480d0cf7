"""Files that are made once and kept: whether each is still what was written, by its digest."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import os
import shutil
import tempfile
import warnings
from pathlib import Path

from fecolumn.foundation.atomic import write_json
from fecolumn.foundation.files import Unreadable, read_json

#: What a folder of kept files says of them: SHA-256 by name.
DIGESTS = "digests.json"


def note(folder: Path, *names: str) -> None:
    """Write down the digests of files of a folder, beside those that it has."""
    known = _noted(folder) | {name: digest_of_file(folder / name) for name in names}
    write_json(folder / DIGESTS, known)


def intact(folder: Path, *names: str) -> bool:
    """Whether files of a folder, all that it has noted unless named, are what was written.

    A file is read once a process, at 1 to 2 GB/s.
    """
    noted = _noted(folder)
    try:
        return bool(noted) and all(
            noted.get(name) == digest_of_file(folder / name) for name in names or noted
        )
    except (OSError, ValueError):
        return False


def digest_of_json(content: object) -> str:
    """SHA-256 of what JSON takes, the same for what it gives back."""
    plain = json.loads(json.dumps(content))
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest()


def remove_damaged(path: Path) -> None:
    """Take a kept file or folder that is not what was written out of the way, and say so; others
    that have it open keep it.
    """
    warnings.warn(f"{path} is damaged, and made anew", stacklevel=2)
    aside = Path(tempfile.mkdtemp(prefix=f".{path.name}-", dir=path.parent))
    with contextlib.suppress(FileNotFoundError):
        os.replace(path, aside / path.name)
    shutil.rmtree(aside, ignore_errors=True)


def _noted(folder: Path) -> dict[str, str]:
    try:
        found = read_json(folder / DIGESTS)
    except Unreadable:
        return {}
    return found if isinstance(found, dict) else {}


def digest_of_file(path: Path) -> str:
    """SHA-256 of a file, which is read again where its size, its time or its inode is another.

    Raises
    ------
    OSError
        no such file, or one that cannot be read.
    """
    status = path.stat()
    return _digest(str(path), status.st_size, status.st_mtime_ns, status.st_ino)


@functools.lru_cache(maxsize=4096)
def _digest(path: str, *_version: int) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
