"""The contact problem of a step: points of a foot on the base that stick, slip, open or stay out of
it, in closed form and by whole matrices.
"""

import numpy as np
import pytest
from one_foot import DEEP, GIVES, Foot, answer, many
from two_blocks import Blocks

from fecolumn.contact.interface import interface_of
from fecolumn.contact.points import BEYOND, CONTACT, OVER, node_points
from fecolumn.contact.problem import list_near_points, room
from fecolumn.contact.tolerances import CLOSE, FORCE_SHARE, NEAR, SOLVED
from fecolumn.foundation._compiled import interpreted


def springs_alone(mu, n=1, static=0.4, **more):
    """n points that do not know of one another, each giving way by GIVES, a part of it at once and
    the rest within the step.
    """
    return Foot(
        np.zeros((n, 3)),
        static * GIVES * np.eye(3 * n),
        (1 - static) * GIVES * np.eye(3 * n),
        mu,
        **more,
    )


@pytest.mark.parametrize("static", [0.0, 0.4, 1.0])
def test_a_pressed_point_sticks_below_the_cone(static):
    """Pulled by a tenth of what presses it, mu 0.3: 1000 N and 100 N, and it is where it was."""
    point = springs_alone(0.3, static=static).solve([[0.1 * DEEP, 0.0, -DEEP]])[0]
    assert point["force"] == pytest.approx([-100.0, 0.0, 1000.0], rel=1e-9)
    assert point["relative"] == pytest.approx(np.zeros(3), abs=2 * SOLVED)


@pytest.mark.parametrize("static", [0.0, 0.4, 1.0])
def test_a_point_pulled_beyond_the_cone_slips_by_what_friction_leaves(static):
    """Pulled by 0.6 and -0.8 of what presses it, mu 0.3: 300 N against the pull, and 0.7 of it is
    left as slip.
    """
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
    """It begins with 1000 N, indented by 1e-6 m: 0.4e-6 m up it keeps 600 N, 1.4e-6 m up it hangs
    0.4e-6 m above the base.
    """
    # of its indentation 0.4 is its static displacement, which `positions` leaves out
    point = springs_alone(0.3).solve([[0.0, 0.0, up - 0.4 * DEEP]], forces=[[0.0, 0.0, 1000.0]])[0]
    assert point["force"] == pytest.approx([0.0, 0.0, load], rel=1e-9)
    assert point["relative"][2] == pytest.approx(max(up - DEEP, 0.0), abs=2 * SOLVED)


@pytest.mark.long
@pytest.mark.parametrize("kind", ["alone", "nodal", "by mass and inertia"])
def test_a_point_above_the_base_carries_nothing_however_small(kind):
    """It begins 1e-6 m up with 0.004 N, which indents 4e-12 m: less than the length to which the
    laws hold, and yet a force that nothing presses.
    """
    if kind == "alone":
        foot, carries = springs_alone(0.3), []
    else:
        # the other end of the rod stands, pressed by a thousand newtons
        foot, carries = rod(kind, 0.0)[0], [[-1.0, 0.0, -DEEP]]
    places = carries + [[1.0, 0.0, 2 * DEEP]]
    after = foot.solve(
        places,
        forces=[[0.0, 0, 100]] * len(carries) + [[0.0, 0, 0.004]],
        anchors=[place[:2] for place in places],
    )
    assert after["relative"][-1, 2] > DEEP
    assert (after["force"][-1] == 0.0).all()


def test_a_stiff_point_finds_its_force_to_a_thousandth_whatever_it_began_with():
    """100 N indent 1e-10 m; 105 N are wrong by 5e-12 m, less than the length to which softer
    contacts are solved.
    """
    gives, load = 1e-12, 100.0
    foot = Foot(np.zeros((1, 3)), gives * np.eye(3), np.zeros((3, 3)), 0.3)
    after = foot.solve([[0.0, 0, -gives * load]], forces=[[0.0, 0, 1.05 * load]])[0]
    assert after["force"][2] == pytest.approx(load, rel=2 * FORCE_SHARE)


def test_points_above_the_base_take_no_part():
    """Pressed; below NEAR, but open; above NEAR; above CLOSE, where nobody asks for the static
    displacement.
    """
    foot = springs_alone(0.3, n=4)
    after = foot.solve(
        [[0.0, 0, -DEEP], [0, 0, 0.9 * NEAR], [0, 0, 1.1 * NEAR], [0, 0, 1.1 * CLOSE]]
    )
    assert foot.problem.active.tolist() == [True, True, False, False]
    assert after["located"].tolist() == [True, True, True, False]
    assert after["force"][:, 2] == pytest.approx([1000.0, 0, 0, 0], rel=1e-9)


def test_a_point_beyond_an_outline_is_found_anew_where_it_comes_back():
    """It is put as high above the surface as the foot is wide: an impact from there would be booked
    with all the way.
    """
    places = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    points, contact = node_points(places, 0.5), np.zeros(2, CONTACT)
    points["beyond"], contact["force"][:, 2] = [OVER, BEYOND], 1e3
    after = contact.copy()
    interpreted(list_near_points)(
        room(points),
        np.arange(2),
        points,
        interface_of(places),
        places[:, [1, 2, 0]],
        contact,
        after,
    )
    assert after["located"].tolist() == [True, False]


def test_a_point_above_near_that_others_push_below_the_base_is_taken_in():
    """Two points that tilt against each other, C = [[1, -1/2], [-1/2, 1]] c: the first alone would
    push the second through the base.
    """
    C, sunk = GIVES * np.array([[1.0, -0.5], [-0.5, 1.0]]), np.array([-4 * NEAR, 1.5 * NEAR])
    static = np.zeros((6, 6))
    static[::3, ::3] = static[1::3, 1::3] = static[2::3, 2::3] = C
    foot = Foot(np.zeros((2, 3)), static, np.zeros((6, 6)), 0.3)
    after = foot.solve([[0.0, 0.0, z] for z in sunk])
    assert foot.problem.active.all()
    # by hand: (4 - 0.75, 2 - 1.5) NEAR / (0.75 c)
    assert after["force"][:, 2] == pytest.approx(
        np.array([3.25, 0.5]) * NEAR / (0.75 * GIVES), rel=1e-9
    )
    assert np.abs(after["relative"]).max() < 2 * SOLVED


def rod(kind, mu, half=5e-9):
    """Mass 2 kg, inertia 0.5 kg m2, two points 1 m to each side of the centre of mass and a little
    below it; they give way by themselves, too.
    """
    arms, mass, inertia = (
        np.array([[-1.0, 0, -0.1], [1.0, 0, -0.1]]),
        2.0,
        np.diag([0.01, 0.5, 0.5]),
    )
    static = elastic = 0.2 * GIVES * np.eye(6)
    rigid = half * Blocks.rigid(mass, inertia, arms)
    if kind == "nodal":
        return Foot(arms, static, elastic + rigid, mu), static + elastic + rigid
    return Foot(arms, static, elastic, mu, mass, inertia, half), static + elastic + rigid


@pytest.mark.parametrize("kind", ["nodal", "by mass and inertia"])
def test_two_points_below_a_rigid_body_share_its_weight_by_its_mobility(kind):
    """Both sunk by u press with u / (W11 + W12), W11 + W12 = dt^2 / 2 (2 / m) + C; one alone with u
    / W11, and the other is tilted up.
    """
    half, C = 5e-9, 0.4 * GIVES
    foot, _ = rod(kind, 0.0)
    both = foot.solve([[-1.0, 0.0, -DEEP], [1.0, 0.0, -DEEP]], anchors=[[-1.0, 0], [1.0, 0]])
    assert both["force"][:, 2] == pytest.approx(DEEP / (half * 2 / 2.0 + C), rel=1e-6)
    one = foot.solve([[-1.0, 0.0, -DEEP], [1.0, 0.0, 10 * DEEP]], anchors=[[-1.0, 0], [1.0, 0]])
    own, coupled = half * (1 / 2.0 + 1 / 0.5) + C, half * (1 / 2.0 - 1 / 0.5)
    assert one["force"][:, 2] == pytest.approx([DEEP / own, 0.0], rel=1e-6)
    assert one["relative"][1, 2] == pytest.approx(10 * DEEP + coupled / own * DEEP, rel=1e-6)


@pytest.mark.parametrize("kind", ["nodal", "by mass and inertia"])
@pytest.mark.parametrize(
    "n, slips, opens", [(2, 1, 0), (2, 1, 1), (7, 2, 2), (12, 7, 2), (12, 3, 6)]
)
def test_a_foot_that_sticks_slips_and_opens_in_part_finds_the_forces_that_obey_the_laws(
    kind, n, slips, opens
):
    """The answer is chosen, and from it where the points would be without forces; whole matrices
    tell.
    """
    foot, W, places = many(kind, n, 3)
    forces, slack = answer(n, slips, opens, 5)
    free = slack - (W @ forces.ravel()).reshape(n, 3)
    after = foot.solve(np.column_stack([places[:, :2], np.zeros(n)]) + free, anchors=places[:, :2])
    # the base's shares move by the way of the points over its width, 1e-6
    np.testing.assert_allclose(after["force"], forces, atol=1e-5 * forces.max())
    gives_alone = 3e-11 * forces
    np.testing.assert_allclose(
        after["relative"] - np.column_stack([places[:, :2], np.zeros(n)]),
        slack - gives_alone,
        atol=1e-5 * DEEP,
    )
