"""Distributions of the peak top displacement of a study: a panel for each time step, a line for each alpha."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.post.style import LINES, PAGE_WIDTH_IN, new_figure, save, styled
from fecolumn.statistics.ecdf import Ecdf, proportion_interval

_PANELS_A_ROW = 3
_ROOM = 1.08  # of an axis over the largest peak, so that the level of what overturned is seen


@dataclass(frozen=True, slots=True)
class Panel:
    """One set of axes: its title, and a label with a distribution of u_max [m] for each line."""

    title: str
    lines: tuple[tuple[str, Ecdf], ...]


def cdf_figure(panels: list[Panel], path, formats=("png", "pdf")) -> list[Path]:
    """Write the figure, as PNG and PDF unless told otherwise.

    Each distribution ends at 1 - P(overturn) and runs on as a level to the end of the axis, a little beyond the largest peak of all
    panels; its shade is the pointwise 95 % band of Greenwood; the legend gives P(overturn) with Wilson's 95 % interval.

    Args:
        panels: at least one.
        path: file name without suffix.
        formats: of the files.
    """
    limit_mm = 1e3 * axis_end(distribution.x[-1] for panel in panels for _, distribution in panel.lines if distribution.x.size)
    columns = 2 if len(panels) == 4 else min(len(panels), _PANELS_A_ROW)
    rows = math.ceil(len(panels) / columns)
    deepest = max(len(panel.lines) for panel in panels)
    looks = {label: None for panel in panels for label, _ in panel.lines}  # one look a label, whatever a panel lacks
    looks = {label: LINES[number % len(LINES)] for number, label in enumerate(looks)}
    legend_in = 0.3 + 0.145 * deepest  # the legend has a strip of its own: a line of points leaves no free corner
    with styled():
        figure = new_figure(PAGE_WIDTH_IN if columns > 1 else PAGE_WIDTH_IN / 2, rows * (2.35 + legend_in))
        figure.get_layout_engine().set(w_pad=0.08)
        grid = figure.subplots(2 * rows, columns, squeeze=False, gridspec_kw={"height_ratios": [2.35, legend_in] * rows})
        for place in range(rows * columns):
            row, column = divmod(place, columns)
            axes, strip = grid[2 * row, column], grid[2 * row + 1, column]
            strip.set_axis_off()
            if place >= len(panels):
                axes.set_axis_off()
                continue
            _draw(axes, panels[place], looks, limit_mm)
            if column == 0:
                axes.set_ylabel(r"$P\,(u_{\max} \leq u)$")
            else:
                axes.tick_params(labelleft=False)
            strip.legend(*axes.get_legend_handles_labels(), loc="upper center", framealpha=0, borderaxespad=0,
                         title=r"$P$(overturn) [95 % interval]", title_fontsize=7.5)
        return save(figure, path, formats)


def axis_end(peaks) -> float:
    """Where an axis of displacements ends [m]: a little beyond the largest of the peaks; 1 where there is none above 0."""
    largest = max(peaks, default=0.0)
    return _ROOM * largest if largest > 0 else 1.0


def _draw(axes, panel: Panel, looks: dict, limit_mm: float) -> None:
    """Bands below, lines above."""
    for label, distribution in panel.lines:
        colour, dashes = looks[label]
        x = np.concatenate([[0.0], 1e3 * distribution.x, [limit_mm]])
        cdf, lower, upper = (np.concatenate([[0.0], y, y[-1:] if y.size else [0.0]])
                             for y in (distribution.cdf, distribution.lower, distribution.upper))
        axes.fill_between(x, lower, upper, step="post", color=colour, alpha=0.12 if len(panel.lines) > 2 else 0.2, linewidth=0, zorder=1)
        axes.step(x, cdf, where="post", color=colour, linestyle=dashes, label=f"{label}:  {overturn_text(distribution)}", zorder=2)
    axes.set(xlim=(0, limit_mm), ylim=(0, 1.02), title=panel.title, xlabel=r"top displacement $u$ [mm]")


def overturn_text(distribution: Ecdf) -> str:
    """P(overturn) and its interval, such as "43.5 % [34.8, 52.6]"."""
    low, high = proportion_interval(distribution.overturned, distribution.n)
    return f"{100 * distribution.overturned / distribution.n:.1f} % [{100 * low:.1f}, {100 * high:.1f}]"
