"""Areas by which stiffnesses per area are multiplied, so that the springs of a few points resist
sinking and rocking as those of the whole face do.

The areas tributary to contact points are as large as the face, but most of the points lie on its
outline, farther out than what they stand for: with nine points inside, the second moment of their
areas is a fifth too large. Here a polynomial of second degree is added to the areas' share, so that
area, centre and second moments become those of the face: the weights of a quadrature rule at given
points, exact for polynomials of that degree.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Least share of its tributary area that a point keeps: none may be without a spring.
LEAST_SHARE = 0.3
#: Mean square of a polynomial at the points, over the face's size, below which it is rounding: the
#: points cannot tell it from those of lower degree, as x^2 + y^2 on a circle.
_INDEPENDENT = 1e-6


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
    found = areas + _change(linear, areas, wanted[:3] - linear @ areas)
    # without their parts of lower degree they leave area and centre as they are
    weighted = linear * areas
    alone = quadratic - (np.linalg.pinv(weighted @ linear.T) @ weighted @ quadratic.T).T @ linear
    more = _change(alone, areas, wanted[3:] - quadratic @ found)
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
    areas = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2
    # exact to the second degree: the middles of the three sides
    middles = (triangles + np.roll(triangles, -1, axis=1)) / 2
    integrals: NDArray[Any] = _polynomials(middles.reshape(-1, 2)) @ np.repeat(areas / 3, 3)
    return integrals


def _polynomials(places: NDArray[Any]) -> NDArray[Any]:
    """1, x, y, x^2, x y, y^2 (6, n) at places (n, 2)."""
    x, y = places.T
    return np.array([np.ones(len(x)), x, y, x * x, x * y, y * y])
