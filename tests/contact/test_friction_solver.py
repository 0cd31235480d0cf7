"""The solver of frictional contact on problems with many points that press, slip and open at
once.
"""

from pathlib import Path

import numpy as np
import pytest

from fecolumn.contact import coulomb
from fecolumn.contact.coupling import coupling_of, slips_under
from fecolumn.contact.friction import iterate, solve_contact
from fecolumn.contact.interior_point import approach, in_cones


def foot(n, seed, gaps=1e-7, slip=1e-6):
    """A stiff ring of n points on a rigid body: compliance of rigid motion 1e5 times that of the
    ring, random slips and gaps.
    """
    random = np.random.default_rng(seed)
    angles = 2 * np.pi * np.arange(n) / n
    arms = np.stack([0.05 * np.cos(angles), 0.05 * np.sin(angles), np.full(n, -0.5)], axis=1)
    rigid = np.zeros((3 * n, 6))
    for i, (x, y, z) in enumerate(arms):
        rigid[3 * i : 3 * i + 3] = np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]])
    elastic = random.standard_normal((3 * n, 3 * n))
    W = 1e-7 * rigid @ np.diag([1, 1, 1, 4, 4, 40]) @ rigid.T + 1e-12 * (
        elastic @ elastic.T / (3 * n) + np.eye(3 * n)
    )
    q = np.stack([np.full(n, slip), np.zeros(n), np.full(n, -2e-6)], axis=1)
    return W, q + gaps * random.standard_normal((n, 3))


def violation(W, q, mu, forces):
    """Penetration, pull, force on open points, force outside the cone, slip not opposed: largest,
    in metres.
    """
    s = (W @ forces.ravel()).reshape(-1, 3) + q
    pull, slip = np.hypot(forces[:, 0], forces[:, 1]), np.hypot(s[:, 0], s[:, 1])
    compliance = np.diag(W).max()
    slides = pull < mu * forces[:, 2] * (1 - 1e-6)
    opposed = (
        np.abs(forces[:, :2] * slip[:, None] + mu * forces[:, 2:] * s[:, :2]).max(initial=0)
        / np.abs(forces).max()
    )
    return max(
        -s[:, 2].min(),
        -forces[:, 2].min() * compliance,
        np.minimum(np.abs(s[:, 2]), compliance * forces[:, 2]).max(),
        (pull - mu * forces[:, 2]).max() * compliance,
        slip[slides].max(initial=0),
        opposed,
    )


@pytest.mark.parametrize("seed", range(12))
def test_foot_that_slides_and_lifts_in_part_obeys_the_laws(seed):
    W, q = foot(20 + 8 * seed, seed, slip=(0, 1e-8, 1e-6)[seed % 3])
    solution = solve_contact(W, q, 0.3, np.zeros_like(q), tolerance=1e-14)
    assert solution.residual <= 1e-14
    assert violation(W, q, 0.3, solution.forces) < 1e-12


@pytest.mark.long
def test_interior_point_leads_into_the_cone_from_nothing():
    W, q = foot(60, 3)
    R, U = np.zeros_like(q), np.zeros_like(q)
    mu = np.full(len(q), 0.3)
    forces, _ = approach(*in_cones(W, q, mu), mu, R, U, 30, np.empty(0))
    exact = solve_contact(W, q, 0.3, np.zeros_like(q), tolerance=1e-14).forces
    assert np.abs(forces - exact).max() < 1e-3 * np.abs(exact).max()


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_interior_point_goes_on_where_points_are_at_the_brink_of_slip(friction):
    """Force and slip of such a point are both of the size of the gap's root: a method that ends at
    a gap of 1e-12 leaves 1e-8 of the slip.
    """
    W, q = foot(24, 1, gaps=1e-10, slip=1e-7 if friction == 0.1 else 4e-7)
    mu = np.full(len(q), friction)
    forces, _ = approach(
        *in_cones(W, q, mu), mu, np.zeros_like(q), np.zeros_like(q), 60, np.empty(0)
    )
    stiffness = 3 / np.diag(W).reshape(-1, 3).sum(axis=1)
    assert (
        coulomb.violation(slips_under(coupling_of(W), q, forces), forces, mu, stiffness)
        < 1e-9 * np.abs(q).max()
    )


def test_points_on_the_boundary_of_the_cone_end_the_interior_point_in_peace():
    """R and U that rounding has put on the cones: no division by zero, the forces stay finite."""
    W, q = foot(8, 1)
    R, U = np.tile([1.0, 0.0, 1.0], (8, 1)), np.tile([-1e-9, 0.0, 1e-9], (8, 1))
    mu = np.full(len(q), 0.3)
    forces, made = approach(*in_cones(W, q, mu), mu, R, U, 5, np.empty(0))
    assert np.isfinite(forces).all() and made < 5


@pytest.mark.parametrize("contacts", ["eleven", "eighteen"])
def test_stiff_bodies_in_many_contacts_whose_forces_hardly_differ_in_what_they_do(contacts):
    """Impacts of a frame of four rigid columns on 0.5 and 1 mm/s: compliance differs by a factor of
    1e6 over the forces, and the active sets of all quicker ways cycle.
    """
    case = np.load(Path(__file__).with_name(f"impact_in_{contacts}_contacts.npz"))
    found = solve_contact(case["W"], case["q"], case["friction"], np.zeros_like(case["q"]), 1e-12)
    assert found.residual <= 1e-12
    relative = (case["W"] @ found.forces.ravel()).reshape(-1, 3) + case["q"]
    size, pull, normal = (
        np.abs(case["q"]).max(),
        np.hypot(*found.forces[:, :2].T),
        found.forces[:, 2],
    )
    assert (
        relative[:, 2].min() > -1e-8 * size
        and normal.min() >= 0
        and np.abs(normal * relative[:, 2]).max() < 1e-8 * size * normal.max()
    )
    assert (pull <= case["friction"] * normal * (1 + 1e-9) + 1e-9).all()


def unpacked(contacts):
    """Compliance, velocities and friction of a recorded impact of which the lower triangle is
    kept.
    """
    case = np.load(Path(__file__).with_name(f"impact_in_{contacts}_contacts.npz"))
    q = case["q"]
    W = np.zeros((q.size, q.size))
    W[np.tril_indices(q.size)] = case["W"]
    return W + np.tril(W, -1).T, q, case["friction"]


def test_an_impact_of_elastic_columns_in_many_contacts_is_solved():
    """Of a frame of four elastic columns with 24 points around each face; with the slip of its last
    iterate the interior point creeps at a thousandth of the velocity.
    """
    W, q, friction = unpacked("eighty_four")
    assert solve_contact(W, q, friction, np.zeros_like(q), 1e-12).residual <= 1e-12


def test_an_impact_under_high_friction_is_solved_point_by_point():
    """Of a tube on a flange that is set spinning at mu = 1.6: two of ten points carry, and with all
    ten at once no way finds which.
    """
    W, q, friction = unpacked("ten")
    found = solve_contact(W, q, friction, np.zeros_like(q), 1e-10 * np.abs(q).max())
    assert found.residual <= 1e-10 * np.abs(q).max() and (found.forces[:, 2] > 0).sum() == 2


def test_of_many_points_those_that_carry_are_a_problem_of_their_own():
    """Points that stay open change nothing but for the rounding of what the others do."""
    W, q = foot(60, 4, slip=1e-6)
    q[20:, 2] = 1e-3
    alone = solve_contact(W[:60, :60], q[:20], 0.3, np.zeros((20, 3)), tolerance=1e-14)
    every = iterate(coupling_of(W), q, np.full(60, 0.3), np.zeros_like(q), 1e-14, False, 800)
    assert (
        every[1] <= 1e-14
        and every[0][:20] == pytest.approx(alone.forces, abs=1e-7 * np.abs(alone.forces).max())
        and not every[0][20:].any()
    )


@pytest.mark.parametrize("seed", range(6))
def test_slips_of_which_one_is_the_sum_of_others_take_newton_few_steps_from_a_good_guess(seed):
    """Nodes of two bodies beside each other on the ground: left on ground, right on ground, left on
    right. Forces about such a node are not unique, their slips are.
    """
    nodes, random = 4, np.random.default_rng(seed)
    elastic = random.standard_normal((6 * nodes, 6 * nodes))
    # of left and right nodes, and the three slips of each pair along axes of its own joint
    moved = 1e-9 * (elastic @ elastic.T / (6 * nodes) + np.eye(6 * nodes))
    left, right = np.eye(6 * nodes)[: 3 * nodes], np.eye(6 * nodes)[3 * nodes :]
    side = np.kron(np.eye(nodes), [[0, 1, 0], [0, 0, 1], [1, 0, 0]]) @ (left - right)
    slips = np.concatenate([left, right, side])
    W = slips @ moved @ slips.T
    pressed = np.concatenate(
        [random.normal(0, 50, (3 * nodes, 2)), random.uniform(500, 1500, (3 * nodes, 1))], axis=1
    )
    q = -(W @ pressed.ravel()).reshape(-1, 3)
    assert np.linalg.matrix_rank(W) == 6 * nodes
    guess = pressed + random.normal(0, 1.0, pressed.shape)
    found = iterate(coupling_of(W), q, np.full(3 * nodes, 0.7), guess, 1e-13, True, 800)
    assert found[1] <= 1e-13 and found[2] <= 10 and found[3] == 0
    assert violation(W, q, 0.7, found[0]) < 1e-12
