"""States are kept at even times, through interruptions, and never fill the disk."""

import h5py
import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.engines.reduced import states
from fecolumn.simulation import run

ROCKING = {
    "column": {"shape": "block", "length_m": 0.4, "width_m": 0.4, "height_m": 1.2},
    "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700},
    "mesh": {"fine_size_m": 0.1, "coarse_size_m": 0.2, "base_size_m": 0.2},
    "initial": {"tilt_rad": 0.05},
    "integration": {"engine": "reduced", "duration_s": 0.25},
    "output": {"states_every_s": 0.02, "checkpoint_every_s": 1e5},
}


def _kept(folder) -> dict[str, np.ndarray]:
    with h5py.File(folder / states.STATES_FILE) as file:
        return {name: file[name][()] for name in file}


@pytest.fixture(scope="module")
def rocking(tmp_path_factory):
    folder = tmp_path_factory.mktemp("rocking")
    run(case_from_tables(ROCKING, "case"), folder, quiet=True)
    return folder


def test_states_are_kept_at_their_interval_and_at_the_end(rocking):
    kept = _kept(rocking)
    assert (
        kept["time"] == pytest.approx([*np.arange(0, 0.25, 0.02), 0.25])
        and kept["modal"].shape[0] == 14
        and kept["modal"].shape[-1] == kept["frequencies"].shape[-1]
    )
    assert kept["points"].sum() == len(kept["force"]) and (kept["force"][:, 2] > 0).all()


def test_states_of_an_interrupted_analysis_are_those_of_one_that_was_not(rocking, tmp_path):
    asked = []
    with pytest.raises(KeyboardInterrupt):
        run(
            case_from_tables(ROCKING, "case"),
            tmp_path / "run",
            quiet=True,
            stop=lambda: asked.append(1) or len(asked) > 6,
        )
    assert (tmp_path / "run" / "checkpoint.npz").is_file() and not (
        tmp_path / "run" / states.STATES_FILE
    ).exists()
    run(case_from_tables(ROCKING, "case"), tmp_path / "run", quiet=True)
    whole, parts = _kept(rocking), _kept(tmp_path / "run")
    assert all(np.array_equal(whole[name], parts[name]) for name in whole)


def test_states_that_would_fill_the_disk_are_thinned_out_evenly(rocking, tmp_path, monkeypatch):
    monkeypatch.setattr(states, "_MOST_BYTES", 6000)
    run(case_from_tables(ROCKING, "case"), tmp_path / "run", quiet=True)
    times, whole = _kept(tmp_path / "run")["time"], _kept(rocking)["time"]
    assert 3 < len(times) < len(whole) and times[0] == 0 and times[-1] == whole[-1]
    gaps = np.diff(times[:-1])
    assert gaps == pytest.approx(gaps[0]) and gaps[0] in (pytest.approx(0.04), pytest.approx(0.08))


def test_states_change_nothing_of_the_motion_and_are_not_asked_of_the_case_id(rocking, tmp_path):
    without = case_from_tables(ROCKING | {"output": {"states_every_s": 0.0}}, "case")
    run(without, tmp_path / "run", quiet=True)
    assert (
        not (tmp_path / "run" / states.STATES_FILE).exists()
        and without.id == case_from_tables(ROCKING, "case").id
    )
    with (
        h5py.File(rocking / "history.h5") as one,
        h5py.File(tmp_path / "run" / "history.h5") as other,
    ):
        assert np.array_equal(one["u_top"][()], other["u_top"][()])


def test_an_analysis_of_a_study_keeps_no_states_unless_asked():
    from fecolumn.study.plan import DEFAULTS

    assert DEFAULTS["output"]["states_every_s"] == 0.0
