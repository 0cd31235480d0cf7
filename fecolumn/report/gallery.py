"""The folder of a report's figures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from fecolumn.report.document import Figure


@dataclass(frozen=True, slots=True)
class Gallery:
    """Where figures go, in which formats, and whether the study has the axes of the paper."""

    folder: Path
    paper: bool
    formats: tuple[str, ...] = ("png", "pdf", "svg")

    def path(self, name: str) -> Path:
        return self.folder / name

    def figure(self, name: str, files: list[Path], caption: str) -> Figure:
        """A figure of the page from the files it was written to."""
        return Figure(name, next(file for file in files if file.suffix == ".svg"), caption)
