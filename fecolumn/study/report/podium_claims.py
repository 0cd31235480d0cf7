"""What Bantilas, Kavvadias and Vasiliadis claim of the two impact laws of a podium, put to a study:
with sizes, intervals and a rule stated beforehand.

Both laws see the same motions: differences are judged in pairs, intervals come from drawing motions
again, the same ones for all buildings. With thousands of motions the least difference is
significant; so every claim has its size beside it, and "alike" is told by the band that the paper
itself draws.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.model_sections import CAV, CRV
from fecolumn.statistics.bands import greenwood, wilson
from fecolumn.statistics.two_sample import paired_kolmogorov_smirnov
from fecolumn.study.report.claim import NOT_SUPPORTED, SUPPORTED, UNDECIDED, Claim
from fecolumn.study.report.notation import count, fixed, percent, percent_interval

#: Tilt over alpha below which a motion starts no rocking
STILL = 1e-6
#: A tenth of the paper's motions: with fewer its band is so wide that lying within says little
FEWEST = 350
_OUTSIDE = 0.05  # share of a curve's points outside a 95 % band that chance alone explains
_RESAMPLES = 499
# Arrays (motions,) by name, see `building_laws`
BuildingResponse = Mapping[str, NDArray[Any]]


@dataclass(frozen=True, slots=True)
class BuildingLaws:
    """Both laws side by side for one building.

    Attributes
    ----------
    profile, storeys
        which.
    motions
        number.
    still
        share of motions that start no rocking.
    overturned
        shares under CRV and CAV.
    tilt, shear
        (D, p) of the paired Kolmogorov-Smirnov test between the laws.
    outside_tilt, outside_shear
        share of the CRV curve's points where CAV's is outside its pointwise 95 % band.
    shear_ratio
        median of base shear CAV over CRV, of motions that rock and overturn under neither.
    median_ratio
        of the medians.
    tilt_scatter, shear_scatter
        half the difference of the 84th and 16th percentiles of ln(CAV/CRV), of the same motions;
        nan where there is none.
    drawn
        the last four of motions drawn again, (4, resamples).
    """

    profile: str
    storeys: int
    motions: int
    still: float
    overturned: tuple[float, float]
    tilt: tuple[float, float]
    shear: tuple[float, float]
    outside_tilt: float
    outside_shear: float
    shear_ratio: float
    median_ratio: float
    tilt_scatter: float
    shear_scatter: float
    drawn: NDArray[Any]


def building_laws(
    profile: str, storeys: int, crv: BuildingResponse, cav: BuildingResponse, resamples: int = 1999
) -> BuildingLaws:
    """Both laws compared; crv, cav: "tilt" over alpha, inf where overturned, and "shear" over V_st,
    (motions,) each.
    """
    a, b, shears = crv["tilt"], cav["tilt"], (crv["shear"], cav["shear"])
    both = np.isfinite(a) & np.isfinite(b)
    tilt, shear = (
        paired_kolmogorov_smirnov(one, two, resamples=resamples)
        for one, two in ((a, b), (shears[0][both], shears[1][both]))
    )
    draws = np.random.default_rng(1).integers(len(a), size=(_RESAMPLES, len(a)))
    drawn = np.array(
        [_sizes(a[some], b[some], shears[0][some], shears[1][some]) for some in draws]
    ).T
    return BuildingLaws(
        profile,
        storeys,
        len(a),
        float((a <= STILL).mean()),
        (float(np.isinf(a).mean()), float(np.isinf(b).mean())),
        (tilt.statistic, tilt.p),
        (shear.statistic, shear.p),
        _outside(a, b),
        _outside(shears[0][both], shears[1][both]),
        *_sizes(a, b, *shears),
        drawn,
    )


def _sizes(
    a: NDArray[Any], b: NDArray[Any], shear_a: NDArray[Any], shear_b: NDArray[Any]
) -> tuple[float, float, float, float]:
    """Median of ratios, ratio of medians, and scatter of tilts and of shears between the laws."""
    both = np.isfinite(a) & np.isfinite(b)
    rocking = both & (a > STILL) & (b > STILL)
    if rocking.sum() < 2:
        return np.nan, np.nan, np.nan, np.nan
    logs = [np.log(two[rocking] / one[rocking]) for one, two in ((a, b), (shear_a, shear_b))]
    scatter = [float(np.diff(np.percentile(one, [16, 84]))[0] / 2) for one in logs]
    return (
        float(np.exp(np.median(logs[1]))),
        float(np.median(shear_b[both]) / np.median(shear_a[both])),
        scatter[0],
        scatter[1],
    )


def _outside(a: NDArray[Any], b: NDArray[Any]) -> float:
    """Share of a's values where the distribution of b is outside the band of a's."""
    x = np.unique(a[np.isfinite(a)])
    cdf, other = (np.searchsorted(np.sort(one), x, side="right") / len(one) for one in (a, b))
    low, high = greenwood(cdf, len(a), 0.95)
    return float(((other < low) | (other > high)).mean())


def compared(
    found: Mapping[tuple[str, int, str], BuildingResponse], resamples: int = 1999
) -> list[BuildingLaws]:
    """All buildings of what was found, by (profile, storeys, law)."""
    keys = dict.fromkeys((profile, n) for profile, n, _ in found)
    return [
        building_laws(profile, n, found[profile, n, CRV], found[profile, n, CAV], resamples)
        for profile, n in keys
    ]


def podium_claims(buildings: Sequence[BuildingLaws]) -> list[Claim]:
    """Each claim that these buildings can be asked for."""
    one = {(each.profile, each.storeys): each for each in buildings}
    profiles, storeys = (
        list(dict.fromkeys(each.profile for each in buildings)),
        sorted({each.storeys for each in buildings}),
    )
    pairs = [
        (one[profile, storeys[0]], one[profile, storeys[-1]])
        for profile in profiles
        if {(profile, storeys[0]), (profile, storeys[-1])} <= set(one)
    ]
    few = min(each.motions for each in buildings) < FEWEST

    def row(
        get: Callable[[BuildingLaws], float],
        form: Callable[[float], str] = lambda value: fixed(value, 3),
    ) -> str:
        return "; ".join(
            f"{profile} "
            f"{', '.join(form(get(one[profile, n])) for n in storeys if (profile, n) in one)}"
            for profile in profiles
        )

    heads = f"n = {', '.join(map(str, storeys))}"
    some = f"{100 * _OUTSIDE:.0f} %"
    within = f"in every building at most {some} of its points are outside"
    found = [
        Claim(
            "p1",
            "The distributions of the largest tilt are almost the same under both laws.",
            f"Share of points where CAV is outside the 95 % band of CRV, {heads}: "
            f"{row(lambda each: each.outside_tilt, percent)}. Distance of the "
            "distributions: "
            f"{row(lambda each: each.tilt[0])}. {_shortfall(buildings)}",
            f"supported: {within} the pointwise 95 % band of CRV; not supported: more; "
            f"undecided: fewer than {FEWEST} motions",
            _judged(all(each.outside_tilt <= _OUTSIDE for each in buildings), few),
        ),
        Claim(
            "p2",
            "Base shear is larger under CAV.",
            f"Ratio of the medians, CAV over CRV, {heads}: {row(lambda each: each.median_ratio)}.",
            "supported: the 95 % interval of the ratio is above 1 in every building; "
            "not supported: below 1 in one; else undecided",
            _sided([each.drawn[1] - 1 for each in buildings]),
        ),
    ]
    if len(storeys) > 1 and pairs:
        found.append(
            Claim(
                "p3",
                f"Most so for the stiffest building, n = {storeys[0]}.",
                f"Excess of the median shear, {heads}: "
                f"{row(lambda each: each.median_ratio - 1, percent)}.",
                f"supported: the 95 % interval of the ratio at n = {storeys[0]} less "
                f"that at n = {storeys[-1]} is above 0 in every profile; not supported: "
                "below 0 in one; else undecided",
                _sided([low.drawn[1] - high.drawn[1] for low, high in pairs]),
            )
        )
    if "flexural" in profiles and len(profiles) > 1:
        own, others = (
            one["flexural", storeys[0]],
            [one[profile, storeys[0]] for profile in profiles if profile != "flexural"],
        )
        found.append(
            Claim(
                "p4",
                "And for the flexural profile.",
                f"Ratio of the medians at n = {storeys[0]}: "
                + ", ".join(
                    f"{each.profile} {fixed(each.median_ratio, 3)}" for each in (own, *others)
                )
                + ".",
                "supported: the 95 % interval of its ratio less that of each other "
                f"profile at n = {storeys[0]} is above 0; not supported: below 0 for "
                "one; else undecided",
                _sided([own.drawn[1] - other.drawn[1] for other in others]),
            )
        )
    found.append(
        Claim(
            "p5",
            f"CAV's base shear is within the band of CRV for n = {storeys[-1]} alone.",
            f"Share of points outside, {heads}: {row(lambda each: each.outside_shear, percent)}.",
            f"supported: at most {some} of the points are outside for n = {storeys[-1]} "
            "and more for every other; not supported: otherwise; undecided: fewer than "
            f"{FEWEST} motions",
            _judged(
                all(
                    (each.outside_shear <= _OUTSIDE) == (each.storeys == storeys[-1])
                    for each in buildings
                ),
                few,
            ),
        )
    )
    if len(storeys) > 1 and pairs:
        for key, name, place, get in (
            ("p6", "tilt", 2, lambda each: each.tilt_scatter),
            ("p7", "base shear", 3, lambda each: each.shear_scatter),
        ):
            found.append(
                Claim(
                    key,
                    f"The dispersion of {name} between the laws falls with n.",
                    f"Scatter of ln(CAV/CRV), {heads}: {row(get)}.",
                    f"supported: the 95 % interval of the scatter at n = {storeys[0]} "
                    f"less that at n = {storeys[-1]} is above 0 in every profile; not "
                    "supported: below 0 in one; else undecided",
                    _sided([low.drawn[place] - high.drawn[place] for low, high in pairs]),
                )
            )
    tallest = [each for each in buildings if each.storeys == storeys[-1]]
    bounds = [wilson(round(each.still * each.motions), each.motions) for each in tallest]
    found.append(
        Claim(
            "p8",
            f"More than 15 % of the motions start no rocking for n = {storeys[-1]}.",
            f"Share that starts none, {heads}: {row(lambda each: each.still, percent)}; "
            f"95 % interval for n = {storeys[-1]}: "
            + "; ".join(
                f"{each.profile} {percent_interval(float(low), float(high))} %"
                for each, (low, high) in zip(tallest, bounds)
            )
            + ".",
            "supported: the 95 % interval (Wilson) is above 15 % in every profile; not "
            "supported: below it in one; else undecided",
            _of_intervals([(float(low) - 0.15, float(high) - 0.15) for low, high in bounds]),
        )
    )
    return found


def _shortfall(buildings: Sequence[BuildingLaws]) -> str:
    motions = min(each.motions for each in buildings)
    fallen = max(max(each.overturned) for each in buildings)
    return f"{count(motions, 'motion')}; at most {percent(fallen)} overturn."


def _judged(holds: bool, few: bool) -> str:
    return UNDECIDED if few else SUPPORTED if holds else NOT_SUPPORTED


def _sided(differences: Iterable[NDArray[Any]]) -> str:
    """Verdict on differences (resamples,) that are claimed to be positive."""
    return _of_intervals(
        [
            tuple(np.nanpercentile(one, [2.5, 97.5])) if np.isfinite(one).any() else (-1.0, 1.0)
            for one in differences
        ]
    )


def _of_intervals(intervals: Sequence[tuple[float, float]]) -> str:
    if all(low > 0 for low, _ in intervals):
        return SUPPORTED
    return NOT_SUPPORTED if any(high < 0 for _, high in intervals) else UNDECIDED
