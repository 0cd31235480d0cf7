"""Closed surfaces of triangles, such as scans: read, checked, cut off flat."""

from __future__ import annotations

import contextlib
import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from fecolumn.mesh.mesh_file import UnusableShape

if TYPE_CHECKING:
    import pyvista


# Of the height: how uneven what the body stands on may be to be taken for a flat foot, and be made
# one; what a scanner's noise leaves on a floor
_UNEVEN = 2e-3
# Cosine of the angle with the vertical of triangles that look down
_DOWN = 0.9
# Of the whole surface: pieces of less area are specks of a scan, and are left out
_SPECK = 1e-3
# Of the size of a body: points so near are one
_SAME_POINT = 1e-7
_FEWEST, _MOST = 4, 5_000_000


@dataclass(frozen=True)
class ClosedSurface:
    """A surface that encloses one body, counter-clockwise seen from outside.

    points: (n, 3) [m]. triangles: (m, 3) point numbers. notes: what was mended, in words.
    """

    points: np.ndarray
    triangles: np.ndarray
    notes: tuple[str, ...]

    @property
    def corners(self) -> np.ndarray:
        """Corners (m, 3, 3) [m] of the triangles."""
        return self.points[self.triangles]

    @property
    def area(self) -> float:
        """Area [m2]."""
        a, b, c = self.corners.transpose(1, 0, 2)
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def closed_surface(path: Path, metres: float, cut_foot: float | None) -> ClosedSurface:
    """The surface of an STL, OBJ or PLY file.

    Parameters
    ----------
    metres
        of a unit of the file.
    cut_foot
        height [m] above its lowest point at which it is cut off, or None.

    Raises
    ------
    UnusableShape
        no such surface, holes, several bodies.
    """
    _check_whole(path)
    surface, notes = _cleaned(_read(path), metres), []
    if cut_foot is not None:
        surface = _cut(surface, cut_foot)
    surface, more = _one_piece(surface)
    notes += more
    _check_closed(surface, cut_foot)
    surface, more = _outwards(surface)
    notes += more
    points = np.array(surface.points, float)
    triangles = np.array(surface.faces.reshape(-1, 4)[:, 1:], np.int64)
    points, more = flat_foot(points, triangles)
    return ClosedSurface(points, triangles, (*notes, *more))


def _check_whole(path: Path) -> None:
    """Refuse files that were cut off, which readers may take as they are."""
    size = path.stat().st_size
    if size == 0:
        raise UnusableShape("0 bytes", "the file is empty")
    with open(path, "rb") as file:
        head = file.read(4096)
        file.seek(max(0, size - 512))
        tail = file.read().lower()
    if path.suffix.lower() == ".stl":
        count = int.from_bytes(head[80:84], "little")
        if size == 84 + 50 * count and size > 84:
            return
        if not head.lstrip().lower().startswith(b"solid") or b"\0" in head:
            there = (size - 84) / 50
            raise UnusableShape(
                f"{max(there, 0):g} triangles",
                f"must hold the {count} that its head tells; the file is cut off or no STL",
            )
        if b"endsolid" not in tail:
            raise UnusableShape(None, "must end with endsolid; the file is cut off")
    if path.suffix.lower() == ".ply":
        if not head.startswith(b"ply") or b"\nend_header" not in head.replace(b"\r", b"\n"):
            raise UnusableShape(None, "must begin with the head of a PLY, from ply to end_header")
        for count in re.findall(rb"^element \w+ (\S+)", head, re.MULTILINE):
            if not count.isdigit() or int(count) > size:
                raise UnusableShape(
                    f"element {count.decode('latin-1')[:20]}", "must be there as the head tells"
                )


def _read(path: Path) -> pyvista.PolyData:
    """What a file holds, as a pyvista.PolyData."""
    import meshio
    import pyvista

    try:
        # meshio prints to the console and exits where a file is broken
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            if path.suffix.lower() == ".obj":
                points, faces = _of_obj(path.read_text(errors="replace"))
            else:
                found = meshio.read(path)
                points = np.array(found.points, float)
                faces = [np.array(one.data, np.int64) for one in found.cells]
    except (SystemExit, Exception) as error:  # the readers raise whatever their parsing meets
        said = " ".join(str(error).split())[:200]
        raise UnusableShape(None, f"cannot be read: {type(error).__name__}: {said}") from None
    faces = [one for one in faces if one.ndim == 2 and one.size]
    count = sum(map(len, faces))
    if not count or points.ndim != 2 or points.shape[1] != 3:
        raise UnusableShape("no triangles", "must be a closed surface of triangles")
    if count > _MOST:
        raise UnusableShape(f"{count} triangles", f"must be at most {_MOST}: decimate the scan")
    for one in faces:
        if one.shape[1] < 3 or one.min() < 0 or one.max() >= len(points):
            raise UnusableShape(
                f"a face of corners {one.min()} to {one.max()}",
                f"must have three corners or more among the {len(points)} of the file",
            )
    if not np.isfinite(points).all():
        raise UnusableShape(None, "coordinates must be finite numbers")
    rows = [np.insert(one, 0, one.shape[1], axis=1).ravel() for one in faces]
    return pyvista.PolyData(points, np.concatenate(rows))


def _of_obj(text: str) -> tuple[np.ndarray, list[np.ndarray]]:
    """Points (n, 3) and faces of an OBJ file; meshio's reader takes no textures."""
    points, faces = [], []
    for line in text.splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            points.append([float(one) for one in rest[:3]])
        elif word == "f":
            corners = [int(one.split("/")[0]) for one in rest]
            # a negative number counts back from the last point before the face
            counted = [one - 1 if one > 0 else len(points) + one for one in corners]
            faces.append(np.array([counted], np.int64))
    return np.array(points, float), faces


def _cleaned(found: pyvista.PolyData, metres: float) -> pyvista.PolyData:
    """Triangles alone, in metres, points that coincide made one."""
    surface = found.triangulate()
    surface.points = np.asarray(surface.points, float) * metres
    size = np.ptp(surface.points, axis=0).max() if surface.n_points else 0.0
    if not size > 0 or not np.isfinite(size):
        raise UnusableShape("all points in one place", "must be a surface around a body")
    surface = surface.clean(
        tolerance=_SAME_POINT * size, absolute=True, lines_to_points=False, polys_to_lines=False
    )
    if surface.n_cells < _FEWEST or surface.n_lines or surface.n_strips:
        raise UnusableShape(
            f"{surface.n_cells} triangles", "must be a closed surface of at least four triangles"
        )
    return surface


def _cut(surface: pyvista.PolyData, height: float) -> pyvista.PolyData:
    """What lies higher than `height` [m] above the lowest point, closed by a level plane."""
    import pyvista
    import vtk

    low, tall = surface.points[:, 2].min(), np.ptp(surface.points[:, 2])
    if height >= 0.5 * tall:
        raise UnusableShape(
            f"cut_foot_m = {height:g} m", f"must be less than half of the height, {tall:.4g} m"
        )
    normals = surface.compute_normals(
        cell_normals=False, auto_orient_normals=True, split_vertices=False
    )
    plane = vtk.vtkPlane()
    plane.SetNormal(0.0, 0.0, 1.0)
    plane.SetOrigin(0.0, 0.0, low + height)
    planes = vtk.vtkPlaneCollection()
    planes.AddItem(plane)
    clip = vtk.vtkClipClosedSurface()
    clip.SetInputData(normals)
    clip.SetClippingPlanes(planes)
    clip.SetTolerance(1e-9)
    clip.Update()
    cut = pyvista.wrap(clip.GetOutput())
    if cut.n_cells < _FEWEST:
        raise UnusableShape(f"cut_foot_m = {height:g} m", "leaves nothing of the surface")
    cut = cut.triangulate()
    cut.clear_data()
    points = np.asarray(cut.points, float)
    points[np.abs(points[:, 2] - low - height) < _SAME_POINT * tall, 2] = low + height
    cut.points = points
    return cut.clean(tolerance=_SAME_POINT * tall, absolute=True, polys_to_lines=True)


def _one_piece(surface: pyvista.PolyData) -> tuple[pyvista.PolyData, list[str]]:
    """The largest piece, where all others together are specks."""
    faces = surface.faces.reshape(-1, 4)[:, 1:]
    n = surface.n_points
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    count, label = connected_components(
        coo_array((np.ones(len(ends), np.int8), ends.T), shape=(n, n)), directed=False
    )
    a, b, c = surface.points[faces].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    of_piece = np.bincount(label[faces[:, 0]], area, minlength=count)
    pieces = int(np.count_nonzero(of_piece))
    if pieces <= 1:
        return surface, []
    largest = int(of_piece.argmax())
    others = of_piece.sum() - of_piece[largest]
    if others > _SPECK * of_piece.sum():
        second = np.sort(of_piece)[-2] / of_piece.sum()
        raise UnusableShape(
            f"{pieces} pieces",
            f"must be one closed surface; the second largest has {100 * second:.2g} % of the area: "
            "unite what overlaps; leave a cavity out, and state mass_kg, centre_m and "
            "inertia_kg_m2 of the hollow body instead",
        )
    kept = surface.extract_cells(np.flatnonzero(label[faces[:, 0]] == largest))
    kept = kept.extract_surface(algorithm="dataset_surface").clean()
    kept.clear_data()
    return kept, [f"left out {pieces - 1} specks of {100 * others / of_piece.sum():.2g} % of area"]


def _check_closed(surface: pyvista.PolyData, cut_foot: float | None) -> None:
    """Refuse holes and edges of three and more triangles, naming how many, where and how large."""
    kinds = dict(boundary_edges=False, non_manifold_edges=False, feature_edges=False)
    edges = surface.extract_feature_edges(
        **(kinds | {"boundary_edges": True}), manifold_edges=False
    )
    low, tall = surface.points[:, 2].min(), np.ptp(surface.points[:, 2])
    if edges.n_cells:
        loops = edges.connectivity("all")
        region = np.asarray(loops.point_data["RegionId"])
        places = [loops.points[region == one] for one in range(region.max() + 1)]
        largest = max(places, key=lambda one: np.ptp(one, axis=0).max())
        x, y, z = largest.mean(axis=0)
        top = largest[:, 2].max() - low
        way = "close them in the program that made the surface"
        if cut_foot is None and top < 0.25 * tall:
            way = f"cut_foot_m = {1.05 * top + 1e-3 * tall:.3g} cuts it off and closes it there"
        holes = f"{len(places)} hole{'s' * (len(places) > 1)}"
        raise UnusableShape(
            holes,
            f"must be closed; the largest hole is {np.ptp(largest, axis=0).max():.3g} m wide, has "
            f"{len(largest)} corners and lies at x = {x:.4g}, y = {y:.4g}, z = {z:.4g} m: {way}",
        )
    edges = surface.extract_feature_edges(
        **(kinds | {"non_manifold_edges": True}), manifold_edges=False
    )
    if edges.n_cells:
        x, y, z = edges.points[0]
        raise UnusableShape(
            f"{edges.n_cells} edges of three or more triangles",
            f"must have two at each edge; the first lies at x = {x:.4g}, y = {y:.4g}, "
            f"z = {z:.4g} m: remove doubled and inner faces in the program that made the surface",
        )


def _outwards(surface: pyvista.PolyData) -> tuple[pyvista.PolyData, list[str]]:
    """All triangles counter-clockwise seen from outside."""
    turned = surface.compute_normals(
        cell_normals=False,
        point_normals=True,
        consistent_normals=True,
        auto_orient_normals=True,
        split_vertices=False,
    )
    turned.clear_data()
    before, after = (
        one.points[one.faces.reshape(-1, 4)[:, 1:]].astype(float) for one in (surface, turned)
    )
    way, other = (np.cross(one[:, 1] - one[:, 0], one[:, 2] - one[:, 0]) for one in (before, after))
    # VTK may have put them into another order
    _, same = cKDTree(before.mean(axis=1)).query(after.mean(axis=1))
    inverted = int((np.einsum("ni,ni->n", way[same], other) < 0).sum())
    note = f"{inverted} of {len(after)} triangles looked inwards, and were turned"
    return turned, [note] if inverted else []


def flat_foot(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """The points (n, 3) [m] with an almost flat foot made flat, and what was done, in words."""
    low, tall = points[:, 2].min(), np.ptp(points[:, 2])
    corners = points[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    near = (corners[:, :, 2] - low < _UNEVEN * tall).all(axis=1)
    down = near & (normal[:, 2] < -_DOWN * np.linalg.norm(normal, axis=1))
    foot = np.unique(triangles[down])
    rise = points[foot, 2].max() - low if len(foot) else 0.0
    if not rise:
        return points, []
    points = points.copy()
    points[foot, 2] = low
    return points, [f"a foot uneven by {rise:.2g} m was made flat"] if rise > 1e-6 * tall else []
