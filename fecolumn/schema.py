"""Typed, validated sections of a TOML file: every key knows its unit, its range and its meaning."""

from __future__ import annotations

import dataclasses
import difflib
import math
import tomllib
import types
import typing
from pathlib import Path


class InputError(ValueError):
    """What a user gave cannot be used; the message names file, key, value and the allowed range."""

    def __init__(self, file, key: str, value, allowed: str):
        self.file, self.key, self.value, self.allowed = str(file), key, value, allowed
        shown = f" = {value!r}" if value is not None else ""
        super().__init__(f"{self.file}: {key}{shown}: {allowed}" if key else f"{self.file}: {allowed}")


def parameter(default=dataclasses.MISSING, *, doc: str, unit: str = "-", low=None, high=None,
              above=None, choices=None, words=(), since: str = "", counts: bool = True):
    """Dataclass field of a case section.

    Args:
        default: value when the key is absent; without one the key is required.
        doc: meaning of the key, shown in error messages.
        unit: physical unit, "-" when dimensionless.
        low, high: closed bounds of a number.
        above: open lower bound of a number.
        choices: the words a text key may take.
        words: words that a number's key takes in place of a number.
        since: version that brought a key younger than its section; at its default it is no part of `Case.id`, so that older results
            keep their names.
        counts: whether the key makes another analysis; False for what only guards or tells.
    """
    metadata = dict(doc=doc, unit=unit, low=low, high=high, above=above, choices=choices, words=words, since=since, counts=counts)
    if isinstance(default, (list, dict)):
        raise TypeError("defaults must be immutable")
    return dataclasses.field(default=default, metadata=metadata)


def allowed_range(metadata) -> str:
    """The allowed values of a parameter in words, with the unit."""
    return " or ".join([_number_range(metadata), *(f'"{word}"' for word in metadata["words"])])


def _number_range(metadata) -> str:
    unit = "" if metadata["unit"] == "-" else f" [{metadata['unit']}]"
    if metadata["choices"]:
        return "one of " + ", ".join(metadata["choices"])
    if metadata["above"] is not None:
        upper = f" and at most {metadata['high']:g}" if metadata["high"] is not None else ""
        return f"must be greater than {metadata['above']:g}{upper}{unit}"
    if metadata["low"] is not None and metadata["high"] is not None:
        return f"must lie in [{metadata['low']:g}, {metadata['high']:g}]{unit}"
    if metadata["low"] is not None:
        return f"must be at least {metadata['low']:g}{unit}"
    return f"must be a number{unit}"


def _typed(kind, value):
    """`value` as `kind`, or None where the TOML type does not fit."""
    if kind is float and isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value)
    if kind is int and isinstance(value, int) and not isinstance(value, bool):
        return value
    if kind in (str, bool) and isinstance(value, kind):
        return value
    if typing.get_origin(kind) is tuple and isinstance(value, (list, tuple)):
        items = [_typed(typing.get_args(kind)[0], item) for item in value]
        return None if None in items else tuple(items)
    return None


_WORDS = {float: "a number", int: "a whole number", str: "text in quotes", bool: "true or false"}


def _checked(kind, metadata, value, file, key):
    if isinstance(kind, types.UnionType):
        kind = next(k for k in typing.get_args(kind) if k is not types.NoneType)
    if isinstance(value, str) and value in metadata["words"]:
        return value
    typed = _typed(kind, value)
    if typed is None:
        word = _WORDS.get(kind) or "a list of " + {str: "texts", float: "numbers"}[typing.get_args(kind)[0]]
        word = " or ".join([word, *(f'"{text}"' for text in metadata["words"])])
        raise InputError(file, key, value, f"must be {word}; {metadata['doc']}")
    for item in typed if isinstance(typed, tuple) else (typed,):
        bad = False
        if isinstance(item, (int, float)) and not isinstance(item, bool):
            bad = (not math.isfinite(item)
                   or (metadata["low"] is not None and item < metadata["low"])
                   or (metadata["high"] is not None and item > metadata["high"])
                   or (metadata["above"] is not None and item <= metadata["above"]))
        if metadata["choices"] and item not in metadata["choices"]:
            bad = True
        if bad:
            raise InputError(file, key, value, f"{allowed_range(metadata)}; {metadata['doc']}")
    return typed


def build(section, table, file, prefix: str = ""):
    """Instance of the dataclass `section` from a TOML table, every key checked.

    Raises:
        InputError: unknown or missing key, wrong type, value out of range.
    """
    if not isinstance(table, dict):
        raise InputError(file, prefix.rstrip("."), table, "must be a table of keys")
    fields = {f.name: f for f in dataclasses.fields(section)}
    hints = typing.get_type_hints(section)
    for key, value in table.items():
        if key not in fields:
            near = difflib.get_close_matches(key, fields, 1, 0.6)
            hint = f"; did you mean {prefix}{near[0]}?" if near else f"; known keys: {', '.join(fields)}"
            raise InputError(file, prefix + key, None if isinstance(value, dict) else value, "unknown key" + hint)
    values = {}
    for name, field in fields.items():
        kind = hints[name]
        inner = next((k for k in typing.get_args(kind) if dataclasses.is_dataclass(k)), None) \
            if isinstance(kind, types.UnionType) else (kind if dataclasses.is_dataclass(kind) else None)
        if inner is not None:
            if name in table:
                values[name] = build(inner, table[name], file, f"{prefix}{name}.")
            elif not isinstance(kind, types.UnionType):
                values[name] = build(inner, {}, file, f"{prefix}{name}.")
            continue
        if name in table:
            values[name] = _checked(kind, field.metadata, table[name], file, prefix + name)
        elif field.default is dataclasses.MISSING:
            raise InputError(file, prefix + name, None, f"missing; {field.metadata['doc']}, {allowed_range(field.metadata)}")
    return section(**values)


def read_toml(path) -> dict:
    """Tables of a TOML file; `extends = "other.toml"` is read first and overridden key by key."""
    path = Path(path)
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        raise InputError(path, "", None, "no such file") from None
    except IsADirectoryError:
        raise InputError(path, "", None, "is a directory; a TOML file is needed") from None
    except UnicodeDecodeError as error:
        raise InputError(path, "", None, f"not a text file in UTF-8 ({error.reason})") from None
    except PermissionError:
        raise InputError(path, "", None, "may not be read (permission denied)") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(path, "", None, f"not valid TOML: {error}") from None
    parent = tables.pop("extends", None)
    if parent is None:
        return tables
    if not isinstance(parent, str):
        raise InputError(path, "extends", parent, "must be the path of a TOML file, relative to this one")
    if (path.parent / parent).resolve() == path.resolve():
        raise InputError(path, "extends", parent, "a file may not extend itself")
    return merge(read_toml(path.parent / parent), tables)


def merge(base: dict, over: dict) -> dict:
    """Tables of `base` overridden by those of `over`, key by key."""
    merged = dict(base)
    for key, value in over.items():
        merged[key] = merge(merged[key], value) if isinstance(value, dict) and isinstance(merged.get(key), dict) else value
    return merged
