"""What tells files apart that a case names: their content, not their names."""

from __future__ import annotations

import functools
import hashlib
import re
from pathlib import Path

from fecolumn.foundation.digests import digest_of_file
from fecolumn.foundation.files import is_file

# What a file of this ending takes from other files, by their names: arrays of XDMF, and parts of a
# script of Gmsh
_ARRAYS = re.compile(r"([^<>\"\s]+\.(?:h5|hdf5|bin|raw)\b)")
_REFERS = {
    ".xdmf": _ARRAYS,
    ".xmf": _ARRAYS,
    ".geo": re.compile(r"\b(?:Include|Merge|Open|ShapeFromFile)\s*\(?\s*\"([^\"\n]+)\""),
}


def content(source: str) -> str:
    """Digest of the file `source` and of the files that it refers to, or `source` itself where it
    is no file; with the number of a motion in an ensemble.
    """
    file, mark, number = (source, "", "") if is_file(source) else source.rpartition("#")
    if not is_file(file):
        return source
    digest = digest_of_file(Path(file))
    if others := _others(Path(file), {Path(file).resolve()}):
        digests = [digest, *(digest_of_file(other) for other in others)]
        digest = hashlib.sha256("".join(digests).encode()).hexdigest()
    return digest + mark + number


def _others(file: Path, known: set[Path]) -> list[Path]:
    """Files that a file refers to, and these to others, in their order; those not `known`, which
    grows.
    """
    if file.suffix.lower() not in _REFERS:
        return []
    found: list[Path] = []
    for name in _names(file, digest_of_file(file)):
        other = (file.parent / name).resolve()
        if other not in known and is_file(other):
            known.add(other)
            found += [other, *_others(other, known)]
    return found


@functools.lru_cache(maxsize=256)
def _names(file: Path, digest: str) -> list[str]:
    """What a file, which has this digest, refers to by name."""
    text = file.read_text(encoding="utf-8", errors="replace")
    return _REFERS[file.suffix.lower()].findall(text)
