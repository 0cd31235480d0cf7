"""Estimates with their intervals, one a row: probabilities of overturning, effects of
parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fecolumn.pictures.figures.style import (
    BLUE,
    COLUMN_WIDTH_IN,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)


@dataclass(frozen=True, slots=True)
class IntervalRow:
    """One row.

    Attributes
    ----------
    name
        what stands at its left.
    value, low, high
        estimate and interval.
    mark
        a level of comparison drawn as a short red line, None for none.
    """

    name: str
    value: float
    low: float
    high: float
    mark: float | None = None


@dataclass(frozen=True, slots=True)
class Scale:
    """An axis of estimates: its label, its limits, and a level across all rows with its words (None
    for none).
    """

    label: str
    limits: tuple[float | None, float | None] = (None, None)
    level: float | None = None
    level_label: str = ""


def interval_figure(
    columns: list[tuple[Scale, list[IntervalRow]]],
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """Write the figure; the columns share their rows, and stand one above the other in a figure of
    a column's width.

    Parameters
    ----------
    columns
        scale and estimates of each; the estimates of all name the same rows.
    path
        file name without suffix.
    formats
        of the files.
    width_in
        of the figure.
    """
    rows, narrow = len(columns[0][1]), width_in <= COLUMN_WIDTH_IN
    names = [one.name.replace(", ", ",\n") if narrow else one.name for one in columns[0][1]]
    row_in = 0.19 if not narrow else 0.08 + 0.13 * max(name.count("\n") + 1 for name in names)
    shape = (len(columns), 1) if narrow else (1, len(columns))
    with styled():
        figure = new_figure(width_in, shape[0] * (0.75 + row_in * max(rows, 2)))
        grid = figure.subplots(*shape, squeeze=False, sharey=True).ravel()
        for axes, (scale, estimates) in zip(grid, columns):
            for place, one in enumerate(estimates):
                axes.plot(
                    [one.low, one.high],
                    [place, place],
                    color=BLUE,
                    linewidth=1.2,
                    solid_capstyle="butt",
                )
                axes.plot(one.value, place, "o", color=BLUE, markersize=3.8)
                if one.mark is not None:
                    axes.plot(
                        [one.mark, one.mark],
                        [place - 0.3, place + 0.3],
                        color=VERMILION,
                        linewidth=1.2,
                    )
            if scale.level is not None:
                axes.axvline(
                    scale.level,
                    color=GREY if not scale.level_label else VERMILION,
                    linewidth=0.8,
                    linestyle="--",
                    zorder=0.5,
                    label=scale.level_label or None,
                )
                if scale.level_label:
                    axes.legend(
                        loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.1, framealpha=0
                    )
            axes.set(xlabel=scale.label, xlim=scale.limits, ylim=(rows - 0.4, -0.6))
            axes.grid(axis="y", visible=False)
            axes.tick_params(axis="y", length=0)
        for axes in grid if narrow else grid[:1]:
            axes.set_yticks(range(rows), names)
        return save(figure, path, formats)
