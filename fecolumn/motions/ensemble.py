"""Motions made or chosen together, so that their statistics mean something."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.motions.record import GroundMotion


@dataclass(frozen=True, slots=True, eq=False)
class Ensemble:
    """Motions made or chosen together.

    Attributes
    ----------
    name
        short name for figures and tables.
    motions
        (n,) at least one.
    parameters
        name with its unit, such as "pulse_period_s", to (n,) numbers, one a motion.
    provenance
        model, seed, version and arguments, as plain values (text, numbers, lists and dicts of
        them).

    Raises
    ------
    ValueError
        no motion, or a parameter that does not have one number a motion.
    """

    name: str
    motions: tuple[GroundMotion, ...]
    parameters: dict[str, NDArray[Any]]
    provenance: dict[str, Any]

    def __post_init__(self) -> None:
        if not self.motions:
            raise ValueError("an ensemble has at least one motion")
        for name, values in self.parameters.items():
            if np.shape(values) != (len(self.motions),):
                raise ValueError(
                    f"parameter {name!r} has shape {np.shape(values)} where "
                    f"{len(self.motions)} motions need one number each"
                )
