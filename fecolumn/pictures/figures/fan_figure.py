"""Displacement of the top against time, all motions of a setting together: a fan; a panel for each
setting, on the same axes.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.ending import OVERTURNED, SLID_OFF
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH_IN,
    PAGE_WIDTH_IN,
    PURPLE,
    VERMILION,
    new_figure,
    save,
    styled,
)
from fecolumn.pictures.figures.thinning import thinned

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure


#: How motions are drawn by their end: colour, marker where the analysis stopped, name. "" is one
#: that stood.
LOOKS = {
    "": (BLUE, None, "stood"),
    OVERTURNED: (VERMILION, "X", "overturned"),
    SLID_OFF: (PURPLE, "P", "slid off"),
}
MOST_POINTS = 40_000  # more points than these are drawn as an image: megabytes else
_STRIP_IN = 0.17
_FINE = 0.003  # of an axis, what a line may be off: half of its width


class DrawnTrace(Protocol):
    """A history as the figures need it; `report.histories.Trace` is one."""

    @property
    def time(self) -> NDArray[Any]:
        """(n,) [s]."""

    @property
    def u_top(self) -> NDArray[Any]:
        """(n, 2) [m], displacement of the top along x and y."""

    @property
    def end(self) -> str:
        """One of LOOKS."""


@dataclass(frozen=True, slots=True)
class Fan:
    """Panel of a fan figure: its title, lines of it parted by newlines, and its traces."""

    title: str
    traces: Sequence[DrawnTrace]


def fan_figure(
    fans: list[Fan],
    limit_m: float,
    critical_m: float | None,
    across: int,
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """Write |u_top|(t) of all motions; those that were lost in another colour, with a marker where
    they left the axes or ended.

    Parameters
    ----------
    fans
        at least one with a trace.
    limit_m
        end of the axis of displacements [m].
    critical_m
        displacement at which the column stands over its rim [m]; None where it is not known, or not
        the same in all.
    across
        panels side by side in a figure of a page's width; one or two are in a column's.
    path
        file name without suffix.
    formats
        of the files.
    width_in
        of the figure.
    """
    from matplotlib.ticker import MaxNLocator

    narrow = width_in <= COLUMN_WIDTH_IN
    across = min(across, 2 if narrow else across, len(fans))
    rows = math.ceil(len(fans) / across)
    lines = [[_line(trace, limit_m) for trace in fan.traces] for fan in fans]
    raster = sum(len(t) for panel in lines for t, _ in panel) > MOST_POINTS
    end = max(trace.time[-1] for fan in fans for trace in fan.traces)
    with styled():
        alone = len(fans) == 1
        figure = new_figure(
            width_in,
            0.45
            + rows
            * (
                (2.5 if not narrow else 2.2)
                if alone
                else 1.25 + 0.16 * (1 + fans[0].title.count("\n"))
            ),
        )
        grid = figure.subplots(rows, across, squeeze=False, sharex=True, sharey=True)
        for axes in grid.flat[len(fans) :]:
            axes.set_axis_off()
        for axes, fan, panel in zip(grid.flat, fans, lines):
            for trace, (time, top) in zip(fan.traces, panel):
                colour, marker, _ = LOOKS[trace.end]
                axes.plot(
                    time,
                    top,
                    color=colour,
                    linewidth=0.55 if alone else 0.4,
                    alpha=0.75 if marker else 0.5,
                    rasterized=raster,
                )
                if marker:
                    axes.plot(
                        time[-1],
                        min(top[-1], 1e3 * limit_m),
                        marker,
                        color=colour,
                        markersize=4 if alone else 3,
                        markeredgewidth=0,
                        clip_on=False,
                        zorder=3,
                    )
            if critical_m and critical_m < limit_m:
                axes.axhline(1e3 * critical_m, color=BLACK, linestyle="--", linewidth=0.8)
            axes.set_title(fan.title, fontsize=8)
            axes.set(xlim=(0, end), ylim=(0, 1e3 * limit_m))
        grid[0, 0].xaxis.set_major_locator(
            MaxNLocator(8 if alone else 4, integer=end > 4, steps=[1, 2, 4, 5, 10])
        )
        for place in range(len(fans)):
            if place + across >= len(fans):  # the lowest of its column
                grid.flat[place].tick_params(labelbottom=True)
        figure.supxlabel("time $t$ [s]", fontsize=9)
        figure.supylabel(r"top displacement $|u|$ [mm]", fontsize=9)
        end_legend(
            figure,
            {trace.end for fan in fans for trace in fan.traces},
            critical_m if critical_m and critical_m < limit_m else None,
        )
        return save(figure, path, formats)


def _line(trace: DrawnTrace, limit_m: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Time [s] and displacement [mm], up to where what was lost leaves the axes."""
    top = np.hypot(*trace.u_top[: rows_within(trace, limit_m)].T)
    rows = thinned(trace.time[: len(top)], top[:, None], (_FINE * limit_m,))
    return trace.time[rows], 1e3 * top[rows]


def rows_within(trace: DrawnTrace, limit_m: float) -> int:
    """Number of rows up to the first beyond the limit of what was lost; all of what stood."""
    if not trace.end:
        return len(trace.time)
    beyond = np.flatnonzero(np.hypot(*trace.u_top.T) >= limit_m)
    return int(beyond[0]) + 1 if len(beyond) else len(trace.time)


def end_legend(
    figure: Figure,
    ends: Collection[str],
    critical_m: float | None = None,
    more: Iterable[Artist] = (),
) -> None:
    """Legend of the ends of motions, of the critical displacement [m] and what else is drawn, in a
    strip of its own at the top of the figure.
    """
    from matplotlib.lines import Line2D

    shown = [
        Line2D([], [], color=colour, marker=marker, markersize=4, markeredgewidth=0, label=name)
        for end, (colour, marker, name) in LOOKS.items()
        if end in ends
    ]
    if critical_m:
        shown.append(
            Line2D(
                [],
                [],
                color=BLACK,
                linestyle="--",
                linewidth=0.8,
                label=f"critical, $u_c$ = {1e3 * critical_m:.3g} mm",
            )
        )
    shown += more
    rows = 1 if len(shown) <= (3 if figure.get_figwidth() <= COLUMN_WIDTH_IN else 6) else 2
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - rows * _STRIP_IN / figure.get_figheight()))
    figure.legend(
        handles=shown,
        loc="upper center",
        ncol=math.ceil(len(shown) / rows),
        framealpha=0,
        borderaxespad=0.1,
    )
