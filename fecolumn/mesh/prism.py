"""Prisms: polygons in quadrilaterals, extruded to bricks.

An outline that is a row of convex quadrilaterals, as that of a block, a tapered pier or a voussoir,
is meshed in a regular grid of each; any other by Gmsh, each corner a node in both.
"""

from __future__ import annotations

import itertools

import numpy as np
from scipy.spatial import cKDTree

from fecolumn.mesh.bricks import BrickMesh, brick_mesh
from fecolumn.mesh.column import divisions
from fecolumn.mesh.gmsh_section import NotMeshed, generated, gmsh_model

# Least sine of the angles of the quadrilaterals of a row
_BLUNT = 0.15
# Over the size of a polygon: points of Gmsh are this near to where they are meant to be
_SAME = 1e-6
# Quadrilaterals of Gmsh over the area they have at the size that is asked for
_MORE = 1.3


def prism_mesh(corners: np.ndarray, levels: np.ndarray, size: float, part: int) -> BrickMesh:
    """Bricks of a polygon extruded between levels.

    Parameters
    ----------
    corners
        (n, 2) [m] of a simple polygon, in either sense.
    levels
        (k,) rising [m].
    size
        of elements in the polygon [m].
    """
    plane, quads = polygon_mesh(corners, size)
    count, layers = len(plane), np.arange(len(levels) - 1)[:, None, None]
    cells = np.concatenate([quads + count * layers, quads + count * (layers + 1)], axis=2)
    points = np.column_stack([np.tile(plane, (len(levels), 1)), np.repeat(levels, count)])
    return brick_mesh(points, cells.reshape(-1, 8), part)


def polygon_mesh(corners: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) [m] and quadrilaterals (m, 4) of a polygon."""
    corners = _counter_clockwise(corners)
    rails = _rails(corners)
    return _free(corners, size) if rails is None else _grid(corners[rails], size)


def polygon_counts(corners: np.ndarray, size: float, order: int) -> tuple[int, int]:
    """Quadrilaterals of `polygon_mesh` and Lagrange nodes of elements of an order, told without
    making them; of what Gmsh meshes roughly.
    """
    corners = _counter_clockwise(corners)
    rails = _rails(corners)
    if rails is not None:
        across, along = _grid_sizes(corners[rails], size)
        return across * sum(along), (order * across + 1) * (order * sum(along) + 1)
    around = sum(2 * count for count in _halves(corners, size))
    cells = round(_MORE * abs(_area(corners)) / size**2) + around // 2
    # Euler: of a polygon without holes
    points, sides = cells + around // 2 + 1, (4 * cells + around) // 2
    return cells, points + (order - 1) * sides + (order - 1) ** 2 * cells


def _area(corners: np.ndarray) -> float:
    x, y = (corners - corners[0]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def _counter_clockwise(corners: np.ndarray) -> np.ndarray:
    corners = np.asarray(corners, dtype=float)
    return corners if _area(corners) > 0 else corners[::-1]


def _rails(corners: np.ndarray) -> np.ndarray | None:
    """Numbers (2, n) of the corners of both long sides of a row of convex quadrilaterals, of
    several ways to see one that with the bluntest angles; None where there is none.
    """
    count = len(corners)
    if count % 2:
        return None
    best, sharpest = None, _BLUNT
    for first in range(count // 2):
        steps = np.arange(count // 2)
        rails = np.stack([first + steps, first - 1 - steps]) % count
        left, right = corners[rails]
        quads = np.stack([left[:-1], left[1:], right[1:], right[:-1]], axis=1)
        ahead = np.roll(quads, -1, axis=1) - quads
        ahead /= np.linalg.norm(ahead, axis=2)[..., None]
        behind = np.roll(ahead, 1, axis=1)
        sines = behind[..., 0] * ahead[..., 1] - behind[..., 1] * ahead[..., 0]
        if sines.min() > sharpest + 1e-9:
            best, sharpest = rails, sines.min()
    return best


def _grid_sizes(rails: np.ndarray, size: float) -> tuple[int, list[int]]:
    """Quadrilaterals across the rails (2, n, 2) [m] and along each of their sides."""
    across = np.linalg.norm(rails[1] - rails[0], axis=1).max()
    along = np.linalg.norm(np.diff(rails, axis=1), axis=2).max(axis=0)
    return divisions(across, size), [divisions(length, size) for length in along]


def _grid(rails: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    across, along = _grid_sizes(rails, size)
    left, right = (
        np.concatenate(
            [
                rail[:1],
                *(
                    start + np.arange(1, n + 1)[:, None] / n * (end - start)
                    for start, end, n in zip(rail, rail[1:], along)
                ),
            ]
        )
        for rail in rails
    )
    # ends exactly, which neighbours have, too
    share = np.arange(across + 1)[:, None, None] / across
    points = ((1 - share) * left + share * right).reshape(-1, 2)
    row = len(left)
    start = (np.arange(across)[:, None] * row + np.arange(row - 1)).ravel()
    return points, np.stack([start, start + 1, start + row + 1, start + row], axis=1)


def _halves(corners: np.ndarray, size: float) -> list[int]:
    """Pairs of quadrilaterals along each side of a polygon that Gmsh meshes."""
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    return [divisions(length, 2 * size) for length in sides]


def _free(corners: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Quadrilaterals by Gmsh: triangles of twice the size, recombined and halved."""
    halves = _halves(corners, size)
    with gmsh_model() as gmsh:
        gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 1)
        geo = gmsh.model.geo
        tags = [geo.addPoint(x, y, 0.0) for x, y in corners.tolist()]
        lines = [geo.addLine(*ends) for ends in zip(tags, tags[1:] + tags[:1])]
        for line, half in zip(lines, halves):
            geo.mesh.setTransfiniteCurve(line, half + 1)
        surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
        geo.mesh.setRecombine(2, surface)
        points, quads = generated(gmsh, 2)
    return _evened(points[:, :2], corners, halves), quads


def _evened(points: np.ndarray, corners: np.ndarray, halves: list[int]) -> np.ndarray:
    """Points (n, 2) [m], those on the sides in exactly equal distances."""
    exact = np.concatenate(
        [
            start + np.arange(2 * half)[:, None] / (2 * half) * (end - start)
            for (start, end), half in zip(
                itertools.pairwise([*corners, corners[0]]), halves, strict=True
            )
        ]
    )
    apart, place = cKDTree(points).query(exact)
    if apart.max() > _SAME * np.ptp(corners, axis=0).max():
        raise NotMeshed("Gmsh returned a polygon with other points along its sides")
    points[place] = exact
    return points
