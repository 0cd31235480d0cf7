"""Section: models beside each other, where a study runs the same motions through several engines.

An engine that is dear may have done fewer motions than the others: it is then measured on those
that it has, and its number stands beside it.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.case.sections import MODEL_ENGINES
from fecolumn.motions.ensemble_file import file_and_number
from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.cdf_figure import CdfPanel, cdf_figure
from fecolumn.statistics.ecdf import censored, percentile
from fecolumn.statistics.equivalence import distance_bound
from fecolumn.statistics.two_sample import paired_kolmogorov_smirnov
from fecolumn.study.report.document import PageBlock, PageColumn, PageSection, PageTable, Paragraph
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import count, interval, millimetres, number, p_value, percent
from fecolumn.study.report.setting_columns import axis_columns
from fecolumn.study.report.sweep import ENGINE_KEY, Setting, Sweep, common_motions

#: What the others are measured against: the first of these with the most motions that one of them
#: has.
NEAREST = ("full", "reduced", "rigid")
_NAMES = {
    "full": "finite elements, full order",
    "reduced": "finite elements, reduced",
    "rigid": "rigid body with contact",
    "housner": "planar block (Housner)",
    "wobbling": "wobbling body",
    "rocking_frame": "rocking frame",
    "wobbling_frame": "wobbling frame",
    "podium": "rocking podium",
}
_ALL = "all"
_PANELS, _MOST = 6, 12


def models(sweep: Sweep, gallery: Gallery) -> PageSection | None:
    """The section; None where the study has one engine, or no two of them on common motions."""
    lines = _lines(sweep) if ENGINE_KEY in sweep.varied else []
    if not lines:
        return None
    others = [axis for axis in sweep.varied if axis != ENGINE_KEY]
    ensembles = _ensembles(lines)
    fewer = {
        name: sorted(
            {
                len(line.common(one))
                for line in lines
                for one in line.settings
                if one.values[ENGINE_KEY] == name
            }
        )
        for line in lines
        for name in line.fewer
    }
    rows = [
        row
        for line in lines
        for name, some in ensembles.items()
        for row in _rows(line, others, name if len(ensembles) > 1 else "", some, bool(fewer))
    ]
    nearest = {line.reference.values[ENGINE_KEY] for line in lines}
    references = " or ".join(_NAMES[one] for one in NEAREST if one in nearest)
    found = {one.values[ENGINE_KEY] for line in lines for one in line.settings}
    motions_text = (
        f"{_span(len(line.reference.runs) for line in lines)} motions{_exceptions(fewer)}"
    )
    text = (
        f"{count(len(found), 'engine')} ran through the same {motions_text}. "
        f"[[models]] sets their distributions beside each other, [[engines]] "
        f"measures each against {references}: D is the largest distance of the two "
        "distributions, p the probability of as large a one if the engine "
        "did not matter (engines swapped within motions). Common motions make D "
        "smaller than chance between two samples of motions would: a D that is not "
        "significant says that these motions do not tell the engines apart, and “not "
        "excluded” up to which distance they leave open. "
        "The share of motions with the same outcome says how far one may be taken for "
        "the other in a single motion."
    )
    blocks: list[PageBlock] = [Paragraph(text)]
    if found & set(MODEL_ENGINES):
        blocks.append(
            Paragraph(
                "Rocking models of rigid bodies do not slide, and know nothing of the "
                "time step but the sampling of the motion; α has no effect on them."
            )
        )
    chosen = [
        (line, name, some)
        for line in lines
        for name, some in ensembles.items()
        if (name != _ALL or len(ensembles) == 1) and _of(line.reference.runs, some)
    ]
    panels = [
        CdfPanel(
            ", ".join(
                [
                    *([name] if name != _ALL else []),
                    *(axis_text(axis, value) for axis, value in line.others.items()),
                ]
            ),
            tuple(
                (_label(line, one, len(motions)), one.distribution(motions))
                for one in line.settings
                if (motions := _of(line.common(one), some))
            ),
            sweep.p_lost,
        )
        for line, name, some in chosen[:_PANELS]
    ]
    left_out = (
        f" {len(chosen) - _PANELS} more panels are in [[engines]]." if len(chosen) > _PANELS else ""
    )
    blocks.append(
        gallery.draw(
            "models",
            f"Distributions of u_max by engine, on the same {motions_text}.{left_out}",
            cdf_figure,
            panels,
        )
    )
    named = (PageColumn("ensemble", "motions of", text=True),) if len(ensembles) > 1 else ()
    columns = (
        *axis_columns(others),
        *named,
        PageColumn("engine", "engine", lambda one: str(_NAMES.get(one, one)), text=True),
        PageColumn("n", "n"),
        PageColumn("overturned", "over\N{SOFT HYPHEN}turned"),
        PageColumn("p_overturn", "P(overturn)", percent),
        PageColumn("p_low p_high", "95 % interval", lambda low, high: interval(low, high, percent)),
        PageColumn("u50_m", "u₅₀ [mm]", millimetres),
        PageColumn("e50", "e₅₀", number),
        PageColumn("distance", "D", number),
        PageColumn("p", "p", p_value),
        PageColumn("not_excluded", "not excluded", number),
        PageColumn("same_outcome", "same outcome", percent),
        *(
            (
                PageColumn(
                    "reference_overturned",
                    f"{references}: over\N{SOFT HYPHEN}turned of the same",
                    number,
                ),
            )
            if fewer
            else ()
        ),
        PageColumn("cpu_s", "CPU an analysis [s]", number),
    )
    blocks.append(
        PageTable(
            "engines",
            columns,
            rows,
            "Engines on the same motions. e₅₀, the difference of the medians over that "
            "of the reference, D, p, the distance not excluded (at 95 %) and the share "
            f"of motions with the same outcome are to {references}"
            f"{', on the n motions of the line' if fewer else ''}. CPU: mean processor time "
            "of an analysis, without what is made or compiled once; wall time where an "
            "analysis did not record it.",
        )
    )
    return PageSection("Models beside each other", blocks)


@dataclass(frozen=True, slots=True)
class _Beside:
    """Engines that share all else, each on the motions that it has in common with the reference.

    Attributes
    ----------
    others
        values of the other axes.
    settings
        with at least one such motion.
    reference
        the engine nearest to the whole of those with most motions.
    fewer
        names of the engines that have not all of its motions.
    """

    others: dict[str, Any]
    settings: tuple[Setting, ...]
    reference: Setting

    def common(self, setting: Setting) -> list[str]:
        return common_motions((self.reference, setting))

    @property
    def fewer(self) -> list[str]:
        return [
            one.values[ENGINE_KEY]
            for one in self.settings
            if len(self.common(one)) < len(self.reference.runs)
        ]


def _lines(sweep: Sweep) -> list[_Beside]:
    found = []
    for others, settings in sweep.groups(ENGINE_KEY):
        known = [one for name in NEAREST for one in settings if one.values[ENGINE_KEY] == name]
        if not known:  # models alone
            continue
        reference = max(known, key=lambda one: len(one.runs))
        there = tuple(one for one in settings if common_motions((reference, one)))
        if len(there) > 1:
            found.append(_Beside(others, there, reference))
    return found


def _span(numbers: Iterable[int]) -> str:
    found = sorted(set(numbers))
    return str(found[0]) if len(found) == 1 else f"{found[0]} to {found[-1]}"


def _exceptions(fewer: dict[str, list[int]]) -> str:
    """What is said of engines that have fewer motions, by their names."""
    spans = (
        f"{_NAMES.get(name, name)}: {_span(numbers)} of them" for name, numbers in fewer.items()
    )
    return f" ({', '.join(spans)})" if fewer else ""


def _label(line: _Beside, setting: Setting, motions: int) -> str:
    name: str = setting.values[ENGINE_KEY]
    return _NAMES.get(name, name) + (f", n = {motions}" if name in line.fewer else "")


def _ensembles(lines: list[_Beside]) -> dict[str, set[str] | None]:
    """Motions by the ensemble file that they are of, _ALL of them first; _ALL alone where the study
    has no two such files, or motions of none.
    """
    found: dict[str, set[str]] = {}
    for motion in (motion for line in lines for motion in line.reference.runs):
        member = next(
            (
                place
                for value in ast.literal_eval(motion)
                if isinstance(value, str) and (place := file_and_number(value))
            ),
            None,
        )
        if member is None:
            return {_ALL: None}
        found.setdefault(Path(member[0]).stem, set()).add(motion)
    return {_ALL: None, **(found if 1 < len(found) <= _MOST else {})}


def _of(motions: Iterable[str], some: set[str] | None) -> list[str]:
    """The motions that are among some, all for None."""
    return [motion for motion in motions if some is None or motion in some]


def _rows(
    line: _Beside, others: list[str], ensemble: str, some: set[str] | None, any_fewer: bool
) -> Iterator[tuple[Any, ...]]:
    for setting in line.settings:
        motions = _of(line.common(setting), some)
        if not motions:
            continue
        (u, lost), (base, base_lost) = setting.peaks(motions), line.reference.peaks(motions)
        fallen, base_fallen = (
            one.column("overturned", motions).astype(bool) for one in (setting, line.reference)
        )
        beside: list[float | None] = [None] * (5 + any_fewer)
        if setting is not line.reference:
            records = setting.records_of(motions)
            test = paired_kolmogorov_smirnov(
                censored(u, lost), censored(base, base_lost), records=records
            )
            medians = [percentile(*one, fraction=0.5) for one in ((u, lost), (base, base_lost))]
            e50 = abs(medians[0] - medians[1]) / medians[1] if np.isfinite(medians).all() else None
            beside = [
                e50,
                float(test.statistic),
                float(test.p),
                distance_bound(u, lost, base, base_lost, records=records)[1],
                float((lost == base_lost).mean()),
            ] + [int(base_fallen.sum())] * any_fewer
        yield (
            *(setting.values[axis] for axis in others),
            *([ensemble] if ensemble else []),
            setting.values[ENGINE_KEY],
            len(motions),
            int(fallen.sum()),
            float(fallen.mean()),
            *setting.overturning(motions),
            percentile(u, lost, fraction=0.5),
            *beside,
            _cost(setting, motions),
        )


def _cost(setting: Setting, motions: list[str]) -> float | None:
    """Mean processor time [s]; wall time of a run that did not record it."""
    times = setting.column("cpu_s", motions)
    times = np.where(np.isnan(times), setting.column("wall_s", motions), times)
    return float(np.nanmean(times)) if np.isfinite(times).any() else None
