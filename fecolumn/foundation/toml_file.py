"""Tables of a TOML file, and of one that it extends."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

from fecolumn.foundation.files import Unreadable, read_bytes
from fecolumn.foundation.paths import taken_over
from fecolumn.foundation.schema import InputError, in_text

# A case has three levels; a file with more than these is damaged, and would exhaust the stack
_DEEPEST = 20
_LONGEST_CHAIN = 50
_LONGEST_FILE = 20_000_000  # [bytes]


def read_toml(path: Path | str, _heirs: tuple[Path, ...] = ()) -> dict[str, Any]:
    """Tables of a TOML file; `extends = "other.toml"` is read first and overridden key by key, or
    by `section = false` as a whole.

    Paths are relative to the file that states them: of a file in another folder they come absolute.
    """
    path = Path(path)
    tables = _tables(path)
    parent = tables.pop("extends", None)
    if parent is None:
        return tables
    if not isinstance(parent, str) or not parent:
        raise InputError(
            path, "extends", parent, "must be the path of a TOML file, relative to this one"
        )
    heirs = (*_heirs, path)
    if any(_same(path.parent / parent, heir) for heir in heirs):
        circle = " -> ".join(heir.name for heir in (*heirs, path.parent / parent))
        raise InputError(
            path,
            "extends",
            parent,
            f"goes in a circle: {circle}" if len(heirs) > 1 else "a file may not extend itself",
        )
    if len(heirs) >= _LONGEST_CHAIN:
        raise InputError(
            path, "extends", parent, f"at most {_LONGEST_CHAIN} files may extend one another"
        )
    other = path.parent / parent
    if not other.exists():
        raise InputError(path, "extends", parent, f"no such file: {other}")
    inherited = read_toml(other, heirs)
    return merge(
        inherited if _same(other.parent, path.parent) else taken_over(inherited, other), tables
    )


def _same(one: Path, other: Path) -> bool:
    try:
        return one.resolve() == other.resolve()
    except (
        OSError,
        ValueError,
        RuntimeError,
    ):  # a name that cannot be, or links in a circle: reading it says so
        return False


def _tables(path: Path) -> dict[str, Any]:
    """Tables of one TOML file as they stand."""
    try:
        text = read_bytes(path, _LONGEST_FILE).decode("utf-8-sig")
    except Unreadable as error:
        raise InputError(
            path, "", None, str(error).replace("a file is needed", "a TOML file is needed")
        ) from None
    except UnicodeDecodeError as error:
        raise InputError(path, "", None, f"not a text file in UTF-8 ({error.reason})") from None
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        told = f"not valid TOML: {error}{_comma_hint(text, str(error))}"
        raise InputError(path, "", None, in_text(told)) from None
    except RecursionError:
        raise InputError(path, "", None, "not valid TOML: nested too deeply") from None
    except (
        ValueError
    ) as error:  # Python reads no number of more than 4300 digits, and no 30 February
        long = next(
            (
                row
                for row, line in enumerate(text.splitlines(), 1)
                if re.search(r"[\d_]{4300,}", line)
            ),
            None,
        )
        said = f"line {long}: a whole number of more than 4300 digits" if long else str(error)
        raise InputError(path, "", None, in_text(f"not valid TOML: {said}")) from None
    if (deep := _depth(tables)) > _DEEPEST:
        raise InputError(path, "", None, f"tables and lists {deep} deep; at most {_DEEPEST}")
    return tables


def _comma_hint(text: str, said: str) -> str:
    """The end of a message on the line that it names, where this has a decimal comma."""
    found = re.search(r"at line (\d+)", said)
    line = text.split("\n")[int(found[1]) - 1] if found else ""
    comma = re.search(r"=\s*[-+]?\d+,\d+\s*(#|$)", line)
    return "; numbers have a decimal point, as in 1.5" if comma else ""


def _depth(tables: dict[str, Any] | list[Any]) -> int:
    """Levels of tables and lists within one another."""
    depth, level = 0, [tables]
    while level:
        depth += 1
        level = [
            item
            for holder in level
            for item in (holder.values() if isinstance(holder, dict) else holder)
            if isinstance(item, (dict, list))
        ]
    return depth


def stated(tables: dict[str, Any]) -> dict[str, Any]:
    """Tables without the keys that are left open."""
    return {
        key: stated(value) if isinstance(value, dict) else value
        for key, value in tables.items()
        if value is not None
    }


def nested(key: str, value: Any) -> dict[str, Any]:
    """Tables in which the dotted key has this value."""
    outer, *inner = key.split(".")
    for part in reversed(inner):
        value = {part: value}
    return {outer: value}


def merge(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """Tables of `base` overridden by those of `over`, key by key."""
    merged = dict(base)
    for key, value in over.items():
        merged[key] = (
            merge(merged[key], value)
            if isinstance(value, dict) and isinstance(merged.get(key), dict)
            else value
        )
    return merged
