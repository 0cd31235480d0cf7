"""Mesh files for other programs."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np

from fecolumn.mesh.bricks import merged_mesh
from fecolumn.mesh.specimen import SpecimenMesh


def write_meshes(specimen: SpecimenMesh, folder) -> tuple[Path, ...]:
    """Body and base together as `specimen.msh` (Gmsh 2.2) and `specimen.xdmf` with `specimen.h5`
    (ParaView).

    The part of each brick is its physical group in the first and the cell field `part` in the
    second. A reader never meets a half-written file: everything is written elsewhere in the folder
    and then renamed.

    Parameters
    ----------
    specimen
        what is written.
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
        _write_msh(specimen, Path(draft) / "specimen.msh")
        _write_xdmf(specimen, Path(draft) / "specimen.xdmf")
        written = []
        for name in ("specimen.msh", "specimen.h5", "specimen.xdmf"):
            os.replace(Path(draft) / name, folder / name)
            written.append(folder / name)
    return tuple(written)


def _write_msh(specimen: SpecimenMesh, path: Path) -> None:
    blocks, points = _blocks(specimen)
    tags = [part for _, _, part in blocks]
    _meshio().Mesh(
        points,
        [(kind, cells) for kind, cells, _ in blocks],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
    ).write(path, file_format="gmsh22")


def _write_xdmf(specimen: SpecimenMesh, path: Path) -> None:
    blocks, points = _blocks(specimen)
    _meshio().Mesh(
        points,
        [(kind, cells) for kind, cells, _ in blocks],
        cell_data={"part": [part for _, _, part in blocks]},
    ).write(path)


def _meshio():
    import meshio

    return meshio


def _blocks(specimen: SpecimenMesh):
    """Kind, cells and parts of each block of elements of one kind, and all points."""
    meshes = specimen.body, specimen.base
    if not specimen.body.is_tetrahedral:
        meshes = (merged_mesh(meshes),)
    offsets = np.cumsum([0] + [len(mesh.points) for mesh in meshes])
    blocks = [
        (
            "tetra" if mesh.is_tetrahedral else "hexahedron",
            mesh.cells + offset,
            mesh.part.astype("int32"),
        )
        for mesh, offset in zip(meshes, offsets)
    ]
    return blocks, np.concatenate([mesh.points for mesh in meshes])
