"""Joints of equal faces have two sides: what a body pivots on is the outline of the region where
both faces overlap, until the first impact and over it.

`verification.joints_moving` has what moves on.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.verification import joints_full, joints_moving, multi_drum
from fecolumn.verification.joint_bodies import (
    BELOW,
    DISPLACED,
    TILT,
    B,
    H,
    W,
    arms,
    block_tables,
    engines,
    lifts,
    met,
    region,
    rocked_block,
    rocks,
    turning_error,
    two,
)
from fecolumn.verification.result import CaseRows, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure


# Angle about the vertical [deg] and displacements [m] of the block above
_TURNED = {
    0.1: ((0.0, 0.0), (0.02, 0.013)),
    5.0: ((0.0, 0.0), (0.02, 0.013)),
    45.0: ((0.0, 0.0), (1e-6, 1e-6), (0.02, 0.013)),
}
# Half a side [m] of the square blocks that are let go over edges and corners: about any horizontal
# axis their inertia is the same
_SQUARE = 0.15
# displacement [m] of a block that overhangs by half of its own half length
_OVERHANG = 0.1


def run(engine: str, long: bool = False) -> CaseRows:
    """Rows of one engine."""
    if engine == "corotated":
        return CaseRows(list(joints_full.full_joint_rows()))
    rows = [
        *_displaced(engine),
        *_lifts(engine),
        *_turned(engine),
        *_lets_go(engine),
        *joints_moving.moving_joint_rows(engine),
        *(multi_drum.multi_drum_rows() if engine == "rigid" else ()),
    ]
    return CaseRows(rows, lambda figure: draw_rates(engine, figure))


def draw_rates(engine: str, figure: Figure) -> None:
    """Rates in the 10 ms before and after the first impact over the displacement of the block
    above, beside the closed form.
    """
    small = np.logspace(-9, np.log10(0.05), 24)
    ways = np.concatenate([-small[::-1], [0.0], small])
    off = np.array([displaced(engine, way) for way in ways])[:, 1:3]
    rates = []
    for way in ways:
        one = rocks(*arms(way))
        rates.append(
            [
                -(one.of(one.impact + end)[0] - one.of(one.impact + start)[0]) / 0.01
                for start, end in ((-0.0125, -0.0025), (0.0025, 0.0125))
            ]
        )
    exact = np.array(rates)
    for axes, place, label in zip(
        figure.subplots(1, 2), (0, 1), ("before the impact", "after the impact")
    ):
        axes.plot(ways, exact[:, place], color="0.5", label="closed form")
        axes.plot(
            ways,
            exact[:, place] * (1 + off[:, place]),
            "o",
            markersize=3,
            color="C3",
            label=f"{engine} engine",
        )
        axes.set_xscale("symlog", linthresh=1e-9)
        axes.set_xticks([-1e-2, -1e-6, 0, 1e-6, 1e-2], ["−1e-2", "−1e-6", "0", "1e-6", "1e-2"])
        axes.set(xlabel="displacement of the upper block [m]", ylabel=f"rate {label} [rad/s]")
        axes.legend(frameon=False, fontsize=8)
    figure.tight_layout()


def displaced(engine: str, way: float, angle: float = 0.0, smaller: float = 0.0) -> np.ndarray:
    """Errors as of `rocked` of a block displaced by `way` [m] towards where it leans, all turned by
    an angle [deg].

    smaller: by which the half length of the block above is less than that below, and by which it is
    displaced further: its edge is then at `way` from that below, too [m].
    """
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    half, moved = B - smaller, way + smaller
    made = two(
        engine,
        dict(length_m=2 * half, at_m=[*(moved * direction), BELOW], turned_deg=angle),
        dict(turned_deg=angle),
        initial=dict(up=dict(tilt_rad=TILT, direction_deg=angle)),
    )
    near, far = min(half, B - moved), min(half, B + moved)
    return rocked_block(made, rocks(near, far, (half**2 + H**2) / 3), angle)


def _displaced(engine: str) -> Iterator[Row]:
    """Tilt and rates of displaced blocks, each by its closed form."""
    kinds = (
        (0.0, 0.0, "equal blocks, the upper displaced by up to 10 mm along x"),
        (30.0, 0.0, "the same askew, all turned by 30 degrees"),
        (0.0, 0.05, "a smaller block, its edge up to 10 mm from that below"),
    )
    for angle, smaller, name in kinds:
        found = np.array(
            [displaced(engine, sign * way, angle, smaller) for way in DISPLACED for sign in (1, -1)]
        )
        before, rate, after, last = np.abs(found).max(axis=0)
        yield Row(
            f"{name}: tilt before the first impact, largest error over 0.05 rad", 0.0, before, 1e-4
        )
        yield Row(
            f"{name}: rate before the impact over that of the closed form of each "
            "displacement, largest error",
            0.0,
            rate,
            1e-4,
        )
        yield Row(f"{name}: rate after the impact, largest error", 0.0, after, 1e-4)
        yield Row(f"{name}: tilt at 0.2 s, after the impact, largest error", 0.0, last, 1e-4)
        yield Row(
            f"{name}: change of the tilt before the impact over displacements of up to "
            "a nanometre, over 0.05 rad",
            0.0,
            np.ptp(found[:6, 0]),
            1e-7,
        )


def _lifts(engine: str) -> Iterator[Row]:
    """The ground's acceleration at which a displaced block lifts is g (b - d) / h."""
    for name, way, towards, half in (
        ("x", 0.0, 0.0, B),
        ("y", 90.0, 90.0, W),
        ("x, displaced askew", 30.0, 0.0, B),
    ):
        errors = []
        direction, displaces = (
            np.array([np.cos(np.radians(a)), np.sin(np.radians(a))]) for a in (towards, way)
        )
        most = (*DISPLACED, _OVERHANG) if way == towards else DISPLACED
        for moved in (sign * one for one in most for sign in (1, -1)):
            make = engines(block_tables(engine, dict(at_m=[*(moved * displaces), BELOW])))
            exact = GRAVITY * (half - max(moved * float(displaces @ direction), 0.0)) / H
            errors.append(abs(lifts(make, exact, direction) / exact - 1))
        yield Row(
            "acceleration g (b - d) / h at which a block displaced by d lifts along "
            f"{name}, largest error",
            0.0,
            max(errors),
            1e-6,
        )


def _turned(engine: str) -> Iterator[Row]:
    """Pushed in a direction a square block turns about the edge of the region that a ray from its
    middle meets there: I w' = m (a h cos - g s).
    """
    square = dict(length_m=2 * _SQUARE, width_m=2 * _SQUARE)
    for angle, places in _TURNED.items():
        for place in places:
            make, corners, errors = (
                engines(
                    block_tables(
                        engine, square | dict(turned_deg=angle, at_m=[*place, BELOW]), square
                    )
                ),
                region(angle, place, (_SQUARE, _SQUARE)),
                [],
            )
            for k in range(16):
                # of each sixteenth the direction farthest from a corner
                ways = [
                    np.array([np.cos(a), np.sin(a)])
                    for a in (k + np.array([0.1, 0.3, 0.5, 0.7])) * np.pi / 8
                ]
                towards = max(ways, key=lambda one: met(corners, one)[3])
                way, normal, apart, longer = met(corners, towards)
                # less than would press on a corner
                errors.append(
                    turning_error(
                        make(),
                        min(1.3, 1 + (longer - 1) / 2) * GRAVITY * way / H,
                        towards,
                        normal,
                        apart,
                        (_SQUARE**2 + H**2) / 3,
                    )
                )
            yield Row(
                f"square blocks, the upper turned by {angle:g} deg, displaced by "
                f"({place[0]:g}, {place[1]:g}) m, pushed in 16 directions: angular "
                "acceleration about the edge of the region, "
                f"which has {len(corners)} corners, largest error",
                0.0,
                max(np.abs(errors)),
                1e-4,
            )


def _lets_go(engine: str) -> Iterator[Row]:
    """Square blocks, one turned, let go over each edge of their region, and over its corners where
    it is regular: rates before and after the impact as of the plane problem.
    """
    square = dict(length_m=2 * _SQUARE, width_m=2 * _SQUARE)
    for angle in _TURNED:
        corners = region(angle, (0.0, 0.0), (_SQUARE, _SQUARE))
        edges = np.roll(corners, -1, axis=0) - corners
        kinds = [("edges", np.column_stack([edges[:, 1], -edges[:, 0]]), _SQUARE)] + [
            ("corners", corners, float(np.linalg.norm(corners[0])))
        ] * (angle == 45.0)
        for name, ways, arm in kinds:
            exact = rocks(arm, arm, (_SQUARE**2 + H**2) / 3)
            errors = []
            for towards in np.degrees(np.arctan2(ways[:, 1], ways[:, 0])):
                made = two(
                    engine,
                    square | dict(turned_deg=angle),
                    square,
                    initial=dict(up=dict(tilt_rad=TILT, direction_deg=float(towards))),
                )
                errors.append(rocked_block(made, exact, float(towards)))
            # edges that are parallel to a few thousandths share an impulse, as
            # contact.tolerances.IMPACT_LEFT allows
            yield Row(
                f"square blocks, the upper turned by {angle:g} deg, let go over "
                f"{len(ways)} {name} of their region: rate after the impact as of the "
                "plane problem, largest error",
                0.0,
                np.abs(errors)[:, 2].max(),
                1e-4 if angle > 1 else 5e-4,
            )
