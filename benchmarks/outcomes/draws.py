"""What is drawn for an analysis: a body, a motion and its amplitude, by Latin hypercubes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.outcomes.motions import measures
from benchmarks.soak.hypercube import Draw, hypercube
from fecolumn.case.sections import GRAVITY
from fecolumn.motions.ensemble import Ensemble

SEED = 1
#: height [m] and width over height, each evenly in the logarithm; coefficient of friction; PGA over
#: g times width over height, at which it lifts off; Young's modulus of what is elastic [Pa];
#: restitution of a planar block over Housner's.
HEIGHT, RATIO, FRICTION, PEAK = (0.3, 12.0), (0.08, 0.5), (0.2, 0.9), (0.7, 10.0)
YOUNGS, RESTITUTION = (1e9, 2e11), (0.9, 1.02)
DENSITY = 2500.0
NAMES = ("height", "ratio", "friction", "peak", "youngs", "restitution", "motion", "shape")


@dataclass(frozen=True)
class Drawn:
    """A body and a motion: lengths [m]; motion: its place in the file, scale: the factor on it."""

    width: float
    height: float
    friction: float
    youngs: float
    restitution: float
    round: bool
    motion: int
    scale: float

    def columns(self, ensemble: Ensemble, alone: bool) -> dict:
        """Columns of the table that body and motion fill; alone: x alone shakes it."""
        return {
            "shape": "cylinder" if self.round else "block",
            "width_m": self.width,
            "height_m": self.height,
            "motion_family": int(ensemble.parameters["family"][self.motion]),
            "motion": self.motion,
            "scale": self.scale,
            "pulse_period_s": float(ensemble.parameters["pulse_period_s"][self.motion]),
            **measures(ensemble, self.motion, self.scale, alone),
        }

    @property
    def frequency(self) -> float:
        """P [rad/s] about an edge: p^2 = m g R / I_O of a homogeneous block or cylinder."""
        across = 0.75 if self.round else 1.0
        square = (self.width**2 + self.height**2) / 4
        inertia = (across * self.width**2 + self.height**2) / 12 + square
        return float(np.sqrt(GRAVITY * np.sqrt(square) / inertia))

    @property
    def slenderness(self) -> float:
        """Alpha [rad] of a homogeneous body."""
        return float(np.arctan(self.width / self.height))


def drawn(kind: str, part: int, count: int, ensemble: Ensemble, alone: bool) -> list[Drawn]:
    """So many draws of a part of a model's analyses, the same for a number of the part."""
    samples = hypercube(NAMES, count, [SEED, *kind.encode(), part])
    return [_one(sample, ensemble, alone) for sample in samples]


def _one(draw: Draw, ensemble: Ensemble, alone: bool) -> Drawn:
    height, ratio = draw.log("height", *HEIGHT), draw.log("ratio", *RATIO)
    motion = draw.place("motion", len(ensemble.motions))
    wanted = draw.log("peak", *PEAK) * GRAVITY * ratio
    return Drawn(
        height * ratio,
        height,
        draw.even("friction", *FRICTION),
        draw.log("youngs", *YOUNGS),
        draw.even("restitution", *RESTITUTION),
        draw.place("shape", 2) == 1,
        motion,
        wanted / measures(ensemble, motion, 1.0, alone)["pga_m_s2"],
    )
