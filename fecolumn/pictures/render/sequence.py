"""A column at several instants side by side, over the history that leads through them: a figure for
papers.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.style import BLACK, PAGE_WIDTH_IN, new_figure, save, styled
from fecolumn.pictures.render.canvas import COLOUR_MAPS
from fecolumn.pictures.render.overlay import draw_legend
from fecolumn.pictures.render.panel import draw_strip
from fecolumn.pictures.render.strips import strips_of

if TYPE_CHECKING:
    from fecolumn.pictures.render.frames import Frames


# Heights of the strips below the pictures, least and largest of the pictures, and gap between
# these; the colour bar's width [in]
_STRIP_IN, _HEIGHTS_IN, _GAP_IN, _BAR_IN = 0.95, (1.3, 3.6), 0.06, 0.12
_LEFT_IN, _RIGHT_IN = 0.55, 0.75
# Of the legend of forces [in]
_LEGEND_IN = 0.22
_LETTERS = "abcdefghij"
# Height that they take of a strip, over that of its line [-]
_LETTERS_SHARE = 0.25
# Share of the axis [-] within which a letter stands beside its line, not over it
_END = 0.02


def beside(frames: Frames) -> float:
    """Width [in] of what stands beside the pictures: the scale of colours, and of deformation."""
    return _RIGHT_IN if frames.coloured or frames.exaggeration != 1 else 0.0


def picture_size(count: int, natural: float, dpi: int, right: float = _RIGHT_IN) -> tuple[int, int]:
    """(width, height) [pixels] of each of `count` pictures in the figure; natural: width over
    height of what they show; right: width [in] of what stands beside them.
    """
    width = (PAGE_WIDTH_IN - right) / count - _GAP_IN
    return round(width * dpi), round(float(np.clip(width / natural, *_HEIGHTS_IN)) * dpi)


def sequence_figure(
    frames: Frames,
    images: list[np.ndarray],
    dpi: int,
    times: np.ndarray,
    path: Path,
    formats: Sequence[str] = ("png", "pdf"),
    legend: float = 0.0,
) -> list[Path]:
    """Write the figure as PNG and PDF.

    Parameters
    ----------
    frames
        of the instants.
    images
        of `Canvas`, as many, of `picture_size` with `dpi`.
    times
        (2,) [s] first and last of the history shown.
    path
        without suffix.
    legend
        force [N] whose arrow is as long as the pictures are high, 0 where none are drawn.
    """
    from matplotlib.cm import ScalarMappable

    count, strips = len(images), strips_of(frames.result, times)[:2]
    picture = images[0].shape[0] / dpi
    below = _LEGEND_IN if legend else 0.0
    height = picture + below + len(strips) * _STRIP_IN + 0.75
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, height)
        figure.set_layout_engine("none")
        width = (PAGE_WIDTH_IN - beside(frames)) / count
        for k, image in enumerate(images):
            axes = figure.add_axes(
                [
                    k * width / PAGE_WIDTH_IN,
                    1 - (picture + 0.22) / height,
                    (width - _GAP_IN) / PAGE_WIDTH_IN,
                    picture / height,
                ]
            )
            axes.imshow(image, interpolation="none", aspect="auto")
            axes.axis("off")
            axes.set_title(
                f"({_LETTERS[k]}) $t$ = {frames.times[k]:.{_digits(frames.times)}f} s", pad=3
            )
        if frames.coloured:
            place = [
                1 - (_RIGHT_IN - 0.08) / PAGE_WIDTH_IN,
                1 - (0.85 * picture + 0.22) / height,
                _BAR_IN / PAGE_WIDTH_IN,
                0.7 * picture / height,
            ]
            quantity = frames.colour_quantity
            figure.colorbar(
                ScalarMappable(quantity.norm(), COLOUR_MAPS[frames.colour]),
                cax=figure.add_axes(place),
                label=quantity.label,
            )
        if legend:
            place = [0, 1 - (picture + 0.22 + below) / height, 1, below / height]
            draw_legend(figure.add_axes(place), frames, legend / picture)
        for row, strip in enumerate(strips):
            bottom = 0.42 + (len(strips) - 1 - row) * (_STRIP_IN + 0.02)
            axes = figure.add_axes(
                [
                    _LEFT_IN / PAGE_WIDTH_IN,
                    bottom / height,
                    1 - (_LEFT_IN + 0.12) / PAGE_WIDTH_IN,
                    (_STRIP_IN - 0.22) / height,
                ]
            )
            draw_strip(axes, strip, last=row == len(strips) - 1)
            low, high = axes.get_ylim()
            axes.set_ylim(low, high + _LETTERS_SHARE * (high - low) * (row == 1))
            for k, time in enumerate(frames.times):
                axes.axvline(time, color=BLACK, linewidth=0.7, linestyle=(0, (3, 2)))
                if row == 1:
                    share = (time - strip.time[0]) / (
                        strip.time[-1] - strip.time[0]
                    )  # at the ends the letter stays off the axis' numbers
                    side = "left" if share < _END else "right" if share > 1 - _END else "center"
                    axes.annotate(
                        _LETTERS[k],
                        (time, 1),
                        (0, -2),
                        xycoords=("data", "axes fraction"),
                        textcoords="offset points",
                        ha=side,
                        va="top",
                        fontsize=8,
                        bbox=dict(facecolor="white", edgecolor="none", pad=0.8),
                    )
        if frames.exaggeration != 1:
            figure.text(
                1 - 0.02 / PAGE_WIDTH_IN,
                1 - (picture + 0.2) / height,
                f"elastic\ndeformation\n× {frames.exaggeration:g}",
                ha="right",
                va="bottom",
                fontsize=8,
            )
        return save(figure, path, formats)


def _digits(times: np.ndarray) -> int:
    return 2 if len(times) < 2 or np.diff(times).min() > 0.02 else 3
