"""Curves with bands, in panels side by side: cost, convergence, overturns in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.post.style import LINES, PAGE_WIDTH_IN, new_figure, save, styled


@dataclass(frozen=True, slots=True)
class Curve:
    """One curve: its name, points, and band (None for none); with `bars`, lower and upper ends of theirs, points alone."""

    name: str
    x: np.ndarray
    y: np.ndarray
    band: tuple[np.ndarray, np.ndarray] | None = None
    steps: bool = False
    markers: bool = False
    bars: tuple[np.ndarray, np.ndarray] | None = None


@dataclass(frozen=True, slots=True)
class CurvePanel:
    """One set of axes: labels, curves, what is set on the axes besides (limits, scales), and where the legend is."""

    xlabel: str
    ylabel: str
    curves: list[Curve]
    settings: dict
    legend_title: str | None = None
    prepare: Callable | None = None
    legend: str = "best"


def line_figure(panels: list[CurvePanel], path, formats=("png", "pdf"), height_in: float = 2.6) -> list[Path]:
    """Write the figure.

    Args:
        panels: side by side; at most seven curves in each.
        path: file name without suffix.
        formats: of the files.
        height_in: of the figure [in].
    """
    with styled():
        figure = new_figure(PAGE_WIDTH_IN if len(panels) > 1 else 0.68 * PAGE_WIDTH_IN, height_in)
        for axes, panel in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels):
            for curve, (colour, dashes) in zip(panel.curves, LINES):
                if curve.band is not None:
                    axes.fill_between(curve.x, *curve.band, step="post" if curve.steps else None, color=colour, alpha=0.15, linewidth=0)
                if curve.bars is not None:
                    axes.errorbar(curve.x, curve.y, np.abs(np.array(curve.bars) - curve.y), color=colour, label=curve.name or None, fmt="o", markersize=3,
                                  linewidth=0.8, capsize=2)
                    continue
                axes.plot(curve.x, curve.y, color=colour, linestyle=dashes, label=curve.name or None, marker="o" if curve.markers else None,
                          markersize=3, drawstyle="steps-post" if curve.steps else "default")
            axes.set(xlabel=panel.xlabel, ylabel=panel.ylabel, **panel.settings)
            if panel.prepare:
                panel.prepare(axes)
            if any(curve.name for curve in panel.curves):
                axes.legend(loc=panel.legend, title=panel.legend_title, title_fontsize=7.5)
        return save(figure, path, formats)
