"""The contact solver on assemblies of rigid bodies, whose W is only semidefinite, against other
ways to the same answer.
"""

import itertools
import os
import subprocess

import numpy as np
import pytest
from scipy.optimize import brentq, nnls, root

from benchmarks.friction.assemblies import arch, boxes, drum, heap, scatter, stack, wall
from benchmarks.friction.problem import Problem, violation
from benchmarks.peers.install import SYSTEM_PYTHON
from fecolumn.contact.friction import solve_contact

# Of max |q|: asked of the solver; and what its forces may violate, by the benchmark's own measure:
# bodies fall a tenth of a millimetre in a step of these problems, so this is 1e-13 m, a tenth of
# what the engines ask for
TOLERANCE, SOLVED = 1e-12, 1e-9


def solved(problem):
    """Forces (n, 3) from no guess, a solution by the natural map of the bipotential: not the
    residual that the solver iterates on.
    """
    forces = solve_contact(
        problem.W,
        problem.q,
        problem.mu,
        np.zeros_like(problem.q),
        TOLERANCE * np.abs(problem.q).max(),
    ).forces
    assert violation(problem, forces) < SOLVED
    return forces


ASSEMBLIES = {
    "stack": stack(3),
    "wall": wall(2, 2),
    "heap": heap(3),
    "drum": drum(8),
    "arch": arch(3),
}


@pytest.mark.parametrize(
    "load, mu", [("rest", 0.6), ("shake", 0.1), ("shake", 0.3), ("impact", 0.3), ("impact", 1.2)]
)
@pytest.mark.parametrize("name", ASSEMBLIES)
def test_hyperstatic_assembly_obeys_the_laws(name, load, mu):
    problem = ASSEMBLIES[name].problem(load, mu, seed=1)
    assert problem.rank < 3 * problem.points
    solved(problem)


def test_stack_at_rest_carries_its_weight():
    """Each joint passes the weight above it, over one step: blocks 0.4 x 0.4 x 0.3 m of 2700 kg/m3,
    5 ms; no friction is called for in sum.
    """
    forces = solved(stack(3).problem("rest", 0.6)).reshape(3, 4, 3).sum(1)
    block = 0.4 * 0.4 * 0.3 * 2700 * 9.81 * 5e-3
    assert forces[:, 2] == pytest.approx([3 * block, 2 * block, block], rel=1e-9)
    assert np.abs(forces[:, :2]).max() < 1e-9 * block


@pytest.mark.parametrize("mu, slides", [(0.44, True), (0.46, False)])
def test_block_on_a_shaken_floor_slides_where_friction_is_less_than_the_shaking(mu, slides):
    """0.4 and 0.2 g across: sqrt(0.2) = 0.447 g; a block that slides keeps sqrt(0.2) - mu of g
    times the step.
    """
    problem = boxes("slab", [((-0.5, -0.5, 0.0), (0.5, 0.5, 0.1))]).problem("shake", mu)
    slip = np.hypot(*problem.relative(solved(problem))[:, :2].T)
    assert slip == pytest.approx(np.full(4, max(np.sqrt(0.2) - mu, 0.0) * 9.81 * 5e-3), abs=1e-12)
    assert (slip.max() > 1e-6) == slides


@pytest.mark.parametrize(
    "assembly, load",
    [
        (stack(3), "impact"),
        (wall(2, 3), "impact"),
        (heap(3), "impact"),
        (heap(3), "rest"),
        (drum(32), "impact"),
        (scatter(20, 5, 4), "impact"),
        (arch(5), "rest"),
    ],
    ids=lambda x: getattr(x, "name", x),
)
def test_without_friction_normal_velocities_are_those_of_least_squares(assembly, load):
    """min |A r + b|, r >= 0, with A^T A = W_nn and A^T b = q_n (Lawson and Hanson's NNLS): r may
    differ, A r + b does not.
    """
    problem = assembly.problem(load, 0.0, seed=3)
    forces, normal = solved(problem), np.arange(2, 3 * problem.points, 3)
    values, vectors = np.linalg.eigh(problem.W[np.ix_(normal, normal)])
    kept = values > 1e-12 * values[-1]
    A = np.sqrt(values[kept])[:, None] * vectors[:, kept].T
    b = np.linalg.lstsq(A.T, problem.q[:, 2], rcond=None)[0]
    assert A.T @ b == pytest.approx(problem.q[:, 2], abs=1e-12)
    exact = problem.q[:, 2] + A.T @ (A @ nnls(A, -b)[0])
    assert np.abs(forces[:, :2]).max() == 0.0
    assert problem.relative(forces)[:, 2] == pytest.approx(
        exact, abs=1e-10 * np.abs(problem.q).max()
    )


@pytest.mark.parametrize(
    "assembly, load, mu",
    [
        (stack(25), "rest", 0.0),
        (stack(25), "impact", 0.0),
        (stack(25), "impact", 1.2),
        (heap(4), "rest", 1.2),
    ],
    ids=["stack at rest", "stack thrown", "stack thrown, rough", "heap"],
)
def test_forces_of_many_redundant_points_are_found(assembly, load, mu):
    """So many points that hardly any choice of those that carry leaves a regular W."""
    problem = assembly.problem(load, mu, seed=5)
    assert problem.points >= 100 and problem.rank < 0.6 * 3 * problem.points
    assert violation(problem, solved(problem)) < 1e-10


def test_frictionless_joints_among_rough_ones_pass_the_weight_and_no_shear():
    """Every second of 20 blocks on ice: on a floor that shakes, what stands on the lowest ice stays
    behind, and all carry the weight above.
    """
    rough = stack(20).problem("shake", 0.6)
    mu = np.repeat(np.arange(20) % 2 * 0.6, 4)
    problem = Problem("stack on ice", rough.W, rough.q, mu)
    forces = solved(problem)
    block = 0.4 * 0.4 * 0.3 * 2700 * 9.81 * 5e-3
    assert np.abs(forces[mu == 0, :2]).max() == 0.0
    assert forces.reshape(20, 4, 3)[:, :, 2].sum(1) == pytest.approx(
        block * np.arange(20, 0, -1), rel=1e-6
    )


def one_point_solutions(problem):
    """All forces (3,) of a single point: open, stuck, and every direction of slip at which force
    and slip are in line, by bisection.
    """
    W, q, mu = problem.W, problem.q[0], problem.mu
    found = [np.zeros(3)] if q[2] >= 0 else []
    stuck = np.linalg.solve(W, -q)
    if np.hypot(*stuck[:2]) <= mu * stuck[2]:
        found.append(stuck)

    def sliding(angle):
        direction = np.array([mu * np.cos(angle), mu * np.sin(angle), 1.0])
        normal = -q[2] / (W[2] @ direction)
        return normal * direction, W @ (normal * direction) + q

    def out_of_line(angle):
        _, u = sliding(angle)
        return np.cos(angle) * u[1] - np.sin(angle) * u[0]

    angles = np.linspace(-np.pi, np.pi, 721)
    values = [out_of_line(angle) for angle in angles]
    for a, b, left, right in zip(angles, angles[1:], values, values[1:]):
        if left * right < 0:
            angle = brentq(out_of_line, a, b, xtol=1e-15, rtol=1e-14)
            force, u = sliding(angle)
            if force[2] > 0 and np.cos(angle) * u[0] + np.sin(angle) * u[1] <= 0:
                found.append(force)
    return found


@pytest.mark.parametrize("seed", range(10))
def test_single_point_is_at_one_of_the_solutions_that_bisection_finds(seed):
    random = np.random.default_rng(seed)
    half, q = random.standard_normal((3, 3)), random.standard_normal((1, 3)) - [0, 0, 1]
    problem = Problem("point", half @ half.T + 0.3 * np.eye(3), q, (0.1, 0.5, 1.2)[seed % 3])
    exact, forces = one_point_solutions(problem), solved(problem)[0]
    assert exact
    assert min(np.abs(forces - one).max() for one in exact) < 1e-10


def enumerated(problem):
    """All forces (n, 3) found by every combination of open, stuck and sliding points; slip's
    directions by root finding from eight each.
    """
    n, mu, found = problem.points, problem.mu, []
    for states in itertools.product("ovs", repeat=n):
        slipping = [i for i in range(n) if states[i] == "s"]

        def forces_of(x, states=states):
            forces, k = np.zeros((n, 3)), 0
            for i, state in enumerate(states):
                if state == "v":
                    forces[i], k = x[k : k + 3], k + 3
                elif state == "s":
                    forces[i], k = (
                        x[k] * np.array([mu * np.cos(x[k + 1]), mu * np.sin(x[k + 1]), 1.0]),
                        k + 2,
                    )
            return forces

        def equations(x, states=states):
            u, k, left = problem.relative(forces_of(x)), 0, []
            for i, state in enumerate(states):
                if state == "v":
                    left, k = [*left, *u[i]], k + 3
                elif state == "s":
                    left, k = (
                        [*left, u[i, 2], np.cos(x[k + 1]) * u[i, 1] - np.sin(x[k + 1]) * u[i, 0]],
                        k + 2,
                    )
            return left

        size = np.linalg.norm(problem.q) / np.trace(problem.W)
        for angles in itertools.product(np.arange(8) * np.pi / 4, repeat=len(slipping)):
            turns, x = iter(angles), []
            for state in states:
                x += (
                    {"o": [], "v": [0.0, 0.0, size]}.get(state)
                    if state != "s"
                    else [size, next(turns)]
                )
            if x:
                sought = root(equations, x, tol=1e-13)
                if not sought.success:
                    continue
                x = sought.x
            forces = forces_of(x)
            u = problem.relative(forces)
            pull, slack = np.hypot(forces[:, 0], forces[:, 1]), 1e-10
            lawful = (
                u[:, 2].min() > -slack
                and forces[:, 2].min() >= -slack
                and (pull <= mu * forces[:, 2] + slack).all()
            )
            if lawful and all(forces[i, :2] @ u[i, :2] <= slack for i in slipping):
                found.append(forces)
                break
    return found


@pytest.mark.parametrize("points, seed", [(2, 0), (2, 1), (2, 2), (2, 3), (3, 4), (3, 5), (3, 6)])
def test_two_and_three_points_are_where_enumeration_puts_them(points, seed):
    """Bodies at random, as many as points and a little soft, so that the forces are unique but for
    what friction leaves open.
    """
    problem = (
        scatter(points, points, seed).problem("impact", (0.2, 0.5)[seed % 2], seed).softened(0.1)
    )
    exact, forces = enumerated(problem), solved(problem)
    assert exact
    assert min(np.abs(forces - one).max() for one in exact) < 1e-8 * np.abs(forces).max()


def test_measure_tells_what_is_no_solution():
    """No force at all, a pull, a force outside the cone, and friction that helps the slip."""
    problem = stack(1).problem("shake", 0.3)
    forces = solved(problem)
    assert violation(problem, 0 * forces) > 0.1
    for wrong in (forces * [1, 1, -1], forces * [2, 2, 1], forces * [-1, -1, 1]):
        assert violation(problem, wrong) > 0.01


def test_point_that_opens_without_friction_and_without_slip_violates_nothing():
    """The cone without friction is a half-line: the trial force straight below it belongs to its
    tip.
    """
    assert (
        violation(Problem("open", np.eye(3), np.array([[0.0, 0.0, 1.0]]), 0.0), np.zeros(3)) == 0.0
    )
    assert (
        violation(
            Problem("pulled", np.eye(3), np.array([[0.0, 0.0, 1.0]]), 0.0),
            np.array([0.0, 0.0, -1.0]),
        )
        == 1.0
    )


@pytest.mark.parametrize(
    "make",
    [lambda: scatter(8, 4, 3), lambda: arch(5), lambda: heap(2)],
    ids=["scatter", "arch", "heap"],
)
def test_problem_is_made_of_its_seed_alone_and_symmetric(make):
    first, second, other = (make().problem("impact", 0.3, seed) for seed in (1, 1, 2))
    assert np.array_equal(first.W, second.W) and np.array_equal(first.q, second.q)
    assert not np.array_equal(first.q, other.q)
    assert np.array_equal(first.W, first.W.T) and np.linalg.eigvalsh(first.W)[
        0
    ] > -1e-14 * np.trace(first.W)


@pytest.fixture(scope="module")
def siconos(tmp_path_factory):
    """Problems that both of Siconos' solvers manage, and its forces by solver."""
    environment = {
        key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "VIRTUAL_ENV")
    }
    asked = [SYSTEM_PYTHON, "-I", "-c", "import siconos.numerics"]
    try:
        done = subprocess.run(asked, env=environment, capture_output=True, timeout=60)
    except OSError:
        done = None
    if done is None or done.returncode:
        pytest.skip(
            f"{SYSTEM_PYTHON} has no siconos: python -m benchmarks.peers --install "
            "installs Debian's python3-siconos"
        )
    from benchmarks.friction.__main__ import siconos

    given = [
        heap(2).problem("impact", 0.3, 1),
        heap(3).problem("shake", 0.1, 1),
        scatter(8, 4, 3).problem("impact", 0.3, 1),
        scatter(20, 5, 4).problem("shake", 0.3, 1),
        stack(1).problem("impact", 0.3, 1),
    ]
    found, remark = siconos(given, tmp_path_factory.mktemp("siconos"))
    assert not remark
    return given, found


@pytest.mark.parametrize("solver", ["nsgs", "newton"])
def test_siconos_finds_the_same_velocities(siconos, solver):
    """Forces of a hyperstatic assembly are not unique; relative velocities are in all of these but
    the block thrown on four corners.
    """
    given, found = siconos
    for problem, theirs in zip(given, found):
        scale = np.abs(problem.q).max()
        assert violation(problem, theirs[solver]["forces"]) < SOLVED, problem.name
        ours = problem.relative(solved(problem))
        if problem.name != "stack of 1, impact":
            assert ours == pytest.approx(
                problem.relative(theirs[solver]["forces"]), abs=1e-8 * scale
            ), problem.name


def test_block_thrown_on_four_corners_has_more_than_one_lawful_end(siconos):
    """Coulomb's law with dependent points: Siconos' solvers end in one way, this project's in
    another, and both obey the laws.
    """
    given, found = siconos
    problem, theirs = given[-1], found[-1]["nsgs"]["forces"]
    ours = solved(problem)
    assert violation(problem, theirs) < SOLVED
    # slips of 0.04 m/s that differ by a hundredth: ten thousand times what either leaves unsolved
    assert np.abs(problem.relative(ours) - problem.relative(theirs)).max() > 1e4 * SOLVED
