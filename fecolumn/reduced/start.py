"""Motion at t = 0: gravity equilibrium of the standing structure, or a rigid tilt, with velocity and spin."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.problem import FAR_BASE, OK
from fecolumn.dynamics.gravity import NoEquilibrium, iterate_to_rest, leaning, moving, pseudo_inertia
from fecolumn.reduced import motion as motions
from fecolumn.reduced.elastic import ACCELERATION, COORDINATE
from fecolumn.reduced.model import resting_scheme


def standing(engine) -> motions.Motion:
    """Gravity equilibrium, by the same proximal steps as the full-order engine: it needs no factorisation.

    Raises:
        NoEquilibrium: no equilibrium, for example of a column whose centre of mass does not stand over its foot.
    """
    structure, model, work = engine.structure, engine.model, engine.work
    start, end = engine.motion_at_rest(), engine.motion_at_rest()
    start.frames["center"], start.contact["anchor"] = model.center, model.reference[:, :2]
    depth = -model.arms[:, 2].mean()
    resting = resting_scheme(structure, engine.points, pseudo_inertia(engine.eye.stance.weight, depth, model.inertia))

    def proximal_step():
        work.before[:] = start.contact
        while (answer := engine.settle(resting, start, end)) == FAR_BASE:
            engine.extend_base(end)
        if answer != OK:
            raise NoEquilibrium("gravity equilibrium: contact does not converge")
        moved = max(np.abs(end.frames["center"] - start.frames["center"]).max(), np.abs(work.action.turn).max() * np.abs(model.center).max(),
                    np.abs(work.elastic.point[1] - work.elastic.point[0]).max())
        end.contact["anchor"] = start.contact["anchor"]
        motions.copy(end, start)
        return moved

    iterate_to_rest(proximal_step, 2 * depth)
    engine.counts[:] = 0
    start.frames["acceleration"] = -start.forces.sum(axis=0) / model.mass
    start.modal[0, ACCELERATION] = -structure.squares[0] * start.modal[0, COORDINATE]
    return start


def tilted(engine, tilt: float, direction: float) -> motions.Motion:
    """The unstrained column turned rigidly by `tilt` [rad] towards `direction` [rad], its lowest point on the base."""
    structure, model, motion = engine.structure, engine.model, engine.motion_at_rest()
    turn, pivot, lift = leaning(model.reference, structure.interfaces["rim_count"][0] > 0, tilt, direction)
    motion.frames["center"], motion.rotation[:] = turn @ (model.center - pivot) + pivot + [0.0, 0.0, lift], turn
    motion.frames["acceleration"] = structure.gravity
    motion.contact["relative"] = motion.frames["center"] + model.arms @ turn.T
    motion.contact["anchor"], motion.contact["located"] = motion.contact["relative"][:, :2], True
    return motion


def begin(engine, initial) -> motions.Motion:
    """The motion that the [initial] section of a case describes."""
    tilt, direction = initial.tilt_rad, np.radians(initial.direction_deg)
    motion = tilted(engine, tilt, direction) if tilt else standing(engine)
    if initial.moves:
        motion.frames["velocity"] = moving(engine.model.reference, engine.structure.interfaces["rim_count"][0] > 0, initial, motion.frames["center"])
        motion.frames["spin"] = motion.rotation[0].T @ np.array(initial.spin_rad_s)
    return motion
