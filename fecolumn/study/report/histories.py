"""Histories of a study's analyses, thinned to what a drawing needs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.ending import OVERTURNED, SLID_OFF
from fecolumn.engines.stored import stored_history
from fecolumn.pictures.figures.thinning import thinned
from fecolumn.study.report.sweep import Setting, Sweep

FINEST = 0.002  # of a history's largest value: less than half a pixel of a drawing 200 pixels high
_MOST = 4000  # analyses whose histories are read: a minute of reading, a hundred megabytes


@dataclass(frozen=True, slots=True)
class Trace:
    """A thinned history of n rows.

    Attributes
    ----------
    time
        (n,) [s].
    u_top
        (n, 2) [m], displacement of the top relative to the base along x and y.
    tilt
        (n,) [rad], angle of the axis to the vertical.
    end
        "overturned", "slid off", or "" of a column that stood.
    scale
        largest displacement [m] and tilt [rad], no more than at the critical displacement.
    """

    time: NDArray[Any]
    u_top: NDArray[Any]
    tilt: NDArray[Any]
    end: str
    scale: tuple[float, float]

    def thinner(self, share: float) -> Trace:
        """The trace with fewer rows, missed by `share` of its scales at most by straight lines
        between these.
        """
        top, tilt = self.scale
        # the magnitude turns where the top passes its place at rest
        values = np.column_stack([self.u_top, np.hypot(*self.u_top.T), self.tilt])
        rows = thinned(self.time, values, share * np.array([top, top, top, tilt]))
        return Trace(self.time[rows], self.u_top[rows], self.tilt[rows], self.end, self.scale)


@dataclass(frozen=True, slots=True)
class Histories:
    """Traces of a study.

    Attributes
    ----------
    traces
        by case id.
    missing
        analyses that are done and whose histories are not to be read.
    skipped
        motions whose histories were not looked at, as there are so many analyses.
    """

    traces: dict[str, Trace]
    missing: int
    skipped: tuple[str, ...] = ()

    def of(self, setting: Setting) -> list[Trace]:
        """The traces of a setting, those that stood first: what was lost is drawn over them."""
        found = [
            self.traces[run["case_id"]]
            for run in setting.runs.values()
            if run.get("case_id") in self.traces
        ]
        return sorted(found, key=lambda trace: bool(trace.end))


def read_histories(sweep: Sweep) -> Histories:
    """The histories of all analyses that are done, of a large study those of as many motions as
    `_MOST` analyses take.
    """
    chosen = spread_out(sweep, max(1, _MOST // len(sweep.done)))
    runs = [
        (motion, run)
        for setting in sweep.done
        for motion, run in setting.runs.items()
        if motion in chosen
    ]
    found = {
        run["case_id"]: trace
        for _, run in runs
        if run.get("case_id") and (trace := _trace(sweep.folder, run))
    }
    return Histories(
        found,
        len(runs) - len(found),
        tuple(motion for motion in sweep.motions if motion not in chosen),
    )


def spread_out(sweep: Sweep, most: int) -> set[str]:
    """As many motions as `most`, spread evenly over the range of peaks in the setting of reference;
    all where there are no more.
    """
    if len(sweep.motions) <= most:
        return set(sweep.motions)
    peaks = {motion: run["u_max_m"] for motion, run in sweep.reference.runs.items()}
    ranked = sorted(sweep.motions, key=lambda motion: peaks.get(motion, 0.0))
    return {ranked[place] for place in np.linspace(0, len(ranked) - 1, most).round().astype(int)}


def _trace(folder: Path, run: dict[str, Any]) -> Trace | None:
    try:
        read = stored_history(
            folder / "analyses" / run["case_id"] / "history.h5", ("time", "u_top", "tilt")
        )
        time, u, tilt = (np.asarray(read[name], float) for name in ("time", "u_top", "tilt"))
        u = u[:, :2]
        sound = (
            time.size > 1
            and tilt.shape == time.shape
            and u.shape == (time.size, 2)
            and bool((np.diff(time) > 0).all())
        )
        if not (
            sound and np.isfinite(u).all() and np.isfinite(tilt).all() and np.isfinite(time).all()
        ):
            return None
    except (OSError, KeyError, IndexError, ValueError):
        return None
    end = OVERTURNED if run["overturned"] else SLID_OFF if run.get("slid_off") else ""
    scale = (
        _scale(np.hypot(*u.T), run.get("u_critical_m")),
        _scale(np.abs(tilt), run.get("critical_tilt_rad")),
    )
    return Trace(time, u, tilt, end, scale).thinner(FINEST)


def _scale(values: NDArray[Any], critical: float | None) -> float:
    """Largest of the values; where the column fell, what it did before counts, and not how far it
    fell.
    """
    largest = float(values.max())
    return max(min(largest, critical) if critical else largest, 1e-9)
