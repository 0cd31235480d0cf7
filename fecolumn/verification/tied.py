"""A body of tied parts, free in space, and what its ties do to fields that they should let pass."""

from __future__ import annotations

from typing import Any

import numpy as np

from fecolumn.case.case import Case
from fecolumn.case.sections import Material
from fecolumn.engines.dynamics.structure import kinematics_of
from fecolumn.engines.elements import checked_layout
from fecolumn.fem.body import Body
from fecolumn.fem.effective import effective_factor
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.mesh.bricks import LOWER, UPPER, BrickMesh, boundary_faces, merged_mesh
from fecolumn.mesh.gmsh_section import swept_grid
from fecolumn.mesh.surface import nodal_areas
from fecolumn.mesh.tie import adjust, tie
from fecolumn.structures.reduction import body_of
from fecolumn.structures.shape import Shape

# Strain of the tests: square terms of the strain measures are 1e-7 of it, rounding of positions
# 1e-8 a brick
STRETCH = 1e-7
# Inertia factor that holds the free body [1/s2]: far below its lowest axial frequency squared, far
# above rounding
_INERTIA = 1e4


def tied_blocks(engine: str, lower: np.ndarray, upper: np.ndarray, height: float) -> Tied:
    """Two blocks of steel, each `height` [m] high, the lower with grid lines `lower` [m] along x
    and y tied to the upper.
    """

    def block(lines: np.ndarray, bottom: float, part: int) -> BrickMesh:
        return swept_grid(
            lines, lines, bottom + np.linspace(0, height, 1 + round((len(lines) - 1) / 2)), part
        )

    mesh = merged_mesh([block(lower, 0.0, LOWER), block(upper, height, UPPER)])
    ties = (tie(mesh, LOWER, UPPER, height, 1e-9, 1e-9, "none"),)
    return Tied(engine, Shape(adjust(mesh, ties), ties, 1, height), Material())


def column_of(case: Case) -> Tied:
    """The column of a case with its ties."""
    drawing: Any = checked_layout(case, "verification").drawings["column"]
    return Tied(case.integration.kinematics, drawing.shape, drawing.material)


def end_areas(body: Body, mesh: BrickMesh, z: float) -> np.ndarray:
    """Tributary areas (n_owned,) [m2] of a body's nodes in its end at height z [m], nil
    elsewhere.
    """
    at_end = np.any(mesh.points[mesh.cells, 2] == z, axis=1)
    quads = boundary_faces(mesh, mesh.part[at_end][0], z, 1e-9)
    return nodal_areas(
        mesh.points[quads],
        body.find_nodes(mesh.points[quads].reshape(-1, 3)).reshape(quads.shape),
        body.n_owned,
        1,
    )


class Tied:
    """Parts of a Shape that its ties hold together, free in space.

    Parameters
    ----------
    kinematics
        "corotated" or "total_lagrangian".
    """

    def __init__(self, kinematics: str, shape: Shape, material: Material) -> None:
        self.body, self.mesh = body_of(shape, material), shape.mesh
        self.kinematics = kinematics_of(kinematics)(self.body)
        # of the strain 1 [J]
        self._energy = (
            material.youngs_modulus_pa * self.body.total_mass / material.density_kg_m3 / 2
        )

    def uniaxial(self) -> np.ndarray:
        """Displacement (n, 3) [m] of a uniform stretch along z about the centre of mass."""
        poisson = self.body.material.poissons_ratio
        return STRETCH * (self.body.X - self.body.center) * [-poisson, -poisson, 1.0]

    def turned(self) -> float:
        """Strain whose uniaxial energy is that of a rigid turn by 1 rad about an oblique axis."""
        energy = self.kinematics.internal(self.body.X @ rotation_matrix([0.6, 0.48, 0.64]).T)[2]
        return float(np.sqrt(abs(energy) / self._energy))

    def sheared(self) -> float:
        """Largest change that the ties make to a linear displacement, relative to its largest."""
        field = self.body.X @ np.array([[0.3, -0.7, 0.5], [0.9, 0.2, -0.4], [-0.6, 0.8, 1.0]])
        return float(np.abs(self.body.constraint.expand(field) - field).max() / np.abs(field).max())

    def stretched(self) -> float:
        """Energy of the uniform stretch relative to E STRETCH^2 volume / 2."""
        return float(
            self.kinematics.internal(self.body.X + self.uniaxial())[2] / (self._energy * STRETCH**2)
        )

    def pulled(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Displacement (n, 3) [m] under opposite loads of E STRETCH times the lower end's area,
        uniform over each end, and the tributary areas (n,) [m2] of lower and upper end.
        """
        body = self.body
        lower, upper = (end_areas(body, self.mesh, z) for z in (0.0, self.mesh.points[:, 2].max()))
        load = np.zeros_like(body.X)
        load[:, 2] = (
            body.material.youngs_modulus_pa * STRETCH * (upper * lower.sum() / upper.sum() - lower)
        )
        factor, moved = effective_factor(body, _INERTIA, 1.0), np.zeros_like(body.X)
        for _ in range(8):
            moved = moved + factor.solve(load - self.kinematics.internal(body.X + moved)[1])
        factor.destroy()
        return moved, lower, upper
