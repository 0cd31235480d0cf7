"""The specimen in elevation and plan, beside a ground motion: what a report is about, at a
glance.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.patches import Polygon, Rectangle

from fecolumn.pictures.figures.specimen_outline import Outline
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
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

    from fecolumn.motions.record import GroundMotion


_FILL, _WALL, _BASE = "#E4E9ED", "#8FA3B3", "#CFD1CC"


def specimen_figure(
    outline: Outline | None,
    tilt_rad: float | None,
    motion: GroundMotion | None,
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """Write the figure: the specimen to scale, dashed at its critical tilt, the plan of its foot,
    and the accelerations of a motion.

    Parameters
    ----------
    outline
        of the specimen; None leaves it out.
    tilt_rad
        critical tilt [rad]; None where it is not known.
    motion
        GroundMotion; None leaves it out. One of the two must be there.
    path
        file name without suffix.
    formats
        of the files.
    width_in
        of the figure.
    """
    narrow, both = width_in <= COLUMN_WIDTH_IN, outline is not None and motion is not None
    with styled():
        figure = new_figure(width_in, 3.1 if not (narrow and both) else 4.9)
        if not both:
            panels = [figure.subplots()]
        elif narrow:
            panels = list(figure.subplots(2, 1, gridspec_kw={"height_ratios": [3, 1.6]}))
        else:
            panels = list(figure.subplots(1, 2, gridspec_kw={"width_ratios": [1, 1.6]}))
        if outline is not None:
            _specimen(panels[0], outline, tilt_rad)
        if motion is not None:
            _motion(panels[-1], motion)
        return save(figure, path, formats)


def _specimen(axes: Axes, outline: Outline, tilt_rad: float | None) -> None:
    top, half = outline.parts[-1].top_m, np.abs(outline.foot[:, 0]).max()
    for part in outline.parts:
        base = part is outline.parts[0]
        axes.add_patch(
            Rectangle(
                (-part.half_width_m, part.bottom_m),
                2 * part.half_width_m,
                part.top_m - part.bottom_m,
                facecolor=_BASE if base else _FILL,
                edgecolor=BLACK,
                linewidth=0.7,
                zorder=2,
            )
        )
        if part.wall_m:
            for side in (-part.half_width_m, part.half_width_m - part.wall_m):
                axes.add_patch(
                    Rectangle(
                        (side, part.bottom_m),
                        part.wall_m,
                        part.top_m - part.bottom_m,
                        facecolor=_WALL,
                        linewidth=0,
                        zorder=2.5,
                    )
                )
    right = max(part.half_width_m for part in outline.parts)
    if tilt_rad:
        c, s = np.cos(tilt_rad), np.sin(tilt_rad)
        for part in outline.parts[1:]:
            corners = np.array(
                [
                    [side * part.half_width_m, height]
                    for side, height in (
                        (-1, part.bottom_m),
                        (1, part.bottom_m),
                        (1, part.top_m),
                        (-1, part.top_m),
                    )
                ]
            )
            turned = (corners - [half, 0]) @ np.array([[c, -s], [s, c]]) + [half, 0]
            axes.add_patch(
                Polygon(
                    turned, fill=False, edgecolor=VERMILION, linestyle="--", linewidth=0.8, zorder=3
                )
            )
            right = max(right, turned[:, 0].max())
        axes.text(
            right,
            top,
            f" critical\n tilt {np.degrees(tilt_rad):.3g}°",
            color=VERMILION,
            fontsize=7.5,
            va="top",
        )
    # the plan of the foot, beside the specimen at its own scale
    scale = 0.16 * top / half
    plan = scale * outline.foot + [right + 0.32 * top, 0.3 * top]
    axes.fill(*plan.T, facecolor=_FILL, edgecolor=BLACK, linewidth=0.7)
    wall = next(
        (
            part.wall_m
            for part in outline.parts[1:]
            if part.wall_m and np.isclose(part.half_width_m, half)
        ),
        None,
    )
    if wall:
        inner = scale * outline.foot * (1 - wall / half) + [right + 0.32 * top, 0.3 * top]
        axes.fill(*inner.T, facecolor="white", edgecolor=BLACK, linewidth=0.5)
    width = "⌀ " if outline.round else ""
    axes.text(
        right + 0.32 * top,
        0.11 * top,
        f"foot, {width}{2e3 * half:.4g} mm",
        ha="center",
        va="top",
        fontsize=7.5,
    )
    left = -max(part.half_width_m for part in outline.parts) - 0.05 * top
    axes.annotate(
        "",
        (left, 0),
        (left, top),
        arrowprops=dict(arrowstyle="<->", linewidth=0.7, shrinkA=0, shrinkB=0),
    )
    axes.text(
        left - 0.02 * top,
        top / 2,
        f"{1e3 * top:.4g} mm",
        rotation=90,
        ha="right",
        va="center",
        fontsize=8,
    )
    axes.set(
        xlim=(left - 0.14 * top, right + 0.56 * top),
        ylim=(outline.parts[0].bottom_m - 0.03 * top, 1.04 * top),
        aspect="equal",
    )
    axes.set_axis_off()


def _motion(axes: Axes, motion: GroundMotion) -> None:
    time = np.arange(len(motion.acceleration)) * motion.dt
    for component, label, colour in zip(
        motion.acceleration.T, ("$a_x$", "$a_y$", "$a_z$"), (BLUE, VERMILION, GREY)
    ):
        if np.abs(component).max() > 0:
            axes.plot(time, component, color=colour, label=label, linewidth=0.6, alpha=0.9)
    axes.set(
        xlabel="time [s]",
        ylabel="ground acceleration [m/s$^2$]",
        xlim=(0, time[-1]),
        title=_short(motion.name),
    )
    axes.legend(loc="upper right", ncol=3)


def _short(name: str) -> str:
    """Name of a motion, without the folder of its file."""
    return name.replace("\\", "/").rpartition("/")[2] if ":" not in name else name
