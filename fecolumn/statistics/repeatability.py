"""How far ahead a motion can be computed: runs that differ by next to nothing, and how they part.

The perturbed runs are analyses like others: a study whose axes shift contact.friction_coefficient,
initial.tilt_rad or motion.delay_s by 1e-9 to 1e-3 of themselves (benchmarks/repeatability.toml).
Where motion is chaotic a perturbation of size e grows on average like e exp(rate t) until it is as
large as the motion; beyond that horizon, of order ln(1 / e) / rate, only statistics can be told
(Lorenz 1969, Tellus 21). With contact it grows in leaps, at impacts and at changes of stick and
slip, so the rate is an average; and short motions may end before the runs have parted at all: then
there is no horizon, and the rate means little.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_DECADE = 10.0


@dataclass(frozen=True, slots=True)
class Spread:
    """Growth of the spread of runs that began all but equal.

    Attributes
    ----------
    times
        (steps,) [s].
    spread
        (steps,) root mean square distance of the runs from their mean [unit of the paths].
    peak
        largest distance of the mean run from the origin [unit of the paths].
    rate
        exponential rate of the running maximum of spread, least squares over `window` [1/s]; nan
        where it grows less than tenfold within `window`.
    interval
        95 % interval of the rate, by leaving out one run after the other (jackknife): what other
        perturbations of this motion would give, not what other motions would.
    window
        times in which the spread lies between `size` and `share` of the peak [s].
    """

    times: NDArray[Any]
    spread: NDArray[Any]
    peak: float
    rate: float
    interval: tuple[float, float]
    window: tuple[float, float]


def spread(paths: ArrayLike, times: ArrayLike, share: float = 0.1, size: float = 0.0) -> Spread:
    """Spread of perturbed runs of one motion over time, and its rate of growth.

    Perturbations of different sizes belong in different calls: the largest alone would be seen.

    Parameters
    ----------
    paths
        (k, steps) or (k, steps, d) with k >= 3 runs, such as the top displacement in x and y [m].
    times
        (steps,) rising [s].
    share
        of the peak, where the growth counts as ended.
    size
        relative size of the perturbation. A response that follows what it is given differs by about
        as much; growth counts from where the spread is that share of the peak, so that the first
        steps' way up from rounding is not taken for chaos.
    """
    paths, times = np.asarray(paths, float), np.asarray(times, float)
    if paths.ndim == 2:
        paths = paths[..., None]
    if (
        paths.ndim != 3
        or len(paths) < 3
        or paths.shape[1] != times.size
        or not np.isfinite(paths).all()
    ):
        raise ValueError(
            f"paths {paths.shape}, times {times.shape}: at least 3 runs of the length "
            "of times are needed, all finite"
        )
    if (np.diff(times) <= 0).any():
        raise ValueError("times must rise")
    distance, peak = _scatter(paths), float(np.linalg.norm(paths.mean(axis=0), axis=1).max())
    rate, window = _rate(distance, times, size * peak, share * peak)
    k = len(paths)
    left_out = np.array(
        [
            _rate(_scatter(np.delete(paths, run, axis=0)), times, size * peak, share * peak)[0]
            for run in range(k)
        ]
    )
    return Spread(times, distance, peak, rate, _jackknife(rate, left_out), window)


def horizon(distance: ArrayLike, times: ArrayLike, peak: float, share: float = 0.1) -> float:
    """Time at which the spread first passes a share of the peak [s]; inf where it never does.

    Parameters
    ----------
    distance
        (steps,) spread, of `spread`, or the distance between two runs.
    times
        (steps,) [s].
    peak
        size of the motion, in the unit of the spread.
    share
        in (0, 1].
    """
    if not 0 < share <= 1:
        raise ValueError(f"share = {share}: must lie in (0, 1]")
    passed = np.flatnonzero(np.asarray(distance, float) > share * peak)
    return float(np.asarray(times, float)[passed[0]]) if passed.size else math.inf


def time_gained(sizes: ArrayLike, horizons: ArrayLike) -> tuple[float, float, float]:
    """Horizon gained by a tenfold smaller perturbation [s], with its 95 % interval: (gain, low,
    high).

    Straight line of the horizons over -log10(size), least squares, interval of Student; ln(10) /
    gain is the rate of growth that does not depend on where the growth begins and ends.

    Parameters
    ----------
    sizes
        (m,) relative size of each perturbation, at least two different ones and m >= 3.
    horizons
        (m,) [s]; infinite ones, of runs that never part, are left out and make the gain a lower
        bound.
    """
    from scipy.stats import linregress, t

    decades, horizons = -np.log10(np.asarray(sizes, float)), np.asarray(horizons, float)
    known = np.isfinite(horizons)
    if known.sum() < 3 or np.ptp(decades[known]) == 0:
        raise ValueError("a gain needs three finite horizons of perturbations of different sizes")
    line = linregress(decades[known], horizons[known])
    reach = t.ppf(0.975, known.sum() - 2) * line.stderr
    return float(line.slope), float(line.slope - reach), float(line.slope + reach)


def aligned(runs: Iterable[tuple[ArrayLike, ArrayLike]]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Runs of different length on common times: (times (steps,), paths (k, steps, d)).

    A run that ended earlier, because it overturned, keeps its last value: from then on its distance
    from the others is that of a column that has fallen. The last row of a thinned history may lie
    between the others; it counts only as that value.

    Parameters
    ----------
    runs
        list of (times (n,), path (n, d)), each with the same step but for the last.

    Raises
    ------
    ValueError
        steps that differ.
    """
    known = [(np.asarray(times, float), np.asarray(path, float)) for times, path in runs]
    common = max((times for times, _ in known), key=len)
    if len(common) > 2 and not math.isclose(
        common[-1] - common[-2], common[1] - common[0], rel_tol=1e-6
    ):
        common = common[:-1]
    for times, _ in known:
        inner = times[:-1][: common.size]
        if not np.allclose(inner, common[: inner.size], rtol=1e-9, atol=0):
            raise ValueError("runs must have the same time step")
    return common, np.array(
        [
            np.stack(
                [np.interp(common, times, row) for row in path.reshape(len(times), -1).T], axis=-1
            )
            for times, path in known
        ]
    )


def _scatter(paths: NDArray[Any]) -> NDArray[Any]:
    """Root mean square distance from the mean run, (steps,)."""
    deviation = paths - paths[0]  # exactly 0 of equal runs, which their mean is not
    deviation -= deviation.mean(axis=0)
    return np.asarray(np.sqrt((deviation**2).sum(axis=(0, 2)) / (len(paths) - 1)))


def _rate(
    distance: NDArray[Any], times: NDArray[Any], floor: float, limit: float
) -> tuple[float, tuple[float, float]]:
    """Slope of ln(running maximum) between floor and limit, and the window of times where it lies
    there.
    """
    grown = np.maximum.accumulate(distance)
    inside = (grown > floor) & (grown <= limit)
    if not inside.any():
        return math.nan, (math.nan, math.nan)
    window = float(times[inside][0]), float(times[inside][-1])
    if grown[inside][-1] < _DECADE * grown[inside][0] or inside.sum() < 3:
        return math.nan, window
    return float(np.polyfit(times[inside], np.log(grown[inside]), 1)[0]), window


def _jackknife(rate: float, left_out: NDArray[Any]) -> tuple[float, float]:
    """95 % interval (Tukey 1958; Efron & Tibshirani 1993, chapter 11)."""
    from scipy.stats import t

    k = left_out.size
    error = math.sqrt((k - 1) / k * ((left_out - left_out.mean()) ** 2).sum())
    reach = float(t.ppf(0.975, k - 1)) * error
    return rate - reach, rate + reach
