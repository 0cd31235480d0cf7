"""Small meshes of one's own: blocks of bricks or tetrahedra, written by meshio."""

import itertools

import meshio
import numpy as np

from fecolumn.case.short_form import short_form

SIDES = 0.2, 0.1, 0.4


def bricks(counts=(4, 2, 6), sides=SIDES):
    """Points and bricks of a block with its foot's middle at the origin."""
    lines = [np.linspace(0, side, n + 1) for side, n in zip(sides, counts)]
    points = np.stack(np.meshgrid(*lines, indexing="ij"), -1).reshape(-1, 3) - [
        sides[0] / 2,
        sides[1] / 2,
        0,
    ]
    number = np.arange(len(points)).reshape([n + 1 for n in counts])
    corners = [
        (0, 0, 0),
        (1, 0, 0),
        (1, 1, 0),
        (0, 1, 0),
        (0, 0, 1),
        (1, 0, 1),
        (1, 1, 1),
        (0, 1, 1),
    ]
    a, b, c = counts
    return points, np.stack(
        [number[i : i + a, j : j + b, k : k + c].ravel() for i, j, k in corners], axis=1
    )


def tetrahedra(counts=(4, 2, 6), sides=SIDES):
    """The same block with each brick cut into six tetrahedra along one diagonal (Kuhn), which fit
    together.
    """
    points, cells = bricks(counts, sides)
    corner = {
        (0, 0, 0): 0,
        (1, 0, 0): 1,
        (1, 1, 0): 2,
        (0, 1, 0): 3,
        (0, 0, 1): 4,
        (1, 0, 1): 5,
        (1, 1, 1): 6,
        (0, 1, 1): 7,
    }
    paths = []
    for axes in itertools.permutations(range(3)):
        place, path = np.zeros(3, int), [0]
        for axis in axes:
            place[axis] = 1
            path.append(corner[tuple(place)])
        paths.append(path)
    return points, np.concatenate([cells[:, path] for path in paths])


def own_case(file, **tables):
    """Case of a mesh file, shaken by nothing for a tenth of a second."""
    return short_form(
        {"column": {"mesh_file": str(file)}, "integration": {"duration_s": 0.1}} | tables,
        "own.toml",
    )


def write(folder, name, kind, points, cells, **options):
    """Path of a mesh file."""
    meshio.Mesh(points, [(kind, cells)]).write(folder / name, **options)
    return folder / name
