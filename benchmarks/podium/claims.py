"""What the paper claims of the two laws of impact, as numbers and yes or no.

Both laws see the same motions: differences are judged in pairs (`paired_kolmogorov_smirnov`). With thousands of motions the least difference is
significant; so every claim has its size beside its p-value, and "alike" is told by the band that the paper itself draws.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.rocking.podium_impact import CAV, CRV
from fecolumn.statistics.bands import greenwood
from fecolumn.statistics.two_sample import paired_kolmogorov_smirnov

#: Tilt over alpha below which a motion starts no rocking
_STILL = 1e-6


@dataclass(frozen=True, slots=True)
class Building:
    """Both laws side by side for one building.

    Attributes:
        profile, storeys: which. motions: number.
        still: share of motions that start no rocking. overturned: shares under CRV and CAV. disagree: share overturned under one law alone.
        tilt, shear: (D, p) of the paired Kolmogorov-Smirnov test between the laws. outside_tilt, outside_shear: share of the CRV curve's
            points where CAV's is outside its pointwise 95 % band.
        shear_ratio: median of base shear CAV over CRV, of motions that rock and overturn under neither. median_ratio: of the medians.
        tilt_scatter, shear_scatter: half the difference of the 84th and 16th percentiles of ln(CAV/CRV), of the same motions.
    """

    profile: str
    storeys: int
    motions: int
    still: float
    overturned: tuple[float, float]
    disagree: float
    tilt: tuple[float, float]
    shear: tuple[float, float]
    outside_tilt: float
    outside_shear: float
    shear_ratio: float
    median_ratio: float
    tilt_scatter: float
    shear_scatter: float


def building(profile: str, storeys: int, crv, cav, resamples: int = 1999) -> Building:
    """Both laws compared; crv, cav: of `ensemble.gathered`."""
    a, b = crv["tilt"], cav["tilt"]
    both = np.isfinite(a) & np.isfinite(b)
    rocking = both & (a > _STILL) & (b > _STILL)
    shears = crv["shear"][both], cav["shear"][both]
    ratio = {name: np.log(cav[name][rocking] / crv[name][rocking]) for name in ("tilt", "shear")}
    tests = {name: paired_kolmogorov_smirnov(*pair, resamples=resamples) for name, pair in (("tilt", (a, b)), ("shear", shears))}
    return Building(
        profile, storeys, len(a), float((a <= _STILL).mean()), (float(np.isinf(a).mean()), float(np.isinf(b).mean())), float((np.isinf(a) != np.isinf(b)).mean()),
        (tests["tilt"].statistic, tests["tilt"].p), (tests["shear"].statistic, tests["shear"].p), _outside(a, b), _outside(*shears),
        float(np.exp(np.median(ratio["shear"]))), float(np.median(shears[1]) / np.median(shears[0])), *(_spread(ratio[name]) for name in ("tilt", "shear")))


def _outside(a, b) -> float:
    """Share of a's values where the distribution of b is outside the band of a's."""
    x = np.unique(a[np.isfinite(a)])
    cdf, other = (np.searchsorted(np.sort(one), x, side="right") / len(one) for one in (a, b))
    low, high = greenwood(cdf, len(a), 0.95)
    return float(((other < low) | (other > high)).mean())


def _spread(logs) -> float:
    return float(np.diff(np.percentile(logs, [16, 84]))[0] / 2)


def compared(found, resamples: int = 1999) -> list[Building]:
    """All buildings of `ensemble.gathered`."""
    keys = dict.fromkeys((profile, n) for profile, n, _ in found)
    return [building(profile, n, found[profile, n, CRV], found[profile, n, CAV], resamples) for profile, n in keys]


def verdicts(buildings) -> list[tuple[str, bool, str]]:
    """Each claim, whether it holds here, and by what."""
    one = {(each.profile, each.storeys): each for each in buildings}
    profiles, storeys = dict.fromkeys(each.profile for each in buildings), sorted({each.storeys for each in buildings})

    def row(get, places=3):
        return "; ".join(f"{profile} {', '.join(f'{get(one[profile, n]):.{places}f}' for n in storeys)}" for profile in profiles)

    def falls(get):
        return all(get(one[profile, storeys[-1]]) < get(one[profile, storeys[0]]) for profile in profiles)

    excess = {key: each.median_ratio for key, each in one.items()}
    largest = max(excess, key=excess.get)
    heads = f"n = {', '.join(map(str, storeys))}: "
    return [
        ("tilts are alike under both laws: CAV within the CRV band nearly everywhere (5 % of its points at most outside)",
         all(each.outside_tilt <= 0.05 for each in buildings), f"D, {heads}{row(lambda each: each.tilt[0])}; share outside {row(lambda each: each.outside_tilt)}"),
        ("base shear is larger under CAV (median, every building)", all(value > 1 for value in excess.values()), f"{heads}{row(lambda each: each.median_ratio)}"),
        ("most so for the stiffest building, n = 3", largest[1] == storeys[0] and all(excess[profile, storeys[0]] > excess[profile, storeys[-1]] for profile in profiles),
         f"largest for {largest[0]}, n = {largest[1]}"),
        ("and for the flexural profile", all(excess["flexural", n] >= max(excess[profile, n] for profile in profiles) for n in storeys[:1]),
         f"n = {storeys[0]}: " + ", ".join(f"{profile} {excess[profile, storeys[0]]:.3f}" for profile in profiles)),
        ("CAV's shear is within the CRV band only for n = 9", all((one[profile, n].outside_shear <= 0.05) == (n == storeys[-1]) for profile in profiles for n in storeys),
         f"share outside, {heads}{row(lambda each: each.outside_shear)}"),
        ("dispersion between the laws falls with n: tilt", falls(lambda each: each.tilt_scatter), f"scatter of ln(CAV/CRV), {heads}{row(lambda each: each.tilt_scatter)}"),
        ("dispersion between the laws falls with n: base shear", falls(lambda each: each.shear_scatter), f"{heads}{row(lambda each: each.shear_scatter)}"),
        ("more than 15 % of the motions start no rocking for n = 9", all(one[profile, storeys[-1]].still > 0.15 for profile in profiles), f"{heads}{row(lambda each: each.still)}"),
    ]
