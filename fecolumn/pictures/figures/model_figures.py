"""Figures of a rocking model: its response to one motion, or the distribution of its peaks in an
ensemble.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.cdf_figure import CdfPanel, cdf_figure
from fecolumn.pictures.figures.style import (
    GREY,
    LINES,
    PAGE_WIDTH_IN,
    legend_beside,
    new_figure,
    save,
    styled,
)
from fecolumn.pictures.figures.top_figure import ground_panel
from fecolumn.statistics.ecdf import ecdf

if TYPE_CHECKING:
    from fecolumn.engines.rocking.model import Model, ModelResponse
    from fecolumn.motions.record import GroundMotion


_STATES = (
    ("kinetic", "kinetic"),
    ("gravity", "gravity"),
    ("strain", "springs, tendons"),
    ("base_work", "work of the ground"),
    ("impact", "impacts"),
    ("damping", "damping"),
)


def response_figure(
    motion: GroundMotion, response: ModelResponse, model: Model, path: Path | str, title: str = ""
) -> list[Path]:
    """Ground acceleration, coordinates with impacts, displacement of the top, energy; PNG and PDF.

    Parameters
    ----------
    motion
        GroundMotion.
    response, model
        of fecolumn.engines.rocking.
    path
        without suffix.
    """
    time = response.time
    ground = np.array(
        [
            np.interp(time, motion.dt * np.arange(len(column)), column, right=0.0)
            for column in motion.acceleration.T
        ]
    )
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 6.0)
        above, middle, top, below = panels = figure.subplots(
            4, 1, sharex=True, gridspec_kw={"height_ratios": [0.8, 1.2, 1, 1]}
        )
        if title:
            above.set_title(title)
        ground_panel(above, time, ground.T)
        units = set(response.units.values())
        for (name, values), (colour, dashes) in zip(response.coordinates.items(), LINES):
            unit = "" if len(units) == 1 else f" [{response.units[name]}]"
            middle.plot(time, values, color=colour, linestyle=dashes, label=_symbol(name) + unit)
        middle.plot(
            response.impact_times,
            np.zeros(len(response.impact_times)),
            "|",
            color=GREY,
            markersize=5,
            label=f"{len(response.impact_times)} impacts",
            zorder=1,
        )
        reach, critical = (
            max(np.abs(values).max() for values in response.coordinates.values()),
            model.critical_tilt,
        )
        if units == {"rad"} and reach > 0.3 * critical:
            for sign in (1, -1):
                middle.axhline(
                    sign * critical,
                    color=GREY,
                    linestyle="--",
                    linewidth=0.8,
                    label=f"critical, {critical:.3g} rad" if sign > 0 else None,
                    zorder=1,
                )
        middle.set_ylabel(f"coordinates\n[{', '.join(sorted(units))}]")
        for component, label, (colour, dashes) in zip(
            response.u_top.T, ("$u_x$", "$u_y$", "$u_z$"), LINES
        ):
            if np.abs(component).max() > 0:
                top.plot(time, 1e3 * component, color=colour, linestyle=dashes, label=label)
        top.set_ylabel("top, relative to\nthe base [mm]")
        for (name, words), (colour, dashes) in zip(_STATES, LINES):
            if name in response.energy and np.abs(response.energy[name]).max() > 0:
                below.plot(time, response.energy[name], color=colour, linestyle=dashes, label=words)
        below.set(ylabel="energy [J]", xlabel="time [s]", xlim=(time[0], time[-1]))
        for axes in panels:
            if axes.get_legend_handles_labels()[0]:
                legend_beside(axes)
        figure.align_ylabels(panels)
        return save(figure, path)


def ensemble_figure(
    responses: Sequence[tuple[GroundMotion, ModelResponse]], name: str, path: Path | str
) -> list[Path]:
    """Distribution of the peak displacement of the top; `responses`: (GroundMotion, Response) of
    one model.
    """
    u_max, overturned = (
        np.array(values)
        for values in zip(*((response.u_max, response.overturned) for _, response in responses))
    )
    return cdf_figure(
        [
            CdfPanel(
                f"{len(responses)} motions", ((name.replace("_", " "), ecdf(u_max, overturned)),)
            )
        ],
        path,
    )


def _symbol(name: str) -> str:
    """Name of a coordinate such as theta_x as mathematics."""
    letter, _, index = name.partition("_")
    greek = letter in ("theta", "phi", "psi", "alpha", "varphi")
    if not greek and len(letter) > 1:
        return name.replace("_", " ")
    symbol = "\\" * greek + letter + ("_{" + index + "}" if index else "")
    return f"${symbol}$"
