"""Stiffness of a structure about a motion: modes, links and the contact that carries."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.problem import near_points
from fecolumn.contact.tolerances import LEAST_COMPLIANCE, STICKS
from fecolumn.engines.dynamics.links_of_model import rows_of_links
from fecolumn.engines.reduced.elastic import END
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.pad import Springs
    from fecolumn.engines.reduced.equilibrium import Work
    from fecolumn.engines.reduced.model import Structure
    from fecolumn.engines.reduced.motion import MotionState


class Masses(NamedTuple):
    """What displacements are measured by: mass: (nb,) [kg], inertia: (nb, 3, 3) [kg m2] and factor:
    (nb, 3, 3) L of it, L L^T; of bodies that grounds hold 1 in their place, which `free` (nb,)
    leaves out.
    """

    mass: Array
    inertia: Array
    factor: Array
    free: Array


def masses_of(structure: Structure) -> Masses:
    """Those of the bodies of a Structure, as their inverses say."""
    bodies = structure.bodies.body
    free = bodies["held"] < 0
    inertia = np.where(free[:, None, None], bodies["inertia"], np.eye(3))
    mass = 1.0 / np.where(free, bodies["inverse_mass"], 1.0)
    return Masses(mass, inertia, np.linalg.cholesky(inertia), free)


def coordinates_of(masses: Masses, ways: Array, turns: Array, modal: Array) -> Array:
    """Displacements (6 nb + nb m,) times the roots of the masses: ways and turns (nb, 3) [m], [rad]
    body by body, then modal coordinates (nb, m).
    """
    rigid = np.hstack(
        [np.sqrt(masses.mass)[:, None] * ways, np.einsum("bca,bc->ba", masses.factor, turns)]
    )
    return np.concatenate([rigid.ravel(), modal.ravel()])


def displacements_of(masses: Masses, coordinates: Array) -> tuple[Array, Array, Array]:
    """Ways, turns and modal coordinates of `coordinates_of`."""
    count = len(masses.mass)
    rigid, modal = coordinates[: 6 * count].reshape(count, 6), coordinates[6 * count :]
    turns = np.linalg.solve(masses.factor.transpose(0, 2, 1), rigid[:, 3:, None])[..., 0]
    return rigid[:, :3] / np.sqrt(masses.mass)[:, None], turns, modal.reshape(count, -1)


def tangent_of(
    structure: Structure,
    springs: Springs,
    work: Work,
    masses: Masses,
    motion: MotionState,
    yielding: Array,
    touches: float = 0.0,
) -> Array:
    """Stiffness (n, n) [1/s2] in the coordinates of `coordinates_of` about a motion to which a step
    of `springs` came; bodies that grounds hold have none.

    Points that carry hold in all directions, those that slide along the normal alone; so do points
    that carry nothing but are less than `touches` [m] above what they stand on. Links that are
    `yielding` (nl,) hold by what they harden. The base's compliance is left out, and that forces
    turn bodies otherwise once these have turned, but for bodies on domes: only that holds them.
    """
    count, modes = len(masses.mass), structure.squares.shape[1]
    links = structure.links
    active = (motion.ties["force"] != 0.0) & ~motion.ties["broken"]
    # a damper holds nothing: neither stiffness nor hardening
    whole = np.maximum(links["stiffness"] + links["hardens"], np.finfo(float).tiny)
    left = np.where(yielding, links["hardens"] / whole, 1.0 - motion.ties["damage"])
    stiffness = np.where(active, links["stiffness"] * left, 0.0)
    rows = [np.zeros((0, (6 + modes) * count))]
    if active.any():
        bodies = list(zip(masses.mass, masses.inertia, motion.frames["center"], motion.rotation))
        rows.append(rows_of_links(structure, stiffness, bodies, [np.ones(modes)] * count)[0])
    carrying = motion.contact["force"][:, 2] > 0
    if touches:
        near = np.zeros(len(carrying), bool)
        near[near_points(work.problem)] = True
        carrying |= near & (motion.contact["relative"][:, 2] < touches)
    rows.append(_contact_rows(structure, springs, work, masses, motion, np.flatnonzero(carrying)))
    stacked = np.concatenate(rows)
    tangent = stacked.T @ stacked
    own = np.arange(6 * count, (6 + modes) * count)
    tangent[own, own] += structure.squares.ravel()
    for b in np.unique(structure.interfaces["slave"][structure.interfaces["edge"][:, 0] > 0]):
        turns = slice(6 * b + 3, 6 * b + 6)
        tangent[turns, turns] += _rolling_stiffness(structure, work, masses, motion, int(b))
    held = np.repeat(~masses.free, 6)
    tangent[: 6 * count][held] = tangent[:, : 6 * count][:, held] = 0.0
    return tangent


def _rolling_stiffness(
    structure: Structure, work: Work, masses: Masses, motion: MotionState, b: int
) -> Array:
    """Stiffness (3, 3) against turning of body b, in the coordinates of `coordinates_of`, by which
    the contact forces on it keep their direction.

    A force f at the arm a, which turns with the body, gets the moment (t x a) x f by a turn t. The
    arm of a ball is that of its centre: it touches below that, however the body has turned.
    """
    stiffness, points = np.zeros((3, 3)), work.points
    for i in np.flatnonzero(motion.contact["force"][:, 2] > 0):
        point, interface = points[i], structure.interfaces[points["interface"][i]]
        axes = work.poses[END]["frame"][point["interface"]].T @ motion.rotation[b]
        force = motion.contact["force"][i] @ axes
        if point["slave"] == b:
            arm = point["arm"] + work.elastic.point[END, i] + interface["ball"] * axes[2]
        elif point["master"] == b:
            arm, force = work.elastic.seat[END, i], -force
        else:
            continue
        both = np.outer(arm, force)
        stiffness += arm @ force * np.eye(3) - (both + both.T) / 2
    half = np.linalg.solve(masses.factor[b], stiffness)
    whole: Array = np.linalg.solve(masses.factor[b], half.T)
    return whole


def _contact_rows(
    structure: Structure,
    springs: Springs,
    work: Work,
    masses: Masses,
    motion: MotionState,
    carrying: Array,
) -> Array:
    """Rows (k, n) of which the squares add up to the stiffness of contact: C^-1/2 B, of points with
    compliance C (k, k) that displacements move by B relative to one another; carrying: (k,) numbers
    of the points.
    """
    contact, bodies, points = motion.contact, structure.bodies, work.points
    count, modes = len(masses.mass), structure.squares.shape[1]
    axes = work.poses[END]["frame"][points["interface"][carrying]].transpose(0, 2, 1)
    gives = np.append(bodies.body["gives"], 0.0)
    own = springs.own[carrying]
    own = own + gives[[points[end][carrying] for end in ("slave", "master")]].sum(axis=0)[:, None]
    compliance = np.diag(own.ravel())
    moved = np.zeros((len(carrying), 3, (6 + modes) * count))
    for b, body in enumerate(bodies.body):
        # shares of the nodes of a body in what the points move, along their axes
        shares = np.zeros((len(carrying), 3, body["count"], 3))
        turned = axes @ motion.rotation[b]
        for place, i in enumerate(carrying):
            point, sides = points[i], []
            if point["slave"] == b:
                n = point["count"]
                arm = point["arm"] + work.elastic.point[END, i]
                sides.append((1.0, point["carriers"][:n], point["weights"][:n], arm))
            if point["master"] == b:
                seat = work.elastic.seat[END, i]
                sides.append((-1.0, point["below"][:3], point["shares"][:3], seat))
            for sign, nodes, weights, arm in sides:
                for node, weight in zip(nodes, weights):
                    shares[place, :, node - body["first"]] += sign * weight * turned[place]
                if masses.free[b]:
                    at = moved[place, :, 6 * b : 6 * b + 6]
                    at[:, :3] += sign * turned[place] / np.sqrt(masses.mass[b])
                    at[:, 3:] += (
                        sign * np.linalg.solve(masses.factor[b], np.cross(arm, turned[place]).T).T
                    )
        if not shares.any():
            continue
        flat = shares.reshape(3 * len(carrying), 3 * body["count"])
        rows = slice(3 * body["first"], 3 * (body["first"] + body["count"]))
        if not body["stiff"]:
            compliance += flat @ bodies.static[rows, : 3 * body["count"]] @ flat.T
        if modes:
            columns = slice(6 * count + modes * b, 6 * count + modes * (b + 1))
            pushes = bodies.pushes.reshape(-1, modes)[rows]
            moved[..., columns] = (flat @ pushes).reshape(len(carrying), 3, modes)
    force, friction = contact["force"][carrying], points["friction"][carrying]
    holds = np.ones((len(carrying), 3), bool)
    slides = np.hypot(*force[:, :2].T) >= STICKS * friction * force[:, 2]
    holds[:, :2] = ~(slides & (force[:, 2] > 0))[:, None]
    kept = np.flatnonzero(holds)
    compliance = compliance[np.ix_(kept, kept)]
    moved = moved.reshape(3 * len(carrying), moved.shape[2])[kept]
    squares, shapes = np.linalg.eigh(compliance)
    if not (squares > 0.0).any():
        return np.zeros((0, moved.shape[1]))
    # points between the same nodes move as one but for rounding
    squares = np.maximum(squares, LEAST_COMPLIANCE * squares[-1:])
    return (shapes / np.sqrt(squares)).T @ moved
