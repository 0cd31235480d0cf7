"""Section: parameters ranked by what they do to the distribution."""

from __future__ import annotations

from typing import Any

from fecolumn.pictures.figures.axis_text import axis_text, level_number
from fecolumn.pictures.figures.interval_figure import IntervalRow, Scale, interval_figure
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.document import PageColumn, PageSection, PageTable, Paragraph
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import (
    axis_name,
    count,
    fixed,
    interval,
    level_text,
    percent_interval,
    sentence,
)
from fecolumn.study.report.ranking import Rank, ranking
from fecolumn.study.report.sweep import Sweep


def sensitivity_section(sweep: Sweep, gallery: Gallery) -> PageSection | None:
    """The section; None where no parameter was varied over common motions."""
    ranks = ranking(sweep)
    if not ranks:
        return None
    first = ranks[0]
    above = [axis_name(rank.axis) for rank in ranks if rank.effect.distance > rank.effect.chance]
    text = (
        "[[sensitivity]] and [[ranking]] rank the parameters by the largest distance "
        "of the CDF between their extreme levels, averaged "
        f"over all other settings. {sentence(axis_name(first.axis))} comes first with "
        f"{fixed(first.effect.distance)} "
        f"{interval(first.effect.distance_low, first.effect.distance_high)}. "
    )
    if any(isinstance(rank.low, tuple) for rank in ranks):
        beside = (
            " Samples differ in all parameters at once: by the luck of few samples an "
            "effect of one shows up under another, too, and "
            "neither intervals nor chance, which are over motions, know of it."
        )
    else:
        beside = ""
    goes = sentence(
        f"{'only ' if len(above) < len(ranks) else ''}{' and '.join(above)} "
        f"{'goes' if len(above) == 1 else 'go'}"
    )
    text += f"{goes if above else 'No parameter goes'} beyond what chance alone gives.{beside}"
    names = [
        f"{axis_text(rank.axis, low)} to {level_number(high)}"
        for rank in ranks
        for low, high in [_ends(rank)]
    ]
    columns = [
        (
            Scale("largest distance of the CDF", (0, None)),
            [
                IntervalRow(
                    name,
                    r.effect.distance,
                    r.effect.distance_low,
                    r.effect.distance_high,
                    r.effect.chance,
                )
                for name, r in zip(names, ranks)
            ],
        ),
        (
            Scale(f"change of {sweep.p_lost.replace('P(', '$P$(')} [%]", level=0.0),
            [
                IntervalRow(
                    name,
                    100 * r.effect.change,
                    100 * r.effect.change_low,
                    100 * r.effect.change_high,
                )
                for name, r in zip(names, ranks)
            ],
        ),
    ]
    figure = gallery.draw(
        "sensitivity",
        "Effect of each parameter between its extreme levels: largest distance of the "
        "CDF, and change of "
        f"{sweep.p_lost}, "
        "with 95 % intervals over the motions. Red: the distance that levels swapped "
        "at random within each motion exceed "
        "in 5 % of cases; a largest distance is never negative, so only beyond the red "
        "line is there evidence of an effect.",
        interval_figure,
        columns,
    )
    rows = [
        (
            r.axis,
            *_ends(r),
            r.settings,
            r.effect.n,
            r.effect.distance,
            r.effect.distance_low,
            r.effect.distance_high,
            r.effect.chance,
            r.effect.change,
            r.effect.change_low,
            r.effect.change_high,
        )
        for r in ranks
    ]
    heads = (
        PageColumn("axis from to", "parameter", _span, text=True),
        PageColumn("settings", "settings"),
        PageColumn("n", "motions"),
        PageColumn("distance", "distance", fixed),
        PageColumn("distance_low distance_high", "95 %", interval),
        PageColumn("chance", "chance", fixed),
        PageColumn(
            "change_p_lost", f"change of {sweep.p_lost} [%]", lambda share: fixed(100 * share, 1)
        ),
        PageColumn("change_low change_high", "95 % [%]", percent_interval),
    )
    return PageSection(
        "Sensitivity",
        [
            Paragraph(text),
            *(
                [Paragraph(sweep.alpha_note, warning=True)]
                if any(rank.axis == ALPHA_KEY for rank in ranks) and sweep.alpha_note
                else []
            ),
            figure,
            PageTable(
                "ranking",
                heads,
                rows,
                "Parameters ranked by the largest distance of the CDF between their "
                "extreme levels (of a sampled "
                "parameter: its outer quarters), averaged over the settings of all others, of "
                f"{count(first.effect.n, 'motion')}. The interval of the distance: its "
                "lower end from a band of 97.5 % for "
                "the whole difference, its upper end the distance that the data "
                "exclude; of the change: Agresti and Min.",
            ),
        ],
    )


def _span(axis: str, low: object, high: object) -> str:
    return f"{axis_name(axis)}: {level_text(axis, low)} to {level_text(axis, high)}"


def _ends(rank: Rank) -> tuple[Any, Any]:
    """Levels compared; of a sampled parameter the least and the largest value."""
    low, high = rank.low, rank.high
    return low[0] if isinstance(low, tuple) else low, high[1] if isinstance(high, tuple) else high
