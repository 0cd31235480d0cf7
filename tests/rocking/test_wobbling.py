"""The wobbling column and frame: derivation, energy, planar limit, passing upright, standing,
tendons, and what a user may state.
"""

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid

from fecolumn.case.case import case_from_tables
from fecolumn.case.model_sections import WobblingFrameModel, WobblingModel
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.block import PlanarBody, RockingBlock, body_plane
from fecolumn.engines.rocking.of_bodies import model_of
from fecolumn.engines.rocking.restraint import Restraint
from fecolumn.engines.rocking.wobbling import Wobbling
from fecolumn.engines.rocking.wobbling_frame import WobblingFrame
from fecolumn.foundation.schema import InputError
from fecolumn.motions.record import GroundMotion
from fecolumn.verification.result import Row
from fecolumn.verification.wobbling_models import SPECIMEN, free, run

COLUMNS = {
    "marble drum": dict(outer_diameter_m=0.5, height_m=1.6, density_kg_m3=2700),
    "steel tube": dict(outer_diameter_m=0.1016, wall_m=0.005, height_m=1.0, density_kg_m3=7850),
    "glass test tube": dict(
        outer_diameter_m=0.02, wall_m=0.0015, height_m=0.15, density_kg_m3=2500
    ),
}


def column(name="marble drum", **keys):
    return Wobbling.of_section(WobblingModel(**COLUMNS[name] | keys), "column.toml")


def shaken(seed, peak, dt=2e-3, steps=3000, vertical=0.0):
    noise = np.random.default_rng(seed).normal(size=(steps, 3))
    smooth = np.column_stack(
        [np.convolve(noise[:, axis], np.hanning(80), "same") for axis in range(3)]
    )
    return GroundMotion(
        smooth / np.abs(smooth).max(axis=0) * [peak, peak, vertical], dt, "noise", ""
    )


def test_the_equations_are_those_that_sympy_derives():
    pytest.importorskip("sympy")
    from benchmarks import wobbling_equations

    found = wobbling_equations.differences()
    assert len(found) == 5 and max(found.values()) < 1e-12


def test_verification_rows_hold():
    assert [row for row in run("models").rows if not row.ok] == []


def test_a_wrong_number_would_not_hold():
    assert not Row("k_crit [kN/m]", 3593.0, 3592.0, 0.5, scale=1.0).ok


@pytest.mark.parametrize("name", COLUMNS)
def test_energy_closes_in_a_motion_of_three_components(name):
    model = column(name)
    found = model.respond(
        shaken(3, 1.6 * GRAVITY * math.tan(model.slenderness), vertical=2.0), free_s=0.5
    )
    assert found.tilt.max() > 1e-3 * model.slenderness
    assert np.abs(found.energy["closure"]).max() < 1e-9 * model.energy_to_overturn


@pytest.mark.parametrize("stiffness", [0.0, 5e4])
def test_in_a_plane_it_is_the_planar_column_without_loss(stiffness):
    """In any direction it is the column of the same mass, inertia, rim and tendon that rocks with
    restitution 1.
    """
    model, angle, start = column("steel tube", tendon_n_m=stiffness), 0.7, 0.04
    motion = shaken(5, 0.8, steps=1000)
    along = motion.acceleration[:, :1] * [math.cos(angle), math.sin(angle), 0.0]
    found = model.respond(GroundMotion(along, motion.dt, "", ""), tilt=start, direction=angle)
    radius, centre, height, mass, _, across, *_ = model.body
    restraint = Restraint(tendons=((stiffness, 0.0, 2 * radius),)) if stiffness else Restraint()
    body = PlanarBody(0, mass, (radius, radius), centre, across, height, (radius, radius))
    plane = body_plane(body, 1.0, restraints=(restraint, restraint))
    exact = RockingBlock((plane,)).respond(motion, tilt=start)
    assert len(exact.impact_times) >= 2
    # later what rounding leaves across the plane grows from swing to swing, and it rolls past
    # upright beside the plane
    rows = exact.time < exact.impact_times[1]
    assert found.tilt[rows] == pytest.approx(exact.tilt[rows], abs=1e-6 * start)
    assert found.impact_times[:2] == pytest.approx(exact.impact_times[:2], rel=1e-6)
    away = found.u_top[rows, 0] * math.sin(angle) - found.u_top[rows, 1] * math.cos(angle)
    assert np.abs(away).max() < 1e-9


def test_a_small_spin_turns_the_plane_and_a_planar_motion_keeps_it():
    frame = WobblingFrame.of_section(WobblingFrameModel(**SPECIMEN), "")
    straight, passages, _ = free(frame, 0.05, 0.0, 5.0)
    assert len(passages) > 3 and np.abs(np.sin(straight[:, 2])).max() < 1e-12
    turned, passages, _ = free(frame, 0.05, 1e-3, 5.0)
    assert len(passages) == 0 and np.abs(np.sin(turned[:, 2]))[-200:].max() > 1e-2


def test_it_stands_below_g_tan_alpha_and_lifts_off_above():
    model = column()
    for share, moves in ((0.99, False), (1.01, True)):
        ramp = (
            np.clip(np.arange(400) / 200, 0, 1)[:, None]
            * np.array([[0.6, 0.8, 0.0]])
            * share
            * GRAVITY
            * math.tan(model.slenderness)
        )
        assert (model.respond(GroundMotion(ramp, 2e-3, "", "")).tilt.max() > 1e-6) == moves


def test_upward_acceleration_of_the_ground_holds_it_down():
    model = column()
    push = np.tile([1.1 * GRAVITY * math.tan(model.slenderness), 0.0, 0.2 * GRAVITY], (200, 1))
    assert model.respond(GroundMotion(push, 2e-3, "", "")).tilt.max() == 0
    assert model.respond(GroundMotion(push * [1, 1, -1], 2e-3, "", "")).tilt.max() > 0


def test_a_column_released_beyond_its_critical_tilt_overturns_and_within_it_not():
    model = column()
    rest = GroundMotion(np.zeros((2000, 3)), 2e-3, "", "")
    found = model.respond(rest, tilt=1.01 * model.critical_tilt, direction=2.0)
    assert found.overturned and found.tilt[-1] >= math.pi / 2
    assert math.atan2(found.u_top[-1, 1], found.u_top[-1, 0]) == pytest.approx(2.0)
    assert not model.respond(rest, tilt=0.99 * model.critical_tilt).overturned


def test_tendons_raise_the_critical_tilt_and_stiff_ones_always_right_the_frame():
    frames = [
        WobblingFrame.of_section(WobblingFrameModel(**SPECIMEN | {"tendon_n_m": stiffness}), "")
        for stiffness in (0.0, 1.72e6, 1e8)
    ]
    tilts = [frame.critical_tilt for frame in frames]
    assert tilts[0] == pytest.approx(0.1359) and tilts[0] < tilts[1] < tilts[2]


def test_pushover_of_the_frame_is_virtual_work_and_slender_at_small_displacement():
    frame = WobblingFrame.of_section(WobblingFrameModel(**SPECIMEN), "")
    u, force = frame.pushover(1e-5)
    assert force == pytest.approx(float(frame.planar.linear_pushover(u)), rel=0.1359**2)
    displacement, force = np.array(
        [frame.pushover(tilt) for tilt in np.linspace(0, frame.critical_tilt, 2001)]
    ).T
    assert trapezoid(force, displacement) == pytest.approx(frame.energy_to_overturn, rel=1e-5)


def test_of_a_case_it_has_mass_and_inertia_of_the_mesh_and_refuses_a_block():
    tables = {
        "column": {"outer_diameter_m": 0.5, "height_m": 1.6, "shape": "solid"},
        "material": {"density_kg_m3": 2700},
        "integration": {"engine": "wobbling"},
    }
    found, stated = model_of(case_from_tables(tables, "drum.toml"), "drum.toml"), column()
    assert found.body[:7] == pytest.approx(stated.body[:7], rel=1e-9)
    tables["column"] = {"length_m": 0.4, "width_m": 0.4, "height_m": 1.2, "shape": "block"}
    with pytest.raises(InputError, match="block.toml: integration.engine = .*round foot"):
        model_of(case_from_tables(tables, "block.toml"), "block.toml")


@pytest.mark.parametrize(
    "keys, words",
    [
        (dict(outer_diameter_m=0.5), "wobbling.outer_diameter_m"),
        (dict(COLUMNS["steel tube"], wall_m=0.06), "wobbling.wall_m"),
        (dict(COLUMNS["marble drum"], slenderness_rad=0.1), "half_diagonal_m"),
    ],
)
def test_keys_that_do_not_fit_are_named(keys, words):
    with pytest.raises(InputError, match=words):
        Wobbling.of_section(WobblingModel(**keys), "column.toml")


def test_more_friction_than_there_is_is_told():
    model = column(outer_diameter_m=1.6, height_m=1.0, friction_coefficient=0.3)
    found = model.respond(shaken(1, 2.0 * GRAVITY * math.tan(model.slenderness)))
    assert "friction coefficient of more than any" in found.notes[0]
    assert "it would slide" in found.notes[0]
    # no number says it, and a summary cannot hold infinity
    assert all(math.isfinite(value) for value in found.peaks.values())
