"""The contact problem of a step: points of a foot on the base that stick, slip, open or stay out of it, in closed form and by whole matrices."""

import numpy as np
import pytest
from two_blocks import Blocks, compliance

from fecolumn._compiled import interpreted
from fecolumn.contact.base_top import Base
from fecolumn.contact.bodies import one_body
from fecolumn.contact.compliance import assemble
from fecolumn.contact.interface import interface_of
from fecolumn.contact.pad import Springs
from fecolumn.contact.points import CONTACT, node_points
from fecolumn.contact.problem import N_COUNTS, OK, begin_problem, find_forces, find_residual, mark_close, room, solve_linear
from fecolumn.contact.stick import no_stick
from fecolumn.contact.tolerances import CLOSE, ITERATIONS, NEAR, SOLVED
from fecolumn.fem.rotation import rotation_matrix

# a point gives way by this [m/N], sunk into the base by this it presses with 1000 N
GIVES, DEEP = 1e-9, 1e-6


def flat(compliance=None):
    """A base of one facet, 4 m wide; compliance: (12, 12) [m/N] of its corners, rigid unless given."""
    side = np.array([-2.0, 2.0])
    return Base(side, side, np.array([[0, 2], [1, 3]]), np.arange(4), np.zeros((12, 12)) if compliance is None else compliance, 0.0)


class Foot:
    """Points at the nodes of one body, 1 m wide where tolerances are concerned, on a flat base.

    Args:
        arms: (n, 3) [m]. static, elastic: (3 n, 3 n) [m/N] what follows forces at once and within the step, in the body's frame.
        mass, inertia: of a body whose rigid motion is given so, as in the reduced engine; None: it is in `elastic`, as in full order.
        half: dt^2 / 2 of the step [s2]. own: (n, 3) [m/N] of the points alone.
    """

    def __init__(self, arms, static, elastic, mu, mass=None, inertia=None, half=0.0, own=0.0, base=None, rotation=None):
        n = len(arms)
        self.rigid, self.n = half if mass else 0.0, n
        self.bodies = one_body(arms, static, elastic, mass, inertia) if mass else one_body(arms, static, elastic)
        self.dynamic, self.base = static + elastic, base or flat()
        self.points, self.interface = node_points(arms, mu), interface_of(np.array([[0.0, 0, 0], [1.0, 0, 0]]))[0]
        self.springs = Springs(np.full((n, 3), own), np.zeros((n, 3)), 0.0)
        self.rotations = np.eye(3)[None] if rotation is None else rotation[None].copy()
        self.problem, self.counts = room(n), np.zeros(N_COUNTS, np.int64)

    def solve(self, positions, forces=None, anchors=None, stick=None):
        """Points (n,) of CONTACT after a step that brings them to `positions` (n, 3) [m] with the forces with which they began, none unless given.

        stick: where to find the stick operator, which is left out unless given.
        """
        positions, before = np.array(positions, float), np.zeros(self.n, CONTACT)
        before["force"], before["anchor"] = 0.0 if forces is None else forces, 0.0 if anchors is None else anchors
        after, worth, stick = before.copy(), stick is not None, stick or no_stick(0)
        begin_problem(self.problem, False, worth)
        if not self.rigid:
            answer, residual = solve_linear(self.problem, self.bodies, self.base, self.points, self.interface, self.springs, self.dynamic,
                                            self.bodies.mobility, stick, np.nan, np.zeros(3), self.rotations, positions, ITERATIONS, before, after,
                                            self.counts)
        else:
            answer, residual = self._iterate(positions, before, after, stick)
        assert answer == OK and residual <= SOLVED
        return after

    def _iterate(self, positions, before, after, stick):
        """As the reduced engine does: the motion under the forces is found outside."""
        response, everyone = np.empty((3 * self.n, 3 * self.n)), np.arange(self.n)
        interpreted(assemble)(self.bodies, self.base, self.points, self.points["arm"].copy(), everyone, self.rotations, self.rigid,
                              self.bodies.mobility, 0.0, self.springs.own, response)
        start, began = positions.copy(), after["force"].copy()
        for iteration in range(ITERATIONS):
            positions = start + (response @ (after["force"] - began).ravel()).reshape(-1, 3)
            interpreted(mark_close)(self.problem, self.interface, positions, before, after)
            answer, residual = interpreted(find_residual)(
                self.problem, self.bodies, self.base, self.points, self.interface, self.springs, self.dynamic, self.rigid, stick, np.nan,
                np.zeros(3), self.rotations, positions, iteration == 0, before, after, self.counts)
            if answer != OK or residual <= SOLVED:
                break
            assert interpreted(find_forces)(self.problem, self.points, self.interface, stick, after, self.counts) == OK
        return answer, residual


def springs_alone(mu, n=1, static=0.4, **more):
    """n points that do not know of one another, each giving way by GIVES, a part of it at once and the rest within the step."""
    return Foot(np.zeros((n, 3)), static * GIVES * np.eye(3 * n), (1 - static) * GIVES * np.eye(3 * n), mu, **more)


@pytest.mark.parametrize("static", [0.0, 0.4, 1.0])
def test_a_pressed_point_sticks_below_the_cone(static):
    """Pulled by a tenth of what presses it, mu 0.3: 1000 N and 100 N, and it is where it was."""
    point = springs_alone(0.3, static=static).solve([[0.1 * DEEP, 0.0, -DEEP]])[0]
    assert point["force"] == pytest.approx([-100.0, 0.0, 1000.0], rel=1e-9)
    assert point["relative"] == pytest.approx(np.zeros(3), abs=2 * SOLVED)


@pytest.mark.parametrize("static", [0.0, 0.4, 1.0])
def test_a_point_pulled_beyond_the_cone_slips_by_what_friction_leaves(static):
    """Pulled by 0.6 and -0.8 of what presses it, mu 0.3: 300 N against the pull, and 0.7 of it is left as slip."""
    point = springs_alone(0.3, static=static).solve([[0.6 * DEEP, -0.8 * DEEP, -DEEP]])[0]
    assert point["force"] == pytest.approx([-180.0, 240.0, 1000.0], rel=1e-9)
    assert point["relative"] == pytest.approx([0.42 * DEEP, -0.56 * DEEP, 0.0], abs=2 * SOLVED)


def test_slip_counts_from_the_anchor():
    point = springs_alone(0.3).solve([[0.5, 0.0, -DEEP]], anchors=[[0.5 - 0.1 * DEEP, 0.0]])[0]
    assert point["force"] == pytest.approx([-100.0, 0.0, 1000.0], rel=1e-6)


def test_the_compliance_of_contact_law_or_pad_comes_in_series():
    """As soft as the point itself: half the force, and it stays sunk and displaced by half."""
    point = springs_alone(0.3, own=GIVES).solve([[0.1 * DEEP, 0.0, -DEEP]])[0]
    assert point["force"] == pytest.approx([-50.0, 0.0, 500.0], rel=1e-9)
    assert point["relative"] == pytest.approx([0.05 * DEEP, 0.0, -0.5 * DEEP], rel=1e-4)


@pytest.mark.parametrize("up, load", [(0.4 * DEEP, 600.0), (1.4 * DEEP, 0.0)])
def test_a_point_that_is_pulled_up_gives_its_force_back_and_opens(up, load):
    """It begins with 1000 N, indented by 1e-6 m: 0.4e-6 m up it keeps 600 N, 1.4e-6 m up it hangs 0.4e-6 m above the base."""
    # of its indentation 0.4 is its static displacement, which `positions` leaves out
    point = springs_alone(0.3).solve([[0.0, 0.0, up - 0.4 * DEEP]], forces=[[0.0, 0.0, 1000.0]])[0]
    assert point["force"] == pytest.approx([0.0, 0.0, load], rel=1e-9)
    assert point["relative"][2] == pytest.approx(max(up - DEEP, 0.0), abs=2 * SOLVED)


def test_points_above_the_base_take_no_part():
    """Pressed; below NEAR, but open; above NEAR; above CLOSE, where nobody asks for the static displacement."""
    foot = springs_alone(0.3, n=4)
    after = foot.solve([[0.0, 0, -DEEP], [0, 0, 0.9 * NEAR], [0, 0, 1.1 * NEAR], [0, 0, 1.1 * CLOSE]])
    assert foot.problem.active.tolist() == [True, True, False, False]
    assert after["located"].tolist() == [True, True, True, False]
    assert after["force"][:, 2] == pytest.approx([1000.0, 0, 0, 0], rel=1e-9)


def test_a_point_above_near_that_others_push_below_the_base_is_taken_in():
    """Two points that tilt against each other, C = [[1, -1/2], [-1/2, 1]] c: the first alone would push the second through the base."""
    C, sunk = GIVES * np.array([[1.0, -0.5], [-0.5, 1.0]]), np.array([-4 * NEAR, 1.5 * NEAR])
    static = np.zeros((6, 6))
    static[::3, ::3] = static[1::3, 1::3] = static[2::3, 2::3] = C
    foot = Foot(np.zeros((2, 3)), static, np.zeros((6, 6)), 0.3)
    after = foot.solve([[0.0, 0.0, z] for z in sunk])
    assert foot.problem.active.all()
    # by hand: (4 - 0.75, 2 - 1.5) NEAR / (0.75 c)
    assert after["force"][:, 2] == pytest.approx(np.array([3.25, 0.5]) * NEAR / (0.75 * GIVES), rel=1e-9)
    assert np.abs(after["relative"]).max() < 2 * SOLVED


def rod(kind, mu, half=5e-9):
    """Mass 2 kg, inertia 0.5 kg m2, two points 1 m to each side of the centre of mass and a little below it; they give way by themselves, too."""
    arms, mass, inertia = np.array([[-1.0, 0, -0.1], [1.0, 0, -0.1]]), 2.0, np.diag([0.01, 0.5, 0.5])
    static = elastic = 0.2 * GIVES * np.eye(6)
    rigid = half * Blocks.rigid(mass, inertia, arms)
    if kind == "nodal":
        return Foot(arms, static, elastic + rigid, mu), static + elastic + rigid
    return Foot(arms, static, elastic, mu, mass, inertia, half), static + elastic + rigid


@pytest.mark.parametrize("kind", ["nodal", "by mass and inertia"])
def test_two_points_below_a_rigid_body_share_its_weight_by_its_mobility(kind):
    """Both sunk by u press with u / (W11 + W12), W11 + W12 = dt^2 / 2 (2 / m) + C; one alone with u / W11, and the other is tilted up."""
    half, C = 5e-9, 0.4 * GIVES
    foot, _ = rod(kind, 0.0)
    both = foot.solve([[-1.0, 0.0, -DEEP], [1.0, 0.0, -DEEP]], anchors=[[-1.0, 0], [1.0, 0]])
    assert both["force"][:, 2] == pytest.approx(DEEP / (half * 2 / 2.0 + C), rel=1e-6)
    one = foot.solve([[-1.0, 0.0, -DEEP], [1.0, 0.0, 10 * DEEP]], anchors=[[-1.0, 0], [1.0, 0]])
    own, coupled = half * (1 / 2.0 + 1 / 0.5) + C, half * (1 / 2.0 - 1 / 0.5)
    assert one["force"][:, 2] == pytest.approx([DEEP / own, 0.0], rel=1e-6)
    assert one["relative"][1, 2] == pytest.approx(10 * DEEP + coupled / own * DEEP, rel=1e-6)


def many(kind, n, seed):
    """A turned body with a random foot on an elastic base, its compliance by whole matrices, and the places (n, 3) of its points."""
    rng, half, mass = np.random.default_rng(seed), 2e-9, 3.0
    arms = np.column_stack([rng.uniform(-0.5, 0.5, (n, 2)), np.full(n, -0.3)])
    inertia, R = np.diag([0.2, 0.3, 0.4]), rotation_matrix(np.array([2e-3, -1e-3, 0.7]))
    static, elastic, below = compliance(rng, n, 1e-10), compliance(rng, n, 2e-10), compliance(rng, 4, 1e-10)
    rigid = half * Blocks.rigid(mass, inertia, arms)
    options = dict(base=flat(below), rotation=R, own=3e-11)
    foot = Foot(arms, static, elastic + rigid, 0.3, **options) if kind == "nodal" else Foot(arms, static, elastic, 0.3, mass, inertia, half, **options)
    places = arms @ R.T
    s, t = (places[:, 0] + 2) / 4, (places[:, 1] + 2) / 4
    shares = np.kron(np.column_stack([(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t]), np.eye(3))
    turn = np.kron(np.eye(n), R)
    W = turn @ (static + elastic + rigid) @ turn.T + shares @ below @ shares.T + 3e-11 * np.eye(3 * n)
    return foot, W, places


def answer(n, slips, opens, seed, mu=0.3):
    """Forces and slacks (n, 3) that obey the laws: the first points slip against their friction, the last ones are open, the others stick."""
    rng = np.random.default_rng(seed)
    forces, slack = np.zeros((n, 3)), np.zeros((n, 3))
    forces[:, 2] = rng.uniform(500, 1500, n)
    forces[:, :2] = 0.5 * mu * forces[:, 2:] * rng.uniform(-1, 1, (n, 2))
    angles = rng.uniform(0, 2 * np.pi, slips)
    way = np.column_stack([np.cos(angles), np.sin(angles)])
    forces[:slips, :2], slack[:slips, :2] = -mu * forces[:slips, 2:] * way, 0.1 * DEEP * rng.uniform(0.5, 1, (slips, 1)) * way
    forces[n - opens:], slack[n - opens:] = 0.0, np.column_stack([np.full((opens, 2), 0.05 * DEEP), 0.1 * DEEP * rng.uniform(0.5, 1, opens)])
    return forces, slack


@pytest.mark.parametrize("kind", ["nodal", "by mass and inertia"])
@pytest.mark.parametrize("n, slips, opens", [(2, 1, 0), (2, 1, 1), (7, 2, 2), (12, 7, 2), (12, 3, 6)])
def test_a_foot_that_sticks_slips_and_opens_in_part_finds_the_forces_that_obey_the_laws(kind, n, slips, opens):
    """The answer is chosen, and from it where the points would be without forces; whole matrices tell."""
    foot, W, places = many(kind, n, 3)
    forces, slack = answer(n, slips, opens, 5)
    free = slack - (W @ forces.ravel()).reshape(n, 3)
    after = foot.solve(np.column_stack([places[:, :2], np.zeros(n)]) + free, anchors=places[:, :2])
    # the base's shares move by the way of the points over its width, 1e-6
    np.testing.assert_allclose(after["force"], forces, atol=1e-5 * forces.max())
    gives_alone = 3e-11 * forces
    np.testing.assert_allclose(after["relative"] - np.column_stack([places[:, :2], np.zeros(n)]), slack - gives_alone, atol=1e-5 * DEEP)
