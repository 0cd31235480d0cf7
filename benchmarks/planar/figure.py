"""Figures of the comparison: distributions of the peaks by each program, and how the multi-drum
column falls.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.planar.advance import History
from fecolumn.pictures.figures.cdf_figure import CdfPanel, cdf_figure
from fecolumn.pictures.figures.style import BLACK, GREY, PAGE_WIDTH_IN, new_figure, save, styled
from fecolumn.statistics.ecdf import ecdf


def distributions(found: dict, path: Path) -> list[Path]:
    """Peaks of the top by structure and program; found: `Response`s by program by structure."""
    panels = []
    for name, programs in found.items():
        lines = [
            (program, ecdf([one.peak for one in responses], [one.fallen for one in responses]))
            for program, responses in programs.items()
        ]
        panels.append(
            CdfPanel(f"{name}, {len(next(iter(programs.values())))} motions", tuple(lines))
        )
    return cdf_figure(panels, path)


def collapse(history: History, path: Path, pictures: int = 6) -> list[Path]:
    """Outlines at equal times from the start to the end of a history."""
    rows = np.linspace(0, len(history.time) - 1, pictures).round().astype(int)
    solid = [number for number, body in enumerate(history.structure.bodies) if not body.fixed]
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 0.3 * PAGE_WIDTH_IN)
        for axes, row in zip(figure.subplots(1, pictures, sharey=True), rows):
            for number in solid:
                outline = (
                    history.structure.bodies[number].outline - history.structure.place[number, :2]
                )
                drawn = np.array(
                    [
                        history.structure.point(number, corner, history.place[row])
                        for corner in (*outline, outline[0])
                    ]
                )
                axes.fill(*drawn.T, facecolor="0.9", edgecolor=BLACK, linewidth=0.6)
            axes.axhline(0.0, color=GREY, linewidth=0.8)
            axes.set(
                title=f"{history.time[row]:.2f} s", aspect="equal", xlim=(-1.5, 4.5), xlabel="x [m]"
            )
            axes.grid(False)
        figure.axes[0].set_ylabel("z [m]")
        return save(figure, path)
