"""Section: probability of overturning over the intensity of the motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.statistics.fragility import DegenerateData, Fragility, logit, lognormal
from fecolumn.study.report.document import PageColumn, PageSection, PageTable, Paragraph
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.intensity import (
    NOT_FOUND,
    SCALE,
    Intensities,
    Runs,
    across_scales,
    without_intensity,
)
from fecolumn.study.report.notation import (
    axis_name,
    count,
    fixed,
    interval,
    p_clause,
    p_value,
    sentence,
)
from fecolumn.study.report.observed_shares import observed_shares, share_groups
from fecolumn.study.report.setting_columns import axis_columns
from fecolumn.study.report.sweep import Sweep

LABEL = "PGV, RotD50 [m/s]"
_FEWEST, _FOLD, _CURVES = 20, 20, 7


@dataclass(frozen=True, slots=True)
class FittedSetting:
    """A setting over all scales of its motions: its values but the scale, its runs, and its
    fragility (None where it has none).
    """

    values: dict[str, Any]
    runs: Runs
    fit: Fragility | None


def fragility(sweep: Sweep, gallery: Gallery, intensities: Intensities) -> PageSection | None:
    """The section; None where the motions are not to be found, are few, or do not tell overturning
    from standing.
    """
    groups = [
        (values, settings)
        for values, settings in across_scales(sweep.done)
        if sum(len(setting.runs) for setting in settings) >= _FEWEST
    ]
    try:
        of_groups = [intensities.of_runs(settings) for _, settings in groups]
    except NOT_FOUND:
        return None
    found = [
        FittedSetting(values, runs, _fit(runs)) for (values, _), runs in zip(groups, of_groups)
    ]
    left = without_intensity([one for _, settings in groups for one in settings], of_groups)
    own = {key: value for key, value in sweep.reference.values.items() if key != SCALE}
    here = next((one for one in found if one.values == own and one.fit), None)
    if here is None or here.fit is None:
        return None
    fit, records = here.fit, here.fit.clusters or here.fit.n
    panels = [
        CurvePanel(
            LABEL,
            r"$P$(overturn)",
            _curves(here.runs, fit),
            {"ylim": (0, 1), "xlim": (0, None)},
            legend="upper left",
        )
    ]
    caption = (
        f"Fragility {sweep.at(own)}, with its 95 % band, and the shares observed in "
        f"{count(share_groups(fit.n), 'group')} of runs of equal number, with Wilson's "
        "95 % interval of independent runs."
    )
    if axis := curve_axis(sweep, [one.values for one in found if one.fit]):
        panels.append(
            CurvePanel(
                LABEL,
                r"$P$(overturn)",
                settings_curves(axis, own, found),
                {"ylim": (0, 1), "xlim": (0, None)},
                legend="upper left",
            )
        )
        caption += (
            f" Right: for each {axis_name(axis)}; bands as bars, of each curve at places of "
            "its own, where there are more than two."
        )
    low, high = fit.median_interval()
    median_text = (
        f"{sentence(sweep.at(own))} half of the {sweep.subject.noun}s overturn at "
        f"{_speed(fit.median)} m/s {interval(low, high, _speed)}, with a "
        "logarithmic "
        f"standard deviation of {fixed(fit.beta)}{_more(_second(here.runs))}. "
    )
    known = (
        f"The {count(fit.n, 'run')} are of {count(records, 'record')} at several "
        "scales or in several directions: intervals and bands count records and "
        "not runs (Liang and Zeger 1986). "
        if records < fit.n
        else ""
    )
    columns = (
        *axis_columns([axis for axis in sweep.varied if axis != SCALE]),
        PageColumn("n", "runs"),
        PageColumn("records", "records"),
        PageColumn("overturned", "over\N{SOFT HYPHEN}turned"),
        PageColumn("median_pgv_m_s", "median PGV [m/s]", _speed),
        PageColumn("median_low median_high", "95 %", lambda low, high: interval(low, high, _speed)),
        PageColumn("beta", "β", fixed),
        PageColumn("beta_low beta_high", "95 %", interval),
        PageColumn("pga_p", "p of PGA", p_value),
    )
    rows = [
        (
            *(one.values[axis] for axis in sweep.varied if axis != SCALE),
            one.runs.overturned.size,
            np.unique(one.runs.record).size,
            int(one.runs.overturned.sum()),
            *_row(one),
        )
        for one in found
    ]
    scaled = (
        "at all its scales"
        if SCALE in sweep.varied
        else "unscaled: far from its middle the curve is an extrapolation"
    )
    return PageSection(
        "Fragility",
        [
            Paragraph(
                "[[fragility]] and [[fragilities]]: probability of overturning over "
                "the peak ground velocity, lognormal, by maximum likelihood (Baker "
                f"2015), each run one yes or no. {median_text}{known}Intensities are those of "
                f"the ensemble as it stands, {scaled}. {left}".rstrip()
            ),
            gallery.draw("fragility", caption, line_figure, panels),
            PageTable(
                "fragilities",
                columns,
                rows,
                "Lognormal fragility of every setting: PGV at which half overturn, "
                "logarithmic standard deviation β, and p "
                "of the likelihood ratio that PGA beside PGV tells no more (logistic "
                "regression, runs taken as independent). "
                "A dash: the runs hold no maximum of the likelihood.",
                folded=len(rows) > _FOLD,
            ),
        ],
    )


def curve_axis(sweep: Sweep, values: list[dict[str, Any]]) -> str | None:
    """The axis whose levels are the curves of one figure: of those that vary among settings, but
    the scale, the one of most levels that fit.
    """
    levels = {
        axis: len({repr(one[axis]) for one in values}) for axis in sweep.varied if axis != SCALE
    }
    few = (axis for axis in levels if 1 < levels[axis] <= _CURVES)
    return max(few, key=levels.__getitem__, default=None)


def settings_curves(axis: str, own: dict[str, Any], found: list[FittedSetting]) -> list[Curve]:
    """A curve for each level of an axis, all else as in `own`."""
    line = [
        one
        for one in found
        if one.fit and all(one.values[key] == value for key, value in own.items() if key != axis)
    ]
    grid = _grid([one.runs.measures[:, 0] for one in line])
    return [
        Curve(axis_text(axis, one.values[axis]), grid, p.p, (p.lower, p.upper))
        for one in line
        if one.fit
        for p in [one.fit.probability(grid)]
    ]


def _grid(samples: Sequence[NDArray[Any]]) -> NDArray[Any]:
    return np.linspace(
        min(float(pgv.min()) for pgv in samples), max(float(pgv.max()) for pgv in samples), 200
    )


def _more(p: float | None) -> str:
    return (
        ""
        if p is None
        else "; the peak acceleration beside the velocity tells "
        f"{'' if p < 0.05 else 'no '}more ({p_clause(p)})"
    )


def _speed(value: float | None) -> str:
    return fixed(value, 3)


def _fit(runs: Runs) -> Fragility | None:
    try:
        return lognormal(runs.measures[:, 0], runs.overturned, runs.record)
    except DegenerateData:
        return None


def _row(one: FittedSetting) -> list[float | None]:
    """Median, beta, their intervals, and p of PGA; None where there is no fragility."""
    if one.fit is None:
        return [None] * 7
    return [
        one.fit.median,
        *one.fit.median_interval(),
        one.fit.beta,
        *one.fit.beta_interval(),
        _second(one.runs),
    ]


def _second(runs: Runs) -> float | None:
    """P of the likelihood ratio that PGA beside PGV tells no more; None where PGA goes with PGV, as
    of pulses of one shape.
    """
    from scipy.stats import chi2

    try:
        more = 2 * (
            logit(runs.measures, runs.overturned).loglik
            - logit(runs.measures[:, 0], runs.overturned).loglik
        )
    except DegenerateData:
        return None
    return float(chi2.sf(max(more, 0.0), 1))


def _curves(runs: Runs, fit: Fragility) -> list[Curve]:
    """The curve with its band, and shares in groups of equal number."""
    pgv, over = runs.measures[:, 0], runs.overturned
    grid = _grid([pgv])
    p = fit.probability(grid)
    return [
        Curve("lognormal, maximum likelihood", grid, p.p, (p.lower, p.upper)),
        observed_shares(pgv, over),
    ]
