"""Plastic impacts of one and of two bodies, with friction and restitution, in closed form."""

import numpy as np
import pytest
from two_blocks import NO_BASE

from fecolumn.contact.bodies import joined, one_body
from fecolumn.contact.impact import find_impact, mark_landing
from fecolumn.contact.interface import interface_of
from fecolumn.contact.pad import Springs
from fecolumn.contact.points import BASE, CONTACT, node_points
from fecolumn.contact.pose import poses_on_base
from fecolumn.contact.problem import N_COUNTS, OK
from fecolumn.contact.work import book_impulses

DT = 1e-4


def body(mass, arms, inertia=None, within=False):
    """A rigid body; `within`: its rigid motion is part of the nodal mobility, as in the full-order engine."""
    n = len(arms)
    if not within:
        return one_body(arms, np.zeros((3 * n, 3 * n)), np.zeros((3 * n, 3 * n)), mass, np.eye(3) if inertia is None else inertia)
    one, W = one_body(arms, np.zeros((3 * n, 3 * n)), np.zeros((3 * n, 3 * n)), mass, inertia), np.zeros((3 * n, 3 * n))
    for i, p in enumerate(arms):
        for j, q in enumerate(arms):
            skew = [np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) for x, y, z in (p, q)]
            W[3 * i:3 * i + 3, 3 * j:3 * j + 3] = np.eye(3) / mass + skew[0] @ np.linalg.inv(inertia) @ skew[1].T
    return one_body(arms, one.static, W)


def struck(bodies, points, velocity, mu=0.0, restitution=0.0, contact_work=-1.0, force=(0.0, 0.0, 1.0), late=None):
    """Impulses (n, 3) of an impact of points that arrive with `velocity` (n, 3) in the very moment; `force` (3,) of the step and the velocities `late` that it has left."""
    n = len(points)
    points["friction"] = mu
    interface = interface_of(np.array([[0.0, 0, 0], [1.0, 0, 0]]), restitution=restitution, master=points["master"][0])
    before, after, landing = np.zeros(n, CONTACT), np.zeros(n, CONTACT), np.zeros(n, bool)
    before["relative"][:, 2], after["force"] = 1e-6, force
    assert mark_landing(interface, points, np.arange(n), before, after, landing) == n
    # what the step's own impulse, about to be replaced, has done is taken out again
    late = np.array(velocity if late is None else late, float)
    answer, pushed, impulses = find_impact(bodies, NO_BASE, points, interface, Springs(np.zeros((n, 3)), np.zeros((n, 3)), 0.0), np.arange(n), points["arm"].copy(),
                                           poses_on_base(np.eye(3)[None]), before, after, np.array(velocity, float), late, landing,
                                           np.zeros(n, bool), True, DT, contact_work, np.zeros(N_COUNTS, np.int64))
    assert answer == OK and (pushed or contact_work >= 0)
    return impulses + DT * after["force"]


@pytest.mark.parametrize("within", [False, True])
def test_rod_that_lands_on_its_end_turns_about_it(within):
    """Impulse v / (1/m + l^2 / 4 I) = m v / 4 of a rod with I = m l^2 / 12."""
    mass, length, speed = 3.0, 2.0, 1.5
    inertia = np.diag([1.0, mass * length**2 / 12, mass * length**2 / 12])
    arms = np.array([[length / 2, 0, 0]])
    impulse = struck(body(mass, arms, inertia, within), node_points(arms, 0.0, master=BASE), [[0, 0, -speed]], contact_work=-10.0)
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
    """A mass point arrives at tan(incidence) = 0.5: friction mu times the normal impulse, at most what stops the slip."""
    mass, place = 2.0, np.zeros((1, 3))
    impulse = struck(body(mass, place), node_points(place, 0.0, master=BASE), [[0.5, 0, -1.0]], mu, contact_work=-10.0)
    assert impulse[0] == pytest.approx([-mass * min(mu, pull), 0, mass], rel=1e-4, abs=1e-4)


def test_restitution_gives_its_share_of_the_plastic_impulse_once_more():
    mass, place = 2.0, np.zeros((1, 3))
    impulse = struck(body(mass, place), node_points(place, 0.0, master=BASE), [[0, 0, -1.0]], restitution=0.6, contact_work=-10.0)
    assert impulse[0, 2] == pytest.approx(1.6 * mass, rel=1e-4)


@pytest.mark.parametrize("contact_work", [-0.05, 0.0, 1e-3])
def test_an_impact_gives_back_no_more_than_contact_has_taken(contact_work):
    """A long step has stopped a slipping mass by the friction of a large force; the impact's smaller one leaves it slipping: 3 m/s less 0.9 times 3 m/s."""
    mass, place = 2.0, np.zeros((1, 3))
    force = np.array([-6.0, 0.0, 6.0]) / DT
    impulse = struck(body(mass, place), node_points(place, 0.0, master=BASE), [[3.0, 0, -3.0]], 0.9, contact_work=contact_work, force=force, late=[[0.0, 0, 0]])
    left = impulse[0] / mass + [3.0, 0, -3.0]
    gained = mass * left @ left / 2
    assert gained <= max(-contact_work, 0.0) + 1e-12
    assert gained == pytest.approx(min(mass * 0.3**2 / 2, max(-contact_work, 0.0)), abs=1e-3)


def test_what_an_impact_gives_back_is_not_booked_as_its_gain():
    """Impact, contact and friction keep their sum; none of them gains where the sum does not."""
    for gained, impact, contact, friction in ((3.0, -1.0, -4.0, -2.0), (3.0, -1.0, -1.0, -2.0), (-3.0, -1.0, 0.0, 0.0), (2.0, -1.0, 1e-6, -2.0)):
        booked = book_impulses(gained, impact, contact, friction)
        assert sum(booked) == pytest.approx(gained + impact + contact + friction, abs=1e-14)
        assert booked[0] <= 0 and booked[1] <= max(contact, 0.0) + 1e-15 and booked[2] <= 1e-15
