"""What a history says over time, as strips beside a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.render.pose import Poses
from fecolumn.render.quantity import Quantity
from fecolumn.render.result import Result
from fecolumn.render.solid import Solid

# Points of a line: more are not told apart at the width of a strip
_MOST_POINTS = 4000
#: Uplift over the foot's width [-] below which a column only slides: elastic deformation alone
#: opens some 1e-5 of it
LIFTED = 1e-4


@dataclass(frozen=True, slots=True)
class Strip:
    """Lines over time.

    Attributes
    ----------
    title, label
        above, and of the axis with its unit.
    time
        (n,) [s].
    lines
        (values (n,) in the label's unit, name) of each.
    """

    title: str
    label: str
    time: np.ndarray
    lines: tuple[tuple[np.ndarray, str], ...]


def strips_of(result: Result, times: np.ndarray) -> list[Strip]:
    """Acceleration of the base (displacement of the top where it is at rest), tilt, uplift and
    energy, from the first of `times` [s] to the last.

    Of a column that never lifts off: slide and twist in place of tilt and uplift.
    """
    history = result.history
    rows = rows_between(history["time"], history["tilt"], times)
    lifted = uplift(result.solid, result.poses)
    if lifted.max() > LIFTED * result.solid.foot_width:
        motion = (
            strip_of(history, rows, "tilt", r"$\theta$", "rad", [(history["tilt"], "")]),
            strip_of(history, rows, "uplift", "$w$", "m", [(lifted, "")]),
        )
    else:
        motion = (
            strip_of(
                history,
                rows,
                "slide",
                "$s$",
                "m",
                [(history["slide"][:, axis], f"${'xy'[axis]}$") for axis in range(2)],
            ),
            strip_of(history, rows, "twist", r"$\psi$", "rad", [(history["twist"], "")]),
        )
    return [
        ground_strip(history, history["u_top"], rows),
        *motion,
        energy_strip(history, rows, history["tilt"]),
    ]


def rows_between(time: np.ndarray, values: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Rows from the first of `times` [s] to the last, as many as a line needs, the peaks of
    `values` among them.
    """
    rows = np.flatnonzero((time >= times[0] - 1e-9) & (time <= times[-1] + 1e-9))
    return _told_apart(values, rows if len(rows) > 1 else np.arange(len(time)))


def strip_of(history: dict, rows: np.ndarray, title: str, symbol: str, unit: str, lines) -> Strip:
    """Strip of the `rows` of lines (values (n,) [SI], name) in a unit that fits them."""
    quantity = Quantity.of("", unit, max(np.abs(values[rows]).max() for values, _ in lines))
    return Strip(
        title,
        f"{symbol} [{quantity.unit}]".strip(),
        history["time"][rows],
        tuple((values[rows] / quantity.scale, name) for values, name in lines),
    )


def ground_strip(history: dict, top: np.ndarray, rows: np.ndarray) -> Strip:
    """Acceleration of the base; displacement of the top (n, 3) [m] where it is at rest."""
    ground = history["ground"]
    moving = [axis for axis in range(3) if np.abs(ground[:, axis]).max() > 0]
    if moving:
        return strip_of(
            history,
            rows,
            "base",
            "$a_g$",
            "m/s2",
            [(ground[:, axis], f"${'xyz'[axis]}$") for axis in moving],
        )
    return strip_of(
        history, rows, "top", "$u$", "m", [(top[:, axis], f"${'xy'[axis]}$") for axis in range(2)]
    )


def energy_strip(history: dict, rows: np.ndarray, moved: np.ndarray) -> Strip:
    """Kinetic and potential energy, this above that where `moved` (n,) is least."""
    kinetic, potential = (
        history["energy/kinetic"],
        history["energy/gravity"] + history["energy/strain"],
    )
    potential = potential - potential[np.argmin(np.abs(moved))]
    return strip_of(
        history,
        rows,
        "energy",
        "$E$",
        "J",
        [(kinetic, "kinetic"), (potential, "potential"), (kinetic + potential, "sum")],
    )


def uplift(solid: Solid, poses: Poses) -> np.ndarray:
    """Height (n,) [m] of the highest point of the foot above the base, of the rigid column at n
    poses.
    """
    corners = solid.mesh.body.points[np.unique(solid.foot_faces)] - poses.origin
    height = np.full(len(poses.time), -np.inf)
    for corner in corners:  # one by one: all corners at all times fill gigabytes
        np.maximum(height, poses.rotation[:, 2] @ corner, out=height)
    return np.maximum(height + poses.foot[:, 2], 0.0)


def _told_apart(values: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Of `rows`, as many as a line needs, the peaks of `values` among them."""
    if len(rows) <= _MOST_POINTS:
        return rows
    groups = np.array_split(rows, _MOST_POINTS // 2)
    return np.unique(
        np.concatenate(
            [[group[np.argmax(values[group])], group[np.argmin(values[group])]] for group in groups]
        )
    )
