"""Rows of the history of a reduced analysis, and when the column is lost."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit
from fecolumn.dynamics.energy import TERMS
from fecolumn.dynamics.overturning import STANDS, Stance, fallen, stance
from fecolumn.reduced.ledger import kinetic, strain, weight_energy
from fecolumn.reduced.elastic import COORDINATE

#: Columns of a row: name in the history file and how many numbers.
COLUMNS = (("time", 1), ("u_top", 3), ("tilt", 1), ("twist", 1), ("slide", 2), ("contact_force", 3), ("active_nodes", 1), ("penetration", 1),
           ("ground", 3), ("iterations", 1), *((f"energy/{term}", 1) for term in TERMS))
WIDTH = sum(count for _, count in COLUMNS)
#: Place of the energy terms in a row.
ENERGY = WIDTH - len(TERMS)


class View(NamedTuple):
    """What is watched of the first body: center: (nb, 3) of mass in the reference configuration; top_arm (3,), top_shape (3, m), foot_arm (3,), foot_shape
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
    return View(np.array(model.center, float)[None], model.top_arm, np.ascontiguousarray(model.top_shape), share @ model.arms,
                np.einsum("i,iam->am", share, model.shapes), stance(model.arms, model.inertia, weight, friction, cap))


@njit
def _displace(arm, shape, center, motion, axes, row, place):
    """Put the displacement along the first `axes` of a point of the first body from `place` on in the row."""
    for axis in range(axes):
        row[place + axis] = motion.frames[0].center[axis] - center[0, axis] - arm[axis]
    for a in range(3):
        local = arm[a]
        for k in range(motion.modal.shape[2]):
            local += shape[a, k] * motion.modal[0, COORDINATE, k]
        for axis in range(axes):
            row[place + axis] += motion.rotation[0, axis, a] * local


@njit
def observe(structure, eye, motion, ledger, iterations, row):
    """Fill a row (WIDTH,)."""
    R, contact = motion.rotation[0], motion.contact
    row[:] = 0.0
    row[0] = motion.whole[0].time
    _displace(eye.top_arm, eye.top_shape, eye.center, motion, 3, row, 1)
    row[4] = np.arctan2(np.hypot(R[0, 2], R[1, 2]), R[2, 2])
    row[5] = np.arctan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])
    _displace(eye.foot_arm, eye.foot_shape, eye.center, motion, 2, row, 6)
    for i in range(len(contact)):
        if contact[i].force[2] > 0:
            row[11] += 1
            for a in range(3):
                row[8 + a] += contact[i].force[a]
        if contact[i].located:
            row[12] = max(row[12], -contact[i].relative[2])
    for a in range(3):
        row[13 + a] = motion.whole[0].ground[a]
    row[16] = iterations
    row[17], row[18], row[19] = kinetic(structure, motion), strain(structure, motion), weight_energy(structure, eye.center, motion)
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
    return fallen(eye.stance, motion.rotation[0], motion.frames[0].spin, row[8:11], top, steepest)
