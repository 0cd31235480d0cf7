"""Columns that start with a velocity or a spin."""

import numpy as np
import pytest
from small_block import ENGINES, G, block, centre, trial

from fecolumn.case.sections import Initial
from fecolumn.engines.dynamics.gravity import begin
from fecolumn.verification.trial import contact_nodes


def started(engine, system, **initial):
    return trial(engine, system, lambda system: begin(system, Initial(**initial)))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_pushed_puck_slides_v2_over_2_mu_g(engine):
    one = started(
        engine, block(0.3, 0.1, friction=0.2, plate=(0.5, 0.25)), velocity_m_s=(0.5, 0.0, 0.0)
    )
    first = centre(one)
    assert one.energy()["kinetic"] == pytest.approx(one.system.body.total_mass * 0.5**2 / 2)
    for _ in range(300):
        one.step()
    moved = centre(one) - first
    assert moved[0] == pytest.approx(0.5**2 / (2 * 0.2 * G), rel=1e-3)
    assert abs(moved[1]) < 1e-6
    assert one.energy()["friction"] == pytest.approx(
        -one.system.body.total_mass * 0.5**2 / 2, rel=1e-3
    )


@pytest.mark.parametrize(
    "engine, share, towards",
    [
        ("rigid", 0.98, (0.0, 1.0, 0.0)),
        ("rigid", 1.02, (0.0, 1.0, 0.0)),
        ("rigid", 1.02, (-1.0, 0.0, 0.0)),
        ("corotated", 0.9, (0.0, 1.0, 0.0)),
    ],
)
def test_a_block_spun_about_its_edge_overturns_beyond_the_energy_of_the_verge(
    engine, share, towards
):
    """I_O w^2 / 2 = m g (R - h) brings the centre of mass over the edge: w y tips towards +x, w x
    towards -y.
    """
    system = block(0.2, 0.6, friction=0.8, dt=2e-3)
    column, edge, height = system.body, 0.1, 0.3
    inertia = _about_edge(system, edge)
    verge = np.sqrt(2 * column.total_mass * G * (np.hypot(edge, height) - height) / inertia)
    one = started(engine, system, spin_rad_s=tuple(share * verge * np.array(towards)))
    assert one.energy()["kinetic"] == pytest.approx(inertia * (share * verge) ** 2 / 2, rel=1e-4)
    lean = np.array([towards[1], -towards[0], 0.0])
    critical, tilts = np.arctan2(edge, height), []
    for _ in range(1500):
        one.step()
        tilts.append(np.arcsin(one.state.rotation[0, :, 2] @ lean))
        if not -0.01 < tilts[-1] < 1.2 * critical:
            break
    returns = (
        critical - np.arccos(1 - (1 - share**2) * (1 - np.cos(critical)))
        if share < 1
        else 1.2 * critical
    )
    assert max(tilts) == pytest.approx(returns, rel=0.03)


def _about_edge(system, edge):
    column = system.body
    turn = np.cross([0.0, 1.0, 0.0], column.X - [edge, 0.0, 0.0])
    return column.dot(turn, column.apply(column.mass, turn))


@pytest.mark.parametrize("engine", ENGINES)
def test_a_spin_about_the_axis_lasts_without_friction(engine):
    one = started(engine, block(0.3, 0.1, friction=0.0), spin_rad_s=(0.0, 0.0, 2.0))
    kinetic, turned = one.energy()["kinetic"], [0.0]
    for _ in range(300):
        one.step()
        turned.append(np.arctan2(one.state.rotation[0, 1, 0], one.state.rotation[0, 0, 0]))
    assert turned[-1] == pytest.approx(0.6, rel=1e-5)
    assert one.energy()["kinetic"] == pytest.approx(kinetic, rel=1e-5)
    assert np.abs(centre(one)[:2]).max() < 1e-9


@pytest.mark.parametrize("engine", ENGINES)
def test_a_tilted_column_spins_about_the_point_on_which_it_stands(engine):
    """The velocity of a tilted start is that of its contact point: nothing slips or strikes in the
    first step.
    """
    system = block(0.2, 0.6, friction=0.8)
    one = started(engine, system, tilt_rad=0.1, spin_rad_s=(0.0, -0.5, 0.0))
    at_rest = started(engine, system, tilt_rad=0.1)
    toes = system.interface.reference[:, 0] > 0
    assert np.abs(one.state.v[contact_nodes(system)[0][toes]]).max() < 1e-12
    assert one.energy()["kinetic"] == pytest.approx(_about_edge(system, 0.1) * 0.5**2 / 2, rel=1e-6)
    assert one.mechanical() - at_rest.mechanical() == pytest.approx(one.energy()["kinetic"])
    one.step()
    assert one.energy()["impact"] == pytest.approx(0, abs=1e-6 * one.energy()["kinetic"])
