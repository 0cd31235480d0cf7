"""Figure of `benchmarks.fragility`."""

from __future__ import annotations

import numpy as np

from benchmarks.fragility.motions import PGV
from benchmarks.fragility.report import PERIODS, half_lost, lost, surface
from benchmarks.fragility.structures import COLUMN, DRUMS, ELASTIC
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PAGE_WIDTH_IN,
    PURPLE,
    SKY,
    VERMILION,
    new_figure,
    save,
    styled,
)
from fecolumn.statistics.ecdf import proportion_interval
from fecolumn.study.store import FAILED

#: Rigid structures that have curves over PGV, and their elastic twins in the same colour; the other
#: columns of drums stand in the middle panel alone
_COLOURS = {
    "monolith": BLACK,
    "2 drums": BLUE,
    "3 drums": SKY,
    "4 drums": GREEN,
    "6 drums": ORANGE,
    "8 drums": VERMILION,
    "trilith": GREY,
    "frame": PURPLE,
}
#: Edges of the classes of PGV in which shares are drawn [m/s]
_CLASSES = np.geomspace(0.15, 2.5, 7)
_TICKS = 0.2, 0.5, 1, 2


def draw(found: dict[str, list[dict]], path):
    """Panels: share lost over PGV; PGV that loses half over the number of drums, by pulse period;
    shift at the end over PGV. Rows of `run.COLUMNS` by structure. PNG and PDF.
    """
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 3.2)
        panels, below = figure.subfigures(2, 1, height_ratios=(1, 0.16))
        left, middle, right = panels.subplots(1, 3)
        for name, rows in found.items():
            told = [row for row in rows if row["outcome"] != FAILED]
            kind = name.removeprefix(ELASTIC)
            if not told or kind not in _COLOURS:
                continue
            style = dict(color=_COLOURS[kind], linestyle="--" if kind != name else "-")
            _shares(left, told, name, style)
            _shifts(right, told, name, style)
        _halves(middle, found)
        left.set(xscale="log", xlabel="PGV [m/s]", ylabel="P(lost) [-]", ylim=(-0.03, 1.03))
        below.legend(*left.get_legend_handles_labels(), loc="center", ncols=5)
        right.set(
            xscale="log",
            yscale="log",
            xlabel="PGV [m/s]",
            ylabel="median shift at the end, not lost [m]",
        )
        for axes in (left, right):
            axes.set_xticks(_TICKS, [f"{one:g}" for one in _TICKS])
            axes.set_xticks([], minor=True)
        return save(figure, path)


def _classes(rows):
    pgv = np.array([row["pgv_m_s"] for row in rows])
    for low, high in zip(_CLASSES, _CLASSES[1:]):
        within = [rows[n] for n in np.flatnonzero((pgv >= low) & (pgv < high))]
        if within:
            yield float(np.sqrt(low * high)), within


def _shares(axes, rows, name: str, style: dict) -> None:
    points = []
    for at, within in _classes(rows):
        number = sum(map(lost, within))
        points.append((at, number / len(within), *proportion_interval(number, len(within))))
    at, share, low, high = np.array(points).T
    axes.errorbar(at, share, np.abs([share - low, high - share]), capsize=1.5, label=name, **style)


def _shifts(axes, rows, name: str, style: dict) -> None:
    points = [
        (at, np.median(shifts))
        for at, within in _classes(rows)
        if (shifts := [row["shift_m"] for row in within if not lost(row)])
    ]
    if points:
        axes.plot(*np.array(points).T, marker="o", markersize=2.5, label=name, **style)


def _halves(axes, found) -> None:
    columns = [
        (drums, found.get("monolith" if drums == 1 else f"{drums} drums")) for drums in DRUMS
    ]
    for period, colour in zip(PERIODS, (BLUE, ORANGE, VERMILION)):
        points = []
        for drums, rows in columns:
            told = [row for row in rows or [] if row["outcome"] != FAILED]
            if told and (fit := surface(told)) is not None:
                points.append((drums, float(half_lost(fit, period))))
        if points:
            axes.plot(
                *np.array(points).T, marker="o", markersize=3, color=colour, label=f"{period:g} s"
            )
    axes.set(
        xlabel=f"drums of a column of {COLUMN[1]:g} m",
        ylabel="PGV that loses half [m/s]",
        ylim=(0, PGV[1]),
    )
    if axes.lines:
        axes.legend(title="pulse period")
