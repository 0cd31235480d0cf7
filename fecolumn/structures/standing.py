"""Bodies as they stand upright, and what each stands on."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Hashable, Iterable, Iterator, Sequence
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY, Initial
from fecolumn.contact.points import GROUND
from fecolumn.structures.faces import over
from fecolumn.structures.model import BodyModel, JointModel, StructureModel

T = TypeVar("T", bound=Hashable)
# Vertical part of a face's normal below which it carries nothing
_LEVEL = 1e-9
# What touches in each joint, by its identity, within `remembered`; None elsewhere
_known: ContextVar[dict[int, NDArray[Any]] | None] = ContextVar("touching", default=None)
#: What a part stands on, GROUND or the places of parts, each with the joints between.
Supports = list[tuple[int, list[JointModel]]]


@dataclass(frozen=True)
class Standing:
    """A part before it is moved: model, place (3,) [m] of its centre of mass upright, its start as
    of `case.Initial` or None, held: place of the ground that holds it, -1 of one that is free.
    """

    name: str
    model: BodyModel
    center: NDArray[Any]
    start: Initial | None
    held: int = -1


def as_standing(structure: StructureModel) -> list[Standing]:
    """The parts of a structure where they are, without a start."""
    return [
        Standing(part.name, part.model, part.center, None, part.held) for part in structure.parts
    ]


def touching(standing: Sequence[Standing], joint: JointModel) -> NDArray[Any]:
    """Rows among the nodes of a joint's slave surface (k,) that have the master below them as the
    bodies stand.
    """
    slave = standing[joint.slave]
    surface = slave.model.surfaces[joint.slave_surface]
    if joint.master == GROUND or joint.master_surface is None:
        return np.arange(len(surface.nodes))
    master = standing[joint.master]
    known = _known.get()
    if known is not None and id(joint) in known:
        return known[id(joint)]
    face = master.model.surfaces[joint.master_surface]
    corners = face.plane(master.model.arms[face.nodes])[:, :2]
    points = face.plane(slave.center + slave.model.arms[surface.nodes] - master.center)[:, :2]
    rows = np.flatnonzero(
        over(points, corners[face.triangles], 1e-9 * np.ptp(corners, axis=0).max())
    )
    if known is not None:
        known[id(joint)] = rows
    return rows


@contextlib.contextmanager
def remembered() -> Iterator[None]:
    """Within it `touching` finds the rows of a joint once: for one list of joints, whose bodies
    have the same models and upright places throughout.
    """
    token = _known.set({})
    try:
        yield
    finally:
        _known.reset(token)


def supports_of(standing: Sequence[Standing], joints: Iterable[JointModel]) -> list[Supports]:
    """Of each part what it stands on, GROUND or a part, and the joints between; a fixed part stands
    by itself, and across a gap nothing stands on anything.
    """
    found: list[dict[int, list[JointModel]]] = [{} for _ in standing]
    for joint in joints:
        down = standing[joint.slave].model.surfaces[joint.slave_surface].normal[2]
        upper = joint.slave if down < 0 else joint.master
        if joint.gap or upper != GROUND and standing[upper].held >= 0:
            continue
        if down < -_LEVEL:
            found[joint.slave].setdefault(joint.master, []).append(joint)
        elif down > _LEVEL and joint.master != GROUND:
            found[joint.master].setdefault(joint.slave, []).append(joint)
    return [list(one.items()) for one in found]


def joined_to(held: Iterable[T], pairs: Collection[tuple[T, T]]) -> set[T]:
    """What is held, and all that pairs join to it, one by another."""
    found = set(held)
    while more := {one for pair in pairs if not found.isdisjoint(pair) for one in pair} - found:
        found |= more
    return found


def loads(standing: Sequence[Standing], joints: Sequence[JointModel]) -> list[float]:
    """Force [N] that each joint carries at rest: what a part and all on it weigh, in equal shares
    on what it stands on.
    """
    supports, carried = (
        supports_of(standing, joints),
        [part.model.mass * GRAVITY for part in standing],
    )
    found = {id(joint): 0.0 for joint in joints}
    for place in reversed(from_below(supports)):
        for below, between in supports[place]:
            share = carried[place] / len(supports[place])
            found |= {id(joint): share for joint in between}
            if below != GROUND:
                carried[below] += share
    return [found[id(joint)] for joint in joints]


def dome_load(standing: Sequence[Standing], joint: JointModel, load: float) -> float:
    """Force [N] about which the compliance of a dome is taken: `load`, what the joint carries at
    rest, or the weight of its own body where that begins above what it will stand on.
    """
    return load or standing[joint.slave].model.mass * GRAVITY


def from_below(supports: list[Supports]) -> list[int]:
    """Places of the parts, each after all that it stands on; those in a circle come last, as they
    are.
    """
    order: list[int] = []
    done = {GROUND}
    left = list(range(len(supports)))
    while left:
        ready = [
            place for place in left if all(below in done for below, _ in supports[place])
        ] or left
        order += ready
        done |= set(ready)
        left = [place for place in left if place not in done]
    return order
