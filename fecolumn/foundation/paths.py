"""Paths that a TOML file states: which keys name files, and how another file takes them over."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

#: Keys of a case that may name files, by section; of bodies by their kind.
OF_SECTIONS = {"column": ("mesh_file",), "motion": ("source", "source_y", "source_z")}
OF_BODIES = {"mesh": ("mesh_file",), "matrices": ("mass_file", "stiffness_file", "nodes_file")}
#: What names of records begin with that are no files
LICK_PREFIX, FEMA_PREFIX = "lick:", "fema-p695:"
# The same of motions that a study's own function makes: a word, a colon, and no ending of a file
_OWN_NAME = re.compile(r"[a-z][a-z0-9-]*:[^.]*")
# Of a study: the case of all its analyses, and what its table [case] takes over
_OF_STUDY = (("case",), ("case", "extends"))


def names_record(source: str) -> bool:
    """Whether a text names a record, such as "lick:12", and no file, whose name may have a colon,
    too.
    """
    known = source.startswith((LICK_PREFIX, FEMA_PREFIX))
    return known or _OWN_NAME.fullmatch(source) is not None


def absolute(path: str, folder: Path) -> str:
    """A path that a file in `folder` states, for files elsewhere; names of records, such as
    "lick:12", stay.
    """
    same = not path or names_record(path) or Path(path).is_absolute()
    return path if same else str(folder / path)


def taken_over(tables: dict[str, Any], file: Path | str) -> dict[str, Any]:
    """Tables of a case or a study with the paths that `file` states made absolute, so that a file
    of another folder may take them over.

    Keys may be dotted ("motion.source"), and stand in the tables and lists of a study's axes.
    """
    folder = Path(file).resolve().parent
    return {name: _absolute(one, tuple(name.split(".")), folder) for name, one in tables.items()}


def _absolute(value: Any, key: tuple[str, ...], folder: Path) -> Any:
    if isinstance(value, dict):
        return {
            name: _absolute(one, (*key, *name.split(".")), folder) for name, one in value.items()
        }
    if isinstance(value, list):
        return [_absolute(one, key, folder) for one in value]
    return absolute(value, folder) if isinstance(value, str) and _names_file(key) else value


def _names_file(key: tuple[str, ...]) -> bool:
    """Whether the key of these words names a file."""
    if (
        len(key) > 2
        and key[-3] == "bodies"
        and any(key[-1] in names for names in OF_BODIES.values())
    ):
        return True
    return key in _OF_STUDY or len(key) > 1 and key[-1] in OF_SECTIONS.get(key[-2], ())
