"""Which code made a result: version of the package, and a digest of the sources that decide what an
analysis gives.
"""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Iterable
from pathlib import Path

from fecolumn.foundation.version import __version__

#: Counts up whenever the same case gives another motion; measurements state it, so that those of an
#: older one are known. See "When motions change" in the manual's contributing.md.
PHYSICS = 13

_PACKAGE = Path(__file__).parents[1]
# Folders and files of which results depend; what only reads, writes, waits or tells is left out
DECIDING = (
    "case/bodies.py",
    "case/body_keys.py",
    "case/case_tables.py",
    "case/check_case.py",
    "case/column_keys.py",
    "case/case.py",
    "case/check_bodies.py",
    "case/check_bond.py",
    "case/check_found.py",
    "case/check_full.py",
    "case/check_grounds.py",
    "case/checked.py",
    "case/check_link.py",
    "case/check_motion.py",
    "case/check_plates.py",
    "case/check_rolling.py",
    "case/check_step.py",
    "case/check_thin.py",
    "case/check_way.py",
    "case/changes.py",
    "case/given.py",
    "case/ground.py",
    "case/joint.py",
    "case/link.py",
    "case/mesh_file_keys.py",
    "case/mesh_limits.py",
    "case/model_keys.py",
    "case/model_names.py",
    "case/model_sections.py",
    "case/model_table.py",
    "case/order.py",
    "case/outline_keys.py",
    "case/reading.py",
    "case/sections.py",
    "case/arch.py",
    "case/polygon.py",
    "case/short_form.py",
    "case/ground_sizes.py",
    "case/sizes.py",
    "contact",
    "engines",
    "fem",
    "foundation/_dolfinx.py",
    "foundation/content.py",
    "foundation/gravity.py",
    "foundation/summed.py",
    "mesh",
    "motions",
    "statistics/csv_table.py",
    "structures",
)


def digest_of(paths: Iterable[Path]) -> str:
    """Sixteen hexadecimal digits that name the content of files."""
    digest = hashlib.sha256()
    for path in paths:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def files_of(names: Iterable[str]) -> list[Path]:
    """Sources that `names` mean, in a lasting order: files of the package, and the .py and .toml
    files of its folders.

    Raises
    ------
    FileNotFoundError
        the package has no such file or folder.
    """
    files = []
    for name in names:
        place = _PACKAGE / name
        found = (
            [place]
            if place.is_file()
            else sorted(path for path in place.rglob("*") if path.suffix in (".py", ".toml"))
        )
        if not found:
            raise FileNotFoundError(f"the package has no source {name}")
        files += found
    return files


@functools.cache
def package_digest() -> str:
    """Digest of DECIDING as it is now: results of the same case and the same digest are of the same
    code.
    """
    return digest_of(files_of(DECIDING))


def code() -> dict[str, str]:
    """What every result says of the code that made it: version and sources."""
    return {"version": __version__, "sources": package_digest()}


def code_text(version: str | None, sources: str | None) -> str:
    """Code for a reader, such as "fecolumn 0.2.0 (sources 3f0c9a1b2d4e5f60)"."""
    return (
        f"fecolumn {version or 'of unknown version'} "
        f"({f'sources {sources}' if sources else 'sources not recorded'})"
    )
