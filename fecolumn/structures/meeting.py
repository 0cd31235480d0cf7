"""A face of a body on a face of another, or across a gap from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case

#: Over the slave's width: what faces a body across a smaller gap was meant to touch it
MEANT_TO_TOUCH = 0.05
#: Cosine from which faces look at one another, and sine up to which they are parallel
OPPOSITE = 1e-5


@dataclass(frozen=True)
class Meeting:
    """A face of a slave on a face of a master.

    interface: name of it. slave, master: body and number of its copy, master None for the ground.
    slave_face, master_face: places of the faces in the lists of their bodies, master_face -1 of the
    ground. gap: between the faces [m], 0 where they touch.
    """

    interface: str
    slave: tuple[str, int]
    slave_face: int
    master: tuple[str, int] | None
    master_face: int
    gap: float = 0.0


@dataclass(frozen=True)
class Gap:
    """A meeting of faces that look at one another across a gap, below 0 where they overlap [m];
    width: of the slave's face [m], to which a gap is related.
    """

    meeting: Meeting
    gap: float
    width: float

    @property
    def sides(self) -> list[tuple[tuple[str, int] | None, int]]:
        """Copy and face of both bodies, of the slave alone on the ground."""
        one = self.meeting
        found: list[tuple[tuple[str, int] | None, int]]
        found = [(one.slave, one.slave_face), (one.master, one.master_face)]
        return found if one.master else found[:1]


def place_of(case: Case, copy: tuple[str, int]) -> NDArray[Any]:
    """Place (3,) [m] of a copy: where the origin of its drawing is at the start."""
    return np.array(case.bodies[copy[0]].places[copy[1]])
