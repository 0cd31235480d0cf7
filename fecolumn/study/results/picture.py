"""A figure in a notebook: shown as it is written to files."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path


class Picture:
    """A figure as PNG and PDF.

    Attributes
    ----------
    png
        its bytes, which a notebook shows.
    """

    def __init__(self, draw):
        """draw: function that writes the figure to the files of a path without suffix, and returns
        them.
        """
        self._draw = draw
        with tempfile.TemporaryDirectory() as folder:
            files = draw(Path(folder) / "figure")
            self.png = next(file for file in files if file.suffix == ".png").read_bytes()

    def _repr_png_(self) -> bytes:
        return self.png

    def save(self, path) -> list[Path]:
        """Write the figure beside `path`, which takes the suffixes .png and .pdf; the files."""
        path = Path(path)
        path = path.with_suffix("") if path.suffix in (".png", ".pdf") else path
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            return [
                Path(shutil.copy(file, path.with_name(path.name + file.suffix)))
                for file in self._draw(Path(folder) / "figure")
            ]
