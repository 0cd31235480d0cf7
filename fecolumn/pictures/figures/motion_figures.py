"""Figures of an ensemble of ground motions: sample motions, spectra with their target,
distributions, rocking.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_report import measured_along, stored_target
from fecolumn.motions.processing import integrate
from fecolumn.motions.spectra import horizontal_spectrum
from fecolumn.pictures.figures.rocking_figure import rocking_figure
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREY,
    PAGE_WIDTH_IN,
    SKY,
    VERMILION,
    new_figure,
    save,
    styled,
)
from fecolumn.statistics.ecdf import ecdf

_ROWS = (r"$a$ [g]", r"$v$ [cm/s]", r"$d$ [cm]")
_MEASURES = (
    ("pga_m_s2", "PGA [g]", 1 / GRAVITY, "pga_g", 1),
    ("pgv_m_s", "PGV [cm/s]", 100, "pgv_m_s", 100),
    ("pgd_m", "PGD [cm]", 100, "pgd_m", 100),
    ("ds5_75_s", r"$D_\mathrm{5-75}$ [s]", 1, "ds5_75_s", 1),
    ("ds5_95_s", r"$D_\mathrm{5-95}$ [s]", 1, "ds5_95_s", 1),
    ("arias_m_s", r"$I_{A,x} + I_{A,y}$ [m/s]", 1, None, 1),
)
_HEADROOM = (1.0, 1.2, 1.0)  # the legend stands in the second row
_N_PERIODS = 150
_SHORTEST_S = 0.03  # displacements of stiffer oscillators tell nothing


def motion_figures(
    ensemble: Ensemble,
    columns: dict[str, NDArray[Any]],
    folder: Path | str,
    show: Iterable[int] | None = None,
    slenderness: float = 0.1,
) -> list[Path]:
    """Write samples, spectra, distributions and rocking spectra as PNG and PDF.

    Parameters
    ----------
    ensemble
        at least one motion.
    columns
        of ensemble_file.summary.
    folder
        made if missing.
    show
        up to three or so numbers of motions, counted from 1; by default those nearest to the 16, 50
        and 84 % PGV.
    slenderness
        of the rocking blocks [rad], in (0, pi/2).
    """
    folder = Path(folder)
    if not show:
        order = np.argsort(columns["pgv_m_s"], kind="stable")
        show = dict.fromkeys(
            int(order[round(share * (len(order) - 1))]) + 1 for share in (0.16, 0.5, 0.84)
        )
    with styled():
        return [
            *_samples(ensemble, list(show), folder / "motions"),
            *_spectra(ensemble, folder / "spectra"),
            *_distributions(ensemble, columns, folder / "distributions"),
            *rocking_figure(ensemble, slenderness, folder / "rocking"),
        ]


def _samples(ensemble: Ensemble, numbers: list[int], path: Path | str) -> list[Path]:
    """Acceleration, velocity and displacement in rows, a motion a column, with one scale a row."""
    figure = new_figure(PAGE_WIDTH_IN, 4.2)
    grid = figure.subplots(3, len(numbers), squeeze=False, sharex="col", sharey="row")
    for place, number in enumerate(numbers):
        motion = ensemble.motions[number - 1]
        time = np.arange(len(motion.acceleration)) * motion.dt
        velocity, displacement = integrate(motion)
        for row, history in enumerate(
            (motion.acceleration / GRAVITY, 100 * velocity, 100 * displacement)
        ):
            axes = grid[row, place]
            for axis, colour, dashes in (
                (0, BLUE, "-"),
                (1, VERMILION, "-" if row == 0 else (0, (4, 1))),
            ):
                axes.plot(
                    time,
                    history[:, axis],
                    color=colour,
                    linestyle=dashes,
                    linewidth=0.5 if row == 0 else 0.9,
                    alpha=0.85 if row == 0 else 1,
                    label=f"${'xy'[axis]}$",
                    zorder=3 - axis,
                )
            if place == 0:
                axes.set_ylabel(_ROWS[row])
        grid[0, place].set_title(f"motion {number}")
        grid[2, place].set(xlabel="time [s]", xlim=(0, time[-1]))
    for row in range(3):
        reach = max(abs(limit) for axes in grid[row] for limit in axes.get_ylim())
        grid[row, 0].set_ylim(-_HEADROOM[row] * reach, _HEADROOM[row] * reach)
    figure.align_ylabels(grid[:, 0])
    grid[1, 0].legend(loc="lower right", ncol=2)
    return save(figure, path)


def _spectra(ensemble: Ensemble, path: Path | str) -> list[Path]:
    """Every spectrum thin, the median and the band between 16 and 84 % over them, the target as
    marks.
    """
    found = stored_target(ensemble)
    periods = np.geomspace(
        *((found[0].periods_s[0], found[0].periods_s[-1]) if found else (0.02, 5.0)), _N_PERIODS
    )
    spectra = (
        np.array([horizontal_spectrum(motion, periods) for motion in ensemble.motions]) / GRAVITY
    )
    low, middle, high = np.percentile(spectra, [16, 50, 84], axis=0)
    along_what = measured_along(ensemble)
    figure = new_figure(PAGE_WIDTH_IN, 3.1)
    grid = figure.subplots(1, 2)
    for axes, power, factor, label in (
        (grid[0], 0, 1.0, rf"$S_a$ ({along_what}, 5 %) [g]"),
        (grid[1], 2, 100 * GRAVITY / (2 * np.pi) ** 2, rf"$S_d$ ({along_what}, 5 %) [cm]"),
    ):
        along = factor * periods**power
        axes.plot(periods, (along * spectra).T, color=GREY, linewidth=0.3, alpha=0.5, zorder=1)
        axes.fill_between(
            periods,
            along * low,
            along * high,
            facecolor=SKY,
            edgecolor=BLUE,
            alpha=0.5,
            linewidth=0.7,
            label="16-84 %",
            zorder=2,
        )
        axes.plot(periods, along * middle, color=BLUE, linewidth=1.4, label="median", zorder=3)
        if found:
            marks = np.array(found[0].periods_s)
            axes.plot(
                marks,
                factor * marks**power * np.array(found[0].sa_g),
                color=BLACK,
                linestyle="none",
                marker="o",
                markersize=2.6,
                markerfacecolor="white",
                markeredgewidth=0.7,
                label=f"target: {found[0].name}",
                zorder=4,
            )
        axes.set(
            xscale="log",
            yscale="log",
            xlabel=r"period $T$ [s]",
            ylabel=label,
            xlim=(periods[0], periods[-1]),
        )
    grid[1].set(
        xlim=(_SHORTEST_S, periods[-1]),
        ylim=(0.5 * factor * _SHORTEST_S**2 * np.interp(_SHORTEST_S, periods, low), None),
    )
    grid[0].plot([], [], color=GREY, linewidth=0.6, label=f"{len(spectra)} motions")
    grid[0].legend(loc="lower left")
    return save(figure, path)


def _distributions(
    ensemble: Ensemble, columns: dict[str, NDArray[Any]], path: Path | str
) -> list[Path]:
    """Distribution of each measure with the band of Greenwood, its median, and the target as a
    line.
    """
    found = stored_target(ensemble)
    figure = new_figure(PAGE_WIDTH_IN, 4.2)
    grid = figure.subplots(2, 3, sharey=True)
    for place, (axes, (key, label, factor, wanted, unit)) in enumerate(zip(grid.flat, _MEASURES)):
        values = factor * columns[key]
        distribution = ecdf(values, np.zeros(len(values), dtype=bool))
        axes.fill_between(
            distribution.x,
            distribution.lower,
            distribution.upper,
            step="post",
            color=BLUE,
            alpha=0.2,
            linewidth=0,
            label="95 % band",
        )
        axes.step(distribution.x, distribution.cdf, where="post", color=BLUE, label="ensemble")
        axes.plot(
            np.median(values),
            0.5,
            color=BLUE,
            linestyle="none",
            marker="o",
            markersize=4,
            label="median",
        )
        if found and wanted:
            axes.axvline(
                unit * getattr(found[0], wanted),
                color=VERMILION,
                linestyle="--",
                label=f"target: {found[0].name}",
            )
        axes.set(xlabel=label, ylim=(0, 1.02))
        if place % 3 == 0:
            axes.set_ylabel("share of motions")
    grid[0, 0].legend(loc="lower right")
    return save(figure, path)
