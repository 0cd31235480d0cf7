"""Masonry walls: multipliers against virtual work and linear programming, and a published wall of
blocks.

Requirement: the force-based multipliers are those of the review's equations, and of the limit
analysis of the same blocks, which knows none of them; the wall of Ferris and Tin-Loi begins to move
at their multiplier; capacity curves have their closed secants.

Sources: [R] the review of rocking and kinematic approaches for masonry walls, by equation; [F]
Ferris and Tin-Loi (2001), wall 1, 5 x 6 blocks of 0.4 x 0.175 m, friction 0.65: 0.64 as later
authors print it and 0.643 as others draw it. Neither is open to read here: the geometry is that of
public re-computations (half blocks at the ends of every second course, the lowest one among them,
loads equal to weights).

Tolerances. Closed forms: rounding, 1e-9 where a linear programme is behind. Wall 1: the digits
told, half of the last.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.impact import rectangular_restitution
from fecolumn.engines.rocking.masonry_displacement import (
    bilinear,
    limit_state,
    oscillator,
    performance_point,
    rigid_wall_curve,
    trilinear,
)
from fecolumn.engines.rocking.masonry_force import (
    facade_multiplier,
    floor_friction,
    free_wall_multiplier,
    hinged_wall_multiplier,
    side_wall_friction,
    side_wall_lever,
)
from fecolumn.engines.rocking.masonry_limit import (
    associated,
    non_associated,
    running_bond,
    wall_of_boxes,
)
from fecolumn.verification.result import CaseRows, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure


THICKNESS, _HEIGHT = 0.4, 3.0


def run(engine: str, long: bool = False) -> CaseRows:
    """All rows; the long run looks for the least multiplier without dilatancy from six starts."""
    return CaseRows([*_force(), *_displacement(), *_limit(6 if long else 1)], _draw, (7.2, 2.8))


def _force() -> Iterator[Row]:
    free = free_wall_multiplier(THICKNESS, _HEIGHT)
    yield Row(
        "free wall: b/h [-] (R, Eq. 9)",
        THICKNESS / _HEIGHT,
        associated(wall_of_boxes([(0, 0, THICKNESS, _HEIGHT)], 2e4), 0.7).multiplier,
        1e-9,
    )
    for psi in (0.0, 0.5, 2.0):
        yield Row(
            f"hinge at mid-height, psi {psi:g}: over the free wall's [-] (R, 5.1)",
            4 * (1 + psi),
            hinged_wall_multiplier(THICKNESS, _HEIGHT, psi) / free,
            1e-12,
        )
    rows, block = 20, (0.15, 0.45)
    joints = sum(
        2 * (2e4 * THICKNESS * block[1] / 2 * block[0] * i) * 0.6 for i in range(1, rows + 1)
    )
    friction = side_wall_friction(rows, 2e4, THICKNESS, *block, 0.6)
    yield Row("friction of side walls, joint by joint [N] (R, Eq. 10)", joints, friction, 1e-12)
    moment = sum(
        2 * (2e4 * THICKNESS * block[1] / 2 * block[0] * i) * 0.6 * (rows - i) * block[0]
        for i in range(1, rows + 1)
    )
    yield Row(
        "its height over the hinge, joint by joint [m] (D)",
        moment / joints,
        side_wall_lever(rows, block[0]),
        1e-12,
    )
    yield Row(
        "that height over H/3 for 1000 rows [-] (R, Eq. 12)",
        1.0,
        side_wall_lever(1000, block[0]) / (1000 * block[0] / 3),
        1.1e-3,
    )
    weight, load = 6e4, 2e4
    force = floor_friction(load, 0.4)
    exact = (weight * 0.2 + load * 2 / 3 * 0.4 + force * 3 + friction * 1) / (
        load * 3 + weight * 1.5
    )
    yield Row(
        "facade held by side walls and floor [-] (R, Eq. 12)",
        exact,
        facade_multiplier(weight, _HEIGHT, THICKNESS, load, force, friction),
        1e-12,
    )
    yield Row(
        "the same without either: the free wall [-]",
        free,
        facade_multiplier(weight, _HEIGHT, THICKNESS),
        1e-12,
    )
    for mu in (2, 4, 8):
        yield Row(
            f"e_H of h/b = {mu}: both forms [-] (R, Eq. 3)",
            1 - 1.5 * math.sin(math.atan(1 / mu)) ** 2,
            rectangular_restitution(mu),
            1e-12,
        )
    for n, patterns in ((2, 8), (3, 26)):
        yield Row(
            f"patterns of n = {n} blocks, 3^n - 1 (R, Eq. 7)",
            patterns,
            sum(any(pattern) for pattern in np.ndindex(*(3,) * n)),
            0.0,
        )
    for tilt, state in (
        (0.0, "at rest"),
        (0.2, "limited rocking"),
        (0.4, "limited rocking"),
        (0.41, "rocking"),
        (1.0, "collapse"),
    ):
        yield Row(
            f"limit state at theta_max/alpha = {tilt:g} is {state} (R, 7.1)",
            1,
            float(limit_state(tilt) == state),
            0.0,
        )


def _displacement() -> Iterator[Row]:
    rigid, imperfect = bilinear(0.1, 0.3), trilinear(0.1, 0.3, (0.13, 0.40))
    yield Row(
        "rigid wall: secant stiffness at 0.4 Delta_u over a_0/Delta_u [-] (D)",
        0.6 / 0.4,
        rigid.secant_stiffness(0.12) / (0.1 * GRAVITY / 0.3),
        1e-12,
    )
    yield Row(
        "imperfect wall: plateau over a_0 [-] (D)",
        0.6,
        float(imperfect.at(0.08)) / (0.1 * GRAVITY),
        1e-12,
    )
    yield Row(
        "imperfect wall joins the rigid one's line beyond Delta_2 [m/s2] (D)",
        float(rigid.at(0.2)),
        float(imperfect.at(0.2)),
        1e-12,
    )
    yield Row(
        "imperfect wall: displacement at 75 % of the peak [m] (D)",
        0.3 * (1 - 0.75 * 0.6),
        imperfect.softened(0.75),
        1e-12,
    )
    # tan(alpha - theta) over sin falls short of the straight line by the third order in alpha
    exact = rigid_wall_curve(THICKNESS, _HEIGHT)
    half = exact.ultimate / 2
    yield Row(
        "exact curve at half its ultimate displacement over a_0 [-] (D)",
        0.5,
        float(exact.at(half)) / (GRAVITY * THICKNESS / _HEIGHT),
        (THICKNESS / _HEIGHT) ** 2,
    )
    pieces = np.full(2000, 1.0)
    found = oscillator(pieces, (np.arange(2000) + 0.5) / 2000)
    yield Row("uniform wall about its foot: share of the mass [-] (D)", 0.75, found.share, 1e-6)
    yield Row("its displacement over the top's [-] (D)", 2 / 3, found.displacement, 1e-6)
    # S_d = v T/(2 pi): T^2 = (2 pi)^2 Delta/a, so that Delta a = v^2, a quadratic on the rigid
    # wall's line
    speed = 0.2
    root = 0.15 * (1 - math.sqrt(1 - 4 * speed**2 / (0.1 * GRAVITY * 0.3)))
    point = performance_point(rigid, lambda period: speed * period / (2 * math.pi))
    yield Row("rigid wall in a spectrum of constant velocity 0.2 m/s [m] (D)", root, point, 1e-3)


def _limit(starts: int) -> Iterator[Row]:
    for height, friction in ((1.2, 0.65), (0.5, 0.65)):
        exact = min(0.4 / height, friction)
        yield Row(
            f"block 0.4 x {height:g} m, friction {friction:g}: turns or slides [-]",
            exact,
            associated(wall_of_boxes([(0, 0, 0.4, height)], 1e4), friction).multiplier,
            1e-9,
        )
    # of a stack the whole turns first: it is as slender as can be
    stack = wall_of_boxes([(0, 0.5 * i, 0.5, 0.5 * (i + 1)) for i in range(6)], 1e4)
    yield Row(
        "stack of six drums: b/h of the whole [-]",
        0.5 / 3.0,
        associated(stack, 0.7).multiplier,
        1e-9,
    )
    wall = running_bond(5, 6, 0.4, 0.175)
    upper, coulomb = associated(wall, 0.65), non_associated(wall, 0.65, starts=starts)
    yield Row(
        "wall of 5 x 6 blocks, sliding dilates: multiplier [-] (F)",
        0.643,
        upper.multiplier,
        5e-4,
        scale=1.0,
    )
    yield Row(
        "wall of 5 x 6 blocks, Coulomb friction: multiplier [-] (F)",
        0.64,
        coulomb.multiplier,
        5e-3,
        scale=1.0,
    )
    yield Row(
        "the same: forces beyond friction over the weight [-]",
        0.0,
        max(coulomb.residual, 0.0),
        1e-6,
    )
    yield Row(
        "the same: Coulomb's over the upper bound, at most 1 [-]",
        1.0,
        max(coulomb.multiplier / upper.multiplier, 1.0),
        1e-7,
    )


def _draw(figure: Figure) -> None:
    from matplotlib.patches import Polygon

    left, right = figure.subplots(1, 2)
    wall = running_bond(5, 6, 0.4, 0.175)
    found = non_associated(wall, 0.65)
    scale = 0.12 / np.abs(found.velocity[:, 0]).max()
    for box, centre, (x, y, turn) in zip(wall.boxes, wall.centres, found.velocity):
        corners = np.array([box[[0, 1]], box[[2, 1]], box[[2, 3]], box[[0, 3]]])
        arms = corners - centre
        moved = corners + scale * (
            np.array([x, y]) + turn * np.column_stack([-arms[:, 1], arms[:, 0]])
        )
        left.add_patch(Polygon(moved, facecolor="#E8E0D5", edgecolor="k", linewidth=0.6))
    left.set(
        xlim=(-0.1, 2.3),
        ylim=(-0.05, 1.25),
        aspect="equal",
        xlabel="x [m]",
        ylabel="y [m]",
        title=f"mechanism at multiplier {found.multiplier:.3f}",
    )
    left.grid(False)
    for label, curve, dashes in (
        ("rigid", bilinear(THICKNESS / _HEIGHT, 0.2), "-"),
        ("imperfect joints, new", trilinear(THICKNESS / _HEIGHT, 0.2, (0.06, 0.28)), "--"),
        ("imperfect joints, severe", trilinear(THICKNESS / _HEIGHT, 0.2, (0.20, 0.50)), "-."),
        ("exact, large rotation", rigid_wall_curve(THICKNESS, _HEIGHT), ":"),
    ):
        right.plot(curve.displacement, curve.acceleration / GRAVITY, dashes, label=label)
    right.set(
        xlabel="displacement of the centre [m]",
        ylabel="acceleration [g]",
        xlim=(0, 0.21),
        ylim=(0, None),
    )
    right.legend()
