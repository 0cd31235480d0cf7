"""A user's shape of a body: elements read through meshio, or made inside what was drawn."""

from __future__ import annotations

import contextlib
import functools
import io
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from fecolumn.foundation.content import content
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import (
    FACES,
    TETRAHEDRON_FACES,
    UPPER,
    BrickMesh,
    boundary_faces,
    brick_mesh,
    outer_faces,
)
from fecolumn.mesh.filled import filled
from fecolumn.mesh.jacobian import corner_jacobians
from fecolumn.mesh.mass import MassProperties
from fecolumn.mesh.mesh_file import MeshFile, UnusableShape
from fecolumn.mesh.upright import Upright
from fecolumn.mesh.weighing import NoSuchDensity, relative_densities

# raises the InputError of a value and of what is allowed
ShapeRefusal = Callable[[object, str], NoReturn]

_DIMENSION_TOLERANCE = 0.01
# Of Abaqus: a block of points, and an instance, whose line a comma continues, with the lines of
# numbers behind it: a shift, and the axis and the angle of a rotation
_NODES = re.compile(r"^\*\s*node\s*(?:,|$)", re.IGNORECASE | re.MULTILINE)
_INSTANCE = re.compile(
    r"^\*\s*instance\b(?:[^\n]*,[ \t]*\n(?![ \t]*[-+.\d]))*[^\n]*\n"
    r"(?P<placed>(?:\*\*[^\n]*\n|[ \t]*[-+.\d][^\n]*\n)*)",
    re.IGNORECASE | re.MULTILINE,
)
_BELOW_THREE_DIMENSIONS = {
    "vertex",
    "line",
    "line3",
    "triangle",
    "triangle6",
    "quad",
    "quad8",
    "quad9",
}
# solids that are read, and their corners; the curved sides of second-order tetrahedra are taken as
# straight
_CORNERS = {"hexahedron": 8, "tetra": 4, "tetra10": 4}
# corners at the ends of the edges of tetrahedra and bricks
_EDGES = np.array([[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]])
_BRICK_EDGES = np.array(
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]]
)


@dataclass(frozen=True, slots=True)
class OwnMesh:
    """A body's mesh and its measures: height [m]; foot: length along x and width along y of the
    rectangle around its foot [m]; foot_edge: mean edge of the foot's faces [m]; drawn_at: place
    (3,) [m] of the foot's middle in the file; has_foot: whether it is flat, else its lowest points
    are taken for it, and its outer faces for their edges; exact: mass properties of what was drawn
    at a density of 1, None of a file of elements.
    """

    mesh: BrickMesh
    height: float
    foot: tuple[float, float]
    foot_edge: float
    drawn_at: tuple[float, float, float]
    has_foot: bool
    exact: MassProperties | None = None

    @property
    def is_tetrahedral(self) -> bool:
        """Tetrahedra, not bricks."""
        return self.mesh.is_tetrahedral

    def counts(self, order: int) -> tuple[int, int]:
        """Lagrange nodes of elements of an order, in all and in the foot."""
        cells, faces = self.mesh.cells, boundary_faces(self.mesh, UPPER, 0.0, 1e-6 * self.height)
        if order == 1:
            return len(self.mesh.points), len(np.unique(faces))
        if self.is_tetrahedral:
            return len(self.mesh.points) + _count(cells[:, _EDGES]), len(np.unique(faces)) + _count(
                np.stack([faces, np.roll(faces, 1, axis=1)], axis=2)
            )
        between = _count(cells[:, _BRICK_EDGES]) + _count(cells[:, FACES]) + len(cells)
        return len(self.mesh.points) + between, len(np.unique(faces)) + _count(
            np.stack([faces, np.roll(faces, 1, axis=1)], axis=2)
        ) + len(faces)


def _count(groups: np.ndarray) -> int:
    """Different sets of points among groups (n, m, k), of k points each."""
    return len(np.unique(np.sort(groups.reshape(-1, groups.shape[-1]), axis=1), axis=0))


def own_mesh(file: MeshFile) -> OwnMesh:
    """The mesh of a file, the foot's middle shifted to the origin, all elements in the part UPPER.

    z is up. The foot is what lies in the lowest horizontal plane. Shells, lines and points beside
    solids are left out; elements of negative volume are turned. Of a surface and of a CAD body, the
    densities of the elements are such that mass, centre and inertia are those of what was drawn.

    Raises
    ------
    InputError
        the file cannot be read, holds other solids than 8-node bricks or tetrahedra, or is broken.
    """
    return _own_mesh(file, content(file.path))


def imported_column(case: Upright) -> BrickMesh:
    """Column of `case.column.mesh_file`; its height and outer diameter must agree with the case
    within 1 %, where it has them.

    Raises
    ------
    InputError
        as of `own_mesh`, or the mesh does not fit the case.
    """

    def refuse(value: object, allowed: str) -> NoReturn:
        raise InputError(case.column.mesh_file, "column.mesh_file", value, allowed)

    own = own_mesh(case.column.drawn)
    if not own.has_foot:
        refuse(
            None,
            "must stand on a flat foot: no element has a face in the lowest horizontal plane"
            + foot_hint(case.column.drawn),
        )
    _check_dimensions(own, case, refuse)
    if own.is_tetrahedral and case.cap:
        refuse(
            f"{len(own.mesh.cells)} tetrahedra",
            "cannot carry a [cap], which has bricks: take the cap into the mesh, or "
            "mesh the column with bricks",
        )
    if own.is_tetrahedral and case.mesh.element_order != 2:
        raise InputError(
            case.column.mesh_file,
            "mesh.element_order",
            case.mesh.element_order,
            "must be 2 for tetrahedra: those of first order are far too stiff in bending",
        )
    return own.mesh


def foot_hint(file: MeshFile) -> str:
    """The way to a flat foot, where there is one."""
    cut = file.kind == "surface" and file.cut_foot is None
    return "; cut_foot_m cuts the surface off flat that far above its lowest point" if cut else ""


@functools.lru_cache(maxsize=32)
def _own_mesh(file: MeshFile, mesh_content: str) -> OwnMesh:
    def refuse(value: object, allowed: str) -> NoReturn:
        raise InputError(file.path, "column.mesh_file", value, allowed)

    exact = None
    if file.kind == "elements":
        points, cells = _elements(Path(file.path), refuse)
        points = points * file.metres
    else:
        try:
            points, cells, exact = filled(file)
        except UnusableShape as error:
            refuse(error.value, error.allowed)
    corners = cells.shape[1]
    used, cells = np.unique(cells, return_inverse=True)
    points, cells = points[used], cells.reshape(-1, corners)
    if not np.all(np.isfinite(points)):
        refuse(
            f"{int(np.sum(~np.isfinite(points).all(axis=1)))} points",
            "coordinates must be finite numbers",
        )

    try:
        file.check_size(np.ptp(points, axis=0))
    except UnusableShape as error:
        refuse(error.value, error.allowed)
    if doubt := file.doubt_of_size(np.ptp(points, axis=0)):
        warnings.warn(f"{file.path}: {doubt}", stacklevel=2)
    height, bottom = float(np.ptp(points[:, 2])), float(points[:, 2].min())
    points = points - [0.0, 0.0, bottom]
    mesh = brick_mesh(points, cells, UPPER)
    _check_elements(mesh, refuse)
    faces = boundary_faces(mesh, UPPER, 0.0, 1e-6 * height)
    has_foot = len(faces) > 0
    sides = points[faces if has_foot else outer_faces(mesh, UPPER)]
    foot = sides.reshape(-1, 3) if has_foot else points[points[:, 2] <= 1e-6 * height]
    low, high = foot[:, :2].min(axis=0), foot[:, :2].max(axis=0)
    middle = (low + high) / 2
    if np.abs(middle).max() > 1e-9 * height:
        mesh.points[:, :2] -= middle
    else:
        middle = np.zeros(2)
    edge = float(np.linalg.norm(sides - np.roll(sides, 1, axis=1), axis=2).mean())
    if exact is not None:
        exact = replace(exact, centre=exact.centre - [*middle, bottom])
        try:
            shares = relative_densities(mesh, exact.mass, exact.centre, exact.inertia)
        except NoSuchDensity as error:
            refuse(
                None, f"its elements are too coarse for it, state a smaller mesh_size_m: {error}"
            )
        mesh = replace(mesh, relative_density=shares)
    return OwnMesh(
        mesh,
        height,
        tuple((high - low).tolist()),
        edge,
        (float(middle[0]), float(middle[1]), bottom),
        has_foot,
        exact,
    )


def _elements(path: Path, refuse: ShapeRefusal) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) in the file's unit and elements (m, 8 or 4) of a file of elements."""
    found = _read(path, refuse)
    solids = {block.type: 0 for block in found.cells if len(block.data)}
    for block in found.cells:
        if len(block.data):
            solids[block.type] += len(block.data)
    others = {
        kind: n
        for kind, n in solids.items()
        if kind not in _CORNERS and kind not in _BELOW_THREE_DIMENSIONS
    }
    kinds = {_CORNERS[kind] for kind in solids if kind in _CORNERS}
    if others or len(kinds) != 1:
        listed = (
            ", ".join(f"{n} x {kind}" for kind, n in (others or solids).items()) or "no elements"
        )
        refuse(
            listed,
            "must hold 8-node bricks (Abaqus C3D8, Gmsh and VTK hexahedron) or tetrahedra (C3D4, "
            "C3D10) as its only solids; a closed surface is taken as .stl, .obj or .ply, a CAD "
            "body as .step or .iges",
        )
    corners = kinds.pop()
    cells = np.concatenate(
        [
            block.data[:, :corners]
            for block in found.cells
            if block.type in _CORNERS and len(block.data)
        ]
    ).astype(np.int64)
    _, once = np.unique(np.sort(cells, axis=1), axis=0, return_index=True)
    if len(once) < len(cells):
        # Gmsh writes an element of two physical groups twice
        warnings.warn(
            f"{path}: {len(cells) - len(once)} elements stand in it twice; each is taken once",
            stacklevel=2,
        )
        cells = cells[np.sort(once)]
    points = np.asarray(found.points, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3:
        refuse(f"points of shape {points.shape}", "must have three coordinates a point")
    if cells.min() < 0 or cells.max() >= len(points):
        refuse(
            f"element refers to point {cells.max()} of {len(points)}",
            "every element's points must be in the file",
        )
    return points, cells


def _read(path: Path, refuse: ShapeRefusal) -> Any:
    """Meshio's mesh of a file."""
    import meshio

    if path.stat().st_size == 0:
        refuse("0 bytes", "the file is empty")
    if path.suffix.lower() == ".inp":
        _check_abaqus(path.read_text(errors="replace"), refuse)
    try:
        # meshio prints to the console and exits where a file is of no known or of a broken format.
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(out):
            return meshio.read(path)
    except KeyError as error:
        refuse(
            None,
            f"cannot be read: an element refers to {error.args[0]}, which the file does not define",
        )
    except (SystemExit, Exception) as error:  # the readers raise whatever their parsing meets
        said = str(error) if not isinstance(error, SystemExit) else " ".join(out.getvalue().split())
        refuse(None, f"cannot be read as a mesh by meshio: {said or type(error).__name__}")


def _check_abaqus(text: str, refuse: ShapeRefusal) -> None:
    """Refuse what meshio passes over in a file of Abaqus: it keeps the last *NODE block, whose
    points it would connect to bricks of all parts, and leaves parts where they were drawn.
    """
    if (blocks := len(_NODES.findall(text))) != 1:
        refuse(f"{blocks} *NODE blocks", "must hold one *NODE block: export the column as one part")
    for instance in _INSTANCE.finditer(text):
        placed = [line for line in instance["placed"].splitlines() if not line.startswith("**")]
        if any(map(_moves, placed)):
            refuse(
                f"*INSTANCE with the placement {'; '.join(line.strip() for line in placed)}",
                "must have its points where they are: a placement of the instance is not read; "
                "export the mesh of the assembly, or write the input file with flattened instances",
            )


def _moves(placed: str) -> bool:
    """Whether a line of a placement shifts by more than 0, or turns by more than an angle of 0."""
    numbers = [one.strip() for one in placed.split(",") if one.strip()]
    try:
        values = [float(one) for one in numbers]
    except ValueError:
        return True
    return any(values) if len(values) <= 3 else bool(values[-1])


def _check_dimensions(own: OwnMesh, case: Upright, refuse: ShapeRefusal) -> None:
    column = case.column
    diameter = np.ptp(own.mesh.points[:, :2], axis=0).mean()
    for key, value, wanted in (
        ("height_m", own.height, column.height_m),
        ("outer_diameter_m", diameter, column.outer_diameter_m),
    ):
        if wanted is None or abs(value / wanted - 1) <= _DIMENSION_TOLERANCE:
            continue
        hint = ""
        for unit, factor in (("millimetres", 1e3), ("centimetres", 1e2), ("inches", 1 / 0.0254)):
            if abs(value / (wanted * factor) - 1) < 0.1:
                hint = f"; the file seems to be in {unit}: state column.mesh_unit"
        refuse(
            f"{value:g} m",
            f"must agree with column.{key} = {wanted:g} m within {_DIMENSION_TOLERANCE:.0%}{hint}",
        )


def _check_elements(mesh: BrickMesh, refuse: ShapeRefusal) -> None:
    bad = np.flatnonzero(corner_jacobians(mesh).min(axis=1) <= 0)
    if len(bad):
        x, y, z = mesh.points[mesh.cells[bad[0]]].mean(axis=0)
        refuse(
            f"{len(bad)} of {len(mesh.cells)} elements",
            "must not be folded or flat (positive Jacobian at every corner); first one "
            f"at x = {x:g}, y = {y:g}, z = {z:g} m",
        )
    pieces, overlaps = _connected(mesh)
    if overlaps:
        refuse(
            f"{overlaps} faces with elements that overlap",
            "must have one element on either side of a face at most",
        )
    if pieces > 1:
        refuse(
            f"{pieces} unconnected pieces",
            "must be one body, connected by faces of elements: merge coincident points before "
            "export",
        )


def _connected(mesh: BrickMesh) -> tuple[int, int]:
    """Pieces that no face connects, and faces with more than one element on a side."""
    local = TETRAHEDRON_FACES if mesh.is_tetrahedral else FACES
    faces = mesh.cells[:, local].reshape(-1, local.shape[1])
    n, owner = len(mesh.cells), np.repeat(np.arange(len(mesh.cells)), len(local))
    _, number, counts = np.unique(
        np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    order = np.argsort(number.ravel(), kind="stable")
    first = np.flatnonzero(np.diff(number.ravel()[order]) == 0)
    same, after = order[first], order[first + 1]
    one, other = owner[same], owner[after]
    graph = coo_array((np.ones(len(same), np.int8), (one, other)), shape=(n, n))
    corners, middles = mesh.points[faces[same]], mesh.points[mesh.cells].mean(axis=1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sides = [
        np.einsum("fa,fa->f", normals, middles[cells] - corners.mean(axis=1))
        for cells in (one, other)
    ]
    overlaps = int((sides[0] * sides[1] > 0).sum() + (counts > 2).sum())
    return int(connected_components(graph, directed=False)[0]), overlaps
