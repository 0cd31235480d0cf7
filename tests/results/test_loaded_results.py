"""Results as Python objects: what a script or a notebook sees of an analysis and of a study."""

import math
import shutil
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

import fecolumn
from fecolumn import InputError
from fecolumn.study.results.analysis import AnalysisResult

sys.path.insert(0, str(Path(__file__).parents[1] / "report"))
from synthetic_study import ALPHA, write_synthetic  # noqa: E402

DRUM = {
    "title": "Drum",
    "column": {"shape": "solid", "outer_diameter_m": 0.5, "height_m": 1.6},
    "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700.0},
    "initial": {"tilt_rad": 0.02},
    "integration": {"engine": "rigid", "duration_s": 0.1},
}


@pytest.fixture(scope="module")
def drum():
    return fecolumn.case_from_tables(DRUM, "drum")


@pytest.fixture(scope="module")
def analysis(drum, tmp_path_factory):
    folder = tmp_path_factory.mktemp("results") / "drum"
    fecolumn.run(drum, folder, quiet=True)
    return fecolumn.load(folder)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    return fecolumn.load(
        write_synthetic(tmp_path_factory.mktemp("study"), {ALPHA: [0.0, -0.2]}, 6, unfinished=(3,))
    )


def test_replaced_case_is_the_one_a_file_would_give(drum):
    thinner = {
        **DRUM,
        "column": {**DRUM["column"], "outer_diameter_m": 0.4},
        "contact": {"friction_coefficient": 0.5},
    }
    wanted = fecolumn.case_from_tables(thinner, "drum")
    assert (
        drum.replace({"column.outer_diameter_m": 0.4, "contact.friction_coefficient": 0.5})
        == wanted
    )
    assert (
        drum.replace(column={"outer_diameter_m": 0.4}, contact={"friction_coefficient": 0.5}).bodies
        == wanted.bodies
        != drum.bodies
    )
    assert drum.replace() == drum


def test_size_that_a_case_states_stays_in_another_column(drum):
    own = fecolumn.case_from_tables({**DRUM, "mesh": {"fine_size_m": 0.06}}, "drum")
    assert own.replace({"column.outer_diameter_m": 0.4}).short.mesh.fine_size_m == 0.06


@pytest.mark.parametrize(
    "change, key",
    [
        ({"contact.friction_coefficient": -1}, "contact.friction_coefficient"),
        ({"contact.friction": 1}, "contact.friction"),
    ],
)
def test_replacing_with_what_no_file_may_say_is_refused(drum, change, key):
    with pytest.raises(InputError) as caught:
        drum.replace(change)
    assert caught.value.key == key


def test_history_has_arrays_with_units(analysis):
    steps = len(analysis.time)
    assert (
        analysis["u_top"].shape == (steps, 3)
        and analysis.units["u_top"] == "m"
        and analysis.units["energy/kinetic"] == "J"
    )
    assert analysis.time[-1] == pytest.approx(0.1)
    assert analysis["tilt"][0] == pytest.approx(0.02, rel=1e-2)
    assert abs(analysis.energy["closure"]).max() < 1e-9
    with pytest.raises(KeyError, match="'speed' is not in the history; it has"):
        analysis["speed"]


def test_energy_of_a_history_of_an_earlier_version_has_the_terms_that_it_lacks(analysis, tmp_path):
    import h5py

    shutil.copytree(analysis.folder, tmp_path / "old")
    with h5py.File(tmp_path / "old" / "history.h5", "a") as file:
        del file["energy/links"]
    old = AnalysisResult(tmp_path / "old")
    assert (
        list(old.energy) == list(analysis.energy)
        and not old.energy["links"].any()
        and old.energy["links"].shape == old.time.shape
    )
    np.testing.assert_array_equal(old.energy["kinetic"], analysis.energy["kinetic"])
    assert (
        old.plot.energy()._repr_png_().startswith(b"\x89PNG")
        and not old.compare(analysis).energy["links"].difference.any()
    )


def test_columns_are_named_with_component_and_unit(analysis):
    columns = analysis.columns()
    np.testing.assert_array_equal(columns["u_top_z [m]"], analysis["u_top"][:, 2])
    np.testing.assert_array_equal(columns["slide_y [m]"], analysis["slide"][:, 1])
    assert all(column.shape == analysis.time.shape for column in columns.values())


def test_analysis_knows_its_case_and_how_it_ended(analysis, drum):
    assert analysis.case.id == drum.id and analysis.finished
    assert "still rocking" in repr(analysis)
    page = analysis._repr_html_()
    assert "<caption>Drum</caption>" in page and "still rocking" in page


@pytest.mark.long
@pytest.mark.parametrize("name", ["top", "path", "energy"])
def test_figures_are_pictures_that_can_be_saved(analysis, name, tmp_path):
    picture = getattr(analysis.plot, name)()
    assert picture._repr_png_().startswith(b"\x89PNG")
    files = picture.save(tmp_path / "figures" / "drum.png")
    assert sorted(file.name for file in files) == ["drum.pdf", "drum.png"]
    assert (tmp_path / "figures" / "drum.png").read_bytes() == picture.png


def test_frames_hold_the_history(analysis):
    frame = analysis.to_pandas()
    np.testing.assert_array_equal(frame["tilt [rad]"], analysis["tilt"])
    data = analysis.data
    assert data["u_top"].attrs["units"] == "m" and data["tilt"].dims == ("time",)
    np.testing.assert_array_equal(data["u_top"].sel(axis="x"), analysis["u_top"][:, 0])
    assert data.attrs["case_id"] == analysis.case.id


@pytest.mark.long
def test_axes_of_a_figure_may_be_changed_before_it_is_saved(analysis, tmp_path):
    picture = analysis.plot.energy()
    before = picture.png
    picture.axes[0].set_title("first test")
    assert picture.png != before
    picture.save(tmp_path / "energy")
    assert (tmp_path / "energy.png").read_bytes() == picture.png


@pytest.mark.long
def test_analysis_can_be_rendered(analysis):
    files = analysis.render(only="pictures", instants=(0.05,))
    assert {"sequence.png", "sequence.pdf"} <= {file.name for file in files} and all(
        file.stat().st_size > 1000 for file in files
    )


def test_folder_of_nothing_is_refused(tmp_path):
    with pytest.raises(InputError, match="neither an analysis"):
        fecolumn.load(tmp_path)
    with pytest.raises(InputError, match="no such folder"):
        fecolumn.load(tmp_path / "none")


def test_analysis_without_history_says_so(tmp_path):
    (tmp_path / "case.json").write_text("{}")
    with pytest.raises(InputError, match="not written yet"):
        _ = fecolumn.load(tmp_path).time


def test_study_gives_rows_distributions_and_figure(study):
    assert study.done == 11 and len(study.rows) == 12 and study.axes[ALPHA] == [0.0, -0.2]
    with pytest.warns(UserWarning, match=f"one distribution of all values of {ALPHA}"):
        whole = study.ecdf()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        one = study.ecdf({ALPHA: -0.2})
    assert whole.n == 11 and one.n in (5, 6)
    assert study.plot.cdf().png.startswith(b"\x89PNG")
    assert "11 of 12 analyses done" in study._repr_html_()


def test_peak_of_what_was_lost_is_no_number(study):
    columns = study.columns()
    lost = np.array(columns["lost"])
    assert lost.any() and np.isnan(np.array(columns["u_max_m"])[lost]).all()
    standing = ~lost & (np.array(columns["state"]) == "done")
    assert np.isfinite(np.array(columns["u_max_m"])[standing]).all()


def test_axis_or_value_that_a_study_does_not_have_is_refused(study):
    with pytest.raises(InputError, match="is no axis"):
        study.ecdf({"contact.mu": 1})
    with pytest.raises(InputError, match="is no value"):
        study.ecdf({ALPHA: -0.1})


def test_array_is_a_motion(drum, tmp_path):
    time = np.arange(0, 1, 0.01)
    source = fecolumn.motion_file(
        tmp_path / "sine.csv", np.column_stack([np.sin(9 * time), np.cos(9 * time)]), 0.01
    )
    case = drum.replace({"initial": None, "integration.duration_s": 0.0, "motion.source": source})
    motion = fecolumn.load_motion(case.motion, 0.01, "case")
    np.testing.assert_allclose(
        motion.acceleration[: len(time), :2],
        np.column_stack([np.sin(9 * time), np.cos(9 * time)]),
        atol=1e-12,
    )


@pytest.mark.parametrize(
    "acceleration",
    [
        np.zeros(1),
        np.zeros((5, 4)),
        np.array([0.0, np.nan, 1.0]),
        [[0.0, 1.0], [2.0]],
        ["a", "b"],
        [None, {}],
    ],
)
def test_array_that_is_no_motion_is_refused(acceleration, tmp_path):
    with pytest.raises(InputError, match="acceleration"):
        fecolumn.motion_file(tmp_path / "a.csv", acceleration, 0.01)


@pytest.mark.parametrize("dt_s", [-1, 0, math.nan, 100])
def test_step_that_no_motion_has_is_refused(dt_s, tmp_path):
    with pytest.raises(InputError, match=r"dt_s = .*: must lie in \[1e-06, 10\] s"):
        fecolumn.motion_file(tmp_path / "a.csv", np.ones(5), dt_s)


def test_names_of_the_package_exist():
    assert all(hasattr(fecolumn, name) for name in fecolumn.__all__) and set(
        fecolumn.__all__
    ) <= set(dir(fecolumn))
    assert set(fecolumn.__all__) == set(fecolumn._HOMES)
