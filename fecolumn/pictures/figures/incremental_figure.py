"""Incremental dynamic analysis: peak displacement over intensity, a line a motion."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fecolumn.pictures.figures.cdf_figure import axis_end
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)
from fecolumn.statistics.incremental import FRACTILES, IncrementalCurve, fractile_curves

_GRID = 400


def incremental_figure(
    curves: list[IncrementalCurve],
    label: str,
    u_critical_m: float | None,
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """Write the figure; intensity upwards, as Vamvatsikos and Cornell (2002) draw it, so that an
    overturned motion is a level line.

    Parameters
    ----------
    curves
        of all motions.
    label
        of the intensity measure, with its unit.
    u_critical_m
        displacement at which the column stands over its rim, a dashed line [m]; None for none.
    path
        file name without suffix.
    formats
        of the files.
    width_in
        of the figure.
    """
    end = 1e3 * axis_end(u for curve in curves for u in curve.u_max[~curve.overturned])
    top = max(float(curve.im[-1]) for curve in curves)
    grid = np.linspace(0, top, _GRID)
    with styled():
        figure = new_figure(min(width_in, 0.72 * PAGE_WIDTH_IN), 3.4)
        axes = figure.subplots()
        for curve in curves:
            stood, fallen = curve.first
            below = curve.im <= stood
            x, y = np.append(0, 1e3 * curve.u_max[below]), np.append(0, curve.im[below])
            if np.isfinite(fallen):
                x, y = np.append(x, [x[-1], end]), np.append(y, [fallen, fallen])
                axes.plot(end, fallen, ">", color=GREY, markersize=3, clip_on=False, zorder=1.5)
            axes.plot(x, y, color=GREY, linewidth=0.5, alpha=0.7, zorder=1)
        axes.plot([], [], color=GREY, linewidth=0.6, label=f"{len(curves)} motions, ▸ overturned")
        for share, u, (colour, dashes) in zip(
            FRACTILES,
            fractile_curves(curves, grid),
            ((BLUE, "--"), (BLACK, "-"), (VERMILION, "-.")),
        ):
            known = np.isfinite(u)
            x, y = 1e3 * u[known], grid[known]
            if np.isinf(u).any():
                level = grid[np.isinf(u)][0]
                x, y = np.append(x, [x[-1] if x.size else 0.0, end]), np.append(y, [level, level])
            axes.plot(
                x,
                y,
                color=colour,
                linestyle=dashes,
                linewidth=1.5,
                label=f"{100 * share:.0f} % of the motions",
                zorder=3,
            )
        if u_critical_m and 1e3 * u_critical_m < end:
            axes.axvline(
                1e3 * u_critical_m,
                color=GREY,
                linestyle=":",
                linewidth=1.0,
                label=f"critical, {1e3 * u_critical_m:.3g} mm",
                zorder=0.5,
            )
        axes.set(
            xlim=(0, end),
            ylim=(0, 1.03 * top),
            xlabel=r"largest top displacement $u_{\max}$ [mm]",
            ylabel=label,
        )
        axes.legend(
            loc="upper left", bbox_to_anchor=(0, -0.17), ncol=2, borderaxespad=0, framealpha=0
        )
        return save(figure, path, formats)
