"""Pictures of structures of many bodies: movies, stills, files for ParaView; and what is
refused.
"""

import shutil

import h5py
import numpy as np
import pytest

from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.draw import render
from fecolumn.pictures.render.frames import Frames
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.pictures.render.result import read_result

SMALL = dict(size=(360, 240), fps=10.0)


def _pictures(file):
    import av

    with av.open(str(file)) as container:
        return [
            frame.to_ndarray(format="rgb24").astype(float) for frame in container.decode(video=0)
        ]


def test_movie_of_a_gate_shows_its_motion_and_the_pressure_on_its_joints(gate):
    (file,) = render(
        gate, RenderOptions(only="movie", speed=0.25, exaggerate="auto", **SMALL), quiet=True
    )
    pictures = _pictures(file)
    assert len(pictures) == 5 and pictures[0].shape == (240, 360, 3)
    # the structure, and the joints in plan
    for part in (
        np.s_[20:210, :140],
        np.s_[110:190, 290:],
    ):
        assert (
            np.ptp(pictures[0][part]) > 100
            and np.abs(pictures[0][part] - pictures[-1][part]).mean() > 0.5
        )


def test_the_history_alone_has_every_body_where_its_top_says(gate, tmp_path):
    folder = shutil.copytree(gate, tmp_path / "run", ignore=shutil.ignore_patterns("states.h5"))
    result = read_result(folder)
    frames = Frames(result, np.array([0.03, 0.05, 0.077]), 0.01)
    assert not frames.from_fields and frames.colour == "displacement"
    for frame in frames:
        row = np.searchsorted(result.time, frame.time - 1e-9)
        for k, piece in enumerate(result.scene.bodies):
            top = piece.points[:, 2] > piece.points[:, 2].max() - 1e-9
            moved = frame.points[result.scene.own(k)][top] - piece.upright[top]
            assert moved.mean(axis=0) == pytest.approx(
                result.history[f"mark/{piece.name}.top/displacement"][row], abs=1e-5
            )
            assert np.abs(moved).max() > 1e-3
    assert render(folder, RenderOptions(only="movie", **SMALL), quiet=True)


def test_stills_and_sequence_of_a_building_without_stress(building):
    files = render(
        building, RenderOptions(only="pictures", instants=(0.06,), view="iso"), quiet=True
    )
    assert {file.name for file in files} == {"sequence.pdf", "sequence.png", "still_0.060s.png"}
    frames = Frames(read_result(building), np.array([0.06]), 0.04)
    assert frames.colour == "displacement" and frames.frame(0).struts.shape == (8, 2, 3)
    with pytest.raises(InputError, match="--colour = 'stress': no body of this structure deforms"):
        render(building, RenderOptions(only="pictures", color="stress"), quiet=True)


def test_exaggeration_leaves_the_slab_of_a_building_where_it_is(building):
    result = read_result(building)
    true, drawn = (
        Frames(result, np.array([0.06]), 0.04, factor).frame(0).points for factor in (1.0, 50.0)
    )
    slab = len(true) - 16
    assert (
        np.array_equal(true[:slab], drawn[:slab])
        and np.abs(drawn[slab:] - true[slab:]).max() > 0.02
    )


def test_paraview_opens_a_structure_as_a_time_series(gate, building):
    import pyvista

    for folder, cells in ((gate, 3), (building, 1)):
        (script,) = render(folder, RenderOptions(paraview=True), quiet=True)
        reader = pyvista.get_reader(str(script.parent / "fields" / "fields.xdmf"))
        assert reader.time_values == pytest.approx(np.arange(0, 0.11, 0.02))
        reader.set_active_time_value(reader.time_values[-1])
        grid = reader.read()
        assert (
            len(np.unique(grid.cell_data["body"])) == cells
            and np.isfinite(grid.cell_data["von Mises stress [Pa]"]).all()
        )
        assert (
            grid.point_data["contact pressure [Pa]"].max() > 1e3
            and np.linalg.norm(grid.point_data["displacement [m]"], axis=1).max() > 1e-3
        )


def test_fields_that_an_analysis_wrote_are_drawn_as_its_states_are(gate, tmp_path):
    """As the full-order engine writes them: here from the states, so that both must show the
    same.
    """
    render(gate, RenderOptions(paraview=True), quiet=True)
    folder = shutil.copytree(
        gate, tmp_path / "run", ignore=shutil.ignore_patterns("render", "states.h5")
    )
    shutil.copytree(gate / "render" / "fields", folder / "fields")
    states, fields = read_result(gate), read_result(folder)
    assert fields.fields.time == pytest.approx(states.states.time)
    one, other = (Frames(result, np.array([0.02, 0.06]), 0.04) for result in (states, fields))
    for k in range(2):
        assert np.abs(one.frame(k).points - other.frame(k).points).max() < 1e-6
        assert other.frame(k).colour == pytest.approx(one.frame(k).colour, rel=1e-4, abs=1.0)
        assert np.nan_to_num(other.frame(k).centres) == pytest.approx(
            np.nan_to_num(one.frame(k).centres), abs=0.02
        )


def test_the_top_of_a_body_that_is_named_is_followed(gate):
    result = read_result(gate, "column 2")
    assert result.top_title == "top of column 2" and np.array_equal(
        result.u_top, result.history["mark/column 2.top/displacement"]
    )
    low, high = (
        result.shown("foot", result.time).min(axis=0),
        result.shown("foot", result.time).max(axis=0),
    )
    assert low[0] > 0 and high[2] < 0.5  # the foot of column 2 alone


@pytest.mark.parametrize(
    "options, told",
    [
        (
            ["--body", "colum 2"],
            "--body = 'colum 2': no such body; did you mean column 2?; there are "
            "column 1, column 2, lintel",
        ),
        (["--start", "0.05", "--end", "3"], "--end = 3.0: must lie between 0 and 0.1 s"),
        (["--exaggerate", "0"], "--exaggerate = 0.0: must be auto"),
    ],
)
def test_what_cannot_be_drawn_of_a_structure_is_one_line(gate, capsys, options, told):
    assert main(["render", str(gate), *options]) == 2
    error = capsys.readouterr().err
    assert told in error and error.count("\n") == 1


def test_a_body_that_a_single_column_has_not_is_refused(block):
    with pytest.raises(InputError, match="--body = 'block': no such body; there are column"):
        read_result(block, "block")


def test_folders_without_states_or_with_others_say_what_to_do(gate, tmp_path):
    copy = shutil.copytree(gate, tmp_path / "run", ignore=shutil.ignore_patterns("render"))
    with h5py.File(copy / "states.h5", "r+") as file:
        file["signature"][0, 0] *= -1
    with pytest.raises(InputError, match='is of other modes of "column 1"'):
        render(copy, RenderOptions(only="pictures", instants=(0.0,)), quiet=True)
    with h5py.File(copy / "states.h5", "r+") as file:
        file.attrs["bodies"] = ["column 1", "column 2", "beam"]
    with pytest.raises(
        InputError,
        match="has the states of column 1, column 2, beam, not of column 1, column 2, lintel",
    ):
        read_result(copy)
    (copy / "states.h5").write_bytes(b"no hdf5")
    with pytest.raises(InputError, match="states.h5: not the states of an analysis"):
        read_result(copy)
    (copy / "states.h5").unlink()
    with h5py.File(copy / "history.h5", "r+") as file:  # as earlier versions wrote it
        for name in ("column 1", "column 2", "lintel"):
            del file[f"body/{name}/rotation"]
    with pytest.raises(InputError, match="of a version before 0.7; run the case into a new folder"):
        read_result(copy)
    (copy / "summary.json").unlink()
    with pytest.raises(InputError, match="has not ended .*fecolumn resume"):
        read_result(copy)
