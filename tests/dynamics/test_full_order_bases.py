"""Bases in the full-order engine: as the rigid engine has them, and the edge of a plate."""

import numpy as np
import pytest
from small_block import block, centre, trial

from fecolumn import simulation
from fecolumn.case.case import case_from_tables
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.verification.models import column_case, column_system
from fecolumn.verification.reduced_trial import begin_trial

# a stout steel tube, two bricks through the wall and 12 around
STOUT = dict(
    column={"outer_diameter_m": 0.2, "wall_m": 0.04, "height_m": 0.2, "fine_height_m": 0.0},
    cap=False,
    mesh={"fine_size_m": 0.04, "coarse_size_m": 0.04, "base_size_m": 0.05},
)


def test_both_engines_stand_slide_and_lift_alike_on_a_pad():
    system = column_system(
        "corotated",
        **STOUT,
        base={"kind": "pad", "stiffness_n_m3": 5e7, "damping_ratio": 0.1},
        integration={"dt_s": 1e-3},
    )
    ends = []
    for engine in ("corotated", "rigid"):
        one = begin_trial(engine, system)
        for k in range(1, 41):
            one.step([9.0 * np.sin(60e-3 * k), 4.0 * np.sin(45e-3 * k), 0.0])
        ends.append((one.top(), one.state.contact["indentation"], one.energy()))
    (top, sunk, energy), (rigid_top, rigid_sunk, rigid_energy) = ends
    assert np.linalg.norm(top) > 1e-3 and np.ptp(sunk[:, 2]) > 1e-5
    np.testing.assert_allclose(top, rigid_top, atol=2e-3 * np.linalg.norm(top))
    np.testing.assert_allclose(sunk, rigid_sunk, atol=5e-3 * np.abs(sunk).max())
    assert energy["damping"] < 0 and energy["damping"] == pytest.approx(
        rigid_energy["damping"], rel=1e-2
    )
    assert abs(energy["closure"]) < 1e-6 * energy["kinetic"] and energy["impact"] == 0


def test_weight_sinks_as_much_into_a_flat_without_edges_as_into_a_wide_plate():
    sunk = []
    for base in (
        {"length_m": 0.6, "width_m": 0.6, "slide_allowance_m": 0.1, "thickness_m": 0.05},
        {"kind": "unbounded", "thickness_m": 0.05},
    ):
        state = begin_trial("corotated", column_system("corotated", **STOUT, base=base)).state
        sunk.append(state.static)
    assert sunk[1] == pytest.approx(sunk[0], rel=1e-3)


@pytest.mark.parametrize("engine", ["corotated", "rigid"])
def test_foot_that_reaches_the_edge_of_its_plate_ends_the_analysis_as_slid_off(engine, tmp_path):
    case = column_case(
        engine,
        **STOUT,
        base={"length_m": 0.22, "width_m": 0.3, "slide_allowance_m": 0.0, "thickness_m": 0.05},
        initial={"velocity_m_s": [-2.0, 0.0, 0.0]},
        contact={"friction_coefficient": 0.05},
        integration={"duration_s": 0.1, "dt_s": 1e-3},
    )
    summary = simulation.run(case_from_tables(case.tables(), "test"), tmp_path / "out", quiet=True)
    assert summary["outcome"] == "slid off" and summary["slid_off"] and not summary["overturned"]
    assert summary["slid_off_time_s"] == pytest.approx(0.005, abs=1.5e-3)  # 10 mm at 2 m/s
    assert abs(summary["slid_off_direction_deg"]) == pytest.approx(180.0, abs=1e-2)
    assert (
        summary["residual_slide_m"] == pytest.approx(0.01, abs=2.5e-3)
        and (tmp_path / "out" / "summary.json").is_file()
    )


@pytest.mark.parametrize("engine", ["corotated", "rigid"])
def test_foot_that_passes_the_edge_within_one_long_step_has_slid_off(engine, tmp_path):
    """25 mm a step, towards an edge 40 mm away: after the first it is still 15 mm inside."""
    case = column_case(
        engine,
        **STOUT,
        base={"length_m": 0.28, "width_m": 0.3, "slide_allowance_m": 0.0, "thickness_m": 0.05},
        initial={"velocity_m_s": [-2.0, 0.0, 0.0]},
        contact={"friction_coefficient": 0.05},
        integration={"duration_s": 0.1, "dt_s": 12.5e-3},
    )
    summary = simulation.run(case_from_tables(case.tables(), "test"), tmp_path / "out", quiet=True)
    assert summary["outcome"] == "slid off" and summary["slid_off_time_s"] == pytest.approx(0.0125)


@pytest.mark.parametrize("engine", ["corotated", "rigid"])
def test_block_as_wide_as_its_plate_stands_on_it(engine):
    """Corner over corner: rounding, and what the block spreads under its weight, are no way off the
    plate.
    """
    one = trial(engine, block(0.3, 0.9, plate=(0.15, 0.15)), standing)
    for _ in range(5):
        state = one.step()
    assert state.forces[:, 2].sum() == pytest.approx(one.system.weight, rel=1e-6) and centre(one)[
        2
    ] == pytest.approx(0.45, abs=1e-6)
