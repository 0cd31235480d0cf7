"""Masonry walls: multipliers beside limit analysis, capacity curves, limit states, and walls of
blocks with friction.
"""

import math

import numpy as np
import pytest

from fecolumn.engines.rocking.masonry_displacement import (
    JOINTS,
    bilinear,
    limit_state,
    motion_spectrum,
    oscillator,
    performance_point,
    secant_demand,
    trilinear,
)
from fecolumn.engines.rocking.masonry_force import (
    facade_multiplier,
    free_wall_multiplier,
    hinged_wall_multiplier,
)
from fecolumn.engines.rocking.masonry_limit import (
    associated,
    non_associated,
    running_bond,
    wall_of_boxes,
)
from fecolumn.motions.pulses import Pulse, sample
from fecolumn.verification.masonry import run


def test_verification_rows_hold():
    assert [row for row in run("models").rows if not row.ok] == []


def test_the_hinged_wall_follows_from_virtual_work_for_any_hinge_and_load():
    """Two straight parts, velocities of their centres and of the load by hand: t = 0.3, h = 3,
    hinge at 0.6 h, P = W/4 in the middle.
    """
    t, h, c, load = 0.3, 3.0, 0.6, 0.25
    lower, upper = 1.0, c / (1 - c)  # turns
    lifted = (
        c * t / 2 * lower
        + (1 - c) * (t * lower + t / 2 * upper)
        + load * (t * lower + t / 2 * upper)
    )
    pushed = c * (c * h / 2) + (1 - c) * (c * h / 2)
    assert hinged_wall_multiplier(t, h, 2 * load, hinge=c, load_at=0.5) == pytest.approx(
        lifted / pushed
    )


def test_a_stiff_floor_helps_more_than_a_centred_load_and_both_more_than_none():
    values = [
        hinged_wall_multiplier(0.3, 3.0, psi, load_at=at) for psi, at in ((0, 0), (1, 0.5), (1, 0))
    ]
    assert values == sorted(values) and values[0] == pytest.approx(
        4 * free_wall_multiplier(0.3, 3.0)
    )


def test_friction_holds_a_facade_and_never_loosens_it():
    alone, held = facade_multiplier(6e4, 3.0, 0.4), facade_multiplier(6e4, 3.0, 0.4, sides=1e4)
    assert held - alone == pytest.approx(1e4 / 3 * 3.0 / (6e4 * 1.5))
    assert facade_multiplier(6e4, 3.0, 0.4, sides=1e4, lever=0.9) < held


@pytest.mark.parametrize(
    "values", [dict(thickness=0.0, height=3.0), dict(thickness=0.3, height=-1.0)]
)
def test_sizes_that_are_no_walls_are_refused(values):
    with pytest.raises(ValueError, match="must be greater than 0"):
        free_wall_multiplier(**values)


def test_a_mechanism_of_several_parts_has_the_oscillator_of_their_displacements():
    """Two equal parts at 1 and 0.5: M* g = (1.5 W)^2 / 1.25 W = 1.8 W, share 0.9, displacement
    1.25/1.5.
    """
    found = oscillator([1e4, 1e4], [1.0, 0.5])
    assert (found.share, found.displacement) == pytest.approx((0.9, 1.25 / 1.5))


def test_the_secant_period_grows_with_displacement_and_worn_joints_lengthen_it():
    curves = [
        bilinear(0.1, 0.3),
        *(trilinear(0.1, 0.3, JOINTS[state]) for state in ("new", "moderate", "severe")),
    ]
    early = [curve.secant_period(0.01) for curve in curves]
    assert early == sorted(early)
    assert curves[0].secant_period(0.05) < curves[0].secant_period(0.2)
    assert secant_demand(curves[0], lambda period: 0.01 * period)[0] == pytest.approx(
        curves[0].secant_period(0.12)
    )


def test_a_weak_motion_is_borne_and_a_strong_one_brings_the_wall_down():
    wall = trilinear(0.1, 0.3)
    weak, strong = (
        motion_spectrum(sample(Pulse("one_sine", amplitude, 0.8), 5e-3, tail=2.0))
        for amplitude in (0.5, 8.0)
    )
    assert performance_point(wall, weak) < 0.1
    assert math.isinf(performance_point(wall, strong))


def test_limit_states_are_those_of_tilt_over_alpha():
    assert [limit_state(tilt) for tilt in (0.0, 0.3, 0.5, 1.0, math.inf)] == [
        "at rest",
        "limited rocking",
        "rocking",
        "collapse",
        "collapse",
    ]
    assert limit_state(0.3, limited=0.2) == "rocking"
    with pytest.raises(ValueError, match="limited"):
        limit_state(0.3, limited=0.5)


def test_forces_of_a_limit_analysis_balance_and_its_mechanism_is_admissible():
    wall = running_bond(3, 4, 0.4, 0.175)
    found = associated(wall, 0.65)
    assert (found.normal >= -1e-6).all() and found.residual < 1e-9
    power = wall.loads @ found.velocity[:, 0]
    lost = wall.weights @ found.velocity[:, 1]
    # what the loads gain lifts the weights: friction that dilates does no work
    assert power == pytest.approx(1.0) and lost == pytest.approx(found.multiplier, rel=1e-6)


def test_without_dilatancy_sliding_costs_work_and_the_bound_is_not_passed():
    wall = running_bond(3, 4, 0.4, 0.175)
    upper, coulomb = associated(wall, 0.4), non_associated(wall, 0.4)
    assert (
        coulomb.multiplier <= upper.multiplier + 1e-7
        and coulomb.residual < 1e-6
        and coulomb.iterations > 20
    )


def test_a_wall_on_ice_slides_at_once_and_a_wall_that_overhangs_does_not_stand():
    assert associated(wall_of_boxes([(0, 0, 1, 0.2)], 1e4), 0.05).multiplier == pytest.approx(0.05)
    with pytest.raises(ValueError, match="does not stand"):
        associated(wall_of_boxes([(0, 0, 0.4, 0.2), (0.3, 0.2, 0.9, 0.4)], 1e4), 0.6)


def test_joints_are_found_where_blocks_touch():
    wall = running_bond(5, 6, 0.4, 0.175)
    beds = [joint for joint in wall.joints if joint.normal[1] == 1]
    assert len(wall.boxes) == 33 and sum(joint.second == -1 for joint in beds) == 6
    assert sum(np.ptp(joint.ends[:, 0]) for joint in beds) == pytest.approx(6 * 2.0)
