"""Motion at t = 0: gravity equilibrium of the standing column, or a rigid tilt, with velocity and spin; as `dynamics.gravity`."""

from __future__ import annotations

import numpy as np

from fecolumn.dynamics.gravity import REST, NoEquilibrium, leaning, pseudo_inertia, spun
from fecolumn.reduced import motion as motions
from fecolumn.reduced.equilibrium import FAR_BASE, OK
from fecolumn.reduced.model import resting_scheme
from fecolumn.reduced.motion import point_positions


def standing(engine, max_iterations: int = 50) -> motions.Motion:
    """Gravity equilibrium, by the same proximal steps as the full-order engine: it needs no factorisation.

    Raises:
        NoEquilibrium: no equilibrium, for example of a column whose centre of mass does not stand over its foot.
    """
    column, model = engine.column, engine.model
    n, m = len(model.arms), len(model.frequencies)
    start, end = motions.at_rest(n, m), motions.at_rest(n, m)
    start.center[:] = model.center
    start.anchors[:] = model.reference[:, :2]
    engine.points.anchors[:] = start.anchors
    engine.points.forces[:] = 0.0
    resting = resting_scheme(column, pseudo_inertia(engine.eye.stance.weight, -model.arms[:, 2].mean(), model.inertia))
    moved = np.inf
    for _ in range(max_iterations):
        while True:
            answer = engine.settle(resting, start, end)
            if answer != FAR_BASE:
                break
            engine.extend_base(end)
        if answer != OK:
            raise NoEquilibrium("gravity equilibrium: contact does not converge")
        moved = max(np.abs(end.center - start.center).max(), np.abs(engine.sway.turn).max() * np.abs(model.center).max(),
                    np.abs(end.elastic - start.elastic).max())
        end.anchors[:] = start.anchors
        motions.copy(end, start)
        engine.points.forces[:] = end.forces
        if moved < REST:
            break
    else:
        raise NoEquilibrium(f"gravity equilibrium: still moving by {moved:.2e} m after {max_iterations} iterations")
    engine.counts[:] = 0
    start.acceleration[:] = -start.forces.sum(axis=0) / column.mass
    start.modal_acceleration[:] = -column.squares * start.modal
    return start


def tilted(engine, tilt: float, direction: float) -> motions.Motion:
    """The unstrained column turned rigidly by `tilt` [rad] towards `direction` [rad], its lowest point on the base."""
    column, model = engine.column, engine.model
    motion = motions.at_rest(len(model.arms), len(model.frequencies))
    turn, pivot, lift = leaning(model.reference, len(column.rim) > 0, tilt, direction)
    motion.center[:] = turn @ (model.center - pivot) + pivot + [0.0, 0.0, lift]
    motion.rotation[:] = turn
    motion.acceleration[:] = column.gravity
    point_positions(engine.points, motion, motion.relative)
    motion.anchors[:] = motion.relative[:, :2]
    return motion


def begin(engine, initial) -> motions.Motion:
    """The motion that the [initial] section of a case describes."""
    tilt, direction, spin = initial.tilt_rad, np.radians(initial.direction_deg), np.array(initial.spin_rad_s)
    motion = tilted(engine, tilt, direction) if tilt else standing(engine)
    if initial.moves:
        tip, axis = spun(engine.model.reference, len(engine.column.rim) > 0, tilt, direction, spin)
        level = spin * [1.0, 1.0, 0.0]
        motion.velocity[:] = initial.velocity_m_s + np.cross(level, motion.center - tip) + np.cross(spin - level, motion.center - axis)
        motion.spin[:] = motion.rotation.T @ spin
    return motion
