"""Finite-element bodies from meshes, the same on every rank."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.fem.body import Body
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import BrickMesh, boundary_faces
from fecolumn.mesh.surface import face_basis, face_points
from fecolumn.mesh.tie import project_to_quads

if TYPE_CHECKING:
    from mpi4py import MPI

    from fecolumn.mesh.tie import Tie


def known_to_all(comm: MPI.Intracomm, make: Callable[..., Any]) -> Any:
    """What `make` makes on rank 0, known on every rank; a refusal is raised on every rank, and so
    is any other error, which others than rank 0 have as RuntimeError.
    """
    if comm.size == 1:
        return make()
    result: Any = None
    caught: Exception | None = None
    told: Any = None  # of an InputError its arguments, of another error a text
    if comm.rank == 0:
        try:
            result = make()
        except InputError as error:
            caught, told = error, (error.file, error.key, error.value, error.allowed)
        except Exception as error:
            caught, told = error, f"{type(error).__name__} on rank 0: {error}"
    result, told = comm.bcast((result, told))
    if caught:
        raise caught
    if told:
        raise RuntimeError(told) if isinstance(told, str) else InputError(*told)
    return result


def tied_body(
    mesh: BrickMesh, ties: tuple[Tie, ...], material: Any, order: int, comm: MPI.Intracomm
) -> Body:
    """The parts of a mesh as one body, held together by its ties (`mesh.tie.Tie`); order: of the
    elements.
    """

    def links(body: Body) -> tuple[dict[int, tuple[Array, Array]], tuple[()]]:
        return {slave: link for one in ties for slave, link in _tie_links(body, mesh, one)}, ()

    return Body(comm, mesh, material, order, links)


def _tie_links(body: Body, mesh: BrickMesh, tie: Tie) -> Iterator[Any]:
    """(slave node, (master nodes, weights)) of one tie, at the Lagrange nodes of the body."""
    slave_quads = boundary_faces(
        mesh,
        tie.slave_part,
        mesh.points[tie.slave_nodes, 2].mean(),
        1e-6 * np.ptp(mesh.points[:, 2]),
    )
    slaves = np.unique(
        body.find_nodes(
            face_points(mesh.points[slave_quads], body.order).reshape(-1, 3), tie.slave_part
        )
    )
    corners = mesh.points[tie.master_quads]
    masters = body.find_nodes(
        face_points(corners, body.order).reshape(-1, 3), tie.master_part
    ).reshape(len(corners), -1)
    quad, xi, _, _ = project_to_quads(body.all_X[slaves], corners)
    weights = face_basis(xi, body.order)
    for slave, nodes, row in zip(slaves, masters[quad], weights):
        kept = np.abs(row) > 1e-12
        yield int(slave), (nodes[kept], row[kept] / row[kept].sum())
