"""Names, forms of call and refusals of what a script reads: results, figures, motions."""

import shutil

import numpy as np
import pytest

import fecolumn
from fecolumn.engines.dynamics.history import History
from fecolumn.foundation.deprecated import warn_of_older_name
from fecolumn.study.results.parting import QuantityPair

TIME = np.linspace(0, 1, 11)


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    """A finished analysis of the classic block, and its folder."""
    case = fecolumn.Case.of_model(
        fecolumn.BlockModel(width_m=0.3, height_m=1.5),
        initial=fecolumn.Initial(tilt_rad=0.05),
        integration=fecolumn.Integration(dt_s=0.01, duration_s=0.5),
    )
    folder = tmp_path_factory.mktemp("names") / "block"
    fecolumn.run(case, folder, quiet=True)
    return fecolumn.load(folder)


@pytest.fixture
def glued(tmp_path):
    """An analysis whose history has two joints, one of them glued at two places."""
    rows = {"time": TIME}
    for place in ("foot: vase 1 on shelf", "foot: vase 2 on shelf"):
        rows |= {f"bond/{place}/{name}": TIME for name in ("stress", "shear_stress", "failed")}
    for place in ("foot: vase 1 on shelf", "base: shelf on ground"):
        rows |= {f"interface/{place}/{name}": TIME for name in ("tilt", "rise", "force")}
        rows[f"interface/{place}/slide"] = np.outer(TIME, [1, 2])
    History(rows).write(tmp_path / "history.h5", {"case_id": "x"})
    return fecolumn.AnalysisResult(tmp_path)


@pytest.mark.long
def test_joints_are_drawn_by_their_name_in_the_case(glued):
    assert glued.plot.joints("foot").png.startswith(b"\x89PNG")
    warn_of_older_name.cache_clear()
    with pytest.warns(DeprecationWarning, match="write plot.joints"):
        assert glued.plot.interfaces().png.startswith(b"\x89PNG")


def test_glued_joints_are_drawn_by_joint_or_place(glued):
    whole, one = glued.plot.bonds("foot"), glued.plot.bonds("foot: vase 2 on shelf")
    assert len(whole.axes) == len(glued.plot.bonds().axes) == 4 and len(one.axes) == 2


@pytest.mark.parametrize(
    "draw, words",
    [
        (
            lambda plot: plot.joints("foots"),
            "no joint 'foots'; did you mean foot.*known: base, foot",
        ),
        (lambda plot: plot.bonds("base"), "no glued joint 'base'.*known: foot"),
        (lambda plot: plot.links("wire"), "this analysis has no link"),
        (lambda plot: plot.links(), "this analysis has no link"),
    ],
)
def test_a_name_that_is_not_there_is_refused_with_those_that_are(glued, draw, words):
    for kind in (fecolumn.InputError, KeyError):
        with pytest.raises(kind, match=words) as caught:
            draw(glued.plot)
        assert str(caught.value).startswith(str(glued.folder))


def test_a_history_is_read_or_refused(block, tmp_path):
    path = block.folder / "history.h5"
    assert list(fecolumn.read_history(str(path), names=["time", "tilt"])) == ["time", "tilt"]
    for kind in (fecolumn.InputError, KeyError):
        with pytest.raises(kind, match="history.h5: tilts: is no column of it; did you mean tilt"):
            fecolumn.read_history(path, names=("tilts",))
    (tmp_path / "text.h5").write_text("no HDF5")
    for kind in (fecolumn.InputError, OSError):
        with pytest.raises(kind, match="none.h5: no such file"):
            fecolumn.read_history(tmp_path / "none.h5")
        with pytest.raises(kind, match="text.h5: not a file of HDF5"):
            fecolumn.read_history(tmp_path / "text.h5")
    with pytest.raises(fecolumn.InputError, match="read_history: path = 3"):
        fecolumn.read_history(3)


def test_the_summary_is_there_when_the_analysis_has_ended(block, tmp_path):
    result = fecolumn.AnalysisResult(tmp_path / "later")
    assert not result.finished and result.summary == {}
    shutil.copytree(block.folder, tmp_path / "later")
    assert result.finished and result.summary == block.summary


def test_options_of_a_picture_are_arguments(block):
    with pytest.raises(TypeError, match=r"render\(\) got an unexpected keyword argument 'colours'"):
        block.render(colours="none")
    warn_of_older_name.cache_clear()
    refused = pytest.raises(fecolumn.InputError, match="must lie between 0.001 and 100")
    with refused, pytest.warns(DeprecationWarning, match="color of render .* write colour"):
        block.render(color="none", speed=0.0, quiet=True)


def test_a_case_is_read_from_a_path():
    with pytest.raises(fecolumn.InputError, match="load_case: path = 3: must be the path"):
        fecolumn.load_case(3)


def test_a_motion_is_loaded_by_its_source_alone():
    ground = fecolumn.load_motion("lick:1", 0.01)
    same = fecolumn.load_motion(fecolumn.Motion("lick:1"), 0.01, "case.toml")
    np.testing.assert_array_equal(ground.acceleration_m_s2, same.acceleration)
    assert (ground.dt_s, ground.duration_s) == (same.dt, same.duration)
    assert ground.acceleration_m_s2.shape[1] == 3
    np.testing.assert_array_equal(ground.peak_m_s2, abs(same.acceleration).max(axis=0))
    with pytest.warns(DeprecationWarning, match="dt of load_motion .* write dt_s"):
        assert fecolumn.load_motion("lick:1", dt=0.01).dt_s == 0.01
    with pytest.raises(fecolumn.InputError, match="motion = 3: must be a Motion"):
        fecolumn.load_motion(3, 0.01)
    with pytest.warns(fecolumn.AliasingWarning):
        fecolumn.load_motion("lick:1", 0.2)


def test_a_pair_says_when_it_parts():
    pair = QuantityPair.of(TIME, 0 * TIME, 0.25, time=TIME)
    assert pair.parted == 3 and pair.parted_s == TIME[3]
    assert QuantityPair.of(TIME, TIME, 0.25, time=TIME).parted_s is None


def test_the_band_of_a_distribution_has_the_names_of_tables():
    one = fecolumn.ecdf([0.1, 0.2, 0.3], [False] * 3, confidence=0.9)
    assert one.low is one.lower and one.high is one.upper


@pytest.mark.parametrize(
    "older, newer",
    [
        (
            lambda: fecolumn.ecdf([0.1, 0.2], [0, 0], 0.9).low.tolist(),
            lambda: fecolumn.ecdf([0.1, 0.2], [0, 0], confidence=0.9).low.tolist(),
        ),
        (
            lambda: fecolumn.proportion_interval(1, 9, 0.9, "exact"),
            lambda: fecolumn.proportion_interval(1, 9, confidence=0.9, method="exact"),
        ),
    ],
)
def test_numbers_by_position_are_taken_as_in_earlier_versions(older, newer):
    with pytest.warns(DeprecationWarning, match="by position until 2.0"):
        assert older() == newer()
