"""What a report is made of: sections of paragraphs, figures and tables, numbered as they come."""

from __future__ import annotations

import base64
import itertools
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from fecolumn.foundation.atomic import write_csv

_REFERENCE = re.compile(r"\[\[(\w+)\]\]")
_WIDE = 11
_PATH, _DIGITS = re.compile(rb' d="[^"]*"'), re.compile(rb"(\.\d\d)\d+")


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Text; "[[name]]" stands for "Figure 3" or "Table 2". A `warning` is set off from the rest."""

    text: str
    warning: bool = False
    kind: str = "text"


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure already written as name.svg, and in the formats of `files`; its drawing for a page,
    and that for a narrow screen, as SVG.
    """

    name: str
    svg: bytes
    narrow: bytes
    caption: str
    files: tuple[str, ...] = ("pdf", "png")
    kind: str = "figure"

    @property
    def source(self) -> str:
        """The drawing as a data URI."""
        return _data_uri(self.svg)

    @property
    def narrow_source(self) -> str:
        """The drawing for a narrow screen as a data URI."""
        return _data_uri(self.narrow)


def _data_uri(svg: bytes) -> str:
    """An image of its own, whose names cannot clash with those of other figures; paths to 0.01 of a
    point, which halves it.
    """
    short = _PATH.sub(lambda path: _DIGITS.sub(rb"\1", path[0]), svg)
    return "data:image/svg+xml;base64," + base64.b64encode(short).decode()


@dataclass(frozen=True, slots=True)
class PageColumn:
    """A column of the page's table: its names in the CSV file, its heading with the unit, how its
    values are written.

    A column may show several values in one cell, such as an interval; `name` then holds their names
    with blanks between.
    """

    name: str
    heading: str
    form: Callable[..., str] = str
    text: bool = False

    @property
    def names(self) -> list[str]:
        """Names of the figures side by side: `name` split at spaces."""
        return self.name.split()


@dataclass(frozen=True, slots=True)
class PageTable:
    """A table; rows hold plain values, which the CSV file takes as they are.

    `folded` ones open on demand.
    """

    name: str
    columns: tuple[PageColumn, ...]
    rows: list[tuple[Any, ...]]
    caption: str
    folded: bool = False
    kind: str = "table"

    def cells(self) -> list[list[str]]:
        """What the page shows."""
        cells = []
        for row in self.rows:
            values = iter(row)
            cells.append(
                [
                    column.form(*itertools.islice(values, len(column.names)))
                    for column in self.columns
                ]
            )
        return cells

    @property
    def wide(self) -> bool:
        """Whether it may stand out into the margins."""
        return len(self.columns) > _WIDE

    def write_csv(self, folder: Path) -> Path:
        """Write name.csv."""
        file = folder / f"{self.name}.csv"
        write_csv(
            file,
            [
                [name for column in self.columns for name in column.names],
                *([_plain(value) for value in row] for row in self.rows),
            ],
        )
        return file


def _plain(value: object) -> object:
    """A value as the CSV file takes it: nothing for what is missing, key=value for a setting."""
    if isinstance(value, dict):
        return " ".join(f"{key}={item}" for key, item in value.items())
    return "" if value is None or value != value else value


class PageBlock(Protocol):
    """What a section is made of; its kind says how the page writes it."""

    @property
    def kind(self) -> str:
        """Such as "text", "figure" or "table"."""


@dataclass(frozen=True, slots=True)
class PageSection:
    """A numbered section."""

    title: str
    blocks: Sequence[PageBlock] = field(default_factory=list)

    @property
    def anchor(self) -> str:
        """Anchor of the section in the page, from its title."""
        return re.sub(r"\W+", "-", self.title.lower())


def numbered(sections: list[PageSection]) -> dict[str, str]:
    """Label, such as "Figure 1" or "Table 1", of every figure and table by name."""
    labels: dict[str, str] = {}
    for kind in ("figure", "table"):
        named = [
            block
            for section in sections
            for block in section.blocks
            if isinstance(block, (Figure, PageTable)) and block.kind == kind
        ]
        labels |= {
            block.name: f"{kind.capitalize()}\N{NO-BREAK SPACE}{place}"
            for place, block in enumerate(named, 1)
        }
    return labels


def referenced(text: str, labels: dict[str, str]) -> str:
    """Text with its references resolved.

    Raises
    ------
    KeyError
        a figure or table that is not there.
    """
    return _REFERENCE.sub(lambda match: labels[match[1]], text)
