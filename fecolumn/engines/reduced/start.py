"""Motion at t = 0: gravity equilibrium of the standing structure, or a rigid tilt, with velocity
and spin.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.points import may_touch
from fecolumn.contact.tolerances import FIRMER_TIMES, LINKS_PROGRESS
from fecolumn.engines.dynamics.gravity import NoEquilibrium, iterate_to_rest
from fecolumn.engines.dynamics.links import end_links
from fecolumn.engines.reduced import motion as motions
from fecolumn.engines.reduced.elastic import ACCELERATION, COORDINATE
from fecolumn.engines.reduced.firmness import firmness_of
from fecolumn.engines.reduced.found_of_model import NoRoom
from fecolumn.engines.reduced.settling import Diverged, Settling
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.reduced.engine import Engine
    from fecolumn.engines.reduced.motion import MotionState
    from fecolumn.structures.model import Part


def gravity_equilibrium(engine: Engine) -> motions.MotionState:
    """Gravity equilibrium, by the same proximal steps as the full-order engine: it needs no
    factorisation.

    Raises
    ------
    NoEquilibrium
        no equilibrium, for example of a column whose centre of mass does not stand over its foot.
    """
    firmness = firmness_of(engine.structure, engine.view.center)
    try:
        return _settled_firmly(engine, firmness)
    except NoEquilibrium:
        if not len(engine.structure.links) or np.ptp(firmness) == 0.0:
            raise
    # a stiff strut makes one column firm, and what lies on several then sinks on the others alone
    return _settled_firmly(engine, np.full_like(firmness, firmness.max()))


def _settled_firmly(engine: Engine, firmness: Array) -> motions.MotionState:
    """As `_settled`, by firmer steps where contact does not converge."""
    firmest = max(10.0**FIRMER_TIMES * firmness.max(), 2 / engine.hht.dt**2)
    while True:
        try:
            return _settled_with_room(engine, firmness)
        except Diverged:
            if firmness.min() >= firmest:
                raise
        firmness = np.minimum(10 * firmness, firmest)


def _settled_with_room(engine: Engine, firmness: Array) -> motions.MotionState:
    """As `_settled`, with room for as many pairs of bodies as are near each other."""
    while True:
        try:
            return _settled(engine, firmness)
        except NoRoom:
            engine.make_room(2 * len(engine.spare.meetings.rows))


def _settled(engine: Engine, firmness: Array) -> motions.MotionState:
    """`standing` by proximal steps of a `firmness` (nb,) [1/s2]."""
    structure, settling = engine.structure, Settling(engine, firmness)
    try:
        progress = LINKS_PROGRESS if len(structure.links) else None
        iterate_to_rest(settling.step, settling.height, progress)
    except NoEquilibrium as error:
        if not isinstance(error, Diverged):
            error = NoEquilibrium(
                f"gravity equilibrium: still moving by {settling.moved:.2e} m after "
                f"{settling.steps} iterations, with {settling.unbalanced:.1e} of the weight "
                "not balanced"
            )
        error.mover = settling.mover
        raise error from None
    start, bodies, action = settling.motion(), structure.bodies.body, engine.work.action
    engine.counts[:] = 0
    start.frames["acceleration"] = -action.push * bodies["inverse_mass"][:, None]
    start.frames["acceleration"][bodies["airborne"]] = structure.gravity
    start.modal[:, ACCELERATION] = -structure.squares * start.modal[:, COORDINATE]
    start.ties["work"] = 0.0  # what links lose on the way there is not of the motion
    return start


def unstrained(engine: Engine, motion: MotionState) -> motions.MotionState:
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
    motion.ties["length"] = engine.link_lengths(motion)
    before = motion._replace(ties=motion.ties.copy())
    motion.whole["static"] = interpreted(end_links)(engine.structure, before, motion, np.inf)[0]
    motion.ties["work"] = 0.0
    return motion


def of_parts(engine: Engine, parts: tuple[Part, ...], stands: bool) -> motions.MotionState:
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
