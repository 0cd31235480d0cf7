"""Laws of links along prescribed ways, against their closed forms: kinematic hardening, the curve
of Wen, what only pushes, powers of the rate; ropes that break one after another.
"""

import numpy as np
import pytest
from test_links import DT, ELASTIC, FAR, STIFFNESS, YIELDS, half_cycle, walked


def full_cycles(steps, peak, cycles):
    return peak * np.sin(2 * np.pi * np.arange(1, cycles * steps + 1) / steps)


@pytest.mark.long
@pytest.mark.parametrize("steps", [8, 12, 1000])
def test_hardening_is_bilinear_and_yields_back_after_twice_the_yield_force(steps):
    """N = h k e + (1 - h) F clipped; a half cycle out to FAR and back."""
    h, ways = 0.1, half_cycle(steps)
    tensions, tie, kept, taken, done = walked(ways, hardening=h)
    out = np.minimum(STIFFNESS * ways, h * STIFFNESS * ways + (1 - h) * YIELDS)
    peak = h * STIFFNESS * FAR + (1 - h) * YIELDS
    back = np.maximum(peak - STIFFNESS * (FAR - ways), h * STIFFNESS * ways - (1 - h) * YIELDS)
    expected = np.where(np.arange(1, steps + 1) <= steps // 2, out, back)
    np.testing.assert_allclose(tensions, expected, atol=1e-9 * YIELDS)
    # what yields out and back, each of them over k + H of the way beyond elastic
    plastic = (1 - h) * (FAR - ELASTIC) + (1 - h) * (FAR - 2 * ELASTIC)
    assert taken == pytest.approx(YIELDS * plastic, rel=1e-10)
    assert done == pytest.approx(taken + kept, rel=1e-11)
    assert tie["work"] == pytest.approx(taken, rel=1e-12)


@pytest.mark.parametrize("bends", [np.inf, 2.0])
def test_a_loop_of_hardening_takes_its_area(bends):
    """The area of a steady loop, by the trapezium of its own forces, is what yielding took."""
    ways = full_cycles(4000, FAR, 3)
    before = walked(ways[:8000], hardening=0.05, bends=bends)
    after = walked(ways, hardening=0.05, bends=bends)
    forces, loop = after[0][7999:], ways[7999:]
    area = np.sum((forces[1:] + forces[:-1]) / 2 * np.diff(loop))
    assert after[3] - before[3] == pytest.approx(area, rel=2e-4)
    if bends == np.inf:
        assert area == pytest.approx(4 * YIELDS * 0.95 * (FAR - ELASTIC), rel=2e-4)


@pytest.mark.parametrize("steps", [6, 8, 1000])
def test_a_tendon_that_hardens_may_yield_back_and_goes_slack_where_it_carries_nothing(steps):
    """Hardened by more than twice its yield force it yields back under tension, until its back
    stress is the yield force; slack it yields no more.
    """
    h, far = 0.5, 10 * ELASTIC
    ways = half_cycle(steps, far)
    tensions, tie, kept, taken, done = walked(ways, pushes=False, hardening=h)
    hardens = STIFFNESS * h / (1 - h)
    out = (1 - h) * (far - ELASTIC)
    assert tensions.max() == pytest.approx(YIELDS * (1 + h * 9)) and tensions.min() == 0.0
    assert tie["flowed"] == pytest.approx(YIELDS / hardens, rel=1e-10)
    assert taken == pytest.approx(YIELDS * (out + out - YIELDS / hardens), rel=1e-10)
    assert kept == pytest.approx(hardens * tie["flowed"] ** 2 / 2, rel=1e-10)
    assert done == pytest.approx(taken + kept, rel=1e-10)


@pytest.mark.parametrize("steps", [1, 7, 300])
@pytest.mark.parametrize("hardening", [0.0, 0.2])
def test_the_curve_of_exponent_one_and_two_has_its_closed_form(steps, hardening):
    """Loaded afresh z = 1 - exp(-w) and tanh w, with w over the yield elongation; the force is h k
    e + (1 - h) F z; taken: (1 - h) F e_y times the integral of z^(n+1).
    """
    ways = np.linspace(0, FAR, steps + 1)[1:]
    w = ways / ELASTIC
    for n, z, area in (
        (1.0, 1 - np.exp(-w), w[-1] - 1.5 + 2 * np.exp(-w[-1]) - np.exp(-2 * w[-1]) / 2),
        (2.0, np.tanh(w), np.log(np.cosh(w[-1])) - np.tanh(w[-1]) ** 2 / 2),
    ):
        tensions, tie, kept, taken, done = walked(ways, bends=n, hardening=hardening)
        expected = hardening * STIFFNESS * ways + (1 - hardening) * YIELDS * z
        np.testing.assert_allclose(tensions, expected, rtol=1e-6)
        assert taken == pytest.approx((1 - hardening) * YIELDS * ELASTIC * area, rel=1e-5)
        assert done == pytest.approx(taken + kept, rel=1e-11)


def test_unloaded_it_is_elastic_and_then_bends_the_other_way():
    """From z1 back along k until the force less its hardening is zero, then tanh again."""
    ways = np.concatenate([np.linspace(0, FAR, 51)[1:], np.linspace(FAR, -FAR, 401)[1:]])
    tensions, *_ = walked(ways, bends=2.0)
    z1 = np.tanh(FAR / ELASTIC)
    turned = ways[50:]
    expected = np.where(
        turned > FAR - z1 * ELASTIC,
        z1 - (FAR - turned) / ELASTIC,
        -np.tanh((FAR - z1 * ELASTIC - turned) / ELASTIC),
    )
    np.testing.assert_allclose(tensions[50:], YIELDS * expected, atol=1e-6 * YIELDS)


def test_a_large_exponent_is_the_corner():
    ways = half_cycle(200)
    sharp, curved = walked(ways, hardening=0.1), walked(ways, hardening=0.1, bends=50.0)
    np.testing.assert_allclose(curved[0], sharp[0], atol=0.02 * YIELDS)
    assert curved[3] == pytest.approx(sharp[3], rel=0.01)


@pytest.mark.parametrize(
    "pulls, pushes, play", [(1, 1, 0.0), (1, 1, ELASTIC), (1, 0, 0.0), (0, 1, ELASTIC)]
)
@pytest.mark.parametrize("hardening", [0.0, 0.3, 0.7])
@pytest.mark.parametrize("bends", [np.inf, 1.0, 3.5, 20.0])
def test_energy_is_kept_or_taken_whatever_the_way(pulls, pushes, play, hardening, bends):
    """Random ways with steps from a hundredth to many times the yield elongation; a way in one
    step or in a hundred ends the same.
    """
    rng = np.random.default_rng(1)
    ways = np.cumsum(rng.normal(size=60) * ELASTIC * 10 ** rng.uniform(-2, 0.8, 60)) * 0.7
    keys = dict(pulls=pulls, pushes=pushes, play=play, hardening=hardening, bends=bends)
    tensions, tie, kept, taken, done = walked(ways, **keys)
    assert done == pytest.approx(taken + kept, rel=1e-10) and taken > 0.0
    fine = np.concatenate([np.linspace(a, b, 21)[1:] for a, b in zip((0.0, *ways[:-1]), ways)])
    many, its, _, less, _ = walked(fine, **keys)
    np.testing.assert_allclose(many[19::20], tensions, atol=2e-5 * YIELDS)
    assert less == pytest.approx(taken, rel=1e-5)
    assert its["flowed"] == pytest.approx(tie["flowed"], abs=2e-5 * ELASTIC)


def test_a_strut_pushes_alone_and_a_stop_beyond_its_gap():
    ways = full_cycles(400, FAR, 1)
    for gap in (0.0, ELASTIC):
        tensions, tie, kept, taken, done = walked(ways, pulls=False, play=gap, yields=np.inf)
        np.testing.assert_allclose(tensions, np.minimum(STIFFNESS * (ways + gap), 0.0), atol=1e-6)
        assert taken == 0.0 and done == pytest.approx(kept, abs=1e-9)
    # one that is crushed keeps its shortening: the gap is wider for good
    tensions, tie, _, taken, done = walked(ways, pulls=False, play=ELASTIC)
    assert tensions.min() == pytest.approx(-YIELDS) and tensions.max() == 0.0
    assert tie["flowed"] == pytest.approx(-(FAR - 2 * ELASTIC)) and taken == pytest.approx(
        YIELDS * (FAR - 2 * ELASTIC), rel=1e-10
    )
    assert done == pytest.approx(taken, rel=1e-10)


@pytest.mark.parametrize("power", [0.3, 1.0, 2.0])
def test_a_dashpot_of_a_power_takes_its_closed_form_over_a_cycle(power):
    """c |v|^a sign(v) takes c w^a A^(1+a) times the integral of |cos|^(1+a) over a cycle
    (Constantinou and Symans 1993).
    """
    steps, damping, slow = 4000, 300.0, 1e-6
    ways = full_cycles(steps, FAR, 1)
    tensions, tie, kept, taken, done = walked(
        ways, stiffness=0.0, damping=damping, power=power, slow=slow
    )
    turn = 2 * np.pi / (steps * DT)
    angles = (np.arange(200000) + 0.5) / 200000 * 2 * np.pi
    integral = np.mean(np.abs(np.cos(angles)) ** (1 + power)) * 2 * np.pi
    assert taken == pytest.approx(damping * turn**power * FAR ** (1 + power) * integral, rel=1e-4)
    rates = np.diff(ways, prepend=0.0) / DT
    np.testing.assert_allclose(
        tensions, damping * np.abs(rates) ** power * np.sign(rates), rtol=1e-8, atol=1e-9
    )
    assert done == pytest.approx(taken, rel=1e-9) and kept == 0.0


def test_below_its_least_rate_a_power_is_proportional():
    slow = 0.01
    ways = np.cumsum([0.2 * slow * DT, slow * DT, 5 * slow * DT])
    tensions, *_ = walked(ways, stiffness=0.0, damping=100.0, power=0.5, slow=slow)
    np.testing.assert_allclose(tensions, 100 * slow**0.5 * np.array([0.2, 1.0, 5**0.5]), rtol=1e-9)


def test_ropes_break_one_after_another_and_each_loses_what_it_held():
    """Three ropes of other slack side by side: the shortest breaks first, and from its break on the
    next one carries; the energy of each is its own breaking_n^2 / 2 k.
    """
    breaks, ways = 2 * ELASTIC, np.linspace(0, 10 * ELASTIC, 1001)[1:]
    slacks = [0.0, 3 * ELASTIC, 6 * ELASTIC]
    ropes = [
        walked(ways, pushes=False, play=slack, yields=np.inf, breaks=breaks) for slack in slacks
    ]
    total = sum(rope[0] for rope in ropes)
    broke = [ways[np.flatnonzero(rope[0])[-1] + 1] for rope in ropes]
    np.testing.assert_allclose(broke, np.add(slacks, breaks), atol=2 * ways[0])
    assert total.max() <= STIFFNESS * breaks and not total[-1]
    for rope in ropes:
        assert rope[1]["broken"] and rope[2] == 0.0
        assert rope[4] == pytest.approx(rope[3], rel=1e-10)
        assert rope[3] == pytest.approx(STIFFNESS * breaks**2 / 2, rel=0.02)


def test_a_rope_goes_slack_and_comes_tight_without_loss():
    ways = full_cycles(50, FAR, 3)
    tensions, _, kept, taken, done = walked(ways, pushes=False, play=ELASTIC, yields=np.inf)
    assert (tensions == 0).sum() > 50 and tensions.max() == pytest.approx(
        STIFFNESS * (ways.max() - ELASTIC)
    )
    assert taken == 0.0 and done == pytest.approx(kept, abs=1e-9 * STIFFNESS * FAR**2)
