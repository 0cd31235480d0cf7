"""Points of two drums that come over the outline of a face while these press on one another: each
carries, and none is left out while one drum sinks into the other.
"""

import numpy as np
import pytest

from fecolumn.contact.points import SUNK
from fecolumn.engines.passing import Passing
from fecolumn.engines.reduced.observe import WIDTH, column_index
from fecolumn.verification.joint_bodies import BELOW, two

RADIUS, HEIGHT = 0.2, 0.8
DRUM = dict(
    kind="cylinder", outer_diameter_m=2 * RADIUS, density_kg_m3=2600.0, youngs_modulus_pa=5e9
)


def _depth(made):
    """How deep [m] the circle of either face is below the other face, within its outline: by
    geometry alone, of bodies that do not deform.
    """
    angles = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    circle = RADIUS * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    centers, R = made.motion.frames["center"][:2], made.motion.rotation
    heights = (BELOW / 2, -HEIGHT / 2)
    depth = 0.0
    for on, of in ((0, 1), (1, 0)):
        places = centers[of] + (circle + [0.0, 0.0, heights[of]]) @ R[of].T
        seen = (places - centers[on]) @ R[on]
        inside = np.hypot(seen[:, 0], seen[:, 1]) < RADIUS
        out = np.sign(heights[on])
        depth = max(depth, (out * (heights[on] - seen[inside, 2])).max(initial=0.0))
    return depth


def _slid(engine, **more):
    """A drum that has slid to and fro by a millimetre, so that the outlines crossed three times;
    its foot then sticks.
    """
    made = two(
        engine,
        DRUM | dict(at_m=[-1e-3, 0.0, BELOW]) | more,
        DRUM | more,
        contact=dict(friction_coefficient=0.1),
    )
    for velocity, steps in ((0.2, 14), (-0.2, 6), (0.2, 6)):
        made.motion.frames["velocity"][1] = [velocity, 0.0, 0.0]
        made.advance(np.zeros((steps, 3)))
    made.motion.frames["velocity"][1] = 0.0
    made.work.points["friction"] = 0.8
    return made


@pytest.mark.long
def test_no_point_of_a_pressed_face_is_left_out():
    made = _slid("reduced")
    points, force = made.work.points, made.motion.contact["force"][:, 2]
    joint = (points["interface"] > 0) & ~points["idle"]
    assert not (points["beyond"][joint] == SUNK).any()
    # what is raised carries as it comes down: within as many steps as that takes
    made.advance(np.zeros((200, 3)))
    force = made.motion.contact["force"][:, 2]
    assert (force[joint] > 0).mean() > 0.9


@pytest.mark.parametrize("side", [1, -1])
def test_a_drum_that_is_shaken_over_after_it_has_slid_does_not_sink(side):
    """It was 8 mm in the other one, and told 4e-12 m: of 35 points 15 were left out for good."""
    made, depth, told, closure = _slid("reduced"), 0.0, 0.0, []
    for _ in range(300):
        rows, _ = made.advance([[5.2 * side, 0.0, 0.0]])
        depth = max(depth, _depth(made))
        told = max(told, rows[0, column_index("penetration")])
        closure.append(rows[0, WIDTH - 1])
    assert np.hypot(*made.motion.rotation[1][:2, 2]) > 5e-3
    # faces bend by that much, which the corners of a rigid one do not tell
    assert depth < 5e-5 and told < 1e-5 and np.ptp(closure) < 1e-10


def test_bodies_that_a_joint_lets_sink_into_each_other_are_told_once():
    made = two("rigid", DRUM | dict(at_m=[0.0, 0.0, BELOW]), DRUM)
    passing = Passing(made.model)
    assert passing.overlaps(made.motion) == ""
    made.motion.frames["center"][1, 2] -= 5e-4
    assert passing.overlaps(made.motion) == ""
    made.motion.frames["center"][1, 2] -= 1.5e-3
    told = passing.overlaps(made.motion)
    assert '"low" and "up"' in told and "by 0.002 m" in told
    assert passing.overlaps(made.motion) == ""
