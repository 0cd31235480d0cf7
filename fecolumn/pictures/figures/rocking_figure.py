"""Figure of the rocking spectra of an ensemble: how far rigid blocks of every size tilt, and how
often they overturn.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.spectrum import larger_rocking_spectrum, tilt_quantile
from fecolumn.motions.ensemble import Ensemble
from fecolumn.pictures.figures.style import (
    BLUE,
    GREY,
    PAGE_WIDTH_IN,
    SKY,
    VERMILION,
    new_figure,
    save,
)

_PERIODS = np.geomspace(0.5, 10.0, 48)  # rectangular blocks of R = 0.05 to 19 m
_TICKS = (0.5, 1, 2, 5, 10)
_HALF_DIAGONALS = (0.05, 0.2, 1, 5)
_TOP = 1.1


def rocking_figure(ensemble: Ensemble, slenderness: float, path: Path | str) -> list[Path]:
    """Peak tilts of all motions with median and 16-84 % band, and the share of motions that
    overturn; PNG and PDF.

    Call inside `styled()`.

    Parameters
    ----------
    ensemble
        blocks rock in the plane of x or y, whichever tilts them more.
    slenderness
        alpha of the rectangular blocks [rad], in (0, pi/2).
    path
        without suffix.
    """
    peaks = np.array(
        [larger_rocking_spectrum(motion, _PERIODS, slenderness) for motion in ensemble.motions]
    )
    # a line ends, and the band leaves through the top, where the block overturns
    low, middle, high = (tilt_quantile(peaks, share) for share in (0.16, 0.5, 0.84))
    figure = new_figure(PAGE_WIDTH_IN, 3.3)
    tilts, fallen = figure.subplots(1, 2)
    tilts.plot(
        _PERIODS,
        _ended(peaks).T,
        color=GREY,
        linewidth=0.3 if len(peaks) > 20 else 0.6,
        alpha=0.5,
        zorder=1,
    )
    tilts.fill_between(
        _PERIODS,
        np.minimum(low, 2 * _TOP),
        np.minimum(high, 2 * _TOP),
        facecolor=SKY,
        edgecolor=BLUE,
        alpha=0.5,
        linewidth=0.7,
        label="16-84 %",
        zorder=2,
    )
    tilts.plot(_PERIODS, _ended(middle), color=BLUE, linewidth=1.4, label="median", zorder=3)
    tilts.plot(
        [],
        [],
        color=GREY,
        linewidth=0.6,
        label=f"{len(peaks)} motion{'s' if len(peaks) > 1 else ''}",
    )
    moved = {axis for motion in ensemble.motions for axis in motion.horizontal_axes}
    along = f"along ${'xy'[moved.pop()]}$" if len(moved) == 1 else "larger of $x$ and $y$"
    tilts.set(ylabel=rf"$\max|\theta|\,/\,\alpha$ ({along})", ylim=(0, _TOP))
    tilts.legend(loc="upper right", title=rf"$\alpha$ = {slenderness:.4g} rad", title_fontsize=7.5)
    fallen.plot(_PERIODS, np.isinf(peaks).mean(axis=0), color=VERMILION, linewidth=1.4)
    fallen.set(ylabel=f"share that overturns ({along})", ylim=(0, 1.02))
    for axes in (tilts, fallen):
        axes.set(xscale="log", xlabel=r"$2\pi/p$ [s]", xlim=(_PERIODS[0], _PERIODS[-1]))
        axes.set_xticks(_TICKS, [f"{tick:g}" for tick in _TICKS])
        axes.minorticks_off()
        axes.tick_params(axis="x", top=False)
        sizes = axes.secondary_xaxis("top", functions=(_half_diagonal, _period))
        sizes.set_xlabel("half diagonal $R$ of a rectangular block [m]")
        sizes.set_xticks(_HALF_DIAGONALS, [f"{size:g}" for size in _HALF_DIAGONALS])
        sizes.minorticks_off()
    return save(figure, path)


def _ended(peaks: NDArray[Any]) -> NDArray[Any]:
    return np.where(np.isinf(peaks), np.nan, peaks)


def _half_diagonal(period: ArrayLike) -> NDArray[Any]:
    """R [m] of a rectangular block with p^2 = 3 g/(4 R)."""
    return 3 * GRAVITY / 4 * (np.asarray(period) / (2 * math.pi)) ** 2


def _period(half_diagonal: NDArray[Any]) -> NDArray[Any]:
    period: NDArray[Any] = 2 * math.pi * np.sqrt(4 * np.maximum(half_diagonal, 0) / (3 * GRAVITY))
    return period
