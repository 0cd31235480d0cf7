"""Section: one motion at a time, scatter matrices and trends."""

from __future__ import annotations

from typing import Any

import numpy as np

from fecolumn.engines.ending import lost
from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.pair_figure import Variable, pair_figure
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.document import (
    Figure,
    PageBlock,
    PageColumn,
    PageSection,
    PageTable,
    Paragraph,
)
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.individual_claims import line_trends, setting_spread
from fecolumn.study.report.notation import (
    axis_name,
    count,
    fixed,
    interval,
    millimetres,
    p_value,
    percent,
)
from fecolumn.study.report.setting_columns import setting_words
from fecolumn.study.report.sweep import Line, Sweep

_VARIABLES, _MATRICES, _FOLD = 6, 4, 20
# Factors above it are told as more than this: the smaller peak is then hardly any motion
_MANY = 100.0
# Peaks over one another from which on the smaller is rounding: of a body that only stood
_ROUNDING = 1e4


def individual(sweep: Sweep, gallery: Gallery) -> PageSection | None:
    """The section; None where no motion was run in two settings."""
    matrices = [
        figure for axis in sweep.leading[:_MATRICES] if (figure := _matrix(sweep, axis, gallery))
    ]
    if not matrices:
        return None
    found = setting_spread(sweep.done)
    text = (
        "One by one, the same motion gives different peaks in different settings: "
        f"{' and '.join(f'[[{one.name}]]' for one in matrices)}. "
    )
    if found.motions:
        text += (
            f"Of the {count(found.motions, 'motion')} run in all {found.settings} "
            f"settings, {found.flipped} "
            f"({percent(found.flipped / found.motions)}) "
            f"{'are lost' if sweep.slides else 'overturn'} in some and stand in others"
        )
        text += (
            "; of those that always stand, the largest peak is "
            f"{_times(float(np.median(found.factor)))} the smallest in the median."
            if found.factor.size
            else "."
        )
    blocks: list[PageBlock] = [Paragraph(text), *matrices]
    rows = [
        row
        for axis in sweep.leading
        if all(isinstance(level, (int, float)) for level in sweep.axes[axis])
        for row in _trends(sweep, axis)
    ]
    if rows:
        columns = (
            PageColumn("axis", "along", axis_name, text=True),
            PageColumn("at", "at", setting_words, text=True),
            PageColumn("levels", "levels"),
            PageColumn("n", "n"),
            PageColumn("rising", "rise"),
            PageColumn("falling", "fall"),
            PageColumn("tau", "mean τ", fixed),
            PageColumn("tau_low tau_high", "95 %", interval),
            PageColumn("p", "p", p_value),
            PageColumn("p_holm", "p (Holm)", p_value),
        )
        blocks.append(
            PageTable(
                "trends",
                columns,
                rows,
                "Trend of the peak of one and the same motion along a parameter: "
                "motions whose peak rises or falls on the "
                "whole, mean Kendall τ with its 95 % interval over the motions, p of "
                "no trend (Page; sign test for two levels). "
                f"Runs that {sweep.lost} rank above all that stand.",
                folded=len(rows) > _FOLD,
            )
        )
    if ALPHA_KEY in sweep.varied and sweep.alpha_note:
        blocks.append(Paragraph(sweep.alpha_note, warning=True))
    blocks.append(_motions(sweep))
    return PageSection("One by one", blocks)


def _matrix(sweep: Sweep, axis: str, gallery: Gallery) -> Figure | None:
    """Scatter matrix of the levels of an axis, all else as in the reference setting where that line
    is there.
    """
    lines = sweep.lines(axis)
    if not lines:
        return None
    wanted = {key: sweep.reference.values[key] for key in lines[0].others}
    line = next((one for one in lines if one.others == wanted), lines[len(lines) // 2])
    if len(line.settings) > _VARIABLES:
        line = Line(
            axis,
            line.others,
            tuple(
                line.settings[k]
                for k in np.linspace(0, len(line.settings) - 1, _VARIABLES).astype(int)
            ),
        )
    u, over = line.peaks()
    variables = [
        Variable(axis_text(axis, level), *pair) for level, pair in zip(line.levels, zip(u, over))
    ]
    name = f"scatter_by_{axis.split('.')[-1]}"
    at = f" {sweep.at(line.others)}" if line.others else ""
    return gallery.draw(
        name,
        f"Largest top displacement of {count(u.shape[1], 'motion')} at {len(variables)} "
        f"values of {axis_name(axis)}{at}, one "
        f"against the other. Shaded strip: {sweep.lost}; open red diamonds: lost in one "
        "of the two alone (flips). R with "
        f"lost runs at {millimetres(sweep.limit_m)} mm.",
        pair_figure,
        variables,
        sweep.limit_m,
    )


def _times(factor: float) -> str:
    """A factor in words: beside a peak of rounding any other is a million times as large."""
    return f"more than {_MANY:g} times" if factor > _MANY else f"{fixed(factor)} times"


def _trends(sweep: Sweep, axis: str) -> list[tuple[Any, ...]]:
    rows = []
    for one in line_trends(sweep, axis):
        it, at = (
            one.trend,
            {key: value for key, value in one.line.others.items() if key in sweep.varied},
        )
        rows.append(
            (
                axis,
                at,
                it.levels,
                it.n,
                it.rising,
                it.falling,
                it.tau,
                it.tau_low,
                it.tau_high,
                it.p,
                one.p_holm,
            )
        )
    return rows


def _motions(sweep: Sweep) -> PageTable:
    """A row for each motion: what the settings make of it."""
    rows = []
    for motion in sweep.motions:
        runs = [setting.runs[motion] for setting in sweep.done if motion in setting.runs]
        peaks = np.array([run["u_max_m"] for run in runs if not lost(run)])
        fallen, slid = (
            sum(bool(run["overturned"]) for run in runs),
            [sum(bool(run.get("slid_off")) for run in runs)] if sweep.slides else [],
        )
        low, high = (float(peaks.min()), float(peaks.max())) if peaks.size else (None, None)
        rows.append(
            (
                runs[0].get("motion") or motion.strip("[]'\""),
                len(runs),
                fallen,
                *slid,
                low,
                high,
                high / low if low and high and high <= _ROUNDING * low else None,
            )
        )
    return PageTable(
        "motions",
        (
            PageColumn("motion", "motion", text=True),
            PageColumn("n", "settings"),
            PageColumn("overturned", "overturned"),
            *((PageColumn("slid_off", "slid off"),) if sweep.slides else ()),
            PageColumn("u_max_smallest_m", "smallest [mm]", millimetres),
            PageColumn("u_max_largest_m", "largest [mm]", millimetres),
            PageColumn("factor", "factor", fixed),
        ),
        rows,
        "Every motion over all settings: runs that overturned"
        + (" or slid off" if sweep.slides else "")
        + ", smallest and largest peak of those that stood, and their ratio, but where "
        f"it is above {_ROUNDING:g}, as the smaller one is rounding.",
        folded=True,
    )
