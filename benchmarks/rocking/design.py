"""Least slenderness that stands a pulse: the formula to design with beside computed outcomes.

    ./containers/run python -m benchmarks.rocking.design

A line for each duration p T_p of three pulses, of a slender block (alpha 0.05 rad): least
tan(alpha) over a_p/g by p T_p / (gamma + p T_p), gamma 1 of a rectangular pulse and else that of
the lines of Makris and Roussos (1998) through computed spectra, w_p/p <= pi; the same of Housner's
block: of a rectangular pulse in closed form, else computed, one over the least amplitude that
overturns; and the formula over it, below 1 where it lets a block fall. A second.
"""

from __future__ import annotations

import math

from benchmarks.beside import markdown
from fecolumn.engines.rocking.overturning import (
    DESIGN,
    overturning_bands,
    rectangular_slenderness,
    slenderness_factor,
)

DURATIONS = (2.0, 3.0, 4.0, 8.0, 16.0)
PULSES = ("rectangular", "one_sine", "one_cosine")
#: Of the block that is computed [rad]; least and largest amplitude over that of uplift
_SLENDER, _RANGE, _POINTS = 0.05, (1.0, 60.0), 4000


def computed(pulse: str, duration: float) -> float:
    """Least tan(alpha) over a_p/g of a block that stands the pulse: one over the least amplitude
    that overturns, over that of uplift; 0 where none does.
    """
    if pulse == "rectangular":
        return float(rectangular_slenderness(duration))
    bands = overturning_bands(
        pulse, 2 * math.pi / duration, _SLENDER, lowest=_RANGE[0], highest=_RANGE[1], points=_POINTS
    )
    return 1 / bands[0].low if bands else 0.0


def table() -> str:
    """A line for each duration."""
    head, rows = ["p T_p"], []
    for pulse in PULSES:
        name = pulse.replace("_", "-")
        head += [
            f"{name}: formula, gamma {DESIGN[pulse]:.4f}",
            f"{name}: {'exact' if pulse == 'rectangular' else 'computed'}",
            f"{name}: formula over {'exact' if pulse == 'rectangular' else 'computed'}",
        ]
    for duration in DURATIONS:
        row = [f"{duration:g}"]
        for pulse in PULSES:
            exact, asked = computed(pulse, duration), float(slenderness_factor(duration, pulse))
            row += [f"{asked:.4f}", f"{exact:.4f}", f"{asked / exact:.3f}" if exact else "-"]
        rows.append(tuple(row))
    return markdown(tuple(head), rows)


def main() -> None:
    print(table())


if __name__ == "__main__":
    main()
