"""Bodies from another program: mass and stiffness matrices, and the nodes at which they may
touch.
"""

from __future__ import annotations

import functools
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, eigh, qr
from scipy.sparse.linalg import LinearOperator, eigsh, splu
from scipy.spatial import ConvexHull, Delaunay, QhullError

from fecolumn.case.bodies import Matrices
from fecolumn.fem.inertia import negative_eigenvalues
from fecolumn.fem.whole_groups import SAME_FREQUENCY, with_group
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.winding import counterclockwise
from fecolumn.structures.faces import SAME_PLANE, Face
from fecolumn.structures.model import BodyModel
from fecolumn.structures.patches import Patch, face_weights
from fecolumn.structures.reduction import top_face

# Over the entries that it is measured by: how symmetric matrices must be, and how free of
# resistance to rigid motion
_EXACT = 1e-6
# Twice the area of a triangle over the square of the largest side, below which it is none
_NO_AREA = 1e-12
# Modes found beyond those asked for, and more each time some are missing
_SPARE = 6
# Degrees of freedom up to which all modes are found at once
_DENSE = 1000
# Raises the InputError of what a file may be instead
Refusal = Callable[[str], NoReturn]


@dataclass(frozen=True, eq=False)
class SystemMatrices:
    """mass, stiffness: (N, N) [kg, N/m]; dofs: (n, 3) rows of x, y, z of each contact node;
    coordinates: (n, 3) [m]; triangles: (t, 3) of nodes.
    """

    mass: sparse.csc_matrix
    stiffness: sparse.csc_matrix
    dofs: NDArray[Any]
    coordinates: NDArray[Any]
    triangles: NDArray[Any]

    def faces(self) -> list[Face]:
        """Plane faces in which the contact nodes lie."""
        corners = self.coordinates[self.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        offsets = np.einsum("ti,ti->t", normals, corners[:, 0])
        size = np.ptp(self.coordinates, axis=0).max()
        left, found = np.ones(len(normals), bool), []
        while left.any():
            first = np.argmax(left)
            same = (
                left
                & (np.linalg.norm(normals - normals[first], axis=1) < 10 * SAME_PLANE)
                & (np.abs(offsets - offsets[first]) < SAME_PLANE * size)
            )
            found.append(
                Face(0, normals[first], float(offsets[first]), self.triangles[same], corners[same])
            )
            left &= ~same
        return sorted(found, key=lambda face: -face.area)


def read_system(key: str, body: Matrices, file: Path | str) -> SystemMatrices:
    """Matrices and nodes of a body's files.

    Raises
    ------
    InputError
        files that cannot be read, or whose matrices and nodes do not fit one another.
    """

    def refuse(name: str, allowed: str) -> NoReturn:
        raise InputError(file, f"{key}.{name}", getattr(body, name), allowed)

    found = {}
    for name in ("mass", "stiffness"):
        matrix = _matrix(
            getattr(body, f"{name}_file"),
            name,
            functools.partial(refuse, f"{name}_file"),
        )
        rows, columns = matrix.shape
        if rows != columns:
            told = f"must hold a symmetric matrix; has {rows} rows and {columns} columns"
            refuse(f"{name}_file", told)
        if not np.isfinite(matrix.data).all():
            refuse(f"{name}_file", "must hold finite entries")
        if (apart := abs(matrix - matrix.T).max()) > _EXACT * abs(matrix).max():
            told = f"must hold a symmetric matrix; entries differ by up to {apart:.3g}"
            refuse(f"{name}_file", told)
        found[name] = matrix
    if found["mass"].shape != found["stiffness"].shape:
        refuse(
            "stiffness_file",
            f"must have as many rows as mass_file, {found['mass'].shape[0]}, has "
            f"{found['stiffness'].shape[0]}",
        )
    dofs, coordinates, triangles = _nodes(body.nodes_file, functools.partial(refuse, "nodes_file"))
    rows = found["mass"].shape[0]
    if len(np.unique(dofs)) < dofs.size or dofs.min() < 0 or dofs.max() >= rows:
        refuse(
            "nodes_file", f"its dofs must be different rows of the matrices, from 0 to {rows - 1}"
        )
    if triangles is None:
        triangles = _hull(coordinates, functools.partial(refuse, "nodes_file"))
    else:
        _check_triangles(coordinates, triangles, functools.partial(refuse, "nodes_file"))
    return SystemMatrices(found["mass"], found["stiffness"], dofs, coordinates, triangles)


def _check_triangles(coordinates: NDArray[Any], triangles: NDArray[Any], refuse: Refusal) -> None:
    """Refuse triangles that are none."""
    n = len(coordinates)
    if triangles.ndim != 2 or triangles.shape[1] != 3 or not len(triangles):
        refuse(f"its triangles must have three nodes each; their shape is {triangles.shape}")
    if triangles.min() < 0 or triangles.max() >= n:
        refuse(f"its triangles must be of nodes 0 to {n - 1}, counted from 0")
    corners = coordinates[triangles]
    sides = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    size = np.ptp(coordinates, axis=0).max()
    flat = np.linalg.norm(np.cross(*sides), axis=1) <= _NO_AREA * size**2
    if flat.any():
        refuse(
            f"{flat.sum()} of its triangles have no area, the first one of nodes "
            f"{triangles[flat.argmax()].tolist()}"
        )


def _matrix(path: str, name: str, refuse: Refusal) -> sparse.csc_matrix:
    import scipy.io

    try:
        if Path(path).suffix == ".npz":
            with np.load(path, allow_pickle=False) as arrays:
                if name in arrays:
                    return sparse.csc_matrix(np.asarray(arrays[name], float))
            return sparse.csc_matrix(sparse.load_npz(path)).astype(float)
        return sparse.csc_matrix(scipy.io.mmread(path)).astype(float)
    except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
        refuse(f"cannot be read as MatrixMarket or .npz: {error}")


def _nodes(path: str, refuse: Refusal) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any] | None]:
    try:
        if Path(path).suffix == ".npz":
            with np.load(path, allow_pickle=False) as arrays:
                dofs, coordinates = arrays["dofs"], np.asarray(arrays["coordinates"], float)
                triangles = arrays["triangles"].astype(np.int64) if "triangles" in arrays else None
        else:
            table = np.loadtxt(
                path, delimiter="," if Path(path).suffix == ".csv" else None, ndmin=2
            )
            dofs, coordinates, triangles = table[:, :3], table[:, 3:6], None
    except (OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        refuse(f"cannot be read as nodes: {error}")
    if (
        dofs.shape != coordinates.shape
        or dofs.shape[1:] != (3,)
        or not np.all(np.isfinite(coordinates))
        or np.any(dofs != np.rint(dofs))
    ):
        refuse("must hold six numbers a node: three whole rows and three finite coordinates")
    return dofs.astype(np.int64), coordinates, triangles


def _hull(coordinates: NDArray[Any], refuse: Refusal) -> NDArray[Any]:
    """Triangles (t, 3) of nodes: every plane face of their convex hull, with the nodes that lie
    inside it.
    """
    try:
        hull = ConvexHull(coordinates)
    except QhullError:
        refuse("its nodes must not lie in one plane: give the triangles of its faces")
    size, found = np.ptp(coordinates, axis=0).max(), []
    done: list[NDArray[Any]] = []
    for *normal, offset in hull.equations:
        if any(
            np.abs(np.array([*normal, offset / size]) - plane).max() < SAME_PLANE for plane in done
        ):
            continue
        done.append(np.array([*normal, offset / size]))
        nodes = np.flatnonzero(np.abs(coordinates @ normal + offset) < SAME_PLANE * size)
        cells, corners = np.zeros((0, 3), np.int64), np.zeros((0, 3, 3))
        axes = Face(0, np.array(normal), -offset, cells, corners).axes
        plane = coordinates[nodes] @ axes[:, :2]
        found.append(nodes[counterclockwise(plane, Delaunay(plane).simplices)])
    return np.concatenate(found)


def matrices_model(
    system: SystemMatrices,
    faces: list[Face],
    patches: dict[str, Patch],
    n_modes: int,
    refuse: Refusal,
) -> BodyModel:
    """Reduce a body given by its matrices, as `reduction.elastic_model` does one of finite
    elements.

    Six degrees of freedom of contact nodes are held, which no rigid motion leaves at rest: with
    them K has an inverse. Rigid motions are what K answers to them; inertia relief frees the
    response again, and is the operator whose largest values are the lowest modes.

    Parameters
    ----------
    refuse
        told what is wrong with the matrices.
    """
    mass, stiffness, dofs = system.mass, system.stiffness, system.dofs
    size = mass.shape[0]
    middle = system.coordinates.mean(axis=0)
    known = _rigid(system.coordinates - middle)
    held = dofs.ravel()[np.sort(qr(known.T, pivoting=True, mode="r")[1][:6])]
    free = np.setdiff1d(np.arange(size), held)
    try:
        factor = splu(sparse.csc_matrix(stiffness[free][:, free]))
    except RuntimeError:
        refuse("its stiffness has more than six motions without resistance: a mechanism")
    rigid = np.zeros((size, 6))
    rows = np.argsort(dofs.ravel())
    rigid[held] = known[rows[np.searchsorted(dofs.ravel()[rows], held)]]
    rigid[free] = factor.solve(-(stiffness[free][:, held] @ rigid[held]))
    scale = np.abs(known).max(axis=0)
    # what holds the body at a row of `held` shows in the forces there alone
    forces, entries = np.abs(stiffness[held] @ rigid), abs(stiffness[held]) @ np.abs(rigid)
    moves = (np.abs(rigid[dofs.ravel()] - known) / scale).max() <= _EXACT
    if not moves or (forces.max(axis=0) > _EXACT * entries.max(axis=0)).any():
        refuse(
            "its stiffness resists rigid motion of the contact nodes: nothing may hold "
            "the body, and their coordinates must be in its unit of length"
        )
    masses = rigid.T @ (mass @ rigid)
    total = np.trace(masses[:3, :3]) / 3
    if np.abs(masses[:3, :3] - total * np.eye(3)).max() > 1e-3 * total:
        refuse(
            "its mass must be the same along x, y and z: "
            f"{', '.join(f'{value:.6g}' for value in np.diag(masses)[:3])} kg"
        )
    # x cross y of the first moments: m (c x e_j) in the rows of rotation
    first = masses[3:, :3] / total
    center = (
        np.array([first[2, 1] - first[1, 2], first[0, 2] - first[2, 0], first[1, 0] - first[0, 1]])
        / 2
    )
    shift = np.eye(6)
    shift[:3, 3:] = _cross(center)
    rigid = rigid @ shift
    masses = rigid.T @ (mass @ rigid)
    shares, momentum = np.linalg.inv(masses), mass @ rigid

    def elastic(columns: NDArray[Any]) -> NDArray[Any]:
        strained: NDArray[Any] = columns - rigid @ (shares @ (momentum.T @ columns))
        return strained

    def response(forces: NDArray[Any]) -> NDArray[Any]:
        forces = forces - momentum @ (shares @ (rigid.T @ forces))
        moved = np.zeros_like(forces)
        moved[free] = factor.solve(np.ascontiguousarray(forces[free]))
        return elastic(moved)

    nodes = _rows(
        system.coordinates, np.concatenate([patch.positions for patch in patches.values()])
    )
    kept, n = np.unique(nodes), len(np.unique(nodes))
    loads = np.zeros((size, 3 * n))
    loads[dofs[kept].ravel(), np.arange(3 * n)] = 1.0
    flexibility = response(loads)[dofs[kept].ravel()]
    squares, fields = _modes(mass, stiffness, response, min(n_modes, size - 6), refuse)
    positions, weights = face_weights(top_face(faces), 1)
    top = fields[dofs[_rows(system.coordinates, positions)]]
    center = middle + center
    return BodyModel(
        total,
        masses[3:, 3:],
        center,
        np.sqrt(squares),
        np.ascontiguousarray(fields[dofs[kept]]),
        ((flexibility + flexibility.T) / 2).reshape(n, 3, n, 3).transpose(0, 2, 1, 3).copy(),
        system.coordinates[kept] - center,
        size,
        {
            name: patch.surface(
                np.searchsorted(kept, _rows(system.coordinates, patch.positions)), center
            )
            for name, patch in patches.items()
        },
        {"top": (weights @ positions - center, np.einsum("i,iam->am", weights, top))},
    )


def _modes(
    mass: sparse.csc_matrix,
    stiffness: sparse.csc_matrix,
    response: Callable[[NDArray[Any]], NDArray[Any]],
    count: int,
    refuse: Refusal,
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Squares (m,) [1/s2] of the lowest elastic frequencies and shapes (N, m) of unit modal
    mass.
    """
    size = mass.shape[0]
    if count <= 0:
        return np.zeros(0), np.zeros((size, 0))
    if size <= _DENSE or count > size // 3:
        try:
            squares, shapes = eigh(stiffness.toarray(), mass.toarray())
        except LinAlgError:
            refuse(
                "must have inertia in every degree of freedom: condense the massless ones out first"
            )
        squares, shapes = squares[6:], shapes[:, 6:]
        count = with_group(np.sqrt(squares), count)
        return squares[:count], shapes[:, :count]
    inverse = LinearOperator(
        (size, size), matvec=lambda force: response(force.reshape(-1, 1)).ravel(), dtype=float
    )
    for sought in range(count + _SPARE, size // 2, _SPARE):
        squares, shapes = eigsh(stiffness, sought, mass, sigma=0.0, OPinv=inverse, which="LM")
        order = np.argsort(squares)
        squares, shapes = squares[order], shapes[:, order]
        kept = with_group(np.sqrt(squares), count)
        # Lanczos' method may miss one of two equal eigenvalues
        between = (1 + SAME_FREQUENCY) ** 2 * squares[kept - 1]
        if kept < sought and _below(stiffness - between * mass) == kept + 6:
            return squares[:kept], shapes[:, :kept]
    refuse(f"some of its {count} lowest modes are not found")


def _below(matrix: sparse.spmatrix) -> int:
    """Number of negative eigenvalues of a symmetric matrix."""
    from mpi4py import MPI
    from petsc4py import PETSc

    rows = sparse.csr_matrix(matrix)
    made = PETSc.Mat().createAIJ(
        rows.shape, csr=(rows.indptr, rows.indices, rows.data), comm=MPI.COMM_SELF
    )
    try:
        return negative_eigenvalues(made)
    finally:
        made.destroy()


def _rigid(arms: NDArray[Any]) -> NDArray[Any]:
    """Rigid motions (3 n, 6) of points with arms (n, 3): translations, and rotations about the
    origin.
    """
    return np.concatenate(
        [
            np.tile(np.eye(3), (len(arms), 1)),
            np.stack([np.cross(axis, arms).ravel() for axis in np.eye(3)], axis=1),
        ],
        axis=1,
    )


def _cross(center: NDArray[Any]) -> NDArray[Any]:
    """Translations by which rotations about the origin become rotations about `center`: -e_j x
    center in column j.
    """
    ways: NDArray[Any] = -np.stack([np.cross(axis, center) for axis in np.eye(3)], axis=1)
    return ways


def _rows(coordinates: NDArray[Any], positions: NDArray[Any]) -> NDArray[Any]:
    """Nodes (k,) at positions (k, 3)."""
    from scipy.spatial import cKDTree

    nodes: NDArray[Any] = cKDTree(coordinates).query(positions)[1]
    return nodes
