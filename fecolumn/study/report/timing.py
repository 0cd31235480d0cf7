"""Section: what the analyses cost."""

from __future__ import annotations

import numpy as np

from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.study.alpha import ALPHA_KEY
from fecolumn.study.report.cost import second_cost
from fecolumn.study.report.document import (
    Figure,
    PageBlock,
    PageColumn,
    PageSection,
    PageTable,
    Paragraph,
)
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import axis_name, number, sentence
from fecolumn.study.report.setting_columns import axis_columns
from fecolumn.study.report.sweep import DT_KEY, Setting, Sweep

_CURVES, _FOLD = 7, 40


def timing(sweep: Sweep, gallery: Gallery) -> PageSection | None:
    """The section; None where no analysis states its time."""
    medians = [_median(setting) for setting in sweep.done]
    if not np.isfinite(medians).any():
        return None
    base = _median(sweep.reference)
    rows = [
        (
            *(setting.values[axis] for axis in sweep.varied),
            len(setting.runs),
            cost,
            cost / base,
            1e3 * _mean(setting, "s_per_step"),
            float(np.nanmean(setting.column("steps"))),
            _per_step(setting, "iterations"),
            _per_step(setting, "contact_iterations"),
            float(np.nansum(setting.column("wall_s"))) / 3600,
        )
        for setting, cost in zip(sweep.done, medians)
    ]
    columns = (
        *axis_columns(sweep.varied),
        PageColumn("n", "n"),
        PageColumn("wall_s_per_s", "cost [s/s]", number),
        PageColumn("ratio", "ratio", number),
        PageColumn("ms_per_step", "step [ms]", number),
        PageColumn("steps", "steps", lambda value: f"{value:.0f}"),
        PageColumn("iterations_per_step", "itera\N{SOFT HYPHEN}tions a step", number),
        PageColumn(
            "contact_iterations_per_step", "contact itera\N{SOFT HYPHEN}tions a step", number
        ),
        PageColumn("wall_h", "total [h]", number),
    )
    # a model in closed form has no iterations
    stated = [
        place
        for place, column in enumerate(columns)
        if "iterations" not in column.name or any(row[place] is not None for row in rows)
    ]
    columns, rows = (
        tuple(columns[place] for place in stated),
        [tuple(row[place] for place in stated) for row in rows],
    )
    total = np.nansum([row[-1] for row in rows])
    blocks: list[PageBlock] = [
        Paragraph(
            f"{sentence(sweep.at(sweep.reference.values))} a second of analysed motion "
            f"takes {number(base)} s of one core in the "
            f"median; the whole study took {number(float(total))} h of one core. Times "
            "are those of workers that may have shared "
            "cores and memory with others: ratios below about 1.2 mean little."
        )
    ]
    if figure := _figure(sweep, gallery):
        blocks.append(figure)
    return PageSection(
        "Cost",
        blocks
        + [
            PageTable(
                "timing",
                columns,
                rows,
                "Wall time of a second of analysed motion (median over the motions; "
                "stepping alone, without "
                "start, files, and what is made or compiled once), its ratio to that "
                f"{sweep.at(sweep.reference.values)}, mean time of a "
                "step, and the time of all analyses together.",
                folded=len(rows) > _FOLD,
            )
        ],
    )


def _median(setting: Setting) -> float:
    costs = second_cost(setting)
    return float(np.nanmedian(costs)) if np.isfinite(costs).any() else float("nan")


def _mean(setting: Setting, name: str) -> float:
    return float(np.nanmean(setting.column(name)))


def _per_step(setting: Setting, name: str) -> float | None:
    shares = setting.column(name) / setting.column("steps")
    return float(np.nanmean(shares)) if np.isfinite(shares).any() else None


def _figure(sweep: Sweep, gallery: Gallery) -> Figure | None:
    """Cost along the time step where it was varied, a curve for each level of the next axis,
    medians with 16-84 % bands.
    """
    if DT_KEY not in sweep.varied:
        return None
    others = [axis for axis in sweep.varied if axis != DT_KEY]
    axis = ALPHA_KEY if ALPHA_KEY in others else others[0] if others else None
    curves = []
    for level in sweep.axes[axis][:_CURVES] if axis else [None]:
        members = [one for one in sweep.done if axis is None or one.values[axis] == level]
        steps = sorted({one.values[DT_KEY] for one in members})
        costs = [
            np.concatenate([second_cost(one) for one in members if one.values[DT_KEY] == step])
            for step in steps
        ]
        quantiles = np.array([np.nanquantile(cost, [0.16, 0.5, 0.84]) for cost in costs])
        curves.append(
            Curve(
                axis_text(axis, level) if axis else "",
                np.array(steps),
                quantiles[:, 1],
                (quantiles[:, 0], quantiles[:, 2]),
                markers=True,
            )
        )
    panels = [
        CurvePanel(
            r"time step $\Delta t$ [s]",
            "wall time per second of motion [s/s]",
            curves,
            {"xscale": "log", "yscale": "log"},
        )
    ]
    each = f", for each {axis_name(axis)}" if axis else ""
    caption = (
        f"Cost of a second of motion against the time step{each}: median and 16–84 % over "
        "the motions."
    )
    if axis and (relative := _relative(sweep, axis)):
        panels.append(
            CurvePanel(
                axis_text(axis, 0).split(" = ")[0],
                "cost relative to the lowest value",
                relative,
                {"ylim": (0, None)},
            )
        )
        caption += (
            f" Right: cost along {axis_name(axis)} relative to its lowest value, same "
            "motions, geometric mean with 95 % interval."
        )
    return gallery.draw("cost", caption, line_figure, panels)


def _relative(sweep: Sweep, axis: str) -> list[Curve]:
    """Cost along an axis of numbers relative to its lowest level, a curve for each time step."""
    if not all(isinstance(level, (int, float)) for level in sweep.axes[axis]):
        return []
    curves = []
    for step in sweep.axes[DT_KEY][:_CURVES]:
        lines = [line for line in sweep.lines(axis) if line.others.get(DT_KEY) == step]
        if not lines:
            continue
        line, motions = lines[len(lines) // 2], lines[len(lines) // 2].motions()
        with np.errstate(divide="ignore", invalid="ignore"):
            logs = np.log(
                [
                    second_cost(setting, motions) / second_cost(line.settings[0], motions)
                    for setting in line.settings
                ]
            )
        reach = 1.96 * logs.std(axis=1) / len(motions) ** 0.5
        middle = logs.mean(axis=1)
        if np.isfinite(middle).all():
            curves.append(
                Curve(
                    axis_text(DT_KEY, step),
                    np.array(line.levels, float),
                    np.exp(middle),
                    (np.exp(middle - reach), np.exp(middle + reach)),
                    markers=True,
                )
            )
    return curves
