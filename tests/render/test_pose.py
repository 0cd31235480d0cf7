"""The history alone gives the place of every point of the column, and of the pressure's centre."""

import numpy as np
import pytest
from rocking_analyses import DRUM, analysed
from scipy.spatial.transform import Rotation

from fecolumn.case.sections import GRAVITY
from fecolumn.fem.rotation import twist_angle
from fecolumn.mesh.mass import MassProperties
from fecolumn.pictures.render.pose import Poses
from fecolumn.pictures.render.pressure_centre import pressure_centre
from fecolumn.pictures.render.result import read_result


def test_between_two_rows_a_column_turns_steadily():
    quarter = Rotation.from_rotvec([[0, 0, 0], [0, 0, np.pi / 2]]).as_matrix()
    middle = Poses(
        np.array([0.0, 1.0]), quarter, np.array([[0.0, 0, 0], [1.0, 0, 0]]), np.zeros(3)
    ).at(np.array([0.5]))
    assert middle.foot[0] == pytest.approx([0.5, 0, 0]) and twist_angle(
        middle.rotation[0]
    ) == pytest.approx(np.pi / 4)


def _farthest(folder) -> float:
    """Largest distance of a point of the rigid column from that of the fields, over the height."""
    result = read_result(folder)
    body, found = result.scene.pieces[0].upright, result.poses[0].at(result.fields.time)
    apart = [
        np.abs(found.move(body, k) - body - result.fields.read(k).displacement[: len(body)]).max()
        for k in range(len(result.fields.time))
    ]
    return max(apart) / result.height


def test_poses_agree_with_the_fields_of_the_reduced_engine(drum):
    assert _farthest(drum) < 1e-3


def test_poses_agree_with_the_fields_of_the_full_engine(tmp_path):
    tables = DRUM | {
        "integration": {"engine": "full", "duration_s": 0.02, "dt_s": 1e-3},
        "output": {"fields_every_s": 0.01},
    }
    assert _farthest(analysed(tables, tmp_path / "run")) < 1e-3


def test_a_block_that_is_shaken_steadily_presses_off_its_middle():
    """Standing under an acceleration a of its base along x, centre of mass at height h: the
    reaction passes through (-a h / g, 0).
    """
    time, mass = (
        np.linspace(0, 1, 101),
        MassProperties(1.0, 100.0, np.array([0.0, 0.0, 0.6]), np.eye(3)),
    )
    at_rest = Poses(time, np.tile(np.eye(3), (101, 1, 1)), np.zeros((101, 3)), np.zeros(3))
    ground = np.tile([1.5, -0.5, 0.0], (101, 1))
    centre = pressure_centre(at_rest, ground, mass, np.array([0.5]), 0.1)[0]
    assert centre == pytest.approx(np.array([-1.5, 0.5]) * 0.6 / GRAVITY, rel=1e-9)


def test_nothing_presses_in_flight():
    time, mass = (
        np.linspace(0, 0.1, 101),
        MassProperties(1.0, 100.0, np.array([0.0, 0.0, 0.6]), np.eye(3)),
    )
    falls = np.column_stack([0 * time, 0 * time, 1.0 - GRAVITY * time**2 / 2])
    assert np.isnan(
        pressure_centre(
            Poses(time, np.tile(np.eye(3), (101, 1, 1)), falls, np.zeros(3)),
            np.zeros((101, 3)),
            mass,
            np.array([0.05]),
            0.02,
        )
    ).all()


def test_a_wobbling_drum_presses_where_its_fields_have_the_pressure(drum):
    from fecolumn.pictures.render.frames import Frames

    result = read_result(drum)
    frames = Frames(result, result.fields.time[1:-1], 0.04)
    found = frames.centres - np.array([frame.centres[0] for frame in frames])
    assert np.hypot(*found.T).max() < 0.05 * 0.5
