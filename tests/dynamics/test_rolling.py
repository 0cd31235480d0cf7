"""A column that rolls around on its rim."""

import numpy as np
import pytest
from coarse_column import coarse_system

from fecolumn.engines.dynamics.checkpoint import read_checkpoint, write_checkpoint
from fecolumn.engines.dynamics.energy import Ledger
from fecolumn.engines.dynamics.gravity import tilted
from fecolumn.engines.dynamics.stepper import Stepper
from fecolumn.verification.rolling_rim import RollingRim
from fecolumn.verification.trial import RigidRocking, Trial
from fecolumn.verification.wobbling import rolling


def started(tilt=0.003):
    system = coarse_system(integration={"dt_s": 1e-3}, contact={"friction_coefficient": 0.8})
    rim = RollingRim.of(system)
    state = rolling(rim, tilt, rim.untwisted(tilt))(system)
    ledger = Ledger(system)
    ledger.open(state)
    return system, state, ledger


@pytest.mark.long
def test_rolling_past_twenty_nodes_loses_what_the_sudden_start_does_and_no_more(tmp_path):
    """At a tilt of 3 mrad the contact is several nodes wide; a polygon loses 3 % here, the start (m
    g)^2 C / 2 half as stress.
    """
    system, state, ledger = started()
    stepper, rest = Stepper(system, ledger), np.zeros(3)
    for _ in range(10):
        state = stepper.step(state, rest)
    early, kinetic = sum(ledger.state_terms(state).values()), ledger.state_terms(state)["kinetic"]
    for _ in range(100):
        state = stepper.step(state, rest)
    assert abs(sum(ledger.state_terms(state).values()) - early) < 1e-3 * kinetic
    assert np.isfinite(state.rims["angle"][0])

    write_checkpoint(tmp_path / "state.npz", system, state, {})
    again, _ = read_checkpoint(tmp_path / "state.npz", system)
    goes_on, restarted = (stepper.step(one, rest) for one in (state, again))
    assert np.array_equal(goes_on.x, restarted.x)


@pytest.mark.long
def test_a_stiff_column_passes_upright_at_a_tilt_of_a_tenth_of_a_milliradian_without_loss():
    """Released from a tenth of its slenderness with a spin across: in steps of 1 ms, the fastest of
    them made in parts, it loses nothing of Housner's loss.
    """
    stiff, spin = {"youngs_modulus_pa": 2e13}, 1.2e-3
    system = coarse_system(
        integration={"dt_s": 1e-3},
        contact={"friction_coefficient": 0.8},
        material=stiff,
        base=stiff,
    )
    rocking, radius = RigidRocking(system), RollingRim.of(system).radius
    tilt = 0.1 * rocking.slenderness

    def released(system):
        state = tilted(system, tilt, 0.0)
        state.v = np.cross([spin, 0.0, 0.0], state.x - [radius, 0.0, 0.0])
        return state

    trial = Trial(system, released)
    steps = round(1.6 * rocking.quarter_period(tilt) / 1e-3)
    energies, tilts = np.array(
        [(trial.mechanical(), np.hypot(*trial.step().rotation[0, :2, 2])) for _ in range(steps)]
    ).T
    assert tilts.min() < 1.2e-4
    assert abs(energies[steps // 6] - trial.mechanical()) < 0.01 * (
        1 - rocking.restitution**2
    ) * rocking.energy(tilt)
    record = trial.stepper.record
    assert record.parts > 0 and record.impacts == 0 and abs(trial.state.time - steps * 1e-3) < 1e-12
