"""A mesh of one's own stays where its file has it unless the case says otherwise."""

import meshio
import numpy as np
import pytest
from small_structures import STONE, structure

from fecolumn.foundation.schema import InputError
from fecolumn.structures.structure import structure_model

CUBE = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)


def _cube(folder, name, points):
    meshio.Mesh(points, [("hexahedron", [list(range(8))])]).write(folder / f"{name}.vtk")
    return dict(kind="mesh", mesh_file=str(folder / f"{name}.vtk"), rigid=True) | STONE


def _centre(body, **keys):
    case = structure(
        bodies=dict(cube=body | keys), joints=dict(foot=dict(between=["cube", "ground"]))
    )
    return structure_model(case).parts[0].center


def test_a_mesh_stays_where_it_is_drawn_and_at_m_moves_the_middle_of_its_foot(tmp_path):
    cube = _cube(tmp_path, "cube", CUBE + [3.0, 1.0, 0.0])
    assert _centre(cube) == pytest.approx([3.5, 1.5, 0.5])
    assert _centre(cube, at_m=[0.0, 0.0, 0.0]) == pytest.approx([0.0, 0.0, 0.5])
    assert _centre(cube, copies_m=[[1.0, 2.0, 0.0]]) == pytest.approx([1.0, 2.0, 0.5])
    assert _centre(cube, turned_deg=30.0) == pytest.approx([3.5, 1.5, 0.5])


def test_height_of_a_drawn_mesh_counts(tmp_path):
    with pytest.warns(UserWarning, match="begin 0.02 m apart"):
        _centre(_cube(tmp_path, "cube", CUBE + [0.0, 0.0, 0.02]))


def test_a_mesh_without_a_flat_foot_may_stand_on_its_other_faces(tmp_path):
    """A voussoir of another program that lies in a notch of two wedges."""
    turned = CUBE - [0.5, 0.5, 0.0]
    turned[:, 0], turned[:, 2] = (turned[:, 0] - turned[:, 2]), (turned[:, 0] + turned[:, 2])
    turned *= [np.sqrt(0.5), 1.0, np.sqrt(0.5)]
    turned -= [turned[turned[:, 2].argmin(), 0], 0.0, turned[:, 2].min()]
    cube = _cube(tmp_path, "cube", turned)
    wedge = dict(kind="prism", width_m=2.0, element_size_m=1.0, rigid=True) | STONE
    case = structure(
        bodies=dict(
            cube=cube,
            left=wedge | dict(outline_m=[[0, 0], [-1, 1], [-1, 0]]),
            right=wedge | dict(outline_m=[[0, 0], [1, 0], [1, 1]]),
        ),
        joints=dict(
            left=dict(between=["left", "ground"]),
            right=dict(between=["right", "ground"]),
            low=dict(between=["left", "cube"]),
            high=dict(between=["right", "cube"]),
        ),
        contact=dict(friction_coefficient=1.0),
    )
    model = structure_model(case)
    assert model.parts[0].center == pytest.approx([0.0, 0.0, np.sqrt(0.5)], abs=1e-12)
    found = {
        joint.name: model.parts[joint.slave].model.surfaces[joint.slave_surface].normal
        for joint in model.joints
        if joint.pair < 0 and "cube" in joint.name
    }
    assert len(found) == 2
    for normal in found.values():
        assert abs(normal[0]) == pytest.approx(np.sqrt(0.5)) and normal[2] == pytest.approx(
            -np.sqrt(0.5)
        )
    with pytest.raises(InputError, match="at_m.*no flat foot"):
        structure_model(case.replace({"bodies.cube.at_m": [0.0, 0.0, 0.0]}))
