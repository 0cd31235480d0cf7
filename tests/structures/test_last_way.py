"""A step that does not converge in its smallest parts."""

import pytest

from benchmarks.fragility.motions import drawn_motion
from benchmarks.fragility.structures import case_of
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import write_ensemble
from fecolumn.simulation import run


@pytest.mark.slow
def test_drums_that_fall_over_one_anothers_edges_fall_on(tmp_path):
    """The rim of the lowest one spins below them, so fast that no part of a step converges."""
    motion, _ = drawn_motion(149)
    write_ensemble(Ensemble("one", (motion,), {}, {}), tmp_path / "motions.h5")
    tables = dict(
        motion=dict(
            source=f"{tmp_path / 'motions.h5'}#1", free_vibration_s="rest", rest_ceiling_s=2.0
        ),
        integration=dict(dt_s=2e-3, duration_s=0.0),
        output=dict(history_every_s=0.05, states_every_s=0.0),
    )
    summary = run(case_of("4 drums", tables), tmp_path / "run", quiet=True)
    assert summary["outcome"] == "overturned"
    assert summary["energy_closure_rel"] < 1e-10
