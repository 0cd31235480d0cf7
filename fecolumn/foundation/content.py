"""What tells files apart that a case names: their content, not their names."""

from __future__ import annotations

import functools
import hashlib
from pathlib import Path

from fecolumn.foundation.files import is_file


def content(source: str) -> str:
    """Digest of the file `source`, or `source` itself where it is no file; with the number of a
    motion in an ensemble.
    """
    file, mark, number = (source, "", "") if is_file(source) else source.rpartition("#")
    if not is_file(file):
        return source
    status = Path(file).stat()
    return _digest(file, status.st_size, status.st_mtime_ns) + mark + number


@functools.lru_cache(maxsize=4096)
def _digest(path: str, size: int, changed: int) -> str:
    """sha256 of a file; size and time of change tell whether it is still the one read before."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
