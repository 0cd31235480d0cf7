"""Rows of the history of a reduced analysis, and when the column is lost."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit
from fecolumn.dynamics.energy import TERMS
from fecolumn.dynamics.overturning import STANDS, Stance, fallen, stance
from fecolumn.reduced.ledger import kinetic, strain, weight_energy
from fecolumn.reduced.motion import TIME

#: Columns of a row: name in the history file and how many numbers.
COLUMNS = (("time", 1), ("u_top", 3), ("tilt", 1), ("twist", 1), ("slide", 2), ("contact_force", 3), ("active_nodes", 1), ("penetration", 1),
           ("ground", 3), ("iterations", 1), *((f"energy/{term}", 1) for term in TERMS))
WIDTH = sum(count for _, count in COLUMNS)
#: Place of the energy terms in a row.
ENERGY = WIDTH - len(TERMS)


class View(NamedTuple):
    """What is watched: center: (3,) of mass in the reference configuration; top_arm (3,), top_shape (3, m), foot_arm (3,), foot_shape
    (3, m): means over top and foot; stance: when it is lost."""

    center: np.ndarray
    top_arm: np.ndarray
    top_shape: np.ndarray
    foot_arm: np.ndarray
    foot_shape: np.ndarray
    stance: Stance


def view(model, weight: float, friction: float, cap: float = 0.0) -> View:
    """The view of a ColumnModel of a weight [N] on a base of a coefficient of friction; cap as of `overturning.stance`."""
    share = model.areas / model.areas.sum()
    return View(np.asarray(model.center, float), model.top_arm, np.ascontiguousarray(model.top_shape), share @ model.arms,
                np.einsum("i,iam->am", share, model.shapes), stance(model.arms, model.inertia, weight, friction, cap))


@njit
def _displacement(arm, shape, center, motion, axis):
    value = motion.center[axis] - center[axis] - arm[axis]
    for a in range(3):
        local = arm[a]
        for k in range(len(motion.modal)):
            local += shape[a, k] * motion.modal[k]
        value += motion.rotation[axis, a] * local
    return value


@njit
def observe(column, eye, motion, ledger, iterations, row):
    """Fill a row (WIDTH,)."""
    R, forces = motion.rotation, motion.forces
    row[:] = 0.0
    row[0] = motion.scalars[TIME]
    for a in range(3):
        row[1 + a] = _displacement(eye.top_arm, eye.top_shape, eye.center, motion, a)
    row[4] = np.arctan2(np.hypot(R[0, 2], R[1, 2]), R[2, 2])
    row[5] = np.arctan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])
    row[6] = _displacement(eye.foot_arm, eye.foot_shape, eye.center, motion, 0)
    row[7] = _displacement(eye.foot_arm, eye.foot_shape, eye.center, motion, 1)
    for i in range(len(forces)):
        for a in range(3):
            row[8 + a] += forces[i, a]
        row[11] += forces[i, 2] > 0
        row[12] = max(row[12], -motion.relative[i, 2])
    for a in range(3):
        row[13 + a] = motion.ground[a]
    row[16] = iterations
    row[17], row[18], row[19] = kinetic(column, motion), strain(column, motion), weight_energy(column, eye.center, motion)
    closure = row[17] + row[18] + row[19]
    for k in range(len(ledger)):
        closure -= ledger[k]
        if k:
            row[19 + k] = ledger[k]
    row[WIDTH - 1] = closure


@njit
def lost(eye, motion, row, steepest):
    """As `overturning.fallen`, of a motion and its row."""
    top = np.hypot(row[1], row[2])
    # what is short of both its cap and its critical tilt stands: most steps, at no cost
    if top < eye.stance.cap and row[4] <= eye.stance.critical:
        return STANDS
    return fallen(eye.stance, motion.rotation, motion.spin, row[8:11], top, steepest)
