"""Distributions of the peak top displacement of a study: a panel for each setting of the other
axes, a line for each level of one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.engines.ending import P_OVERTURN
from fecolumn.pictures.figures.style import (
    COLUMN_WIDTH_IN,
    LINES,
    PAGE_WIDTH_IN,
    new_figure,
    save,
    styled,
)
from fecolumn.statistics.ecdf import Ecdf

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch


_PANELS_A_ROW = 3
_ROOM = 1.08  # of an axis over the largest peak, so that the level of what overturned is seen
_FAR = (
    3.0  # times the peak that 95 % stay below, beyond which the others would be squeezed together
)
SHADED = 2  # shades of more lines would hide each other: these get bars
_BARS = 5  # of each line
SHADES, BARS = "shades: pointwise 95 % bands", "bars: pointwise 95 % bands"


@dataclass(frozen=True, slots=True)
class CdfPanel:
    """One set of axes: its title, a label with a distribution of u_max [m] for each line, and what
    its legend calls the share beyond.
    """

    title: str
    lines: tuple[tuple[str, Ecdf], ...]
    p_lost: str = P_OVERTURN


def cdf_figure(
    panels: list[CdfPanel],
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """Write the figure, as PNG and PDF unless told otherwise.

    Each distribution ends at 1 - P(overturn) and runs on as a level to the end of the axis, a
    little beyond the largest peak of all panels; peaks far beyond all others are named instead. The
    pointwise 95 % band of Greenwood is a shade where a panel has one or two lines, and bars beside
    each other where it has more; the legend gives P(overturn), or what else `Panel.p_lost` calls
    it, with Wilson's 95 % interval.

    Parameters
    ----------
    panels
        at least one.
    path
        file name without suffix.
    formats
        of the files.
    width_in
        of the figure; panels stand one above the other in one of a column's width.
    """
    peaks = [peak for panel in panels for _, distribution in panel.lines for peak in distribution.x]
    limit_mm = 1e3 * axis_end(common(peaks))
    columns = (
        1
        if width_in <= COLUMN_WIDTH_IN
        else 2
        if len(panels) == 4
        else min(len(panels), _PANELS_A_ROW)
    )
    rows = math.ceil(len(panels) / columns)
    deepest = max(len(panel.lines) for panel in panels)
    # one look a label, whatever a panel lacks
    labels = dict.fromkeys(label for panel in panels for label, _ in panel.lines)
    looks = {label: LINES[number % len(LINES)] for number, label in enumerate(labels)}
    # the legend has a strip of its own: a line of points leaves no free corner
    legend_in = 0.3 + 0.145 * (deepest + 1 + (1e3 * max(peaks, default=0.0) > limit_mm))
    with styled():
        figure = new_figure(
            width_in if columns > 1 else min(width_in, 0.6 * PAGE_WIDTH_IN),
            rows * (2.35 + legend_in),
        )
        figure.get_layout_engine().set(w_pad=0.08)
        grid = figure.subplots(
            2 * rows,
            columns,
            squeeze=False,
            gridspec_kw={"height_ratios": [2.35, legend_in] * rows},
        )
        for place in range(rows * columns):
            row, column = divmod(place, columns)
            axes, strip = grid[2 * row, column], grid[2 * row + 1, column]
            strip.set_axis_off()
            if place >= len(panels):
                axes.set_axis_off()
                continue
            note = _draw(axes, panels[place], looks, limit_mm) + _beyond(panels[place], limit_mm)
            if column == 0:
                axes.set_ylabel(r"$P\,(u_{\max} \leq u)$")
            else:
                axes.tick_params(labelleft=False)
            handles, names = axes.get_legend_handles_labels()
            strip.legend(
                [*handles, _nothing()],
                [*names, note],
                loc="upper center",
                framealpha=0,
                borderaxespad=0,
                title=f"{panels[place].p_lost.replace('P(', '$P$(')} [95 % interval]",
                title_fontsize=7.5,
            )
        return save(figure, path, formats)


def axis_end(peaks: Iterable[float]) -> float:
    """Where an axis of displacements ends [m]: a little beyond the largest of the peaks; 1 where
    there is none above 0.
    """
    largest = max(peaks, default=0.0)
    return _ROOM * largest if largest > 0 else 1.0


def common(peaks: Iterable[float]) -> list[float]:
    """The peaks without those so far beyond 95 % of all that they would leave the others no room on
    an axis.
    """
    peaks = list(peaks)
    return [peak for peak in peaks if peak <= _FAR * np.quantile(peaks, 0.95)]


def _beyond(panel: CdfPanel, limit_mm: float) -> str:
    """A line on the peaks beyond the axis, "" where there are none."""
    beyond = [
        1e3 * peak
        for _, distribution in panel.lines
        for peak in distribution.x
        if 1e3 * peak > limit_mm
    ]
    return f"\n{len(beyond)} beyond the axis, up to {max(beyond):.0f} mm" if beyond else ""


def _draw(
    axes: Axes,
    panel: CdfPanel,
    looks: dict[str, tuple[str, str | tuple[int, tuple[int, ...]]]],
    limit_mm: float,
) -> str:
    """Bands below, lines above; what the bands are."""
    shaded = len(panel.lines) <= SHADED
    for number, (label, distribution) in enumerate(panel.lines):
        colour, dashes = looks[label]
        x = np.concatenate([[0.0], 1e3 * distribution.x, [limit_mm]])
        cdf, lower, upper = (
            np.concatenate([[0.0], y, y[-1:] if y.size else [0.0]])
            for y in (distribution.cdf, distribution.lower, distribution.upper)
        )
        if shaded:
            axes.fill_between(
                x, lower, upper, step="post", color=colour, alpha=0.2, linewidth=0, zorder=1
            )
        else:  # of each line at places of its own, in turn
            at = limit_mm * (np.arange(_BARS) + (number + 0.5) / len(panel.lines)) / _BARS
            there = np.searchsorted(x, at, side="right") - 1
            axes.vlines(
                at, lower[there], upper[there], color=colour, linewidth=1.6, alpha=0.55, zorder=1.5
            )
        axes.step(
            x,
            cdf,
            where="post",
            color=colour,
            linestyle=dashes,
            label=f"{label}:  {overturn_text(distribution)}",
            zorder=2,
        )
    axes.set(
        xlim=(0, limit_mm), ylim=(0, 1.02), title=panel.title, xlabel=r"top displacement $u$ [mm]"
    )
    return SHADES if shaded else BARS


def _nothing() -> Patch:
    from matplotlib.patches import Patch

    return Patch(facecolor="none", edgecolor="none", label="")


def overturn_text(distribution: Ecdf) -> str:
    """Share of the runs that were lost and its interval, such as "43.5 % [34.8, 52.6]"."""
    low, high = distribution.lost_interval
    return f"{100 * distribution.lost / distribution.n:.1f} % [{100 * low:.1f}, {100 * high:.1f}]"
