"""Section: can the analyses be trusted? Code, energy, cuts, penetration, overturns in time,
failures.
"""

from __future__ import annotations

import numpy as np

from fecolumn.engines.summary_entries import CLOSES
from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.study.failures import may_be_biased, why_failed
from fecolumn.study.mixture import codes, listed
from fecolumn.study.report.document import (
    Figure,
    PageBlock,
    PageColumn,
    PageSection,
    PageTable,
    Paragraph,
)
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import axis_name, count, fixed, number
from fecolumn.study.report.setting_columns import axis_columns
from fecolumn.study.report.sweep import Setting, Sweep
from fecolumn.study.setting_rows import failed_of
from fecolumn.study.store import DONE, FAILED

_CURVES, _FOLD = 7, 40


def audit(sweep: Sweep, gallery: Gallery) -> PageSection:
    """The section."""
    blocks: list[PageBlock] = [
        Paragraph(_completeness(sweep)),
        *([Paragraph(note, warning=True)] if (note := failed_note(sweep)) else []),
        *([Paragraph(f"{sweep.cut}.", warning=True)] if sweep.cut else []),
        _code(sweep),
        Paragraph(_energy(sweep)),
        _table(sweep),
    ]
    if figure := _overturn_times(sweep, gallery):
        blocks.append(figure)
    failed = failed_of(sweep.rows)
    if failed:
        axes = list(failed[0]["axes"])
        rows = [
            (
                *(str(value) for value in row["axes"].values()),
                row["reason"] or "no reason recorded",
                row["id"],
                row.get("log") or "",
            )
            for row in failed
        ]
        columns = (
            *(PageColumn(axis, axis_name(axis), text=True) for axis in axes),
            PageColumn("reason", "reason", text=True),
            PageColumn("id", "analysis", text=True),
            PageColumn("log", "log", text=True),
        )
        blocks.append(
            PageTable(
                "failures",
                columns,
                rows,
                "Analyses that failed, with the reason recorded; they count neither as "
                "standing nor "
                "as overturned.",
                folded=len(rows) > _FOLD,
            )
        )
    return PageSection("Audit", blocks)


def failed_note(sweep: Sweep) -> str:
    """How many analyses of each setting failed, why, and what to do; "" where none did."""
    told = [
        (sweep.at(setting.values), setting.failed, setting.planned)
        for setting in sweep.settings
        if setting.failed
    ]
    return f"{may_be_biased(told)} {why_failed(failed_of(sweep.rows))}".strip()


def _completeness(sweep: Sweep) -> str:
    done, failed = (sum(row["state"] == state for row in sweep.rows) for state in (DONE, FAILED))
    total = sweep.analyses
    if done == total:
        return f"All {count(total, 'analysis')} are done, none failed."
    parts = [f"{done} of {count(total, 'analysis')} are done"]
    if failed:
        parts.append(f"{failed} failed ([[failures]])")
    if total - done - failed:
        parts.append(f"{total - done - failed} of {total} not run yet")
    return (
        "; ".join(parts)
        + ". Figures and tables hold what is done; comparisons take the motions done in "
        "both settings."
    )


def _code(sweep: Sweep) -> Paragraph:
    found = codes(sweep.rows)
    if len(found) == 1:
        return Paragraph(f"All that is done was done by {next(iter(found))}.")
    return Paragraph(
        f"Analyses of different code stand side by side: {listed(found)}. Differences "
        "between settings may be differences of "
        "code; a study in a new folder is of one code.",
        warning=True,
    )


def _energy(sweep: Sweep) -> str:
    runs = [
        (abs(run["energy_closure_rel"]), setting, run)
        for setting in sweep.done
        for run in setting.runs.values()
        if run.get("energy_closure_rel") is not None
    ]
    if not runs:
        return "No analysis states how its energy ledger closes."
    worst, setting, run = max(runs, key=lambda one: one[0])
    median, open_ = (
        float(np.median([one[0] for one in runs])),
        sum(one[0] > CLOSES for one in runs),
    )
    at = (
        f" ({run['motion']}, {sweep.words(setting.values)})"
        if run.get("motion")
        else f" ({sweep.words(setting.values)})"
    )
    text = (
        "The energy ledger (kinetic, strain and gravity energy against the work of "
        "base motion, friction, impact, contact and numerical "
        f"damping) closes to {number(median)} of the energy moved in the median and "
        f"{number(worst)} at worst{at if worst else ''}. "
    )
    return text + (
        f"{count(open_, 'analysis')} {'misses' if open_ == 1 else 'miss'} "
        f"{number(CLOSES)}: look at them before trusting their "
        "peaks."
        if open_
        else f"No analysis misses {number(CLOSES)}."
    )


def _table(sweep: Sweep) -> PageTable:
    rows = [
        (
            *(setting.values[axis] for axis in sweep.varied),
            setting.planned,
            len(setting.runs),
            setting.failed,
            *_median_and_worst(setting, "energy_closure_rel"),
            _largest(setting, "penetration_max_m"),
            _total(setting, "cuts"),
            _mean(setting, "impacts"),
            _mean(setting, "rigid_loss_share"),
            *(_share(setting, term) for term in ("algorithmic", "impact", "friction")),
            *_first_and_last(setting),
        )
        for setting in sweep.settings
    ]
    columns = (
        *axis_columns(sweep.varied),
        PageColumn("planned", "planned"),
        PageColumn("done", "done"),
        PageColumn("failed", "failed"),
        PageColumn("closure_median", "closure, median", number),
        PageColumn("closure_worst", "worst", number),
        PageColumn(
            "penetration_max_m",
            "pene\N{SOFT HYPHEN}tration [mm]",
            lambda value: number(None if value is None else 1e3 * value),
        ),
        PageColumn("cuts", "step cuts", number),
        PageColumn("impacts_mean", "impacts a run", number),
        PageColumn("rigid_loss_share_mean", "of the rigid loss [%]", _hundred),
        PageColumn("algorithmic_share", "loss by HHT [%]", _hundred),
        PageColumn("impact_share", "impact [%]", _hundred),
        PageColumn("friction_share", "friction [%]", _hundred),
        PageColumn("overturn_first_s overturn_last_s", "overturned at [s]", _span),
    )
    return PageTable(
        "audit",
        columns,
        rows,
        "Audit of every setting: analyses; relative closure error of the energy ledger; largest "
        "penetration; step cuts; impacts, and what they took of the loss that rigid "
        "bodies would have had at them, means; of the energy lost, the parts taken by "
        "numerical damping, impact "
        "and friction (sums over the motions; negative where energy was gained); first "
        "and last overturn.",
        folded=len(rows) > _FOLD,
    )


def _span(first: float | None, last: float | None) -> str:
    return number(None) if first is None or last is None else f"{fixed(first)}–{fixed(last)}"


def _hundred(share: float | None) -> str:
    return fixed(None if share is None else 100 * share, 1)


def _median_and_worst(setting: Setting, name: str) -> tuple[float | None, float | None]:
    values = np.abs(setting.column(name))
    return (
        (float(np.nanmedian(values)), float(np.nanmax(values)))
        if np.isfinite(values).any()
        else (None, None)
    )


def _largest(setting: Setting, name: str) -> float | None:
    values = setting.column(name)
    return float(np.nanmax(values)) if np.isfinite(values).any() else None


def _total(setting: Setting, name: str) -> int | None:
    values = setting.column(name)
    return int(np.nansum(values)) if np.isfinite(values).any() else None


def _mean(setting: Setting, name: str) -> float | None:
    values = setting.column(name)
    return float(np.nanmean(values)) if np.isfinite(values).any() else None


def _share(setting: Setting, term: str) -> float | None:
    """Part of a term of the ledger in all losses of the setting [-]."""
    ledgers = [
        run["energy_j"] for run in setting.runs.values() if isinstance(run.get("energy_j"), dict)
    ]
    losses = {
        name: -sum(ledger.get(name, 0.0) for ledger in ledgers)
        for name in ("algorithmic", "impact", "friction", "contact", "damping", "rolling", "links")
    }
    whole = sum(max(loss, 0.0) for loss in losses.values())
    return losses[term] / whole if whole > 0 else None


def _first_and_last(setting: Setting) -> tuple[float | None, float | None]:
    times = [
        run["overturn_time_s"]
        for run in setting.runs.values()
        if run.get("overturned") and run.get("overturn_time_s") is not None
    ]
    return (min(times), max(times)) if times else (None, None)


def _overturn_times(sweep: Sweep, gallery: Gallery) -> Figure | None:
    """Share of the runs that have overturned by a time, settings of one axis together."""
    axis = next((axis for axis in sweep.varied if len(sweep.axes[axis]) <= _CURVES), None)
    end = max(
        (run.get("duration_s") or 0.0 for setting in sweep.done for run in setting.runs.values()),
        default=0.0,
    )
    curves = []
    for level in sweep.axes[axis] if axis else [None]:
        runs = [
            run
            for setting in sweep.done
            if axis is None or setting.values[axis] == level
            for run in setting.runs.values()
        ]
        times = np.sort(
            [
                run["overturn_time_s"]
                for run in runs
                if run.get("overturned") and run.get("overturn_time_s") is not None
            ]
        )
        if runs:
            share = np.arange(times.size + 1) / len(runs)
            curves.append(
                Curve(
                    axis_text(axis, level) if axis else "",
                    np.concatenate([[0.0], times, [end]]),
                    np.append(share, share[-1]),
                    steps=True,
                )
            )
    if not any(curve.y[-1] > 0 for curve in curves):
        return None
    panel = CurvePanel(
        "time $t$ [s]", "share overturned by $t$", curves, {"xlim": (0, end), "ylim": (0, None)}
    )
    return gallery.draw(
        "overturn_times",
        "Share of the runs that have overturned by a time"
        + (f", for each {axis_name(axis)}, all other settings together." if axis else "."),
        line_figure,
        [panel],
    )
