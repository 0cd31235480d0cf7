"""Spectra of motions beside the target that they shall fit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)

if TYPE_CHECKING:
    from fecolumn.motions.spectral_match import TargetSpectrum


def match_figure(
    target: TargetSpectrum,
    spectra: NDArray[Any],
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
) -> list[Path]:
    """Each spectrum thin, their mean of logarithms and its standard deviation over the target's,
    and beside it the standard deviations.

    Parameters
    ----------
    target
        `motions.spectral_match.TargetSpectrum`.
    spectra
        (n, p) [m/s2] at its periods.
    path
        file name without suffix.
    """
    periods, logs = target.periods, np.log(spectra / GRAVITY)
    middle, wanted = logs.mean(axis=0), np.log(target.sa / GRAVITY)
    spread = logs.std(axis=0, ddof=1) if len(logs) > 1 else np.zeros(len(periods))
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 3.2)
        left, right = figure.subplots(1, 2, width_ratios=[1.6, 1])
        left.plot(periods, np.exp(logs).T, color=GREY, linewidth=0.3, alpha=0.6)
        left.plot([], [], color=GREY, linewidth=0.6, label=f"{len(logs)} motions")
        for center, sigma, color, style, label in (
            (middle, spread, BLUE, "-", "their mean"),
            (wanted, target.sigma, VERMILION, "--", "target"),
        ):
            left.plot(periods, np.exp(center), color=color, linestyle=style, label=label)
            if sigma is None:
                continue
            for sign in (-1, 1):
                own = np.exp(center + sign * sigma)
                left.plot(periods, own, color=color, linestyle=style, linewidth=0.6)
            right.plot(periods, sigma, color=color, linestyle=style)
        left.plot([], [], color=BLACK, linewidth=0.6, label=r"$\pm\sigma$")
        left.set(yscale="log", ylabel=r"$S_a$ (5 %) [g]")
        right.set(ylabel=r"standard deviation of $\ln S_a$ [-]", ylim=(0, None))
        for axes in (left, right):
            axes.set(xscale="log", xlim=(periods[0], periods[-1]), xlabel="period $T$ [s]")
        left.legend(loc="lower left")
        return save(figure, path, formats)
