"""Fields for ParaView: displacement, von Mises stress and contact pressure as XDMF with one HDF5
file a frame.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import numpy as np
from dolfinx import fem
from numpy.typing import NDArray

from fecolumn.engines.scene.frame_files import frame_digits, frame_name, time_of_frame
from fecolumn.fem.material.elasticity import isotropic_stress, von_mises
from fecolumn.fem.material.kinematics import linear_strain
from fecolumn.foundation import _dolfinx
from fecolumn.foundation.atomic import write_bytes, write_hdf5

if TYPE_CHECKING:
    import h5py
    from mpi4py import MPI

    from fecolumn.fem.body import Body
    from fecolumn.mesh.bricks import BrickMesh

_TOPOLOGY = (
    '<Topology TopologyType="{kind}" NumberOfElements="{cells}"><DataItem '
    'Dimensions="{numbers}" Format="HDF" NumberType="Int" '
    'Precision="8">mesh.h5:/cells</DataItem></Topology>'
)
_GEOMETRY = (
    '<Geometry GeometryType="XYZ"><DataItem Dimensions="{points} 3" Format="HDF" '
    'Precision="8">mesh.h5:/points</DataItem></Geometry>'
)
_FIELD = (
    '<Attribute Name="{title}" AttributeType="{kind}" Center="{center}"><DataItem '
    'Dimensions="{shape}" Format="HDF" Precision="8">{file}:/{name}</DataItem></Attribute>'
)
# Numbers of elements in XDMF by their points: triangle, tetrahedron, brick
_XDMF = {3: 4, 4: 6, 8: 9}


class _Drawn(Protocol):
    """What has meshes whose fields are written."""

    comm: MPI.Intracomm
    of_cells: dict[str, NDArray[Any]]
    meshes: list[BrickMesh]


_D = TypeVar("_D", bound=_Drawn)


class FieldWriter(Generic[_D]):
    """Writes frames of bodies into a folder; `fields.xdmf` always lists complete frames only.

    Displacements are relative to the shaking table. Frames of an interrupted analysis are kept and
    continued.

    Parameters
    ----------
    fields
        what has meshes, of_cells, comm and values as `engines.scene.state_fields.StateFields` has.
    interval_s
        least time between frames [s].
    """

    def __init__(self, folder: Path, fields: _D, interval_s: float = 1.0) -> None:
        self.folder, self.fields = folder, fields
        self._digits = frame_digits(interval_s)
        self._mixed = any(mesh.cells.shape[1] != 8 for mesh in fields.meshes)
        if fields.comm.rank == 0:
            folder.mkdir(parents=True, exist_ok=True)
            self._write_mesh()

    def _write_mesh(self) -> None:
        meshes = self.fields.meshes
        lists = [
            mesh.cells + first
            for mesh, first in zip(meshes, np.cumsum([0] + [len(mesh.points) for mesh in meshes]))
        ]
        # XDMF tells elements of different kinds in one list by their numbers
        cells = (
            np.concatenate(
                [np.insert(some, 0, _XDMF[some.shape[1]], axis=1).ravel() for some in lists]
            )
            if self._mixed
            else np.vstack(lists)
        )
        _write_h5(
            self.folder / "mesh.h5",
            {
                "points": np.vstack([mesh.points for mesh in meshes]),
                "cells": cells,
                **{name: values.astype(float) for name, values in self.fields.of_cells.items()},
            },
        )

    def add(self, time: float, values: dict[str, NDArray[Any]] | None) -> None:
        """Add the frame of a time [s] from its `values`, or None of another rank than 0."""
        if values is not None:
            _write_h5(self.folder / frame_name(time, self._digits), values)
            self._write_index()

    def _write_index(self) -> None:
        meshes = self.fields.meshes
        points, cells = (
            sum(len(mesh.points) for mesh in meshes),
            sum(len(mesh.cells) for mesh in meshes),
        )
        kind = "Mixed" if self._mixed else "Hexahedron"
        numbers = (
            sum(len(mesh.cells) * (mesh.cells.shape[1] + 1) for mesh in meshes)
            if self._mixed
            else f"{cells} 8"
        )
        grids = []
        for frame in sorted(self.folder.glob("frame_*.h5")):
            fields = [
                _FIELD.format(
                    title="displacement [m]",
                    kind="Vector",
                    center="Node",
                    shape=f"{points} 3",
                    file=frame.name,
                    name="displacement",
                ),
                _FIELD.format(
                    title="von Mises stress [Pa]",
                    kind="Scalar",
                    center="Cell",
                    shape=cells,
                    file=frame.name,
                    name="von_mises",
                ),
                _FIELD.format(
                    title="contact pressure [Pa]",
                    kind="Scalar",
                    center="Node",
                    shape=points,
                    file=frame.name,
                    name="pressure",
                ),
                *(
                    _FIELD.format(
                        title=name,
                        kind="Scalar",
                        center="Cell",
                        shape=cells,
                        file="mesh.h5",
                        name=name,
                    )
                    for name in self.fields.of_cells
                ),
            ]
            time = time_of_frame(frame)
            grids.append(
                f'<Grid Name="fecolumn" GridType="Uniform"><Time Value="{time}"/>'
                + _TOPOLOGY.format(cells=cells, kind=kind, numbers=numbers)
                + _GEOMETRY.format(points=points)
                + "".join(fields)
                + "</Grid>"
            )
        text = (
            '<?xml version="1.0"?>\n<Xdmf Version="3.0"><Domain><Grid Name="frames" '
            'GridType="Collection" CollectionType="Temporal">\n'
            + "\n".join(grids)
            + "\n</Grid></Domain></Xdmf>\n"
        )
        write_bytes(self.folder / "fields.xdmf", text.encode())


class StressField:
    """Von Mises stress at the middle of each element, in the order of the input mesh."""

    def __init__(self, body: Body) -> None:
        self.body = body
        self._u = fem.Function(body.space)
        space = _dolfinx.cellwise_space(body.mesh)
        material = body.material
        stress = von_mises(
            isotropic_stress(
                linear_strain(self._u), material.youngs_modulus_pa, material.poissons_ratio
            )
        )
        self._expression = fem.Expression(stress, _dolfinx.interpolation_points(space))
        self._result = fem.Function(space)

    def values(self, displacement: NDArray[Any]) -> NDArray[Any] | None:
        """(n_cells,) [Pa] on rank 0 from local displacements (n_owned, 3)."""
        body = self.body
        self._u.x.array[: 3 * body.n_owned] = displacement.reshape(-1)
        self._u.x.scatter_forward()
        self._result.interpolate(self._expression)
        owned = body.mesh.topology.index_map(3).size_local
        cells = np.asarray(body.mesh.topology.original_cell_index)[:owned]
        pieces: Any = body.comm.gather((cells, self._result.x.array[:owned].copy()))
        if body.comm.rank:
            return None
        stress = np.empty(len(body.bricks.cells))
        for numbers, values in pieces:
            stress[numbers] = values
        return stress


def vertex_nodes(body: Body) -> NDArray[Any]:
    """Node of each point of the body's input mesh."""
    nodes = np.empty(len(body.bricks.points), np.int64)
    for part in np.unique(body.bricks.part):
        points = np.unique(body.bricks.cells[body.bricks.part == part])
        nodes[points] = body.find_nodes(body.bricks.points[points], part)
    return nodes


def _write_h5(path: Path, arrays: dict[str, NDArray[Any]]) -> None:
    def fill(file: h5py.File) -> None:
        for name, values in arrays.items():
            file.create_dataset(name, data=values, compression="gzip")

    write_hdf5(path, fill)
