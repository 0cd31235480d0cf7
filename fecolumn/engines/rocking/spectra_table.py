"""Overturning spectra of the pulses of the literature: bands over frequency and amplitude."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fecolumn.engines.rocking.overturning import Band, overturning_bands

PULSE_SHAPES = ("one_sine", "one_cosine", "symmetric_ricker", "antisymmetric_ricker")
FREQUENCIES = tuple(0.25 * number for number in range(1, 41))
_POINTS = 801  # amplitudes of the grid: steps of 0.33 %


def spectra_table(
    slenderness: float,
    restitution: float,
    shapes: Sequence[str] = PULSE_SHAPES,
    frequencies: Sequence[float] = FREQUENCIES,
    *,
    show: Callable[[str], object] = lambda text: None,
) -> list[tuple[str, float, Band]]:
    """(shape, w_p/p, band) of all that overturns, in this order; `show` is told what is done."""
    found: list[tuple[str, float, Band]] = []
    for shape in shapes:
        for frequency in frequencies:
            found += [
                (shape, frequency, band)
                for band in overturning_bands(
                    shape, frequency, slenderness, points=_POINTS, restitution=restitution
                )
            ]
        show(f"{shape}: {len(frequencies)} frequencies done")
    return found
