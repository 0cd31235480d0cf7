"""The only file that knows dolfinx versions: 0.5 (Debian 12) and 0.9 (Debian 13)."""

from __future__ import annotations

import logging
import weakref
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

# Before dolfinx: its form compiler gives a root logger without handlers one that prints every call
# of the C compiler, and takes Python's warnings for itself. What a compiler that fails says still
# goes to stderr.
logging.getLogger().addHandler(logging.NullHandler())

import dolfinx  # noqa: E402
import numpy as np  # noqa: E402
import ufl  # noqa: E402
from dolfinx import fem, mesh  # noqa: E402
from petsc4py import PETSc  # noqa: E402

from fecolumn.foundation import _form_compiler  # noqa: E402, F401

if TYPE_CHECKING:
    from mpi4py import MPI


logging.captureWarnings(False)

VERSION = tuple(int(n) for n in dolfinx.__version__.split(".")[:2])
_MODERN = VERSION >= (0, 8)

# 8-node brick: VTK vertex order -> tensor-product order of dolfinx
_TENSOR_ORDER = [0, 1, 3, 2, 4, 5, 7, 6]


def create_brick_mesh(comm: MPI.Intracomm, points: NDArray[Any], cells: NDArray[Any]) -> Any:
    """Distributed mesh of 8-node bricks, or of tetrahedra.

    Parameters
    ----------
    comm
        MPI communicator.
    points
        (n_points, 3) [m], read on rank 0.
    cells
        (n_cells, 8 or 4) point numbers in VTK order, read on rank 0.
    """
    corners = cells.shape[1]
    if comm.rank == 0:
        cells = np.ascontiguousarray(
            cells[:, _TENSOR_ORDER] if corners == 8 else cells, dtype=np.int64
        )
        points = np.ascontiguousarray(points, dtype=np.float64)
    else:
        cells, points = np.empty((0, corners), np.int64), np.empty((0, 3))
    kind = "hexahedron" if corners == 8 else "tetrahedron"
    if _MODERN:
        import basix.ufl

        element = basix.ufl.element("Lagrange", kind, 1, shape=(3,))
    else:
        element = ufl.Mesh(ufl.VectorElement("Lagrange", kind, 1))
    return mesh.create_mesh(comm, cells, points, element)


def vector_space(msh: dolfinx.mesh.Mesh, order: int) -> Any:
    """Continuous Lagrange space of displacement vectors."""
    return (
        fem.functionspace(msh, ("Lagrange", order, (3,)))
        if _MODERN
        else fem.VectorFunctionSpace(msh, ("Lagrange", order))
    )


def cellwise_space(msh: dolfinx.mesh.Mesh, shape: tuple[int, ...] = ()) -> Any:
    """Space of one value (or one array of `shape`) a cell."""
    if _MODERN:
        return fem.functionspace(msh, ("DG", 0, shape) if shape else ("DG", 0))
    if shape:
        return (
            fem.TensorFunctionSpace(msh, ("DG", 0), shape)
            if len(shape) == 2
            else fem.VectorFunctionSpace(msh, ("DG", 0), shape[0])
        )
    return fem.FunctionSpace(msh, ("DG", 0))


def cellwise(msh: dolfinx.mesh.Mesh, values: NDArray[Any]) -> fem.Function:
    """Function of one number a cell, from those of all cells (n_cells,) in the order in which they
    were given to `create_brick_mesh`, known on every rank.
    """
    space = cellwise_space(msh)
    function = fem.Function(space)
    owned = msh.topology.index_map(msh.topology.dim).size_local
    given = np.asarray(msh.topology.original_cell_index)[:owned]
    places = [space.dofmap.cell_dofs(cell)[0] for cell in range(owned)]
    function.x.array[places] = values[given]
    function.x.scatter_forward()
    return function


def interpolation_points(space: Any) -> NDArray[Any]:
    """Reference points at which an expression for `space` is evaluated."""
    points = space.element.interpolation_points
    return np.asarray(points() if callable(points) else points)


def assemble_matrix(form: Any) -> PETSc.Mat:
    """Assembled sparse matrix of a bilinear form without boundary conditions."""
    from dolfinx.fem import petsc

    matrix = petsc.assemble_matrix(fem.form(form))
    matrix.assemble()
    return matrix


def release_with(owner: object, *objects: Any) -> weakref.finalize[..., Any]:
    """Destroy PETSc objects when `owner` goes, or when the returned function is called: petsc4py
    alone would keep them for ever.

    The owner must not be part of a reference cycle: the garbage collector comes at other times on
    other ranks.
    """
    end = weakref.finalize(owner, _destroy, *objects)
    end.atexit = False
    return end


def _destroy(*objects: Any) -> None:
    for one in objects:
        one.destroy()
