"""One instant alone: the column with its colours' scale, for a paper's column or a slide."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.post.style import COLUMN_WIDTH_IN, new_figure, save, styled
from fecolumn.render.frames import Frame, Frames
from fecolumn.render.scene import COLOUR_MAPS

# Parts of the figure: height [in], and left, bottom, width, height as shares
_HEIGHT_IN = 4.3
_SCENE, _BAR = (0.0, 0.0, 0.8, 0.94), (0.82, 0.25, 0.035, 0.5)


def still_figure(frames: Frames, frame: Frame, image: np.ndarray, path: Path, formats=("png",)) -> list[Path]:
    """Write the picture (height, width, 3) of a frame with its time and the scale of its colours; `path` without suffix."""
    from matplotlib.cm import ScalarMappable

    with styled():
        figure = new_figure(COLUMN_WIDTH_IN, _HEIGHT_IN)
        figure.set_layout_engine("none")
        axes = figure.add_axes(_SCENE)
        axes.imshow(image, interpolation="antialiased")
        axes.axis("off")
        told = f"$t$ = {frame.time:.3f} s" + (f", elastic deformation × {frames.exaggeration:g}" if frames.exaggeration != 1 else "")
        figure.text(0.02, 0.985, told, va="top")
        quantity = frames.colour_quantity
        figure.colorbar(ScalarMappable(quantity.norm(), COLOUR_MAPS[frames.colour]), cax=figure.add_axes(_BAR), label=quantity.label)
        return save(figure, path, formats)
