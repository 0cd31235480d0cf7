"""How well a mesh represents the specimen: mass properties against closed forms, and the smallest
Jacobians.
"""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull

from fecolumn.mesh.bricks import CAP, FLANGE, LOWER, UPPER, BrickMesh
from fecolumn.mesh.jacobian import corner_jacobians, scaled_jacobian
from fecolumn.mesh.mass import MassProperties, mass_properties
from fecolumn.mesh.outline import is_solid, own_of
from fecolumn.mesh.specimen import SpecimenMesh
from fecolumn.mesh.upright import Upright


@dataclass(frozen=True, slots=True)
class QualityRow:
    """One line of the quality table; `exact` and `difference` (relative) are None where there is no
    closed form.
    """

    name: str
    unit: str
    mesh: float
    exact: float | None = None

    @property
    def difference(self) -> float | None:
        """(mesh - exact) / exact."""
        return None if self.exact is None else self.mesh / self.exact - 1


def exact_column(case: Upright) -> MassProperties:
    """Closed form of the tube, solid cylinder or block, without flange and cap."""
    column, density = case.column, case.material.density_kg_m3
    if column.shape == "block":
        return box_properties(
            column.length_m, column.width_m, column.height_m, case.seat_m, density
        )
    outer = column.outer_diameter_m / 2
    return ring_properties(
        outer,
        0.0 if is_solid(case.column) else outer - column.wall_m,
        column.height_m,
        case.seat_m,
        density,
    )


def exact_flange(case: Upright) -> MassProperties:
    """Closed form of the flange."""
    flange = case.flange
    return ring_properties(
        flange.outer_diameter_m / 2,
        flange.inner_diameter_m / 2,
        flange.thickness_m,
        0.0,
        case.material.density_kg_m3,
    )


def exact_cap(case: Upright) -> MassProperties:
    """Closed form of the cap plate."""
    cap = case.cap
    return box_properties(
        cap.length_m,
        cap.width_m,
        cap.thickness_m,
        case.seat_m + case.column.height_m,
        case.material.density_kg_m3,
    )


def ring_properties(
    outer: float, inner: float, height: float, bottom: float, density: float
) -> MassProperties:
    """Of a tube, or of a solid cylinder with the inner radius 0, from a height `bottom` up [m]."""
    squares = outer**2 + inner**2
    volume = math.pi * (outer**2 - inner**2) * height
    mass = density * volume
    across = mass * (3 * squares + height**2) / 12
    return MassProperties(
        volume,
        mass,
        np.array([0, 0, bottom + height / 2]),
        np.diag([across, across, mass * squares / 2]),
    )


def box_properties(a: float, b: float, c: float, bottom: float, density: float) -> MassProperties:
    """Of a block of sides a, b, c from a height `bottom` up [m]."""
    mass = density * a * b * c
    inertia = np.diag([b * b + c * c, a * a + c * c, a * a + b * b]) * mass / 12
    return MassProperties(a * b * c, mass, np.array([0, 0, bottom + c / 2]), inertia)


def quality_table(case: Upright, specimen: SpecimenMesh) -> tuple[QualityRow, ...]:
    """Jacobians, and mass properties of flange, column, cap and their assembly, against closed
    forms where the column is a built one.

    Beside the mesh of a user's surface or CAD body are the integrals of what was drawn; of elements
    there is no other form: they are told as they are. Both with the tilt at which the centre of
    mass stands over the nearest edge of the rectangle around its foot.
    """
    body, base = specimen.body, specimen.base
    density, own = case.material.density_kg_m3, bool(case.column.mesh_file)
    kept = {
        "flange": body.part == FLANGE,
        "column": (body.part == LOWER) | (body.part == UPPER),
        "cap": body.part == CAP,
    }
    parts = {name: _part(body, mask) for name, mask in kept.items() if mask.any()}
    exact: dict[str, Callable[[Upright], MassProperties | None]] = {
        "flange": exact_flange,
        "column": exact_column,
        "cap": exact_cap,
    }
    rows = [QualityRow("smallest Jacobian of the body", "m3", float(corner_jacobians(body).min()))]
    shown = {**parts, "base": base} if len(base.cells) else parts
    rows += [
        QualityRow(
            f"smallest scaled Jacobian of the {name}", "-", float(scaled_jacobian(mesh).min())
        )
        for name, mesh in shown.items()
    ]

    found = {name: mass_properties(mesh, density) for name, mesh in parts.items()}
    exact["column"] = functools.partial(_drawn_column, body) if own else exact_column
    closed = {name: exact[name](case) for name in parts}
    for name in parts:
        rows += _mass_rows(name, found[name], closed[name])
    whole = functools.reduce(operator.add, found.values())
    if len(parts) > 1:
        rows += _mass_rows(
            " with ".join(sorted(parts, key=["column", "flange", "cap"].index)),
            whole,
            None if None in closed.values() else functools.reduce(operator.add, closed.values()),
        )
    if own:
        sides = ConvexHull(body.points[specimen.foot_nodes, :2]).equations
        reach = float(-(sides @ [*whole.centre[:2], 1.0]).max())
        rows += [
            QualityRow(
                "tilt with the centre of mass over the foot's nearest side",
                "rad",
                float(np.arctan2(reach, whole.centre[2])),
            )
        ]
    if len(base.cells):
        plate = case.base
        rows += [
            QualityRow(
                "base: volume",
                "m3",
                mass_properties(base, plate.density_kg_m3).volume,
                plate.length_m * plate.width_m * plate.thickness_m,
            )
        ]
    return tuple(rows)


def _drawn_column(body: BrickMesh, case: Upright) -> MassProperties | None:
    """Of the surface or the CAD body that a column was drawn as; None of elements of one's own."""
    drawn, density = own_of(case.column).exact, case.material.density_kg_m3
    if drawn is None:
        return None
    return replace(
        drawn,
        mass=density * drawn.mass,
        centre=drawn.centre + [0.0, 0.0, body.points[:, 2].min()],
        inertia=density * drawn.inertia,
    )


def _mass_rows(name: str, found: MassProperties, exact: MassProperties | None) -> list[QualityRow]:
    def row(what: str, unit: str, of: Callable[[MassProperties], float]) -> QualityRow:
        return QualityRow(
            f"{name}: {what}", unit, float(of(found)), None if exact is None else float(of(exact))
        )

    rows = [
        row("volume", "m3", lambda one: one.volume),
        row("mass", "kg", lambda one: one.mass),
        row("height of the centre of mass", "m", lambda one: one.centre[2]),
    ]
    return rows + [
        row(
            f"inertia I_{axis}{axis} about the centre of mass",
            "kg m2",
            functools.partial(_inertia, i),
        )
        for i, axis in enumerate("xyz")
    ]


def _inertia(axis: int, one: MassProperties) -> float:
    return one.inertia[axis, axis]


def _part(mesh: BrickMesh, kept: np.ndarray) -> BrickMesh:
    return mesh.only(kept)
