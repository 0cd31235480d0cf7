"""Motion at t = 0: gravity equilibrium of the standing structure, or a rigid tilt, with velocity
and spin.
"""

from __future__ import annotations

import numpy as np

from fecolumn.contact.points import may_touch
from fecolumn.contact.problem import FAR_BASE, NO_ROOM, OK, near_points
from fecolumn.contact.tolerances import FIRMER_TIMES, LINKS_FIRM, SLIDES_KEPT
from fecolumn.contact.work import move_anchors
from fecolumn.engines.dynamics.gravity import (
    NoEquilibrium,
    iterate_to_rest,
    pseudo_inertia,
)
from fecolumn.engines.dynamics.links import end_links, fastest
from fecolumn.engines.reduced import motion as motions
from fecolumn.engines.reduced.elastic import ACCELERATION, COORDINATE
from fecolumn.engines.reduced.found_of_model import NoRoom
from fecolumn.engines.reduced.model import resting_scheme
from fecolumn.foundation._compiled import interpreted


def gravity_equilibrium(engine) -> motions.MotionState:
    """Gravity equilibrium, by the same proximal steps as the full-order engine: it needs no
    factorisation.

    Raises
    ------
    NoEquilibrium
        no equilibrium, for example of a column whose centre of mass does not stand over its foot.
    """
    structure, centers = engine.structure, engine.view.center
    bodies = structure.bodies.body
    weight = bodies["mass"].sum() * np.linalg.norm(structure.gravity)
    # of a dome the place of contact moves by its radius times the tilt, as far as the centre of
    # mass at that height would
    levers = [
        max(
            np.abs(structure.bodies.arms[body["first"] : body["first"] + body["count"], 2]).max(),
            structure.interfaces["ball"][structure.interfaces["slave"] == b].max(initial=0.0),
        )
        for b, body in enumerate(bodies)
    ]
    firmness = max(
        pseudo_inertia(weight, lever, body["inertia"])
        for body, lever in zip(bodies, levers)
        if body["held"] < 0
    )
    # links answer the motion of a step at once: the motion must not answer them as strongly
    held = [
        (body["mass"], body["inertia"], center, np.eye(3)) for body, center in zip(bodies, centers)
    ]
    firmness = max(
        firmness, LINKS_FIRM * fastest(structure.links, structure.links["stiffness"], held)[0]
    )
    firmest = max(10.0**FIRMER_TIMES * firmness, 2 / engine.hht.dt**2)
    while True:
        try:
            return _settled_with_room(engine, firmness)
        except _Diverged:
            if firmness >= firmest:
                raise
        firmness = min(10 * firmness, firmest)


def _settled_with_room(engine, firmness: float) -> motions.MotionState:
    """As `_settled`, with room for as many pairs of bodies as are near each other."""
    while True:
        try:
            return _settled(engine, firmness)
        except NoRoom:
            engine.make_room(2 * len(engine.spare.meetings.rows))


class _Diverged(NoEquilibrium):
    """A proximal step has no answer."""


def _settled(engine, firmness: float) -> motions.MotionState:
    """`standing` by proximal steps of a `firmness` [1/s2]."""
    structure, work, centers = engine.structure, engine.work, engine.view.center
    bodies, start, end = structure.bodies.body, engine.motion_at_rest(), engine.motion_at_rest()
    start.frames["center"] = centers
    start.contact["anchor"] = engine.places(centers, start.rotation)[:, :2]
    start.ties["length"] = engine.link_lengths(centers, start.rotation)
    resting = resting_scheme(structure, engine.points, firmness)
    # of the turns, which move the bodies by so much wherever they stand
    reach = max(np.ptp(centers[:, :2], axis=0).max(), np.abs(centers[:, 2]).max())
    steps, mover = 0, None

    def proximal_step():
        nonlocal steps, mover
        while (answer := engine.settle(resting, start, end)) == FAR_BASE:
            engine.extend_base(end)
        if answer == NO_ROOM:
            raise NoRoom
        of_each = np.maximum(
            np.abs(end.frames["center"] - start.frames["center"]).max(axis=1),
            np.abs(work.action.turn).max(axis=1) * reach,
        )
        if np.isfinite(of_each).all():
            mover = int(np.argmax(of_each))
        if answer != OK:
            raise _Diverged(
                f"gravity equilibrium: contact does not converge in iteration {steps + 1}"
            )
        moved = max(
            of_each.max(),
            np.abs(work.elastic.point[1] - work.elastic.point[0]).max(),
        )
        steps += 1
        if steps > SLIDES_KEPT:
            interpreted(move_anchors)(
                work.points,
                structure.interfaces,
                resting.springs,
                near_points(work.problem),
                work.before,
                end.contact,
            )
        else:
            end.contact["anchor"] = work.before["anchor"]
        motions.copy(end, start)
        return moved

    try:
        iterate_to_rest(proximal_step, 2 * np.abs(centers[:, 2]).max())
    except NoEquilibrium as error:
        error.mover = mover
        raise
    engine.counts[:] = 0
    start.frames["acceleration"] = -work.action.push * bodies["inverse_mass"][:, None]
    start.frames["acceleration"][bodies["airborne"]] = structure.gravity
    start.modal[:, ACCELERATION] = -structure.squares * start.modal[:, COORDINATE]
    start.ties["work"] = 0.0  # what links lose on the way there is not of the motion
    return start


def unstrained(engine, motion) -> motions.MotionState:
    """A motion of which the places of the bodies are known: they fall freely from there, and links
    are as tight as they are.
    """
    free = engine.structure.bodies.body["held"] < 0
    motion.frames["acceleration"] = free[:, None] * engine.structure.gravity
    motion.contact["relative"] = engine.places(motion.frames["center"], motion.rotation)
    motion.contact["anchor"], motion.contact["located"] = (
        motion.contact["relative"][:, :2],
        may_touch(engine.points, engine.structure.interfaces, motion.contact["relative"]),
    )
    motion.ties["length"] = engine.link_lengths(motion.frames["center"], motion.rotation)
    motion.whole["static"] = interpreted(end_links)(
        engine.structure.links,
        motion.grounds,
        motion.frames,
        motion.rotation,
        motion.ties.copy(),
        motion.ties,
        np.inf,
    )[0]
    motion.ties["work"] = 0.0
    return motion


def of_parts(engine, parts, stands: bool) -> motions.MotionState:
    """The motion that the parts of a StructureModel begin with.

    stands: whether they come from gravity equilibrium; else they are unstrained where the parts
    say.
    """
    if stands:
        motion = gravity_equilibrium(engine)
    else:
        motion = engine.motion_at_rest()
        motion.frames["center"], motion.rotation[:] = (
            [part.center for part in parts],
            [part.rotation for part in parts],
        )
        unstrained(engine, motion)
    motion.frames["velocity"] = [part.velocity for part in parts]
    motion.frames["spin"] = [
        rotation.T @ part.spin for rotation, part in zip(motion.rotation, parts)
    ]
    return motion
