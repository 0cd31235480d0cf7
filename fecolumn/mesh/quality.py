"""How well a mesh represents the specimen: mass properties against closed forms, and the smallest Jacobians."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fecolumn.case import Case
from fecolumn.mesh.bricks import CAP, BrickMesh
from fecolumn.mesh.column import is_solid
from fecolumn.mesh.jacobian import corner_jacobians, scaled_jacobian
from fecolumn.mesh.specimen import SpecimenMesh

# Corner signs of the VTK hexahedron.
_SIGNS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])


@dataclass(frozen=True, slots=True)
class MassProperties:
    """Volume, mass and inertia of a body.

    Attributes:
        volume: [m3]; mass: [kg].
        centre: (3,) centre of mass [m].
        inertia: (3, 3) inertia tensor about the centre of mass [kg m2].
    """

    volume: float
    mass: float
    centre: np.ndarray
    inertia: np.ndarray

    def __add__(self, other: MassProperties) -> MassProperties:
        mass = self.mass + other.mass
        centre = (self.mass * self.centre + other.mass * other.centre) / mass
        inertia = sum(one.inertia + one.mass * _steiner(one.centre - centre) for one in (self, other))
        return MassProperties(self.volume + other.volume, mass, centre, inertia)


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the quality table; `exact` and `difference` (relative) are None where there is no closed form."""

    name: str
    unit: str
    mesh: float
    exact: float | None = None

    @property
    def difference(self) -> float | None:
        """(mesh - exact) / exact."""
        return None if self.exact is None else self.mesh / self.exact - 1


def mass_properties(mesh: BrickMesh, density: float) -> MassProperties:
    """Mass properties of trilinear bricks.

    Three Gauss points a direction are exact: the Jacobian is quadratic and x_i x_j quadratic in each local coordinate.

    Args:
        mesh: bricks.
        density: [kg/m3].
    """
    abscissae, weights = np.polynomial.legendre.leggauss(3)
    corners = mesh.points[mesh.cells]
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for i, j, k in np.ndindex(3, 3, 3):
        factors = 1 + _SIGNS * abscissae[[i, j, k]]
        shape = factors.prod(axis=1) / 8
        slope = np.stack([_SIGNS[:, a] * np.delete(factors, a, axis=1).prod(axis=1) / 8 for a in range(3)])
        weight = np.linalg.det(slope @ corners) * (weights[i] * weights[j] * weights[k])
        x = np.einsum("a,cai->ci", shape, corners)
        volume += weight.sum()
        first += weight @ x
        second += np.einsum("c,ci,cj->ij", weight, x, x)
    centre = first / volume
    about_centre = second - volume * np.outer(centre, centre)
    inertia = density * (np.trace(about_centre) * np.eye(3) - about_centre)
    return MassProperties(volume, density * volume, centre, inertia)


def exact_column(case: Case) -> MassProperties:
    """Closed form of the tube or solid cylinder."""
    column, density = case.column, case.material.density_kg_m3
    outer = column.outer_diameter_m / 2
    inner = 0.0 if is_solid(case) else outer - column.wall_m
    squares, height = outer**2 + inner**2, column.height_m
    volume = math.pi * (outer**2 - inner**2) * height
    mass = density * volume
    across = mass * (3 * squares + height**2) / 12
    return MassProperties(volume, mass, np.array([0, 0, height / 2]), np.diag([across, across, mass * squares / 2]))


def exact_cap(case: Case) -> MassProperties:
    """Closed form of the cap plate."""
    a, b, c = case.cap.length_m, case.cap.width_m, case.cap.thickness_m
    mass = case.material.density_kg_m3 * a * b * c
    inertia = np.diag([b * b + c * c, a * a + c * c, a * a + b * b]) * mass / 12
    return MassProperties(a * b * c, mass, np.array([0, 0, case.column.height_m + c / 2]), inertia)


def quality_table(case: Case, specimen: SpecimenMesh) -> tuple[Row, ...]:
    """Jacobians, and mass properties of column, cap and their assembly against closed forms.

    A polygon of n chords in place of a circle has too small a volume, by 1 - sin(2 pi / n) / (2 pi / n).
    """
    body, base = specimen.body, specimen.base
    density = case.material.density_kg_m3
    is_cap = body.part == CAP
    column = _part(body, ~is_cap)
    rows = [Row("smallest Jacobian of the body", "m3", float(corner_jacobians(body).min())),
            Row("smallest scaled Jacobian of the column", "-", float(scaled_jacobian(column).min()))]
    if is_cap.any():
        rows += [Row("smallest scaled Jacobian of the cap", "-", float(scaled_jacobian(_part(body, is_cap)).min()))]
    if len(base.cells):
        rows += [Row("smallest scaled Jacobian of the base", "-", float(scaled_jacobian(base).min()))]

    found, exact = mass_properties(column, density), exact_column(case)
    rows += _mass_rows("column", found, exact)
    if is_cap.any():
        found_cap, closed_cap = mass_properties(_part(body, is_cap), density), exact_cap(case)
        rows += _mass_rows("cap", found_cap, closed_cap)
        rows += _mass_rows("column with cap", found + found_cap, exact + closed_cap)
    plate = case.base
    if len(base.cells):
        rows += [Row("base: volume", "m3", mass_properties(base, plate.density_kg_m3).volume,
                     plate.length_m * plate.width_m * plate.thickness_m)]
    return tuple(rows)


def _mass_rows(name, found, exact):
    rows = [Row(f"{name}: volume", "m3", found.volume, exact.volume),
            Row(f"{name}: mass", "kg", found.mass, exact.mass),
            Row(f"{name}: height of the centre of mass", "m", float(found.centre[2]), float(exact.centre[2]))]
    return rows + [Row(f"{name}: inertia I_{axis}{axis} about the centre of mass", "kg m2",
                       float(found.inertia[i, i]), float(exact.inertia[i, i])) for i, axis in enumerate("xyz")]


def _part(mesh, kept) -> BrickMesh:
    return BrickMesh(mesh.points, mesh.cells[kept], mesh.part[kept])


def _steiner(arm):
    return arm @ arm * np.eye(3) - np.outer(arm, arm)
