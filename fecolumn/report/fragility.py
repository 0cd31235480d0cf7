"""Section: probability of overturning over the intensity of the motions."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from fecolumn.post.line_figure import Curve, CurvePanel, line_figure
from fecolumn.report.distributions import axis_columns
from fecolumn.report.document import Column, Paragraph, Section, Table
from fecolumn.report.gallery import Gallery
from fecolumn.report.notation import count, fixed, interval, p_clause, p_value, setting_text
from fecolumn.report.sweep import Setting, Sweep, read_tables
from fecolumn.schema import InputError, build
from fecolumn.statistics.bands import wilson
from fecolumn.statistics.fragility import DegenerateData, lognormal, logit

SCALE = "motion.scale"
_FEWEST, _BINS, _FOLD = 20, 6, 20


def fragility(sweep: Sweep, gallery: Gallery) -> Section | None:
    """The section; None where the motions are not to be found, are few, or do not tell overturning from standing."""
    known: dict[str, tuple[float, float]] = {}
    try:
        groups = [(values, *_runs(sweep.folder, settings, known)) for values, settings in _groups(sweep)]
    except (InputError, OSError, ValueError, KeyError):
        return None
    rows, curves, told = [], None, ""
    own = {key: value for key, value in sweep.reference.values.items() if key != SCALE}
    for values, measures, over in groups:
        fit = _fit(measures, over)
        rows.append((*(values[axis] for axis in sweep.varied if axis != SCALE), over.size, int(over.sum()), *(fit[1:] if fit else [None] * 7)))
        if values == own and fit:
            curves = _curves(fit[0], measures[:, 0], over)
            told = (f"At {setting_text(own)} half of the columns overturn at {_speed(fit[1])} m/s {interval(fit[2], fit[3], _speed)}, with a logarithmic standard "
                    f"deviation of {fixed(fit[4])}{_more(fit[7])}. ")
    if curves is None:
        return None
    files = line_figure([CurvePanel("PGV, RotD50 [m/s]", r"$P$(overturn)", curves, {"ylim": (0, 1)}, legend="upper left")], gallery.path("fragility"), gallery.formats)
    columns = (*axis_columns([axis for axis in sweep.varied if axis != SCALE]), Column("n", "runs"), Column("overturned", "over\N{SOFT HYPHEN}turned"),
               Column("pgv_median_m_s", "median PGV [m/s]", _speed),
               Column("pgv_low pgv_high", "95 %", lambda low, high: interval(low, high, _speed)),
               Column("beta", "β", fixed), Column("beta_low beta_high", "95 %", interval), Column("pga_p", "p of PGA", p_value))
    return Section("Fragility", [
        Paragraph("[[fragility]] and [[fragilities]]: probability of overturning over the peak ground velocity, lognormal, by maximum likelihood (Baker "
                  f"2015), each run one yes or no. {told}Intensities are those of the ensemble as it stands"
                  f"{', at all its scales' if SCALE in sweep.varied else ', unscaled: far from its middle the curve is an extrapolation'}."),
        gallery.figure("fragility", files, f"Fragility at {setting_text(own)}, with its 95 % band; beside it the shares observed in "
                                           f"{count(_BINS, 'group')} of motions of equal number, with Wilson's 95 % interval."),
        Table("fragilities", columns, rows, "Lognormal fragility of every setting: PGV at which half overturn, logarithmic standard deviation β, and p "
                                            "of the likelihood ratio that PGA beside PGV tells no more (logistic regression). A dash: the runs "
                                            "hold no maximum of the likelihood.", folded=len(rows) > _FOLD)])


def _more(p: float | None) -> str:
    return "" if p is None else f"; the peak acceleration beside the velocity tells {'' if p < 0.05 else 'no '}more ({p_clause(p)})"


def _speed(value) -> str:
    return fixed(value, 3)


def _groups(sweep: Sweep) -> list[tuple[dict, list[Setting]]]:
    """Settings that differ in the scale of their motions alone, with what they have in common; those of few runs left out."""
    groups: dict[str, tuple[dict, list[Setting]]] = {}
    for setting in sweep.done:
        values = {key: value for key, value in setting.values.items() if key != SCALE}
        groups.setdefault(repr(values), (values, []))[1].append(setting)
    return [group for group in groups.values() if sum(len(setting.runs) for setting in group[1]) >= _FEWEST]


def _runs(folder: Path, settings: list[Setting], known: dict) -> tuple[np.ndarray, np.ndarray]:
    """PGV and PGA (n, 2) [m/s, m/s2] of all runs, and which overturned (n,)."""
    runs = [run for setting in settings for run in setting.runs.values()]
    measures = np.array([_intensity(folder / "analyses" / run["case_id"], known) for run in runs])
    return measures, np.concatenate([setting.peaks()[1] for setting in settings])


def _intensity(folder: Path, known: dict) -> tuple[float, float]:
    """PGV [m/s] and PGA [m/s2] of the motion of the analysis in a folder; `known` has those of motions read before, at scale 1."""
    from fecolumn.case import Motion
    from fecolumn.motions.intensity import peak_values
    from fecolumn.motions.load import unsampled

    table = read_tables(folder)["motion"]
    scale = table["scale"]
    table.update(scale=1.0, free_vibration_s=0.0, delay_s=0.0)
    key = json.dumps(table, sort_keys=True)
    if key not in known:
        pga, pgv, _ = peak_values(unsampled(build(Motion, table, folder), folder))
        known[key] = pgv, pga
    return scale * known[key][0], scale * known[key][1]


def _fit(measures: np.ndarray, over: np.ndarray):
    """Fragility over PGV, its median and beta with their intervals, p of PGA or None; None where there is no fragility."""
    try:
        fit = lognormal(measures[:, 0], over)
    except DegenerateData:
        return None
    return fit, fit.median, *fit.median_interval(), fit.beta, *fit.beta_interval(), _second(measures, over)


def _second(measures: np.ndarray, over: np.ndarray) -> float | None:
    """p of the likelihood ratio that PGA beside PGV tells no more; None where PGA goes with PGV, as of pulses of one shape."""
    from scipy.stats import chi2

    try:
        more = 2 * (logit(measures, over).loglik - logit(measures[:, 0], over).loglik)
    except DegenerateData:
        return None
    return float(chi2.sf(max(more, 0.0), 1))


def _curves(fit, pgv: np.ndarray, over: np.ndarray) -> list[Curve]:
    """The curve with its band, and shares in groups of equal number."""
    grid = np.linspace(pgv.min(), pgv.max(), 200)
    p = fit.probability(grid)
    bins = np.array_split(np.argsort(pgv, kind="stable"), _BINS)
    shares = np.array([over[one].mean() for one in bins])
    low, high = np.transpose([np.ravel(wilson([over[one].sum()], one.size)) for one in bins])
    return [Curve("lognormal, maximum likelihood", grid, p.p, (p.lower, p.upper)),
            Curve("observed, sextiles", np.array([np.median(pgv[one]) for one in bins]), shares, bars=(low, high))]
