"""Mass, centre and inertia of meshes and of what closed surfaces enclose."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from fecolumn.mesh.bricks import BrickMesh
from fecolumn.mesh.jacobian import corner_jacobians

# Corner signs of the VTK hexahedron.
_SIGNS = np.array(
    [
        [-1, -1, -1],
        [1, -1, -1],
        [1, 1, -1],
        [-1, 1, -1],
        [-1, -1, 1],
        [1, -1, 1],
        [1, 1, 1],
        [-1, 1, 1],
    ]
)


@dataclass(frozen=True, slots=True)
class MassProperties:
    """Volume, mass and inertia of a body.

    Attributes
    ----------
    volume
        [m3]
    mass
        [kg].
    centre
        (3,) centre of mass [m].
    inertia
        (3, 3) inertia tensor about the centre of mass [kg m2].
    """

    volume: float
    mass: float
    centre: np.ndarray
    inertia: np.ndarray

    def __add__(self, other: MassProperties) -> MassProperties:
        mass = self.mass + other.mass
        centre = (self.mass * self.centre + other.mass * other.centre) / mass
        inertia = sum(
            one.inertia + one.mass * _steiner(one.centre - centre) for one in (self, other)
        )
        return MassProperties(self.volume + other.volume, mass, centre, inertia)

    def scaled(self, factor: float) -> MassProperties:
        """Those of a body so many times as large, of the same density."""
        cubed = factor**3
        return MassProperties(
            self.volume * cubed,
            self.mass * cubed,
            self.centre * factor,
            self.inertia * cubed * factor**2,
        )


def _steiner(arm: np.ndarray) -> np.ndarray:
    return arm @ arm * np.eye(3) - np.outer(arm, arm)


def mass_properties(mesh: BrickMesh, density: float) -> MassProperties:
    """Mass properties of trilinear bricks, or of tetrahedra; of elements of different density where
    the mesh says so.

    Parameters
    ----------
    mesh
        bricks or tetrahedra.
    density
        [kg/m3].
    """
    shares = 1.0 if mesh.relative_density is None else mesh.relative_density
    space, volume, first, second = 0.0, 0.0, np.zeros(3), np.zeros((3, 3))
    for weight, x in _rule(mesh):
        space += weight.sum()
        weight = weight * shares
        volume += weight.sum()
        first += weight @ x
        second += np.einsum("c,ci,cj->ij", weight, x, x)
    return replace(from_moments(volume, first, second, density), volume=float(space))


def element_moments(mesh: BrickMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Integrals of 1 (n,), x_i (n, 3) and x_i x_j (n, 3, 3) over each element."""
    return _summed(_rule(mesh))


def _rule(mesh: BrickMesh) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Weights (n,) [m3] and places (n, 3) [m] of a rule exact for x_i x_j in each element.

    Three Gauss points a direction are exact for bricks: the Jacobian is quadratic and x_i x_j
    quadratic in each local coordinate.
    """
    corners = mesh.points[mesh.cells]
    if mesh.is_tetrahedral:
        yield from _rule_of_tetrahedra(corners, corner_jacobians(mesh)[:, 0] / 6)
        return
    abscissae, weights = np.polynomial.legendre.leggauss(3)
    for i, j, k in np.ndindex(3, 3, 3):
        factors = 1 + _SIGNS * abscissae[[i, j, k]]
        shape = factors.prod(axis=1) / 8
        slope = np.stack(
            [_SIGNS[:, a] * np.delete(factors, a, axis=1).prod(axis=1) / 8 for a in range(3)]
        )
        weight = np.linalg.det(slope @ corners) * (weights[i] * weights[j] * weights[k])
        yield weight, np.einsum("a,cai->ci", shape, corners)


def _rule_of_tetrahedra(
    corners: np.ndarray, volumes: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """As `_rule`: 4/5 of the volume (n,) in the middle, 1/20 at each of the corners (n, 4, 3)."""
    yield 0.8 * volumes, corners.mean(axis=1)
    for corner in range(4):
        yield volumes / 20, corners[:, corner]


def _summed(
    rule: Iterable[tuple[np.ndarray, np.ndarray]],
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Integrals of 1, x_i and x_i x_j over each element by a rule."""
    volumes, first, second = np.zeros(()), np.zeros(()), np.zeros(())
    for weight, x in rule:
        volumes = volumes + weight
        first = first + weight[:, None] * x
        second = second + weight[:, None, None] * x[:, :, None] * x[:, None, :]
    return volumes, first, second


def enclosed(triangles: np.ndarray) -> MassProperties:
    """What a closed surface encloses at a density of 1, by the divergence theorem: the sum over its
    triangles (n, 3, 3), counter-clockwise from outside, of the tetrahedra to one point, with sign.
    """
    apex = triangles.reshape(-1, 3).mean(axis=0)
    corners = triangles - apex
    volumes = np.einsum("ni,ni->n", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    tetrahedra = np.concatenate([np.zeros((len(corners), 1, 3)), corners], axis=1)
    _, first, second = _summed(_rule_of_tetrahedra(tetrahedra, volumes))
    found = from_moments(volumes.sum(), first.sum(axis=0), second.sum(axis=0), 1.0)
    return MassProperties(found.volume, found.mass, found.centre + apex, found.inertia)


def from_moments(
    volume: float, first: np.ndarray, second: np.ndarray, density: float
) -> MassProperties:
    """Mass properties from the integrals of 1, x_i and x_i x_j over the volume."""
    centre = first / volume
    about_centre = second - volume * np.outer(centre, centre)
    inertia = density * (np.trace(about_centre) * np.eye(3) - about_centre)
    return MassProperties(float(volume), float(density * volume), centre, inertia)
