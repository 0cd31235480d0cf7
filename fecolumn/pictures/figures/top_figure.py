"""Displacement of the top against time, below the ground motion that made it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    legend_beside,
    new_figure,
    save,
    styled,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fecolumn.pictures.figures.history_curves import EndingMark, HistoryCurves


# An axis reaches up to the critical displacement where the peak is above this share of it
_NEAR = 0.4


def top_figure(
    history: HistoryCurves,
    ending: EndingMark,
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
) -> list[Path]:
    """Ground acceleration (where there is one), both components of the top's displacement, and its
    magnitude with its peak.

    The displacement at which the column stands over its rim is a dashed line, or where the peak
    stays far below it, words.

    Parameters
    ----------
    history, ending
        of `history_curves`.
    path
        file name without suffix.
    formats
        of the files.
    """
    time, u = history.time, 1e3 * history.u_top[:, :2]
    magnitude = np.hypot(*u.T)
    shaken = bool(np.abs(history.ground).max() > 0)
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 4.7 if shaken else 3.4)
        panels = figure.subplots(
            3 if shaken else 2,
            1,
            sharex=True,
            gridspec_kw={"height_ratios": [1, 1.2, 1.2] if shaken else [1, 1]},
        )
        if shaken:
            ground_panel(panels[0], time, history.ground)
            legend_beside(panels[0])
        above, below = panels[-2:]
        for component, label, colour in zip(u.T, ("$u_x$", "$u_y$"), (BLUE, VERMILION)):
            above.plot(time, component, color=colour, label=label)
        above.set_ylabel("top, relative to\nthe base [mm]")
        legend_beside(above)
        _magnitude(below, history, ending, magnitude)
        below.set(xlabel="time [s]", xlim=(time[0], time[-1]))
        figure.align_ylabels(panels)
        return save(figure, path, formats)


def ground_panel(axes: Axes, time: NDArray[Any], ground: NDArray[Any]) -> None:
    """Draw the components of a ground acceleration (n, 3) [m/s2] that are not 0 over time [s]."""
    for component, label, colour in zip(
        ground.T, ("$a_x$", "$a_y$", "$a_z$"), (BLUE, VERMILION, GREY)
    ):
        if np.abs(component).max() > 0:
            axes.plot(time, component, color=colour, label=label, linewidth=0.7)
    axes.set_ylabel("ground\n[m/s$^2$]")


def _magnitude(
    axes: Axes, history: HistoryCurves, ending: EndingMark, magnitude: NDArray[Any]
) -> None:
    # what is lost goes on: it is marked where it stopped
    marked = len(magnitude) - 1 if ending.lost else int(np.argmax(magnitude))
    shown = magnitude[marked]
    if not ending.lost and ending.u_max_m is not None:
        shown = 1e3 * ending.u_max_m
    axes.plot(history.time, magnitude, color=BLACK, label=r"$|u| = \sqrt{u_x^2 + u_y^2}$")
    word = f"{ending.words}, stopped at" if ending.lost else r"$u_{\max}$ ="
    axes.plot(
        history.time[marked],
        magnitude[marked],
        "X" if ending.lost else "o",
        color=VERMILION,
        markersize=4.5,
        clip_on=False,
        linestyle="none",
        label=f"{word} {shown:.4g} mm\n{history.time[marked]:.3g} s, tilt "
        f"{'of the top body ' * ending.several}{np.degrees(history.tilt[marked]):.2g}°",
    )
    top, critical = magnitude.max(), 1e3 * (ending.u_critical_m or 0)
    if critical:
        words = f"critical, $u_c$ = {critical:.3g} mm"
        if top > _NEAR * critical:
            axes.axhline(critical, color=GREY, linestyle="--", linewidth=0.9, label=words, zorder=1)
            top = max(top, critical)
        else:
            axes.plot(
                [],
                [],
                linestyle="none",
                label=f"{words},\n{critical / max(top, 1e-12):.3g} times the peak",
            )
    axes.set(ylabel="top, magnitude\n[mm]", ylim=(0, 1.08 * max(top, 1e-9)))
    legend_beside(axes)
