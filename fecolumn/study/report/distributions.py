"""Section: distributions of the peak, P(overturn) of every setting, pairs of settings compared."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.cdf_figure import BARS, SHADED, SHADES, CdfPanel, cdf_figure
from fecolumn.statistics.ecdf import percentile
from fecolumn.statistics.records import run_count
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.convergence_figure import convergence_blocks
from fecolumn.study.report.document import (
    Figure,
    PageBlock,
    PageSection,
    Paragraph,
)
from fecolumn.study.report.families import families, shortfalls
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import (
    axis_name,
    interval,
    millimetres,
    percent,
    sentence,
)
from fecolumn.study.report.overturning_table import overturning_blocks
from fecolumn.study.report.pair import ComparedPair
from fecolumn.study.report.pair_table import pair_table
from fecolumn.study.report.power import power
from fecolumn.study.report.setting_columns import setting_in_figure, setting_labels
from fecolumn.study.report.sweep import Setting, Sweep

#: Lines of a panel and panels of a figure, at most
_LINES, _PANELS = 7, 9


def distributions(sweep: Sweep, pairs: list[ComparedPair], gallery: Gallery) -> PageSection:
    """The section; figures go to the gallery's folder."""
    figures: list[Figure] = []
    for name, axis in _views(sweep):
        panels = _panels(sweep, axis)
        own = sweep.together(axis) if axis else ()
        other = [axis_name(one) for one in sweep.varied if one not in own]
        what = (
            f"a line for each {' and '.join(axis_name(one) for one in own)}"
            if axis
            else "settings of the study"
            if len(sweep.done) <= _LINES
            else "the settings of least, middle and largest P(overturn)"
        )
        figures.append(
            gallery.draw(
                name,
                f"Distribution of the largest top displacement: {what}"
                + (f", a panel for each {' and '.join(other)}" if other and axis else "")
                + _left_out(sweep, panels)
                + f". {'Lost' if sweep.slides else 'Overturned'} runs are censored: a "
                f"distribution ends at 1 − {sweep.p_lost}. {_bands(panels)}: pointwise "
                f"95 % bands (Greenwood){_seen(panels)}; in the legend {sweep.p_lost} "
                "with Wilson's 95 % interval.",
                cdf_figure,
                panels,
            )
        )
    blocks: list[PageBlock] = [Paragraph(_opening(sweep, figures[0].name)), *figures]
    blocks += overturning_blocks(sweep, gallery)
    if len(sweep.done) > 1:
        blocks.append(power(sweep))
    if pairs:
        blocks += [
            Paragraph(
                "[[families]] and, pair by pair, [[comparisons]] compare settings that "
                "differ in one parameter alone. The same "
                "motions are in both, so the paired permutation p is the one to judge "
                "by, and that of independent samples is "
                "conservative; p (Holm) is the paired one, corrected for the family of "
                "tests that answer one question. The "
                "last column is the other side of the test, the largest distance that "
                "the data cannot exclude at 95 %."
            ),
            *shortfalls(pairs),
            *(
                [Paragraph(sweep.alpha_note, warning=True)]
                if sweep.alpha_note and ALPHA_KEY in sweep.varied
                else []
            ),
            families(pairs),
            pair_table(sweep, pairs),
        ]
    return PageSection("Distributions", blocks + convergence_blocks(sweep, gallery))


def _bands(panels: list[CdfPanel]) -> str:
    """What the bands of a figure are."""
    kinds = {(SHADES if len(panel.lines) <= SHADED else BARS).partition(":")[0] for panel in panels}
    return " and ".join(sorted(kinds)).capitalize()


def _seen(panels: list[CdfPanel]) -> str:
    return (
        ", of each line at places of its own"
        if any(len(panel.lines) > SHADED for panel in panels)
        else ""
    )


def _views(sweep: Sweep) -> list[tuple[str, str | None]]:
    """Axes that are drawn as lines: up to three with few levels, most levels first."""
    axes = sorted(
        (axis for axis in sweep.leading if len(sweep.axes[axis]) <= _LINES and sweep.lines(axis)),
        key=lambda axis: -len(sweep.axes[axis]),
    )
    return [(f"cdf_by_{axis.split('.')[-1]}", axis) for axis in axes[:3]] or [("cdf", None)]


def _median(u_max: NDArray[Any], overturned: NDArray[Any]) -> float:
    return percentile(u_max, overturned, fraction=0.5)


def _panels(sweep: Sweep, axis: str | None) -> list[CdfPanel]:
    if axis is None:
        chosen = list(sweep.done)
        # of many unordered ones the least, the middle and the most dangerous
        if len(chosen) > _LINES:
            ranked = sorted(
                chosen,
                key=lambda one: (one.column("overturned").mean(), _median(*one.peaks())),
            )
            chosen = [ranked[0], ranked[len(ranked) // 2], ranked[-1]]
        labels = setting_labels(sweep)
        return [
            CdfPanel(
                "", tuple((labels[id(one)], one.distribution()) for one in chosen), sweep.p_lost
            )
        ]
    groups: dict[str, list[Setting]] = {}
    for setting in sorted(
        sweep.done,
        key=lambda one: [sweep.axes[key].index(value) for key, value in one.values.items()],
    ):
        title = setting_in_figure(
            {
                key: value
                for key, value in setting.values.items()
                if key not in sweep.together(axis) and key in sweep.varied
            }
        )
        groups.setdefault(title, []).append(setting)

    def level_of(setting: Setting) -> str:
        return ", ".join(axis_text(key, setting.values[key]) for key in sweep.together(axis))

    panels = [
        CdfPanel(
            title,
            tuple((level_of(one), one.distribution()) for one in group),
            sweep.p_lost,
        )
        for title, group in groups.items()
    ]
    return panels[:_PANELS]


def _left_out(sweep: Sweep, panels: list[CdfPanel]) -> str:
    drawn, there = sum(len(panel.lines) for panel in panels), len(sweep.done)
    return f" ({drawn} of {there} settings)" if drawn < there else ""


def _opening(sweep: Sweep, figure: str) -> str:
    u, over = sweep.reference.peaks()
    fallen = sweep.reference.column("overturned")
    low, high = sweep.reference.overturning()
    median = percentile(u, over, fraction=0.5)
    half = (
        " mm"
        if np.isfinite(median)
        else f" (more than half {'are lost' if fallen.sum() < over.sum() else 'overturn'})"
    )
    return (
        f"[[{figure}]] shows the distribution of the largest displacement of "
        f"{sweep.subject.top}, u_max, in every setting. "
        f"{sentence(sweep.at(sweep.reference.values))} half of the "
        f"{run_count(over.size, sweep.reference.records_of(), 'motion')} stay below "
        f"{millimetres(median)}{half}, and "
        f"{int(fallen.sum())} overturn: P(overturn) = {percent(fallen.mean())}, 95 % "
        f"interval {interval(low, high, percent)}."
    )
