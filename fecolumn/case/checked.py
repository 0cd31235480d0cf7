"""Types of what the checks of a case are given: the case itself, and what refuses its keys."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn, Protocol

from fecolumn.case.bodies import Arch
from fecolumn.case.body_keys import Placed
from fecolumn.case.ground import Ground
from fecolumn.case.joint import Joint
from fecolumn.case.link import Link
from fecolumn.case.sections import Contact, Initial, Integration, Material, Motion, Overturn
from fecolumn.foundation.schema import InputError, Section


class Refuse(Protocol):
    """Raises the InputError of a key, of its value and of what it may be instead."""

    def __call__(self, key: str, value: object, allowed: str, /) -> NoReturn:
        """Raise it."""
        ...


def refuse_in(file: Path | str) -> Refuse:
    """What refuses keys of a file."""

    def refuse(key: str, value: object, allowed: str) -> NoReturn:
        raise InputError(file, key, value, allowed)

    return refuse


class CheckedCase(Protocol):
    """Attributes of a Case that its checks read; a Case imports its checks, and not they a Case."""

    @property
    def bodies(self) -> Mapping[str, Placed]:
        """By name."""

    @property
    def materials(self) -> Mapping[str, Material]:
        """By name."""

    @property
    def joints(self) -> Mapping[str, Joint]:
        """By name."""

    @property
    def links(self) -> Mapping[str, Link]:
        """By name."""

    @property
    def initial(self) -> Mapping[str, Initial]:
        """By the name of a body."""

    @property
    def grounds(self) -> Mapping[str, Ground]:
        """By name."""

    @property
    def arches(self) -> Mapping[str, Arch]:
        """By name."""

    @property
    def own(self) -> Mapping[str, Section]:
        """Table of a rocking model by its name."""

    @property
    def contact(self) -> Contact:
        """Of all joints."""

    @property
    def integration(self) -> Integration:
        """Engine and step."""

    @property
    def overturn(self) -> Overturn:
        """What counts as overturned."""

    @property
    def motion(self) -> Motion | None:
        """None for a ground at rest."""

    @property
    def found(self) -> tuple[tuple[str, int], ...]:
        """As of Case."""

    def copies_of(self, name: str, /) -> tuple[tuple[str, int], ...]:
        """As of Case."""

    def names_of(self, name: str, /) -> tuple[str, ...]:
        """As of Case."""

    def is_held(self, name: str, /) -> bool:
        """As of Case."""

    def modes_of(self, body: str, /) -> int:
        """As of Case."""

    @property
    def observed(self) -> str:
        """Name of a body."""
