"""Section: all motions together, as they moved: fans, paths in plan, directions in which what was
analysed was lost.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.ending import lost
from fecolumn.pictures.figures.axis_text import axis_text
from fecolumn.pictures.figures.fan_figure import Fan, fan_figure
from fecolumn.pictures.figures.plan_figure import LostDirections, plan_figure
from fecolumn.pictures.figures.specimen_outline import specimen_outline
from fecolumn.study.report.document import Figure, PageBlock, PageSection, Paragraph
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.histories import Histories
from fecolumn.study.report.notation import axis_name, count
from fecolumn.study.report.sweep import Setting, Sweep

_PANELS, _ACROSS = 20, 5
SHAPE = {"column", "cap", "flange"}


def all_motions(sweep: Sweep, histories: Histories, gallery: Gallery) -> PageSection | None:
    """The section; None where no history is to be read."""
    drawn = [setting for setting in sweep.done if histories.of(setting)]
    if not drawn:
        return None
    shown = sweep.reference if sweep.reference in drawn else drawn[0]
    limit, own = 1.03 * sweep.limit_m, histories.of(shown)
    # a model of a plane has no path in plan
    in_plan = any(trace.u_top[:, 1].any() for trace in own)
    caption = (
        f"{_what(sweep)} in {count(len(own), 'motion')} {sweep.at(shown.values)}, against "
        f"time. {_marked(sweep, shown)}"
    )
    blocks: list[PageBlock] = [
        Paragraph(_opening(sweep, histories, len(drawn), in_plan)),
        gallery.draw("fan", caption, fan_figure, [Fan("", own)], limit, critical_of([shown]), 1),
    ]
    if in_plan:
        blocks.append(_plan(sweep, histories, shown, limit, gallery))
    if len(drawn) > 1:
        blocks.append(_multiples(sweep, histories, drawn, limit, gallery))
    return PageSection("All motions together", blocks)


def _what(sweep: Sweep) -> str:
    return f"Displacement of {sweep.subject.top} relative to the base"


def _opening(sweep: Sweep, histories: Histories, drawn: int, in_plan: bool) -> str:
    text = (
        f"[[fan]] {'and [[plan]] show' if in_plan else 'shows'} the motions of one setting "
        f"together{', [[multiples]] those of each' if drawn > 1 else ''}. "
    )
    if histories.missing:
        text += (
            f"{count(histories.missing, 'history')} of analyses that are done could not be "
            f"read and {'is' if histories.missing == 1 else 'are'} not drawn. "
        )
    if histories.skipped:
        text += (
            f"The histories of {len(sweep.motions) - len(histories.skipped)} of "
            f"{len(sweep.motions)} motions are drawn, spread evenly over the "
            "peaks of that setting. "
        )
    return (
        text + "Histories are drawn as history.h5 has them, row by row; peaks in tables and "
        "distributions are of every step of the analysis."
    )


def _marked(sweep: Sweep, setting: Setting) -> str:
    if not any(lost(run) for run in setting.runs.values()):
        return "None was lost."
    return f"Crosses: {sweep.lost}, where the analysis stopped or left the axes."


def _plan(
    sweep: Sweep, histories: Histories, shown: Setting, limit: float, gallery: Gallery
) -> Figure:
    here, anywhere = _directions([shown]), _directions(sweep.done)
    same = not {axis.partition(".")[0] for axis in sweep.varied} & SHAPE
    outline = specimen_outline(sweep.case) if sweep.case and same else None
    caption = f"Paths of the top in plan, relative to the base, {sweep.at(shown.values)}"
    if len(anywhere):
        caption += (
            f". Right or below: directions in which {sweep.subject.noun}s were lost, the "
            "share of each sector of 30°"
        )
        caption += (
            f"; filled, {len(here)} of this setting; outline, {len(anywhere)} of all settings"
            if len(sweep.done) > 1
            else ""
        )
    return gallery.draw(
        "plan",
        caption + ".",
        plan_figure,
        histories.of(shown),
        LostDirections(here, anywhere, "lost" if sweep.slides else "overturned"),
        None if outline is None else outline.foot,
        critical_of([shown]),
        limit,
    )


def critical_of(settings: Iterable[Setting]) -> float | None:
    """Critical displacement of the settings [m]; None where it is not the same in all."""
    found = {run.get("u_critical_m") for setting in settings for run in setting.runs.values()}
    return found.pop() if len(found) == 1 else None


def _directions(settings: Iterable[Setting]) -> NDArray[Any]:
    """[deg] of all that was lost and tells."""
    found = [
        run.get("overturn_direction_deg")
        if run["overturned"]
        else run.get("slid_off_direction_deg")
        for setting in settings
        for run in setting.runs.values()
        if lost(run)
    ]
    return np.array([angle for angle in found if angle is not None], float)


def _multiples(
    sweep: Sweep, histories: Histories, drawn: list[Setting], limit: float, gallery: Gallery
) -> Figure:
    """A panel a setting on the same axes, ordered so that the axis of most levels runs across."""
    axes = sorted(sweep.varied, key=lambda axis: len(sweep.axes[axis]))
    ordered = sorted(
        drawn, key=lambda one: [sweep.axes[axis].index(one.values[axis]) for axis in axes]
    )
    chosen = (
        ordered
        if len(ordered) <= _PANELS
        else [
            ordered[place]
            for place in np.linspace(0, len(ordered) - 1, _PANELS).round().astype(int)
        ]
    )
    levels = [len(sweep.axes[axis]) for axis in axes]
    across = (
        levels[-1]
        if math.prod(levels) == len(ordered) and levels[-1] <= _ACROSS
        else min(len(chosen), _ACROSS - 1)
    )
    fans = [
        Fan(
            "\n".join(
                [*(axis_text(axis, one.values[axis]) for axis in axes[-3:]), _share(sweep, one)]
            ),
            histories.of(one),
        )
        for one in chosen
    ]
    part = (
        f" ({len(chosen)} of {len(ordered)} settings, evenly spaced in their order)"
        if len(chosen) < len(ordered)
        else ""
    )
    return gallery.draw(
        "multiples",
        f"{_what(sweep)} in all motions, a panel for each setting{part}, varying "
        f"{' and '.join(axis_name(axis) for axis in axes)}; the same axes in all.",
        fan_figure,
        fans,
        limit,
        critical_of(chosen),
        across,
    )


def _share(sweep: Sweep, setting: Setting) -> str:
    fallen = sum(lost(run) for run in setting.runs.values())
    return f"{fallen} of {len(setting.runs)} {'lost' if sweep.slides else 'overturned'}"
