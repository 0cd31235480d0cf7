"""What was of a column alone, of several bodies: total Lagrangian, literal HHT, bases that yield,
pads, and rims that resist to roll; each against a closed form or one body of the same shape.
"""

from dataclasses import replace

import numpy as np
import pytest
from brick_bodies import GRAVITY, MARBLE, Structure, brick_body, closure, pulse
from mpi4py import MPI

from fecolumn.case.sections import Material
from fecolumn.contact.base_plate import BasePlate
from fecolumn.contact.points import GROUND
from fecolumn.contact.unbounded_base import unbounded_base
from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.resistance import Resistance
from fecolumn.fem.body import Body
from fecolumn.fem.corotated import Corotated
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.fem.total_lagrangian import TotalLagrangian
from fecolumn.verification.models import box

WHOLE, HALF = (1, 1, 4), (1, 1, 2)
SOFT = Material(youngs_modulus_pa=2e7, poissons_ratio=0.0, density_kg_m3=2000.0)


def pair(material=MARBLE, bricks=HALF, **further):
    """Two equal blocks, the one on the other; `further` of the upper one."""
    block = brick_body(0.4, 0.4, 0.6, bricks, material)
    return Structure(
        [("low", block, (0, 0, 0)), ("up", block, (0, 0, 0.6), further)],
        [(0, "foot", GROUND, None), (1, "foot", 0, "head")],
    )


def monolith(material=MARBLE):
    """One block with the nodes of both."""
    return Structure(
        [("whole", brick_body(0.4, 0.4, 1.2, WHOLE, material), (0, 0, 0))],
        [(0, "foot", GROUND, None)],
    )


def plate(half, thickness=0.1, bricks=4, material=SOFT):
    """Plate of 2 half x 2 half [m], held at its bottom."""
    lines = np.linspace(-half, half, bricks + 1)
    mesh = box(lines, lines, np.linspace(-thickness, 0, 3))

    def held(body):
        return {}, np.flatnonzero(body.all_X[:, 2] < -thickness + 1e-9)

    return BasePlate(Body(MPI.COMM_WORLD, mesh, material, 1, held))


@pytest.mark.long
def test_tangents_of_copies_are_of_each_body_as_it_is_turned():
    run = pair(SOFT).full(kinematics=TotalLagrangian)
    system, random = run.system, np.random.default_rng(2)
    bodies, turns = system.bodies, [[0.0, 0.3, 0.0], [0.5, -0.2, 0.8]]
    R = np.stack([rotation_matrix(turn) for turn in turns])
    x = np.concatenate([(bodies.X[rows]) @ turn.T for rows, turn in zip(bodies.rows, R)])
    forces = random.normal(size=x.shape)
    before = system.operators(system.hht.mass_factor, system.hht.stiffness_factor)
    into = np.concatenate([forces[rows] @ turn for rows, turn in zip(bodies.rows, R)])
    expected = before.factor.solve(into)
    expected = np.concatenate([expected[rows] @ turn.T for rows, turn in zip(bodies.rows, R)])
    fresh = system.refresh(before, x)
    assert len(set(fresh.factor.each)) == 2
    np.testing.assert_allclose(
        fresh.factor.solve(forces), expected, atol=1e-9 * abs(expected).max()
    )
    np.testing.assert_allclose(fresh.rotation, R, atol=1e-12)


@pytest.mark.long
def test_total_lagrangian_pair_moves_as_the_corotated_one_to_the_order_of_its_strain():
    grounds, off = pulse(2.0, 0.2, 120), []
    for stiff in (1.0, 10.0):
        material = replace(SOFT, youngs_modulus_pa=stiff * 2e7)
        rows = [
            pair(material).full(kinematics=kinematics).advance(grounds)[0]
            for kinematics in (TotalLagrangian, Corotated)
        ]
        off.append(np.abs(rows[0] - rows[1]).max() / np.abs(rows[1]).max())
    strain = SOFT.density_kg_m3 * 9.81 * 1.2 / 2e7
    assert 0 < off[0] < 5 * strain and off[1] < off[0] / 5


@pytest.mark.long
def test_total_lagrangian_pair_that_rocks_keeps_its_energy():
    run = pair(MARBLE, rotation=rotation_matrix([0, 0.02, 0]), velocity=np.zeros(3))
    run = run.full(kinematics=TotalLagrangian, stands=False)
    _, energies = run.advance(np.zeros((60, 3)))
    assert closure(energies) < 1e-6


def test_literal_hht_of_a_pair_is_that_of_one_body_and_keeps_the_energy():
    """As long as the joint stays shut it does no work, and alpha = 0 takes none."""
    found = []
    grounds = np.column_stack([np.zeros((200, 2)), 3.0 * np.sin(np.arange(200) * 0.5)])
    grounds[20:] = 0.0
    for one in (monolith(SOFT), pair(SOFT)):
        run = one.full(dt=1e-3, alpha=0.0, impact="none")
        tops = []
        for ground in grounds:
            run.state = run.stepper.step(run.state, ground)
            tops.append(run.state.x[:, 2].max())
        found.append(np.array(tops))
        energy = dict(zip(TERMS, run.ledger.row(run.state)))
        kept = abs(energy["base_work"])
        assert kept > 1e-2 and abs(energy["closure"]) < 1e-6 * kept
        assert max(abs(energy[name]) for name in ("contact", "impact", "friction")) < 1e-6 * kept
        assert abs(energy["algorithmic"]) < 1e-6 * kept
    moved = np.ptp(found[0])
    assert moved > 1e-5
    np.testing.assert_allclose(found[1], found[0], rtol=0, atol=1e-6 * moved)


def test_two_bodies_settle_on_a_plate_by_pressure_times_thickness_over_modulus():
    """Blocks that cover a plate without lateral strain press it evenly."""
    block = brick_body(0.4, 0.8, 0.5, (2, 4, 2), SOFT)
    both = Structure(
        [("left", block, (-0.2, 0, 0)), ("right", block, (0.2, 0, 0))],
        [(0, "foot", GROUND, None), (1, "foot", GROUND, None)],
    )
    run = both.full(base=plate(0.4))
    np.testing.assert_allclose(run.state.forces[:, 2].sum(), run.system.weight, rtol=1e-9)
    # a column shortens by H^2 / 2 on its top, H^2 / 3 on the mean, less what is linear in bricks
    H, h, strain = 0.5, 0.25, SOFT.density_kg_m3 * 9.81 / SOFT.youngs_modulus_pa
    sunk = strain * (H * 0.1 + H**2 / 3 - h**2 / 12)
    centers = run.system.bodies.centers(run.state.x)[:, 2] - H / 2
    np.testing.assert_allclose(-centers, sunk, rtol=1e-7)


def test_a_pair_settles_on_a_layer_as_one_body_does():
    found = []
    for one in (monolith(SOFT), pair(SOFT)):
        reference = np.concatenate([p.center + p.model.arms for p in one.model().parts[:1]])
        base = unbounded_base(0.1, np.linspace(0, -0.3, 4), SOFT, reference)
        run = one.full(base=base)
        found.append(run.system.bodies.centers(run.state.x)[:, 2].mean())
    assert found[0] < 0.6 - 1e-4
    assert found[1] == pytest.approx(found[0], abs=1e-8)


def test_rolling_on_a_body_resists_on_both_by_opposite_moments():
    run = pair(MARBLE, rotation=rotation_matrix([0.02, 0.01, 0]), spin=np.array([0.3, 0.2, 1.0]))
    run = run.full(stands=False)
    system, state = run.system, run.state
    joint = system.interface.interfaces[1]
    joint["rolling"], joint["radius"] = 0.01, 0.2
    state.contact["force"][system.interface.points["interface"] == 1, 2] = 100.0
    resistance = Resistance(system)
    a = resistance.acceleration(state, 1e-3)
    moments = []
    for rows, center in zip(system.bodies.rows, system.bodies.centers(state.x)):
        push = system.bodies.parts[0].momentum(a[rows])
        moments.append(np.cross(state.x[rows] - center, push).sum(axis=0))
        np.testing.assert_allclose(push.sum(axis=0), 0, atol=1e-9)
    assert np.linalg.norm(moments[0]) > 1e-3
    np.testing.assert_allclose(moments[0], -moments[1], atol=1e-9 * np.linalg.norm(moments[0]))
    v = state.v
    assert system.bodies.dot(v, system.bodies.momentum(a)) < 0  # it takes energy


def test_equilibrium_of_a_literal_pair_does_not_move():
    run = pair(SOFT).full(impact="none", alpha=-0.1)
    start = standing(run.system)
    run.advance(np.zeros((5, 3)))
    assert np.abs(run.state.x - start.x).max() < 1e-9 * np.abs(GRAVITY).max()
