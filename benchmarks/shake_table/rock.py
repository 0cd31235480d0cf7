"""A rigid rock from the scan of its surface, and the engine that shakes it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection
from scipy.spatial.transform import Rotation

from fecolumn.contact.overturning import Limits
from fecolumn.contact.points import GROUND
from fecolumn.contact.unbounded_base import rigid_base
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced.start import of_parts
from fecolumn.engines.reduced_engine import engine_on
from fecolumn.structures.model import BodyModel, JointModel, Part, StructureModel, Surface

#: The pose of rest is sought within this angle of the scan's vertical.
NEAR = np.radians(5)
#: Tilt from rest at which the rock has overturned, and the farther one up to which its surface may
#: touch.
OVERTURNED, TOUCHES = np.radians(45), np.radians(60)


@dataclass(frozen=True)
class Stone:
    """mass [kg], or nan for density [kg/m3] times the scan's volume; youngs [Pa], poisson; softer:
    factor on the compliance of each contact point; friction, restitution; direction: of the table's
    positive displacement, from the scan's x towards its y [rad]; rounding: radius of the edges
    [m].
    """

    mass: float = np.nan
    density: float = 2700.0
    youngs: float = 50e9
    poisson: float = 0.25
    softer: float = 1.0
    friction: float = 0.6
    restitution: float = 0.0
    direction: float = 0.0
    rounding: float = 0.0


def read_scan(file: Path) -> tuple[np.ndarray, np.ndarray]:
    """Corners (n, 3) [m] and outward triangles (t, 3) of a closed surface.

    Raises
    ------
    ValueError
        no triangles, or the surface is not closed.
    """
    import meshio

    try:
        mesh = meshio.read(file)
    except (Exception, SystemExit) as error:
        raise ValueError(f"{file}: cannot be read as a mesh by meshio: {error}") from None
    if "triangle" not in mesh.cells_dict:
        raise ValueError(f"{file}: has no triangles")
    corners, same = np.unique(mesh.points, axis=0, return_inverse=True)
    triangles = same.ravel()[mesh.cells_dict["triangle"]]
    triangles = triangles[[len(set(triangle)) == 3 for triangle in triangles.tolist()]]
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    open_sides = (np.unique(sides, axis=0, return_counts=True)[1] != 2).sum()
    if open_sides:
        raise ValueError(
            f"{file}: the surface is not closed, {open_sides} of its edges do not part "
            "two triangles"
        )
    corners = corners - corners.mean(axis=0)
    if signed_volumes(corners, triangles).sum() < 0:
        triangles = triangles[:, ::-1]
    return corners, triangles


def signed_volumes(corners, triangles):
    """Volumes (t,) [m3] of the tetrahedra between the origin and each triangle."""
    a, b, c = np.moveaxis(corners[triangles], 1, 0)
    return np.einsum("ij,ij->i", a, np.cross(b, c)) / 6


def solid(corners, triangles) -> tuple[float, np.ndarray, np.ndarray]:
    """Volume [m3], centre (3,) [m] and inertia (3, 3) [m5] about it of the solid in a closed
    surface, of density 1: exact, by tetrahedra.
    """
    volumes = signed_volumes(corners, triangles)
    volume = volumes.sum()
    center = volumes @ corners[triangles].sum(axis=1) / 4 / volume
    points = corners[triangles] - center
    volumes = np.einsum("ij,ij->i", points[:, 0], np.cross(points[:, 1], points[:, 2])) / 6
    whole = points.sum(axis=1)
    second = (
        np.einsum("t,tka,tkb->ab", volumes, points, points)
        + np.einsum("t,ta,tb->ab", volumes, whole, whole)
    ) / 20
    return volume, center, np.trace(second) * np.eye(3) - second


def at_rest(corners, center, facets) -> tuple[np.ndarray, float]:
    """Rotation (3, 3) from the scan to rest, and its angle [rad]: on that facet near below on which
    the centre of mass is lowest.
    """
    normals, heights = facets[:, :3], -facets[:, 3] - facets[:, :3] @ center
    near = np.arccos(np.clip(-normals[:, 2], -1, 1)) < NEAR
    if not near.any():
        raise ValueError(
            "the scan does not stand: no facet of its convex hull lies within "
            f"{np.degrees(NEAR):.0f} degrees of the ground"
        )
    down = normals[near][np.argmin(heights[near])]
    angle = np.arccos(np.clip(-down[2], -1, 1))
    axis = np.cross(down, [0.0, 0.0, -1.0])
    return Rotation.from_rotvec(
        angle * axis / max(np.linalg.norm(axis), np.finfo(float).tiny)
    ).as_matrix(), float(angle)


def rounded(facets: np.ndarray, center: np.ndarray, radius: float) -> np.ndarray:
    """Corners (n, 3) [m] of a convex body whose edges are rounded by a ball of `radius` [m]: of
    its facets what the ball touches; an edge is a chamfer between two of them.

    Parameters
    ----------
    facets
        (f, 4) outward normals and offsets, as of a ConvexHull.
    center
        (3,) [m] within the body.

    Raises
    ------
    ValueError
        the ball does not fit beside the centre.
    """
    facets = np.unique(facets.round(12), axis=0)
    if not (facets[:, :3] @ center + facets[:, 3] + radius < 0).all():
        raise ValueError(f"rounding: a ball of {radius:.3g} m is too large for the scan")
    cut = HalfspaceIntersection(facets + [0, 0, 0, radius], center)
    corners = np.concatenate(
        [
            corner + radius * facets[list(planes), :3]
            for corner, planes in zip(cut.intersections, cut.dual_facets)
        ]
    )
    # of facets that are nearly one plane one corner is enough
    return corners[np.unique((2 * corners / radius).round(), axis=0, return_index=True)[1]]


def body_of(scan: Path, stone: Stone) -> BodyModel:
    """The rigid body of a scan, at rest, with the corners of its convex hull that touch up to
    TOUCHES as contact points.

    A point has the local compliance of the half-space under a rigid disk of its tributary area,
    normal (1 - nu^2) / (2 a E) and tangential that times (2 - nu) / (2 - 2 nu) (Johnson, Contact
    Mechanics, 3.4 and 3.7): the stone's alone, the ground is rigid.

    Raises
    ------
    ValueError
        the scan is not closed, or does not stand.
    """
    corners, triangles = read_scan(scan)
    volume, center, inertia = solid(corners, triangles)
    mass = stone.density * volume if np.isnan(stone.mass) else stone.mass
    hull = ConvexHull(corners)
    turn, _ = at_rest(corners, center, hull.equations)
    if stone.rounding:
        corners = rounded(hull.equations, center, stone.rounding)
        hull = ConvexHull(corners)
        triangles = hull.simplices
    spin = Rotation.from_euler("z", -stone.direction).as_matrix() @ turn
    down = np.arccos(np.clip(-(hull.equations[:, :3] @ spin.T)[:, 2], -1, 1)) < TOUCHES
    feet = np.unique(hull.simplices[down])
    areas = np.zeros(len(corners))
    spans = corners[triangles[:, 1:]] - corners[triangles[:, :1]]
    np.add.at(
        areas, triangles, np.linalg.norm(np.cross(spans[:, 0], spans[:, 1]), axis=1)[:, None] / 6
    )
    arms, area = (corners[feet] - center) @ spin.T, areas[feet]
    n, nu = len(feet), stone.poisson
    normal = stone.softer * (1 - nu**2) / (2 * np.sqrt(area / np.pi) * stone.youngs)
    flexibility = np.zeros((n, n, 3, 3))
    flexibility[np.arange(n), np.arange(n)] = normal[:, None, None] * np.diag(
        [(2 - nu) / (2 - 2 * nu)] * 2 + [1.0]
    )
    foot = Surface(
        np.arange(n),
        np.array([0.0, 0, arms[:, 2].min()]),
        np.diag([1.0, -1.0, -1.0]),
        area,
        np.ones(n, bool),
        np.zeros((0, 3), int),
    )
    top = (corners @ spin.T)[:, 2].argmax()
    return BodyModel(
        mass,
        mass / volume * spin @ inertia @ spin.T,
        np.array([0.0, 0, -arms[:, 2].min()]),
        np.zeros(0),
        np.zeros((n, 3, 0)),
        flexibility,
        arms,
        0,
        {"foot": foot},
        {"top": ((corners[top] - center) @ spin.T, np.zeros((3, 0)))},
    )


def engine_of(body: BodyModel, stone: Stone, dt: float, alpha: float = -0.05) -> Engine:
    """Engine of the rock alone on rigid ground, standing."""
    part = Part("rock", body, body.center, np.eye(3), 0.0, np.zeros(3), np.zeros(3))
    joint = JointModel(
        "rock on table",
        0,
        "foot",
        GROUND,
        None,
        stone.friction,
        np.zeros((len(body.arms), 3)),
        False,
        stone.restitution,
    )
    base = rigid_base(body.reference)
    model = StructureModel((part,), (joint,), (), base, (0, "top"))
    begin = partial(of_parts, parts=model.parts, stands=True)
    return engine_on(model, HHT(dt, alpha), begin, limits=Limits.of_tilt(1, OVERTURNED))
