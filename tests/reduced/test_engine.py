"""The reduced engine moves as the full-order engine does, and books every joule."""

import numpy as np
import pytest
from pair import column, reduced, system_of, tilted_motion, tops

from fecolumn.engines.dynamics import gravity
from fecolumn.verification.models import shaking
from fecolumn.verification.trial import RigidRocking


@pytest.mark.long
def test_free_rocking_is_that_of_the_full_engine():
    """Released at 0.4 of the critical tilt, over the first impact: top within 1e-4 of its peak,
    same loss within 0.5 %.
    """
    system = system_of(integration={"dt_s": 1e-3}, contact={"friction_coefficient": 0.8})
    tilt, still = 0.4 * RigidRocking(system).slenderness, np.zeros((400, 3))
    engine = reduced(system, begin=lambda engine: tilted_motion(engine, tilt, 0.0))
    rows, lost = engine.advance(still)
    path, trial = tops(system, still, lambda system: gravity.tilted(system, tilt, 0.0))
    assert not lost and engine.record.impacts > 0
    assert np.abs(column(rows, "u_top", 3) - path).max() < 1e-4 * np.abs(path).max()
    assert column(rows, "energy/impact")[-1] == pytest.approx(trial.energy()["impact"], rel=5e-3)
    moved = np.ptp(column(rows, "energy/gravity"))
    assert np.abs(column(rows, "energy/closure")).max() < 1e-9 * moved
    # rolling on one point: of the third order of a step
    taken = sum(column(rows, f"energy/{term}") for term in ("friction", "impact", "contact"))
    created = np.maximum(np.diff(taken, prepend=0.0), 0.0) / (
        system.weight * system.body.all_X[:, 2].max()
    )
    assert created.sum() < 1e-7 and created.max() < 1e-9


@pytest.mark.parametrize("alpha", [0.0, pytest.param(-0.1, marks=pytest.mark.slow)])
def test_shaken_column_slides_rocks_and_wobbles_as_in_the_full_engine(alpha):
    """Eight impacts and a slide in 0.2 s: top within 1e-3 of its peak; contact takes energy
    only.
    """
    system = system_of(
        integration={"dt_s": 1e-3, "alpha_hht": alpha}, base={"length_m": 0.4, "width_m": 0.4}
    )
    grounds = shaking(1e-3 * np.arange(1, 201))
    engine = reduced(system)
    rows, _ = engine.advance(grounds)
    path, trial = tops(system, grounds)
    assert engine.record.impacts > 0
    assert np.abs(column(rows, "u_top", 3) - path).max() < 1e-3 * np.abs(path).max()
    assert column(rows, "energy/friction")[-1] == pytest.approx(
        trial.energy()["friction"], rel=0.02
    )
    assert np.abs(column(rows, "energy/closure")).max() < 1e-12
    taken = sum(column(rows, f"energy/{term}") for term in ("friction", "impact", "contact"))
    # rolling on several points gives and takes, as in the full engine; the bounds are those of the
    # ledger's verification, of a run and of a step
    created = np.maximum(np.diff(taken, prepend=0.0), 0.0) / (
        system.weight * system.body.all_X[:, 2].max()
    )
    assert created.sum() < 1e-6 and created.max() < 3e-7


@pytest.mark.parametrize(
    "dt, alpha",
    [
        (0.02, 0.0),
        pytest.param(0.02, -0.333, marks=pytest.mark.slow),
        (1e-3, 0.0),
        (1e-3, -0.2),
        (1e-4, -0.05),
    ],
)
def test_standing_column_neither_drifts_nor_gains_energy(dt, alpha):
    engine = reduced(system_of(integration={"dt_s": dt, "alpha_hht": alpha}))
    before = engine.motion.frames["center"].copy()
    rows, _ = engine.advance(np.zeros((3000, 3)))
    assert np.abs(engine.motion.frames["center"] - before).max() < 1e-10
    energy = (
        sum(column(rows, f"energy/{term}") for term in ("kinetic", "strain", "gravity"))
        - engine.ledger[0]
    )
    assert energy.max() < 1e-9


@pytest.mark.slow
def test_more_modes_converge_to_the_full_engine():
    """0.05 s of shaking at dt = 1e-4, which resolves modes up to 3 kHz: the error falls with the
    modes kept.
    """
    system = system_of(integration={"dt_s": 1e-4}, contact={"friction_coefficient": 0.8})
    times = 1e-4 * np.arange(1, 501)
    grounds = np.stack([4 * np.sin(30 * times), 3 * np.sin(40 * times), 0 * times], axis=1)
    path, _ = tops(system, grounds)
    errors = [
        np.abs(column(reduced(system, modes).advance(grounds)[0], "u_top", 3) - path).max()
        for modes in (0, 10, 100)
    ]
    assert errors[2] < 0.1 * errors[0] and errors[2] < errors[1]
    assert errors[2] < 1e-5 * np.abs(path).max()


def test_rolling_on_the_round_rim_takes_no_energy():
    system = system_of(integration={"dt_s": 1e-3}, contact={"friction_coefficient": 0.8})
    spin = np.array([0.8, 0.3, 0.0])

    def begin(engine):
        motion = tilted_motion(engine, 0.04, 0.3)
        pivot = np.array([np.cos(0.3), np.sin(0.3), 0.0]) * 0.0508
        motion.frames["velocity"] = np.cross(spin, motion.frames["center"] - pivot)
        motion.frames["spin"] = motion.rotation[0].T @ spin
        return motion

    engine = reduced(system, begin=begin)
    first = engine.mechanical()
    engine.advance(np.zeros((100, 3)))
    assert abs(engine.mechanical() - first) < 1e-3 * engine.row()[17]
