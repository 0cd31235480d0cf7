"""Sections of a case from TOML tables."""

from __future__ import annotations

import dataclasses
import typing
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fecolumn.case.arch import with_voussoirs, without_voussoirs
from fecolumn.case.bodies import BODY_KINDS
from fecolumn.case.case_tables import COMMON, NAMED
from fecolumn.case.given import by_two_bodies, check_name, with_files
from fecolumn.case.ground import GROUND_NAME, Ground
from fecolumn.case.joint import Joint
from fecolumn.case.sections import (
    located,
)
from fecolumn.case.short_form import full_tables, in_short_form, short_form
from fecolumn.foundation.deprecated import warn_of_older_name
from fecolumn.foundation.schema import InputError, Section, build, meant
from fecolumn.foundation.toml_file import stated

_Made = typing.TypeVar("_Made")
# Fields of a Case, and how messages call its keys and ranges
_Read = tuple[dict[str, Any], Callable[[str], str]]


def fields_of_tables(tables: dict[str, Any], file: Path | str) -> _Read:
    """Fields of the Case of TOML tables, and how messages call its keys and ranges; relative paths
    are taken from the folder of `file`.

    Raises
    ------
    InputError
        every unknown or missing key, wrong type and value out of range, told at once.
    """
    if {"case", "axes"} <= set(tables):
        raise InputError(file, "", None, "is a study, not a case: fecolumn study")
    if "column" in tables and "bodies" in tables:
        raise InputError(
            file,
            "bodies",
            None,
            "stands beside [column], the short form of a case of one body; describe the column in "
            "[bodies], too: fecolumn show writes it so",
        )
    if "column" in tables:
        return _of_short_form(tables, file)
    if "interfaces" in tables:
        return _of_interfaces(tables, file)
    tables = stated(tables)
    errors: list[InputError] = []
    found: dict[str, Any] = {}
    if not tables.get("grounds"):
        tables = tables | {"grounds": {GROUND_NAME: {}}}
    grounds = set(tables["grounds"]) if isinstance(tables["grounds"], dict) else {GROUND_NAME}
    for key in tables:
        if key not in NAMED and key not in COMMON and key not in ("title", "observed"):
            errors.append(
                InputError(
                    file,
                    key,
                    None,
                    f"says nothing of a structure of [bodies]{meant(key, [*NAMED, *COMMON])}; "
                    f"its tables: {', '.join([*NAMED, *COMMON])}",
                )
            )
    bodies, own = without_voussoirs(tables.get("bodies", {}))
    tables = tables | {"bodies": bodies}
    for name, kind in NAMED.items():
        found[name] = _named(name, kind, tables.get(name, {}), grounds, file, errors)
    for name, kind in COMMON.items():
        table = tables.get(name, False)
        try:
            if name != "motion" or table is not False:
                found[name] = located(
                    name, build(kind, {} if table is False else table, file, f"{name}."), file
                )
        except InputError as error:
            errors.append(error)
    for key in ("title", "observed"):
        found[key] = tables.get(key, "")
        if not isinstance(found[key], str):
            errors.append(InputError(file, key, found[key], "must be text in quotes"))
    try:
        found["bodies"], found["arches"] = with_voussoirs(found["bodies"], own, file)
    except InputError as error:
        errors.append(error)
    if errors:
        raise InputError.of_several(errors)
    return found, str


def _of_short_form(tables: dict[str, Any], file: Path | str) -> _Read:
    """As `fields_of_tables`, of tables with [column]; messages name the keys of the short form."""
    form = short_form(tables, file)
    found, _ = told_of(file, lambda: fields_of_tables(full_tables(form), file), in_short_form)
    return found | {"short": form}, in_short_form


def _of_interfaces(tables: dict[str, Any], file: Path | str) -> _Read:
    """As `fields_of_tables`, of tables with [interfaces], the name of [joints] in earlier versions,
    by which messages call them.
    """
    older, joints = tables["interfaces"], tables.get("joints", {})
    if not isinstance(older, dict) or not isinstance(joints, dict):
        raise InputError(file, "joints", joints or older, "must hold tables by name")
    if twice := set(joints) & set(older):
        key = f"joints.{min(twice)}"
        raise InputError(file, key, None, "stands in [interfaces], too: give it once")
    warn_of_older_name(str(file), "[interfaces]", "[joints]")
    others = {name: table for name, table in tables.items() if name != "interfaces"}

    def named(text: str) -> str:
        for name in older:
            text = text.replace(f"joints.{name}", f"interfaces.{name}")
        return text

    found, _ = told_of(
        file, lambda: fields_of_tables(others | {"joints": older | joints}, file), named
    )
    return found, named


def told_of(file: Path | str, made: Callable[[], _Made], named: Callable[[str], str]) -> _Made:
    """What `made` returns; its errors are told of `file`, with keys and ranges as `named` says."""
    try:
        return made()
    except InputError as error:
        raise InputError.of_several(
            [InputError(file, named(one.key), one.value, named(one.allowed)) for one in error.all]
        ) from None


def _named(
    name: str,
    kind: type[Section],
    tables: object,
    grounds: set[str],
    file: Path | str,
    errors: list[InputError],
) -> dict[str, Section]:
    """Sections by name of one table of tables; grounds: names that no body can have."""
    if not isinstance(tables, dict):
        errors.append(
            InputError(file, name, tables, f"must hold tables by name, such as [{name}.NAME]")
        )
        return {}
    found: dict[str, Section] = {}
    for key, table in tables.items():
        if table is False:
            continue
        try:
            if not isinstance(table, dict):
                raise InputError(
                    file, f"{name}.{key}", table, f"must be a table [{name}.NAME] of keys"
                )
            check_name(name, key, tables, grounds, file)
            section = _built(_kind_of(name, key, table, kind, file), table, file, f"{name}.{key}.")
            if isinstance(section, Joint):
                section = by_two_bodies(section, grounds, file, f"{name}.{key}.")
            found[key] = section
        except InputError as error:
            errors.append(error)
    return found


def _kind_of(
    name: str, key: str, table: dict[str, Any], kind: type[Section], file: Path | str
) -> type[Section]:
    """Class of a section: of a body that of its kind."""
    if name != "bodies":
        return kind
    word = table.get("kind")
    if not isinstance(word, str) or word not in BODY_KINDS:
        raise InputError(
            file,
            f"{name}.{key}.kind",
            word,
            f"{'missing; ' if word is None else ''}must be one of {', '.join(BODY_KINDS)}",
        )
    return BODY_KINDS[word]


def _built(kind: type[Section], table: dict[str, Any], file: Path | str, prefix: str) -> Section:
    """A section with its relative paths taken from the folder of `file`."""
    section: Section = build(kind, table, file, prefix)
    if isinstance(section, Ground) and section.motion:
        return dataclasses.replace(section, motion=located("motion", section.motion, file))
    return with_files(section, file, prefix)
