import numpy as np
import pytest

from fecolumn.contact.interface import INTERFACE
from fecolumn.contact.pad import Pad, Springs, dashpot_work, indent, springs_of
from fecolumn.contact.points import CONTACT, node_points


def interfaces(relaxation: float) -> np.ndarray:
    """One interface, on a pad where its relaxation [s] is not nan."""
    one = np.zeros(1, INTERFACE)
    one["on_pad"], one["relaxation"] = relaxation == relaxation, relaxation
    return one


def pad(stiffness: float, relaxation: float, dt: float = 1e-3):
    """One point on a pad: its points and springs in a step, and what it carries before and
    after.
    """
    points = node_points(np.zeros((1, 3)), 0.5, pad=Pad(np.full((1, 3), stiffness), relaxation))
    return (
        points,
        springs_of(points, interfaces(relaxation), dt),
        np.zeros(1, CONTACT),
        np.zeros(1, CONTACT),
    )


@pytest.mark.parametrize("relaxation", [0.0, 2e-4, 1e-2])
def test_springs_and_dashpots_take_no_more_than_the_forces_give(relaxation):
    """Pressed, eased and let go of, in steps longer and shorter than the relaxation time."""
    points, springs, before, after = pad(1e5, relaxation)
    taken, given = [], 0.0
    for force in (50.0, 120.0, 120.0, 60.0, 1.0, 0.0, 0.0):
        after["force"] = 0.1 * force, 0.0, force
        indent(points, springs, before, after)
        taken.append(dashpot_work(points, springs, before, after))
        given += float(
            np.sum(
                after["force"]
                * (springs.give * after["force"] + (springs.kept - 1) * before["indentation"])
            )
        )
        before["indentation"] = after["indentation"]
    assert min(taken) > -1e-15 and before["indentation"][0, 2] >= 0
    assert sum(taken) + 0.5e5 * np.sum(before["indentation"] ** 2) == pytest.approx(
        given, rel=1e-12
    )


def test_force_of_a_step_is_that_of_the_midpoint():
    points, springs, before, after = pad(2e4, 3e-3)
    before["indentation"], after["force"] = (0.0, 0.0, 1e-3), (0.0, 0.0, 70.0)
    indent(points, springs, before, after)
    u0, u1 = before["indentation"][0, 2], after["indentation"][0, 2]
    assert 2e4 * (u0 + u1) / 2 + 2e4 * 3e-3 * (u1 - u0) / 1e-3 == pytest.approx(70.0, rel=1e-12)


def test_point_without_pad_gives_by_its_contact_law_alone():
    points = node_points(np.zeros((2, 3)), 0.5, law=np.full((2, 3), 1e-9))
    springs = springs_of(points, interfaces(np.nan), 1e-3)
    assert isinstance(springs, Springs) and np.all(springs.own == 1e-9) and not springs.give.any()
