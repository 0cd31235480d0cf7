"""Fields for ParaView: displacement, von Mises stress and contact pressure as XDMF with one HDF5
file a frame.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from dolfinx import fem

from fecolumn import _dolfinx
from fecolumn.atomic import write_bytes, write_hdf5
from fecolumn.contact.projection import nodes_under
from fecolumn.dynamics.checkpoint import gather_all
from fecolumn.material.elasticity import isotropic_stress, von_mises
from fecolumn.material.kinematics import linear_strain

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


class SpecimenFields:
    """Fields of column and base from positions and contact forces, in the order of the mesh.

    Parameters
    ----------
    column
        Body.
    plate
        BasePlate, None for a base without bricks, which is not shown.
    foot
        Footprint, the column nodes that may touch and those that they stand for.
    specimen
        SpecimenMesh of both.
    """

    def __init__(self, column, plate, foot, specimen):
        self.specimen = specimen
        self.column, self.plate, self.foot, self.comm = column, plate, foot, column.comm
        #: Meshes that are drawn, and numbers of their cells by name, as `FieldWriter` takes them.
        self.meshes = [specimen.body, specimen.base]
        self.of_cells = {"part": np.concatenate([mesh.part for mesh in self.meshes])}
        bodies = (column, plate.body) if plate else (column,)
        self._nodes = [vertex_nodes(body) for body in bodies]
        self._stress = {body: StressField(body) for body in bodies}
        self._pressure_points = self._points_of_foot()

    def _points_of_foot(self) -> np.ndarray:
        at = {node: point for point, node in enumerate(self._nodes[0])}
        return np.array([at.get(node, -1) for node in self.foot.all_nodes])

    def values(self, x, local, positions, forces, at_nodes) -> dict[str, np.ndarray] | None:
        """Displacement (n_points, 3) [m] relative to the table, von Mises stress (n_cells,) and
        contact pressure (n_points,) [Pa] on rank 0; called on every rank.

        Parameters
        ----------
        x
            (n_owned, 3) positions of the column [m]
        local
            its displacements in its own frame [m].
        positions
            (n, 3) of the contact points [m], asked for with a plate alone
        forces
            (n, 3) on them [N]
        at_nodes
            (n, 3) these forces on the foot's nodes.
        """
        column, plate = self.column, self.plate
        displacement, stress = (
            [gather_all(column, x - column.X)],
            [self._stress[column].values(local)],
        )
        if plate:
            sunk = plate.displacement(
                *nodes_under(plate.grid, positions, forces[:, 2] > 0), -forces
            )
            displacement.append(gather_all(plate.body, sunk))
            stress.append(self._stress[plate.body].values(sunk))
        if column.comm.rank:
            return None
        pressure = np.zeros(len(self.specimen.body.points) + len(self.specimen.base.points))
        at_vertex = self._pressure_points >= 0
        pressure[self._pressure_points[at_vertex]] = (at_nodes[:, 2] / self.foot.areas)[
            self.foot.nearest
        ][at_vertex]
        return {
            "displacement": np.vstack(
                [values[nodes] for values, nodes in zip(displacement, self._nodes)]
            ),
            "von_mises": np.concatenate(stress),
            "pressure": pressure,
        }


class FieldWriter:
    """Writes frames of bodies into a folder; `fields.xdmf` always lists complete frames only.

    Displacements are relative to the shaking table. Frames of an interrupted analysis are kept and
    continued.

    Parameters
    ----------
    fields
        SpecimenFields, or what has `meshes`, `of_cells`, `comm` and `values` as it has.
    """

    def __init__(self, folder: Path, fields):
        self.folder, self.fields = folder, fields
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

    def write(self, time: float, x, local, positions, forces, at_nodes) -> None:
        """Add the frame of a time [s]; called on every rank, the other arguments as of
        `SpecimenFields.values`.
        """
        self.add(time, self.fields.values(x, local, positions, forces, at_nodes))

    def add(self, time: float, values: dict[str, np.ndarray] | None) -> None:
        """Add the frame of a time [s] from `SpecimenFields.values`."""
        if values is not None:
            _write_h5(self.folder / f"frame_{round(time * 1e6):012d}.h5", values)
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
            time = int(frame.stem.split("_")[1]) / 1e6
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

    def __init__(self, body):
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

    def values(self, displacement: np.ndarray) -> np.ndarray | None:
        """(n_cells,) [Pa] on rank 0 from local displacements (n_owned, 3)."""
        body = self.body
        self._u.x.array[: 3 * body.n_owned] = displacement.reshape(-1)
        self._u.x.scatter_forward()
        self._result.interpolate(self._expression)
        owned = body.mesh.topology.index_map(3).size_local
        cells = np.asarray(body.mesh.topology.original_cell_index)[:owned]
        pieces = body.comm.gather((cells, self._result.x.array[:owned].copy()))
        if body.comm.rank:
            return None
        stress = np.empty(len(body.bricks.cells))
        for numbers, values in pieces:
            stress[numbers] = values
        return stress


def vertex_nodes(body) -> np.ndarray:
    """Node of each point of the body's input mesh."""
    nodes = np.empty(len(body.bricks.points), np.int64)
    for part in np.unique(body.bricks.part):
        points = np.unique(body.bricks.cells[body.bricks.part == part])
        nodes[points] = body.find_nodes(body.bricks.points[points], part)
    return nodes


def _write_h5(path: Path, arrays: dict) -> None:
    def fill(file):
        for name, values in arrays.items():
            file.create_dataset(name, data=values, compression="gzip")

    write_hdf5(path, fill)
