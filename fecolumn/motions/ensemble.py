"""Motions made or chosen together, so that their statistics mean something."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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
    parameters: dict[str, np.ndarray]
    provenance: dict

    def __post_init__(self):
        if not self.motions:
            raise ValueError("an ensemble has at least one motion")
        for name, values in self.parameters.items():
            if np.shape(values) != (len(self.motions),):
                raise ValueError(
                    f"parameter {name!r} has shape {np.shape(values)} where "
                    f"{len(self.motions)} motions need one number each"
                )
