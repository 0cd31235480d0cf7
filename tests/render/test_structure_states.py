"""States of a structure give back where its bodies are, how they deform and what presses on their
faces.
"""

import shutil

import h5py
import numpy as np
import pytest
from rocking_structures import GATE, TILTED, analysed, case_of
from scipy.interpolate import griddata

from fecolumn.engines.reduced.states import STATES_FILE
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.frames import Frames
from fecolumn.pictures.render.result import read_result
from fecolumn.simulation import run

GRAVITY = 9.80665
COLUMN_KG, LINTEL_KG = 0.2 * 0.4 * 0.8 * 2700, 1.3 * 0.44 * 0.2 * 2700


@pytest.fixture(scope="module")
def standing(tmp_path_factory):
    """The gate at rest, its tendon gone."""
    return read_result(
        analysed(
            tmp_path_factory.mktemp("standing") / "run",
            GATE,
            dict(links=dict(tendon=False), integration=dict(duration_s=0.02)),
        )
    )


def _forces(result, state):
    """Contact force (3,) [N] on each body."""
    first = result.states.drawn.first_node
    at_nodes = state.at_nodes(first[-1])
    return [at_nodes[a:b].sum(axis=0) for a, b in zip(first, first[1:])]


def test_contact_forces_of_a_standing_gate_carry_the_weight_of_each_body(standing):
    forces = _forces(standing, standing.states.state(0))
    assert np.array(forces) == pytest.approx(
        GRAVITY * np.array([[0, 0, COLUMN_KG]] * 2 + [[0, 0, LINTEL_KG]]), abs=1e-3
    )


def test_pressure_on_the_faces_carries_what_stands_on_them(standing):
    pressures, centres = standing.states.drawn.pressures(standing.states.state(0))
    carried = {
        (contact.interface, contact.slave): (pressure @ seat.areas, centre)
        for contact, seat, pressure, centre in zip(
            standing.scene.contacts, standing.states.drawn.seats, pressures, centres
        )
    }
    assert carried["feet", "column 1"][0] == pytest.approx(
        GRAVITY * (COLUMN_KG + LINTEL_KG / 2), rel=1e-5
    )
    assert carried["heads", "column 2"][0] == pytest.approx(GRAVITY * LINTEL_KG / 2, rel=1e-5)
    # the lintel sags: it presses on the inner edges of the columns
    assert carried["heads", "column 1"][1][0] > 0 > carried["heads", "column 2"][1][0]


def test_deformed_meshes_of_a_standing_gate_touch_where_they_press(standing):
    """Modes and static response together: on the rigid ground the feet stay level to a thousandth
    of what the columns shorten, and heads and lintel meet.
    """
    fields, state, contacts = (
        standing.states.drawn,
        standing.states.state(0),
        standing.scene.contacts,
    )
    placed = standing.states.drawn.positions(state, fields.local(state)[0])
    shortening = 0.8 * GRAVITY * LINTEL_KG / 2 / (0.08 * 50e9)
    for contact, seat, pressure in zip(contacts, fields.seats, fields.pressures(state)[0]):
        if contact.interface.endswith(", edge"):
            continue  # the other side of a joint carries where its body has slid
        feet = placed[contact.points][seat.shares @ pressure > 0]
        level = 0.0 if contact.on_ground else 0.8
        assert (
            len(feet) >= 3
            and np.abs(feet[:, 2] - level).max() < (1e-3 if contact.on_ground else 5) * shortening
        )
    lintel = placed[standing.scene.first[2] :]
    under = lintel[np.abs(standing.scene.points[standing.scene.first[2] :, 2] - 0.8) < 1e-9]
    head = next(
        k
        for k, contact in enumerate(contacts)
        if (contact.interface, contact.slave) == ("heads", "column 1")
    )
    shown = fields.seats[head].shares @ fields.pressures(state)[0][head]
    pressed = placed[contacts[head].points][shown > 0]
    gaps = griddata(under[:, :2], under[:, 2], pressed[:, :2]) - pressed[:, 2]
    assert np.abs(gaps).max() < 0.1 * shortening


def test_stress_of_a_standing_column_is_what_it_carries_over_its_section(standing):
    _, _, stress = standing.states.drawn.local(standing.states.state(0))
    of_column = stress[standing.scene.first_cell[0] : standing.scene.first_cell[1]]
    assert (
        np.median(of_column) == pytest.approx(GRAVITY * (LINTEL_KG + COLUMN_KG) / 2 / 0.08, rel=0.6)
        and not np.isnan(stress).any()
    )


def test_states_place_the_tops_where_the_history_has_them(gate):
    result = read_result(gate)
    fields = result.states.drawn
    for k, time in enumerate(result.states.time):
        state, row = result.states.state(k), np.searchsorted(result.time, time - 1e-9)
        for number, (body, model) in enumerate(zip(result.scene.bodies, fields.models)):
            arm = model.marks["top"][0]
            moved = state.center[number] + state.rotation[number] @ arm - body.center - arm
            assert moved == pytest.approx(
                result.history[f"mark/{body.name}.top/displacement"][row], abs=1e-5
            )
        placed = result.states.drawn.positions(state, fields.local(state)[0])
        assert placed[:, 2].min() > -1e-6  # the rigid ground is never entered


def test_floors_of_a_building_sway_as_the_history_says(building):
    result = read_result(building)
    fields, first = result.states.drawn, len(result.scene.points) - 16
    swayed = []
    for k, time in enumerate(result.states.time):
        state, row = result.states.state(k), np.searchsorted(result.time, time - 1e-9)
        local, bent, _ = fields.local(state)
        moved = result.states.drawn.positions(state, local) - result.scene.points
        for floor in range(2):
            of_floor = slice(first + 8 * floor + 4, first + 8 * (floor + 1))  # its upper face
            assert moved[of_floor].mean(axis=0) == pytest.approx(
                result.history[f"mark/building.floor {floor + 1}/displacement"][row], abs=5e-5
            )
        drift = bent[first : first + 8].mean(axis=0)[:2]
        assert drift == pytest.approx(result.history["storey/building 1/drift"][row], abs=5e-5)
        swayed.append(np.linalg.norm(drift))
    assert max(swayed) > 2e-3  # a hundred times what the comparisons allow is seen


def test_states_of_an_interrupted_structure_are_those_of_one_that_was_not(gate, tmp_path):
    asked, case = [], case_of(GATE, TILTED)
    with pytest.raises(KeyboardInterrupt):
        run(case, tmp_path / "run", quiet=True, stop=lambda: asked.append(1) or len(asked) > 2)
    run(case, tmp_path / "run", quiet=True)
    with h5py.File(gate / STATES_FILE) as whole, h5py.File(tmp_path / "run" / STATES_FILE) as parts:
        assert set(whole) == set(parts) and len(whole["time"]) == 6
        assert all(np.array_equal(whole[name][()], parts[name][()]) for name in whole)


def test_a_broken_tendon_is_kept_as_broken_and_not_drawn(tmp_path):
    pushed = dict(
        column=dict(velocity_m_s=[0.5, 0.0, 0.0], spin_rad_s=[0.0, 1.25, 0.0]),
        lintel=dict(velocity_m_s=[1.0, 0.0, 0.0]),
    )
    folder = analysed(
        tmp_path / "run",
        GATE,
        dict(
            initial=pushed,
            links=dict(tendon=dict(breaking_n=400.0)),
            integration=dict(duration_s=0.1),
        ),
    )
    result = read_result(folder)
    broken = [bool(result.states.state(k).broken[0]) for k in range(len(result.states.time))]
    assert not broken[0] and broken[-1]
    frames = Frames(result, result.states.time, 0.02, 1.0, "displacement")
    length = [np.linalg.norm(np.diff(frame.links[0], axis=0)) for frame in frames]
    assert length[0] == pytest.approx(0.8, rel=0.01) and length[-1] == 0


def test_fields_written_while_a_structure_runs_are_those_of_its_states(gate, tmp_path):
    folder = analysed(tmp_path / "run", GATE, TILTED, dict(output=dict(fields_every_s=0.04)))
    result = read_result(folder)
    assert result.fields.time == pytest.approx([0.0, 0.04, 0.08])
    for k, time in enumerate(result.fields.time):
        written, made = (
            result.fields.read(k),
            result.states.read(int(np.argmin(np.abs(result.states.time - time)))),
        )
        for name in ("displacement", "stress", "pressure"):
            one, other = getattr(written, name), getattr(made, name)
            assert np.abs(one - other).max() < 1e-5 * max(np.abs(one).max(), 1e-6)


def test_the_history_turns_every_body_as_its_states_do(gate):
    result = read_result(gate)
    for number, poses in enumerate(result.poses):
        there = poses.at(result.states.time)
        for k in range(len(result.states.time)):
            kept = result.states.state(k)
            assert there.rotation[k] == pytest.approx(kept.rotation[number], abs=1e-12)
            assert there.foot[k] == pytest.approx(kept.center[number], abs=1e-12)


def test_states_of_another_case_are_refused(standing, tmp_path):
    shutil.copytree(standing.folder, tmp_path / "run")
    with h5py.File(tmp_path / "run" / STATES_FILE, "a") as file:
        file.attrs["case_id"] = "0123456789ab"
    with pytest.raises(InputError, match="states.h5: case_id = '0123456789ab': is of another case"):
        read_result(tmp_path / "run")
