"""Values of a case that are changed by dotted keys."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from fecolumn.case.case_tables import NAMED, of_this_version
from fecolumn.case.case_text import ShownCase
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge, nested


def changed_tables(case: ShownCase, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Tables of a case with other values, of the short form where it was stated in it and all
    changes are of keys that it has.

    Parameters
    ----------
    changes
        values by dotted key or by section, None of what is removed.

    Raises
    ------
    InputError
        no such key, which could be removed.
    """
    changes = {of_this_version(key): value for key, value in changes.items()}
    full = any(_is_full(key, value) for key, value in changes.items())
    short = case.short if not full else None
    tables = short.tables(opened=True) if short else case.tables()
    for key, value in changes.items():
        if value is None:
            _remove(tables, key, short or case)
        else:
            tables = merge(tables, nested(key, value))
    return tables


def _is_full(key: str, value: object) -> bool:
    """Whether a dotted key, or a table of this name, is of the full form alone."""
    first, _, rest = key.partition(".")
    if first == "initial":
        return (
            "." in rest
            or isinstance(value, dict)
            and any(isinstance(v, dict) for v in value.values())
        )
    return first in NAMED or first == "observed"


def _remove(tables: dict[str, Any], key: str, section: Any) -> None:
    """Take a dotted key out of the tables of a `section`; one that may be left out may be so
    already.

    Raises
    ------
    InputError
        no such key.
    """
    *outer, last = key.split(".")
    for word in outer:
        tables[word] = dict(found) if isinstance(found := tables.get(word), dict) else {}
        tables = tables[word]
        inner = section.get(word) if isinstance(section, Mapping) else None
        section = inner or getattr(section, word, None)
    is_section = dataclasses.is_dataclass(section)
    known = [one.name for one in dataclasses.fields(section)] if is_section else []
    if last not in tables and last not in known:
        raise InputError("case", key, None, "no such key, which could be removed")
    tables.pop(last, None)
