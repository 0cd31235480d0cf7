"""Figure of how long the steps of an analysis take, by what they do."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.step_times import kinds_of
from fecolumn.pictures.figures.style import LINES, PAGE_WIDTH_IN, new_figure, save, styled

# Bins of a decade of time
_BINS = 12


def step_times_figure(rows: NDArray[Any], path: Path) -> list[Path]:
    """Histogram of the times of steps: their number, and the time they take, stacked by what
    they do.

    rows: of `engines.step_times.read_step_times`; path: without its ending.
    """
    spent = np.maximum(rows[:, 1], 0.1)
    low, high = np.floor(np.log10(spent.min())), np.ceil(np.log10(spent.max()) + 1e-9)
    edges = np.logspace(low, high, int(_BINS * max(high - low, 1)) + 1)
    kinds = kinds_of(rows)
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 3.0)
        times = [np.maximum(some[:, 1], 0.1) for _, some in kinds]
        for axes, title, power in zip(
            figure.subplots(1, 2), ("share of the steps [%]", "share of the time [%]"), (0, 1)
        ):
            whole = (spent**power).sum()
            axes.hist(
                times,
                edges,
                weights=[100 * one**power / whole for one in times],
                stacked=True,
                color=[LINES[number % len(LINES)][0] for number in range(len(kinds))],
                label=[name for name, _ in kinds],
            )
            axes.set(xscale="log", xlabel="time of a step [µs]", ylabel=title)
        figure.axes[0].legend()
        return save(figure, path)
