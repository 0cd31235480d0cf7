"""Structures of the comparisons, standing on a ground whose top is z = 0; widths and heights in
m.
"""

from __future__ import annotations

import numpy as np

from benchmarks.planar.bodies import BOTTOM, LEFT, RIGHT, TOP, Body, Joint, Structure, quadrilateral

FRICTION = 0.7
GROUND = Body("ground", quadrilateral(100.0, 100.0, 1.0, (0.0, -1.0)), fixed=True)
#: Two equal blocks, five drums, a stack of four: width, height of each
BLOCK, DRUM, COURSE = (0.4, 0.8), (0.9, 0.6), (0.4, 0.4)
#: Column of seven drums and a capital (benchmark of HybriDFEM): heights, widths at the ground and
#: at the top, density [kg/m3]
TAPERING = dict(heights=(0.82,) * 7 + (0.21,), widths=(1.11, 0.90), density=2620.0)
#: Two blocks beside each other: width, height of each, gap
PAIR = dict(first=(0.3, 1.0), second=(0.4, 1.0), gap=0.02)
#: Columns and beam of the rocking frame and of the trilith: width, height
FRAME, TRILITH = (
    dict(column=(0.3, 2.0), beam=(3.3, 0.3), span=3.0),
    dict(column=(0.22, 0.8), beam=(1.1, 0.139), span=0.8),
)


def stack(sizes, offsets=None, friction: float = FRICTION, density: float = 2500.0) -> Structure:
    """Quadrilaterals on one another.

    Parameters
    ----------
    sizes
        (width, height) or (width below, width above, height) of each from below.
    offsets
        of each along x [m].
    """
    bodies, joints, level = [GROUND], [], 0.0
    for number, (size, x) in enumerate(
        zip(sizes, offsets if offsets is not None else np.zeros(len(sizes))), 1
    ):
        below, above, height = size if len(size) == 3 else (size[0], *size)
        bodies.append(
            Body(f"block {number}", quadrilateral(below, above, height, (x, level)), density)
        )
        joints.append(Joint(number, BOTTOM, number - 1, TOP, friction))
        level += height
    return Structure(tuple(bodies), tuple(joints))


def two_blocks(d: float = 0.0, size=BLOCK) -> Structure:
    """Two equal blocks, the upper one displaced by d [m] towards +x."""
    return stack([size, size], [0.0, d])


def drums(number: int = 5, size=DRUM) -> Structure:
    """Drums on one another, rectangles in the plane."""
    return stack([size] * number)


def courses(number: int = 4, size=COURSE) -> Structure:
    """A stack of equal blocks."""
    return stack([size] * number)


def tapering_column() -> Structure:
    """Drums and capital whose outline is straight from the ground to the top."""
    heights, (wide, narrow) = np.array(TAPERING["heights"]), TAPERING["widths"]
    levels = np.concatenate([[0.0], np.cumsum(heights)])
    widths = wide + (narrow - wide) * levels / levels[-1]
    return stack(list(zip(widths, widths[1:], heights)), density=TAPERING["density"])


def frame(
    column, beam, span: float, friction: float = FRICTION, density: float = 2500.0
) -> Structure:
    """A beam on two columns; span: between their axes [m]."""
    (width, height), (length, thickness) = column, beam
    bodies = [
        GROUND,
        *(
            Body(name, quadrilateral(width, width, height, (x, 0.0)), density)
            for name, x in (("column 1", -span / 2), ("column 2", span / 2))
        ),
        Body("beam", quadrilateral(length, length, thickness, (0.0, height)), density),
    ]
    return Structure(
        tuple(bodies),
        tuple(Joint(number, BOTTOM, 0, TOP, friction) for number in (1, 2))
        + tuple(Joint(3, BOTTOM, number, TOP, friction) for number in (1, 2)),
    )


def beside(
    first, second, gap: float, side_friction: float = FRICTION, friction: float = FRICTION
) -> Structure:
    """Two blocks (width, height) on the ground with a gap [m] between them, the first on the
    left.
    """
    bodies = (
        GROUND,
        Body("left", quadrilateral(first[0], *first, (-first[0] / 2, 0.0))),
        Body("right", quadrilateral(second[0], *second, (gap + second[0] / 2, 0.0))),
    )
    return Structure(
        bodies,
        (
            Joint(1, BOTTOM, 0, TOP, friction),
            Joint(2, BOTTOM, 0, TOP, friction),
            Joint(1, RIGHT, 2, LEFT, side_friction),
        ),
    )


def beside_wall(
    size, gap: float, side_friction: float = FRICTION, friction: float = FRICTION
) -> Structure:
    """A block (width, height) on the ground with a wall on its right, a gap [m] away."""
    wall = Body("wall", quadrilateral(1.0, 1.0, 10.0, (gap + 0.5, 0.0)), fixed=True)
    bodies = (GROUND, wall, Body("block", quadrilateral(size[0], *size, (-size[0] / 2, 0.0))))
    return Structure(
        bodies, (Joint(2, BOTTOM, 0, TOP, friction), Joint(2, RIGHT, 1, LEFT, side_friction))
    )


def leaning_block(structure: Structure, body: int, tilt: float) -> np.ndarray:
    """Places (nb, 3) with one quadrilateral tilted by `tilt` [rad] about the corner of its foot on
    that side, +x for tilt > 0.
    """
    corners = structure.bodies[body].outline
    return structure.turned(structure.place, body, corners[1 if tilt > 0 else 0], -tilt)


def leaning_frame(structure: Structure, tilt: float) -> np.ndarray:
    """Places (4, 3) with the columns of `frame` tilted by `tilt` > 0 [rad] towards +x, the beam
    level on them.
    """
    place = structure.place
    for column in (1, 2):
        place = structure.turned(place, column, structure.bodies[column].outline[1], -tilt)
    corner = structure.ends(1, TOP)[1]  # the left corner of the head carries
    place[3, :2] += structure.point(1, corner, place) - structure.point(1, corner, structure.place)
    return place
