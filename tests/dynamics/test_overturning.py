"""The point of no return against the equation of rocking: what it calls lost never comes back."""

import math

import numpy as np
import pytest

from fecolumn.contact.overturning import (
    CAPPED,
    NO_RETURN,
    STANDS,
    barrier,
    critical_displacement,
    fallen,
    stance,
    steepest_to_come,
)
from fecolumn.fem.rotation import rotation_matrix

G = 9.80665
RADIUS, HALF = 0.25, 0.8  # a marble drum, solid, 0.5 m x 1.6 m
MASS = 2700 * math.pi * RADIUS**2 * 2 * HALF
INERTIA = MASS * np.diag([RADIUS**2 / 4 + HALF**2 / 3, RADIUS**2 / 4 + HALF**2 / 3, RADIUS**2 / 2])
ALPHA = math.atan(RADIUS / HALF)
PRESSED = np.array([0.0, 0.0, MASS * G])


def drum(friction=0.6, cap=0.0):
    angles = 2 * np.pi * np.arange(24) / 24
    foot = np.column_stack([RADIUS * np.cos(angles), RADIUS * np.sin(angles), np.full(24, -HALF)])
    return stance(foot, INERTIA, MASS * G, friction, cap)


def block(length=0.4, width=0.2):
    foot = np.array(
        [[x, y, -HALF] for x in (-length / 2, 0, length / 2) for y in (-width / 2, 0, width / 2)]
    )
    return stance(foot, INERTIA, MASS * G, 0.6, 0.0)


def answer(one, tilt, rate=0.1, spin=0.0, force=PRESSED, steepest=0.0, towards=0.0, top=0.0):
    """Answer of a body that leans by `tilt` towards an azimuth, its tilt growing at `rate`, turning
    about its axis at `spin`.
    """
    axis = np.array([-math.sin(towards), math.cos(towards), 0.0])
    rotation = rotation_matrix(tilt * axis)
    return fallen(
        one, rotation, rotation.T @ (rate * axis) + [0.0, 0.0, spin], force, top, steepest
    )


def test_round_foot_is_a_circle_whatever_its_nodes():
    assert drum().critical == pytest.approx(ALPHA, abs=1e-5) and len(drum().corners) > 100
    assert barrier(drum()) == pytest.approx(MASS * G * (math.hypot(RADIUS, HALF) - HALF), rel=1e-4)
    # turned about its edge by alpha: r (1 - cos) + H sin
    assert critical_displacement(drum(), np.array([0, 0, HALF])) == pytest.approx(
        RADIUS * (1 - math.cos(ALPHA)) + 2 * HALF * math.sin(ALPHA), rel=1e-4
    )


def test_block_falls_sooner_across_than_along():
    assert block().critical == pytest.approx(math.atan(0.1 / HALF))
    between = 0.18  # beyond atan(0.1 / 0.8) = 0.124, short of atan(0.2 / 0.8) = 0.245
    assert answer(block(), between, towards=math.pi / 2) == NO_RETURN
    assert answer(block(), between, towards=0.0) == STANDS


@pytest.mark.parametrize(
    "tilt, steepest, friction, sticks, lost",
    [
        (ALPHA - 0.01, 0.0, 0.6, True, False),
        (ALPHA + 0.01, 0.0, 0.6, True, True),  # nothing more to come
        (
            ALPHA + 0.19,
            0.2,
            0.6,
            True,
            False,
        ),  # apparent gravity still to be inclined by atan 0.2 = 0.197
        (ALPHA + 0.21, 0.2, 0.6, True, True),
        (
            ALPHA + 0.21,
            0.2,
            0.6,
            False,
            False,
        ),  # an edge that slides may be braked: friction decides, atan 0.6 = 0.540
        (ALPHA + 0.55, 0.2, 0.6, False, True),
        (ALPHA + 0.55, 5.0, 0.6, True, True),  # no motion passes on more than friction does
        (1.6, np.inf, 10.0, False, True),
    ],
)  # lies on its side
def test_point_of_no_return_is_the_inclination_still_to_come(
    tilt, steepest, friction, sticks, lost
):
    force = PRESSED if sticks else PRESSED + [friction * PRESSED[2], 0, 0]
    assert (answer(drum(friction), tilt, steepest=steepest, force=force) == NO_RETURN) == lost
    assert (
        answer(drum(friction), tilt, rate=-0.1, steepest=steepest, force=force) == STANDS
        or tilt > math.pi / 2
    )


def test_column_that_stands_as_a_top_is_not_lost():
    """L^2 = I m g h at 64 rad/s: below it gravity overcomes the gyroscopic stiffness."""
    assert answer(drum(), ALPHA + 0.05, spin=200.0) == STANDS
    assert answer(drum(), ALPHA + 0.05, spin=1.0) == NO_RETURN


def test_cap_counts_only_where_there_is_one():
    assert answer(drum(cap=0.25), 0.1, top=0.26) == CAPPED
    assert answer(drum(cap=0.25), 0.1, top=0.24) == answer(drum(), 0.1, top=0.26) == STANDS


def test_steepest_to_come_counts_vertical_motion_and_forgets_the_past():
    grounds = [[3.0, 4.0, 0.0], [2.0, 0.0, -G / 2], [1.0, 0.0, 0.0], [0.0, 0.0, 5.0]]
    np.testing.assert_allclose(steepest_to_come([0, 0, -G], grounds), [5 / G, 4 / G, 1 / G, 0.0])
    assert steepest_to_come([0, 0, -G], [[0.0, 0.0, -1.1 * G]])[0] == math.inf


def rock(tilt, rate, grounds, dt, one):
    """Tilt of the planar rocking drum (Housner 1963) under (n, 2) horizontal and vertical
    accelerations, its end, and when it was called lost.
    """
    steepest = steepest_to_come([0, 0, -G], np.insert(grounds, 1, 0.0, axis=1))
    about_edge, arm, called = (
        INERTIA[0, 0] + MASS * (RADIUS**2 + HALF**2),
        math.hypot(RADIUS, HALF),
        None,
    )
    for k in range(20 * len(grounds)):
        a, v = grounds[k] if k < len(grounds) else (0.0, 0.0)
        ahead, side = steepest[k] if k < len(steepest) else 0.0, math.copysign(1, tilt)
        if (
            called is None
            and answer(
                one, abs(tilt), side * rate, steepest=ahead, towards=0.0 if tilt > 0 else math.pi
            )
            == NO_RETURN
        ):
            called = k
        rate -= (
            dt
            * MASS
            * arm
            / about_edge
            * (side * (G + v) * math.sin(ALPHA - abs(tilt)) + a * math.cos(ALPHA - abs(tilt)))
        )
        if (tilt + dt * rate) * tilt < 0:
            rate *= 1 - 1.5 * math.sin(ALPHA) ** 2
        tilt += dt * rate
        if abs(tilt) > math.pi / 2 or (k > len(grounds) and abs(tilt) < 0.5 * ALPHA):
            break
    return abs(tilt) > math.pi / 2, called


def test_what_is_called_lost_never_comes_back():
    """120 random motions from random leans, vertical motion too: all that fall are called lost,
    none that comes back is, some far beyond alpha.
    """
    rng, one, dt, ends, farthest = np.random.default_rng(5), drum(friction=10.0), 2e-3, [], 0.0
    for _ in range(120):
        grounds = np.repeat(rng.normal(0, [3.0, 2.0], (8, 2)), 50, axis=0)
        tilt = rng.uniform(0.5, 1.6) * ALPHA
        fell, called = rock(tilt, rng.normal(0, 0.3), grounds, dt, one)
        ends.append(fell)
        assert fell == (called is not None)
        farthest = max(farthest, 0.0 if fell else tilt)
    assert 20 < sum(ends) < 100 and farthest > 1.2 * ALPHA
