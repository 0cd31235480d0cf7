"""What the stick operator leaves undone, foreseen from the step before."""

import numpy as np
import pytest

from fecolumn.contact.points import CONTACT, POINT
from fecolumn.engines.reduced.secant import no_secant, predict_slips, update_secant

N = 5
SLACK = np.random.default_rng(0).standard_normal((N, 3))
LEFT = 1e-4 * np.random.default_rng(1).standard_normal((N, 3))


def learnt(force=(1.0, 2.0, 10.0)):
    """After a step whose first forces left LEFT of SLACK."""
    secant, points, contact = no_secant(N), np.zeros(N, POINT), np.zeros(N, CONTACT)
    points["friction"], contact["force"] = 0.3, (1.0, 2.0, 10.0)
    contact["force"][2] = force
    predict_slips(secant, np.arange(N), SLACK.copy())
    update_secant(secant, points, np.arange(N), LEFT, contact)
    return secant, points, contact


def foreseen(secant, slack):
    changed = slack.copy()
    predict_slips(secant, np.arange(N), changed)
    return changed - slack


def test_the_first_step_foresees_nothing():
    assert (foreseen(no_secant(N), SLACK) == 0.0).all()


@pytest.mark.parametrize("share", [2.0, -0.5])
def test_what_is_left_is_foreseen_in_proportion(share):
    assert foreseen(learnt()[0], share * SLACK) == pytest.approx(share * LEFT, rel=1e-12)


def test_what_was_foreseen_counts_as_left():
    """A step that met the laws at once teaches the same."""
    secant, points, contact = learnt()
    predict_slips(secant, np.arange(N), 2 * SLACK)
    update_secant(secant, points, np.arange(N), np.zeros((N, 3)), contact)
    assert foreseen(secant, SLACK) == pytest.approx(LEFT, rel=1e-12)


@pytest.mark.parametrize("force", [(0.0, 0.0, 0.0), (0.0, 3.0, 10.0)])
def test_nothing_is_learnt_where_a_point_opens_or_slips(force):
    assert (foreseen(learnt(force)[0], SLACK) == 0.0).all()
