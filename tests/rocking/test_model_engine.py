"""integration.engine = "housner": the block of a case's column in runs and studies, like any
engine.
"""

import json
import math

import h5py
import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.engines.rocking.impact import body_restitution
from fecolumn.engines.rocking.of_bodies import model_of
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge
from fecolumn.simulation import run
from fecolumn.study.plan import read_plan

MARBLE = {
    "column": {"shape": "block", "length_m": 0.4, "width_m": 0.5, "height_m": 1.2},
    "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700.0},
    "contact": {"friction_coefficient": 0.8},
}
DRUM = {
    "column": {"shape": "solid", "outer_diameter_m": 0.5, "height_m": 1.6},
    "material": {"density_kg_m3": 2700.0},
}
TEST_TUBE = {
    "column": {"outer_diameter_m": 0.02, "wall_m": 0.0015, "height_m": 0.15},
    "material": {"youngs_modulus_pa": 70e9, "density_kg_m3": 2500.0},
}
CAPPED = {
    "column": {"outer_diameter_m": 0.0761, "wall_m": 0.005, "height_m": 1.5},
    "cap": {"length_m": 0.15, "width_m": 0.15, "thickness_m": 0.01},
}


def case(tables, **more):
    return case_from_tables(
        merge(merge(tables, {"integration": {"engine": "housner"}}), more), "case.toml"
    )


@pytest.mark.parametrize(
    "tables, half", [(MARBLE, (0.2, 0.25)), (DRUM, (0.25, 0.25)), (TEST_TUBE, (0.01, 0.01))]
)
def test_block_of_a_column_has_its_slenderness_and_its_inertia_about_the_rim(tables, half):
    column = case(tables).short.column
    block, h = model_of(case(tables), "case.toml"), tables["column"]["height_m"] / 2
    for plane, b in zip(block.planes, half):
        if column.shape == "block":
            central = ((2 * b) ** 2 + (2 * h) ** 2) / 12
        else:
            inner = 0.0 if column.shape == "solid" else column.outer_diameter_m / 2 - column.wall_m
            central = (3 * (b**2 + inner**2) + (2 * h) ** 2) / 12
        assert plane.alpha == pytest.approx((math.atan2(b, h),) * 2)
        assert plane.p2[0] == pytest.approx(GRAVITY * math.hypot(b, h) / (central + b * b + h * h))
        assert plane.restitution[0] == pytest.approx(
            body_restitution(1.0, central, (-b, h), (b, h))
        )
        assert plane.uplift() == pytest.approx(b / h)


def test_cap_raises_the_centre_and_the_top():
    plane = model_of(case(CAPPED), "").planes[0]
    tube, cap = math.pi * (0.03805**2 - 0.03305**2) * 1.5, 0.15 * 0.15 * 0.01
    assert plane.mass == pytest.approx(7850 * (tube + cap))
    assert plane.height == pytest.approx(
        (tube * 0.75 + cap * 1.505) / (tube + cap)
    ) and plane.top == pytest.approx(1.51)


@pytest.fixture(scope="module")
def leaning(tmp_path_factory):
    """Summary and folder of a marble block released at a tilt towards 30 degrees from x."""
    folder = tmp_path_factory.mktemp("leaning") / "out"
    return run(
        case(
            MARBLE,
            initial={"tilt_rad": 0.1, "direction_deg": 30.0},
            integration={"duration_s": 3.0, "dt_s": 2e-3},
        ),
        folder,
        quiet=True,
    ), folder


def test_result_folder_is_that_of_any_analysis(leaning):
    summary, folder = leaning
    assert (
        summary["engine"] == "housner"
        and summary["outcome"] == "at rest"
        and not summary["overturned"]
    )
    assert (
        summary == json.loads((folder / "summary.json").read_text())
        and not (folder / "checkpoint.npz").exists()
    )
    with h5py.File(folder / "history.h5") as history:
        assert len(history["time"]) == 1501 and history["model/theta_x"].attrs["unit"] == "rad"
        assert {f"energy/{term}" for term in TERMS} <= {
            f"energy/{name}" for name in history["energy"]
        }
        assert history["model/theta_x"][0] == pytest.approx(
            0.1 * math.cos(math.radians(30))
        ) and history["model/theta_y"][0] == pytest.approx(0.05)
        assert np.hypot(*history["u_top"][:, :2].T).max() == pytest.approx(summary["u_max_m"])
    assert summary["energy_closure_rel"] < 1e-6 and summary["cpu_s"] < 5


def test_analysis_is_there_already_when_asked_again(leaning):
    summary, folder = leaning
    again = run(
        case(
            MARBLE,
            initial={"tilt_rad": 0.1, "direction_deg": 30.0},
            integration={"duration_s": 3.0, "dt_s": 2e-3},
        ),
        folder,
        quiet=True,
    )
    assert again == summary


def pulse_file(folder, amplitude_g, period=0.8, dt=0.005):
    time = np.arange(0, period + dt, dt)
    path = folder / f"pulse{amplitude_g:g}.csv"
    path.write_text(
        "t,x\n"
        + "\n".join(
            f"{t:.6f},{amplitude_g * math.sin(2 * math.pi * t / period) * (t <= period):.8f}"
            for t in time
        )
    )
    return {"source": str(path), "units": "g"}


def test_overturning_ends_at_the_point_of_no_return_with_its_time(tmp_path):
    summary = run(case(MARBLE, motion=pulse_file(tmp_path, 2.0)), tmp_path / "out", quiet=True)
    assert (
        summary["overturned"]
        and summary["u_max_censored"]
        and "point of no return" in summary["ended_by"]
    )
    with h5py.File(tmp_path / "out" / "history.h5") as history:
        assert history["tilt"][-2] <= summary["critical_tilt_rad"] < history["tilt"][-1]
        assert history["time"][-1] == summary["overturned_at_s"] == summary["overturn_time_s"]


def test_cap_on_the_displacement_stops_earlier(tmp_path):
    summary = run(
        case(MARBLE, motion=pulse_file(tmp_path, 2.0), overturn={"displacement_m": 0.1}),
        tmp_path / "out",
        quiet=True,
    )
    assert (
        summary["overturned"]
        and "overturn.displacement_m" in summary["ended_by"]
        and 0.1 <= summary["u_max_m"] < 0.12
    )


def test_rest_ends_the_analysis_after_the_motion(tmp_path):
    motion = pulse_file(tmp_path, 0.6, period=0.3) | {"free_vibration_s": "rest"}
    summary = run(case(MARBLE, motion=motion), tmp_path / "out", quiet=True)
    assert summary["outcome"] == "at rest" and "after the motion's end" in summary["ended_by"]
    assert summary["energy_left_j"] <= 1e-3 * summary["energy_to_overturn_j"]
    assert 0.3 < summary["duration_s"] < 20


def test_friction_that_does_not_suffice_is_told_and_recorded(tmp_path):
    with pytest.warns(UserWarning, match="there is 0.31: it would slide"):
        summary = run(
            case(
                MARBLE,
                motion=pulse_file(tmp_path, 0.9, 0.4),
                contact={"friction_coefficient": 0.31},
            ),
            tmp_path / "out",
            quiet=True,
        )
    assert summary["notes"] and summary["peaks"]["friction_demanded_x"] > 0.31


@pytest.mark.parametrize(
    "more, said",
    [
        (
            {"contact": {"restitution": 0.5}},
            "contact.restitution = 0.5: must be 0 where integration.engine = 'housner'",
        ),
        ({"output": {"fields_every_s": 0.1}}, "output.fields_every_s = 0.1: must be 0"),
        ({"initial": {"spin_rad_s": [0.0, 1.0, 0.0]}}, "it starts from initial.tilt_rad"),
        (
            {"base": {"kind": "pad", "stiffness_n_m3": 1e9}},
            "base.kind = 'pad': must be plate or unbounded",
        ),
    ],
)
def test_keys_that_a_rigid_model_knows_nothing_of_are_refused(more, said):
    with pytest.raises(InputError) as told:
        case(MARBLE, **more)
    assert said in str(told.value)


def test_studies_take_it_beside_other_engines(tmp_path):
    pulse = pulse_file(tmp_path, 1.0)
    (tmp_path / "study.toml").write_text(f"""
[case]
column = {{shape = "solid", outer_diameter_m = 0.5, height_m = 1.6}}
motion.units = "g"
[axes]
"integration.engine" = ["rigid", "housner"]
"motion.source" = ["{pulse["source"]}"]
""")
    plan = read_plan(tmp_path / "study.toml")
    assert [one.case.integration.engine for one in plan.analyses] == ["rigid", "housner"]
    assert plan.analyses[1].effort < plan.analyses[0].effort


def test_a_rigid_model_of_a_column_passes_over_the_damping_of_elastic_modes():
    damped = case(MARBLE, material={"damping_ratio": 0.05})
    found, exact = (model_of(one, "case.toml").describe() for one in (damped, case(MARBLE)))
    assert found == exact
