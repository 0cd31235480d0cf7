"""Tables and figure of a study, from its ledger."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from fecolumn.engines.ending import P_LOST, P_OVERTURN, lost
from fecolumn.foundation.atomic import write_csv
from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.cdf_figure import CdfPanel, cdf_figure
from fecolumn.statistics.ecdf import ecdf
from fecolumn.statistics.ensemble import EnsembleSummary, summarize
from fecolumn.statistics.records import Records
from fecolumn.study.device_peaks import BOND_COLUMNS, LINK_COLUMNS, peaks_of_bonds, peaks_of_links
from fecolumn.study.plan import Plan
from fecolumn.study.planned import PlannedStudy
from fecolumn.study.setting_rows import SettingRows, rows_by_setting

# The axis told apart by lines where it is varied, all others by panels; where it is not, the axis
# of most levels that a panel can show
_LINE_AXIS, _LINES = "integration.alpha_hht", 7

_TABLE = (
    "planned",
    "n",
    "overturned",
    "slid_off",
    "p_overturn",
    "wilson_low",
    "wilson_high",
    "exact_low",
    "exact_high",
    "u_max_16_m",
    "u_max_50_m",
    "u_max_84_m",
    "energy_closure_worst",
    "records",
    "failed",
)
_ANALYSES = (
    "u_max_m",
    "u_max_censored",
    "overturned",
    "slid_off",
    "outcome",
    "residual_slide_m",
    "steps",
    "energy_closure_rel",
)


def ensemble(summaries: list[dict[str, Any]], records: Records = None) -> EnsembleSummary:
    """Row of one combination from the summaries of its analyses, at least one; their records."""
    return summarize(
        [summary["u_max_m"] for summary in summaries],
        [summary["overturned"] for summary in summaries],
        [summary["energy_closure_rel"] for summary in summaries],
        [summary["s_per_step"] for summary in summaries],
        [bool(summary.get("slid_off")) for summary in summaries],
        records,
    )


def write_tables(plan: Plan, rows: list[dict[str, Any]], folder: Path | str) -> None:
    """Write table.csv and analyses.csv, the same bytes for the same results, and timing.csv; of
    structures with links links.csv, and with glued joints bonds.csv, too.
    """
    table, timing, links, bonds = [], [], [], []
    for setting in rows_by_setting(plan, rows):
        planned, failed, done = len(setting.rows), len(setting.failed), setting.summaries
        texts = [str(value) for value in setting.values.values()]
        if done:
            row = ensemble(done, setting.records)
            shares = (row.p_overturn, *row.wilson, *row.exact)
            table.append(
                [
                    *texts,
                    planned,
                    row.n,
                    row.overturned,
                    row.slid_off,
                    *(f"{p:.6f}" for p in shares),
                    *(f"{u:.6e}" for u in (row.u16_m, row.u50_m, row.u84_m)),
                    f"{row.energy_closure_worst:.3e}",
                    row.records,
                    failed,
                ]
            )
            timing.append(
                [*texts, row.n, f"{row.s_per_step:.6f}", f"{sum(s['wall_s'] for s in done):.2f}"]
            )
            links += [[*texts, *_told(row)] for row in peaks_of_links(done)]
            bonds += [[*texts, *_told(row)] for row in peaks_of_bonds(done)]
        else:
            table.append([*texts, planned, 0, *[""] * (len(_TABLE) - 3), failed])
    axes = list(plan.analyses[0].combination)
    write_csv(Path(folder) / "table.csv", [[*axes, *_TABLE], *table])
    write_csv(Path(folder) / "timing.csv", [[*axes, "n", "s_per_step", "wall_s"], *timing])
    if links:
        write_csv(Path(folder) / "links.csv", [[*axes, *LINK_COLUMNS], *links])
    if bonds:
        write_csv(Path(folder) / "bonds.csv", [[*axes, *BOND_COLUMNS], *bonds])
    write_csv(
        Path(folder) / "analyses.csv",
        [["case_id", *plan.axes, "state", *_ANALYSES], *map(_analysis_row, rows)],
    )


def _slid_off(settings: list[SettingRows]) -> bool:
    """Whether anything slid off its base."""
    return any(summary.get("slid_off") for one in settings for summary in one.summaries)


def _told(row: list[Any]) -> list[Any]:
    """A row of peaks as it stands in a table."""
    return [f"{value:.6e}" if isinstance(value, float) else value for value in row]


def _analysis_row(row: dict[str, Any]) -> list[Any]:
    texts, summary = [row["id"], *row["axes"].values(), row["state"]], row["summary"]
    if not summary:
        return texts + [""] * len(_ANALYSES)
    # what overturned or slid off has none
    peak = "" if lost(summary) else f"{summary['u_max_m']:.6e}"
    return [
        *texts,
        peak,
        int(lost(summary)),
        int(summary["overturned"]),
        int(bool(summary.get("slid_off"))),
        summary.get("outcome", ""),
        f"{summary['residual_slide_m']:.6e}",
        summary["steps"],
        f"{summary['energy_closure_rel']:.3e}",
    ]


def table_text(plan: PlannedStudy, rows: list[dict[str, Any]]) -> str:
    """The table for a reader: a line for each combination, axes of one value left out; columns that
    slid off their base, analyses that failed, and records that several analyses share, are counted
    where there are any.
    """
    levels, settings = varied(plan), rows_by_setting(plan, rows)
    shared = any(len(set(one.records)) < len(one.records) for one in settings)
    failed = any(one.failed for one in settings)
    off = _slid_off(settings)
    lines = [
        [
            *(key.split(".")[-1] for key in levels),
            "n",
            *(["records"] if shared else []),
            *(["failed"] if failed else []),
            "overturned",
            *(["slid off"] if off else []),
            "P [95 % Wilson]",
            "u16 mm",
            "u50 mm",
            "u84 mm",
            "closure",
            "s/step",
        ]
    ]
    for setting in settings:
        planned, done = len(setting.rows), setting.summaries
        texts = [str(setting.values[key]) for key in levels]
        lacking = [str(len(setting.failed))] if failed else []
        if not done:
            lines.append([*texts, f"0/{planned}", *["-"] * shared, *lacking] + ["-"] * (7 + off))
            continue
        row = ensemble(done, setting.records)
        lines.append(
            [
                *texts,
                f"{row.n}/{planned}",
                *([str(row.records)] if shared else []),
                *lacking,
                str(row.overturned),
                *([str(row.slid_off)] if off else []),
                f"{100 * row.p_overturn:.1f} % [{100 * row.wilson[0]:.1f}, "
                f"{100 * row.wilson[1]:.1f}]",
                *(
                    f"{1e3 * u:.2f}" if math.isfinite(u) else "lost" if off else "overturn"
                    for u in (row.u16_m, row.u50_m, row.u84_m)
                ),
                f"{row.energy_closure_worst:.1e}",
                f"{row.s_per_step:.3g}",
            ]
        )
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(line, widths)) for line in lines
    )


def write_figure(plan: PlannedStudy, rows: list[dict[str, Any]], folder: Path | str) -> list[Path]:
    """Write cdf.png and cdf.pdf: a line for each level of one axis, a panel for each setting of the
    others; axes of one value are left out.
    """
    panels: dict[str, list[Any]] = {}
    levels = varied(plan)
    line = line_axis(levels)
    settings = rows_by_setting(plan, rows)
    for setting in settings:
        values, done = setting.values, setting.summaries
        title = ", ".join(
            axis_text(key, value) for key, value in values.items() if key != line and key in levels
        )
        if done:
            label = axis_text(line, values[line]) if line else f"$n$ = {len(done)}"
            panels.setdefault(title, []).append(
                (
                    label,
                    ecdf(
                        [s["u_max_m"] for s in done],
                        [lost(s) for s in done],
                        records=setting.records,
                    ),
                )
            )
    if not panels:
        return []
    off = _slid_off(settings)
    return cdf_figure(
        [
            CdfPanel(title or plan.title, tuple(lines), P_LOST if off else P_OVERTURN)
            for title, lines in panels.items()
        ],
        Path(folder) / "cdf",
    )


def varied(plan: PlannedStudy) -> dict[str, int]:
    """Number of levels of each axis that tells ensembles apart and has more than one."""
    levels = {
        key: len({repr(analysis.combination[key]) for analysis in plan.analyses})
        for key in plan.analyses[0].combination
    }
    return {key: count for key, count in levels.items() if count > 1}


def line_axis(levels: dict[str, int]) -> str | None:
    """The axis whose levels are the lines of a figure, from the numbers of levels of those that
    vary; None where one line a panel is left.
    """
    if _LINE_AXIS in levels:
        return _LINE_AXIS
    few = [key for key in levels if levels[key] <= _LINES]
    return max(few, key=levels.__getitem__, default=None)
