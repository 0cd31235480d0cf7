"""Bodies that stand, rock and slide on moving ones, against closed forms: stacks, frames, links."""

from dataclasses import replace

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.points import GROUND
from fecolumn.engines.reduced.observe import ENERGY, OF_BODY, WIDTH
from fecolumn.engines.reduced.start import of_parts
from fecolumn.engines.reduced_engine import GRAVITY_DOWN
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.structures.model import LinkModel
from fecolumn.verification.boxes import (
    block_on_a_heavy_one,
    box_model,
    engine,
    frame,
    joint,
    part,
    sine_pulse,
    stack,
)
from fecolumn.verification.several_bodies import closure

G = GRAVITY


@pytest.mark.parametrize("alpha", [0.0, -0.2])
def test_a_stack_carries_its_weight_and_rests(alpha):
    made = stack(alpha=alpha)
    low, up = (body["mass"] * G for body in made.structure.bodies.body)
    forces = made.motion.forces[:, 2]
    assert forces[:4].sum() == pytest.approx(low + up, rel=1e-8) and forces[
        4:
    ].sum() == pytest.approx(up, rel=1e-8)
    rows, over = made.advance(np.zeros((500, 3)))
    assert not over and np.abs(rows[:, 1:4] - rows[0, 1:4]).max() < 1e-11


@pytest.mark.parametrize("columns", [2, 4])
def test_a_slab_rests_on_more_columns_than_it_needs(columns):
    made, slab, column = frame(columns)
    rows, over = made.advance(np.zeros((500, 3)))
    weight = (slab.mass + columns * column.mass) * G
    assert not over and np.abs(rows[:, 1:4] - rows[0, 1:4]).max() < 1e-11
    assert rows[-1, 10] == pytest.approx(weight, rel=1e-9)


# place of the tilt among the columns of a body, and how many these are
TILT, OF_ONE = 3, sum(count for _, count in OF_BODY)


def test_a_block_rocks_on_a_heavy_one_as_on_the_ground():
    """Housner (1963): quarter period acosh(1 / (1 - theta / alpha)) / p; an impact leaves (1 - 3/2
    sin^2 alpha)^2 of the energy.
    """
    dt = 5e-4
    made, alpha, p = block_on_a_heavy_one(dt)
    tilt = made.advance(np.zeros((1000, 3)))[0][:, 4]
    top = np.argmax(tilt[:500])
    quarter = np.arccosh(1 / (1 - tilt[top] / alpha)) / p
    back = top + np.argmin(tilt[top : top + int(1.3 * quarter / dt)])
    assert (back - top) * dt == pytest.approx(quarter, abs=4 * dt)
    again = tilt[back : back + int(1.2 * quarter / dt)].max()
    energy = [np.cos(alpha - most) - np.cos(alpha) for most in (tilt[top], again)]
    assert energy[1] / energy[0] == pytest.approx((1 - 1.5 * np.sin(alpha) ** 2) ** 2, rel=2e-3)


def test_energy_of_a_stack_in_which_both_blocks_rock_is_accounted_for():
    made = stack()
    rows, _ = made.advance(sine_pulse(7.0, 0.66, 1000))
    assert rows[:, WIDTH + TILT].max() > 0.05
    assert rows[:, WIDTH + OF_ONE + TILT].max() > 0.1
    assert closure(rows) < 1e-11
    # contact makes no energy: what is not friction or impact takes some
    assert rows[-1, ENERGY + 6] < 1e-6 * np.ptp(rows[:, ENERGY + 2])


@pytest.mark.parametrize("seed", [1, 7])
def test_a_stack_shaken_to_pieces_never_gains_by_contact(seed):
    """Blocks slide over the edges of one another, tilt there and come back: impact and friction
    only take, contact makes no more than its solver leaves.
    """
    random, t = np.random.default_rng(seed), np.arange(1, 1501) * 1e-3
    ground = np.zeros((1500, 3))
    for axis in (0, 1):
        for frequency in (1.0, 2.3, 4.1):
            ground[:, axis] += (
                7 * random.normal() * np.sin(2 * np.pi * frequency * t + random.uniform(0, 6))
            )
    ground[:, 2] = 2.8 * np.sin(10 * np.pi * t)
    made = stack()
    rows, _ = made.advance(ground)
    moved = np.ptp(rows[:, ENERGY + 2])
    friction, impact, contact = np.diff(rows[:, ENERGY + 4 : ENERGY + 7], axis=0).T
    assert impact.sum() < -1.0 and closure(rows) < 1e-11
    assert impact.max() <= 1e-12 * moved and friction.max() <= 1e-12 * moved
    assert contact.max() < 1e-7 * moved and (friction + impact + contact).max() < 1e-7 * moved


def test_a_block_that_slides_over_an_edge_and_back_stands_on_all_points_over_the_other():
    """Its outer points come back to where the others have sunk in, and carry as these do: all but
    the line that is out at the end, in a straight line that puts their resultant below its middle.
    """
    block = box_model(0.4, 0.4, 0.2, gives=1e-6, per_side=5)
    made = engine(
        [part("low", block, (0, 0, 0)), part("up", block, (0, 0, 0.2))],
        [joint(0, GROUND, block), joint(1, 0, block, friction=0.1)],
        observed=1,
    )
    stood = made.motion.forces[25:, 2].copy()
    t = np.arange(1, 1201) * 1e-3
    ground = np.zeros((1200, 3))
    ground[:, 0] = 3.0 * np.sin(2 * np.pi * t / 0.4) * (t < 0.8)
    rows, _ = made.advance(ground)
    assert 0.005 < np.abs(rows[:, 1] - rows[0, 1]).max() < 0.1
    back = np.zeros((1200, 3))
    back[:, 0] = (
        np.sign(rows[-1, 1] - rows[0, 1]) * 4.0 * (t < 0.1) * np.abs(np.sin(np.pi * t / 0.1))
    )
    rows_back, _ = made.advance(back)
    forces = made.motion.forces[25:, 2].reshape(5, 5)
    # out by the row of one side, back and out by that of the other
    lines = forces.mean(axis=1)
    out = 0 if lines[0] == 0 else -1
    assert (np.delete(forces, out, axis=0) > 0).all() and (forces[out] == 0).all()
    assert forces.sum() == pytest.approx(stood.sum(), rel=1e-3)
    # four lines at -2, -1, 0 and 1 of their distance from the middle: 0.1 to 0.4 of the weight have
    # no moment about it
    straight = np.array([0.1, 0.2, 0.3, 0.4]) * stood.sum() / 5
    assert np.delete(lines, out)[:: 1 if out else -1] == pytest.approx(straight, rel=0.1)
    deeper = rows_back[-1, 3] - rows[0, 3]
    assert deeper < 0 and abs(deeper) < 2 * 1e-6 * stood.max()


def test_a_structure_rocks_the_same_wherever_it_stands():
    """A frame 70 m from the origin, whose slab's contacts count from the slab."""
    ground = sine_pulse(4.0, 1.0, 600)
    here, there = (frame(2, at=at)[0].advance(ground)[0] for at in ((0, 0, 0), (60.0, -40.0, 0)))
    assert np.abs(here[:, 1:4]).max() > 0.05
    np.testing.assert_allclose(there[:, 1:4], here[:, 1:4], rtol=0, atol=1e-7)


@pytest.mark.parametrize(
    "columns, push, uplifts", [(2, 0.95, False), (2, 1.1, True), (4, 0.95, False), (4, 1.1, True)]
)
def test_a_frame_uplifts_when_the_ground_accelerates_by_g_tan_alpha(columns, push, uplifts):
    """Makris and Vassiliou (2013): columns of slenderness alpha under a slab uplift together at g
    tan(alpha), whatever the slab's mass.
    """
    made, *_ = frame(columns)
    ground = np.zeros((400, 3))
    # slowly, lest the elastic points ring
    ground[:, 0] = push * G * 0.2 / 1.2 * np.minimum(np.arange(400) / 300, 1.0)
    rows, _ = made.advance(ground)
    assert (rows[-1, WIDTH + 3] > 1e-4) == uplifts


def test_a_frame_rocks_at_the_frequency_of_its_theory():
    """Makris and Vassiliou (2013): the frame rocks as a column with p_hat = p sqrt((1 + 2 g) / (1 +
    3 g)), g the slab's mass over that of the columns.

    theta'' = -p_hat^2 sin(alpha - theta): quarter period of small rocking acosh(1 / (1 - theta /
    alpha)) / p_hat.
    """
    made, slab, column = frame(2, dt=5e-4)
    alpha, R = np.arctan(0.2 / 1.2), np.hypot(0.2, 1.2) / 2
    mass = slab.mass / (2 * column.mass)
    p_hat = np.sqrt(0.75 * G / R * (1 + 2 * mass) / (1 + 3 * mass))
    rows, over = made.advance(sine_pulse(2.1, 0.8, 3500, dt=5e-4))
    assert not over
    tilt = rows[1700:, WIDTH + 3]
    top = np.argmax(tilt[:1000])
    quarter = np.arccosh(1 / (1 - tilt[top] / alpha)) / p_hat
    back = top + np.argmin(tilt[top : top + int(1.2 * quarter / 5e-4)])
    assert (back - top) * 5e-4 == pytest.approx(quarter, rel=0.02)


@pytest.mark.parametrize("columns, order", [(2, [2, 0, 1]), (4, [3, 1, 4, 0, 2])])
def test_motion_does_not_depend_on_the_order_of_bodies_and_contacts(columns, order):
    ground = sine_pulse(4.0, 1.0, 1000)
    first, other = (frame(columns, numbers)[0].advance(ground)[0] for numbers in (None, order))
    assert np.abs(first[:, 1:4]).max() > 0.05
    np.testing.assert_allclose(other[:, 1:4], first[:, 1:4], rtol=0, atol=1e-10)


def test_momentum_is_conserved_where_nothing_is_held():
    """Two blocks that collide in free flight: their common momentum and angular momentum stay."""
    one = box_model(0.3, 0.4, 0.5)
    lower = part("lower", one, (0, 0, 10.0), spin=(0.3, -0.2, 0.1))
    upper = replace(
        part("upper", one, (0.05, 0.08, 10.6), velocity=(0.1, 0.0, -1.5)),
        rotation=rotation_matrix(np.array([0.1, 0.05, 0.3])),
    )
    made = engine([lower, upper], [joint(0, GROUND, one), joint(1, 0, one)], stands=False)

    def moments():
        frames, spins = (
            made.motion.frames,
            [
                R @ body["inertia"] @ w
                for R, body, w in zip(
                    made.motion.rotation, made.structure.bodies.body, made.motion.frames["spin"]
                )
            ],
        )
        momentum = one.mass * frames["velocity"]
        return momentum.sum(axis=0), (np.cross(frames["center"], momentum) + spins).sum(axis=0)

    # a frame that falls along: no gravity in it
    before, record = moments(), made.record.impacts
    made.advance(np.tile(GRAVITY_DOWN, (300, 1)))
    after = moments()
    assert made.record.impacts > record
    # the first step still blends the gravity of the start
    np.testing.assert_allclose(after[0] - before[0], [0, 0, (after[0] - before[0])[2]], atol=1e-9)
    assert abs((after[0] - before[0])[2]) < 2 * one.mass * G * 1e-3


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


def tied(link, steps=600, push=8.0):
    block = box_model(0.3, 0.3, 0.8)
    made = engine([part("block", block, (0, 0, 0))], [joint(0, GROUND, block)], [link])
    return made, made.advance(sine_pulse(push, 0.5, steps))[0]


def test_a_tendon_that_is_tight_presses_the_block_down():
    block = box_model(0.3, 0.3, 0.8)
    tendon = tie(kind="tendon", arm_b=np.array([0.0, 0, 0.0]), prestress=500.0, pushes=False)
    made = engine([part("block", block, (0, 0, 0))], [joint(0, GROUND, block)], [tendon])
    assert made.motion.forces[:, 2].sum() == pytest.approx(block.mass * G + 500.0, rel=1e-6)


@pytest.mark.parametrize(
    "settings",
    [
        {},
        dict(slack=0.005),
        dict(pushes=False, slack=0.002),
        dict(damping=300.0),
        dict(yield_n=200.0),
        dict(breaking_n=100.0),
    ],
)
def test_energy_of_links_is_accounted_for(settings):
    made, rows = tied(tie(**settings))
    assert rows[:, 4].max() > 0.01 and closure(rows) < 1e-11
    lost = rows[-1, ENERGY + 10]
    dissipates = bool({"damping", "yield_n", "breaking_n"} & set(settings))
    assert (lost < -1e-3) == dissipates and lost <= 1e-12
    assert made.motion.ties["broken"][0] == ("breaking_n" in settings) and (
        made.motion.ties["flowed"][0] != 0
    ) == ("yield_n" in settings)
    # nothing else is damped here, and nothing of it is booked elsewhere
    assert rows[-1, ENERGY + 8] == 0.0 and made.motion.ties["work"].sum() == pytest.approx(
        -lost, rel=1e-12, abs=1e-15
    )


def test_a_mass_that_a_yielding_spring_stops_has_lost_all_but_what_the_spring_then_gives_back():
    """Without friction, along x at the height of the centre of mass: F_y times the plastic way is m
    v^2 / 2 less F_y^2 / 2 k.
    """
    block, speed, stiffness, yields = box_model(0.3, 0.3, 0.8), 0.5, 1e5, 1e3
    spring = tie(
        arm_a=np.zeros(3), arm_b=np.array([-2.0, 0, 0.4]), stiffness=stiffness, yield_n=yields
    )
    made = engine(
        [part("block", block, (0, 0, 0), velocity=(speed, 0.0, 0.0))],
        [joint(0, GROUND, block, friction=0.0)],
        [spring],
    )
    rows, _ = made.advance(np.zeros((300, 3)))
    plastic = (block.mass * speed**2 / 2 - yields**2 / (2 * stiffness)) / yields
    tension, elongation, yielded, work, broken = rows[:, -5:].T
    assert (
        work[-1] == pytest.approx(yields * plastic, rel=1e-4)
        and yielded[-1] == pytest.approx(plastic, rel=1e-4)
        and rows[-1, ENERGY + 10] == pytest.approx(-work[-1], rel=1e-12)
    )
    assert (
        elongation.max() == pytest.approx(plastic + yields / stiffness, rel=1e-4)
        and tension.max() == pytest.approx(yields, rel=1e-12)
        and not broken.any()
    )
    assert np.abs(rows[:, WIDTH - 1]).max() < 1e-12 * block.mass * speed**2 / 2


@pytest.mark.long
def test_a_tendon_that_a_lean_has_stretched_is_loaded_from_the_start():
    """A block that leans about its edge, tied to the ground by a tendon through its foot: k e^2 /
    2, which contact must not make.
    """
    breadth, tilt, stiffness = 0.3, 0.05, 2e5
    block, turn = box_model(breadth, breadth, 0.8), rotation_matrix(np.array([0, tilt, 0]))
    toe = np.array([breadth / 2, 0, 0])
    leaning = replace(
        part("block", block, (0, 0, 0)), center=toe + turn @ (block.center - toe), rotation=turn
    )
    tendon = tie(kind="tendon", arm_b=np.array([0.0, 0, 0.0]), stiffness=stiffness, pushes=False)
    made = engine([part("block", block, (0, 0, 0))], [joint(0, GROUND, block)], [tendon])
    made.motion = of_parts(made, [leaning], False)
    made.ledger[0] = made.mechanical()
    top = toe + turn @ (np.array([0.0, 0, 0.8]) - toe)
    stretched = np.linalg.norm(top) - 0.8
    assert made.row()[ENERGY + 1] == pytest.approx(stiffness * stretched**2 / 2, rel=1e-9)
    rows, _ = made.advance(np.zeros((150, 3)))
    assert (
        rows[:, ENERGY + 6].max() < 1e-6 * rows[0, ENERGY : ENERGY + 3].sum()
        and closure(rows) < 1e-11
    )


@pytest.mark.parametrize(
    "settings, much",
    [(dict(stiffness=1e9), "1e\\+09 N/m"), (dict(damping=1e7), "20000 N/m and 1e\\+07 N s/m")],
)
def test_a_link_too_stiff_for_the_step_is_refused_by_name(settings, much):
    with pytest.raises(ValueError, match=f"links.tie: {much} .* needs steps of at most") as refused:
        tied(tie(**settings))
    longest = float(str(refused.value).split()[-2])
    block = box_model(0.3, 0.3, 0.8)
    engine(
        [part("block", block, (0, 0, 0))],
        [joint(0, GROUND, block)],
        [tie(**settings)],
        dt=0.98 * longest,
    )


def test_many_links_are_refused_where_one_of_them_would_do():
    """Sixteen tendons as stiff as one may be answer a step sixteen times as strongly."""
    block = box_model(0.3, 0.3, 0.8)
    one = tie(stiffness=0.9 * 4 * block.mass / 1e-3**2 / 4, arm_a=np.zeros(3))
    tied(one, steps=5)
    with pytest.raises(
        ValueError, match="links.tie: .* with the links beside it, needs steps of at most 0.00026 s"
    ):
        engine([part("block", block, (0, 0, 0))], [joint(0, GROUND, block)], [one] * 16)


@pytest.mark.parametrize("stiffness", [1e6, 1e8])
@pytest.mark.parametrize("prestress, end", [(500.0, (0, 0, 0.0)), (0.0, (1.0, 0.3, 3.0))])
def test_a_block_comes_to_rest_on_links_however_stiff(stiffness, prestress, end):
    """As stiff as its foot, along it or aslant; the tendon adds its prestress to the weight."""
    block = box_model(0.3, 0.3, 0.8)
    link = tie(stiffness=stiffness, prestress=prestress, arm_b=np.array(end))
    made = engine([part("block", block, (0, 0, 0))], [joint(0, GROUND, block)], [link], dt=1e-4)
    assert made.motion.forces[:, 2].sum() == pytest.approx(
        block.mass * G + prestress, rel=0.2 if stiffness > 1e7 else 5e-3
    )
    rows, _ = made.advance(np.zeros((50, 3)))
    assert np.abs(rows[:, 1:4] - rows[0, 1:4]).max() < 1e-11
