"""One instant alone: the column with its colours' scale, for a paper's column or a slide."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.pictures.figures.style import COLUMN_WIDTH_IN, new_figure, save, styled
from fecolumn.pictures.render.canvas import COLOUR_MAPS
from fecolumn.pictures.render.frame import Frame

# Beside and above the picture; least and largest height of the picture [in]
_RIGHT_IN, _ABOVE_IN, _HEIGHTS_IN = 0.75, 0.25, (1.8, 4.5)


def still_size(natural: float, dpi: int) -> tuple[int, int]:
    """(width, height) [pixels] of the picture; natural: width over height of what it shows."""
    width = COLUMN_WIDTH_IN - _RIGHT_IN
    return round(width * dpi), round(float(np.clip(width / natural, *_HEIGHTS_IN)) * dpi)


def still_figure(
    frames, frame: Frame, image: np.ndarray, dpi: int, path: Path, formats=("png",)
) -> list[Path]:
    """Write the picture (height, width, 3) of a frame, of `still_size`, with its time and the scale
    of its colours; `path` without suffix.
    """
    from matplotlib.cm import ScalarMappable

    tall = image.shape[0] / dpi + _ABOVE_IN
    share = 1 - _ABOVE_IN / tall
    with styled():
        figure = new_figure(COLUMN_WIDTH_IN, tall)
        figure.set_layout_engine("none")
        axes = figure.add_axes([0, 0, 1 - _RIGHT_IN / COLUMN_WIDTH_IN, share])
        axes.imshow(image, interpolation="antialiased", aspect="auto")
        axes.axis("off")
        told = f"$t$ = {frame.time:.3f} s" + (
            f", elastic deformation × {frames.exaggeration:g}" if frames.exaggeration != 1 else ""
        )
        figure.text(0.02, 1 - 0.05 / tall, told, va="top")
        quantity = frames.colour_quantity
        figure.colorbar(
            ScalarMappable(quantity.norm(), COLOUR_MAPS[frames.colour]),
            cax=figure.add_axes(
                [1 - 0.95 * _RIGHT_IN / COLUMN_WIDTH_IN, 0.2 * share, 0.035, 0.6 * share]
            ),
            label=quantity.label,
        )
        return save(figure, path, formats)
