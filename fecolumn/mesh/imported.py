"""A user's mesh of the column, read through meshio."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from fecolumn.case import Case
from fecolumn.mesh.bricks import UPPER, BrickMesh, boundary_quads, brick_mesh
from fecolumn.mesh.jacobian import corner_jacobians
from fecolumn.schema import InputError

_DIMENSION_TOLERANCE = 0.01
_BELOW_THREE_DIMENSIONS = {"vertex", "line", "line3", "triangle", "triangle6", "quad", "quad8", "quad9"}


def imported_column(case: Case) -> BrickMesh:
    """Column of `case.column.mesh_file`, its foot shifted to z = 0, all bricks in the part UPPER.

    The axis must be the z axis, lengths must be in metres, height and outer diameter must agree with the case within
    1 %. Shells, lines and points beside the bricks are left out; bricks with exchanged bottom and top are turned.

    Raises:
        InputError: the file cannot be read, holds other solids than 8-node bricks, is broken, or does not fit the case.
    """
    def refuse(value, allowed):
        raise InputError(case.column.mesh_file, "column.mesh_file", value, allowed)

    found = _read(Path(case.column.mesh_file), refuse)
    solids = {block.type: 0 for block in found.cells if len(block.data)}
    for block in found.cells:
        if len(block.data):
            solids[block.type] += len(block.data)
    others = {kind: n for kind, n in solids.items() if kind != "hexahedron" and kind not in _BELOW_THREE_DIMENSIONS}
    if others or "hexahedron" not in solids:
        listed = ", ".join(f"{n} x {kind}" for kind, n in (others or solids).items()) or "no elements"
        refuse(listed, "must hold 8-node bricks (Abaqus C3D8, Gmsh and VTK hexahedron) as its only solids")
    cells = np.concatenate([block.data for block in found.cells if block.type == "hexahedron"]).astype(np.int64)
    points = np.asarray(found.points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3:
        refuse(f"points of shape {points.shape}", "must have three coordinates a point")
    if cells.min() < 0 or cells.max() >= len(points):
        refuse(f"brick refers to point {cells.max()} of {len(points)}", "every brick's points must be in the file")
    used, cells = np.unique(cells, return_inverse=True)
    points, cells = points[used], cells.reshape(-1, 8)
    if not np.all(np.isfinite(points)):
        refuse(f"{int(np.sum(~np.isfinite(points).all(axis=1)))} points", "coordinates must be finite numbers")

    points = points - [0.0, 0.0, points[:, 2].min()]
    mesh = brick_mesh(points, cells, UPPER)
    _check_dimensions(points, case, refuse)
    _check_bricks(mesh, case, refuse)
    return mesh


def _read(path: Path, refuse):
    """meshio's mesh of a file."""
    import meshio

    if path.stat().st_size == 0:
        refuse("0 bytes", "the file is empty")
    if path.suffix.lower() == ".inp":
        # meshio keeps the last *NODE block only and would connect the other parts' bricks to its points.
        blocks = len(re.findall(r"^\*\s*node\s*(?:,|$)", path.read_text(errors="replace"), re.IGNORECASE | re.MULTILINE))
        if blocks != 1:
            refuse(f"{blocks} *NODE blocks", "must hold one *NODE block: export the column as one part")
    try:
        # meshio prints to the console and exits where a file is of no known or of a broken format.
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(out):
            return meshio.read(path)
    except KeyError as error:
        refuse(None, f"cannot be read: an element refers to {error.args[0]}, which the file does not define")
    except (SystemExit, Exception) as error:  # the readers raise whatever their parsing meets
        said = str(error) if not isinstance(error, SystemExit) else " ".join(out.getvalue().split())
        refuse(None, f"cannot be read as a mesh by meshio: {said or type(error).__name__}")


def _check_dimensions(points, case: Case, refuse) -> None:
    column = case.column
    height, diameter = np.ptp(points[:, 2]), np.ptp(points[:, :2], axis=0).mean()
    for key, value, wanted in (("height_m", height, column.height_m), ("outer_diameter_m", diameter, column.outer_diameter_m)):
        if abs(value / wanted - 1) <= _DIMENSION_TOLERANCE:
            continue
        hint = ""
        for unit, factor in (("millimetres", 1e3), ("centimetres", 1e2), ("inches", 1 / 0.0254)):
            if abs(value / (wanted * factor) - 1) < 0.1:
                hint = f"; the file seems to be in {unit}, lengths must be in metres"
        refuse(f"{value:g} m", f"must agree with column.{key} = {wanted:g} m within {_DIMENSION_TOLERANCE:.0%}{hint}")
    centre = (points[:, :2].min(axis=0) + points[:, :2].max(axis=0)) / 2
    if np.abs(centre).max() > _DIMENSION_TOLERANCE * column.outer_diameter_m:
        refuse(f"axis at x = {centre[0]:g} m, y = {centre[1]:g} m", "the column's axis must be x = y = 0")


def _check_bricks(mesh: BrickMesh, case: Case, refuse) -> None:
    bad = np.flatnonzero(corner_jacobians(mesh).min(axis=1) <= 0)
    if len(bad):
        x, y, z = mesh.points[mesh.cells[bad[0]]].mean(axis=0)
        refuse(f"{len(bad)} of {len(mesh.cells)} bricks",
               f"must not be folded or flat (positive Jacobian at every corner); first one at x = {x:g}, y = {y:g}, z = {z:g} m")
    n = len(mesh.points)
    edges = np.stack([mesh.cells, np.roll(mesh.cells, 1, axis=1)]).reshape(2, -1)
    pieces, _ = connected_components(coo_array((np.ones(edges.shape[1], np.int8), edges), shape=(n, n)), directed=False)
    if pieces > 1:
        refuse(f"{pieces} unconnected pieces", "must be one connected body: merge coincident points before export")
    if not len(boundary_quads(mesh, UPPER, 0.0, 1e-6 * case.column.height_m)):
        refuse(None, "must stand on a flat foot: no brick has a face in the lowest horizontal plane")
