"""Motion of each body in the history of a rocking model, and its pictures."""

from __future__ import annotations

import h5py
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_models_of_bodies import (
    AROUND,
    BLOCK,
    DRUM,
    FOOT,
    PIER,
    PLACES,
    POST,
    STOREYS,
    case,
    frame,
    own,
)

from fecolumn.case.case import case_of_table
from fecolumn.engines.rocking.body_motion import body_motion
from fecolumn.engines.rocking.of_bodies import model_of
from fecolumn.foundation.schema import InputError
from fecolumn.motions.record import GroundMotion
from fecolumn.pictures.render.result import read_result
from fecolumn.pictures.render.thrust import JointForces
from fecolumn.simulation import run

SLAB = {name: value for name, value in STOREYS.items() if not name.startswith(("floor", "storey"))}
SLAB |= dict(kind="slab")
TIME = 1e-3 * np.arange(1500)
SHAKEN = np.zeros((1500, 3))
SHAKEN[:, 0] = 3.0 * np.sin(2 * np.pi * TIME)
BOTH = SHAKEN.copy()
BOTH[:, 1] = 4.0 * np.sin(2 * np.pi * 1.3 * TIME)


def moved(made, ground=SHAKEN):
    """Response of a case's model to a ground motion (n, 3) [m/s2], and columns of its bodies."""
    response = model_of(made, "case.toml").respond(GroundMotion(ground, 1e-3, "", ""))
    assert response.tilt.max() > 1e-3
    return response, body_motion(made, response, "case.toml")


@pytest.mark.parametrize("engine, body", [("housner", BLOCK), ("wobbling", DRUM)])
def test_the_top_of_a_body_moves_as_the_response_says(engine, body):
    response, columns = moved(case(engine, dict(body=body), FOOT), BOTH)
    np.testing.assert_allclose(columns["mark/body.top/displacement"], response.u_top, atol=1e-12)
    assert np.abs(response.u_top[:, 1]).max() > 1e-4


def test_the_centre_of_mass_of_an_uneven_block_turns_about_the_edges():
    """Its potential energy is the weight times the height of the centre in the columns."""
    made = case("housner", dict(body=BLOCK | dict(centre_m=[0.05, 0.0, 0.7])), FOOT)
    response, columns = moved(made)
    mass = 2700.0 * 0.4 * 0.6 * 1.6
    np.testing.assert_allclose(
        mass * 9.80665 * columns["body/body/displacement"][:, 2],
        response.energy["gravity"],
        atol=1e-9 * mass,
    )


@pytest.mark.parametrize("engine, body", [("housner", BLOCK), ("wobbling", DRUM)])
def test_the_ground_pushes_a_body_as_its_centre_of_mass_accelerates(engine, body):
    """F = m (a + g) between impacts, at an edge or a place of the rim when it leans."""
    made = case(engine, dict(body=body), FOOT)
    response, columns = moved(made, BOTH)
    n = min(len(TIME), int(np.argmax(np.append(response.tilt, 1.0) > 0.3)))  # what falls turns far
    center = columns["body/body/displacement"][:n]
    (name,) = {one.split("/")[1] for one in columns if one.startswith("interface/")}
    force, foot = (columns[f"interface/{name}/{one}"][:n] for one in ("resultant", "center"))
    mass = 2700.0 * 1.6 * (0.4 * 0.6 if engine == "housner" else np.pi / 4 * 0.4**2)
    moves = (center[2:] - 2 * center[1:-1] + center[:-2]) / 1e-3**2
    pushed = mass * (BOTH[1 : n - 1] + moves + [0.0, 0.0, 9.80665])
    smooth = np.ones(n - 2, bool)  # without an impact within three steps
    for time in response.impact_times:
        smooth &= np.abs(TIME[1 : n - 1] - time) > 3e-3
    assert smooth.sum() > 500
    error = np.linalg.norm((force[1:-1] - pushed)[smooth], axis=1)
    assert np.quantile(error, 0.95) < 0.01 * mass * 9.80665
    leans = response.tilt[:n] > 1e-3
    if engine == "housner":
        assert (np.abs(foot[:, :2]) <= np.array([0.2, 0.3]) + 1e-12).all()
        assert np.isclose(np.abs(foot[leans, :2]), [0.2, 0.3]).any(axis=1).all()
    else:
        np.testing.assert_allclose(np.hypot(*foot[leans, :2].T), 0.2)


@pytest.mark.parametrize("seconds", [0.4, 1.5, 3.0])
@pytest.mark.parametrize("engine, body", [("housner", BLOCK), ("wobbling", DRUM)])
def test_what_is_let_go_beyond_its_critical_tilt_has_overturned_however_long_it_is_followed(
    engine, body, seconds, tmp_path
):
    made = case(engine, dict(body=body), FOOT, initial=dict(body=dict(tilt_rad=0.26)))
    made = made.replace({"integration.duration_s": seconds})
    summary = run(made, tmp_path / "run", quiet=True)
    assert summary["outcome"] == "overturned" and summary["overturn_time_s"] < 1e-2


@pytest.mark.long
def test_forces_of_a_rocking_model_are_drawn(tmp_path):
    made = case("wobbling", dict(body=DRUM), FOOT, initial=dict(body=dict(tilt_rad=0.05)))
    run(made, tmp_path / "run", quiet=True)
    drawn = read_result(tmp_path / "run")
    forces = JointForces(drawn, 0.05)
    weight = 2700.0 * 1.6 * np.pi / 4 * 0.4**2 * 9.80665
    assert forces.largest == pytest.approx(weight, rel=0.2)


@pytest.mark.parametrize("engine, column", [("rocking_frame", PIER), ("wobbling_frame", POST)])
def test_a_slab_lies_on_the_upper_edges_of_all_columns(engine, column):
    made = frame(engine, column, SLAB)
    response, columns = moved(made, BOTH if engine == "wobbling_frame" else SHAKEN)
    slab = columns["body/slab/displacement"]
    np.testing.assert_allclose(slab, response.u_top, atol=1e-12)
    assert not columns["body/slab/rotation"].any()
    for number, place in enumerate(AROUND if engine == "wobbling_frame" else PLACES, 1):
        turned = Rotation.from_rotvec(columns[f"body/body {number}/rotation"])
        top = np.array(place) + [0, 0, 1.6] + columns[f"mark/body {number}.top/displacement"]
        lean = turned.apply([0.0, 0.0, 1.0])[:, :2]
        tilted = np.hypot(*lean.T) > 1e-9
        across = np.zeros((len(lean), 3))
        across[tilted, :2] = -lean[tilted] / np.hypot(*lean[tilted].T)[:, None]
        edge = top + turned.apply(0.1 * across)
        # the edge that is highest: it touches the slab at the same place of that, always
        np.testing.assert_allclose(
            edge[tilted],
            (np.array(place) + [0, 0, 1.6] + slab + 0.1 * across)[tilted],
            atol=1e-12,
        )


@pytest.mark.long
def test_floors_of_a_podium_are_in_its_history_and_drawn(tmp_path):
    """The roof is the top that the model tells; a run is drawn from its history alone."""
    table = [f"{time:.3f},{value:.6f}" for time, value in zip(TIME, SHAKEN[:, 0])]
    (tmp_path / "push.csv").write_text("time_s,ax_m_s2\n" + "\n".join(table) + "\n")
    made = frame(
        "podium",
        PIER,
        STOREYS | dict(period_s=0.3, profile="shear"),
        motion=dict(source=str(tmp_path / "push.csv")),
    ).replace({"integration.duration_s": 0.0})
    run(made, tmp_path / "run", quiet=True)
    with h5py.File(tmp_path / "run" / "history.h5") as file:
        roof = file["mark/slab.floor 3/displacement"][:]
        drifts = sum(file[f"storey/slab {number}/drift"][:] for number in (1, 2, 3))
        slab = file["body/slab/displacement"][:]
        np.testing.assert_allclose(roof, file["u_top"][:], atol=1e-12)
        np.testing.assert_allclose((slab + np.pad(drifts, [(0, 0), (0, 1)])), roof, atol=1e-12)
    result = read_result(tmp_path / "run", "slab")
    assert len(result.poses) == 3
    floors = result.scene_history.floors[2]
    np.testing.assert_allclose(floors[:, -1], roof - slab, atol=1e-9)


def test_a_motion_across_the_plane_of_a_frame_is_told(tmp_path):
    table = [f"{time:.3f},0,{value:.6f}" for time, value in zip(TIME, SHAKEN[:, 0])]
    (tmp_path / "push.csv").write_text("time_s,ax_m_s2,ay_m_s2\n" + "\n".join(table) + "\n")
    motion = dict(source=str(tmp_path / "push.csv"))
    made = frame("rocking_frame", PIER, SLAB, motion=motion)
    with pytest.warns(UserWarning, match="rocks along x alone.*along y, of up to 3 m/s2"):
        summary = run(made.replace({"integration.duration_s": 0.0}), tmp_path / "run", quiet=True)
    assert "rocks along x alone" in summary["notes"][-1]


def test_a_model_of_its_own_table_has_no_bodies_to_draw(tmp_path):
    table = dict(block=dict(width_m=0.4, height_m=1.6, density_kg_m3=2700.0))
    response = own(**table).respond(GroundMotion(SHAKEN, 1e-3, "", ""))
    made = case_of_table(table | dict(integration=dict(duration_s=0.1)), "case.toml")
    assert body_motion(made, response, "case.toml") == {}
    run(made, tmp_path / "run", quiet=True)
    with pytest.raises(InputError, match="which has no bodies to draw"):
        read_result(tmp_path / "run")
