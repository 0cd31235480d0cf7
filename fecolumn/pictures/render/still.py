"""One instant alone: the column with its colours' scale, for a paper's column or a slide."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.style import COLUMN_WIDTH_IN, new_figure, save, styled
from fecolumn.pictures.render.canvas import COLOUR_MAPS
from fecolumn.pictures.render.frame import Frame
from fecolumn.pictures.render.overlay import draw_legend

if TYPE_CHECKING:
    from fecolumn.pictures.render.frames import Frames


# Beside and above the picture; least and largest height of the picture [in]
_RIGHT_IN, _ABOVE_IN, _HEIGHTS_IN = 0.75, 0.25, (1.8, 4.5)
# Of the legend of forces [in]
_LEGEND_IN = 0.22


def still_size(natural: float, dpi: int, coloured: bool = True) -> tuple[int, int]:
    """(width, height) [pixels] of the picture; natural: width over height of what it shows;
    coloured: whether the scale of colours stands beside it.
    """
    width = COLUMN_WIDTH_IN - (_RIGHT_IN if coloured else 0.0)
    return round(width * dpi), round(float(np.clip(width / natural, *_HEIGHTS_IN)) * dpi)


def still_figure(
    frames: Frames,
    frame: Frame,
    image: np.ndarray,
    dpi: int,
    path: Path,
    formats: Sequence[str] = ("png",),
    legend: float = 0.0,
) -> list[Path]:
    """Write the picture (height, width, 3) of a frame, of `still_size`, with its time and the scale
    of its colours; `path` without suffix; legend: force [N] whose arrow is as long as the picture
    is high, 0 where none are drawn.
    """
    from matplotlib.cm import ScalarMappable

    picture, below = image.shape[0] / dpi, _LEGEND_IN if legend else 0.0
    tall = below + picture + _ABOVE_IN
    right = _RIGHT_IN if frames.coloured else 0.0
    low, share = below / tall, picture / tall
    with styled():
        figure = new_figure(COLUMN_WIDTH_IN, tall)
        figure.set_layout_engine("none")
        axes = figure.add_axes([0, low, 1 - right / COLUMN_WIDTH_IN, share])
        axes.imshow(image, interpolation="antialiased", aspect="auto")
        axes.axis("off")
        caption = f"$t$ = {frame.time:.3f} s" + (
            f", elastic deformation × {frames.exaggeration:g}" if frames.exaggeration != 1 else ""
        )
        figure.text(0.02, 1 - 0.05 / tall, caption, va="top")
        quantity = frames.colour_quantity
        if frames.coloured:
            figure.colorbar(
                ScalarMappable(quantity.norm(), COLOUR_MAPS[frames.colour]),
                cax=figure.add_axes(
                    [1 - 0.95 * right / COLUMN_WIDTH_IN, low + 0.2 * share, 0.035, 0.6 * share]
                ),
                label=quantity.label,
            )
        if legend:
            draw_legend(figure.add_axes([0, 0, 1, low]), frames, legend / picture)
        return save(figure, path, formats)
