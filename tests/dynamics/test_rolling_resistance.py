"""Rolling resistance of a column that wobbles on its rim."""

import numpy as np
import pytest
from coarse_column import coarse_system
from scipy.integrate import solve_ivp

from fecolumn.contact.rim import lowest
from fecolumn.engines.dynamics.gravity import tilted
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.rolling_rim import RollingRim
from fecolumn.verification.wobbling import rolling

TILT, RESISTANCE = 0.03, 5e-4


def wobble(engine, steps):
    """The trial after `steps` of 1 ms from steady precession, its rim, and the length of rim rolled
    [m].
    """
    system = coarse_system(
        integration={"dt_s": 1e-3, "alpha_hht": 0.0},
        contact={"friction_coefficient": 0.8, "rolling_resistance": RESISTANCE},
    )
    rim = RollingRim.of(system)
    one = begin_trial(engine, system, rolling(rim, TILT, rim.untwisted(TILT)))
    angles = []
    for _ in range(steps):
        one.step()
        angles.append(lowest(one.state.rotation[0])[0])
    return one, rim, rim.radius * np.ptp(np.unwrap(angles))


@pytest.mark.long
@pytest.mark.parametrize("engine, steps", [("rigid", 600), ("corotated", 120)])
def test_a_wobbling_column_loses_the_resistance_times_its_weight_per_length_rolled(engine, steps):
    one, rim, rolled = wobble(engine, steps)
    energy, lost = one.energy(), RESISTANCE * one.system.weight * rolled
    assert rolled > 3 * rim.radius * steps / 600
    # the first step does not know the contact force yet
    assert energy["rolling"] == pytest.approx(-lost, rel=1e-3 + 1.5 / steps)
    # the sudden start takes (m g)^2 C / 2, the resistance all else
    assert abs(energy["contact"] + energy["impact"] + energy["friction"]) < 1e-4
    assert abs(energy["closure"]) < 1e-5 * one.energy()["kinetic"]


def test_wobbling_decays_as_steady_precession_does():
    """Quadrature of dE/dt = -c m g R rate(tilt) with E(tilt) of steady precession; the sudden
    resistance makes it nod a little about that.
    """
    one, rim, _ = wobble("rigid", 800)
    weight = one.system.weight

    def energy(tilt):
        return rim.energy(tilt, rim.untwisted(tilt))

    def rate(time, tilt):
        slope = (energy(tilt[0] + 1e-5) - energy(tilt[0] - 1e-5)) / 2e-5
        return [
            -RESISTANCE * weight * rim.radius * rim.rate(tilt[0], rim.untwisted(tilt[0])) / slope
        ]

    tilt = solve_ivp(rate, (0, one.state.time), [TILT], rtol=1e-9).y[0, -1]
    assert one.energy()["rolling"] == pytest.approx(energy(tilt) - energy(TILT), rel=0.02)
    assert np.arccos(one.state.rotation[0, 2, 2]) == pytest.approx(tilt, rel=0.05)


def test_planar_rocking_does_not_roll():
    system = coarse_system(
        integration={"dt_s": 1e-3},
        contact={"friction_coefficient": 0.8, "rolling_resistance": RESISTANCE},
    )
    one = begin_trial("rigid", system, lambda system: tilted(system, 0.03, 0.0))
    for _ in range(300):
        one.step()
    assert one.energy()["impact"] < 0 and abs(one.energy()["rolling"]) < 1e-3 * abs(
        one.energy()["impact"]
    )
