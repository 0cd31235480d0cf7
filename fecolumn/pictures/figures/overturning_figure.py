"""Figures of overturning: spectra of pulses with their islands, and the least slenderness that
stands a pulse.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.engines.rocking.overturning import (
    DESIGN,
    LINEAR,
    rectangular_slenderness,
    slenderness_factor,
)
from fecolumn.pictures.figures.style import (
    BLACK,
    COLUMN_WIDTH_IN,
    GREY,
    LINES,
    PAGE_WIDTH_IN,
    new_figure,
    save,
    styled,
)

if TYPE_CHECKING:
    from fecolumn.engines.rocking.overturning import Band


_TOP = 14.0
_KINDS: tuple[tuple[str, str, Callable[[int], bool]], ...] = (
    ("no impact", "#222222", lambda impacts: impacts == 0),
    ("one impact", "#8C8C8C", lambda impacts: impacts == 1),
    ("two and more", "#56B4E9", lambda impacts: impacts >= 2),
)
_WORDS = {
    "one_sine": "one-sine",
    "one_cosine": "one-cosine",
    "symmetric_ricker": "symmetric Ricker",
    "antisymmetric_ricker": "antisymmetric Ricker",
    "rectangular": "rectangular",
}


def overturning_figure(
    rows: Sequence[tuple[str, float, Band]], slenderness: float, path: Path | str
) -> list[Path]:
    """A panel a pulse: amplitudes that overturn, by the impacts before, over frequency; what is
    white is safe. PNG and PDF.

    Parameters
    ----------
    rows
        (shape, w_p/p, Band) of `spectra_table`; frequencies evenly spaced.
    slenderness
        alpha [rad].
    path
        without suffix.
    """
    shapes = list(dict.fromkeys(shape for shape, _, _ in rows))
    frequencies = sorted({frequency for _, frequency, _ in rows})
    half = min(np.diff(frequencies)) / 2 if len(frequencies) > 1 else 0.125
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 3.1)
        for place, (shape, axes) in enumerate(
            zip(shapes, np.atleast_1d(figure.subplots(1, len(shapes), sharey=True)))
        ):
            for words, colour, chosen in _KINDS:
                bands = [
                    (frequency, band)
                    for name, frequency, band in rows
                    if name == shape and chosen(band.impacts)
                ]
                axes.bar(
                    [frequency for frequency, _ in bands],
                    [min(band.high, _TOP) - band.low for _, band in bands],
                    2 * half,
                    [band.low for _, band in bands],
                    color=colour,
                    linewidth=0,
                    label=words,
                    zorder=2,
                )
            line = np.array([0, math.pi])
            if shape in LINEAR:
                axes.plot(
                    line,
                    1 + LINEAR[shape] * line,
                    color="#D55E00",
                    linestyle="--",
                    linewidth=1.2,
                    label=r"$1 + \beta\,\omega_p/p$",
                    zorder=3,
                )
            axes.set(
                xlim=(0, max(frequencies) + half),
                ylim=(0, _TOP),
                xlabel=r"$\omega_p/p$",
                title=_WORDS.get(shape, shape),
            )
            axes.axhline(1.0, color=BLACK, linewidth=0.6, zorder=3)
            if place == 0:
                axes.set_ylabel(r"$a_p/(g\,\tan\alpha)$")
                axes.legend(
                    loc="upper left",
                    title=rf"overturned, $\alpha$ = {math.degrees(slenderness):.3g}°",
                    title_fontsize=7.5,
                )
        return save(figure, path)


def slenderness_figure(path: Path | str) -> list[Path]:
    """phi(p T_p) of tan(alpha) = (a_p/g) phi: the least slenderness of a column that stands a
    rectangular pulse, and first estimates, which are too small. PNG and PDF; `path` without suffix.
    """
    duration = np.linspace(0, 20, 401)
    with styled():
        figure = new_figure(COLUMN_WIDTH_IN, 2.6)
        axes = figure.subplots()
        axes.plot(
            duration,
            rectangular_slenderness(duration),
            color=BLACK,
            linewidth=1.8,
            label=r"rectangular, exact: $1 - e^{-pT_p}$",
        )
        for pulse, (colour, dashes) in zip(DESIGN, LINES):
            words = {
                "rectangular": r"estimate $pT_p/(\gamma + pT_p)$, $\gamma$ = 1, rectangular",
                "one_sine": r"$\gamma$ = $\pi/3$, one-sine",
                "one_cosine": r"$\gamma$ = $\pi/2$, one-cosine",
            }[pulse]
            axes.plot(
                duration,
                slenderness_factor(duration, pulse),
                color=colour,
                linestyle=dashes,
                linewidth=1.1,
                label=words,
            )
        axes.axhline(1.0, color=GREY, linewidth=0.6)
        axes.set(
            xlim=(0, 20),
            ylim=(0, 1.05),
            xlabel=r"$p\,T_p$",
            ylabel=r"$\varphi = \tan\alpha\;g/a_p$",
        )
        axes.legend(
            loc="lower right", title="block stands above the exact line", title_fontsize=7.5
        )
        return save(figure, path)
