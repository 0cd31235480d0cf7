"""One elastic body: reference positions, mass, stiffness and kinematic constraints, distributed
over the ranks.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import ufl
from mpi4py import MPI
from petsc4py import PETSc
from scipy.spatial import cKDTree

from fecolumn.fem.material.elasticity import isotropic_stress
from fecolumn.fem.material.kinematics import linear_strain
from fecolumn.foundation import _dolfinx
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.mesh.bricks import BrickMesh


class Body:
    """Finite-element operators of one body.

    Arrays named like the physics (`x`, `v`, `f`) hold the owned nodes of this rank, shape (n_owned,
    3); a node is a Lagrange point of the element. Positions, velocities and accelerations carry all
    nodes; forces are reduced: tied and held nodes have passed theirs on and carry zero.

    Parameters
    ----------
    comm
        MPI communicator.
    bricks
        BrickMesh, read on every rank.
    material
        object with youngs_modulus, poissons_ratio and density in SI units.
    order
        polynomial order of the elements.
    constrain
        function of this body that returns the constraint; see `fecolumn.mesh.tie` for ties.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        bricks: BrickMesh,
        material: Any,
        order: int = 1,
        constrain: Callable[..., Any] | None = None,
    ) -> None:
        self.comm, self.bricks, self.material, self.order = comm, bricks, material, order
        self.mesh = _dolfinx.create_brick_mesh(comm, bricks.points, bricks.cells)
        self.space = _dolfinx.vector_space(self.mesh, order)
        index_map = self.space.dofmap.index_map
        self.n_owned, self.n_nodes = index_map.size_local, index_map.size_global
        self.first = index_map.local_range[0]
        self.X = self.space.tabulate_dof_coordinates()[: self.n_owned].copy()
        # node positions and parts of all ranks, so that searches need no communication
        self.all_X = np.concatenate(comm.allgather(self.X))
        self.all_part = np.concatenate(comm.allgather(self._node_parts()))

        u, w = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        stress = isotropic_stress(
            linear_strain(u), material.youngs_modulus_pa, material.poissons_ratio
        )
        density = material.density_kg_m3
        if bricks.relative_density is not None:
            density = density * _dolfinx.cellwise(self.mesh, bricks.relative_density)
        mass = _dolfinx.assemble_matrix(density * ufl.inner(u, w) * ufl.dx)
        stiffness = _dolfinx.assemble_matrix(ufl.inner(stress, linear_strain(w)) * ufl.dx)
        self.work = mass.createVecs()
        self.constraint = Constraint(self, *(constrain(self) if constrain else ({}, ())))
        self.mass, self.stiffness = self.constraint.reduce(mass), self.constraint.reduce(stiffness)
        mass.destroy(), stiffness.destroy()
        # the consistent mass joins no two axes and is the same along each: a ninth of its entries
        # serves all three
        one_axis = PETSc.IS().createStride(self.n_owned, 3 * self.first, 3, comm)
        self._mass_of_axis = self.mass.createSubMatrix(one_axis, one_axis)
        self._motion = PETSc.Mat().createDense(((self.n_owned, None), (None, 3)), comm=comm)
        self._motion.setUp(), self._motion.assemble(), one_axis.destroy()
        self._momentum = self._mass_of_axis.matMult(self._motion)
        tie = self.constraint.projection
        _dolfinx.release_with(
            self,
            self.mass,
            self.stiffness,
            self._mass_of_axis,
            self._motion,
            self._momentum,
            *self.work,
            *([] if tie is None else [tie]),
        )
        #: Largest diagonal entries of stiffness [N/m] and mass [kg].
        diagonals = [matrix.getDiagonal() for matrix in (self.stiffness, self.mass)]
        self.stiffness_scale, self.mass_scale = (diagonal.max()[1] for diagonal in diagonals)
        for diagonal in diagonals:
            diagonal.destroy()
        self.unit_loads = np.stack(
            [self.apply(self.mass, np.tile(e, (self.n_owned, 1))) for e in np.eye(3)]
        )
        self.node_mass = self.unit_loads[2, :, 2]
        self.total_mass = self.sum(self.node_mass.sum())
        self.center = self.sum(self.node_mass @ self.X) / self.total_mass
        #: Positions (n_owned, 3) from the centre of mass [m], and the mass matrix times them [kg
        #: m].
        self.arms = self.X - self.center
        self.mass_arms = self.momentum(self.arms)

    def _node_parts(self) -> Array:
        """Part of each owned node."""
        part = np.zeros(self.n_owned, np.int8)
        cells = np.asarray(self.mesh.topology.original_cell_index)
        for cell in range(self.mesh.topology.index_map(3).size_local):
            nodes = self.space.dofmap.cell_dofs(cell)
            part[nodes[nodes < self.n_owned]] = self.bricks.part[cells[cell]]
        return part

    def find_nodes(self, points: Array, part: int | None = None) -> Array:
        """Numbers (n,) of the nodes at `points` (n, 3) [m], of one part if given."""
        among = (
            np.flatnonzero(self.all_part == part) if part is not None else np.arange(self.n_nodes)
        )
        distance, nearest = cKDTree(self.all_X[among]).query(points)
        size = np.ptp(self.all_X, axis=0).max()
        if np.any(distance > 1e-9 * size):
            raise RuntimeError(
                f"no node at {points[np.argmax(distance)]} m: nearest is "
                f"{distance.max():.3g} m away"
            )
        return among[nearest]

    def owned(self, nodes: Array) -> tuple[Array, Array]:
        """Where `nodes` are owned here: positions in the list, and local rows."""
        nodes = np.asarray(nodes)
        here = np.flatnonzero((nodes >= self.first) & (nodes < self.first + self.n_owned))
        return here, nodes[here] - self.first

    def gather(self, nodes: Array, values: Array) -> Array:
        """Values (n, ...) at `nodes` on every rank, from owned values (n_owned, ...)."""
        if self.comm.size == 1:
            return values[nodes]
        result = np.zeros((len(nodes),) + values.shape[1:])
        here, rows = self.owned(nodes)
        result[here] = values[rows]
        self.comm.Allreduce(MPI.IN_PLACE, result)
        return result

    def spread(self, nodes: Array, values: Array) -> Array:
        """Reduced forces (n_owned, 3) of forces `values` (n, 3) at `nodes` (n,): tied ones pass
        theirs on.
        """
        result = np.zeros((self.n_owned, 3))
        here, rows = self.owned(nodes)
        result[rows] = values[here]
        return self.constraint.collect(result) if self.constraint.holds(nodes) else result

    def apply(self, matrix: PETSc.Mat, values: Array) -> Array:
        """Product of a matrix with an owned array (n_owned, 3), or with (k, n_owned, 3) of k copies
        at once, for which the matrix is read once.
        """
        if values.ndim == 3:
            return self.apply_many(matrix, values.reshape(len(values), -1).T).T.reshape(
                values.shape
            )
        source, target = self.work
        source.array[:] = values.reshape(-1)
        matrix.mult(source, target)
        return target.array.reshape(-1, 3).copy()

    def momentum(self, values: Array) -> Array:
        """Product of the mass with an owned array (n_owned, 3), or with those of copies (k,
        n_owned, 3).
        """
        if values.ndim == 3:
            return np.stack([self.momentum(one) for one in values])
        self._motion.getDenseArray()[:] = values
        self._mass_of_axis.matMult(self._motion, self._momentum)
        return np.array(self._momentum.getDenseArray(), order="C")

    def apply_many(self, matrix: PETSc.Mat, columns: Array) -> Array:
        """Product of a matrix with columns (3 n_owned, m)."""
        sizes = (3 * self.n_owned, None), (None, columns.shape[1])
        source = PETSc.Mat().createDense(sizes, array=np.asfortranarray(columns), comm=self.comm)
        source.assemble()
        target = matrix.matMult(source)
        result = target.getDenseArray().copy(order="F")
        source.destroy(), target.destroy()
        return result

    def sum(self, value: Any) -> Any:
        """Sum of a number or array over the ranks."""
        if self.comm.size == 1:
            return value
        return self.comm.allreduce(value)

    def max(self, value: float) -> float:
        """Largest value over the ranks."""
        return float(value if self.comm.size == 1 else self.comm.allreduce(float(value), MPI.MAX))

    def dot(self, left: Array, right: Array) -> float:
        """Inner product of two owned arrays over all ranks."""
        return float(self.sum(np.vdot(left, right)))


class Constraint:
    """Ties and supports as a projection P: all nodes = P (free nodes).

    Parameters
    ----------
    body
        the body.
    ties
        {slave node: (master nodes, weights)}.
    held
        nodes without displacement.
    """

    def __init__(self, body: Body, ties: dict, held: Array | tuple[()]) -> None:
        self.body = weakref.proxy(body)
        self.nodes = np.array(sorted(ties) + sorted(held), dtype=np.int64)
        if not len(self.nodes):
            self.projection = None
            return
        rows = PETSc.Mat().createAIJ(((3 * body.n_owned, None),) * 2, comm=body.comm)
        width = max((len(masters) for masters, _ in ties.values()), default=1)
        rows.setPreallocationNNZ((width, width))
        free = np.ones(body.n_owned, bool)
        free[body.owned(self.nodes)[1]] = False
        for row in 3 * (np.flatnonzero(free) + body.first):
            for axis in range(3):
                rows.setValue(row + axis, row + axis, 1.0)
        for slave, (masters, weights) in ties.items():
            if body.first <= slave < body.first + body.n_owned:
                for axis in range(3):
                    rows.setValues([3 * slave + axis], [3 * m + axis for m in masters], weights)
        rows.assemble()
        self.projection = rows

    def reduce(self, matrix: PETSc.Mat) -> PETSc.Mat:
        """P^T A P."""
        return matrix.copy() if self.projection is None else matrix.ptap(self.projection)

    def expand(self, values: Array) -> Array:
        """Values of all nodes from those of the free nodes; held nodes get zero."""
        return values if self.projection is None else self.body.apply(self.projection, values)

    def holds(self, nodes: Array) -> bool:
        """Whether any of the nodes (n,) is tied or held."""
        return len(self.nodes) > 0 and bool(np.isin(nodes, self.nodes).any())

    def collect(self, forces: Array) -> Array:
        """P^T f: what ties and supports leave on the free nodes."""
        if self.projection is None:
            return forces
        source, target = self.body.work
        source.array[:] = forces.reshape(-1)
        self.projection.multTranspose(source, target)
        return target.array.reshape(-1, 3).copy()

    def pinned(self, matrix: PETSc.Mat) -> PETSc.Mat:
        """The matrix with a positive diagonal at constrained nodes, so that it can be factored."""
        if not len(self.nodes):
            return matrix
        diagonal = matrix.createVecRight()
        matrix.getDiagonal(diagonal)
        scale = diagonal.max()[1]
        values = np.zeros((self.body.n_owned, 3))
        values[self.body.owned(self.nodes)[1]] = scale
        diagonal.array[:] = values.reshape(-1)
        identity = PETSc.Mat().createAIJ(matrix.getSizes(), comm=self.body.comm)
        identity.setPreallocationNNZ((1, 0))
        identity.setDiagonal(diagonal)
        identity.assemble()
        matrix.axpy(1.0, identity, structure=PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
        identity.destroy(), diagonal.destroy()
        return matrix
