"""A figure in a notebook: shown as it is written to files, with the axes to change it by."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class Picture:
    """A figure, which a notebook shows.

        picture = result.plot.top()
        picture.axes[0].set_title("first test")
        picture.save("top")

    Attributes
    ----------
    figure
        of matplotlib.
    """

    def __init__(self, draw: Callable[[Path], list[Path]]) -> None:
        """draw: function that writes the figure to the files of a path without suffix, and returns
        them.
        """
        from fecolumn.pictures.figures.style import figures_saved

        with tempfile.TemporaryDirectory() as folder, figures_saved() as saved:
            draw(Path(folder) / "figure")
        self.figure: Figure = saved[-1].figure
        self._fitted = saved[-1].fitted

    @property
    def axes(self) -> list[Axes]:
        """Axes of its panels, those of matplotlib: titles, limits and lines may be changed."""
        return list(self.figure.axes)

    @property
    def png(self) -> bytes:
        """The figure as it is now."""
        with tempfile.TemporaryDirectory() as folder:
            return self._saved(Path(folder) / "figure", ("png",))[0].read_bytes()

    def _repr_png_(self) -> bytes:
        return self.png

    def save(self, path: str | Path) -> list[Path]:
        """Write the figure beside `path`, which takes the suffixes .png and .pdf; the files."""
        path = Path(path)
        return self._saved(path.with_suffix("") if path.suffix in (".png", ".pdf") else path)

    def _saved(self, path: Path, formats: tuple[str, ...] = ("png", "pdf")) -> list[Path]:
        from fecolumn.pictures.figures.style import save, styled

        with styled():
            if self._fitted:  # again, as a title may have come in
                self.figure.set_layout_engine("constrained")
            return save(self.figure, path, formats)
