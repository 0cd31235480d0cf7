"""Peaks of the same motions in pairs of settings, one against the other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from fecolumn.pictures.figures.cdf_figure import axis_end
from fecolumn.pictures.figures.style import (
    BLUE,
    COLUMN_WIDTH_IN,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)
from fecolumn.statistics.correlation import correlation

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_STRIP = 1.14  # the overturned lie beyond the largest peak, in a strip of their own
_ALL_PAIRS = 4  # settings of which every pair is drawn; of more only neighbours


@dataclass(frozen=True, slots=True)
class Variable:
    """One setting: its name, and the peak [m] and end of each of the same motions."""

    name: str
    u_max_m: NDArray[Any]
    overturned: NDArray[Any]


def pair_figure(
    variables: list[Variable],
    limit_m: float,
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """Write the figure: a panel for each pair of up to four settings, of more for each pair of
    neighbours.

    A lost run (overturned, or slid off the base) is drawn in the shaded strip beyond the largest
    peak; a motion that overturned in one of the two settings alone, a flip, is an open red diamond.
    The title has the correlation R and the number of flips.

    Parameters
    ----------
    variables
        two settings or more, the same motions in the same order in each.
    limit_m
        displacement of overturned runs in R [m].
    path
        file name without suffix.
    formats
        of the files.
    width_in
        of the figure.
    """
    pairs = list(
        itertools.combinations(variables, 2)
        if len(variables) <= _ALL_PAIRS
        else itertools.pairwise(variables)
    )
    columns = min(len(pairs), 2 if width_in <= COLUMN_WIDTH_IN else 3)
    if width_in <= COLUMN_WIDTH_IN and len(pairs) > 1:
        columns = 1
    rows = math.ceil(len(pairs) / columns)
    fallen = any(one.overturned.any() for one in variables)
    end = 1e3 * axis_end(u for one in variables for u in one.u_max_m[~one.overturned])
    with styled():
        cell = min(width_in / columns, 2.6 if columns > 1 else 3.2)
        figure = new_figure(cell * columns, 1.02 * cell * rows)
        grid = figure.subplots(rows, columns, squeeze=False)
        for place, axes in enumerate(grid.flat):
            if place < len(pairs):
                _pair(axes, *pairs[place], end, limit_m, fallen)
            else:
                axes.set_axis_off()
        return save(figure, path, formats)


def _pair(axes: Axes, a: Variable, b: Variable, end: float, limit_m: float, fallen: bool) -> None:
    middle = (1 + _STRIP) / 2 * end
    # where many overturn in both, points of one place would hide each other: spread along the
    # strip, always the same way
    shift = 0.045 * end * np.sin(2.4 * np.arange(a.u_max_m.size))
    x, y = (
        np.where(
            one.overturned, middle + sign * shift, 1e3 * np.where(one.overturned, 0, one.u_max_m)
        )
        for one, sign in ((a, 1), (b, -1))
    )
    axes.axvspan(end, _STRIP * end, color="#EEEEEE", zorder=0)
    axes.axhspan(end, _STRIP * end, color="#EEEEEE", zorder=0)
    axes.plot([0, end], [0, end], color=GREY, linewidth=0.6, zorder=1)
    flip = a.overturned ^ b.overturned
    axes.scatter(x[~flip], y[~flip], s=9, color=BLUE, alpha=0.65, linewidths=0, zorder=2)
    axes.scatter(
        x[flip],
        y[flip],
        s=13,
        marker="D",
        facecolors="none",
        edgecolors=VERMILION,
        linewidths=0.8,
        zorder=3,
    )
    ticks = [tick for tick in MaxNLocator(4).tick_values(0, end) if 0 <= tick < 0.92 * end]
    # no strip for what is not there
    top, strip, word = (_STRIP * end, [middle], ["lost"]) if fallen else (end, [], [])
    axes.set(xlim=(0, top), ylim=(0, top), aspect="equal", xlabel=_label(a), ylabel=_label(b))
    axes.set_xticks([*ticks, *strip], [*(f"{tick:g}" for tick in ticks), *word])
    axes.set_yticks([*ticks, *strip], [*(f"{tick:g}" for tick in ticks), *word])
    axes.grid(False)
    r = correlation(a.u_max_m, a.overturned, b.u_max_m, b.overturned, limit_m)
    text = rf"$R$ = {r:.2f}".replace("-", "\N{MINUS SIGN}") if np.isfinite(r) else "$R$ undefined"
    axes.set_title(f"{text}, {int(flip.sum())} flip{'' if flip.sum() == 1 else 's'}", fontsize=8)


def _label(one: Variable) -> str:
    return rf"$u_{{\max}}$ [mm], {one.name}"
