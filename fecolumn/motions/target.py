"""What an ensemble is made to meet in the median: spectrum, peaks and durations of the motion that
seeds it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.schema import parameter
from fecolumn.motions.intensity import peak_values, significant_duration
from fecolumn.motions.record import GroundMotion
from fecolumn.motions.spectra import horizontal_spectrum

_RECORD_PERIODS = np.geomspace(0.03, 20, 66)
_TOLERANCES = {"pga": 0.10, "pgv": 0.10, "pgd": 0.25, "ds5_75": 0.10, "ds5_95": 0.10}
SPECTRUM_TOLERANCE, SPECTRUM_RANGE_S = 0.15, (0.05, 3.0)


@dataclass(frozen=True, slots=True)
class Target:
    """Figures of the seed motion at full scale; peaks and spectrum as RotD50, 5 % damping."""

    name: str = parameter(doc="short name of the seed motion")
    source: str = parameter(doc="where the figures come from")
    periods_s: tuple[float, ...] = parameter(
        doc="rising natural periods", unit="s", above=0, high=100
    )
    sa_g: tuple[float, ...] = parameter(
        doc="pseudo-acceleration at each period", unit="g", above=0, high=100
    )
    pga_g: float = parameter(doc="peak ground acceleration", unit="g", above=0, high=100)
    pgv_m_s: float = parameter(doc="peak ground velocity", unit="m/s", above=0, high=100)
    pgd_m: float = parameter(doc="peak ground displacement", unit="m", above=0, high=100)
    ds5_75_s: float = parameter(
        doc="time between 5 % and 75 % of the Arias intensity", unit="s", above=0, high=1000
    )
    ds5_95_s: float = parameter(
        doc="time between 5 % and 95 % of the Arias intensity", unit="s", above=0, high=1000
    )


@dataclass(frozen=True, slots=True)
class Agreement:
    """One figure of an ensemble beside its target."""

    name: str
    target: float
    median: float
    tolerance: float

    @property
    def within(self) -> bool:
        """Whether the median differs from the target by no more than the tolerance."""
        return abs(self.median / self.target - 1) <= self.tolerance


def measured(motion: GroundMotion, periods: ArrayLike) -> NDArray[Any]:
    """Spectrum [m/s2] at the periods, then PGA [m/s2], PGV [m/s], PGD [m], Ds5-75 and Ds5-95 [s]:
    (n_periods + 5,).
    """
    durations = significant_duration(motion, 0.05, 0.75), significant_duration(motion, 0.05, 0.95)
    return np.concatenate([horizontal_spectrum(motion, periods), peak_values(motion), durations])


def figures(target: Target) -> NDArray[Any]:
    """The target's figures in the order and units of `measured`."""
    return np.concatenate(
        [
            np.array(target.sa_g) * GRAVITY,
            [
                target.pga_g * GRAVITY,
                target.pgv_m_s,
                target.pgd_m,
                target.ds5_75_s,
                target.ds5_95_s,
            ],
        ]
    )


def target_of_record(motion: GroundMotion) -> Target:
    """Target of a recorded motion."""
    found = measured(motion, _RECORD_PERIODS)
    sa, (pga, pgv, pgd, ds5_75, ds5_95) = found[:-5] / GRAVITY, found[-5:].tolist()
    return Target(
        motion.name,
        motion.source,
        tuple(_RECORD_PERIODS.tolist()),
        tuple(sa.tolist()),
        pga / GRAVITY,
        pgv,
        pgd,
        ds5_75,
        ds5_95,
    )


def time_scaled(target: Target, factor: float) -> Target:
    """Target of the motion with time times `factor` and the same accelerations."""
    return dataclasses.replace(
        target,
        periods_s=tuple(factor * period for period in target.periods_s),
        pgv_m_s=factor * target.pgv_m_s,
        pgd_m=factor**2 * target.pgd_m,
        ds5_75_s=factor * target.ds5_75_s,
        ds5_95_s=factor * target.ds5_95_s,
    )


def agreement(
    motions: Iterable[GroundMotion], target: Target, time_scale: float = 1.0
) -> list[Agreement]:
    """Medians over motions beside the target's figures: PGA, PGV, PGD, durations, and the ordinates
    from 0.05 to 3 s at full scale.

    Parameters
    ----------
    motions
        at the scale of `target`.
    target
        already scaled in time.
    time_scale
        its factor, which scales the periods that count.
    """
    medians = np.median([measured(motion, target.periods_s) for motion in motions], axis=0)
    pairs = list(zip(figures(target).tolist(), medians.tolist()))
    units = {
        "pga": (GRAVITY, "PGA [g]"),
        "pgv": (1, "PGV [m/s]"),
        "pgd": (1, "PGD [m]"),
        "ds5_75": (1, "Ds5-75 [s]"),
        "ds5_95": (1, "Ds5-95 [s]"),
    }
    rows = [
        Agreement(label, wanted / unit, median / unit, _TOLERANCES[key])
        for (key, (unit, label)), (wanted, median) in zip(units.items(), pairs[-5:])
    ]
    first, last = (
        time_scale * period * (1 + sign * 1e-9) for period, sign in zip(SPECTRUM_RANGE_S, (-1, 1))
    )
    return rows + [
        Agreement(f"Sa({period:.4g} s) [g]", wanted / GRAVITY, median / GRAVITY, SPECTRUM_TOLERANCE)
        for period, (wanted, median) in zip(target.periods_s, pairs)
        if first <= period <= last
    ]
