"""Fragility over two intensity measures: contours of the probability of overturning."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.style import (
    BLUE,
    COLUMN_WIDTH_IN,
    GREY,
    VERMILION,
    new_figure,
    save,
    styled,
)

if TYPE_CHECKING:
    from fecolumn.statistics.fragility import Probability


_LEVELS = (0.1, 0.5, 0.9)
_DASHES = (":", "-", "--")
_DECADE = 10.0  # an axis of logarithms needs as much to have its numbers


def contour_figure(
    names: Sequence[str],
    measures: NDArray[Any],
    overturned: NDArray[Any],
    probability: Callable[[NDArray[Any]], Probability],
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = COLUMN_WIDTH_IN,
) -> list[Path]:
    """Runs as points, contours of P(overturn) = 0.1, 0.5, 0.9, and the 95 % band of the middle one
    as a shade.

    Parameters
    ----------
    names
        of the two measures, for the axes.
    measures
        (n, 2) positive.
    overturned
        (n,) bool.
    probability
        im (m, 2) to statistics.fragility.Probability.
    path
        without suffix.
    formats, width_in
        of the figure.
    """
    low, high = measures.min(axis=0), measures.max(axis=0)
    reach = (high / low) ** 0.05
    grids = [np.geomspace(a / r, b * r, 121) for a, b, r in zip(low, high, reach)]
    x, y = np.meshgrid(*grids)
    p = probability(np.column_stack([x.ravel(), y.ravel()]))
    with styled():
        figure = new_figure(1.25 * width_in, 3.2)
        axes = figure.subplots()
        apart = ((p.lower - 0.5) * (p.upper - 0.5)).reshape(x.shape)
        if apart.min() < 0:
            axes.contourf(x, y, apart, levels=[-1.0, 0.0], colors=[BLUE], alpha=0.15)
            axes.fill_between(
                [], [], color=BLUE, alpha=0.15, linewidth=0, label="95 % band of $P$ = 0.5"
            )
        axes.plot(
            *measures[~overturned].T,
            "o",
            fillstyle="none",
            color=GREY,
            markersize=3.5,
            label="stood",
            linestyle="none",
        )
        axes.plot(
            *measures[overturned].T,
            "x",
            color=VERMILION,
            markersize=3.5,
            label="overturned",
            linestyle="none",
        )
        for level, dashes in zip(_LEVELS, _DASHES):
            if p.p.min() < level < p.p.max():
                axes.contour(
                    x, y, p.p.reshape(x.shape), levels=[level], colors=[BLUE], linestyles=[dashes]
                )
                axes.plot([], [], color=BLUE, linestyle=dashes, label=f"$P$ = {level:g}")
        axes.set(xlabel=names[0], ylabel=names[1])
        for axis, grid in zip("xy", grids):
            wide = grid[-1] > _DECADE * grid[0]
            axes.set(**{f"{axis}lim": grid[[0, -1]], f"{axis}scale": "log" if wide else "linear"})
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), framealpha=0)
        return save(figure, path, formats)
