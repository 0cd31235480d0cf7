"""What a reduced or rigid analysis keeps of its states gives deformation, stress and contact
pressure without field files.
"""

import itertools
import shutil
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from rocking_analyses import BLOCK, DRUM, analysed

from fecolumn.case.case import case_from_tables
from fecolumn.engines.scene.fields import FieldWriter
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.draw import render
from fecolumn.pictures.render.frames import Frames
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.pictures.render.result import read_result
from fecolumn.structures.structure import structure_model


@pytest.fixture(scope="module")
def stateful_block(tmp_path_factory):
    """The rigid block as it comes without being asked for fields."""
    return analysed(BLOCK | {"output": {}}, tmp_path_factory.mktemp("block") / "run")


def _largest(folder, name) -> tuple[float, float]:
    """Largest difference of a field made from states to that in the files, and the field's largest
    value.
    """
    result = read_result(folder)
    assert len(result.states.time) == len(
        result.fields.time
    ) and result.states.time == pytest.approx(result.fields.time, abs=1e-6)
    pairs = [
        (getattr(result.fields.read(k), name), getattr(result.states.read(k), name))
        for k in range(len(result.fields.time))
    ]
    return max(np.abs(one - other).max() for one, other in pairs), max(
        np.abs(one).max() for one, _ in pairs
    )


@pytest.mark.parametrize("name", ["displacement", "stress", "pressure"])
def test_states_of_a_wobbling_drum_give_the_fields_that_it_wrote(drum, name):
    difference, peak = _largest(drum, name)
    assert 0 < peak and difference < 1e-6 * peak


def test_states_of_the_rigid_engine_give_the_fields_that_it_wrote(tmp_path):
    folder = analysed(BLOCK | {"output": {"fields_every_s": 0.04}}, tmp_path / "run")
    difference, peak = _largest(folder, "stress")
    assert 1e3 < peak and difference < 1e-6 * peak


@pytest.mark.long
def test_pictures_without_field_files_show_stress_and_pressure(stateful_block):
    assert not (stateful_block / "fields").exists()
    result = read_result(stateful_block)
    frames = Frames(result, np.linspace(0, 0.2, 6), 0.04)
    assert frames.from_fields and frames.colour == "stress" and frames.pressure_quantity.largest > 0
    pressure = frames.frame(1).pressures[
        0
    ]  # it stands on one edge: 4 of 16 faces of 0.1 x 0.1 m carry
    weight = 0.4**2 * 1.2 * 2700 * 9.80665
    assert np.count_nonzero(pressure) == 4 and 0.8 * weight < pressure.sum() * 0.1**2 < 1.1 * weight
    files = render(
        stateful_block,
        RenderOptions(only="pictures", instants=(0.0, 0.08), exaggerate="auto"),
        quiet=True,
    )
    assert {file.name for file in files} >= {"sequence.png", "still_0.000s.png", "still_0.080s.png"}
    assert not Frames(
        result, np.linspace(0, 0.2, 6), 0.04, colour="displacement"
    ).from_fields  # which the history gives at once


def test_paraview_opens_what_the_states_give(stateful_block):
    import pyvista

    (script,) = render(stateful_block, RenderOptions(paraview=True), quiet=True)
    assert 'os.path.join(here, "fields", "fields.xdmf")' in script.read_text()
    reader = pyvista.get_reader(str(script.parent / "fields" / "fields.xdmf"))
    assert reader.time_values == pytest.approx(np.arange(0, 0.21, 0.04))


@pytest.mark.long
def test_states_of_other_modes_are_refused_and_the_history_still_drawn(drum, tmp_path):
    folder = shutil.copytree(
        drum, tmp_path / "run", ignore=shutil.ignore_patterns("fields", "render")
    )
    with h5py.File(folder / "states.h5", "r+") as file:
        file["signature"][0] *= -1  # a mode of the other sign, as another machine's may be
    with pytest.raises(InputError, match="of other modes .*--colour displacement"):
        render(folder, RenderOptions(only="pictures", instants=(0.08,)), quiet=True)
    assert render(
        folder, RenderOptions(only="pictures", instants=(0.08,), color="displacement"), quiet=True
    )


def test_damaged_states_are_told(drum, tmp_path):
    folder = shutil.copytree(drum, tmp_path / "run", ignore=shutil.ignore_patterns("render"))
    (folder / "states.h5").write_bytes(b"no hdf5")
    with pytest.raises(InputError, match="states.h5: not the states of an analysis"):
        read_result(folder)


def test_states_are_few_numbers(drum):
    """Of a drum on its rim: a frame, 100 modes and the points that carry, in less than 2 kB; as
    much as a coarse mesh alone has of displacements in a hundredth of it.
    """
    states = (drum / "states.h5").stat().st_size
    assert states < 2000 * (7 + 2)  # states, and what the file itself and its modes take
    assert DRUM["output"] == {"fields_every_s": 0.04}  # and they were kept without being asked for


def test_the_pressure_below_a_standing_drum_adds_up_to_its_weight(tmp_path):
    """Over the drawn faces, which are a polygon; nodes inside stand for many points."""
    case = {
        "bodies": {
            "drum": {
                "kind": "cylinder",
                "outer_diameter_m": 0.4,
                "height_m": 0.8,
                "element_size_m": 0.05,
                "youngs_modulus_pa": 50e9,
                "poissons_ratio": 0.2,
                "density_kg_m3": 2700.0,
            }
        },
        "joints": {"foot": {"between": ["drum", "ground"]}},
        "contact": {"interior_points": 9},
        "integration": {"dt_s": 1e-3, "duration_s": 0.01, "n_modes": 4},
    }
    result = read_result(analysed(case, tmp_path / "run"))
    faces = result.scene.contacts[0].faces
    pressure, places = result.states.read(0).pressure[faces], result.scene.points[faces][..., :2]
    total, steps = 0.0, (np.arange(20) + 0.5) / 20
    for x, y in itertools.product(steps, steps):  # bilinear, as ParaView draws it
        shares = np.array([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y])
        along = np.array([y - 1, 1 - y, y, -y]), np.array([x - 1, -x, x, 1 - x])
        ways = [np.einsum("q,fqa->fa", one, places) for one in along]
        total += (pressure @ shares) @ np.abs(np.cross(*ways)) / len(steps) ** 2
    model = structure_model(case_from_tables(case, "drum")).parts[0].model
    assert total == pytest.approx(model.mass * 9.80665, rel=1e-3)


@pytest.mark.parametrize("interval, names", [(1e-3, "000000001000"), (1e-8, "00000000000001")])
def test_frames_of_short_steps_have_names_of_their_own(interval, names, tmp_path):
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
    mesh = SimpleNamespace(points=corners, cells=np.arange(8)[None])
    drawn = SimpleNamespace(meshes=[mesh], of_cells={}, comm=SimpleNamespace(rank=0))
    writer = FieldWriter(tmp_path / "fields", drawn, interval)
    for step in range(3):
        writer.add(step * interval, {"displacement": np.zeros((8, 3))})
    found = sorted(file.name for file in (tmp_path / "fields").glob("frame_*.h5"))
    assert len(found) == 3 and found[1] == f"frame_{names}.h5"
