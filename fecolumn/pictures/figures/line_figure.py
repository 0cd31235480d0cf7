"""Curves with bands, in panels side by side: cost, convergence, overturns in time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.style import (
    COLUMN_WIDTH_IN,
    LINES,
    PAGE_WIDTH_IN,
    new_figure,
    save,
    styled,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# shades of more curves would hide each other: these get bars, of each curve at places of its own
_SHADED = 2
_BARS, _HEIGHT_IN = 6, 2.6


@dataclass(frozen=True, slots=True)
class Curve:
    """One curve: its name, points, and band (None for none); with `bars`, lower and upper ends of
    theirs, points alone.
    """

    name: str
    x: NDArray[Any]
    y: NDArray[Any]
    band: tuple[NDArray[Any], NDArray[Any]] | None = None
    steps: bool = False
    markers: bool = False
    bars: tuple[NDArray[Any], NDArray[Any]] | None = None


@dataclass(frozen=True, slots=True)
class CurvePanel:
    """One set of axes: labels, curves, what is set on the axes besides (limits, scales), and where
    the legend is.
    """

    xlabel: str
    ylabel: str
    curves: list[Curve]
    settings: dict[str, Any]
    legend_title: str | None = None
    prepare: Callable[[Axes], object] | None = None
    legend: str = "best"


def line_figure(
    panels: list[CurvePanel],
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """Write the figure.

    Parameters
    ----------
    panels
        side by side, one above the other in a figure of a column's width; at most seven curves in
        each.
    path
        file name without suffix.
    formats
        of the files.
    width_in
        of the figure.
    """
    narrow = width_in <= COLUMN_WIDTH_IN
    shape = (len(panels), 1) if narrow else (1, len(panels))
    with styled():
        figure = new_figure(
            width_in if narrow or len(panels) > 1 else 0.68 * width_in, _HEIGHT_IN * shape[0]
        )
        for axes, panel in zip(figure.subplots(*shape, squeeze=False).flat, panels):
            banded = sum(curve.band is not None for curve in panel.curves)
            for number, (curve, (colour, dashes)) in enumerate(zip(panel.curves, LINES)):
                if curve.band is not None:
                    _band(axes, curve, colour, number, banded)
                if curve.bars is not None:
                    axes.errorbar(
                        curve.x,
                        curve.y,
                        np.abs(np.array(curve.bars) - curve.y),
                        color=colour,
                        label=curve.name or None,
                        fmt="o",
                        markersize=3,
                        linewidth=0.8,
                        capsize=2,
                    )
                    continue
                axes.plot(
                    curve.x,
                    curve.y,
                    color=colour,
                    linestyle=dashes,
                    label=curve.name or None,
                    marker="o" if curve.markers else None,
                    markersize=3,
                    drawstyle="steps-post" if curve.steps else "default",
                )
            axes.set(**{"xlabel": panel.xlabel, "ylabel": panel.ylabel, **panel.settings})
            if panel.prepare:
                panel.prepare(axes)
            if any(curve.name for curve in panel.curves):
                axes.legend(loc=panel.legend, title=panel.legend_title, title_fontsize=7.5)
        return save(figure, path, formats)


def _band(axes: Axes, curve: Curve, colour: str, number: int, banded: int) -> None:
    """Shade of a curve's band, or where many curves have one, bars of it: at its points, or at
    places of its own.
    """
    if curve.band is None:
        return
    lower, upper = map(np.asarray, curve.band)
    if banded <= _SHADED:
        axes.fill_between(
            curve.x,
            lower,
            upper,
            step="post" if curve.steps else None,
            color=colour,
            alpha=0.15,
            linewidth=0,
        )
        return
    at = np.arange(len(curve.x))
    if not curve.markers:
        at = np.unique(
            ((np.arange(_BARS) + (number + 0.5) / banded) / _BARS * len(curve.x)).astype(int)
        )
    axes.vlines(
        np.asarray(curve.x)[at],
        lower[at],
        upper[at],
        color=colour,
        linewidth=1.6,
        alpha=0.5,
    )
