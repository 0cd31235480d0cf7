"""A round column that wobbles or passes upright beside planar rocking: it rolls, however fast, and
rolling takes nothing.
"""

import numpy as np
import pytest
from pair import column, reduced, system_of, tilted_motion
from rolling_column import roll

from fecolumn.verification.rolling_rim import RollingRim
from fecolumn.verification.trial import RigidRocking

STIFF = {"youngs_modulus_pa": 2e13}


def turning(engine, rim, tilt, spin):
    """Motion of a column that leans by `tilt` [rad] towards +x and turns with `spin` (3,) [rad/s]
    about the lowest point of its rim.
    """
    motion = tilted_motion(engine, tilt, 0.0)
    motion.frames["velocity"] = np.cross(spin, motion.rotation[0] @ [-rim.radius, 0.0, rim.height])
    motion.frames["spin"] = motion.rotation[0].T @ spin
    return motion


def passing(dt, spin, modes=0, stiff=STIFF):
    """Rows of a column released from 0.3 of its slenderness with a spin [rad/s] across until it has
    passed upright by nearly as much; its rim, tilt, Housner's loss.
    """
    system = system_of(
        integration={"dt_s": dt}, contact={"friction_coefficient": 0.8}, material=stiff, base=stiff
    )
    rocking, rim = RigidRocking(system), RollingRim.of(system)
    tilt = 0.3 * rocking.slenderness
    engine = reduced(
        system, modes, begin=lambda engine: turning(engine, rim, tilt, np.array([spin, 0.0, 0.0]))
    )
    rows, _ = engine.advance(np.zeros((round(1.45 * rocking.quarter_period(tilt) / dt), 3)))
    return rows, rim, tilt, (1 - rocking.restitution**2) * rocking.energy(tilt), engine


def lost(rows):
    """Energy [J] lost once the sudden start has faded."""
    mechanical = sum(column(rows, f"energy/{term}") for term in ("kinetic", "strain", "gravity"))
    return mechanical[len(rows) // 8] - mechanical[-1]


@pytest.mark.long
@pytest.mark.parametrize("spin", [0.01, 0.002, 0.0006])
def test_a_stiff_column_passes_upright_as_one_that_rolls_and_loses_nothing(spin):
    """At tilts down to 1e-4 rad in steps of 1 ms, in which the lowest point would run half around
    the rim: as the exact rolling body, whose energy is kept.
    """
    rows, rim, tilt, housner, engine = passing(1e-3, spin)
    axes, first, last = roll(rim, tilt, [spin, 0.0, 0.0], column(rows, "time")[-1])
    assert last == pytest.approx(first, rel=1e-8)
    assert abs(lost(rows)) < 0.01 * housner and engine.record.impacts == 0
    # it has turned round by almost half a circle: to the side to which it rolls
    way = column(rows, "u_top", 2)[-1]
    assert np.arctan2(way[1], way[0]) == pytest.approx(
        np.arctan2(axes[1, -1], axes[0, -1]), abs=5e-3
    )
    assert column(rows, "tilt")[-1] == pytest.approx(np.hypot(*axes[:, -1]), rel=0.01)


def test_a_steel_column_passes_upright_at_a_small_tilt_without_an_impact():
    rows, _, _, housner, engine = passing(1e-3, 0.005, 30, {})
    assert lost(rows) < 0.1 * housner and engine.record.impacts == 0


def test_planar_rocking_over_is_an_impact_and_one_step():
    """Housner's loss of a stiff column; no part of a step for it, and none for what leads up to
    it.
    """
    rows, _, _, housner, engine = passing(1e-3, 0.0)
    assert lost(rows) == pytest.approx(housner, rel=0.05)
    assert engine.record.impacts > 0 and engine.record.parts == 0


@pytest.mark.long
@pytest.mark.parametrize("share", [1.0, 0.5, 0.2])
def test_a_steel_column_that_wobbles_at_a_small_tilt_loses_next_to_nothing(share):
    """Three revolutions from a tilt of 5 mrad, steadily or down to 0.7 mrad, at the share of the
    steady rate: the contact widens and narrows on the way.
    """
    system = system_of(integration={"dt_s": 1e-3}, contact={"friction_coefficient": 0.8})
    rim, tilt = RollingRim.of(system), 0.005
    spin = rim.untwisted(tilt)
    engine = reduced(
        system,
        begin=lambda engine: turning(engine, rim, tilt, share * rim.angular_velocity(tilt, spin)),
    )
    rows, _ = engine.advance(np.zeros((round(6 * np.pi / rim.rate(tilt, spin) / 1e-3), 3)))
    assert abs(lost(rows)) < 3e-3 * rim.energy(tilt, spin) and engine.record.impacts == 0
