"""Paths of the top seen from above, all motions of a setting together, and the directions in which
columns were lost.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.pictures.figures.fan_figure import LOOKS, MOST_POINTS, end_legend, rows_within
from fecolumn.pictures.figures.style import (
    BLACK,
    COLUMN_WIDTH_IN,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)
from fecolumn.pictures.figures.thinning import thinned

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from fecolumn.pictures.figures.fan_figure import DrawnTrace


_SECTORS = 12
# times the reach of the paths: a foot or a critical displacement farther off would shrink them
_FAR = 3
_FINE = 0.002  # of the axes, what a path may be off


class LostDirections(NamedTuple):
    """Directions in which columns were lost [deg], from x towards y.

    Attributes
    ----------
    here, anywhere
        of this setting, and of all settings.
    word
        what became of the columns, such as "overturned".
    """

    here: ArrayLike
    anywhere: ArrayLike
    word: str


def plan_figure(
    traces: Sequence[DrawnTrace],
    lost: LostDirections,
    foot: NDArray[Any] | None,
    critical_m: float | None,
    limit_m: float,
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """Write the paths of the top, and beside them the rose of directions where any column was lost.

    Parameters
    ----------
    traces
        of one setting.
    lost
        where columns went that were lost.
    foot
        (k, 2) closed outline of the foot [m]; None where it is not known.
    critical_m
        displacement at which the column stands over its rim [m]; None where it is not known.
    limit_m
        end of the axes [m] where a column was lost.
    path
        file name without suffix.
    formats
        of the files.
    width_in
        of the figure; of a column's width the rose stands below the paths.
    """
    narrow = width_in <= COLUMN_WIDTH_IN
    own, every = np.asarray(lost.here, float), np.asarray(lost.anywhere, float)
    rose = own.size or every.size
    with styled():
        figure = new_figure(
            *(
                (width_in, 6.1 if rose else 3.4)
                if narrow
                else (width_in if rose else 0.6 * width_in, 3.4)
            )
        )
        shape = (2, 1) if narrow else (1, 2)
        axes = figure.add_subplot(*shape, 1) if rose else figure.add_subplot()
        critical, more = _paths(axes, traces, foot, critical_m, limit_m)
        if rose:
            _rose(figure.add_subplot(*shape, 2, projection="polar"), own, every, lost.word)
        end_legend(figure, {trace.end for trace in traces}, critical, more)
        return save(figure, path, formats)


def _paths(
    axes: Axes,
    traces: Sequence[DrawnTrace],
    foot: NDArray[Any] | None,
    critical_m: float | None,
    limit_m: float,
) -> tuple[float | None, list[Artist]]:
    """Draw them; the critical displacement [m] where it is drawn, and what else the legend
    names.
    """
    lines = [_path(trace, limit_m) for trace in traces]
    reach = max((np.abs(u).max() for u in lines), default=0.0)
    raster = sum(map(len, lines)) > MOST_POINTS
    for trace, u in zip(traces, lines):
        colour, marker, _ = LOOKS[trace.end]
        axes.plot(
            *u.T, color=colour, linewidth=0.4, alpha=0.75 if marker else 0.5, rasterized=raster
        )
        if marker:
            axes.plot(
                *u[-1],
                marker,
                color=colour,
                markersize=4,
                markeredgewidth=0,
                clip_on=False,
                zorder=3,
            )
    critical = critical_m if critical_m and 1e3 * critical_m < _FAR * reach else None
    if critical:
        angle = np.linspace(0, 2 * np.pi, 181)
        axes.plot(
            1e3 * critical * np.cos(angle),
            1e3 * critical * np.sin(angle),
            color=BLACK,
            linestyle="--",
            linewidth=0.8,
        )
    more = (
        axes.plot(*(1e3 * foot.T), color=BLACK, linewidth=0.8, label="foot")
        if foot is not None and 1e3 * np.abs(foot).max() < _FAR * reach
        else []
    )
    half = 1.05 * max(
        [reach, 1e-6, *(np.abs(line.get_xydata()).max() for line in more), 1e3 * (critical or 0)]
    )
    axes.set(
        xlim=(-half, half),
        ylim=(-half, half),
        aspect="equal",
        xlabel="$u_x$ [mm]",
        ylabel="$u_y$ [mm]",
        title="path of the top in plan",
    )
    return critical, more


def _path(trace: DrawnTrace, limit_m: float) -> NDArray[Any]:
    """(n, 2) [mm], up to where what was lost is a limit away."""
    stop = rows_within(trace, limit_m)
    rows = thinned(trace.time[:stop], trace.u_top[:stop], (_FINE * limit_m,) * 2)
    millimetres: NDArray[Any] = 1e3 * trace.u_top[rows]
    return millimetres


def _rose(axes: Axes, own: NDArray[Any], every: NDArray[Any], word: str) -> None:
    """Shares of sectors centred on x, so that what falls along an axis is in one."""
    from matplotlib.patheffects import withStroke
    from matplotlib.ticker import MaxNLocator

    width = 2 * np.pi / _SECTORS
    centres = width * np.arange(_SECTORS)
    shares = [
        100
        * np.bincount(
            np.round(np.radians(angles) / width).astype(int) % _SECTORS, minlength=_SECTORS
        )
        / max(angles.size, 1)
        for angles in (own, every)
    ]
    if own.size:
        axes.bar(
            centres,
            shares[0],
            width=width,
            color=VERMILION,
            alpha=0.65,
            edgecolor="white",
            linewidth=0.6,
            label=f"this setting: {own.size}",
        )
    if every.size > own.size:
        axes.bar(
            centres,
            shares[1],
            width=width,
            facecolor="none",
            edgecolor=BLACK,
            linewidth=0.8,
            label=f"all settings: {every.size}",
        )
    axes.set_xticks(centres[::3], ["$+x$", "$+y$", "$-x$", "$-y$"])
    axes.set_ylim(0, 1.08 * max(map(max, shares)))
    axes.set_yticks(
        MaxNLocator(4, steps=[1, 2, 5, 10]).tick_values(0, axes.get_ylim()[1])[1:-1], []
    )
    free = [k for k in range(_SECTORS) if k % 3]  # the names of the axes stand at the others
    angle = centres[min(free, key=lambda k: max(shares[0][k], shares[1][k]))]
    for tick in axes.get_yticks():
        axes.text(
            angle,
            tick,
            f"{tick:g} %",
            fontsize=7.5,
            ha="center",
            va="center",
            path_effects=[withStroke(linewidth=2, foreground="white")],
            zorder=4,
        )
    axes.tick_params(axis="x", pad=1)
    axes.grid(color="#CCCCCC", linewidth=0.5)
    axes.spines["polar"].set(linewidth=0.6, color=GREY)
    axes.set_title(f"{word} towards: share of sector", pad=16)
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.07), ncol=2, framealpha=0, borderaxespad=0.2
    )
