"""What a history says over time, as strips beside a picture."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.render.frame import Strip
from fecolumn.pictures.render.joints import motion

if TYPE_CHECKING:
    from fecolumn.pictures.render.result import Result

# Points of a line of a movie: more are not told apart at the width of a strip
_MOST_POINTS = 4000
#: Uplift over the foot's width [-] below which a body only slides: elastic deformation alone opens
#: some 1e-5 of it
LIFTED_UPLIFT = 1e-4
# Lines that a strip has at most
_MOST = 4


def strips_of(result: Result, times: np.ndarray, most: int = _MOST_POINTS) -> list[Strip]:
    """Acceleration of the base (displacement of the top where it is at rest), tilt of bodies,
    uplift at interfaces and energy, from the first of `times` [s] to the last, each of `most`
    points at most.

    Where nothing lifts off, slide and twist stand in place of tilt and uplift. Of equal bodies, and
    of an interface between several, a line is the largest of all at each time; of more bodies or
    interfaces than a strip has lines, those that move most are drawn.
    """
    history, scene, time = result.history, result.scene, result.time
    tilts = [_tilt(poses.at(time).rotation) for poses in result.poses]
    leans = np.max(tilts, axis=0)
    rows = rows_between(time, [leans, *history["ground"].T], times, most)
    poses = tuple(one.at(time[rows]) for one in result.poses)
    contacts = [scene.contacts[k] for k in scene.shown]
    moved = [motion(scene, contact, poses) for contact in contacts]
    names = [contact.interface for contact in contacts]

    def strip(title: str, symbol: str, unit: str, lines: Iterable[tuple[np.ndarray, str]]) -> Strip:
        return strip_of(time[rows], title, symbol, unit, lines)

    def by_kind(values: list[np.ndarray]) -> list[tuple[np.ndarray, str]]:
        return _largest([piece.kind for piece in scene.bodies], values)

    widths = [np.ptp(scene.points[contact.points], axis=0).max() for contact in contacts]
    if any(up.max() > LIFTED_UPLIFT * width for (up, _), width in zip(moved, widths)):
        shown = (
            strip("tilt", r"$\theta$", "rad", by_kind([tilt[rows] for tilt in tilts])),
            strip("uplift", "$w$", "m", _largest(names, [up for up, _ in moved])),
        )
    else:
        slides = [slide for _, slide in moved]
        shown = (
            strip(
                "slide",
                "$s$",
                "m",
                [(slides[0][:, axis], f"${'xy'[axis]}$") for axis in range(2)]
                if len(slides) == 1
                else _largest(names, [np.hypot(*slide.T) for slide in slides]),
            ),
            strip("twist", r"$\psi$", "rad", by_kind([_twist(one.rotation) for one in poses])),
        )
    return [
        ground_strip(history, result.u_top, rows),
        *shown,
        energy_strip(history, rows, leans),
    ]


def _tilt(rotation: np.ndarray) -> np.ndarray:
    """(n,) [rad] of rotations (n, 3, 3), as of `fem.rotation.tilt_angle`."""
    return np.arctan2(np.hypot(rotation[:, 0, 2], rotation[:, 1, 2]), rotation[:, 2, 2])


def _twist(rotation: np.ndarray) -> np.ndarray:
    """(n,) [rad] of rotations (n, 3, 3), as of `fem.rotation.twist_angle`."""
    return np.arctan2(rotation[:, 1, 0] - rotation[:, 0, 1], rotation[:, 0, 0] + rotation[:, 1, 1])


def _largest(names: list[str], values: list[np.ndarray]) -> list[tuple[np.ndarray, str]]:
    """(values (n,), name): of each name the values (n,) of that of its bearers that has the
    largest at each time, of _MOST names with the largest peaks; those of one bearer as they are.
    """
    groups: dict[str, list] = {}
    for name, one in zip(names, values):
        groups.setdefault(name, []).append(one)
    lines = [
        (each[0] if len(each) == 1 else np.max(np.abs(each), axis=0), name)
        for name, each in groups.items()
    ]
    kept = sorted(range(len(lines)), key=lambda k: -np.abs(lines[k][0]).max())[:_MOST]
    return [lines[k] for k in sorted(kept)]


def rows_between(
    time: np.ndarray, values: list[np.ndarray], times: np.ndarray, most: int
) -> np.ndarray:
    """Rows from the first of `times` [s] to the last, `most` at most, the peaks of each of `values`
    (n,) among them.
    """
    rows = np.flatnonzero((time >= times[0] - 1e-9) & (time <= times[-1] + 1e-9))
    rows = rows if len(rows) > 1 else np.arange(len(time))
    if len(rows) <= most:
        return rows
    groups = np.array_split(rows, most // (2 * len(values)))
    ends = [
        (group[np.argmax(one[group])], group[np.argmin(one[group])])
        for group in groups
        for one in values
    ]
    return np.unique(ends)


def strip_of(
    time: np.ndarray, title: str, symbol: str, unit: str, lines: Iterable[tuple[np.ndarray, str]]
) -> Strip:
    """Strip of lines (values (n,) [SI], name) at `time` (n,) [s] in a unit that fits them."""
    quantity = Quantity.of("", unit, max(np.abs(values).max() for values, _ in lines))
    return Strip(
        title,
        f"{symbol} [{quantity.unit}]".strip(),
        time,
        tuple((values / quantity.scale, name) for values, name in lines),
    )


def ground_strip(history: dict, top: np.ndarray, rows: np.ndarray) -> Strip:
    """Acceleration of the base; displacement of the top (n, 3) [m] where it is at rest."""
    ground, time = history["ground"], history["time"][rows]
    moving = [axis for axis in range(3) if np.abs(ground[:, axis]).max() > 0]
    if moving:
        lines = [(ground[rows, axis], f"${'xyz'[axis]}$") for axis in moving]
        return strip_of(time, "base", "$a_g$", "m/s2", lines)
    lines = [(top[rows, axis], f"${'xy'[axis]}$") for axis in range(2)]
    return strip_of(time, "top", "$u$", "m", lines)


def energy_strip(history: dict, rows: np.ndarray, moved: np.ndarray) -> Strip:
    """Kinetic and potential energy, this above that where `moved` (n,) is least."""
    kinetic = history["energy/kinetic"]
    potential = history["energy/gravity"] + history["energy/strain"]
    potential = potential - potential[np.argmin(np.abs(moved))]
    lines = [
        (kinetic[rows], "kinetic"),
        (potential[rows], "potential"),
        ((kinetic + potential)[rows], "sum"),
    ]
    return strip_of(history["time"][rows], "energy", "$E$", "J", lines)
