"""Mesh files for other programs."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from fecolumn.mesh.bricks import BrickMesh, merge
from fecolumn.mesh.specimen import SpecimenMesh


def write_meshes(specimen: SpecimenMesh, folder) -> tuple[Path, ...]:
    """Body and base together as `specimen.msh` (Gmsh 2.2) and `specimen.xdmf` with `specimen.h5` (ParaView).

    The part of each brick is its physical group in the first and the cell field `part` in the second. A reader never
    meets a half-written file: everything is written elsewhere in the folder and then renamed.

    Args:
        specimen: what is written.
        folder: where; made if missing.

    Returns:
        The paths of the three files.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    whole = merge([specimen.body, specimen.base])
    with tempfile.TemporaryDirectory(dir=folder, prefix=".writing-") as draft:
        # The .xdmf names its .h5, so both need their final names; the .h5 must be there first.
        _write_msh(whole, Path(draft) / "specimen.msh")
        _write_xdmf(whole, Path(draft) / "specimen.xdmf")
        written = []
        for name in ("specimen.msh", "specimen.h5", "specimen.xdmf"):
            os.replace(Path(draft) / name, folder / name)
            written.append(folder / name)
    return tuple(written)


def _write_msh(mesh: BrickMesh, path: Path) -> None:
    import meshio

    tags = mesh.part.astype("int32")
    meshio.Mesh(mesh.points, [("hexahedron", mesh.cells)],
                cell_data={"gmsh:physical": [tags], "gmsh:geometrical": [tags]}).write(path, file_format="gmsh22")


def _write_xdmf(mesh: BrickMesh, path: Path) -> None:
    import meshio

    meshio.Mesh(mesh.points, [("hexahedron", mesh.cells)], cell_data={"part": [mesh.part.astype("int32")]}).write(path)
