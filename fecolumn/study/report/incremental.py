"""Section: incremental dynamic analysis, where a study scales the same motions to several
levels.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.incremental_figure import incremental_figure
from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.statistics.fragility import DegenerateData, Fragility
from fecolumn.statistics.incremental import IncrementalCurve, first_overturning, incremental_curves
from fecolumn.statistics.records import counted_unit, run_count
from fecolumn.study.report.document import PageBlock, PageColumn, PageSection, PageTable, Paragraph
from fecolumn.study.report.fragility import LABEL, curve_axis
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.intensity import (
    NOT_FOUND,
    SCALE,
    Intensities,
    Runs,
    across_scales,
    without_intensity,
)
from fecolumn.study.report.notation import axis_name, count, fixed, interval, millimetres
from fecolumn.study.report.setting_columns import axis_columns
from fecolumn.study.report.sweep import Sweep

_LEAST_SCALES, _LEAST_MOTIONS, _FOLD = 3, 3, 20


@dataclass(frozen=True, slots=True)
class ScaledSetting:
    """A setting but for the scale: its values, the curves of its motions, their records, and the
    law of the first overturning (None where there is none).
    """

    values: dict[str, Any]
    curves: list[IncrementalCurve]
    records: list[str]
    fit: Fragility | None


def incremental(sweep: Sweep, gallery: Gallery, intensities: Intensities) -> PageSection | None:
    """The section; None where motions are not at three scales or more, or not to be found."""
    if SCALE not in sweep.varied:
        return None
    groups = across_scales(sweep.done)
    try:
        of_groups = [intensities.of_runs(settings) for _, settings in groups]
    except NOT_FOUND:
        return None
    found = [one for (values, _), runs in zip(groups, of_groups) if (one := _scaled(values, runs))]
    own = {key: value for key, value in sweep.reference.values.items() if key != SCALE}
    here = next((one for one in found if one.values == own), found[0] if found else None)
    if here is None:
        return None
    at = sweep.at(here.values)
    blocks: list[PageBlock] = []
    once = counted_unit(len(here.curves), len(set(here.records))).removesuffix("s")
    again = sum(curve.stands_again for curve in here.curves)
    fallen = sum(np.isfinite(curve.first[1]) for curve in here.curves)
    levels = max(len(curve.im) for curve in here.curves)
    text = (
        f"[[ida]]: each of {run_count(len(here.curves), here.records, 'motion')} scaled to "
        f"{count(levels, 'level')} (Vamvatsikos and Cornell 2002), {at}. "
        f"{fallen} overturn the {sweep.subject.noun} at one of their scales"
        f"{', or let it slide off, which counts as overturned here' if sweep.slides else ''}. "
    )
    if here.fit:
        text += (
            "Half of the motions have overturned it by a PGV of "
            f"{_speed(here.fit.median)} m/s "
            f"{interval(*here.fit.median_interval(), _speed)}, "
            f"with a logarithmic standard deviation of {fixed(here.fit.beta)} "
            f"{interval(*here.fit.beta_interval())}. Each {once} counts once, by the "
            "intensities between which it "
            f"first overturns the {sweep.subject.noun}; those that never do count as "
            "beyond their largest. "
        )
    text += (
        f"With {count(again, 'motion')} the {sweep.subject.noun} stands again at a "
        "larger scale: to have overturned by an intensity is then more probable "
        "than to overturn at it, which the fragility below tells."
        if again
        else f"No motion lets the {sweep.subject.noun} stand again at a larger scale."
    )
    text = f"{text} {without_intensity(sweep.done, of_groups)}".rstrip()
    blocks.append(
        Paragraph(f"{text} [[first_overturnings]] has all settings, [[ida_motions]] every motion.")
    )
    blocks.append(
        gallery.draw(
            "ida",
            f"Incremental dynamic analysis {at}: peak displacement of the top over the "
            "intensity, a thin line a motion, "
            "and the 16, 50 and 84 % fractiles over the motions, as far as all motions "
            "are known. A line that turns level and ends in a mark: overturned.",
            incremental_figure,
            here.curves,
            LABEL,
            _critical(sweep),
        )
    )
    if here.fit:
        panels, caption = _panels(sweep, here, here.fit, found)
        blocks.append(gallery.draw("first_overturning", caption, line_figure, panels))
    return PageSection(
        "Incremental dynamic analysis", [*blocks, _table(sweep, found), _motions(sweep, found)]
    )


def _scaled(values: dict[str, Any], runs: Runs) -> ScaledSetting | None:
    """A motion at scales below 0 is another motion of its record."""
    motions = [
        name.strip("[]'\"") + (", reversed" if turned else "")
        for name, turned in zip(runs.motion.tolist(), runs.reversed)
    ]
    curves = incremental_curves(motions, runs.measures[:, 0], runs.u_max, runs.lost)
    own = dict(zip(motions, runs.record.tolist()))
    records = [own[curve.motion] for curve in curves]
    if (
        len(set(records)) < _LEAST_MOTIONS
        or np.median([len(curve.im) for curve in curves]) < _LEAST_SCALES
    ):
        return None
    try:
        lower, upper = np.transpose([curve.first for curve in curves])
        fit = first_overturning(lower, upper, records)
    except DegenerateData:
        fit = None
    return ScaledSetting(values, curves, records, fit)


def _critical(sweep: Sweep) -> float | None:
    """Displacement of the top at which the column stands over its rim [m], where all analyses state
    one.
    """
    stated = {run.get("u_critical_m") for setting in sweep.done for run in setting.runs.values()}
    return stated.pop() if len(stated) == 1 else None


def _panels(
    sweep: Sweep, here: ScaledSetting, fit: Fragility, found: list[ScaledSetting]
) -> tuple[list[CurvePanel], str]:
    """The law of one setting beside what is known of its motions, and the laws of several
    settings.
    """
    lower, upper = np.transpose([curve.first for curve in here.curves])
    end = 1.05 * max(float(curve.im[-1]) for one in found for curve in one.curves)
    grid, share = np.linspace(1e-3 * end, end, 300), np.arange(lower.size + 1) / lower.size
    p = fit.probability(grid)

    def steps(name: str, bounds: NDArray[Any]) -> Curve:
        known = np.sort(bounds[np.isfinite(bounds)])
        return Curve(
            name,
            np.concatenate([[0.0], known, [end]]),
            np.append(share[: known.size + 1], share[known.size]),
            steps=True,
        )

    settings = {"ylim": (0, 1), "xlim": (0, end)}
    panels = [
        CurvePanel(
            LABEL,
            "share of motions\nthat have overturned",
            [
                Curve("lognormal, intervals as known", grid, p.p, (p.lower, p.upper)),
                steps("scale that overturns", upper),
                steps("largest scale below it", np.where(np.isinf(upper), np.inf, lower)),
            ],
            settings,
            legend="upper left",
        )
    ]
    caption = (
        f"Share of motions that have overturned the {sweep.subject.noun} by an "
        f"intensity {sweep.at(here.values)}, with the 95 % band over the motions. "
        "Steps: "
        "the two ends of what is known of each motion."
    )
    if axis := curve_axis(sweep, [one.values for one in found if one.fit]):
        line = [
            one
            for one in found
            if one.fit
            and all(one.values[key] == value for key, value in here.values.items() if key != axis)
        ]
        curves = [
            Curve(axis_text(axis, one.values[axis]), grid, q.p, (q.lower, q.upper))
            for one in line
            if one.fit
            for q in [one.fit.probability(grid)]
        ]
        panels.append(CurvePanel(LABEL, "", curves, settings, legend="upper left"))
        caption += (
            f" Right: for each {axis_name(axis)}; bands as bars, of each curve at places of "
            "its own, where there are more than two."
        )
    return panels, caption


def _table(sweep: Sweep, found: list[ScaledSetting]) -> PageTable:
    axes = [axis for axis in sweep.varied if axis != SCALE]
    shared = any(len(set(one.records)) < len(one.curves) for one in found)
    columns = (
        *axis_columns(axes),
        PageColumn("motions", "motions"),
        *((PageColumn("records", "records"),) if shared else ()),
        PageColumn("runs", "runs"),
        PageColumn("overturned", "motions that overturn"),
        PageColumn("stands_again", "that let stand again"),
        PageColumn("median_pgv_m_s", "median PGV [m/s]", _speed),
        PageColumn("median_low median_high", "95 %", lambda low, high: interval(low, high, _speed)),
        PageColumn("beta", "β", fixed),
        PageColumn("beta_low beta_high", "95 %", interval),
    )
    rows = []
    for one in found:
        law = (
            [None] * 6
            if one.fit is None
            else [
                one.fit.median,
                *one.fit.median_interval(),
                one.fit.beta,
                *one.fit.beta_interval(),
            ]
        )
        rows.append(
            (
                *(one.values[axis] for axis in axes),
                len(one.curves),
                *((len(set(one.records)),) if shared else ()),
                sum(len(curve.im) for curve in one.curves),
                sum(bool(np.isfinite(curve.first[1])) for curve in one.curves),
                sum(curve.stands_again for curve in one.curves),
                *law,
            )
        )
    return PageTable(
        "first_overturnings",
        columns,
        rows,
        "PGV by which half of the motions have overturned the "
        f"{sweep.subject.noun}{', or let it slide off' if sweep.slides else ''}, and "
        "logarithmic standard deviation β of that PGV over the motions: "
        "lognormal, maximum likelihood of the intervals known, 95 % intervals over the "
        "motions. A dash: the motions do not bound the law.",
        folded=len(rows) > _FOLD,
    )


def _motions(sweep: Sweep, found: list[ScaledSetting]) -> PageTable:
    axes = [axis for axis in sweep.varied if axis != SCALE]
    columns = (
        *axis_columns(axes),
        PageColumn("motion", "motion", text=True),
        PageColumn("scales", "scales"),
        PageColumn("pgv_stood_m_s", "last PGV that stands [m/s]", _speed),
        PageColumn("u_max_m", "u_max there [mm]", millimetres),
        PageColumn("pgv_overturned_m_s", "first PGV that overturns [m/s]", _speed),
        PageColumn("stands_again", "stands again", lambda again: "yes" if again else ""),
    )
    rows = []
    for one in found:
        for curve in one.curves:
            stood, fallen = curve.first
            u = float(curve.u_max[np.searchsorted(curve.im, stood)]) if stood else None
            rows.append(
                (
                    *(one.values[axis] for axis in axes),
                    curve.motion,
                    len(curve.im),
                    stood or None,
                    u,
                    fallen if np.isfinite(fallen) else None,
                    curve.stands_again,
                )
            )
    return PageTable(
        "ida_motions",
        columns,
        rows,
        "Every motion: the largest PGV below its first overturning, and that of the "
        "first overturning"
        f"{', or sliding off' if sweep.slides else ''}; a dash where there is none.",
        folded=True,
    )


def _speed(value: float | None) -> str:
    return fixed(value, 3)
