"""Areas by which stiffnesses per area are multiplied, so that the springs of a few points resist
sinking and rocking as those of the region do in which two faces touch.

The areas tributary to contact points are as large as the face, but most of the points lie on its
outline, farther out than what they stand for: with nine points inside, the second moment of their
areas is a fifth too large. Here a polynomial of second degree is added to the areas' share, so that
area, centre and second moments become those of the region: the weights of a quadrature rule at
given points, exact for polynomials of that degree.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.structures.model import JointModel, Surface
from fecolumn.structures.outlines import cross_product
from fecolumn.structures.standing import Standing, touching

#: Least share of its tributary area that a point keeps: none may be without a spring.
LEAST_SHARE = 0.3
#: Mean square of a polynomial at the points, over the face's size, below which it is rounding: the
#: points cannot tell it from those of lower degree, as x^2 + y^2 on a circle.
_INDEPENDENT = 1e-6


def spring_areas(
    standing: Sequence[Standing], joint: JointModel
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Areas (k,) [m2] of the points of a joint's slave, and rows (n,) of those that have the master
    below them as the bodies stand.

    Those of the rows make up the region in which the two faces overlap. The others touch nothing
    until they slide, and keep the areas tributary to them.
    """
    slave = standing[joint.slave]
    surface, rows = slave.model.surfaces[joint.slave_surface], touching(standing, joint)
    areas, region = surface.areas.copy(), _touching_region(standing, joint, rows)
    if len(rows) and len(region):
        areas[rows] = areas_by_moments(_places(surface, slave)[rows], areas[rows], region)
    return areas, rows


def stiffer_in_rocking(
    standing: Sequence[Standing], joint: JointModel, areas: NDArray[Any], rows: NDArray[Any]
) -> float:
    """Ratio of the second moment of `spring_areas` to that of the region in which the faces of a
    joint touch, about the axis through its centre for which it is farthest from 1.
    """
    slave, region = standing[joint.slave], _touching_region(standing, joint, rows)
    if len(rows) < 2 or not len(region):
        return 1.0
    places = _places(slave.model.surfaces[joint.slave_surface], slave)[rows]
    area, *first = _integrals(region)[:3]
    middle = np.array(first) / area
    own, whole = (
        np.array([[xx, xy], [xy, yy]])
        for xx, xy, yy in (
            _polynomials(places - middle)[3:] @ areas[rows],
            _integrals(region - middle)[3:],
        )
    )
    ratios = np.linalg.eigvals(np.linalg.solve(whole, own)).real
    return float(ratios[np.argmax(np.abs(ratios - 1))])


def _places(surface: Surface, part: Standing) -> NDArray[Any]:
    """Places (k, 2) [m] of a surface's points along its tangents."""
    places: NDArray[Any] = surface.plane(part.model.arms[surface.nodes])[:, :2]
    return places


def _touching_region(
    standing: Sequence[Standing], joint: JointModel, rows: NDArray[Any]
) -> NDArray[Any]:
    """Triangles (r, 3, 2) [m] of the region in which the faces of a joint touch, along the tangents
    of the slave's; rows: of its points there.
    """
    slave = standing[joint.slave]
    surface = slave.model.surfaces[joint.slave_surface]
    if len(rows) == len(surface.nodes) or not len(surface.region):
        return surface.region
    master = standing[joint.master]
    face = master.model.surfaces[str(joint.master_surface)]
    corners = master.center + master.model.arms[face.nodes][face.triangles] - slave.center
    return overlap_of(surface.region, surface.plane(corners)[..., :2])


def overlap_of(triangles: NDArray[Any], others: NDArray[Any]) -> NDArray[Any]:
    """Triangles (r, 3, 2) [m] of the region in which two faces of triangles (n, 3, 2) and (m, 3, 2)
    overlap: each of one cut by the sides of each of the other (Sutherland and Hodgman 1974).
    """
    low, high = triangles.min(axis=1)[:, None], triangles.max(axis=1)[:, None]
    near = ((low < others.max(axis=1)) & (high > others.min(axis=1))).all(axis=2)
    found = []
    for first, second in np.argwhere(near):
        corners, cutter = triangles[first], others[second]
        if cross_product(cutter[1] - cutter[0], cutter[2] - cutter[0]) < 0:
            cutter = cutter[::-1]
        for start, end in zip(cutter, np.roll(cutter, -1, axis=0)):
            corners = _left_of(corners, start, end - start)
        found += [corners[[0, k, k + 1]] for k in range(1, len(corners) - 1)]
    return np.reshape(found, (-1, 3, 2))


def _left_of(corners: NDArray[Any], start: NDArray[Any], along: NDArray[Any]) -> NDArray[Any]:
    """Corners (m, 2) of the part of a convex polygon (n, 2) to the left of a line."""
    if not len(corners):
        return corners
    height, kept = cross_product(along, corners - start), []
    for k, own in enumerate(height):
        if own >= 0:
            kept.append(corners[k])
        after = (k + 1) % len(corners)
        if own * height[after] < 0:
            share = own / (own - height[after])
            kept.append(corners[k] + share * (corners[after] - corners[k]))
    return np.reshape(kept, (-1, 2))


def areas_by_moments(
    places: NDArray[Any], areas: NDArray[Any], triangles: NDArray[Any]
) -> NDArray[Any]:
    """Areas (n,) [m2] of points whose sum, centre and second moments are those of a face.

    Points that cannot have them, as four at corners, get areas that have the sum, then the centre,
    then as much of the second moments as LEAST_SHARE leaves them.

    Parameters
    ----------
    places
        (n, 2) of the points in the plane of the face [m].
    areas
        (n,) tributary to them [m2].
    triangles
        (t, 3, 2) of which the face is made [m].
    """
    middle, size = places.mean(axis=0), np.ptp(places, axis=0).max()
    if not size > 0:
        return areas
    at_points = _polynomials((places - middle) / size)
    wanted = _integrals((triangles - middle) / size) * size**2
    linear, quadratic = at_points[:3], at_points[3:]
    areas = areas * (wanted[0] / areas.sum())
    found = _with_share(areas, areas, _change(linear, areas, wanted[:3] - linear @ areas))
    # without their parts of lower degree they leave area and centre as they are
    weighted = linear * areas
    alone = quadratic - (np.linalg.pinv(weighted @ linear.T) @ weighted @ quadratic.T).T @ linear
    return _with_share(areas, found, _change(alone, areas, wanted[3:] - quadratic @ found))


def _with_share(areas: NDArray[Any], found: NDArray[Any], more: NDArray[Any]) -> NDArray[Any]:
    """Areas found (n,) [m2] and as much of what is to be added to them (n,) as leaves LEAST_SHARE
    of the areas (n,).
    """
    falls = more < 0
    part = np.min((found - LEAST_SHARE * areas)[falls] / -more[falls], initial=1.0)
    enough: NDArray[Any] = found + max(part, 0.0) * more
    return enough


def _change(polynomials: NDArray[Any], areas: NDArray[Any], missing: NDArray[Any]) -> NDArray[Any]:
    """Change (n,) [m2] of the areas, a sum of the polynomials (k, n) times them, that gives the
    integrals missing (k,) [m2], as many as the points can have.
    """
    weighted = polynomials * areas
    values, ways = np.linalg.eigh(weighted @ polynomials.T)
    told_apart = values > _INDEPENDENT * areas.sum()
    inverse = np.divide(1.0, values, out=np.zeros(len(values)), where=told_apart)
    change: NDArray[Any] = (ways @ (inverse * (ways.T @ missing))) @ weighted
    return change


def _integrals(triangles: NDArray[Any]) -> NDArray[Any]:
    """Integrals (6,) of the polynomials over triangles (t, 3, 2)."""
    first, second = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    areas = np.abs(cross_product(first, second)) / 2
    # exact to the second degree: the middles of the three sides
    middles = (triangles + np.roll(triangles, -1, axis=1)) / 2
    integrals: NDArray[Any] = _polynomials(middles.reshape(-1, 2)) @ np.repeat(areas / 3, 3)
    return integrals


def _polynomials(places: NDArray[Any]) -> NDArray[Any]:
    """1, x, y, x^2, x y, y^2 (6, n) at places (n, 2)."""
    x, y = places.T
    return np.array([np.ones(len(x)), x, y, x * x, x * y, y * y])
