"""Outcomes over PGA and PGV/PGA, measured and computed, with the line where overturning is as
likely as not.
"""

from __future__ import annotations

import numpy as np

from benchmarks.shake_table.probability import Class
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)
from fecolumn.statistics.binary_regression import DegenerateData, fit_binary


def boundary(pga, pgv_pga, overturned, at) -> np.ndarray | None:
    """PGA (m,) [g] at which P(overturn) is one half at values `at` (m,) [s] of PGV/PGA, by logit
    regression on both logarithms; None where there is none.
    """
    x = np.column_stack([np.ones(len(pga)), np.log(pga), np.log(pgv_pga)])
    try:
        c = fit_binary(x, np.asarray(overturned, bool), "logit")[0].params
    except DegenerateData:
        return None
    return np.exp(-(c[0] + c[2] * np.log(at)) / c[1])


def draw(rows: list[dict], path):
    """Panels: what the specimen did, what was computed with the tests told wrongly; rows with
    numbers of `runs.COLUMNS`. PNG and PDF.
    """
    pga, ratio, measured, computed = (
        np.array([row[name] for row in rows], float)
        for name in ("pga_g", "pgv_pga_s", "measured", "computed")
    )
    measured, computed = measured == 1, computed == 1
    at = np.geomspace(ratio.min(), ratio.max(), 100)
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 3.2)
        left, right = figure.subplots(1, 2, sharex=True, sharey=True)
        for axes, told, title in (
            (left, measured, f"measured: {measured.sum()} of {len(rows)} overturned"),
            (right, computed, f"computed: {computed.sum()}"),
        ):
            axes.loglog(
                ratio[~told],
                pga[~told],
                "o",
                fillstyle="none",
                color=GREY,
                markersize=3,
                markeredgewidth=0.7,
                label="stood",
            )
            axes.loglog(
                ratio[told],
                pga[told],
                "x",
                color=VERMILION,
                markersize=3.5,
                markeredgewidth=0.8,
                label="overturned",
            )
            for outcomes, colour, dashes, words in (
                (measured, BLACK, "--", "measured, $P$ = 0.5"),
                (computed, BLUE, "-", "computed, $P$ = 0.5"),
            ):
                if (line := boundary(pga, ratio, outcomes, at)) is not None:
                    axes.loglog(at, line, color=colour, linestyle=dashes, label=words)
            axes.set(title=title, xlabel="PGV/PGA [s]", ylim=(0.8 * pga.min(), 1.25 * pga.max()))
        wrong = measured != computed
        right.loglog(
            ratio[wrong],
            pga[wrong],
            "o",
            fillstyle="none",
            color=BLACK,
            markersize=6,
            markeredgewidth=0.5,
            label="told wrongly",
        )
        left.set_ylabel("PGA [g]")
        right.legend(loc="lower left")
        return save(figure, path)


def draw_reliability(classes: list[Class], path):
    """Share of tests that overturned over the probability told, with intervals of 95 %, and how
    many tests are in each class of `probability.reliability`. PNG and PDF.
    """
    means = np.array([one.told for one in classes])
    shares = np.array([one.share for one in classes])
    ends = np.array([one.interval for one in classes])
    with styled():
        figure = new_figure(PAGE_WIDTH_IN / 2, 3.6)
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        upper.plot([0, 1], [0, 1], color=GREY, linewidth=0.8, label="told rightly")
        upper.errorbar(
            means,
            shares,
            np.abs(ends.T - shares),
            fmt="o",
            color=BLUE,
            capsize=2,
            markersize=4,
            label="tests, 95 % interval",
        )
        upper.set(ylabel="share that overturned [-]", ylim=(-0.03, 1.03))
        upper.legend(loc="upper left")
        lows, highs = (np.array([getattr(one, end) for one in classes]) for end in ("low", "high"))
        counts = [one.n for one in classes]
        lower.bar(lows, counts, highs - lows, align="edge", color=BLUE, edgecolor="white")
        lower.set(xlabel="told P(overturn) [-]", ylabel="tests", yscale="log")
        return save(figure, path)
