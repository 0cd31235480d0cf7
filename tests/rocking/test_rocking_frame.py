"""The rocking frame against Makris and Vassiliou: the block that rocks alike, its impacts, its
force after uplift.
"""

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid

from fecolumn.case.model_sections import BlockModel, FrameModel
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.block import RockingBlock
from fecolumn.engines.rocking.frame import RockingFrame
from fecolumn.engines.rocking.impact import frame_restitution, housner_restitution
from fecolumn.engines.rocking.restraint import Restraint
from fecolumn.motions.pulses import Pulse, sample
from fecolumn.motions.record import GroundMotion

# The restrained frame of four columns of the NTUA tests (paper on the wobbling model): 2R, alpha,
# weights [N], stiffness [N/m]
TESTED = dict(
    columns=4,
    slenderness_rad=0.1359,
    half_diagonal_m=1.463 / 2,
    column_mass_kg=1220 / GRAVITY,
    beam_mass_kg=94350 / GRAVITY,
)


def frame(**keys):
    return RockingFrame.of_section(FrameModel(**{**TESTED, **keys}), "frame.toml")


@pytest.mark.parametrize("gamma", [0.0, 0.434, 4.0, 1e6])
def test_frame_rocks_as_a_larger_block_of_its_slenderness(gamma):
    """R_hat = (1 + gamma/(1 + 2 gamma)) R; p_hat^2 = p^2 (1 + 2 gamma)/(1 + 3 gamma), 2/3 p^2 under
    a heavy beam.
    """
    alpha, radius = 0.17, 2.0
    found = RockingFrame.of(3, alpha, radius, 100.0, 300.0 * gamma)
    larger = (1 + gamma / (1 + 2 * gamma)) * radius
    assert found.plane.p2[0] == pytest.approx(3 * GRAVITY / (4 * larger), rel=1e-12)
    kept = frame_restitution(alpha, gamma)
    assert kept <= housner_restitution(alpha)
    block = RockingBlock.of_section(
        BlockModel(slenderness_rad=alpha, half_diagonal_m=larger, restitution=kept), ""
    )
    motion = sample(Pulse("antisymmetric_ricker", 0.45 * GRAVITY, 0.6), 2e-3, tail=2.0)
    assert found.respond(motion).tilt == pytest.approx(block.respond(motion).tilt, abs=1e-12)


def test_impact_keeps_the_momentum_of_columns_and_beam():
    """From the velocities of every body before and after: moments of momentum of the columns about
    the feet they land on, and the beam's through its pivots.

    Before, columns turn about their left feet and the beam moves at 2 R across the diagonal from
    there; after, about the right ones. Virtual work of the impulse with the motion after, which the
    impulses at the new pivots do not enter, gives the law.
    """
    alpha, gamma, R = 0.2, 2.5, 1.0
    s, c = math.sin(alpha), math.cos(alpha)

    # of a column's centre of mass and of the beam per angular velocity, leaning to +x
    def velocities(side):  # +1 about the right foot, -1 about the left one
        return np.array([R * c, side * R * s]), np.array([2 * R * c, side * 2 * R * s])

    (column, beam), (column_after, beam_after) = velocities(-1), velocities(1)
    inertia = R * R / 3
    before = inertia + column @ column_after + gamma * beam @ beam_after
    after = inertia + column_after @ column_after + gamma * beam_after @ beam_after
    assert before / after == pytest.approx(frame_restitution(alpha, gamma), rel=1e-12)


def test_energy_of_a_restrained_frame_closes():
    rng = np.random.default_rng(4)
    noise = np.convolve(rng.normal(size=3000), np.hanning(60) / np.hanning(60).sum(), "same")
    motion = GroundMotion(
        np.column_stack([noise / np.abs(noise).max() * 4.0, 0 * noise, 0 * noise]), 2e-3, "", ""
    )
    found = frame(tendon_n_m=1.72e6, tendon_prestress_n=2000.0).respond(motion, free_s=1.0)
    assert len(found.impact_times) > 3
    assert np.abs(found.energy["closure"]).max() < 1e-7 * found.energy["kinetic"].max()


@pytest.mark.parametrize("stiffness, sign", [(0.0, -1), (1.72e6, -1), (3.4e6, -1), (3.8e6, 1)])
def test_force_after_uplift_falls_below_the_critical_stiffness_and_rises_above(stiffness, sign):
    found = frame(tendon_n_m=stiffness)
    assert found.critical_tendon_stiffness == pytest.approx(3.593e6, rel=1e-3)
    force = found.pushover([1e-9, 1e-4])
    assert np.sign(np.diff(force)[0]) == sign
    # slender: alpha^2 of slope at most, of the weights' own slope
    assert np.diff(force)[0] / 1e-4 == pytest.approx(
        np.diff(found.linear_pushover([0, 1]))[0], abs=2 * 0.1359**2 * 72700
    )


def test_tested_frame_has_the_numbers_derived_from_its_paper():
    found = frame(tendon_n_m=1.72e6)
    assert found.mass_ratio == pytest.approx(19.33, abs=0.005)
    assert found.plane.uplift() == pytest.approx(0.1367, abs=5e-5)
    assert found.pushover([0.0])[0] == pytest.approx(13.15e3 * math.tan(0.1359) / 0.1359, rel=1e-3)
    assert found.linear_pushover([0.0])[0] == pytest.approx(13.15e3, rel=1e-3)
    slope = np.diff(found.linear_pushover([0, 1]))[0]
    assert slope == pytest.approx(-34.8e3, rel=2e-3)
    assert -found.linear_pushover(0.0) / slope == pytest.approx(0.378, rel=2e-3)
    free = frame()
    assert -free.linear_pushover(0.0) / np.diff(free.linear_pushover([0, 1]))[0] == pytest.approx(
        0.197, rel=2e-3
    )
    # the exact capacity: the beam over the pivots, 2 R sin(alpha) further, one above the other
    assert free.critical_displacement == pytest.approx(1.463 * math.sin(0.1359), rel=1e-9)


def test_tendon_over_two_joints_counts_four_times():
    one, two = (
        frame(tendon_n_m=1e6, tendon_joints=n).plane.restraints[0].tendon[0] for n in (1, 2)
    )
    assert two == pytest.approx(4 * one)


def test_pushover_does_the_work_of_the_potential():
    held = RockingFrame.of(
        2, 0.2, 1.0, 100.0, 500.0, restraint=Restraint(tendons=((2e4, 300.0, 0.4),))
    )
    displacement = np.linspace(0, 0.2, 4001)
    work = trapezoid(held.pushover(displacement), displacement)
    lean = 0.2 - math.asin(math.sin(0.2) - 0.1)
    assert work == pytest.approx(float(sum(held.plane.potential(lean))), rel=1e-6)


def test_trilith_of_pena_does_not_lift_in_its_plane():
    """5 mm at 3.3 Hz is 0.219 g, below g tan(alpha) = 0.275 g: the motion that was recorded was not
    planar rocking.
    """
    trilith = RockingFrame.of_section(
        FrameModel(width_m=0.22, height_m=0.8, column_mass_kg=305.0, beam_mass_kg=265.0), ""
    )
    time = np.arange(0, 3, 1e-3)
    shaking = 0.005 * (2 * math.pi * 3.3) ** 2 * np.sin(2 * math.pi * 3.3 * time)
    for factor, lifts in ((1.0, False), (0.28 / 0.219, True)):
        motion = GroundMotion(np.column_stack([factor * shaking, 0 * time, 0 * time]), 1e-3, "", "")
        assert (trilith.respond(motion).tilt.max() > 0) == lifts
