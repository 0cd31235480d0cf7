"""Impulses by frozen slips: they obey Coulomb's law but for what is said, and take energy wherever
their rounds stop.
"""

import itertools

import numpy as np
import pytest

from fecolumn.contact import frozen_slips
from fecolumn.contact.coulomb import violation
from fecolumn.contact.coupling import (
    Coupling,
    coupling_by_levers,
    motion_by,
    moved_by,
    slips_under,
    softened,
    stiffnesses,
    times,
)
from fecolumn.contact.fallbacks import by_frozen_slips
from fecolumn.contact.frozen_slips import find_impulses, follow_slips, solve_frozen
from fecolumn.contact.impulses import all_impulses, rough_impulses
from fecolumn.contact.problem import N_COUNTS
from fecolumn.foundation._compiled import interpreted

FRICTION = 0.5
# Velocities [m/s] to which impulses are found: exact, allowed, usable
TO = (1e-12, 1e-4, 1e-4)


def impact(blocks, seed):
    """Coupling, velocities, friction and guess of the impact of so many blocks on one another, of
    1 kg and 1 x 1 x 2 m, with eight points a joint that give little.
    """
    rng, levers, bodies = np.random.default_rng(seed), [], []
    root = np.sqrt(12 / np.array([5.0, 5.0, 2.0]))
    for b in range(blocks):
        for x, y in itertools.product((-0.5, 0.0, 0.5), repeat=2):
            if x == y == 0.0:
                continue
            row = np.zeros((3, 12))
            for side, arm, sign in ((0, [x, y, -1.0], 1.0), (1, [x, y, 1.0], -1.0)):
                if side == 0 or b > 0:
                    turn = np.cross(arm, np.eye(3)) * root
                    row[:, 6 * side : 6 * side + 6] = sign * np.hstack([np.eye(3), turn])
            levers.append(row)
            bodies.append((b, b - 1))
    n = len(levers)
    coupling = coupling_by_levers(np.zeros((n, 3)), np.array(levers), np.array(bodies))
    coupling = softened(coupling, 1e-4 / stiffnesses(coupling, False))
    motion = 0.3 * rng.standard_normal((blocks, 6))
    motion[0, 2] -= 1.0
    velocity = moved_by(coupling, motion)
    return coupling, velocity, np.full(n, FRICTION), np.zeros((n, 3))


@pytest.mark.long
@pytest.mark.parametrize("blocks", [1, 3])
@pytest.mark.parametrize("seed", range(4))
def test_coulombs_law_is_missed_by_no_more_than_is_said(blocks, seed):
    coupling, velocity, friction, start = impact(blocks, seed)
    impulses, missed, _ = find_impulses(coupling, velocity, friction, start, False, *TO)
    after, presses = times(coupling, impulses) + velocity, impulses[:, 2] > 0
    assert missed < 2e-3 and presses.sum() >= 2
    assert (np.abs(after[presses, 2]) <= 1.2 * missed + 1e-10).all()
    assert (after[~presses, 2] >= -1.2 * missed - 1e-10).all()
    full = np.hypot(*impulses.T[:2]) > 0.999 * FRICTION * impulses[:, 2]
    slips = np.hypot(*after.T[:2]) > missed + 1e-9
    assert full[presses & slips].all()
    works = (impulses * after)[:, :2].sum(axis=1)
    assert (works <= 1.2 * missed * np.linalg.norm(impulses, axis=1) + 1e-10).all()


@pytest.mark.long
def test_an_impact_that_stops_too_early_takes_energy_too(monkeypatch):
    coupling, velocity, friction, start = impact(3, 1)
    monkeypatch.setattr(frozen_slips, "FROZEN_ROUNDS", 2)
    impulses, missed, _ = interpreted(find_impulses)(
        coupling, velocity, friction, start, False, 1e-12, 1e-9, 1e-9
    )
    assert missed > 1e-3
    assert (np.hypot(*impulses.T[:2]) <= FRICTION * impulses[:, 2] * (1 + 1e-12)).all()
    jump = times(coupling, impulses)
    assert (impulses * (velocity + jump / 2)).sum() < 0.0
    assert (impulses * (velocity + jump)).sum() <= 0.0


def test_a_good_guess_needs_fewer_steps():
    coupling, velocity, friction, start = impact(3, 2)
    impulses, missed, made = find_impulses(coupling, velocity, friction, start, False, *TO)
    again, left, fewer = find_impulses(coupling, velocity, friction, impulses, True, *TO)
    assert left <= max(missed, 1e-4) and missed < 2e-3 and fewer < made
    np.testing.assert_allclose(times(coupling, again), times(coupling, impulses), atol=1e-2)


@pytest.mark.long
@pytest.mark.parametrize("blocks", [1, 3])
@pytest.mark.parametrize("seed", range(3))
def test_rough_impulses_take_the_energy_of_exact_ones(blocks, seed):
    """Blocks that give nothing: the rigid loss of the ledger is the energy of rough ones."""
    coupling, velocity, friction, start = impact(blocks, seed)
    coupling = coupling_by_levers(0 * coupling.own, coupling.levers, coupling.bodies)
    n, counts = len(friction), np.zeros(N_COUNTS, np.int64)
    exact, solved = all_impulses(
        coupling, velocity.ravel(), friction, start.ravel(), np.inf, 0.0, counts
    )
    rough = rough_impulses(coupling, velocity.ravel(), friction, np.arange(n), start.ravel())
    energy = [
        (impulses * (velocity + times(coupling, impulses) / 2)).sum()
        for impulses in (exact.reshape(n, 3), rough.reshape(n, 3))
    ]
    assert solved and energy[0] < 0 and energy[1] == pytest.approx(energy[0], rel=5e-3)


@pytest.mark.parametrize("mu", [0.0, 0.4])
def test_the_slope_of_the_nearest_impulse_of_the_cone_is_that_of_differences(mu):
    rng, kinds = np.random.default_rng(5), set()
    for _ in range(40):
        place, give = rng.standard_normal(3), 0.3
        impulse, slope = np.empty(3), np.empty((3, 3))
        nearest = interpreted(frozen_slips._nearest)
        nearest(*place, mu, give, impulse, slope)
        differences, ahead, back = np.empty((3, 3)), np.empty(3), np.empty(3)
        for a in range(3):
            step = 1e-6 * np.eye(3)[a]
            nearest(*(place + step), mu, give, ahead, np.empty((3, 3)))
            nearest(*(place - step), mu, give, back, np.empty((3, 3)))
            differences[:, a] = (ahead - back) / 2e-6 / give
        np.testing.assert_allclose(slope, differences, atol=1e-8)
        kinds.add((impulse[2] > 0, bool(np.hypot(*impulse[:2]) < mu * impulse[2] * 0.999)))
    assert len(kinds) >= 2


@pytest.mark.long
@pytest.mark.parametrize("along", [0.3, 1.0, 3.0])
@pytest.mark.parametrize("seed", range(4))
def test_forces_of_a_step_are_found_where_newton_alone_may_find_none(seed, along):
    """Points that give otherwise along their faces than across them, as joints with a law do."""
    coupling, slips, friction, start = impact(6, seed)
    own = coupling.own * [along, along, 1.0]
    coupling = Coupling(coupling.whole, own, coupling.levers, coupling.bodies, coupling.blocks)
    rho = stiffnesses(coupling, False)
    forces, residual, _, _ = by_frozen_slips(coupling, slips, friction, start, 1e-11, rho, 36)
    after = slips_under(coupling, slips, forces)
    assert violation(after, forces, friction, rho) == residual <= 1e-11
    assert (forces[:, 2] > 0).sum() >= 2


@pytest.mark.parametrize("seed", range(4))
def test_a_motion_follows_its_slips(seed):
    """While the same points carry, stick and slide, the motion that follows a small change of the
    slips is the solution for them but for what is quadratic in the change, by which cones bend.
    """
    coupling, velocity, friction, start = impact(3, seed)
    chance, far = np.random.default_rng(seed), []
    n = len(velocity)
    change = chance.uniform(0.0, 1.0, n)
    for size in (1e-7, 1e-8):
        slips, impulses, slopes = np.full(n, 1e-2), np.empty((n, 3)), np.empty((n, 3, 3))
        motion = motion_by(coupling, start)
        solve_frozen(coupling, velocity, friction, slips, motion, impulses, slopes, 1e-15)
        before = np.full(n, 1e-2)
        stays, after = motion.copy(), before + size * change
        follow_slips(coupling, before, after, motion, impulses, slopes)
        exact = motion.copy()
        solve_frozen(coupling, velocity, friction, after.copy(), exact, impulses, slopes, 1e-15)
        assert np.abs(exact - stays).max() > 1e-2 * size
        far.append(np.abs(motion - exact).max())
    assert far[0] < 1e-3 * 1e-7 or far[1] < 0.02 * far[0]
