"""Points of a round rim that roll along with its lowest one: where they are, what they take along
and how high they stand, on an exact circle.
"""

import numpy as np
import pytest

from fecolumn.contact.interface import interface_of, rims_at_rest
from fecolumn.contact.points import CONTACT, node_points
from fecolumn.contact.rim import Rim
from fecolumn.contact.rolling import NEW, OLD, part_of_step, plan_roll, roll_points, stay
from fecolumn.contact.tolerances import FLAT, PARTS, REACH, ROLL, ROLL_STEP
from fecolumn.fem.rotation import rotation_matrix

N, RADIUS, HEIGHT, TILT = 24, 0.05, 0.3, 0.02
SECTOR = 2 * np.pi / N
REACHED = range(-REACH, REACH + 1)


def leaning(azimuth, tilt=TILT):
    """Rotation of a column that leans by `tilt` towards `azimuth` [rad] without twist."""
    return rotation_matrix(tilt * np.array([-np.sin(azimuth), np.cos(azimuth), 0.0]))


class Foot:
    """A rim of N nodes at the start of a step, its points turned to `angle` [rad], on the nodes for
    None; lowest at `azimuth`.

    The point there and those beside it carry `forces`, at `about` [rad] if it is given; they are
    anchored and positioned anyhow.
    """

    def __init__(self, angle, azimuth, forces=(100.0, 300.0, 50.0), tilt=TILT, about=None):
        circle = 2 * np.pi * np.arange(N) / N - 1.0
        self.arms = np.column_stack(
            [RADIUS * np.cos(circle), RADIUS * np.sin(circle), np.full(N, -HEIGHT)]
        )
        rim = Rim.find(self.arms)
        self.nodes, self.interface, self.points = (
            np.asarray(rim.nodes, np.int64),
            interface_of(self.arms, rim)[0],
            node_points(self.arms, 0.5),
        )
        self.first, self.rim = rim.first, rims_at_rest()
        self.rotation, self.contact, rng = (
            leaning(azimuth, tilt),
            np.zeros(N, CONTACT),
            np.random.default_rng(1),
        )
        if angle is not None:
            self.rim["angle"] = angle
        number = round(((about or angle or azimuth) - self.first) / SECTOR)
        for off, force in zip(range(-(len(forces) // 2), len(forces) // 2 + 1), forces):
            self.contact["force"][self.nodes[(number + off) % N]] = [
                0.1 * force,
                0.2 * force,
                force,
            ]
        self.contact["anchor"], self.contact["relative"] = (
            rng.normal(size=(N, 2)),
            rng.normal(size=(N, 3)),
        )
        self.contact["located"] = True

    @property
    def places(self):
        return self.arms @ self.rotation.T

    def plan(self, halfway, allowed=True):
        """(whether it rolls, Roll) towards the rotation halfway."""
        rolls, _, roll = plan_roll(
            self.interface, self.nodes, self.rim[0], self.contact, self.rotation, halfway, allowed
        )
        return rolls, roll

    def roll(self, roll):
        """What the points bring to the step."""
        before = self.contact.copy()
        roll_points(
            roll, self.nodes, self.rim[0], self.arms, self.places, self.contact, self.points, before
        )
        return before

    def angle_of(self, roll, which, k):
        """Angle [rad] at which point k of the rim is on a circle of the Roll."""
        return self.first + (k + roll.phase[which]) * SECTOR

    def on_circle(self, angle):
        """Arm (3,) of the circle at an angle."""
        return np.array([RADIUS * np.cos(angle), RADIUS * np.sin(angle), -HEIGHT])


def steady(half_turn, azimuth=0.7, **more):
    """A foot that rolls by `half_turn` [rad] in half a step, and did so in the last one."""
    foot = Foot(azimuth - half_turn, azimuth, **more)
    # what the rule gave it then: height of the points before, of the lowest place, and behind
    foot.rim["lift"][0] = [drop(off * SECTOR) - drop(half_turn - off * SECTOR) for off in REACHED]
    return foot, leaning(azimuth + half_turn)


def drop(angle):
    """Height [m] over the foot's middle of the rim `angle` [rad] beside its lowest place, -a
    sin(tilt) cos(angle).
    """
    return -RADIUS * np.sin(TILT) * np.cos(angle)


@pytest.mark.parametrize("half_turn", [0.02, -0.02, 0.21, -0.3])
def test_points_roll_on_with_the_lowest_one_and_take_their_forces_along(half_turn):
    """Each lies on the circle; the strongest stays the lowest, whatever number it has; anchor and
    place have gone the way along the rim.
    """
    foot, halfway = steady(half_turn)
    rolls, roll = foot.plan(halfway)
    before = foot.roll(roll)
    assert (
        rolls
        and not roll.leaps
        and foot.rim["angle"][0] == pytest.approx(0.7 + half_turn, abs=1e-12)
    )
    for k in range(N):
        point, angle = foot.points[foot.nodes[k]], foot.angle_of(roll, NEW, k)
        np.testing.assert_allclose(point["arm"], foot.on_circle(angle), atol=1e-14)
        np.testing.assert_allclose(
            point["weights"] @ foot.arms[point["carriers"]], point["arm"], atol=1e-16
        )
        i, taken = foot.nodes[k], foot.nodes[(k - roll.passed) % N]
        assert (before["force"][i] == foot.contact["force"][taken]).all()
        was = foot.angle_of(roll, OLD, (k - roll.passed) % N)
        # the place goes on by twice half a step: the last one's and this one's
        assert (angle - was - 2 * half_turn + np.pi) % (2 * np.pi) - np.pi == pytest.approx(
            0.0, abs=1e-12
        )
        way = foot.rotation @ (foot.on_circle(angle) - foot.on_circle(was))
        np.testing.assert_allclose(
            before["anchor"][i] - foot.contact["anchor"][taken], way[:2], atol=1e-14
        )
        np.testing.assert_allclose(
            before["relative"][i, :2] - foot.contact["relative"][taken, :2], way[:2], atol=1e-14
        )
    strongest = np.argmax(before["force"][:, 2])
    assert foot.nodes[roll.index[NEW]] == strongest and before["force"][strongest, 2] == 300.0


@pytest.mark.parametrize("half_turn", [0.02, -0.02, 0.3])
def test_in_steady_rolling_the_lowest_point_keeps_its_height_and_those_beside_it_do_opposite_work(
    half_turn,
):
    """Heights from the rotations at both ends of the step: gap(lowest) the same, gap(off) +
    gap(-off) the same.
    """
    foot, halfway = steady(half_turn)
    _, roll = foot.plan(halfway)
    foot.roll(roll)
    ends = [foot.rotation, leaning(0.7 + 2 * half_turn)]
    lift = foot.rim["lift"][0]
    heights = {
        off: [
            (R @ foot.points["arm"][foot.nodes[(roll.index[NEW] + off) % N]])[2]
            + HEIGHT * np.cos(TILT)
            + lift[REACH + off]
            for R in ends
        ]
        for off in REACHED
    }
    assert heights[0] == pytest.approx([drop(0.0)] * 2, abs=1e-13)
    for off in range(1, REACH + 1):
        work = [end - start for start, end in (heights[off], heights[-off])]
        assert sum(work) == pytest.approx(0.0, abs=1e-13) and abs(work[0]) > 1e-5 * RADIUS
    # at the step's end all of them are where those of the start's lowest place were
    assert [heights[off][1] for off in REACHED] == pytest.approx(
        [drop(off * SECTOR) for off in REACHED], abs=1e-13
    )
    assert [
        foot.points["lift"][foot.nodes[(roll.index[NEW] + off) % N]] for off in REACHED
    ] == pytest.approx(lift)


def test_what_the_rule_left_over_stays_in_the_lift_while_the_rim_carries_and_goes_when_it_is_free():
    extra = 1e-6
    for forces, kept in (((300.0,), extra), ((0.0,), 0.0)):
        foot, halfway = steady(0.02)
        _, roll = foot.plan(halfway)
        foot.roll(roll)
        usual = foot.rim["lift"][0].copy()
        foot, halfway = steady(0.02, forces=forces)
        foot.rim["lift"] += extra
        rolls, roll = foot.plan(halfway)
        foot.roll(roll)
        assert rolls and foot.rim["lift"][0] == pytest.approx(usual + kept, abs=1e-14)


def test_a_point_that_was_not_located_starts_afresh_unless_the_lowest_place_is_near():
    foot, halfway = steady(0.02)
    foot.contact["located"] = False
    _, roll = foot.plan(halfway)
    before = foot.roll(roll)
    taken = foot.contact[foot.nodes[(np.arange(N) - roll.passed) % N]]
    moved = np.abs(before["anchor"][foot.nodes] - taken["anchor"]).max(axis=1)
    near = (roll.index[NEW] + np.array(REACHED)) % N
    far = np.setdiff1d(np.arange(N), near)
    assert (
        not before["located"][foot.nodes[far]].any()
        and not moved[far].any()
        and (moved[near] > 1e-5).all()
    )


@pytest.mark.parametrize("on_nodes", [True, False])
def test_points_that_stay_keep_their_places_and_heights(on_nodes):
    """On their nodes, or where the last step left them on the circle; whatever the column does
    halfway.
    """
    foot = Foot(None if on_nodes else 0.55, 0.7)
    foot.rim["lift"][0] = [1e-6, -2e-6, 3e-6, 0.0, 5e-6]
    _, roll = foot.plan(leaning(0.9))
    stay(roll, foot.nodes, foot.rim[0], TILT, foot.arms, foot.points)
    for k, i in enumerate(foot.nodes):
        place = foot.arms[i] if on_nodes else foot.on_circle(foot.angle_of(roll, OLD, k))
        np.testing.assert_allclose(foot.points["arm"][i], place, atol=1e-14)
        assert foot.points["count"][i] == (1 if on_nodes else 4)
    lifted = foot.nodes[(roll.index[OLD] + np.array(REACHED)) % N]
    assert (
        foot.points["lift"][lifted].tolist()
        == [1e-6, -2e-6, 3e-6, 0.0, 5e-6]
        == foot.rim["lift"][0].tolist()
    )
    assert not foot.points["lift"][np.setdiff1d(foot.nodes, lifted)].any()


def test_no_point_stays_below_the_rim_of_a_foot_that_is_flat():
    foot = Foot(0.55, 0.7, tilt=FLAT / 2)
    foot.rim["lift"][0] = [1e-6, -2e-6, 3e-6, 0.0, -5e-6]
    _, roll = foot.plan(foot.rotation)
    stay(roll, foot.nodes, foot.rim[0], FLAT / 2, foot.arms, foot.points)
    assert foot.rim["lift"][0].tolist() == [1e-6, 0.0, 3e-6, 0.0, 0.0]


def test_nothing_rolls_below_flat_or_where_it_must_not():
    assert not Foot(0.68, 0.7, tilt=FLAT).plan(leaning(0.72, 0.9 * FLAT))[0]
    assert Foot(0.68, 0.7, tilt=FLAT).plan(leaning(0.72, 1.1 * FLAT))[0]
    assert not Foot(0.68, 0.7).plan(leaning(0.72), allowed=False)[0]


def test_where_the_lowest_point_leaps_the_rim_waits_until_what_carried_is_free():
    """A column rocks over to the other side: its rim rolls there only if nothing carries, or
    something does where it comes down.
    """
    across = leaning(0.7 + np.pi)
    loaded, free, landed = (
        Foot(0.7, 0.7),
        Foot(0.7, 0.7, forces=(0.0,)),
        Foot(0.7, 0.7, about=0.7 + np.pi),
    )
    assert [foot.plan(across)[0] for foot in (loaded, free, landed)] == [False, True, True]
    assert all(foot.plan(across)[1].leaps for foot in (loaded, free, landed))
    less, more = (
        Foot(0.7, 0.7).plan(leaning(0.7 + share * ROLL))[1].leaps for share in (0.99, 1.01)
    )
    assert not less and more


def test_a_contact_that_rolls_on_widens_without_landing_and_one_that_comes_down_lands():
    """Points beside the lowest one of a rim that carries belong to it; with nothing carried, after
    a leap, and where the points stay, all of them may land.
    """
    foot, halfway = steady(0.02)
    roll = foot.plan(halfway)[1]
    foot.roll(roll)
    away = [
        (foot.angle_of(roll, NEW, k) - roll.angle + np.pi) % (2 * np.pi) - np.pi for k in range(N)
    ]
    assert (foot.points["rolls"][foot.nodes] == (np.abs(away) <= ROLL)).all() and 1 < foot.points[
        "rolls"
    ].sum() < N / 2
    for other, towards in (
        (Foot(0.7, 0.7, forces=(0.0,)), 0.72),
        (Foot(0.7, 0.7, about=0.7 + np.pi), 0.7 + np.pi),
    ):
        other.points["rolls"] = True
        other.roll(other.plan(leaning(towards))[1])
        assert not other.points["rolls"].any()
    foot.points["rolls"] = True
    stay(foot.plan(halfway)[1], foot.nodes, foot.rim[0], TILT, foot.arms, foot.points)
    assert not foot.points["rolls"].any()


def test_a_foot_that_stands_does_not_roll_however_it_tilts():
    """Points across the foot from its lowest one carry: a soft base that gives way by 2e-4 rad
    under a moment.
    """
    foot = Foot(None, 0.7, tilt=2e-4)
    foot.contact["force"][:, 2] = 10.0
    assert not foot.plan(leaning(0.72, 2e-4))[0]


def parts(x, y, u, v, dt):
    """Parts of a step in which the way down goes on straight: (k,) of PARTS."""
    made = []
    while sum(made) < PARTS:
        done = sum(made) / PARTS * dt
        made.append(part_of_step(x + done * u, y + done * v, u, v, dt, sum(made)))
    return made


@pytest.mark.parametrize("run, count", [(0.5, 1), (0.99, 1), (1.5, 2), (3.0, 4), (7.0, 8)])
def test_a_wobble_is_made_in_parts_of_the_angle_that_a_step_may_run(run, count):
    dt, tilt = 1e-3, 0.005
    assert part_of_step(tilt, 0.0, 0.0, tilt * run * ROLL_STEP / dt, dt, 0) == PARTS // count


@pytest.mark.parametrize("nearest", [2 * FLAT, 1e-4, 1e-3])
def test_a_pass_beside_upright_is_made_in_parts_that_turn_little_each(nearest):
    """At 0.1 rad/s in steps of 1 ms past a tilt of `nearest`: smallest where the foot is flattest,
    and all of them make the step.
    """
    dt, speed = 1e-3, 0.1
    x = -0.4 * speed * dt
    made = parts(x, nearest, speed, 0.0, dt)
    ways = x + speed * dt * np.concatenate([[0], np.cumsum(made)]) / PARTS
    assert sum(made) == PARTS and np.abs(np.diff(np.arctan2(nearest, ways))).max() <= ROLL_STEP
    assert len(made) > 1 or nearest == 1e-3


def test_planar_rocking_over_and_standing_are_one_step():
    """Exactly towards upright, past it below FLAT, faster past it than the smallest part tells, and
    a foot that sways below FLAT.
    """
    for x, y, u, v, dt in (
        (-5e-5, 0.0, 0.1, 0.0, 1e-3),
        (-5e-5, 0.9 * FLAT, 0.1, 0.0, 1e-3),
        (-5e-3, 2 * FLAT, 10.0, 0.0, 1e-3),
        (0.5 * FLAT, 0.0, 0.0, 1e-4, 1e-3),
        (0.0, 0.0, 0.0, 0.0, 1e-3),
    ):
        assert part_of_step(x, y, u, v, dt, 0) == PARTS


@pytest.mark.parametrize("azimuth", 0.7 + np.pi + np.array([-0.12, -0.05, 0.0, 0.03, 0.1]))
def test_after_a_leap_the_nearest_point_that_rested_there_takes_the_lowest_place(azimuth):
    foot = Foot(0.78, 0.7, forces=(0.0,))
    _, roll = foot.plan(leaning(azimuth))
    place = foot.angle_of(roll, OLD, roll.index[NEW] - roll.passed)
    assert roll.leaps and abs((place - azimuth + np.pi) % (2 * np.pi) - np.pi) <= SECTOR / 2
    before = foot.roll(roll)
    carried = before["force"][foot.nodes], foot.contact["force"][foot.nodes]
    assert (carried[0] == np.roll(carried[1], roll.passed, axis=0)).all()
