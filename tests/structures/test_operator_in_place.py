"""The operator of feet that stick, in structures of elastic bodies, says how forces change and not
where points are.
"""

import numpy as np
import pytest
from small_structures import STONE, structure

from fecolumn.engines.reduced.observe import column_index
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

DT, STEPS = 1e-3, 160


def lintel_on_two_posts():
    """A stone on two posts, all with ten modes."""
    post = dict(kind="block", length_m=0.3, width_m=0.3, height_m=1.6, element_size_m=0.15)
    return structure(
        bodies=dict(
            post=post | STONE | dict(modes=10, copies_m=[[0.7, 0, 0], [-0.7, 0, 0]]),
            lintel=dict(
                kind="block",
                length_m=2.0,
                width_m=0.3,
                height_m=0.4,
                at_m=[0, 0, 1.6],
                element_size_m=0.15,
                modes=10,
            )
            | STONE,
        ),
        joints=dict(feet=dict(between=["post", "ground"]), heads=dict(between=["post", "lintel"])),
        contact=dict(friction_coefficient=0.7, interior_points=0),
        integration=dict(engine="reduced", dt_s=DT),
    )


def histories(share: float, anew: bool):
    """Rows of a sine of 3 Hz of so much of what lifts a foot; anew: with an operator that is
    found in each step in which any would do. And the times that a compliance was assembled.
    """
    case = lintel_on_two_posts()
    engine = engine_of(case, structure_model(case), "posts")
    t = DT * np.arange(1, STEPS + 1)
    ground = np.outer(share * 9.80665 * 0.3 / 1.6 * np.sin(6 * np.pi * t), [1.0, 0.3, 0.0])
    rows = []
    for one in ground:
        if anew:
            engine.work.stick.key[1] = 0.0
        rows.append(engine.advance(one[None])[0][0].copy())
    return np.array(rows), engine.counts[-1]


@pytest.mark.parametrize("share", [0.5, 1.2])
def test_the_motion_does_not_depend_on_when_the_operator_was_found(share):
    """Up to what a step may leave of the laws, over the largest way."""
    held, few = histories(share, False)
    found, many = histories(share, True)
    assert few < many / 2
    at = column_index("u_top")
    ways = [rows[:, at : at + 3] for rows in (held, found)]
    assert np.abs(ways[0] - ways[1]).max() < 1e-9 * np.abs(ways[1]).max()
