"""Rows of the history of a reduced analysis, and when the column is lost."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.overturning import (
    CAPPED,
    FELL,
    NO_RETURN,
    STANDS,
    Stance,
    fallen,
    is_past_no_return,
)
from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import SLAVE, find_poses
from fecolumn.contact.record import record
from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.engines.reduced.elastic import COORDINATE
from fecolumn.engines.reduced.ledger import N_TERMS, kinetic, strain, weight_energy
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.reduced.model import Structure
    from fecolumn.engines.reduced.motion import MotionState

#: Columns of a row: name in the history file and how many numbers.
COLUMNS = (
    ("time", 1),
    ("u_top", 3),
    ("tilt", 1),
    ("twist", 1),
    ("slide", 2),
    ("contact_force", 3),
    ("active_nodes", 1),
    ("penetration", 1),
    ("ground", 3),
    ("iterations", 1),
    *((f"energy/{term}", 1) for term in TERMS),
)
WIDTH = sum(count for _, count in COLUMNS)


def column_index(column: str, columns: tuple[tuple[str, int], ...] = COLUMNS) -> int:
    """Place in a row of the first number of a column."""
    names = [name for name, _ in columns]
    return sum(count for _, count in columns[: names.index(column)])


_TOP, _TILT, _TWIST, _SLIDE, _FORCE, _ACTIVE, _DEPTH, _GROUND, ITERATIONS_MADE = (
    column_index(name)
    for name in (
        "u_top",
        "tilt",
        "twist",
        "slide",
        "contact_force",
        "active_nodes",
        "penetration",
        "ground",
        "iterations",
    )
)
#: Place of the energy terms in a row.
ENERGY = WIDTH - len(TERMS)


#: A point of a body that is watched: arm: (3,) from its centre of mass in its frame [m].
MARK = record(("body", "i8"), ("arm", "f8", 3))
#: Columns of a row beside COLUMNS, of a structure of many bodies: of each body displacement of its
#: centre of mass [m], tilt [rad] and rotation vector [rad]; of each interface tilt of the slave
#: from the master [rad], rise of the middle of its foot and its slide along two tangents [m],
#: normal force [N], resultant of all forces on the slave [N] and centre of pressure [m], both in
#: the table frame and 0 where nothing carries; of each mark its displacement [m]; of each link
#: tension [N], elongation from its unstressed length and the part of it that has yielded [m],
#: energy that it has taken [J], whether it is broken; of each glued joint the largest tension and
#: shear of its points [Pa], the share of its area that has failed and energy that it has taken [J].
OF_BODY, OF_INTERFACE, OF_MARK = (
    (("displacement", 3), ("tilt", 1), ("rotation", 3)),
    (("tilt", 1), ("rise", 1), ("slide", 2), ("force", 1), ("resultant", 3), ("center", 3)),
    (("displacement", 3),),
)
OF_LINK = (("tension", 1), ("elongation", 1), ("yielded", 1), ("work", 1), ("broken", 1))
OF_BOND = (("stress", 1), ("shear_stress", 1), ("failed", 1), ("work", 1))
#: Numbers in a row of each of them
PER_BODY, _N_INTERFACE, _N_MARK, _N_LINK, _N_BOND = (
    sum(count for _, count in columns)
    for columns in (OF_BODY, OF_INTERFACE, OF_MARK, OF_LINK, OF_BOND)
)
_BODY_TILT, _TURN, _RISE, _SHIFT, _NORMAL, _RESULTANT, _CENTER = (
    column_index("tilt", OF_BODY),
    column_index("rotation", OF_BODY),
    *(
        column_index(name, OF_INTERFACE)
        for name in ("rise", "slide", "force", "resultant", "center")
    ),
)


class View(NamedTuple):
    """What is watched: center: (nb, 3) of mass in the reference configuration; body: the one of
    which top_arm (3,), top_shape (3, m), foot_arm (3,), foot_shape (3, m) are means over top and
    foot; stance: when it is lost, if it stands alone. limits: (nb,) tilts [rad] at which a body of
    many is lost, none for one alone; standing: (nb,) of `overturning.STANDING`, by which it is lost
    before, with the corners (k, 2) [m] of all. feet: (ni, 3) of the interfaces [m] and normals:
    (ni, 3) of them in the frames of their slaves, in the reference configuration; marks: (nm,) of
    MARK, their shapes (nm, 3, m). links: how many beside those of glued joints; bonds: areas (k,)
    [m2] that glue holds in each of these. levels: (G,) heights of the grounds [m]. held:
    (nb,) as of `contact.bodies.BODY`. sides: (ni, 2) slave and master of the interfaces, GROUND
    among them; faces, gives: (ni, 2, 6, m), (ni, 2, 6, 3 n) of `structures.face_motion`.
    """

    center: Array
    body: int
    top_arm: Array
    top_shape: Array
    foot_arm: Array
    foot_shape: Array
    stance: Stance
    limits: Array
    standing: Array
    corners: Array
    feet: Array
    normals: Array
    marks: Array
    shapes: Array
    links: int = 0
    levels: Array = np.zeros(1)
    held: Array = np.zeros(0, np.int64)
    bonds: Array = np.zeros(0)
    sides: Array = np.zeros((0, 2), np.int64)
    faces: Array = np.zeros((0, 2, 6, 0))
    gives: Array = np.zeros((0, 2, 6, 0))

    @property
    def width(self) -> int:
        """Numbers in a row."""
        return (
            WIDTH
            if not len(self.limits)
            else WIDTH
            + PER_BODY * len(self.center)
            + _N_INTERFACE * len(self.feet)
            + _N_MARK * len(self.marks)
            + _N_LINK * self.links
            + _N_BOND * len(self.bonds)
        )


@njit(fastmath={"reassoc", "contract"})
def _displace(
    b: int,
    arm: Array,
    shape: Array,
    center: Array,
    motion: MotionState,
    axes: int,
    row: Array,
    place: int,
) -> None:
    """Put the displacement along the first `axes` of a point of body b from `place` on in the
    row.
    """
    for axis in range(axes):
        row[place + axis] = motion.frames[b].center[axis] - center[b, axis] - arm[axis]
    for a in range(3):
        local = arm[a]
        for k in range(shape.shape[1]):
            local += shape[a, k] * motion.modal[b, COORDINATE, k]
        for axis in range(axes):
            row[place + axis] += motion.rotation[b, axis, a] * local


@njit
def observe(
    structure: Structure,
    points: Array,
    poses: Array,
    view: View,
    motion: MotionState,
    ledger: Array,
    iterations: int,
    row: Array,
) -> None:
    """Fill a row (view.width,); points: (P,) of POINT, poses: room for (ni,) of POSE."""
    R, contact = motion.rotation[view.body], motion.contact
    row[:] = 0.0
    row[0] = motion.whole[0].time
    _displace(view.body, view.top_arm, view.top_shape, view.center, motion, 3, row, _TOP)
    row[_TILT] = np.arctan2(np.hypot(R[0, 2], R[1, 2]), R[2, 2])
    row[_TWIST] = np.arctan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])
    _displace(view.body, view.foot_arm, view.foot_shape, view.center, motion, 2, row, _SLIDE)
    depth = 0.0
    for i in range(len(contact)):
        if contact[i].force[2] > 0:
            row[_ACTIVE] += 1
            if structure.interfaces[points[i].interface].master == GROUND:
                for a in range(3):
                    row[_FORCE + a] += contact[i].force[a]
        if contact[i].located:
            depth = max(depth, contact[i].raised - contact[i].relative[2])
        elif contact[i].raised > depth:
            depth = contact[i].raised
    row[_DEPTH] = depth
    for a in range(3):
        row[_GROUND + a] = motion.whole[0].ground[a]
    row[ITERATIONS_MADE] = iterations
    row[ENERGY], row[ENERGY + 1], row[ENERGY + 2] = (
        kinetic(structure, motion),
        strain(structure, motion),
        weight_energy(structure, view.center, motion),
    )
    closure = row[ENERGY] + row[ENERGY + 1] + row[ENERGY + 2]
    for k in range(N_TERMS):
        closure -= ledger[k]
        if k:
            row[ENERGY + 2 + k] = ledger[k]
    row[WIDTH - 1] = closure
    if len(view.limits):
        _observe_all(structure, points, poses, view, motion, row)


@njit
def _observe_all(
    structure: Structure, points: Array, poses: Array, view: View, motion: MotionState, row: Array
) -> None:
    """Fill what a row has of bodies, interfaces, marks and links."""
    place = WIDTH
    for b in range(len(motion.frames)):
        R = motion.rotation[b]
        for a in range(3):
            row[place + a] = motion.frames[b].center[a] - view.center[b, a]
        row[place + _BODY_TILT] = np.arctan2(np.hypot(R[0, 2], R[1, 2]), R[2, 2])
        # sine and cosine of the angle of the rotation, along its axis the first
        x, y, z = (R[2, 1] - R[1, 2]) / 2, (R[0, 2] - R[2, 0]) / 2, (R[1, 0] - R[0, 1]) / 2
        sine, cosine = np.sqrt(x * x + y * y + z * z), (R[0, 0] + R[1, 1] + R[2, 2] - 1) / 2
        factor = np.arctan2(sine, cosine) / sine if sine > 0 else 1.0
        row[place + _TURN], row[place + _TURN + 1] = factor * x, factor * y
        row[place + _TURN + 2] = factor * z
        place += PER_BODY
    find_poses(structure.interfaces, motion.grounds, motion.frames, motion.rotation, poses, None)
    first, deforms = place, view.gives.shape[3] > 0
    pushes = _node_forces(structure, points, poses, motion) if deforms else np.zeros((0, 3))
    for k in range(len(view.feet)):
        T, foot, normal = poses[k].turned[SLAVE], poses[k].foot, view.normals[k]
        x, y, z = (
            T[2, 1] * normal[2] - T[2, 2] * normal[1],
            T[2, 2] * normal[0] - T[2, 0] * normal[2],
            T[2, 0] * normal[1] - T[2, 1] * normal[0],
        )
        row[place] = np.arctan2(
            np.hypot(np.hypot(x, y), z),
            T[2, 0] * normal[0] + T[2, 1] * normal[1] + T[2, 2] * normal[2],
        )
        row[place + _RISE] = foot[2] - view.feet[k, 2]
        for a in range(2):
            row[place + _SHIFT + a] = foot[a] - view.feet[k, a]
        if deforms:
            own = row[place : place + _N_INTERFACE]
            _add_deformation(structure, poses[k].turned, view, motion, pushes, k, own)
        place += _N_INTERFACE
    _observe_forces(structure, points, poses, motion, len(view.feet), row[first:place])
    for n in range(len(view.marks)):
        _displace(
            view.marks[n].body,
            view.marks[n].arm,
            view.shapes[n],
            view.center,
            motion,
            3,
            row,
            place,
        )
        place += _N_MARK
    for n in range(view.links):
        tie = motion.ties[n]
        row[place], row[place + 1], row[place + 2] = (
            tie.force,
            tie.length - structure.links[n].length,
            tie.flowed,
        )
        row[place + 3], row[place + 4] = tie.work, tie.broken
        place += _N_LINK
    for n in range(view.links, len(motion.ties), 3):
        link, tie = structure.links[n], motion.ties[n]
        own = row[place + _N_BOND * (link.bond - 1) : place + _N_BOND * link.bond]
        shear = np.hypot(motion.ties[n + 1].force, motion.ties[n + 2].force)
        own[0], own[1] = max(own[0], tie.force / link.area), max(own[1], shear / link.area)
        own[2] += tie.broken * link.area / view.bonds[link.bond - 1]
        own[3] += tie.work


@njit
def _node_forces(structure: Structure, points: Array, poses: Array, motion: MotionState) -> Array:
    """Contact forces (N, 3) [N] on the nodes of all bodies, in the frames of these."""
    pushes, push = np.zeros((len(structure.bodies.arms), 3)), np.empty(3)
    for i in range(len(points)):
        f = motion.contact[i].force
        if not f[2] > 0:
            continue
        for side in range(2):
            if (points[i].master if side else points[i].slave) == GROUND:
                continue
            T = poses[points[i].interface].turned[side]
            for a in range(3):
                push[a] = T[0, a] * f[0] + T[1, a] * f[1] + T[2, a] * f[2]
            for q in range(4 if side else points[i].count):
                share = -points[i].shares[q] if side else points[i].weights[q]
                node = points[i].below[q] if side else points[i].carriers[q]
                if share != 0.0:
                    for a in range(3):
                        pushes[node, a] += share * push[a]
    return pushes


@njit
def _add_deformation(
    structure: Structure,
    turned: Array,
    view: View,
    motion: MotionState,
    pushes: Array,
    k: int,
    row: Array,
) -> None:
    """Let what a row has of interface k be of the faces of its bodies as they are deformed.

    turned: (2, 3, 3) of slave and master to its frame; pushes: (N, 3) of `_node_forces`.
    """
    moved, normals = np.zeros((2, 6)), np.zeros((2, 3))
    for side in range(2):
        body = view.sides[k, side]
        if body == GROUND:
            continue
        for m in range(view.faces.shape[3]):
            for s in range(6):
                moved[side, s] += view.faces[k, side, s, m] * motion.modal[body, COORDINATE, m]
        first = structure.bodies.body[body].first
        for n in range(structure.bodies.body[body].count):
            for a in range(3):
                push = pushes[first + n, a]
                if push != 0.0:
                    for s in range(6):
                        moved[side, s] += view.gives[k, side, s, 3 * n + a] * push
    for side in range(2):
        T, sign, x, y, z = (
            turned[side],
            1 - 2 * side,
            moved[side, 3],
            moved[side, 4],
            moved[side, 5],
        )
        n0, n1, n2 = T[2, 0], T[2, 1], T[2, 2]
        if side == SLAVE:
            n0, n1, n2 = view.normals[k, 0], view.normals[k, 1], view.normals[k, 2]
        tipped = n0 + y * n2 - z * n1, n1 + z * n0 - x * n2, n2 + x * n1 - y * n0
        for a in range(3):
            for c in range(3):
                normals[side, a] += T[a, c] * tipped[c]
                if a < 2:
                    row[_SHIFT + a] += sign * T[a, c] * moved[side, c]
                else:
                    row[_RISE] += sign * T[a, c] * moved[side, c]
    own, other, cosine, across = normals[SLAVE], normals[1 - SLAVE], 0.0, 0.0
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        cosine += own[a] * other[a]
        across = np.hypot(across, own[b] * other[c] - own[c] * other[b])
    row[0] = np.arctan2(across, cosine)


@njit
def _observe_forces(
    structure: Structure, points: Array, poses: Array, motion: MotionState, joints: int, row: Array
) -> None:
    """Add forces and centres of pressure to what a row has of interfaces, those of the first
    `joints` of them. Those of pairs that were found are of the joint in whose place they are.
    """
    for i in range(len(points)):
        force, place = motion.contact[i].force, motion.contact[i].relative
        if not force[2] > 0:
            continue
        k, sign = points[i].interface, 1.0
        Q, origin = poses[k].frame, poses[k].origin
        if k >= joints:
            other = points[i].master
            if other == GROUND:
                other = len(motion.frames) + points[i].ground
            k = structure.found.joint[other, points[i].slave]
            if k < 0:
                continue
            if structure.interfaces[k].slave != points[i].slave:
                sign = -1.0
        own = row[_N_INTERFACE * k : _N_INTERFACE * (k + 1)]
        own[_NORMAL] += force[2]
        for a in range(3):
            along = Q[a, 0] * force[0] + Q[a, 1] * force[1] + Q[a, 2] * force[2]
            own[_RESULTANT + a] += sign * along
            own[_CENTER + a] += force[2] * (origin[a] + Q[a, 0] * place[0] + Q[a, 1] * place[1])
    for k in range(joints):
        own = row[_N_INTERFACE * k : _N_INTERFACE * (k + 1)]
        if own[_NORMAL] > 0:
            for a in range(3):
                own[_CENTER + a] /= own[_NORMAL]


@njit
def outcome_of_row(view: View, motion: MotionState, row: Array, steepest: float) -> int:
    """As `overturning.fallen`, of a motion and its row; FELL where one of many bodies has fallen
    past the lowest ground.
    """
    top, force = np.hypot(row[_TOP], row[_TOP + 1]), row[_FORCE : _FORCE + 3]
    if len(view.limits):
        spins = np.empty((len(view.limits), 3))
        for b in range(len(view.limits)):
            for a in range(3):
                spins[b, a] = motion.frames[b].spin[a]
        for b in range(len(view.limits)):
            if view.held[b] >= 0:
                continue
            if motion.frames[b].center[2] < view.levels.min():
                return FELL
            if row[WIDTH + PER_BODY * b + _BODY_TILT] > view.limits[b] or is_past_no_return(
                view.standing, view.corners, motion.rotation, spins, b, force, steepest
            ):
                return NO_RETURN
        return CAPPED if top >= view.stance.cap else STANDS
    # what is short of both its cap and its critical tilt stands: most steps, at no cost
    if top < view.stance.cap and row[_TILT] <= view.stance.critical:
        return STANDS
    return fallen(view.stance, motion.rotation[0], motion.frames[0].spin, force, top, steepest)
