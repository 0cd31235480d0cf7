"""Sections as classes for Python: signature, help and messages of the keys of a TOML table."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import textwrap
import typing

from fecolumn.foundation.schema import (
    InputError,
    Section,
    a_section,
    meant,
    required,
    section_name,
    wanted,
)

if typing.TYPE_CHECKING:
    from collections.abc import Callable

_Made = typing.TypeVar("_Made", bound=Section)


@typing.dataclass_transform(frozen_default=True, kw_only_default=True, field_specifiers=(required,))
def section_class(*, kw_only: bool = True) -> Callable[[type[_Made]], type[_Made]]:
    """Make a class of keys a frozen dataclass whose help tells each key's meaning, unit, range and
    default.

    An unknown or a missing key is an InputError, as in a file.

    Parameters
    ----------
    kw_only
        all keys are given by name alone, so that others may come to stand between them.
    """

    def made(plain: type[_Made]) -> type[_Made]:
        words = plain.__doc__
        cls = dataclasses.dataclass(frozen=True, slots=True, kw_only=kw_only, repr=False)(plain)
        cls.__repr__ = Section.__repr__  # type: ignore[method-assign]
        cls.__init__ = _by_known_keys(cls.__init__, cls, kw_only)  # type: ignore[method-assign]
        cls.__doc__ = words and f"{inspect.cleandoc(words)}\n\n{_parameters(cls)}"
        return cls

    return made


def _by_known_keys(init: typing.Any, cls: typing.Any, kw_only: bool) -> typing.Any:
    """The __init__ of a section that tells unknown and missing keys as those of a file."""
    names = {field.name: field for field in dataclasses.fields(cls)}
    kinds = typing.get_type_hints(cls)
    needed = {
        key: f"{field.metadata['doc']}, {wanted(kinds[key], field.metadata)}"
        if field.metadata
        else f"must be {a_section(kinds[key])}"
        for key, field in names.items()
        if field.default is dataclasses.MISSING
    }

    @functools.wraps(init)
    def checked(self: _Made, *values: typing.Any, **keys: typing.Any) -> None:
        name = section_name(cls)
        prefix = f"{name}." if name else ""
        keys = cls._by_newer_names(keys, "script", f"{cls.__name__}.")
        errors = [
            InputError(
                "case",
                prefix + key,
                value,
                "unknown key" + (meant(key, names, prefix) or f"; known keys: {', '.join(names)}"),
            )
            for key, value in keys.items()
            if key not in names
        ]
        if values and kw_only:
            first = next(iter([*needed, *names]))
            told = f"keys are given by name, such as {cls.__name__}({first}=...)"
            errors.append(InputError("case", name, values, told))
        errors += [
            InputError("case", prefix + key, None, f"missing; {told}")
            for key, told in needed.items()
            if key not in [*keys, *list(names)[: len(values)]]
        ]
        if errors:
            raise InputError.of_several(errors)
        init(self, *values, **keys)

    return checked


def _parameters(cls: typing.Any) -> str:
    """The sections Parameters, required keys first, and Raises of a class's help."""
    fields = sorted(dataclasses.fields(cls), key=lambda one: one.default is not dataclasses.MISSING)
    kinds = typing.get_type_hints(cls)
    lines = ["Parameters", "----------"]
    for field in fields:
        lines.append(f"{field.name} : {field.type}{_default(field)}")
        if field.metadata:
            told = f"{field.metadata['doc']}; {wanted(kinds[field.name], field.metadata)}"
            lines += textwrap.wrap(told, 92, initial_indent="    ", subsequent_indent="    ")
    lines += ["", "Raises", "------", "InputError"]
    lines += ["    unknown or missing key, wrong type, or value out of range."]
    return "\n".join(lines)


def _default(field: dataclasses.Field[typing.Any]) -> str:
    if field.default is dataclasses.MISSING:
        return ""
    return ", optional" if field.default is None else f", default {field.default!r}"
