"""Section: models beside each other, where a study runs the same motions through several engines."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np

from fecolumn.case import MODEL_ENGINES
from fecolumn.motions.ensemble_file import file_and_number
from fecolumn.post.axis_text import axis_text
from fecolumn.post.cdf_figure import Panel, cdf_figure
from fecolumn.report.distributions import axis_columns
from fecolumn.report.document import Column, Paragraph, Section, Table
from fecolumn.report.gallery import Gallery
from fecolumn.report.notation import count, interval, millimetres, number, p_value, percent
from fecolumn.report.sweep import Line, Setting, Sweep
from fecolumn.statistics.ecdf import censored, ecdf, percentile, proportion_interval
from fecolumn.statistics.two_sample import paired_kolmogorov_smirnov

ENGINE = "integration.engine"
#: What the others are measured against: the first of these that a study has.
NEAREST = ("full", "reduced", "rigid")
NAMES = {"full": "finite elements, full order", "reduced": "finite elements, reduced", "rigid": "rigid body with contact", "housner": "planar block (Housner)",
         "wobbling": "wobbling body", "rocking_frame": "rocking frame", "wobbling_frame": "wobbling frame", "podium": "rocking podium"}
ALL = "all"
_PANELS, _MOST = 6, 12


def models(sweep: Sweep, gallery: Gallery) -> Section | None:
    """The section; None where the study has one engine, or no two of them on common motions."""
    lines = [(line, _reference(line)) for line in sweep.lines(ENGINE)] if ENGINE in sweep.varied else []
    lines = [(line, reference) for line, reference in lines if reference]
    if not lines:
        return None
    others = [axis for axis in sweep.varied if axis != ENGINE]
    ensembles = _ensembles(lines)
    rows = [row for line, reference in lines for name, some in ensembles.items() for row in _rows(line, reference, others, name if len(ensembles) > 1 else "", some)]
    nearest = {reference.values[ENGINE] for _, reference in lines}
    told = " or ".join(NAMES[one] for one in NEAREST if one in nearest)
    motions = sorted({len(line.motions()) for line, _ in lines})
    span = str(motions[0]) if len(motions) == 1 else f"{motions[0]} to {motions[-1]}"
    text = (f"The same {span} motions ran through {count(len(sweep.axes[ENGINE]), 'engine')}. [[models]] sets their distributions beside each other, [[engines]] "
            f"measures each against {told}: D is the largest distance of the two distributions, p the probability of as large a one if the engine "
            "did not matter (engines swapped within motions). Common motions make D smaller than chance between two samples of motions would: a D that is not "
            "significant says that these motions do not tell the engines apart. The share of motions with the same outcome says how far one may be taken for the other in a single motion.")
    blocks = [Paragraph(text)]
    if any(one in MODEL_ENGINES for one in sweep.axes[ENGINE]):
        blocks.append(Paragraph("Rocking models of rigid bodies do not slide, and know nothing of the time step but the sampling of the motion; α has no effect on them."))
    chosen = [(line, name, motions) for line, _ in lines for name, some in ensembles.items() if (name != ALL or len(ensembles) == 1) and (motions := _of(line, some))]
    panels = [Panel(", ".join([*([name] if name != ALL else []), *(axis_text(axis, value) for axis, value in line.others.items())]),
                    tuple((NAMES.get(one.values[ENGINE], one.values[ENGINE]), ecdf(*one.peaks(motions))) for one in line.settings), sweep.p_lost)
              for line, name, motions in chosen[:_PANELS]]
    left_out = f" {len(chosen) - _PANELS} more panels are in [[engines]]." if len(chosen) > _PANELS else ""
    blocks.append(gallery.draw("models", f"Distributions of u_max by engine, on the same motions.{left_out}", cdf_figure, panels))
    named = (Column("ensemble", "motions of", text=True),) if len(ensembles) > 1 else ()
    columns = (*axis_columns(others), *named, Column("engine", "engine", lambda one: NAMES.get(one, one), text=True), Column("n", "n"), Column("overturned", "over\N{SOFT HYPHEN}turned"),
               Column("p_overturn", "P(overturn)", percent), Column("p_low p_high", "95 % interval", lambda low, high: interval(low, high, percent)),
               Column("u50_m", "u₅₀ [mm]", millimetres), Column("distance", "D", number), Column("p", "p", p_value),
               Column("same_outcome", "same outcome", percent), Column("cpu_s", "CPU an analysis [s]", number))
    blocks.append(Table("engines", columns, rows, f"Engines on the same motions. D, p and the share of motions with the same outcome are to {told}. CPU: mean processor time "
                        "of an analysis, without what is made or compiled once; wall time where an analysis did not record it."))
    return Section("Models beside each other", blocks)


def _reference(line: Line) -> Setting | None:
    """The engine nearest to the whole that a line has."""
    found = {setting.values[ENGINE]: setting for setting in line.settings}
    return next((found[name] for name in NEAREST if name in found), None)


def _ensembles(lines) -> dict[str, set | None]:
    """Motions by the ensemble file that they are of, ALL of them first; ALL alone where the study has no two such files, or motions of none."""
    found: dict[str, set] = {}
    for motion in (motion for line, _ in lines for motion in line.motions()):
        member = next((place for value in ast.literal_eval(motion) if isinstance(value, str) and (place := file_and_number(value))), None)
        if member is None:
            return {ALL: None}
        found.setdefault(Path(member[0]).stem, set()).add(motion)
    return {ALL: None} | (found if 1 < len(found) <= _MOST else {})


def _of(line: Line, some: set | None) -> list[str]:
    """The motions of a line that are among some, all for None."""
    return [motion for motion in line.motions() if some is None or motion in some]


def _rows(line: Line, reference: Setting, others, ensemble: str, some: set | None):
    motions = _of(line, some)
    if not motions:
        return
    base, base_lost = reference.peaks(motions)
    for setting in line.settings:
        u, lost = setting.peaks(motions)
        fallen = setting.column("overturned", motions).astype(bool)
        test = None if setting is reference else paired_kolmogorov_smirnov(censored(u, lost), censored(base, base_lost))
        yield (*(setting.values[axis] for axis in others), *([ensemble] if ensemble else []), setting.values[ENGINE], len(motions), int(fallen.sum()), float(fallen.mean()),
               *proportion_interval(int(fallen.sum()), len(motions)), percentile(u, lost, 0.5), None if test is None else float(test.statistic),
               None if test is None else float(test.p), None if test is None else float((lost == base_lost).mean()), _cost(setting, motions))


def _cost(setting: Setting, motions) -> float | None:
    """Mean processor time [s]; wall time of a run that did not record it."""
    times = setting.column("cpu_s", motions)
    times = np.where(np.isnan(times), setting.column("wall_s", motions), times)
    return float(np.nanmean(times)) if np.isfinite(times).any() else None
