"""Sections that a script gives, brought into the form of those of a file: names, joints, arches."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from fecolumn.case.arch import with_voussoirs
from fecolumn.case.bodies import Arch
from fecolumn.case.body_keys import Placed
from fecolumn.case.checked import CheckedCase
from fecolumn.case.ground import Ground
from fecolumn.case.joint import Joint
from fecolumn.case.link import Link
from fecolumn.case.sections import located
from fecolumn.foundation.files import is_file
from fecolumn.foundation.paths import OF_BODIES, absolute
from fecolumn.foundation.schema import InputError, Section, a_section

_Body = TypeVar("_Body", bound=Section)
# Of a voussoir a table of keys
_Given = Section | dict[str, Any]

# Characters of a name that stand for something else in dotted keys, and in names of copies and
# marks
_TAKEN = set(".\"'[]/ ")
#: A name with a number, such as "arch 3": a body of several that its first word stands for
NUMBERED = re.compile(r"(\S+) [1-9][0-9]*")
_HERE = "case"


def as_of_file(case: CheckedCase, named: Mapping[str, type[Section]]) -> Mapping[str, object]:
    """The tables of tables of a case as those of a file: joints with a body first, arches by their
    voussoirs, files by their absolute paths.

    Parameters
    ----------
    case
        as its maker gave it.
    named
        class of the sections of each table of tables.

    Raises
    ------
    InputError
        what is no section of the table, is named by a word that cannot be, or has no file.
    """
    errors: list[InputError] = []
    found = {name: _sections(case, name, kind, errors) for name, kind in named.items()}
    if errors:
        raise InputError.of_several(errors)
    if case.own:
        return found | {"grounds": {}}
    grounds = set(found["grounds"])
    for name, given in found.items():
        for key, section in given.items():
            try:
                check_name(name, key, given, grounds, _HERE)
                given[key] = _as_of_file(name, key, section, grounds)
            except InputError as error:
                errors.append(error)
    if errors:
        raise InputError.of_several(errors)
    own = {key: one for key, one in found["bodies"].items() if isinstance(one, dict)}
    bodies = {key: one for key, one in found["bodies"].items() if isinstance(one, Placed)}
    made: dict[str, object] = dict(found)
    if own or any(isinstance(body, Arch) for body in bodies.values()):
        made["bodies"], made["arches"] = with_voussoirs(bodies, own, _HERE)
    if case.motion:
        made["motion"] = located("motion", case.motion, _HERE)
    return made


def _sections(
    case: CheckedCase, name: str, kind: type[Section], errors: list[InputError]
) -> dict[str, _Given]:
    """Sections by name, each of its class."""
    given = getattr(case, name)
    if not hasattr(given, "items"):
        one = "Block" if name == "bodies" else kind.__name__
        told = f'must hold sections by name, such as {{"NAME": {one}(...)}}'
        errors.append(InputError(_HERE, name, given, told))
        return {}
    for key, section in given.items():
        if isinstance(section, kind) or name == "bodies" and _is_of_arch(key, section, given):
            continue
        what = "a body, such as Block(...)" if name == "bodies" else a_section(kind)
        errors.append(InputError(_HERE, f"{name}.{key}", section, f"must be {what}"))
    return dict(given)


def _is_of_arch(key: object, section: object, bodies: Mapping[str, object]) -> bool:
    """Whether it is a table of keys of a voussoir "NAME 3" beside an arch "NAME"."""
    return isinstance(section, dict) and isinstance(bodies.get(str(key).rpartition(" ")[0]), Arch)


def _as_of_file(name: str, key: str, section: _Given, grounds: set[str]) -> _Given:
    if isinstance(section, Joint):
        return by_two_bodies(section, grounds, _HERE, f"{name}.{key}.")
    if isinstance(section, Ground) and section.motion:
        return dataclasses.replace(section, motion=located("motion", section.motion, _HERE))
    if isinstance(section, Link) and type(section) is not Link:  # a Tendon, say
        return Link(**{one.name: getattr(section, one.name) for one in fields(Link)})
    if not isinstance(section, Placed):
        return section
    return with_files(section, _HERE, f"{name}.{key}.")


def with_files(body: _Body, file: Path | str, prefix: str) -> _Body:
    """A body with its relative paths taken from the folder of `file`.

    Raises
    ------
    InputError
        one of its files is not there.
    """
    folder = Path(file).resolve().parent
    found = {}
    for key in OF_BODIES.get(getattr(body, "kind", ""), ()):
        path = getattr(body, key)
        found[key] = absolute(path, folder)
        if not is_file(found[key]):
            raise InputError(file, prefix + key, path, "no such file")
    same = all(getattr(body, key) == path for key, path in found.items())
    return body if same else dataclasses.replace(body, **found)


def check_name(
    name: str, key: object, tables: Mapping[str, object], grounds: set[str], file: Path | str
) -> None:
    """Refuse a name that stands for something else.

    Parameters
    ----------
    name, key
        table of tables, and the name in it.
    tables
        all of that table by their names.
    grounds
        names that no body can have.
    """
    if not isinstance(key, str):
        raise InputError(file, name, key, "names must be text in quotes")
    word = key
    beside = tables.get(key.rpartition(" ")[0])
    if name == "bodies" and (own := NUMBERED.fullmatch(key)):
        word = own[1]
        if word in tables and not isinstance(beside, Arch):
            raise InputError(
                file,
                f"{name}.{key}",
                None,
                f"must be named by another word: {name}.{word} stands beside it, and "
                "NAME means all of NAME 1, NAME 2 ...",
            )
    if name != "initial" and (
        set(word) & _TAKEN or not word or name == "bodies" and word in grounds
    ):
        raise InputError(
            file,
            f"{name}.{key}",
            None,
            "must be named by another word: not that of a ground, without blanks, "
            "dots, slashes and quotes",
        )


def by_two_bodies(joint: Joint, grounds: set[str], file: Path | str, prefix: str) -> Joint:
    """The joint with a body as the first of the two that touch."""
    if len(joint.between) != 2:
        raise InputError(
            file,
            prefix + "between",
            list(joint.between),
            'must be two names, such as ["drum", "capital"]',
        )
    bodies = tuple(sorted(joint.between, key=lambda one: one in grounds))
    if bodies[0] in grounds:
        raise InputError(
            file,
            prefix + "between",
            list(joint.between),
            "must name a body: grounds do not touch one another",
        )
    return dataclasses.replace(joint, between=bodies)
