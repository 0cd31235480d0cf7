"""What is in a file of a motion, and what is odd about it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.motions.load import RECORDED_G, higher_between_rows
from fecolumn.motions.processing import integrate, resample
from fecolumn.motions.record import METRES_PER_S2, GroundMotion, Recording
from fecolumn.motions.spike import spike_in

# Units that a record without one most likely has
_USUAL = "g", "m/s2", "cm/s2", "mm/s2"
# [g]: peaks of ground motions that are worth an analysis lie between
_LIKELY = 0.005, 3.0
# Of the peak velocity: what may be left at the end of a record without drift
_LEFT = 0.1
# Of a record's step, a step at which its peak between its rows is looked for, of so many samples at
# most
_FINER, _MANY = 10, 1_000_000
# Seconds of one value without change that are a gap, and of the peak that are a clipped record
_GAP_S, _CLIPPED = 0.5, 4


def file_lines(recording: Recording, dt: float, units: str = "") -> list[str]:
    """Lines on a file: format, samples, components, unit; where it states none, that which the user
    says in `units`.
    """
    values = recording.values.reshape(len(recording.values), -1)
    moves = [bool(column.any()) for column in values.T]
    named = list(zip((f"a{axis}" for axis in recording.axes if axis), moves))
    axes = ", ".join(name for name, moving in named if moving)
    still = "".join(f"; {name} is 0 throughout" for name, moving in named if not moving)
    told = f" ({axes}){still}" if named else "; its axis is that of the key it stands under"
    kind = recording.format or "record of an ensemble"
    step = f"dt {dt:g} s, {(len(recording.values) - 1) * dt:g} s long" if dt else "dt not stated"
    lines = [
        f"{recording.name}: {kind}, {len(recording.values)} samples, {step}",
        f"components: {sum(moves)}{told}",
        f"unit: {recording.units or (f'{units}, as --units says' if units else 'not stated')}",
    ]
    if recording.source and recording.source != recording.name:
        lines.append(f"source: {recording.source[:300]}")
    return lines


def peaks_by_unit(recording: Recording) -> str:
    """The peak of a record without a unit in each unit that there is."""
    peak = float(np.abs(recording.values).max())
    told, likely = [], []
    for unit in _USUAL:
        in_g = peak * METRES_PER_S2[unit] / GRAVITY
        told.append(f"{in_g:.3g} g in {unit}")
        if _LIKELY[0] <= in_g <= _LIKELY[1]:
            likely.append(unit)
    what = f"; {' or '.join(likely)} would make a ground motion" if likely else ""
    return f"peak: {peak:.4g} as it stands, that is {', '.join(told)}{what}"


def peak_lines(motion: GroundMotion) -> list[str]:
    """A line on the peaks of each component along which the ground moves."""
    velocity, displacement = integrate(motion)
    lines = []
    for axis, name in enumerate("xyz"):
        if motion.acceleration[:, axis].any():
            pga, pgv, pgd = (
                float(np.abs(one[:, axis]).max())
                for one in (motion.acceleration, velocity, displacement)
            )
            lines.append(
                f"a{name}: PGA {pga / GRAVITY:.4g} g ({pga:.4g} m/s2), PGV {100 * pgv:.4g} cm/s, "
                f"PGD {100 * pgd:.4g} cm"
            )
    return lines or ["the ground does not move"]


def oddities(motion: GroundMotion) -> list[str]:
    """What a user should know of before an analysis: unit, drift, gaps, clipping; and ways out."""
    velocity, displacement = integrate(motion)
    found = []
    for axis, name in enumerate("xyz"):
        a, v, u = (one[:, axis] for one in (motion.acceleration, velocity, displacement))
        peak = float(np.abs(a).max())
        if not peak:
            continue
        if peak > RECORDED_G * GRAVITY:
            found.append(
                f"a{name}: {peak / GRAVITY:.3g} g is more than was ever recorded: another unit?"
            )
        elif peak < _LIKELY[0] * GRAVITY:
            found.append(f"a{name}: {peak / GRAVITY:.3g} g is hardly felt: another unit?")
        found += _drift(name, v, u)
        found += _stillness(name, a, motion.dt)
        if (place := spike_in(a)) is not None:
            found.append(
                f"a{name}: a spike: {a[place]:.3g} m/s2 at t = {place * motion.dt:.4g} s, one "
                "sample alone: is the file damaged?"
            )
    if len(motion.acceleration) * _FINER > _MANY:
        return found
    told = higher_between_rows(motion, resample(motion, motion.dt / _FINER))
    return found + [told] if told else found


def _drift(name: str, v: NDArray[Any], u: NDArray[Any]) -> list[str]:
    end = v[-max(2, len(v) // 50) :].mean()
    if abs(end) <= _LEFT * np.abs(v).max():
        return []
    return [
        f"a{name}: drifts: integrated from rest it ends at {100 * end:.3g} cm/s and {u[-1]:.3g} m; "
        "fecolumn motions correct takes the drift out"
    ]


def _stillness(name: str, a: NDArray[Any], dt: float) -> list[str]:
    """Runs of one value: a gap within the motion, or a peak cut off by the recorder."""
    edges = np.flatnonzero(np.diff(a) != 0)
    bounds = np.concatenate([[-1], edges, [len(a) - 1]])
    lengths = np.diff(bounds)
    inner = np.arange(1, len(lengths) - 1)  # rest before and after is no gap
    found = []
    if len(inner) and lengths[inner].max() * dt >= _GAP_S:
        run = int(inner[lengths[inner].argmax()])
        found.append(
            f"a{name}: a gap: {lengths[run] * dt:.3g} s of one value, {a[bounds[run] + 1]:.3g} "
            f"m/s2, from t = {(bounds[run] + 1) * dt:.4g} s"
        )
    top = np.flatnonzero(np.abs(a) == np.abs(a).max())
    if len(top) >= _CLIPPED and (np.diff(top) == 1).sum() >= _CLIPPED - 1:
        found.append(f"a{name}: clipped: its peak lasts {len(top)} samples")
    return found
