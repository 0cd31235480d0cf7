"""A building of rigid floors on a rigid slab that nothing holds: its modes in space, drifts and
shears of its storeys.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from fecolumn.case.bodies import Storeys
from fecolumn.case.sections import Material
from fecolumn.structures.model import BodyModel, StoreyDrifts
from fecolumn.structures.patches import Patch
from fecolumn.structures.reduction import local_points


@dataclass(frozen=True, slots=True)
class Building:
    """Floors above a slab, from below. masses: (n,) [kg]; heights: (n,) [m] above the slab's foot;
    stiffness: (n, 2) [N/m] of storeys along x, y.
    """

    masses: NDArray[Any]
    heights: NDArray[Any]
    stiffness: NDArray[Any]

    def stiffness_matrix(self, axis: int) -> NDArray[Any]:
        """Stiffness (n, n) [N/m] of the floors along an axis, relative to the slab."""
        drift = np.eye(len(self.masses)) - np.eye(len(self.masses), k=-1)
        matrix: NDArray[Any] = drift.T * self.stiffness[:, axis] @ drift
        return matrix

    def fixed(self, axis: int) -> NDArray[Any]:
        """Frequencies (n,) [rad/s] along an axis on a fixed slab."""
        squares = eigh(self.stiffness_matrix(axis), np.diag(self.masses), eigvals_only=True)
        frequencies: NDArray[Any] = np.sqrt(squares)
        return frequencies


def building_of(body: Storeys) -> Building:
    """Floors and storeys as a body's keys say."""

    def each(values: tuple[float, ...]) -> NDArray[Any]:
        return np.array(values * body.floors if len(values) == 1 else values, float)

    masses, storey_heights = each(body.floor_masses_kg), each(body.storey_heights_m)
    heights = body.thickness_m + np.cumsum(storey_heights)
    if body.period_s is None:
        x = each(body.stiffness_x_n_m)
        stiffness = np.stack([x, each(body.stiffness_y_n_m) if body.stiffness_y_n_m else x], axis=1)
    else:
        stiffness = np.repeat(
            _of_period(body, body.period_s, masses, np.cumsum(storey_heights))[:, None], 2, axis=1
        )
    return Building(masses, heights, stiffness)


def _of_period(
    body: Storeys, period: float, masses: NDArray[Any], heights: NDArray[Any]
) -> NDArray[Any]:
    """Stiffnesses (n,) [N/m] of storeys by which the first mode on a fixed slab has the wanted
    period [s], and the wanted profile.

    With floors that move as f_i at the frequency w, storey i carries w^2 times the sum of m_j f_j
    above it, at a drift of f_i - f_(i-1).
    """
    w = 2 * math.pi / period
    z = heights / heights[-1]
    if body.profile == "uniform":
        alike = Building(masses, heights, np.ones((len(masses), 2)))
        return np.full(len(masses), (w / alike.fixed(0)[0]) ** 2)
    moved = {
        "triangular": z,
        "shear": np.sin(np.pi * z / 2),
        "flexural": 1 - np.cos(np.pi * z / 2),
    }[body.profile]
    stiffness: NDArray[Any] = (
        w**2 * np.cumsum((masses * moved)[::-1])[::-1] / np.diff(moved, prepend=0.0)
    )
    return stiffness


def storeys_model(
    body: Storeys, slab_mass: float, patches: dict[str, Patch], material: Material
) -> BodyModel:
    """The building and its slab as one free body.

    Coordinates are rigid motion r (6) of the whole and displacements u (2 n) of the floors relative
    to it: with the masses [[A, B], [B^T, D]] and the stiffness K of u alone, a free mode has r =
    -A^-1 B u and (D - B^T A^-1 B) u w^2 = K u. A floor is a thin plate of the slab's length and
    width; the slab gives only at its contact points, see `reduction.local_points`. Marks: "floor 1"
    ... from below, "top" the highest; "storey 1" ...: points at the centre of mass that move by a
    storey's drift besides.
    """
    building, n = building_of(body), body.floors
    mass = slab_mass + building.masses.sum()
    center = np.array(
        [0.0, 0.0, (slab_mass * body.thickness_m / 2 + building.masses @ building.heights) / mass]
    )
    above = building.heights - center[2]
    inertia = slab_mass * (
        _plate(body.length_m, body.width_m, body.thickness_m)
        + _raised(body.thickness_m / 2 - center[2])
    )
    for floor, z in zip(building.masses, above):
        inertia = inertia + floor * (_plate(body.length_m, body.width_m, 0.0) + _raised(z))
    rigid = np.zeros((6, 6))
    rigid[:3, :3], rigid[3:, 3:] = mass * np.eye(3), inertia
    coupling = np.zeros((6, 2, n))
    coupling[0, 0] = coupling[1, 1] = building.masses
    coupling[4, 0], coupling[3, 1] = building.masses * above, -building.masses * above
    coupling = coupling.reshape(6, 2 * n)
    stiffness = np.zeros((2 * n, 2 * n))
    stiffness[:n, :n], stiffness[n:, n:] = (
        building.stiffness_matrix(0),
        building.stiffness_matrix(1),
    )
    own = np.diag(np.tile(building.masses, 2))
    squares, moved = eigh(stiffness, own - coupling.T @ np.linalg.solve(rigid, coupling))
    turned, frequencies = -np.linalg.solve(rigid, coupling @ moved), np.sqrt(squares)

    def carried(arms: NDArray[Any]) -> NDArray[Any]:
        """Displacements (k, 3, m) of points with arms (k, 3) that move with the slab."""
        moved_by_turns = np.cross(turned[3:].T[None], arms[:, None]).transpose(0, 2, 1)
        displacements: NDArray[Any] = turned[:3] + moved_by_turns
        return displacements

    arms, flexibility, surfaces = local_points(
        patches, center, material, body.contact_stiffness_n_m3
    )
    shapes = carried(arms)
    flexibility += np.einsum("iam,jbm,m->ijab", shapes, shapes, 1 / squares)
    floors = np.column_stack([np.zeros((n, 2)), above])
    relative = moved.reshape(2, n, -1).transpose(1, 0, 2)
    at_floors = carried(floors)
    at_floors[:, :2] += relative
    marks = {
        f"floor {number}": (arm, shape)
        for number, (arm, shape) in enumerate(zip(floors, at_floors), 1)
    }
    marks["top"] = marks[f"floor {n}"]
    drifts = np.diff(relative, axis=0, prepend=np.zeros((1, 2, relative.shape[2])))
    marks |= {
        f"storey {number}": (np.zeros(3), np.pad(drift, ((0, 1), (0, 0))))
        for number, drift in enumerate(drifts, 1)
    }
    damping = (
        _rayleigh(body, building, material.damping_ratio, own, stiffness, moved, frequencies)
        if body.damping == "rayleigh"
        else None
    )
    return BodyModel(
        mass,
        inertia,
        center,
        frequencies,
        shapes,
        flexibility,
        arms,
        0,
        surfaces,
        marks,
        damping,
        StoreyDrifts(drifts, building.stiffness),
    )


def _plate(length: float, width: float, thickness: float) -> NDArray[Any]:
    """Inertia (3, 3) over mass of a box about its middle [m2]."""
    x, y, z = length**2, width**2, thickness**2
    return np.diag([y + z, x + z, x + y]) / 12


def _raised(z: float) -> NDArray[Any]:
    """What a height z [m] over the centre of mass adds to it."""
    return np.diag([z**2, z**2, 0.0])


def _rayleigh(
    body: Storeys,
    building: Building,
    ratio: float,
    mass: NDArray[Any],
    stiffness: NDArray[Any],
    moved: NDArray[Any],
    frequencies: NDArray[Any],
) -> NDArray[Any]:
    """Damping ratios (m,) of the free modes: floors damped relative to the slab by C = a M + b K on
    each axis.

    The two modes named have the ratio on a fixed slab: a, b = 2 ratio w1 w2 / (w1 + w2), 2 ratio /
    (w1 + w2). Of one floor b alone. In the free modes C is not diagonal; what couples them is left
    out.
    """
    n, damping = body.floors, np.zeros_like(mass)
    for axis in range(2):
        rows, w = slice(axis * n, (axis + 1) * n), building.fixed(axis)
        first, second = (w[mode - 1] for mode in body.rayleigh_modes) if n > 1 else (0.0, w[0])
        damping[rows, rows] = (
            2
            * ratio
            / (first + second)
            * (first * second * mass[rows, rows] + stiffness[rows, rows])
        )
    ratios: NDArray[Any] = np.einsum("im,ij,jm->m", moved, damping, moved) / (2 * frequencies)
    return ratios
