"""Damping of elastic modes: what it takes from them, and that it takes nothing from rigid
motion.
"""

import numpy as np
import pytest
from small_block import block, trial

from fecolumn.verification.trial import afloat

RATIO = 0.05
FALL = np.array([0.0, 0.0, -9.80665])


def slender(**options):
    """A bar of 20 x 20 x 200 mm in eight bricks, which bends at some 2 kHz."""
    return block(0.02, 0.2, bricks=8, damping_ratio=RATIO, **options)


@pytest.mark.parametrize("engine", ["corotated", "reduced"])
@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_the_first_bending_mode_decays_by_2_pi_zeta_a_cycle(engine, alpha):
    """Released from a shape of the mode, its energy falls by exp(-4 pi zeta) a cycle; HHT's own
    loss, small at 100 steps a cycle, is booked apart.
    """
    system = slender()
    frequency, shape = system.damping.each[0].frequencies[0], system.damping.each[0].shapes[0]
    dt, cycles = 2 * np.pi / frequency / 100, 3
    system = slender(dt=dt, alpha=alpha)
    start = 1e-4 * shape / np.abs(shape).max()
    one = trial(
        engine,
        system,
        lambda system: afloat(system, start, 0 * start, FALL - frequency**2 * start, 0.1),
    )
    begun, first = one.mechanical(), one.energy()["strain"]
    for _ in range(100 * cycles):
        one.step()
    damped = np.sqrt(1 - RATIO**2)
    phase = 2 * np.pi * cycles * damped
    # of x = exp(-zeta w t) (cos w_d t + zeta / damped sin w_d t) at t = cycles 2 pi / w
    t = 2 * np.pi * cycles
    x = np.exp(-RATIO * t) * (np.cos(phase) + RATIO / damped * np.sin(phase))
    v = -np.exp(-RATIO * t) * np.sin(phase) / damped
    energy, left = one.energy(), 1 + (one.mechanical() - begun) / first
    assert np.log(left) == pytest.approx(np.log(x**2 + v**2), rel=0.01)
    assert energy["damping"] + energy["algorithmic"] == pytest.approx((left - 1) * first, rel=1e-6)
    assert abs(energy["algorithmic"]) < (1e-3 if alpha else 1e-8) * first
    assert abs(energy["closure"]) < 1e-9 * first


@pytest.mark.parametrize("engine", ["corotated", "reduced"])
def test_tumbling_in_free_flight_is_not_damped(engine):
    system = slender(dt=1e-3)
    arm = system.body.X - system.body.center
    rates = np.cross([3.0, 5.0, 20.0], arm) + [0.1, 0.2, 0.0]
    one = trial(engine, system, lambda system: afloat(system, 0 * arm, rates, 0 * arm + FALL, 0.15))
    kinetic, begun = one.energy()["kinetic"], one.mechanical()
    for _ in range(50):
        one.step()
    assert abs(one.energy()["damping"]) < 1e-6 * kinetic
    assert one.mechanical() - begun == pytest.approx(0, abs=1e-4 * kinetic)
    assert one.state.rotation[0, 0, 0] < 0.9


def test_a_damped_landing_closes_its_ledger_in_both_engines_and_loses_the_same():
    """A bar that lands on one edge and rings: contact, impact, damping and HHT are booked to the
    last joule.
    """
    losses = []
    for engine in ("corotated", "reduced"):
        system = block(0.02, 0.2, bricks=8, damping_ratio=RATIO, dt=2e-5, alpha=-0.1)
        still = np.zeros_like(system.body.X)
        one = trial(
            engine,
            system,
            lambda system, still=still: afloat(
                system, still, still + [0.0, 0.0, -0.1], still + [0.0, 0.0, -9.80665], 5e-5
            ),
        )
        first = one.energy()["kinetic"]
        for _ in range(60):
            one.step()
        energy = one.energy()
        assert energy["damping"] < 0 and abs(energy["closure"]) < 1e-7 * first
        losses.append(energy["damping"])
    assert losses[1] == pytest.approx(losses[0], rel=0.02)
