"""P(overturn) of every setting, as a table and a figure."""

from __future__ import annotations

from fecolumn.pictures.figures.interval_figure import IntervalRow, Scale, interval_figure
from fecolumn.statistics.ecdf import percentile
from fecolumn.study.report.claim import CALIBRATION_TARGET
from fecolumn.study.report.document import PageBlock, PageColumn, PageTable
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import fixed, millimetres, percent, percent_interval
from fecolumn.study.report.setting_columns import axis_columns, setting_labels
from fecolumn.study.report.sweep import Sweep

#: Rows of a table that is not folded, and of a figure
_ROWS = 40
TARGET_NOTE = (
    f"{percent(CALIBRATION_TARGET)} is a calibration target, never a result: the "
    "specimen's size is not published, and height and "
    "cap are there to be chosen so that P(overturn) comes near it"
)


def overturning_blocks(sweep: Sweep, gallery: Gallery) -> list[PageBlock]:
    """The figure, where a few settings are known, and the table; figures go to the gallery."""
    rows, estimates, labels = [], [], setting_labels(sweep)
    off = any(run.get("slid_off") for setting in sweep.settings for run in setting.runs.values())
    shared = len(set(sweep.records)) < len(sweep.records)
    for number, setting in enumerate(sweep.settings, 1):
        levels = (number, *(setting.values[axis] for axis in sweep.varied))
        if not setting.runs:
            rows.append(
                (
                    *levels,
                    setting.planned,
                    0,
                    *([0] if shared else []),
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
        wilson, exact = setting.overturning(), setting.overturning(method="exact")
        slid = [int(over.sum()) - k] if off else []
        rows.append(
            (
                *levels,
                setting.planned,
                n,
                *([len(set(setting.records_of()))] if shared else []),
                k,
                *slid,
                k / n,
                *wilson,
                *exact,
                *(percentile(u, over, fraction=share) for share in (0.16, 0.5, 0.84)),
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
            *((PageColumn("records", "records"),) if shared else ()),
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
        + (" Intervals count records, as runs of one are not independent." if shared else "")
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


def _whole(value: int | None) -> str:
    return "\N{EM DASH}" if value is None else str(value)
