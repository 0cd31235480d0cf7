"""The stick operator of a foot that stays in its place: the forces are those of the whole contact
problem, and it knows where it holds.
"""

import numpy as np
import pytest
from one_foot import DEEP, answer, many
from plain import poses_on_base

from fecolumn.contact.factor import multiply, solve_factored
from fecolumn.contact.friction import solve_contact
from fecolumn.contact.interface import interface_of, rims_at_rest
from fecolumn.contact.points import CONTACT
from fecolumn.contact.problem import N_ASSEMBLED
from fecolumn.contact.stick import find_stick, holds, no_stick, operator_of, solve_sticking
from fecolumn.contact.tolerances import PAD_TURN, STICK_TURN, STICK_WAY
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation._compiled import interpreted

N = 12
TIGHT, USABLE = 1e-14, 1e-9


def found(seed):
    """A foot with its operator, and its compliance by whole matrices."""
    foot, W, places = many("by mass and inertia", N, seed)
    # shares of the base's nodes are found by `project`
    foot.solve(np.column_stack([places[:, :2], np.full(N, -DEEP)]), anchors=places[:, :2])
    stick = no_stick(N)
    interpreted(find_stick)(
        stick,
        foot.bodies,
        foot.base,
        foot.points,
        np.arange(foot.n),
        foot.springs,
        foot.dynamic,
        foot.rigid,
        foot.rims,
        foot.poses,
    )
    return foot, stick, W


@pytest.mark.long
def test_operator_is_the_compliance_of_all_points_and_its_inverse():
    foot, stick, W = found(1)
    np.testing.assert_allclose(operator_of(stick, N), W, atol=1e-5 * np.abs(W).max())
    static = np.empty((3 * N, 3 * N))
    for column, unit in zip(static.T, np.eye(3 * N)):
        solved, moved = operator_of(stick, N) @ unit, np.empty(3 * N)
        solve_factored(stick.factor, solved)
        np.testing.assert_allclose(solved, unit, atol=1e-9)
        multiply(stick.static, unit, moved)
        column[:] = moved
    np.testing.assert_allclose(
        static,
        operator_of(stick, N) - 3e-11 * np.eye(3 * N) - _elastic(foot),
        atol=1e-5 * np.abs(W).max(),
    )


def _elastic(foot):
    """What of the compliance does not follow forces at once."""
    turn, half = np.kron(np.eye(N), foot.poses[0]["turned"][0]), foot.rigid
    body, arms = foot.bodies.body[0], foot.bodies.arms
    rows = np.concatenate(
        [np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]]) for x, y, z in arms]
    )
    inverse = np.zeros((6, 6))
    inverse[:3, :3], inverse[3:, 3:] = np.eye(3) * body["inverse_mass"], body["inverse_inertia"]
    return turn @ (foot.bodies.mobility + half * rows @ inverse @ rows.T) @ turn.T


@pytest.mark.long
@pytest.mark.parametrize(
    "slips, opens, seed", [(0, 0, 1), (1, 0, 2), (2, 1, 3), (4, 2, 4), (0, 3, 5), (5, 1, 6)]
)
def test_forces_of_a_foot_of_which_some_points_slip_or_open_are_those_of_the_whole_problem(
    slips, opens, seed
):
    """Slacks made from an answer: stuck points have none, slipping ones slip against their
    friction, open ones have a gap.
    """
    foot, stick, _ = found(seed)
    exact, slack = answer(N, slips, opens, seed)
    begun = exact + np.where(
        exact[:, 2:] > 0, np.random.default_rng(seed).normal(0, 20, (N, 3)), 0.0
    )
    after = np.zeros(N, CONTACT)
    after["force"] = begun
    under = slack + (operator_of(stick, N) @ (begun - exact).ravel()).reshape(N, 3)
    residual, _ = interpreted(solve_sticking)(
        stick, foot.points, np.arange(foot.n), under, np.ones(N, bool), after, TIGHT, USABLE
    )
    assert residual <= TIGHT
    np.testing.assert_allclose(after["force"], exact, atol=1e-6 * 1500)
    q = under - (operator_of(stick, N) @ begun.ravel()).reshape(N, 3)
    np.testing.assert_allclose(
        after["force"],
        solve_contact(operator_of(stick, N), q, 0.3, begun, TIGHT).forces,
        atol=1e-6 * 1500,
    )


def test_points_that_take_no_part_carry_nothing():
    """Although they are below the base."""
    foot, stick, _ = found(1)
    exact, slack = answer(N, 2, 2, 1)
    slack[N - 2 :, 2] *= -1
    after, active = np.zeros(N, CONTACT), np.arange(N) < N - 2
    under = slack - (operator_of(stick, N) @ exact.ravel()).reshape(N, 3)
    residual, _ = interpreted(solve_sticking)(
        stick, foot.points, np.arange(foot.n), under, active, after, TIGHT, USABLE
    )
    assert residual <= TIGHT
    np.testing.assert_allclose(after["force"], exact, atol=1e-6 * 1500)


def test_a_foot_that_mostly_opens_is_left_to_the_whole_problem():
    foot, stick, _ = found(1)
    after = np.zeros(N, CONTACT)
    after["force"][:, 2] = 7.0
    slack = np.tile([0.0, 0.0, DEEP], (N, 1))
    slack[0, 2] = -0.5 * DEEP
    residual, _ = interpreted(solve_sticking)(
        stick, foot.points, np.arange(foot.n), slack, np.ones(N, bool), after, TIGHT, USABLE
    )
    assert residual == np.inf and (after["force"][:, 2] == 7.0).all()
    # so is one that was solved no better than usable
    exact, slack = answer(N, 2, 2, 1)
    after["force"] = exact + 7.0
    under = slack + (operator_of(stick, N) @ (after["force"] - exact).ravel()).reshape(N, 3)
    residual, _ = interpreted(solve_sticking)(
        stick, foot.points, np.arange(foot.n), under, np.ones(N, bool), after, TIGHT, 0.0
    )
    assert 0 < residual <= TIGHT and (after["force"] == exact + 7.0).all()


def test_a_contact_problem_with_the_operator_ends_with_the_forces_without_it():
    """All points close: the operator is found once, and nothing else is assembled."""
    foot, W, places = many("nodal", N, 3)
    exact, slack = answer(N, 4, 1, 3)
    positions = (
        np.column_stack([places[:, :2], np.zeros(N)]) + slack - (W @ exact.ravel()).reshape(N, 3)
    )
    foot.counts[:], stick = 0, no_stick(N)
    forces = foot.solve(positions, anchors=places[:, :2], stick=stick)["force"]
    assert stick.key[1] == 1.0 and foot.counts[N_ASSEMBLED] == 1
    np.testing.assert_allclose(forces, exact, atol=1e-5 * exact.max())


DEPTH, WIDTH, ANGLE, HALF = -0.5, 0.2, 0.3, 5e-7


def standing(on_pad=False):
    """An operator found for a foot 0.2 m wide and 0.5 m below the centre of mass."""
    stick, interface = no_stick(1), interface_of(np.array([[0.0, 0, 0], [WIDTH, 0, 0]]))
    interface["on_pad"] = on_pad
    center, rotation = np.array([1.0, 2.0, 3.0]), rotation_matrix(np.array([0, 0, 0.4]))

    def pose(center, rotation):
        place = poses_on_base(rotation[None])
        place["foot"] = center + rotation @ [0, 0, DEPTH]
        return place

    stick.poses[:], stick.angles[:], stick.key[:] = pose(center, rotation), ANGLE, [HALF, 1.0, 0.0]

    def still(moved=(0.0, 0, 0), turned=(0.0, 0, 0), angle=ANGLE, half=HALF, reach=1.0):
        rims = rims_at_rest()
        rims["angle"] = angle
        return interpreted(holds)(
            stick,
            interface,
            rims,
            half,
            pose(center + moved, rotation_matrix(np.array(turned, float)) @ rotation),
            reach,
        )

    return stick, still


def test_operator_holds_while_the_foot_stays_where_it_was_found():
    stick, still = standing()
    assert still() and still(moved=[0.9 * STICK_WAY * WIDTH, 0, 1.0])
    assert not still(moved=[1.1 * STICK_WAY * WIDTH, 0, 0]) and not still(
        moved=[0, -1.1 * STICK_WAY * WIDTH, 0]
    )
    assert still(turned=[0, 0, 0.9 * STICK_TURN]) and not still(turned=[0, 0, 1.1 * STICK_TURN])
    # a column that sways about its foot: the foot stays
    lean = 0.9 * STICK_TURN
    assert still(moved=[-lean * DEPTH, 0, 0], turned=[0, lean, 0])
    assert not still(moved=[-lean * DEPTH, 0, 0]) and not still(turned=[0, lean, 0])
    for turn, way in ((0.9, 0.0), (0.0, 0.9)):
        far = dict(
            turned=[0, 0, 10 * turn * STICK_TURN], moved=[10 * way * STICK_WAY * WIDTH, 0, 0]
        )
        assert not still(**far) and still(**far, reach=10.0) and not still(**far, reach=8.0)
    stick.key[1] = 0.0
    assert not still()


def test_operator_is_of_one_place_of_the_rims_points_and_one_length_of_step():
    stick, still = standing()
    assert not still(angle=ANGLE + 1e-9) and not still(angle=np.nan) and not still(half=HALF / 4)
    stick.angles[0] = np.nan
    assert still(angle=np.nan) and not still()


def test_on_a_pad_the_foot_may_move_farther_unless_it_lifts():
    """Its springs are the same everywhere, but it must stay upright."""
    _, still = standing(on_pad=True)
    assert still(moved=[1.0, 1.0, 1.0], turned=[0, 0.9 * PAD_TURN, 0]) and not still(
        turned=[0, 1.1 * PAD_TURN, 0]
    )
