"""The explorer of the page: a study's peaks and thinned histories, embedded for the page's own
script.
"""

from __future__ import annotations

import base64
import json
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np

from fecolumn.engines.ending import lost
from fecolumn.pictures.figures.axis_text import axis_unit
from fecolumn.pictures.figures.cdf_figure import axis_end
from fecolumn.pictures.figures.fan_figure import LOOKS
from fecolumn.pictures.figures.specimen_outline import specimen_outline
from fecolumn.pictures.figures.style import LINES
from fecolumn.study.report.all_motions import SHAPE, critical_of
from fecolumn.study.report.document import PageSection, Paragraph
from fecolumn.study.report.histories import FINEST, Histories, Trace, spread_out
from fecolumn.study.report.notation import (
    axis_name,
    count,
    level_text,
    percent,
    plain_level,
    setting_text,
)
from fecolumn.study.report.sweep import Setting, Sweep

LARGEST_BYTES = 5_000_000  # of all histories in the page: with its figures it stays below 15 MB
MOST_ANALYSES = 200_000  # more than these are too many for a page, even without a history
_SHARES = (FINEST, 0.005, 0.01, 0.02)  # of its scale, what a drawn line may be off
_CHOICES = 10  # levels of an axis that are offered one by one
_FULL = (65535, 32767, 32767)  # of the integers of time, displacement and tilt
_DASHES = {"-": "", "--": "5 2.5", "-.": "7 2.5 1.5 2.5"}


@dataclass(frozen=True, slots=True)
class Explorer:
    """The explorer as a block of the page; `data` is what its script reads, see `explorer_data`."""

    data: dict[str, Any]
    kind: str = "explorer"

    @property
    def json(self) -> str:
        """The data as JSON that may stand within a script element."""
        return json.dumps(
            self.data, ensure_ascii=False, separators=(",", ":"), allow_nan=False
        ).replace("<", "\\u003c")


def explorer(sweep: Sweep, histories: Histories) -> PageSection:
    """The section."""
    if sum(len(setting.runs) for setting in sweep.done) > MOST_ANALYSES:
        return PageSection(
            "Explorer",
            [
                Paragraph(
                    "The explorer is left out: a page cannot hold more than "
                    f"{MOST_ANALYSES} analyses."
                )
            ],
        )
    data, words = explorer_data(sweep, histories)
    return PageSection("Explorer", [Paragraph(_OPENING + words), Explorer(data)])


_OPENING = (
    "Choose settings; mark a range of peaks in the distribution with the mouse, or "
    "with the two sliders by the arrow keys; "
    "choose one of the motions whose peaks lie in it to see its histories in all settings chosen. "
)


def explorer_data(sweep: Sweep, histories: Histories) -> tuple[dict[str, Any], str]:
    """What the page's script reads, and what is to be said of it.

    Keys: axes (name, unit, levels as text), settings (words, levels by place, peaks [mm] and ends
    by motion, histories by motion in the form of `packed`), motions, start (places of the settings
    chosen at first), end_mm of the axis, ends (names and colours), looks of lines, foot [mm],
    critical_mm. A peak is null where there is no analysis; what is lost has the peak null and an
    end.
    """
    settings = sorted(
        sweep.done,
        key=lambda one: [sweep.axes[axis].index(one.values[axis]) for axis in sweep.varied],
    )
    chosen, share = _fitting(sweep, histories)
    names = list(LOOKS)
    outline = (
        specimen_outline(sweep.case)
        if sweep.case and not SHAPE & {axis.partition(".")[0] for axis in sweep.varied}
        else None
    )
    single = any(len(sweep.axes[axis]) > _CHOICES for axis in sweep.varied)
    data = {
        "axes": [] if single else [_axis(sweep, axis) for axis in sweep.varied],
        "settings": [_setting(sweep, one, single, chosen, names) for one in settings],
        "motions": _names(sweep),
        "start": _start(sweep, settings),
        "end_mm": 1e3
        * axis_end(
            run["u_max_m"] for one in settings for run in one.runs.values() if not lost(run)
        ),
        "ends": [{"word": word, "colour": colour} for colour, _, word in LOOKS.values()],
        "lost": "lost" if sweep.slides else "overturned",
        "looks": [{"colour": colour, "dash": _dash(dash)} for colour, dash in LINES],
        "foot": None if outline is None else np.round(1e3 * outline.foot, 2).tolist(),
        "critical_mm": 1e3 * critical if (critical := critical_of(settings)) else None,
    }
    return data, _said(sweep, histories, chosen, share)


def packed(trace: Trace) -> str:
    """Base64 of a history, little-endian: three 32-bit floats, the largest time [s], displacement
    [m] and tilt [rad] in magnitude; then the times of all n rows as 16-bit integers of which 65535
    is the largest, and their u_x, u_y and tilt as signed ones of which 32767 is.
    """
    scales = [
        max(float(np.abs(values).max()), 1e-9) for values in (trace.time, trace.u_top, trace.tilt)
    ]
    time, u, tilt = (
        np.round(full * values / scale)
        for full, values, scale in zip(_FULL, (trace.time, trace.u_top.T, trace.tilt), scales)
    )
    parts = (np.array(scales, "<f4"), time.astype("<u2"), u.astype("<i2"), tilt.astype("<i2"))
    return base64.b64encode(b"".join(part.tobytes() for part in parts)).decode()


def _fitting(sweep: Sweep, histories: Histories) -> tuple[dict[str, str], float]:
    """Histories in the form of `packed` by case id, as fine as the page has room for, and what
    their lines may be off.
    """
    traces = histories.traces
    for share in _SHARES:
        found = {
            case_id: packed(trace if share == FINEST else trace.thinner(share - FINEST))
            for case_id, trace in traces.items()
        }
        if sum(map(len, found.values())) <= LARGEST_BYTES:
            return found, share
    most = len(sweep.motions)
    while sum(map(len, found.values())) > LARGEST_BYTES and most > 1:
        most = max(1, int(0.95 * most * min(1.0, LARGEST_BYTES / sum(map(len, found.values())))))
        kept = spread_out(sweep, most)
        ids = {
            run.get("case_id")
            for one in sweep.done
            for motion, run in one.runs.items()
            if motion in kept
        }
        found = {case_id: text for case_id, text in found.items() if case_id in ids}
    return found, share


def _said(sweep: Sweep, histories: Histories, chosen: dict[str, str], share: float) -> str:
    if not histories.traces:
        return "No histories are at hand."
    text = (
        "Histories are thinned: lines are drawn through some of their rows and miss "
        f"none by more than {percent(share)} of its largest displacement "
        "or tilt, or of the critical ones where these are less; times are rounded to "
        "1/65 535 of its length."
    )
    there = {
        motion
        for one in sweep.done
        for motion, run in one.runs.items()
        if run.get("case_id") in chosen
    }
    if len(chosen) < len(histories.traces) or histories.skipped:
        text += (
            f" To bound the size of the page it holds the histories of {len(there)} of "
            f"{len(sweep.motions)} motions; the others are in analyses/ID/history.h5."
        )
    if histories.missing:
        text += f" {count(histories.missing, 'history')} could not be read."
    return text


def _axis(sweep: Sweep, axis: str) -> dict[str, Any]:
    levels = sweep.axes[axis]
    unit = axis_unit(axis)
    numbers = all(
        isinstance(level, (int, float)) and not isinstance(level, bool) for level in levels
    )
    return {
        "name": axis_name(axis) + (f" [{unit}]" if numbers and unit != "-" else ""),
        "levels": [plain_level(level) if numbers else level_text(axis, level) for level in levels],
    }


def _setting(
    sweep: Sweep, setting: Setting, single: bool, chosen: dict[str, str], names: list[str]
) -> dict[str, Any]:
    runs = [setting.runs.get(motion) for motion in sweep.motions]
    return {
        "words": setting_text({axis: setting.values[axis] for axis in sweep.varied}),
        "levels": []
        if single
        else [sweep.axes[axis].index(setting.values[axis]) for axis in sweep.varied],
        "peaks": [
            None if run is None or lost(run) else float(f"{1e3 * run['u_max_m']:.4g}")
            for run in runs
        ],
        "ends": [
            None
            if run is None
            else names.index(
                "overturned" if run["overturned"] else "slid off" if run.get("slid_off") else ""
            )
            for run in runs
        ],
        "histories": [None if run is None else chosen.get(run.get("case_id", "")) for run in runs],
    }


def _start(sweep: Sweep, settings: list[Setting]) -> list[int]:
    """The setting of reference and those along the first axis of which it has neighbours."""
    for axis in sweep.varied:
        along = [
            place
            for place, one in enumerate(settings)
            if all(
                one.values[key] == sweep.reference.values[key]
                for key in sweep.varied
                if key != axis
            )
        ]
        if 1 < len(along) <= 4:
            return along
    return [next(place for place, one in enumerate(settings) if one is sweep.reference)]


def _names(sweep: Sweep) -> list[str]:
    """What the motions are called, with all that tells them apart where a name alone does not."""
    runs = {
        motion: next(one.runs[motion] for one in sweep.done if motion in one.runs)
        for motion in sweep.motions
    }
    names = {motion: run.get("motion") or motion.strip("[]'\"") for motion, run in runs.items()}
    often = {name for name, times in Counter(names.values()).items() if times > 1}
    return [
        f"{name} ({motion.strip('[]')})" if name in often else name
        for motion, name in names.items()
    ]


def _dash(dash: str | tuple[int, tuple[int, ...]]) -> str:
    return (
        _DASHES[dash]
        if isinstance(dash, str)
        else " ".join(f"{2 * length:g}" for length in dash[1])
    )
