"""The turn of a body in a step, however slender it is and however fast it turns."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fecolumn.contact.bodies import BODY
from fecolumn.engines.reduced.rotation import Turning, turning


@pytest.mark.long
@pytest.mark.parametrize("slender", [1.0, 0.1, 1 / 128])
@pytest.mark.parametrize("angle", [0.01, 0.3, 1.0])
def test_a_free_body_keeps_its_energy_whatever_its_turn(slender, angle):
    """The equation of the turn is solved: its momentum turned back has the energy it had."""
    inertia = np.diag([1.0, 1.2, slender])
    body = np.zeros(1, BODY)
    body["inertia"], body["inverse_inertia"] = inertia, np.linalg.inv(inertia)
    advance, rotation = angle * np.array([0.1, 1.0, 0.3]), Rotation.from_rotvec([0.2, 0.5, -0.3])
    turn, moment, halfway = advance.copy(), np.zeros(3), np.zeros((3, 3))
    still = np.zeros((3, 3))
    start = rotation.as_matrix()
    given = Turning(body[0], advance, start, 0.0, still, np.zeros(3), moment, halfway)
    assert turning(given, turn)
    after = Rotation.from_rotvec(-turn).as_matrix() @ inertia @ advance
    energy = advance @ inertia @ advance
    assert after @ np.linalg.solve(inertia, after) == pytest.approx(energy, rel=1e-11)
    mean = rotation * Rotation.from_rotvec(turn / 2)
    assert halfway == pytest.approx(mean.as_matrix(), abs=1e-11)
