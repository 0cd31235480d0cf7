"""The figures of a report: drawn for a page, and once more for a narrow screen."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from fecolumn.pictures.figures.style import COLUMN_WIDTH_IN
from fecolumn.study.report.document import Figure


@dataclass(frozen=True, slots=True)
class Gallery:
    """Where figures go, in which formats besides SVG, and whether the study has the axes of the
    paper.
    """

    folder: Path
    paper: bool
    files: tuple[str, ...] = ("pdf", "png")

    def draw(
        self, name: str, caption: str, function: Callable[..., list[Path]], *args: object
    ) -> Figure:
        """A figure of the page.

        Parameters
        ----------
        name
            of its files.
        caption
            below it.
        function
            called as function(*args, path, formats) for the files, and with width_in, a column of a
            journal, for a telephone.
        """
        function(*args, self.folder / name, (*self.files, "svg"))
        with tempfile.TemporaryDirectory() as folder:
            (narrow,) = function(*args, Path(folder) / name, ("svg",), width_in=COLUMN_WIDTH_IN)
            return Figure(
                name,
                (self.folder / f"{name}.svg").read_bytes(),
                narrow.read_bytes(),
                caption,
                self.files,
            )
