"""How far two distributions may differ without the data being able to exclude it: "not significant"
is not "equal".
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.statistics.bands import normal_quantile
from fecolumn.statistics.ecdf import censored
from fecolumn.statistics.records import Records, by_record

#: A difference of two CDFs that most would call small: "no difference" is claimed up to it.
SMALL = 0.1
_LEVEL = 0.05  # of significance, the usual one
_HALVINGS = 40  # of an interval of differences: to 1e-12


def distance_bound(
    u_a: ArrayLike,
    overturned_a: ArrayLike,
    u_b: ArrayLike,
    overturned_b: ArrayLike,
    confidence: float = 0.95,
    records: Records = None,
) -> tuple[float, float]:
    """Largest distance of the two distributions, and the distance the data exclude at `confidence`.

    The same motions in both settings: at each u the difference F_a - F_b is that of two paired
    proportions. The bound is the largest over u of that of `paired_error` and of `score_bound`. The
    true largest difference sits at some u*, and there the bound of one proportion
    already holds, so none is needed for all u at once (intersection-union test, Berger 1982,
    Technometrics 24). Where motions share records, n is the number of records, each with the mean
    difference of its motions.

    Parameters
    ----------
    u_a, u_b
        (n,) [m] peaks of the same n motions; ignored where the run overturned.
    overturned_a, overturned_b
        (n,) True where the column overturned: beyond every u.
    records
        (n,) record of each motion, None where each has one of its own.

    Returns
    -------
    Largest |F_a - F_b| over u, and its upper confidence bound, both in [0, 1].

    Raises
    ------
    ValueError
        as of `ecdf`; two numbers of motions.
    """
    a, b = censored(u_a, overturned_a), censored(u_b, overturned_b)
    if a.shape != b.shape:
        raise ValueError(f"u_a {a.shape} and u_b {b.shape}: must be peaks of the same motions")
    at = np.unique(np.concatenate([a, b]))
    at = at[np.isfinite(at)]
    if not at.size:
        at = np.zeros(1)
    difference = (a[:, None] <= at).astype(float) - (b[:, None] <= at)
    distance = float(np.abs(difference.mean(axis=0)).max())
    return distance, max(distance, upper_bound(by_record(difference, records), confidence))


def upper_bound(difference: ArrayLike, confidence: float) -> float:
    """Distance that n motions exclude at `confidence`, see `distance_bound`; difference (n, points)
    as of `paired_error`.

    Where few motions differ, all one way, the error of `paired_error` is too small: the bound is
    that of `score_bound` at least, to which what differs in part counts as more, smaller
    differences of as much variance.
    """
    difference = np.asarray(difference, float)
    centre, error = paired_error(difference)
    bound = np.abs(difference.mean(axis=0)).max()
    bound = max(bound, (np.abs(centre) + normal_quantile(2 * confidence - 1) * error).max())
    # with records of several sizes a large one counts as more than one
    ups, downs = (np.clip(sign * difference, 0.0, 1.0).sum(axis=0) for sign in (1, -1))
    # differences in part are more and smaller ones: of this size, with a whole one besides, as none
    # that was seen says nothing of the size of others
    size = ((np.clip(np.abs(difference), 0.0, 1.0) ** 2).sum(axis=0) + 1) / (ups + downs + 1)
    most, least, n = np.maximum(ups, downs) / size, np.minimum(ups, downs) / size, 1 / size
    bound = max(bound, score_bound(most, least, len(difference) * n, confidence).max())
    return float(min(1.0, bound))


def score_bound(
    ups: NDArray[Any], downs: NDArray[Any], n: NDArray[Any] | int, confidence: float
) -> NDArray[Any]:
    """Upper bound (...) at a one-sided `confidence` of the difference of two paired proportions, of
    which `ups` of n (...) motions have the first alone and `downs` (...) the second, or parts.

    It is the largest difference that the score test does not reject (Tango 1998, Statistics in
    Medicine 17): Wilson's bound where `downs` is 0.
    """
    ups, downs = np.asarray(ups, float), np.asarray(downs, float)
    z = normal_quantile(2 * confidence - 1)

    def rejected(difference: NDArray[Any]) -> NDArray[Any]:
        # share of the second alone that is likeliest at this difference
        b = -ups - downs + (2 * n - ups + downs) * difference
        c = -downs * difference * (1 - difference)
        alone = (np.sqrt(np.maximum(b**2 - 8 * n * c, 0.0)) - b) / (4 * n)
        spread = np.sqrt(np.maximum(n * (2 * alone + difference * (1 - difference)), 1e-300))
        found: NDArray[Any] = (n * difference - ups + downs) / spread >= z
        return found

    low, high = (ups - downs) / n, np.ones(np.shape(ups))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        beyond = rejected(middle)
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return high


def paired_error(difference: ArrayLike) -> tuple[NDArray[Any], NDArray[Any]]:
    """Centre and standard error of the mean difference of two paired proportions.

    Two motions are added to those seen, half a one to each of the four outcomes (Agresti & Min
    2005, Statistics in Medicine 24), so that the error is not 0 where no motion differs.

    Parameters
    ----------
    difference
        (n, ...) of each motion: -1, 0 or 1, or a mean of such over the settings it was run in.

    Returns
    -------
    Centre of the interval and standard error, (...) each.
    """
    difference = np.asarray(difference, float)
    n, total = len(difference) + 2, difference.sum(axis=0)
    return total / n, np.sqrt(np.maximum((difference**2).sum(axis=0) + 1 - total**2 / n, 0)) / n


def detectable_distance(n: int, significance: float = 0.05) -> float:
    """Largest distance of two CDFs of n motions each that chance alone gives, exceeded in a share
    `significance` of cases.

    A true difference below it is not seen: the two-sample Kolmogorov-Smirnov test does not reject.
    sqrt(ln(2 / significance) / n), the limit of many independent motions (Smirnov 1939); the same
    motions in both settings tell somewhat more.
    """
    return math.sqrt(math.log(2 / significance) / n)


def motions_needed(distance: float, significance: float = 0.05) -> int:
    """Motions in each setting from which a distance of two CDFs can be seen, the inverse of
    `detectable_distance`.
    """
    return math.ceil(round(math.log(2 / significance) / distance**2, 9))


def difference_shortfall(
    n: int, distance: float, comparisons: int = 1, unit: str = "motions"
) -> str:
    """Warning that n motions are few to claim a difference; "" where they are enough.

    A claim is made where one of several comparisons differs: it is judged at 5 % over their number,
    the strictest level of Holm's correction.

    Parameters
    ----------
    n
        motions in each setting.
    distance
        of the two CDFs, as found.
    comparisons
        pairs of settings that answer one question.
    unit
        what n counts, "records" where motions share them.
    """
    detectable = detectable_distance(n, _LEVEL / comparisons)
    if distance >= detectable:
        return ""
    among = f" among {comparisons} comparisons" if comparisons > 1 else ""
    return (
        f"With {n} {unit} a KS distance below {detectable:.2f} cannot be told from 0{among} "
        f"but by the pairing of {unit}: the claim of a difference of "
        f"{distance:.2f} needs about N = {motions_needed(distance, _LEVEL / comparisons)}."
    )


def equality_shortfall(
    n: int, margin: float = SMALL, bound: float = math.inf, unit: str = "motions"
) -> str:
    """Warning that n motions are few to claim that there is no difference; "" where they are
    enough, or where they exclude it all the same.

    Parameters
    ----------
    n
        motions in each setting.
    margin
        distance of two CDFs up to which they are called equal.
    bound
        distance that the data exclude, see `distance_bound`.
    unit
        what n counts, "records" where motions share them.
    """
    if n >= motions_needed(margin) or bound <= margin:
        return ""
    return (
        f"With {n} {unit} a KS distance below {detectable_distance(n):.2f} cannot be "
        f"told from 0: the claim of no difference beyond {margin:.2f} "
        f"needs about N = {motions_needed(margin)}."
    )
