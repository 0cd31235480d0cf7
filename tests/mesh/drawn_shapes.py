"""Shapes without elements: surfaces as scanners write them, and CAD bodies."""

import numpy as np
import pyvista


def figure(steps=40, noise=0.0):
    """Closed surface of a figure on a flat foot, about 1.5 m high: four ellipsoids in one."""
    grid = pyvista.ImageData(
        dimensions=(steps, steps, 2 * steps),
        spacing=(1.0 / (steps - 1), 1.0 / (steps - 1), 2.0 / (2 * steps - 1)),
        origin=(-0.5, -0.5, -0.1),
    )
    places = np.asarray(grid.points)
    parts = [
        ([0, 0, 0.6], [0.25, 0.2, 0.6]),
        ([0.05, 0, 1.35], [0.15, 0.15, 0.2]),
        ([0.2, 0, 0.9], [0.12, 0.1, 0.35]),
        ([0, 0, 0.1], [0.4, 0.35, 0.3]),
    ]
    inside = [1 - np.linalg.norm((places - middle) / radii, axis=1) for middle, radii in parts]
    grid["inside"] = np.minimum(np.max(inside, axis=0), 20 * places[:, 2])
    surface = grid.contour([0.0], scalars="inside").triangulate().clean()
    surface.clear_data()
    if noise:
        shaken = np.random.default_rng(1).normal(size=surface.points.shape) * noise
        surface.points = surface.points + shaken
    return surface


def box(sides=(0.4, 0.3, 1.2)):
    """Surface of a block of twelve triangles, its foot's middle at the origin."""
    x, y, z = sides
    return pyvista.Box((-x / 2, x / 2, -y / 2, y / 2, 0, z)).triangulate().clean()


def saved(surface, path):
    """The path of a surface as STL, PLY or OBJ; an OBJ in text of our own, as cameras write it."""
    if path.suffix == ".obj":
        lines = [f"v {x} {y} {z} 0.5 0.5 0.5" for x, y, z in surface.points]
        lines += ["vt 0 0", "vn 0 0 1", "o figure"]
        lines += [
            "f " + " ".join(f"{one + 1}/1/1" for one in face)
            for face in surface.faces.reshape(-1, 4)[:, 1:]
        ]
        path.write_text("\n".join(lines) + "\n")
    else:
        surface.save(path, recompute_normals=False)
    return path
