"""Typed, validated sections of a TOML file: every key knows its unit, its range and its meaning."""

from __future__ import annotations

import dataclasses
import difflib
import functools
import math
import numbers
import re
import reprlib
import types
import typing
from collections.abc import Iterable, Mapping
from pathlib import Path

_LONGEST_WORDS = 800  # of a message, in one of its parts
# Magnitude of a number that is not 0: its fifth power, an inertia of a length, is still a number
_LEAST = 1e-60
_LONGEST_TEXT = 4096  # a path's most on Linux


class InputError(ValueError):
    """What a user gave cannot be used; the message names file, key, value and the allowed range.

    Attributes
    ----------
    file, key, value, allowed
        of the first thing that is wrong. all: one InputError for each, in the order of the
        message's lines.
    """

    def __init__(self, file: Path | str, key: str, value: object, allowed: str) -> None:
        self.file, self.key, self.value, self.allowed = (
            in_text(str(file)),
            key,
            value,
            in_text(allowed),
        )
        equals = f" = {shown(value)}" if value is not None else ""
        self.all: tuple[InputError, ...] = (self,)
        super().__init__(
            f"{self.file}: {in_text(key)}{equals}: {self.allowed}"
            if key
            else f"{self.file}: {self.allowed}"
        )

    @classmethod
    def of_several(cls, errors: list[InputError]) -> InputError:
        """One error that tells of all, a line each."""
        first = errors[0]
        error = cls(first.file, first.key, first.value, first.allowed)
        error.all = tuple(one for several in errors for one in several.all)
        error.args = (
            "\n".join(str(one) for one in error.all) if len(error.all) > 1 else str(first),
        )
        return error


class _Shown(reprlib.Repr):
    """Values for messages: long ones shortened."""

    def __init__(self) -> None:
        super().__init__()
        self.maxstring = self.maxother = 300
        self.maxlist = self.maxtuple = 12
        self.maxdict, self.maxlevel = 6, 4

    def repr_int(self, value: int, level: int) -> str:
        if value.bit_length() < 200:
            return repr(value)
        # Python writes no more than 4300 digits
        return f"{'-' if value < 0 else ''}1e{round(value.bit_length() * math.log10(2))} or so"


_repr = _Shown().repr


def shown(value: object) -> str:
    """A value as Python writes it, in one line; long ones shortened."""
    return re.sub(r"\s*\n\s*", " ", _repr(value))


def in_text(words: str) -> str:
    """Words without line breaks and other control characters, so that a message stays one line;
    shortened where very long.
    """
    words = re.sub(r"[\x00-\x1f\x7f\ud800-\udfff]", lambda found: repr(found[0])[1:-1], words)
    return (
        words
        if len(words) <= _LONGEST_WORDS
        else f"{words[: _LONGEST_WORDS // 2]} ... {words[-_LONGEST_WORDS // 2 :]}"
    )


class Rules(typing.TypedDict, total=False):
    """What the value of a key must be, and what the key is for.

    Attributes
    ----------
    low, high
        closed bounds of a number.
    above
        open lower bound of a number.
    choices
        the words a text key may take.
    words
        words that a number's key takes in place of a number.
    since
        version that brought a key younger than its section; at its default it is no part of
        `Case.id`, so that older results keep their names.
    counts
        whether the key makes another analysis; False for what only guards or tells.
    """

    low: float | None
    high: float | None
    above: float | None
    choices: typing.Sequence[str] | None
    words: typing.Sequence[str]
    since: str
    counts: bool


_NO_RULES = dict(low=None, high=None, above=None, choices=None, words=(), since="", counts=True)


def parameter(
    default: object = dataclasses.MISSING,
    *,
    doc: str,
    unit: str = "-",
    **rules: typing.Unpack[Rules],
) -> typing.Any:
    """Dataclass field of a case section.

    Parameters
    ----------
    default
        value when the key is absent; without one the key is required.
    doc
        meaning of the key, shown in error messages.
    unit
        physical unit, "-" when dimensionless.
    rules
        what a value must be.
    """
    metadata = _NO_RULES | rules | dict(doc=doc, unit=unit)
    if isinstance(default, (list, dict)):
        raise TypeError("defaults must be immutable")
    return dataclasses.field(default=default, metadata=metadata)


def required(*, doc: str, unit: str = "-", **rules: typing.Unpack[Rules]) -> typing.Any:
    """As `parameter`, of a key that has no default; by this name type checkers know it."""
    return parameter(doc=doc, unit=unit, **rules)


def allowed_range(metadata: Mapping[str, typing.Any]) -> str:
    """The allowed values of a parameter in words, with the unit."""
    return " or ".join([_number_range(metadata), *(f'"{word}"' for word in metadata["words"])])


def wanted(kind: typing.Any, metadata: Mapping[str, typing.Any]) -> str:
    """As `allowed_range`, of a key of this type: of text, switches and lists, too."""
    kinds = [one for one in typing.get_args(kind) if one is not types.NoneType]
    kind = kinds[0] if isinstance(kind, types.UnionType) else kind
    if kind not in (float, int):
        if not any(metadata[rule] not in (None, ()) for rule in ("choices", "low", "above")):
            return _type_in_words(kind, metadata)
    return allowed_range(metadata)


def _type_in_words(kind: typing.Any, metadata: Mapping[str, typing.Any]) -> str:
    words = " or ".join([_word(kind), *(f'"{text}"' for text in metadata["words"])])
    return f"must be {words}"


def _word(kind: typing.Any) -> str:
    return _WORDS.get(kind) or "a list of " + _ITEMS.get(
        typing.get_args(kind)[0], "lists of numbers"
    )


def _number_range(metadata: Mapping[str, typing.Any]) -> str:
    unit = "" if metadata["unit"] == "-" else f" [{metadata['unit']}]"
    if metadata["choices"]:
        return "must be one of " + ", ".join(filter(None, metadata["choices"]))
    if metadata["above"] is not None:
        upper = f" and at most {metadata['high']:g}" if metadata["high"] is not None else ""
        return f"must be greater than {metadata['above']:g}{upper}{unit}"
    if metadata["low"] is not None and metadata["high"] is not None:
        return f"must lie in [{metadata['low']:g}, {metadata['high']:g}]{unit}"
    if metadata["low"] is not None:
        return f"must be at least {metadata['low']:g}{unit}"
    return f"must be a number{unit}"


def _typed(kind: typing.Any, value: typing.Any) -> typing.Any:
    """`value` as `kind`, or None where the TOML type does not fit."""
    if kind is float and isinstance(value, numbers.Real) and not isinstance(value, bool):
        try:
            return float(value)
        except OverflowError:
            return -math.inf if value < 0 else math.inf
    if kind is int and isinstance(value, numbers.Integral) and not isinstance(value, bool):
        return int(value)
    if kind in (str, bool) and isinstance(value, kind):
        return value
    if typing.get_origin(kind) is tuple and isinstance(value, (list, tuple)):
        items = [_typed(typing.get_args(kind)[0], item) for item in value]
        return None if None in items else tuple(items)
    return None


def _items(typed: typing.Any) -> tuple[typing.Any, ...]:
    """Single values of a key, those of lists of lists, too."""
    if not isinstance(typed, tuple):
        return (typed,)
    return tuple(item for inner in typed for item in _items(inner))


_WORDS = {float: "a number", int: "a whole number", str: "text in quotes", bool: "true or false"}
_ITEMS = {str: "texts", float: "numbers", int: "whole numbers"}


def _checked(
    kind: typing.Any,
    metadata: Mapping[str, typing.Any],
    value: typing.Any,
    file: Path | str,
    key: str,
) -> typing.Any:
    """`value` as the type of a key.

    Raises
    ------
    InputError
        wrong type, or out of range.
    """
    if isinstance(kind, types.UnionType):
        if value is None and types.NoneType in typing.get_args(kind):
            return None
        kind = next(k for k in typing.get_args(kind) if k is not types.NoneType)
    if isinstance(value, str) and value in metadata["words"]:
        return value
    typed = _typed(kind, value)
    if typed is None:
        told = f"{_type_in_words(kind, metadata)}; {metadata['doc']}"
        raise InputError(file, key, value, told)
    for item in _items(typed):
        bad = False
        if isinstance(item, (int, float)) and not isinstance(item, bool):
            bad = (
                (isinstance(item, float) and not math.isfinite(item))
                or (metadata["low"] is not None and item < metadata["low"])
                or (metadata["high"] is not None and item > metadata["high"])
                or (metadata["above"] is not None and item <= metadata["above"])
            )
        if metadata["choices"] and item not in metadata["choices"]:
            bad = True
        if isinstance(item, float) and 0 < abs(item) < _LEAST:
            allowed = f"{allowed_range(metadata)}, and {_LEAST:g} in magnitude unless it is 0"
            raise InputError(file, key, value, f"{allowed}; {metadata['doc']}")
        if bad:
            raise InputError(file, key, value, f"{allowed_range(metadata)}; {metadata['doc']}")
        if isinstance(item, str) and (
            len(item) > _LONGEST_TEXT or re.search(r"[\x00-\x08\x0b-\x1f\x7f]", item)
        ):
            raise InputError(
                file,
                key,
                value,
                f"must be text of at most {_LONGEST_TEXT} characters, without control "
                f"characters; {metadata['doc']}",
            )
    return typed


@functools.cache
def _kinds(section: type) -> dict[str, tuple[typing.Any, ...]]:
    """Fields of a dataclass by name: (field, type, dataclass of a section or None, whether the
    section may be absent).
    """
    hints, kinds = typing.get_type_hints(section), {}
    for field in dataclasses.fields(section):
        kind = hints[field.name]
        inner = next(
            (k for k in (kind, *typing.get_args(kind)) if dataclasses.is_dataclass(k)), None
        )
        kinds[field.name] = field, kind, inner, isinstance(kind, types.UnionType)
    return kinds


def section_name(section: type) -> str:
    """Name of a section in messages, "" of a whole case: its SECTION, or that of its class.

    The table of a FrameModel is [frame], of a WobblingFrameModel [wobbling_frame].
    """
    words = re.findall("[A-Z][a-z]*", section.__name__.removesuffix("Model"))
    return getattr(section, "SECTION", "_".join(words).lower())


class Section:
    """Base of a case and its sections: none can be made, or made of another by
    `dataclasses.replace`, with a value out of range.
    """

    __slots__ = ()

    if typing.TYPE_CHECKING:  # every section is made a dataclass
        __dataclass_fields__: typing.ClassVar[dict[str, dataclasses.Field[typing.Any]]]

    @classmethod
    def _by_newer_names(
        cls, keys: dict[str, typing.Any], file: Path | str, prefix: str
    ) -> dict[str, typing.Any]:
        """Keys of a file or a script by their names in this version; a section that had others
        says so.
        """
        return keys

    def __repr__(self) -> str:
        """The keys that are not at their defaults, as they are given."""
        given = (
            f"{name}={value!r}"
            for name, (field, *_) in _kinds(type(self)).items()  # type: ignore[arg-type]
            if (value := getattr(self, name)) != field.default
        )
        return f"{type(self).__name__}({', '.join(given)})"

    def __post_init__(self) -> None:
        """Check every key, and turn numbers into the key's own type.

        Raises
        ------
        InputError
            names section, key, value and range.
        """
        name = section_name(type(self))
        prefix, errors = f"{name}." if name else "", []
        kinds = _kinds(type(self))  # type: ignore[arg-type]  # a class is hashable as such
        for key, (field, kind, inner, optional) in kinds.items():
            value = getattr(self, key)
            try:
                if inner is None:
                    object.__setattr__(
                        self, key, _checked(kind, field.metadata, value, "case", prefix + key)
                    )
                elif not (isinstance(value, inner) or (optional and value is None)):
                    raise InputError(
                        "case",
                        prefix + key,
                        value,
                        f"must be {a_section(inner)}" + (" or None" if optional else ""),
                    )
            except InputError as error:
                errors.append(error)
        if errors:
            raise InputError.of_several(errors)


def parameter_of(section: type[Section], key: str) -> dataclasses.Field[typing.Any]:
    """The key of a section, with its default and, as `metadata`, its Rules."""
    return next(one for one in dataclasses.fields(section) if one.name == key)


def a_section(cls: type[Section]) -> str:
    """What a script has to give: "a Joint(...)", "an Integration(...)"."""
    name = cls.__name__
    return f"{'an' if name[0] in 'AEIO' else 'a'} {name}(...)"


def build(section: type, table: typing.Any, file: Path | str, prefix: str = "") -> typing.Any:
    """Instance of the dataclass `section` from a TOML table, every key checked; a section that is
    `false` is as if it were absent.

    Raises
    ------
    InputError
        every unknown or missing key, wrong type and value out of range, told at once.
    """
    if not isinstance(table, dict):
        raise InputError(file, prefix.rstrip("."), table, "must be a table of keys")
    if issubclass(section, Section):
        table = section._by_newer_names(table, file, prefix)
    kinds, errors, values = _kinds(section), [], {}
    for key, value in table.items():
        if key not in kinds:
            hint = meant(key, kinds, prefix) or f"; known keys: {', '.join(kinds)}"
            errors.append(
                InputError(
                    file,
                    prefix + key,
                    None if isinstance(value, dict) else value,
                    "unknown key" + hint,
                )
            )
    for name, (field, kind, inner, optional) in kinds.items():
        try:
            if inner is not None:
                if table.get(name, False) is not False:
                    values[name] = build(inner, table[name], file, f"{prefix}{name}.")
                elif not optional:
                    values[name] = build(inner, {}, file, f"{prefix}{name}.")
            elif name in table:
                values[name] = _checked(kind, field.metadata, table[name], file, prefix + name)
            elif field.default is dataclasses.MISSING:
                raise InputError(
                    file,
                    prefix + name,
                    None,
                    f"missing; {field.metadata['doc']}, {wanted(kind, field.metadata)}",
                )
        except InputError as error:
            errors.append(error)
    if errors:
        raise InputError.of_several(errors)
    return section(**values)


def table_of(section: typing.Any, defaults: bool) -> dict[str, typing.Any]:
    """The table of a section: without keys that are left open, or that are not stated as they
    stand at their `defaults`.
    """
    found = {}
    for one in dataclasses.fields(section):
        value = getattr(section, one.name)
        if value is None or not defaults and one.name != "kind" and value == one.default:
            continue
        found[one.name] = table_of(value, defaults) if dataclasses.is_dataclass(value) else value
    return found


def meant(name: str, known: Iterable[str], prefix: str = "") -> str:
    """The end of a message on an unknown name: "; did you mean ...?" with the nearest of the known
    ones, "" where none is near: of those that begin with its words, such as friction_coefficient
    for friction, else of those that are spelt alike.
    """
    known = list(known)
    begun = [one for one in known if one.startswith(f"{name}_")]
    near = difflib.get_close_matches(name, begun or known, 1, 0.0 if begun else 0.6)
    return f"; did you mean {prefix}{near[0]}?" if near else ""
