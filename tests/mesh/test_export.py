import meshio
import numpy as np
import pytest
from small_specimen import small_case

from fecolumn.mesh.bricks import merged_mesh
from fecolumn.mesh.export import write_meshes
from fecolumn.mesh.specimen import specimen_mesh


@pytest.fixture(scope="module")
def specimen():
    return specimen_mesh(small_case())


def test_written_files_hold_the_mesh_and_its_parts(specimen, tmp_path):
    whole = merged_mesh([specimen.body, specimen.base])
    for _ in range(2):  # the second time over existing files
        paths = write_meshes([specimen.body, specimen.base], tmp_path / "new" / "folder")
    assert sorted(p.name for p in (tmp_path / "new" / "folder").iterdir()) == sorted(
        p.name for p in paths
    )
    for name, key in (("specimen.msh", "gmsh:physical"), ("specimen.xdmf", "part")):
        found = meshio.read(tmp_path / "new" / "folder" / name)
        assert np.array_equal(found.points, whole.points)
        assert np.array_equal(found.cells_dict["hexahedron"], whole.cells)
        assert np.array_equal(np.concatenate(found.cell_data[key]), whole.part)


def test_a_failed_write_leaves_the_earlier_files(specimen, tmp_path, monkeypatch):
    meshes = [specimen.body, specimen.base]
    before = {path: path.read_bytes() for path in write_meshes(meshes, tmp_path)}

    def full_disk(*arguments, **options):
        raise OSError("no space left on device")

    monkeypatch.setattr("fecolumn.mesh.export._write_xdmf", full_disk)
    with pytest.raises(OSError):
        write_meshes(meshes, tmp_path)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
