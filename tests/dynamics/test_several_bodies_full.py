"""Bodies on moving ones with all their degrees of freedom: stacks, frames and links, against closed
forms and the reduced engine.
"""

from dataclasses import replace

import numpy as np
import pytest
from brick_bodies import FullRun, Structure, brick_body, closure, frame, pulse, stack

from fecolumn.case.sections import Material
from fecolumn.contact.points import GROUND, SUNK
from fecolumn.engines.dynamics.checkpoint import read_checkpoint, write_checkpoint
from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.stage import Stage
from fecolumn.engines.reduced.observe import ENERGY, PER_BODY, WIDTH
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.structures.model import LinkModel

G = 9.81
# Difference by which the engines may part, displacement [m] and tilt [rad]: ten times what steps of
# 1e-3 to 2.5e-4 s and 100 or all modes leave, the full order's unbalanced force of 1e-7 of the
# weight
AGREES = 2e-7


@pytest.mark.parametrize("alpha", [0.0, -0.2])
def test_a_stack_of_elastic_blocks_carries_its_weight_and_rests(alpha):
    run = stack().full(alpha=alpha)
    low, up = (part.model.mass * G for part in run.model.parts)
    forces, points = run.state.forces[:, 2], run.system.interface.points
    assert forces[points["slave"] == 0].sum() == pytest.approx(low + up, rel=1e-8) and forces[
        points["slave"] == 1
    ].sum() == pytest.approx(up, rel=1e-8)
    rows, energies = run.advance(np.zeros((50, 3)))
    assert np.abs(rows - rows[0]).max() < 1e-12 and np.abs(energies[:, -1]).max() < 1e-10


@pytest.mark.parametrize(
    "height, pressed, stays_open",
    [
        (-0.1, False, True),
        (-5e-3, False, False),
        (-1e-6, False, False),
        (-1e-6, True, False),
        (1e-6, True, False),
    ],
)
def test_a_point_that_comes_back_from_beyond_an_edge_stays_open_at_the_side_alone(
    height, pressed, stays_open
):
    """At the side it is nearer to the edge than to the surface; pressed: whether others carry."""
    run = stack().full()
    interface, state, x, contact = (
        run.system.interface,
        run.state,
        run.state.x.copy(),
        run.state.contact.copy(),
    )
    point = np.flatnonzero(interface.points["slave"] == 1)[0]
    contact["beyond"][point], contact["force"][point] = True, 0.0
    if not pressed:
        contact["force"] = 0.0
    x[run.system.bodies.rows[1], 2] += height - state.contact["relative"][point, 2]
    before, _, _ = interface.begin_step(replace(state, x=x, contact=contact), state.rotation, True)
    kept = np.zeros(len(before), bool)
    kept[point] = stays_open
    assert ((interface.points["beyond"] == SUNK) == kept).all() and (before["beyond"] == kept).all()


@pytest.mark.parametrize("columns", [2, 4])
def test_a_slab_of_bricks_rests_on_more_columns_than_it_needs(columns):
    run = frame(columns).full()
    rows, _ = run.advance(np.zeros((30, 3)))
    points = run.system.interface.points
    weight = sum(part.model.mass for part in run.model.parts) * G
    # a step ends with an unbalanced force of 1e-7 of the weight at most at a node, which moves a
    # free body by 5e-10 m in this time
    assert run.state.forces[points["master"] == GROUND, 2].sum() == pytest.approx(weight, rel=1e-6)
    assert np.abs(rows - rows[0]).max() < 5e-10


@pytest.mark.long
@pytest.mark.parametrize("push, uplifts", [(0.95, False), (1.1, True)])
def test_a_frame_of_bricks_uplifts_when_the_ground_accelerates_by_g_tan_alpha(push, uplifts):
    """Makris and Vassiliou (2013): columns of slenderness alpha under a slab uplift together at g
    tan(alpha), whatever the slab's mass.
    """
    ground = np.zeros((220, 3))
    ground[:, 0] = push * G * 0.2 / 1.2 * np.minimum(np.arange(220) / 150, 1.0)
    rows, _ = frame(2).full().advance(ground)
    assert (rows[-1, :2, 3] > 3e-4).all() == uplifts and (rows[-1, :2, 3] < 1e-4).all() != uplifts


def rocking(share=0.3):
    """The stack at rest, its upper block given a share of the spin that would just overturn it,
    about an edge of its foot.
    """
    breadth, height = 0.3, 0.9
    spin = np.array(
        [
            0.0,
            share * np.arctan(breadth / height) * np.sqrt(1.5 * G / np.hypot(breadth, height)),
            0.0,
        ]
    )
    return stack(spin=spin, velocity=np.cross(spin, [-breadth / 2, 0.0, height / 2]))


def until_the_third_impact(step, record, most=600):
    rows = []
    while record().impacts < 3 and len(rows) < most:
        rows.append(step())
    assert record().impacts >= 3
    return np.array(rows)


@pytest.fixture(scope="module")
def rocked():
    """The rocking stack in full order until its third impact: the run, rows, the ledger."""
    run, energies = rocking().full(), []

    def step():
        row, energy = run.advance(np.zeros((1, 3)))
        energies.append(energy[0])
        return row[0]

    rows = until_the_third_impact(step, lambda: run.stepper.record)
    return run, rows, np.array(energies)


@pytest.mark.parametrize("modes", [100, 129])
def test_full_order_and_reduced_stacks_agree_until_the_third_impact(rocked, modes):
    """129 elastic modes are all there are."""
    rows = rocked[1]
    made = rocking().reduced(modes=modes)
    other = until_the_third_impact(
        lambda: made.advance(np.zeros((1, 3)))[0][0], lambda: made.record
    )[:, WIDTH : WIDTH + 2 * PER_BODY].reshape(-1, 2, PER_BODY)[..., :4]
    assert len(other) == len(rows) and rows[:, 1, 3].max() > 0.01
    np.testing.assert_allclose(other, rows, rtol=0, atol=AGREES)


def test_energy_of_a_rocking_stack_of_bricks_is_accounted_for(rocked):
    """However far bodies turn within a step: the work of internal forces is the change of the
    strain energy.
    """
    _, _, energies = rocked
    moved = np.ptp(energies[:, TERMS.index("gravity")])
    assert np.abs(energies[:, -1]).max() < 1e-9 * moved
    # contact makes no energy: what is not friction or impact takes some
    assert (
        energies[-1, TERMS.index("contact")] < 1e-6 * moved
        and energies[-1, TERMS.index("impact")] < 0
    )


def test_internal_forces_neither_make_energy_nor_turn_a_body_that_spins_in_the_air():
    """A soft bar, thrown with a fast spin about a skew axis and struck by nothing: it stretches and
    vibrates by the spin, and turns by 0.06 rad in a step.

    Means of forces in the table frame leave 3e-3 of the kinetic energy unaccounted for, whatever
    the stiffness, and turn the angular momentum by 5e-4.
    """
    soft = Material(youngs_modulus_pa=1e9, poissons_ratio=0.3, density_kg_m3=1000.0)
    bar = brick_body(0.1, 0.1, 0.6, (1, 1, 4), soft)
    thrown = dict(spin=np.array([30.0, 50.0, 5.0]), velocity=np.array([0.3, 0.0, 2.0]))
    run = Structure([("bar", bar, (0, 0, 1.0), thrown)], [(0, "foot", GROUND, None)]).full(
        alpha=0.0, stands=False
    )
    column = run.system.bodies

    def angular_momentum(state):
        return np.cross(state.x - column.centers(state.x), column.momentum(state.v)).sum(axis=0)

    start, kinetic = angular_momentum(run.state), run.ledger.state_terms(run.state)["kinetic"]
    _, energies = run.advance(np.zeros((100, 3)))
    assert energies[:, TERMS.index("strain")].max() > 3e-4 * kinetic
    assert (
        np.abs(energies[:, -1]).max() < 1e-6 * kinetic
        and np.abs(energies[:, TERMS.index("algorithmic")]).max() < 1e-6 * kinetic
    )
    assert np.linalg.norm(angular_momentum(run.state) - start) < 1e-4 * np.linalg.norm(start)


@pytest.mark.parametrize(
    "columns, order, steps",
    [(2, [2, 0, 1], 200), pytest.param(4, [3, 1, 4, 0, 2], 120, marks=pytest.mark.slow)],
)
def test_full_order_motion_does_not_depend_on_the_order_of_bodies_and_contacts(
    columns, order, steps
):
    ground = pulse(4.0, 1.0, steps)
    first, other = (frame(columns, numbers).full().advance(ground)[0] for numbers in (None, order))
    assert first[-1, 0, 3] > 5e-4
    np.testing.assert_allclose(other[:, order], first, rtol=0, atol=1e-10)


def test_a_structure_goes_on_from_a_checkpoint_as_if_nothing_had_happened(tmp_path):
    run = rocking().full()
    run.advance(np.zeros((60, 3)))
    write_checkpoint(
        tmp_path / "state.npz", run.system, run.state, {"work": list(run.ledger.work.values())}
    )
    whole, _ = run.advance(np.zeros((90, 3)))
    other = rocking().full()
    state, extra = read_checkpoint(tmp_path / "state.npz", other.system)
    assert len(extra["work"]) == len(TERMS) - 4
    resumed, _ = FullRun(other.system, other.model, state=state).advance(np.zeros((90, 3)))
    np.testing.assert_allclose(resumed, whole, rtol=0, atol=1e-10)


def test_a_standing_stack_steps_by_its_stick_operator_and_without_it_in_a_step_that_is_cut():
    run, shaken = stack().full(), np.outer(0.5 * np.sin(0.05 * np.arange(1, 21)), [1.0, 0.3, 0.0])
    run.advance(shaken)
    whole, hht = run.stepper.step(run.state.copy(), shaken[-1]), run.system.hht
    assert (
        run.system.interface.stay.stick.key[1] == 1.0 and run.stepper.record.contact_iterations > 0
    )
    halved = run.stepper._hht_step(run.state.copy(), shaken[-1], HHT(hht.dt / 2, hht.alpha))
    assert (
        np.abs(halved.x - run.state.x).max() > 0
        and np.abs(2 * (halved.x - run.state.x) - (whole.x - run.state.x)).max() < 1e-7
    )


def tie(**settings):
    values = dict(
        name="tie",
        kind="spring",
        a=0,
        arm_a=np.array([0.0, 0, 0.4]),
        b=GROUND,
        arm_b=np.array([0.0, 0, 3.0]),
        stiffness=2e4,
        damping=0.0,
        prestress=0.0,
        slack=0.0,
        pushes=True,
        pulls=True,
        yield_n=np.inf,
        breaking_n=np.inf,
    )
    return LinkModel(**{**values, **settings})


def tied(link):
    return Structure(
        [("block", brick_body(0.3, 0.3, 0.8, (1, 1, 2)), (0, 0, 0))],
        [(0, "foot", GROUND, None)],
        [link],
    )


def test_a_tight_tendon_presses_a_block_of_bricks_down():
    run = tied(tie(kind="tendon", arm_b=np.zeros(3), prestress=500.0, pushes=False)).full()
    assert run.state.forces[:, 2].sum() == pytest.approx(run.system.weight + 500.0, rel=1e-5)


@pytest.mark.parametrize(
    "settings", [{}, dict(slack=0.002, damping=300.0), dict(yield_n=20.0), dict(breaking_n=30.0)]
)
def test_links_do_the_same_in_full_order_and_reduced(settings):
    ground = pulse(8.0, 0.5, 150)
    run, made = tied(tie(**settings)).full(), tied(tie(**settings)).reduced()
    rows, energies = run.advance(ground)
    other = made.advance(ground)[0]
    np.testing.assert_allclose(rows[:, 0, 3], other[:, WIDTH + 3], rtol=0, atol=AGREES)
    links = TERMS.index("links")
    assert energies[-1, links] == pytest.approx(other[-1, ENERGY + links], rel=1e-3, abs=1e-9)
    assert (energies[-1, links] < -1e-3) == bool(
        {"damping", "yield_n", "breaking_n"} & set(settings)
    )
    assert closure(energies) < 1e-9
    assert run.state.ties["broken"] == made.motion.ties["broken"] and rows[:, 0, 3].max() > 0.01
    assert energies[-1, TERMS.index("damping")] == 0.0 and run.state.ties["work"][
        0
    ] == pytest.approx(-energies[-1, links], rel=1e-12, abs=1e-15)
    for name in ("length", "flowed", "force", "work"):
        np.testing.assert_allclose(
            run.state.ties[name], made.motion.ties[name], rtol=1e-3, atol=AGREES, err_msg=name
        )


def ringing():
    """Two columns below a soft slab that overhangs on one side, let go unstrained and shaken:
    motion and energies in full order.
    """
    soft = Material(youngs_modulus_pa=1e8, poissons_ratio=0.2, density_kg_m3=2700.0)
    column, slab = brick_body(0.2, 0.2, 1.2, (1, 1, 2)), brick_body(2.8, 0.6, 0.3, (14, 3, 1), soft)
    bodies = [
        ("left", column, (-1.0, 0, 0)),
        ("right", column, (0.6, 0, 0)),
        ("slab", slab, (0, 0, 1.2)),
    ]
    structure = Structure(
        bodies,
        [
            (0, "foot", GROUND, None),
            (1, "foot", GROUND, None),
            (0, "head", 2, "foot"),
            (1, "head", 2, "foot"),
        ],
    )
    return structure.full(stands=False).advance(pulse(4.0, 0.5, 120))


def test_energy_of_a_frame_whose_slab_rings_is_accounted_for():
    """Its mean rotation, and what takes away the moment of internal forces, have no work on the
    strain: 1e-8 and more would be left where they had.
    """
    rows, energies = ringing()
    assert (
        np.ptp(energies[:, TERMS.index("strain")])
        > 0.1 * np.ptp(energies[:, TERMS.index("gravity")])
        and rows[:, 0, 3].max() > 1e-3
    )
    assert closure(energies) < 1e-10


def test_forces_on_a_bent_body_are_the_gradients_of_its_energy_and_of_the_places_of_its_points():
    """Else a body that is strained turns by its own internal forces, or contact forces right it
    with the levers of other points than those they act on.
    """
    bar = Structure(
        [
            (
                "bar",
                brick_body(
                    0.4,
                    0.2,
                    1.0,
                    (2, 1, 3),
                    Material(youngs_modulus_pa=1e8, poissons_ratio=0.2, density_kg_m3=2700.0),
                ),
                (0, 0, 0),
            )
        ],
        [(0, "foot", GROUND, None)],
    )
    run, random = bar.full(), np.random.default_rng(1)
    system, column, interface = run.system, run.system.bodies, run.system.interface
    X = column.placed
    x = (
        X + 0.05 * np.column_stack([X[:, 2] ** 2, X[:, 0] * X[:, 2], X[:, 1] - X[:, 0] ** 2])
    ) @ rotation_matrix([0.1, 0.2, 0.3]).T
    R, internal, _ = system.kinematics.internal(x)
    interface.positions(x, R, interface.poses(x, R))
    forces = 1e3 * random.normal(size=(interface.size, 3))
    stage, push = (
        Stage(x, 0.0, x, 1.0, run.state.contact, np.inf, R, turns=True),
        interface.load(forces, R),
    )
    straight, led = (
        column.momentum(one)
        for one in stage.twist_corrections_at(system, x, internal, R, R, forces, push)
    )
    for way in random.normal(size=(3, *x.shape)):
        ends = [x + sign * 1e-6 * way for sign in (1, -1)]
        energy = [system.kinematics.internal(end)[2] for end in ends]
        places = [
            np.vdot(
                forces,
                interface.at_points(interface.node_positions(end, system.kinematics.rotation(end))),
            )
            for end in ends
        ]
        assert (energy[0] - energy[1]) / 2e-6 == pytest.approx(
            np.vdot(internal - straight, way), rel=1e-6
        )
        assert (places[0] - places[1]) / 2e-6 == pytest.approx(np.vdot(push + led, way), rel=1e-6)
        assert abs(np.vdot(led, way)) > 1e-4 * abs(np.vdot(push, way))


def test_a_slack_link_of_no_length_gives_way_and_pulls_back():
    """A tendon between a point of a block and the ground at the same place, as a wire rope in a
    hook: no direction at the start, and none of the numbers is nan.
    """
    hook = dict(kind="tendon", arm_b=np.array([0.0, 0, 0.8]), slack=0.002, pushes=False)
    run, made = tied(tie(**hook)).full(), tied(tie(**hook)).reduced()
    ground = pulse(8.0, 0.5, 150)
    rows, energies = run.advance(ground)
    np.testing.assert_allclose(
        rows[:, 0, 3], made.advance(ground)[0][:, WIDTH + 3], rtol=0, atol=AGREES
    )
    assert (
        rows[:, 0, 3].max() > 2e-3
        and run.state.ties["length"][0] > 0.002
        and closure(energies) < 1e-9
    )
