"""A physical quantity as a figure writes it: name, unit with its prefix, factor and range."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.colors import Normalize


# Prefixes that readers of each unit know, from small to large
_PREFIXES = {
    "m": ((1e-6, "µm"), (1e-3, "mm"), (1.0, "m")),
    "rad": ((1e-6, "µrad"), (1e-3, "mrad")),
    "Pa": ((1.0, "Pa"), (1e3, "kPa"), (1e6, "MPa"), (1e9, "GPa")),
    "J": ((1e-9, "nJ"), (1e-6, "µJ"), (1e-3, "mJ"), (1.0, "J"), (1e3, "kJ"), (1e6, "MJ")),
    "N": ((1.0, "N"), (1e3, "kN"), (1e6, "MN")),
    "m/s2": ((1.0, "m/s²"),),
}
# Lengths and angles are written in the smallest unit in which they stay below so much: engineers
# read 800 mm, not 0.8 m
_LARGEST = {"m": 1e3, "rad": 2e3}


@dataclass(frozen=True, slots=True)
class Quantity:
    """Name, unit as written, what one of that unit is in SI, the largest value in SI, and over how
    many decades its colours run; 0: from zero, evenly.
    """

    name: str
    unit: str
    scale: float
    largest: float
    decades: int = 0

    @classmethod
    def of(cls, name: str, unit: str, largest: float, decades: int = 0) -> Quantity:
        """The quantity in the largest prefixed unit in which its largest value [SI] is at least 1,
        and lengths and angles in the smallest in which they stay readable.
        """
        largest, choices = float(np.nan_to_num(abs(largest))), _PREFIXES[unit]
        least = _LARGEST.get(unit)
        fit = [
            (scale, word)
            for scale, word in choices
            if (largest / scale <= least if least else largest >= scale)
        ]
        scale, word = (
            (fit[0] if least else fit[-1]) if fit else (choices[-1] if least else choices[0])
        )
        return cls(name, word, scale, largest, decades)

    @property
    def label(self) -> str:
        """Such as "tilt [mrad]"."""
        return f"{self.name} [{self.unit}]"

    @property
    def range(self) -> tuple[float, float]:
        """Least and largest value [SI] that colours tell apart."""
        largest = self.largest or 1e-30
        return (largest / 10.0**self.decades if self.decades else 0.0), largest

    def norm(self) -> Normalize:
        """The range in the unit as written, as matplotlib maps it to colours."""
        from matplotlib.colors import LogNorm, Normalize

        return (LogNorm if self.decades else Normalize)(*(end / self.scale for end in self.range))
