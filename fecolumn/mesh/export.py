"""Mesh files for other programs."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from types import ModuleType

import numpy as np

from fecolumn.mesh.bricks import BrickMesh


def write_meshes(meshes: list[BrickMesh], folder: Path | str) -> tuple[Path, ...]:
    """Meshes together as `specimen.msh` (Gmsh 2.2) and `specimen.xdmf` with `specimen.h5`
    (ParaView).

    The part of each element is its physical group in the first and the cell field `part` in the
    second, and `body` there its mesh, from 1. A reader never meets a half-written file: everything
    is written elsewhere in the folder and then renamed.

    Parameters
    ----------
    meshes
        of bodies and grounds, one after another.
    folder
        where; made if missing.

    Returns
    -------
    The paths of the three files.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder, prefix=".writing-") as draft:
        # The .xdmf names its .h5, so both need their final names; the .h5 must be there first.
        _write_msh(meshes, Path(draft) / "specimen.msh")
        _write_xdmf(meshes, Path(draft) / "specimen.xdmf")
        written = []
        for name in ("specimen.msh", "specimen.h5", "specimen.xdmf"):
            os.replace(Path(draft) / name, folder / name)
            written.append(folder / name)
    return tuple(written)


def _write_msh(meshes: list[BrickMesh], path: Path) -> None:
    blocks, points = _blocks(meshes)
    tags = [part for _, _, part, _ in blocks]
    _meshio().Mesh(
        points,
        [(kind, cells) for kind, cells, *_ in blocks],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
    ).write(path, file_format="gmsh22")


def _write_xdmf(meshes: list[BrickMesh], path: Path) -> None:
    blocks, points = _blocks(meshes)
    _meshio().Mesh(
        points,
        [(kind, cells) for kind, cells, *_ in blocks],
        cell_data={
            "part": [part for _, _, part, _ in blocks],
            "body": [np.full(len(part), number, "int32") for _, _, part, number in blocks],
        },
    ).write(path)


def _meshio() -> ModuleType:
    import meshio

    return meshio


def _blocks(
    meshes: list[BrickMesh],
) -> tuple[list[tuple[str, np.ndarray, np.ndarray, int]], np.ndarray]:
    """Kind, cells, parts and number of the mesh of each block of elements of one kind, and all
    points.
    """
    kinds = {3: "triangle", 4: "tetra", 8: "hexahedron"}
    offsets = np.cumsum([0] + [len(mesh.points) for mesh in meshes])
    blocks = [
        (kinds[mesh.cells.shape[1]], mesh.cells + offset, mesh.part.astype("int32"), number)
        for number, (mesh, offset) in enumerate(zip(meshes, offsets), 1)
        if len(mesh.cells)
    ]
    return blocks, np.concatenate([mesh.points for mesh in meshes])
