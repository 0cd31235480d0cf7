"""Plastic impacts of one and of two bodies, with friction and restitution, in closed form."""

import numpy as np
import pytest
from plain import no_pads, poses_on_base
from two_blocks import NO_BASE

from fecolumn.contact.bodies import joined, one_body
from fecolumn.contact.compliance import assemble
from fecolumn.contact.impact import Collision, TouchingBodies, find_impact
from fecolumn.contact.impact_event import landing_moment, mark_landing, touched
from fecolumn.contact.interface import interface_of
from fecolumn.contact.points import CONTACT, GROUND, node_points
from fecolumn.contact.problem import N_COUNTS, OK
from fecolumn.contact.tolerances import IMPACT_LEFT
from fecolumn.contact.work import book_impulses

DT = 1e-4


def body(mass, arms, inertia=None, within=False):
    """A rigid body; `within`: its rigid motion is part of the nodal mobility, as in the full-order
    engine.
    """
    n = len(arms)
    if not within:
        return one_body(
            arms,
            np.zeros((3 * n, 3 * n)),
            np.zeros((3 * n, 3 * n)),
            mass,
            np.eye(3) if inertia is None else inertia,
        )
    one, W = (
        one_body(arms, np.zeros((3 * n, 3 * n)), np.zeros((3 * n, 3 * n)), mass, inertia),
        np.zeros((3 * n, 3 * n)),
    )
    for i, p in enumerate(arms):
        for j, q in enumerate(arms):
            skew = [np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) for x, y, z in (p, q)]
            W[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] = (
                np.eye(3) / mass + skew[0] @ np.linalg.inv(inertia) @ skew[1].T
            )
    return one_body(arms, one.static, W)


def landed(bodies, points, interface, ends, velocities, landing, dt, contact_work=0.0):
    """What `find_impact` answers of points (n,) that land on the ground; ends: their CONTACT
    before and after, velocities: (n, 3) [m/s] then.
    """
    n = len(points)
    union = touched(np.arange(n), *ends, landing)
    return find_impact(
        TouchingBodies(bodies, NO_BASE, points, interface, no_pads(np.zeros((n, 3)))),
        Collision(
            union,
            points["arm"].copy(),
            poses_on_base(np.eye(3)[None]),
            *ends,
            *velocities,
            landing,
            np.zeros(n, bool),
            dt,
            landing_moment(union, *ends, velocities[0], landing, dt),
        ),
        contact_work,
        np.zeros(N_COUNTS, np.int64),
    )


def struck(
    bodies,
    points,
    velocity,
    mu=0.0,
    restitution=0.0,
    contact_work=-1.0,
    force=(0.0, 0.0, 1.0),
    late=None,
):
    """Impulses (n, 3) of an impact of points that arrive with `velocity` (n, 3) in the very moment;
    `force` (3,) of the step and the velocities `late` that it has left.
    """
    n = len(points)
    points["friction"] = mu
    interface = interface_of(
        np.array([[0.0, 0, 0], [1.0, 0, 0]]), restitution=restitution, master=points["master"][0]
    )
    before, after, landing = np.zeros(n, CONTACT), np.zeros(n, CONTACT), np.zeros(n, bool)
    before["relative"][:, 2], after["force"] = 1e-6, force
    assert mark_landing(interface, points, np.arange(n), before, after, landing) == n
    # what the step's own impulse, about to be replaced, has done is taken out again
    late = np.array(velocity if late is None else late, float)
    early = np.array(velocity, float)
    answer, pushed, impulses = landed(
        bodies, points, interface, (before, after), (early, late), landing, DT, contact_work
    )
    assert answer == OK and (pushed or contact_work >= 0)
    return impulses + DT * after["force"]


@pytest.mark.parametrize("within", [False, True])
def test_rod_that_lands_on_its_end_turns_about_it(within):
    """Impulse v / (1/m + l^2 / 4 I) = m v / 4 of a rod with I = m l^2 / 12."""
    mass, length, speed = 3.0, 2.0, 1.5
    inertia = np.diag([1.0, mass * length**2 / 12, mass * length**2 / 12])
    arms = np.array([[length / 2, 0, 0]])
    impulse = struck(
        body(mass, arms, inertia, within),
        node_points(arms, 0.0, master=GROUND),
        [[0, 0, -speed]],
        contact_work=-10.0,
    )
    assert impulse[0] == pytest.approx([0, 0, mass * speed / 4], rel=1e-4)


def test_two_bodies_that_collide_go_on_together():
    """Impulse v m1 m2 / (m1 + m2) through their centres."""
    first, second, speed, place = 2.0, 6.0, 1.2, np.zeros((1, 3))
    pair = joined([body(first, place), body(second, place)])
    points = node_points(place, 0.0, slave=0, master=1)
    points["below"], points["shares"] = 1, [1.0, 0, 0, 0]
    impulse = struck(pair, points, [[0, 0, -speed]], contact_work=-10.0)
    assert impulse[0, 2] == pytest.approx(speed * first * second / (first + second), rel=1e-4)


@pytest.mark.parametrize("mu, pull", [(0.1, 0.1), (0.9, 0.5)])
def test_oblique_impact_slides_or_sticks(mu, pull):
    """A mass point arrives at tan(incidence) = 0.5: friction mu times the normal impulse, at most
    what stops the slip.
    """
    mass, place = 2.0, np.zeros((1, 3))
    impulse = struck(
        body(mass, place),
        node_points(place, 0.0, master=GROUND),
        [[0.5, 0, -1.0]],
        mu,
        contact_work=-10.0,
    )
    assert impulse[0] == pytest.approx([-mass * min(mu, pull), 0, mass], rel=1e-4, abs=1e-4)


def test_restitution_gives_its_share_of_the_plastic_impulse_once_more():
    mass, place = 2.0, np.zeros((1, 3))
    impulse = struck(
        body(mass, place),
        node_points(place, 0.0, master=GROUND),
        [[0, 0, -1.0]],
        restitution=0.6,
        contact_work=-10.0,
    )
    assert impulse[0, 2] == pytest.approx(1.6 * mass, rel=1e-4)


@pytest.mark.parametrize("contact_work", [-0.05, 0.0, 1e-3])
def test_an_impact_gives_back_no_more_than_contact_has_taken(contact_work):
    """A long step has stopped a slipping mass by the friction of a large force; the impact's
    smaller one leaves it slipping: 3 m/s less 0.9 times 3 m/s.
    """
    mass, place = 2.0, np.zeros((1, 3))
    force = np.array([-6.0, 0.0, 6.0]) / DT
    impulse = struck(
        body(mass, place),
        node_points(place, 0.0, master=GROUND),
        [[3.0, 0, -3.0]],
        0.9,
        contact_work=contact_work,
        force=force,
        late=[[0.0, 0, 0]],
    )
    left = impulse[0] / mass + [3.0, 0, -3.0]
    gained = mass * left @ left / 2
    assert gained <= max(-contact_work, 0.0) + 1e-12
    assert gained == pytest.approx(min(mass * 0.3**2 / 2, max(-contact_work, 0.0)), abs=1e-3)


def test_what_an_impact_gives_back_is_not_booked_as_its_gain():
    """Impact, contact and friction keep their sum; none of them gains where the sum does not."""
    for gained, impact, contact, friction in (
        (3.0, -1.0, -4.0, -2.0),
        (3.0, -1.0, -1.0, -2.0),
        (-3.0, -1.0, 0.0, 0.0),
        (2.0, -1.0, 1e-6, -2.0),
    ):
        booked = book_impulses(gained, impact, contact, friction)
        assert sum(booked) == pytest.approx(gained + impact + contact + friction, abs=1e-14)
        assert booked[0] <= 0 and booked[1] <= max(contact, 0.0) + 1e-15 and booked[2] <= 1e-15


@pytest.mark.parametrize(
    "gained, impact, contact, friction, booked",
    [
        (-22.0, 0.0, 25.0, -1.0, (0.0, 3.0, -1.0)),  # what contact had made they take first
        (-22.0, -1.0, 5.0, -1.0, (-18.0, 0.0, -1.0)),
        (3.0, 0.0, 0.0, -1.0, (0.0, 2.0, 0.0)),
    ],
)  # and what friction has not taken it does not get back
def test_impulses_that_come_in_place_of_others_first_undo_what_these_did(
    gained, impact, contact, friction, booked
):
    assert book_impulses(gained, impact, contact, friction) == pytest.approx(booked, abs=1e-14)


def ring(radius, height, count):
    """Arms (count, 3) of points around a circle."""
    angles = 2 * np.pi * (np.arange(count) + 0.5) / count
    return np.column_stack(
        [radius * np.cos(angles), radius * np.sin(angles), np.full(count, height)]
    )


def square(half, height, side=5):
    """Arms of points on the outline of a square."""
    line = np.linspace(-half, half, side)
    return np.array([[x, y, height] for x in line for y in line if max(abs(x), abs(y)) == half])


def elastic(mass, inertia, arms, give, modes=0):
    """A body whose points give alone by `give` [m/N], and by modes of its own mass."""
    n = 3 * len(arms)
    shapes = np.random.default_rng(3).normal(size=(n, modes)) / np.sqrt(mass)
    return one_body(arms, give * np.eye(n), shapes @ shapes.T, mass, np.diag(inertia))


#: Of a column half width and height [m], mass [kg], inertia across it [kg m2]; its slenderness.
HALF, HEIGHT, MASS = 0.1, 1.5, 120.0
ACROSS = MASS / 12 * (HEIGHT**2 + 4 * HALF**2)
SLENDER = np.arctan(2 * HALF / HEIGHT)


def a_foot(give):
    """A column with twenty modes that rocks about a side of its foot and comes down on all of it:
    bodies, points, velocities (n, 3), those that carried, velocities of all bodies.
    """
    arms = ring(HALF, -HEIGHT / 2, 48)
    velocity = np.array(
        [
            [0, 0, HALF * (1 - np.cos(angle)) * -0.3]
            for angle in 2 * np.pi * (np.arange(48) + 0.5) / 48
        ]
    )
    velocity[:, 2] -= velocity[:, 2].max()
    return (
        elastic(MASS, [ACROSS, ACROSS, 2.0], arms, give, 20),
        node_points(arms, 0.8, master=GROUND),
        velocity,
        velocity[:, 2] > -1e-9,
    )


def a_frame(give, slab=17e3):
    """A slab on four columns that rock about the sides of their feet and heads, and come down on
    all of them.
    """
    foot, head, rate = square(HALF, -HEIGHT / 2), square(HALF, HEIGHT / 2), 0.3
    places, n = [(-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (-1.5, 1.5)], len(square(HALF, 0.0))
    column = elastic(MASS, [ACROSS, ACROSS, 2.0], np.concatenate([foot, head]), give)
    under = np.concatenate([head + [x, y, -HEIGHT / 2 - 0.2] for x, y in places])
    bodies = joined(
        [column] * 4 + [elastic(slab, [slab * 1.4, slab * 1.4, slab * 2.7], under, give)]
    )
    points = []
    for k in range(4):
        points.append(node_points(foot, 10.0, slave=k, master=GROUND, first=2 * n * k))
        points.append(
            node_points(under[n * k : n * (k + 1)], 10.0, slave=4, master=k, first=8 * n + n * k)
        )
        points[-1]["below"], points[-1]["shares"], points[-1]["seat"] = (
            2 * n * k + n + np.arange(n)[:, None],
            [1.0, 0, 0, 0],
            head,
        )
    down = -2 * rate * HALF * (HALF - foot[:, 0]) / (2 * HALF)
    up = -2 * rate * HALF * (HALF + head[:, 0]) / (2 * HALF)
    velocity = np.zeros((8 * n, 3))
    velocity[:, 2] = np.tile(np.concatenate([down, up]), 4)
    return bodies, np.concatenate(points), velocity, velocity[:, 2] > -1e-12


@pytest.mark.parametrize(
    "made, give", [(a_foot, 1e-9), (a_foot, 0.0), (a_frame, 1e-9), (a_frame, 0.0)]
)
@pytest.mark.parametrize("parts", [1, 8, 64])
def test_an_impact_is_plastic_whatever_the_step_and_the_faces(made, give, parts):
    """Nothing closes by more than a thousandth of the approach, friction stays in its cone, and no
    energy is made: in a step as in its 64th, on soft faces as on stiff ones.
    """
    bodies, points, velocity, carried = made(give)
    n, dt = len(points), 1e-3 / parts
    interface = interface_of(np.array([[0.0, 0, 0], [0.2, 0, 0]]), master=points["master"][0])
    before, after, landing = np.zeros(n, CONTACT), np.zeros(n, CONTACT), ~carried
    before["relative"][~carried, 2], before["force"][carried, 2], after["force"][:, 2] = (
        1e-6,
        1.0,
        1.0,
    )
    mobility, poses, listed = np.empty((3 * n, 3 * n)), poses_on_base(np.eye(3)[None]), np.arange(n)
    assemble(
        bodies,
        NO_BASE,
        points,
        points["arm"].copy(),
        listed,
        poses,
        1.0,
        bodies.mobility,
        0.0,
        np.zeros((n, 3)),
        mobility,
    )
    given = dt * after["force"].ravel()
    late = velocity + (mobility @ given).reshape(n, 3)
    answer, pushed, impulses = landed(
        bodies, points, interface, (before, after), (velocity, late), landing, dt
    )
    assert answer == OK and pushed
    total = impulses.ravel() + given
    left, each = velocity + (mobility @ total).reshape(n, 3), total.reshape(n, 3)
    rounding = 1e-12 * each[:, 2].sum()
    assert left[:, 2].min() > 1e-3 * velocity[:, 2].min()
    # those that carried until then may open
    assert left[~carried & (each[:, 2] > rounding), 2].max() < -1e-3 * velocity[:, 2].min()
    assert np.all(np.hypot(each[:, 0], each[:, 1]) <= points["friction"] * each[:, 2] + rounding)
    assert total @ (velocity.ravel() + mobility @ total / 2) < 0


@pytest.mark.parametrize("slab", [48.0, 480.0, 17e3])
def test_a_frame_keeps_what_the_theory_of_rocking_frames_says(slab):
    """Makris and Vassiliou (2013): rate after over before an impact."""
    bodies, points, velocity, carried = a_frame(1e-9, slab)
    n, ratio = len(points), slab / (4 * MASS)
    interface = interface_of(np.array([[0.0, 0, 0], [0.2, 0, 0]]))
    before, after = np.zeros(n, CONTACT), np.zeros(n, CONTACT)
    before["relative"][~carried, 2], before["force"][carried, 2], after["force"][:, 2] = (
        1e-6,
        1e-9,
        1e-9,
    )
    mobility, poses, listed = np.empty((3 * n, 3 * n)), poses_on_base(np.eye(3)[None]), np.arange(n)
    assemble(
        bodies,
        NO_BASE,
        points,
        points["arm"].copy(),
        listed,
        poses,
        1.0,
        bodies.mobility,
        0.0,
        np.zeros((n, 3)),
        mobility,
    )
    answer, _, impulses = landed(
        bodies, points, interface, (before, after), (velocity, velocity), ~carried, 1e-4
    )
    left = velocity + (mobility @ impulses.ravel()).reshape(n, 3)
    kept = (1 - 1.5 * np.sin(SLENDER) ** 2 + 3 * ratio * np.cos(2 * SLENDER)) / (1 + 3 * ratio)
    assert answer == OK and left[:, 2].max() / -velocity[:, 2].min() == pytest.approx(
        kept, abs=5e-3 * (1 - kept)
    )


@pytest.mark.parametrize("thrust", [1e2, 1e4, 1e6])
def test_slip_ends_whatever_the_thrust_under_which_it_ended(thrust):
    """A mass of 1 kg that slid at 1 mm/s under a thrust sticks by the end of the step, to
    IMPACT_LEFT of the velocities that it had, not of those that the thrust alone would give it.
    """
    place, step, speed, mu = np.zeros((1, 3)), 1e-3, 1e-3, 0.5
    points = node_points(place, 0.0, master=GROUND)
    points["friction"] = mu
    interface = interface_of(np.array([[0.0, 0, 0], [1.0, 0, 0]]), master=points["master"][0])
    before, after = np.zeros(1, CONTACT), np.zeros(1, CONTACT)
    before["force"], after["force"] = [-mu * thrust, 0, thrust], [-speed / step, 0, thrust]
    listed, late = np.arange(1), np.zeros((1, 3))
    answer, pushed, impulses = find_impact(
        TouchingBodies(body(1.0, place), NO_BASE, points, interface, no_pads(np.zeros((1, 3)))),
        Collision(
            listed,
            place.copy(),
            poses_on_base(np.eye(3)[None]),
            before,
            after,
            np.array([[speed, 0, 0]]),
            late,
            np.zeros(1, bool),
            np.ones(1, bool),
            step,
            np.nan,
        ),
        -1.0,
        np.zeros(N_COUNTS, np.int64),
    )
    assert answer == OK and pushed
    assert np.abs(late + impulses).max() < 2 * IMPACT_LEFT * speed
