"""Section: distributions of the peak, P(overturn) of every setting, pairs of settings compared."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.cdf_figure import BARS, SHADED, SHADES, CdfPanel, cdf_figure
from fecolumn.pictures.figures.interval_figure import IntervalRow, Scale, interval_figure
from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.statistics.convergence import cdf_convergence
from fecolumn.statistics.ecdf import ecdf, percentile, proportion_interval
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.claim import CALIBRATION_TARGET
from fecolumn.study.report.document import (
    Figure,
    PageBlock,
    PageColumn,
    PageSection,
    PageTable,
    Paragraph,
)
from fecolumn.study.report.families import families, shortfalls
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import (
    axis_name,
    count,
    fixed,
    interval,
    level_text,
    millimetres,
    p_value,
    percent,
    percent_interval,
    plain_level,
    sentence,
    setting_text,
)
from fecolumn.study.report.pair import ComparedPair
from fecolumn.study.report.power import power
from fecolumn.study.report.sweep import Setting, Sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LINES, _PANELS, _ROWS = 7, 9, 40
_FOLD, _LONGEST = 20, 60
TARGET_NOTE = (
    f"{percent(CALIBRATION_TARGET)} is a calibration target, never a result: the "
    "specimen's size is not published, and height and "
    "cap are there to be chosen so that P(overturn) comes near it"
)


def distributions(sweep: Sweep, pairs: list[ComparedPair], gallery: Gallery) -> PageSection:
    """The section; figures go to the gallery's folder."""
    figures: list[Figure] = []
    for name, axis in _views(sweep):
        panels = _panels(sweep, axis)
        other = [axis_name(one) for one in sweep.varied if one != axis]
        what = (
            f"a line for each {axis_name(axis)}"
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
                + _left_out(sweep, axis, panels)
                + f". {'Lost' if sweep.slides else 'Overturned'} runs are censored: a "
                f"distribution ends at 1 − {sweep.p_lost}. {_bands(panels)}: pointwise "
                f"95 % bands (Greenwood){_seen(panels)}; in the legend {sweep.p_lost} "
                "with Wilson's 95 % interval.",
                cdf_figure,
                panels,
            )
        )
    blocks: list[PageBlock] = [Paragraph(_opening(sweep, figures[0].name)), *figures]
    blocks += _overturning(sweep, gallery)
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
            _comparisons(sweep, pairs),
        ]
    return PageSection("Distributions", blocks + _convergence(sweep, gallery))


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
        (axis for axis in sweep.varied if len(sweep.axes[axis]) <= _LINES and sweep.lines(axis)),
        key=lambda axis: -len(sweep.axes[axis]),
    )
    return [(f"cdf_by_{axis.split('.')[-1]}", axis) for axis in axes[:3]] or [("cdf", None)]


def _median(u_max: NDArray[Any], overturned: NDArray[Any]) -> float:
    return percentile(u_max, overturned, 0.5)


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
        labels = _labels(sweep)
        return [
            CdfPanel(
                "", tuple((labels[id(one)], ecdf(*one.peaks())) for one in chosen), sweep.p_lost
            )
        ]
    groups: dict[str, list[Setting]] = {}
    for setting in sorted(
        sweep.done,
        key=lambda one: [sweep.axes[key].index(value) for key, value in one.values.items()],
    ):
        title = _in_figure(
            {
                key: value
                for key, value in setting.values.items()
                if key != axis and key in sweep.varied
            }
        )
        groups.setdefault(title, []).append(setting)
    panels = [
        CdfPanel(
            title,
            tuple((axis_text(axis, one.values[axis]), ecdf(*one.peaks())) for one in group),
            sweep.p_lost,
        )
        for title, group in groups.items()
    ]
    return panels[:_PANELS]


def _labels(sweep: Sweep) -> dict[int, str]:
    """What every setting is called in figures, by its identity: its values, or its number where
    these would be too long.
    """
    texts = [
        _in_figure({axis: one.values[axis] for axis in sweep.varied}) or "all analyses"
        for one in sweep.settings
    ]
    if _long(texts):
        texts = [f"setting {number}" for number in range(1, len(texts) + 1)]
    return {id(one): text for one, text in zip(sweep.settings, texts)}


def _long(texts: list[str]) -> bool:
    return max(map(len, texts)) > _LONGEST


def _in_figure(values: dict[str, Any]) -> str:
    return ", ".join(axis_text(key, value) for key, value in values.items())


def _left_out(sweep: Sweep, axis: str | None, panels: list[CdfPanel]) -> str:
    drawn, there = sum(len(panel.lines) for panel in panels), len(sweep.done)
    return f" ({drawn} of {there} settings)" if drawn < there else ""


def _opening(sweep: Sweep, figure: str) -> str:
    u, over = sweep.reference.peaks()
    fallen = sweep.reference.column("overturned")
    low, high = proportion_interval(int(fallen.sum()), fallen.size)
    median = percentile(u, over, 0.5)
    half = (
        " mm"
        if np.isfinite(median)
        else f" (half or more {'are lost' if fallen.sum() < over.sum() else 'overturn'})"
    )
    return (
        f"[[{figure}]] shows the distribution of the largest displacement of "
        f"{sweep.subject.top}, u_max, in every setting. "
        f"{sentence(sweep.at(sweep.reference.values))} half of the "
        f"{count(over.size, 'motion')} stay below "
        f"{millimetres(median)}{half}, and "
        f"{int(fallen.sum())} overturn: P(overturn) = {percent(fallen.mean())}, 95 % "
        f"interval {interval(low, high, percent)}."
    )


def _overturning(sweep: Sweep, gallery: Gallery) -> list[PageBlock]:
    rows, estimates, labels = [], [], _labels(sweep)
    off = any(run.get("slid_off") for setting in sweep.settings for run in setting.runs.values())
    for number, setting in enumerate(sweep.settings, 1):
        levels = (number, *(setting.values[axis] for axis in sweep.varied))
        if not setting.runs:
            rows.append(
                (
                    *levels,
                    setting.planned,
                    0,
                    *([None] if off else []),
                    None,
                    None,
                    None,
                    None,
                    None,
                    None,
                    None,
                    None,
                    None,
                )
            )
            continue
        u, over = setting.peaks()
        k, n = int(setting.column("overturned").sum()), over.size
        wilson, exact = proportion_interval(k, n), proportion_interval(k, n, method="exact")
        slid = [int(over.sum()) - k] if off else []
        rows.append(
            (
                *levels,
                setting.planned,
                n,
                k,
                *slid,
                k / n,
                *wilson,
                *exact,
                *(percentile(u, over, share) for share in (0.16, 0.5, 0.84)),
            )
        )
        estimates.append(
            IntervalRow(labels[id(setting)], 100 * k / n, 100 * wilson[0], 100 * wilson[1])
        )
    table = PageTable(
        "p_overturn",
        (
            PageColumn("setting", "setting"),
            *axis_columns(sweep.varied),
            PageColumn("planned", "planned"),
            PageColumn("n", "run"),
            PageColumn("overturned", "over\N{SOFT HYPHEN}turned", _whole),
            *((PageColumn("slid_off", "slid off", _whole),) if off else ()),
            PageColumn(
                "p_overturn",
                "P(overturn) [%]",
                lambda share: fixed(None if share is None else 100 * share, 1),
            ),
            PageColumn("wilson_low wilson_high", "Wilson [%]", percent_interval),
            PageColumn("exact_low exact_high", "exact [%]", percent_interval),
            PageColumn("u_max_16_m", "u₁₆ [mm]", millimetres),
            PageColumn("u_max_50_m", "u₅₀ [mm]", millimetres),
            PageColumn("u_max_84_m", "u₈₄ [mm]", millimetres),
        ),
        rows,
        "P(overturn) of every setting with 95 % intervals (Wilson; exact: Clopper and "
        "Pearson), and percentiles of u_max; “overturn” "
        "where that share of the runs does not stand."
        + (
            " Columns that slid off their base are lost, too: distributions and percentiles, here "
            "and in what follows, take them with those that overturned; P(overturn) does not."
            if off
            else ""
        )
        + (f" {TARGET_NOTE}." if gallery.paper else ""),
        folded=len(rows) > _ROWS,
    )
    if not 2 <= len(estimates) <= _ROWS:
        return [table]
    scale = Scale(
        r"$P$(overturn) [%], 95 % interval (Wilson)",
        (0, None),
        *((100 * CALIBRATION_TARGET, "calibration target 43.5 %") if gallery.paper else ()),
    )
    caption = "Probability of overturning in every setting." + (
        f" Dashed: {TARGET_NOTE}." if gallery.paper else ""
    )
    return [gallery.draw("overturning", caption, interval_figure, [(scale, estimates)]), table]


def axis_columns(axes: Iterable[str]) -> tuple[PageColumn, ...]:
    """Columns of the levels of axes."""
    return tuple(
        PageColumn(
            axis, axis_name(axis) + (f" [{unit}]" if (unit := _unit(axis)) else ""), plain_level
        )
        for axis in axes
    )


def _unit(axis: str) -> str:
    from fecolumn.pictures.figures.axis_text import axis_unit

    return "" if axis_unit(axis) == "-" else axis_unit(axis)


def _levels(axis: str, low: object, high: object) -> str:
    return f"{axis_name(axis)}: {level_text(axis, low)}, {level_text(axis, high)}"


def setting_words(values: dict[str, Any]) -> str:
    """Values of the other axes, nothing where there are none."""
    return setting_text(values) if values else ""


def _whole(value: int | None) -> str:
    return "\N{EM DASH}" if value is None else str(value)


def _comparisons(sweep: Sweep, pairs: list[ComparedPair]) -> PageTable:
    rows = []
    for pair in pairs:
        it = pair.comparison
        rows.append(
            (
                pair.axis,
                pair.low,
                pair.high,
                {key: value for key, value in pair.others.items() if key in sweep.varied},
                it.n_a,
                it.ks,
                it.ks_p,
                it.ks_evidence,
                it.paired_p,
                pair.p_holm,
                it.ad_p,
                it.cvm_p,
                it.e50,
                it.correlation,
                it.flips,
                it.mcnemar_p,
                pair.bound,
            )
        )
    columns = (
        PageColumn("axis a b", "a against b", _levels, text=True),
        PageColumn("at", "at", setting_words, text=True),
        PageColumn("n", "n"),
        PageColumn("ks", "D", fixed),
        PageColumn("ks_p", "p", p_value),
        PageColumn("ks_evidence", "evidence", text=True),
        PageColumn("paired_p", "paired p", p_value),
        PageColumn("p_holm", "p (Holm)", p_value),
        PageColumn("ad_p", "AD p", p_value),
        PageColumn("cvm_p", "CvM p", p_value),
        PageColumn("e50", "e₅₀", fixed),
        PageColumn("correlation", "R", fixed),
        PageColumn("flips", "flips"),
        PageColumn("mcnemar_p", "McNemar p", p_value),
        PageColumn("bound_95", "D not excluded", fixed),
    )
    return PageTable(
        "comparisons",
        columns,
        rows,
        "Settings compared in pairs: Kolmogorov-Smirnov distance D with p of "
        "independent samples and "
        "the field's word for the evidence against one distribution; p of paired permutations; "
        "Anderson-Darling and Cramér-von Mises as independent samples; error of the median e₅₀ (a "
        "against b); correlation R with lost runs (overturned or slid off) at the "
        "limit; motions lost in one "
        "setting alone (flips) with McNemar's p.",
        folded=len(rows) > _FOLD,
    )


def _convergence(sweep: Sweep, gallery: Gallery) -> list[PageBlock]:
    """How many motions the reference setting's distribution needs."""
    u, over = sweep.reference.peaks()
    if u.size < 10:
        return []
    sizes = np.unique(np.round(np.geomspace(3, u.size, 24)).astype(int))
    found = cdf_convergence(u, over, sizes)
    curves = [
        Curve("drawn from the ensemble, median", sizes, found.median),
        Curve("drawn from the ensemble, 95 %", sizes, found.upper_95),
        Curve("bound to the true CDF, 95 % (DKW)", sizes, found.dkw_95),
    ]
    panels = [
        CurvePanel(
            "motions $n$",
            r"largest distance of two CDFs",
            curves,
            {"xscale": "log", "ylim": (0, 1)},
            prepare=_plain_ticks,
        )
    ]
    last = float(found.dkw_95[-1])
    return [
        gallery.draw(
            "convergence",
            f"Distance of the CDF of n motions from that of all {u.size}, "
            f"{sweep.at(sweep.reference.values)}. It vanishes at n = {u.size} by construction; the "
            "distance to the distribution of all motions there could be stays below the DKW bound, "
            f"{fixed(last)} for {u.size} motions, at 95 %.",
            line_figure,
            panels,
        )
    ]


def _plain_ticks(axes: Axes) -> None:
    low, high = axes.get_xlim()
    ticks = [tick for tick in (3, 5, 10, 20, 50, 100, 200, 500, 1000) if low <= tick <= high]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
