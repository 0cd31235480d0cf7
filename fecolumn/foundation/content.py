"""What tells files apart that a case names: their content, not their names."""

from __future__ import annotations

from pathlib import Path

from fecolumn.foundation.digests import digest_of_file
from fecolumn.foundation.files import is_file


def content(source: str) -> str:
    """Digest of the file `source`, or `source` itself where it is no file; with the number of a
    motion in an ensemble.
    """
    file, mark, number = (source, "", "") if is_file(source) else source.rpartition("#")
    return digest_of_file(Path(file)) + mark + number if is_file(file) else source
