"""`fecolumn keys`: every key of a case, of a study and of a rocking model, with meaning, unit,
range and default, as the schema declares them.
"""

from __future__ import annotations

import argparse
import dataclasses
import difflib
import re
import textwrap
import types
import typing
from collections.abc import Container, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fecolumn.foundation.schema import InputError, Section, allowed_range

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_WIDTH = 118
_TABLES = {dict: "table", list: "list of tables"}


@dataclass(frozen=True, slots=True)
class Key:
    """A key as a user reads it: name, unit ("" where it has none), allowed values, default,
    meaning, all in words.
    """

    name: str
    unit: str
    allowed: str
    default: str
    meaning: str


@dataclass(frozen=True, slots=True)
class Table:
    """The keys of one table of a TOML file; name: as it stands in brackets, "" for the top of the
    file.
    """

    name: str
    meaning: str
    keys: tuple[Key, ...]
    of: str

    @property
    def heading(self) -> str:
        """Its line above the keys."""
        return f"[{self.name}]" if self.name else f"top of a {self.of} file"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Arguments of `fecolumn keys`."""
    parser.add_argument(
        "section",
        nargs="?",
        default="",
        metavar="SECTION",
        help="print only this table, such as contact or study, or this key, such as contact.law",
    )
    parser.add_argument("--markdown", action="store_true", help="print tables in Markdown")


def main(args: argparse.Namespace) -> int:
    """Print the keys; returns 0.

    Raises
    ------
    InputError
        no table and no key of that name.
    """
    found = chosen(args.section.strip("[]"))
    print(markdown(found) if args.markdown else text(found))
    return 0


def tables() -> list[Table]:
    """Every table of a case file, of a study file and of a rocking model."""
    from fecolumn.case.sections import OUTPUT_OF_ONE
    from fecolumn.case.short_form import ShortForm
    from fecolumn.study.keys import LatinHypercube, StudyKeys
    from fecolumn.study.plan import DEFAULTS

    extends = Key(
        "extends",
        "",
        "path",
        "none",
        "another file, read first; keys in this file take the place of its keys",
    )
    sections = {
        name: inner
        for name, kind in typing.get_type_hints(ShortForm).items()
        for inner in (kind, *typing.get_args(kind))
        if isinstance(inner, type) and dataclasses.is_dataclass(inner)
    }
    found = [Table("", _sentence(ShortForm), (extends, *_keys(ShortForm, skip=sections)), "case")]
    for field in dataclasses.fields(ShortForm):
        if field.name in sections:
            absent = "" if field.default is dataclasses.MISSING else " The table may be left out."
            kind = sections[field.name]
            found.append(
                Table(
                    field.name,
                    _sentence(kind) + absent,
                    _keys(kind, DEFAULTS.get(field.name, {}), of_one=OUTPUT_OF_ONE),
                    "case",
                )
            )
    from fecolumn.case.model_sections import SECTIONS

    return [
        *found,
        *_of_structures(),
        Table("", _sentence(StudyKeys), (extends, *_keys(StudyKeys)), "study"),
        Table("latin_hypercube", _sentence(LatinHypercube), _keys(LatinHypercube), "study"),
        *(
            Table(name, _sentence(section), _keys(section), "model")
            for name, section in SECTIONS.items()
        ),
    ]


def _of_structures() -> list[Table]:
    """Tables of a structure's case beside those that it has in common with a column's."""
    from fecolumn.case.bodies import BODY_KINDS, Footed
    from fecolumn.case.body_keys import Placed, Solid, WithMaterial
    from fecolumn.case.ground import Ground
    from fecolumn.case.joint import Joint
    from fecolumn.case.link import Link
    from fecolumn.case.mesh_limits import MeshLimits
    from fecolumn.case.sections import Cap, Flange, Initial, Material, Motion

    def own(kind: type[Section]) -> Table:
        return Table(
            "bodies.NAME",
            _sentence(kind),
            tuple(
                key
                for key in _keys(kind, skip=("flange", "cap"))
                if key.name in kind.__annotations__
            ),
            "structure",
        )

    top = Key(
        "observed",
        "",
        "text",
        "none",
        'body, or "BODY.MARK" such as "building.floor 2", whose displacement is u_top; left out: '
        "the top of the highest body",
    )
    kinds: list[type[Placed]] = [Placed, WithMaterial, Solid, Footed]
    bodies = [own(kind) for kind in [*kinds, *dict.fromkeys(BODY_KINDS.values())]]
    others = {
        "bodies.NAME.flange": Flange,
        "bodies.NAME.cap": Cap,
        "materials.NAME": Material,
        "grounds.NAME": Ground,
        "grounds.NAME.motion": Motion,
        "joints.NAME": Joint,
        "links.NAME": Link,
        "initial.NAME": Initial,
        "mesh": MeshLimits,
    }
    return [
        Table(
            "",
            "A structure of bodies: the tables below, and [contact], [integration], [motion], "
            "[overturn], [output] as above.",
            (top,),
            "structure",
        ),
        *bodies,
        *(
            Table(name, _sentence(kind), _keys(kind, skip=("motion",)), "structure")
            for name, kind in others.items()
        ),
    ]


def chosen(name: str) -> list[Table]:
    """All tables, those of one name ("case" and "study" are the tops of these files), or one key of
    a table.

    Raises
    ------
    InputError
        neither table nor key.
    """
    found = tables()
    if not name:
        return found
    whole = [
        table
        for table in found
        if name in (table.name, table.name or table.of)
        or table.name.startswith(f"{name}.")
        or (name in ("study", "structure") and table.of == name)
    ]
    if whole:
        return whole
    section, _, last = name.rpartition(".")
    one = [
        dataclasses.replace(table, keys=tuple(key for key in table.keys if key.name == last))
        for table in found
        if not section or section == table.name
    ]
    if one := [table for table in one if table.keys]:
        return one
    known = [
        word
        for table in found
        for word in (table.name or table.of, *(f"{table.name}.{key.name}" for key in table.keys))
    ]
    near = difflib.get_close_matches(name, known, 1, 0.5)
    hint = f"did you mean {near[0]}?" if near else ""
    raise InputError(
        "fecolumn keys",
        "SECTION",
        name,
        hint
        or f"must be one of {', '.join(dict.fromkeys(t.name or t.of for t in found))}, or "
        "a key of these",
    )


def text(found: list[Table]) -> str:
    """Tables for a terminal."""
    parts = []
    for table in found:
        parts.append(
            textwrap.fill(f"{table.heading}  {table.meaning}", _WIDTH, subsequent_indent="    ")
        )
        for key in table.keys:
            unit = f" [{key.unit}]" if key.unit else ""
            default = key.default if key.default == "required" else f"default {key.default}"
            parts.append(f"  {key.name + unit}: {key.allowed}; {default}")
            parts.append(
                textwrap.fill(
                    key.meaning, _WIDTH, initial_indent="      ", subsequent_indent="      "
                )
            )
        parts.append("")
    return "\n".join(parts).rstrip()


def markdown(found: list[Table]) -> str:
    """Tables in Markdown."""
    parts = []
    for table in found:
        parts += [
            f"## {table.heading}\n",
            f"{table.meaning}\n",
            "| key | unit | allowed | default | meaning |",
            "|---|---|---|---|---|",
        ]
        for key in table.keys:
            cells = (
                f"`{key.name}`",
                key.unit or "-",
                key.allowed,
                f"`{key.default}`" if key.default != "required" else "**required**",
                key.meaning,
            )
            parts.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
        parts.append("")
    return "\n".join(parts).rstrip()


def _sentence(section: type) -> str:
    return " ".join(str(section.__doc__).split("\n\n")[0].split())


def _keys(
    section: type[DataclassInstance],
    of_study: Mapping[str, Any] | None = None,
    skip: Container[str] = (),
    of_one: Mapping[str, Any] | None = None,
) -> tuple[Key, ...]:
    """Keys of a section; of_study, of_one: what a study or one analysis takes where they are left
    open.
    """
    hints = typing.get_type_hints(section)
    return tuple(
        _key(
            field,
            hints[field.name],
            (of_one or {}).get(field.name, field.default),
            (of_study or {}).get(field.name),
        )
        for field in dataclasses.fields(section)
        if field.name not in skip
    )


def _key(field: dataclasses.Field[Any], kind: object, taken: object, of_study: object) -> Key:
    default = _shown(taken) + (f" (in a study {_shown(of_study)})" if of_study is not None else "")
    unit = field.metadata["unit"]
    return Key(
        field.name,
        "" if unit == "-" else unit,
        _allowed(field.metadata, kind),
        default,
        field.metadata["doc"],
    )


def _allowed(metadata: types.MappingProxyType[str, Any], kind: object) -> str:
    """The allowed values, with the kind of value where they have no bounds."""
    kinds = [
        inner
        for inner in (typing.get_args(kind) if isinstance(kind, types.UnionType) else (kind,))
        if inner is not types.NoneType
    ]
    if bool in kinds:
        return "true or false"
    if table := _TABLES.get(typing.get_origin(kinds[0]) or kinds[0]):
        return table
    if kinds == [str] and not metadata["choices"]:
        return "text"
    if typing.get_origin(kinds[0]) is tuple and typing.get_args(kinds[0])[0] is str:
        return " or ".join(["list of texts", *(f'"{word}"' for word in metadata["words"])])
    words = allowed_range(metadata | {"unit": "-"})
    if kinds == [int]:  # as it is typed
        words = re.sub(r"[\d.]+e\+?\d+", lambda number: f"{float(number[0]):.0f}", words)
    words = words.removeprefix("must be ").removeprefix("must lie ")
    if typing.get_origin(kinds[0]) is tuple:
        return f"list, each {words}"
    return f"whole number, {words}" if kinds == [int] else words


def _shown(value: object) -> str:
    if value is dataclasses.MISSING:
        return "required"
    if value is None:
        return "derived"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return value or "none"
    if isinstance(value, tuple):
        return f"[{', '.join(map(_shown, value))}]"
    return f"{value:g}" if isinstance(value, float) else str(value)
