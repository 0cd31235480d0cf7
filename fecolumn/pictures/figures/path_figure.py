"""Path of the top seen from above, beside the foot of the column."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

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

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import LineCollection

    from fecolumn.pictures.figures.history_curves import EndingMark, HistoryCurves


# A path smaller than this share of the foot gets a panel of its own
_SMALL = 0.45
# Way along the path, over its reach, drawn as one straight line: a third of a point on paper
_STRAIGHT = 1 / 400


def path_figure(
    history: HistoryCurves,
    ending: EndingMark,
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
) -> list[Path]:
    """Path of the top coloured by time, to one scale with the outline of the foot; a small path is
    drawn once more, enlarged.

    Parameters
    ----------
    history, ending
        of `history_curves`.
    path
        file name without suffix.
    formats
        of the files.
    """
    u = 1e3 * history.u_top[:, :2]
    reach = max(float(np.abs(u).max()), 1e-6)
    foot = None if ending.outline is None else 1e3 * ending.outline.foot
    both = foot is not None and reach < _SMALL * np.abs(foot).max()
    with styled():
        figure = new_figure(PAGE_WIDTH_IN if both else COLUMN_WIDTH_IN, 3.1)
        grid = figure.subplots(1, 2 if both else 1, squeeze=False)[0]
        if foot is not None:
            axes = grid[0]
            axes.plot(*foot.T, color=GREY, linewidth=1.0, label="foot", zorder=1)
            if ending.u_critical_m and 1e3 * ending.u_critical_m < 3 * max(
                reach, np.abs(foot).max()
            ):
                _circle(axes, 1e3 * ending.u_critical_m)
        lines = [_path(axes, u, history.time, ending) for axes in grid][-1]
        for number, axes in enumerate(grid):
            enlarged = both and number
            drawn = (
                [reach]
                if enlarged
                else [
                    reach,
                    *(
                        np.abs(line.get_xydata()).max()
                        for line in axes.lines
                        if line.get_label() != "_path"
                    ),
                ]
            )
            half = 1.08 * max(drawn)
            axes.set(
                xlim=(-half, half),
                ylim=(-half, half),
                aspect="equal",
                xlabel="$u_x$ [mm]",
                ylabel="$u_y$ [mm]",
                title="enlarged" if enlarged else "",
            )
        grid[0].legend(
            loc="lower left", bbox_to_anchor=(0, 1.0), ncol=2, framealpha=0, borderaxespad=0.2
        )
        figure.colorbar(lines, ax=list(grid), label="time [s]", shrink=0.85)
        return save(figure, path, formats)


def _circle(axes: Axes, radius: float) -> None:
    angle = np.linspace(0, 2 * np.pi, 181)
    axes.plot(
        radius * np.cos(angle),
        radius * np.sin(angle),
        color=GREY,
        linestyle="--",
        linewidth=0.9,
        label=f"critical, $u_c$ = {radius:.3g} mm",
        zorder=1,
    )


def _drawn(u: NDArray[Any]) -> NDArray[Any]:
    """Numbers of the points of a path (n, 2) that are drawn: few enough for a small file."""
    way = np.append(0.0, np.linalg.norm(np.diff(u, axis=0), axis=1).cumsum())
    line = max(_STRAIGHT * float(np.abs(u).max()), np.finfo(float).tiny)
    first: NDArray[Any] = np.unique(np.floor(way / line), return_index=True)[1]
    return np.append(first, len(u) - 1) if first[-1] < len(u) - 1 else first


def _path(axes: Axes, u: NDArray[Any], time: NDArray[Any], ending: EndingMark) -> LineCollection:
    from matplotlib.collections import LineCollection

    drawn = _drawn(u)
    lines = LineCollection(
        np.stack([u[drawn[:-1]], u[drawn[1:]]], axis=1),
        array=time[drawn[1:]],
        cmap="viridis",
        linewidths=0.9,
        capstyle="round",
        zorder=2,
    )
    lines.set_clim(time[0], time[-1])
    axes.add_collection(lines)
    axes.plot(*u[0], "o", color=BLACK, markersize=4, label="start", linestyle="none")
    axes.plot(
        *u[-1],
        "X" if ending.lost else "s",
        color=VERMILION,
        markersize=4.5,
        label=ending.words,
        linestyle="none",
    )
    return lines
