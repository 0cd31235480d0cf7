"""Section: a podium's two laws of impact on the same motions, and the claims of their paper."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.model_sections import CAV, CRV
from fecolumn.pictures.figures.podium_figure import podium_figure
from fecolumn.study.report.claim import Claim, ClaimList
from fecolumn.study.report.document import PageBlock, PageColumn, PageSection, PageTable, Paragraph
from fecolumn.study.report.gallery import Gallery
from fecolumn.study.report.notation import count, fixed, p_value, percent
from fecolumn.study.report.podium_claims import (
    BuildingLaws,
    BuildingResponse,
    compared,
    podium_claims,
)
from fecolumn.study.report.sweep import Sweep, common_motions

LAW, STOREYS, PROFILE = "podium.impact", "podium.storeys", "podium.profile"
AUTHORS = "Bantilas, Kavvadias and Vasiliadis"
# Of a summary's peaks, each with its name before version 0.11
_TILT = ("tilt_over_alpha", "tilt over alpha [-]")
_SHEAR = ("base_shear_over_v_st", "base shear over V_st [-]")
_DEFAULTS = {STOREYS: 3, PROFILE: "shear"}


def podium(sweep: Sweep, gallery: Gallery) -> PageSection | None:
    """The section; None where the study does not vary the law of a podium's impact, or varies more
    than its building.
    """
    if LAW not in sweep.varied or not set(sweep.varied) <= {LAW, STOREYS, PROFILE}:
        return None
    found = responses(sweep)
    if not found:
        return None
    buildings = compared(found, resamples=999)
    claims = podium_claims(buildings)
    text = (
        f"{AUTHORS} ran 3500 near-fault synthetics through nine buildings on a rocking "
        "storey under two laws of what an impact does to the floors: constant relative "
        "velocity "
        "(CRV) and constant absolute velocity (CAV). [[laws]] sets both beside each "
        "other for the buildings of this study, [[tilts]] and [[shears]] show the "
        "distributions. What follows judges each finding by a rule stated beforehand; "
        "motions drawn again give the intervals."
    )
    blocks: list[PageBlock] = [
        Paragraph(text),
        gallery.draw(
            "tilts",
            "Largest tilt over the slenderness; what overturns lies beyond the axis.",
            podium_figure,
            found,
            "tilt",
            r"$\theta_{\max}/\alpha$",
            (0.0, 1.05),
        ),
        gallery.draw(
            "shears",
            "Largest base shear over that at uplift in a steady acceleration, of "
            "motions that overturn the podium under neither law.",
            podium_figure,
            found,
            "shear",
            r"$V_{\max}/V_{st}$",
            _limits(found),
        ),
        _table(buildings),
        *_verdicts(claims),
    ]
    return PageSection("Two laws of impact", blocks)


def responses(sweep: Sweep) -> dict[tuple[str, int, str], dict[str, NDArray[Any]]]:
    """Tilt over alpha, inf where overturned, and shear over V_st, by (profile, storeys, law), of
    the motions that both laws and all buildings have.
    """
    own = sweep.case.get("podium") or {}
    there = [setting for setting in sweep.done if setting.values.get(LAW) in (CRV, CAV)]
    motions = common_motions(there) if there else []
    found = {}
    for setting in there:
        building = tuple(
            setting.values.get(key, own.get(key.partition(".")[2]) or _DEFAULTS[key])
            for key in (PROFILE, STOREYS)
        )
        runs = [setting.runs[motion] for motion in motions]
        tilts, shears = ([_peak(run, names) for run in runs] for names in (_TILT, _SHEAR))
        if None in tilts:
            return {}
        fallen = np.array([bool(run["overturned"]) for run in runs])
        found[*building, setting.values[LAW]] = dict(
            tilt=np.where(fallen, np.inf, tilts),
            shear=np.array(shears),
        )
    return (
        {
            key: values
            for key, values in found.items()
            if {(*key[:2], CRV), (*key[:2], CAV)} <= set(found)
        }
        if len(motions) > 1
        else {}
    )


def _peak(run: dict[str, Any], names: tuple[str, ...]) -> Any:
    """The peak of a summary that has one of these names; None where none has."""
    peaks = run.get("peaks") or {}
    return next((peaks[name] for name in names if name in peaks), None)


def _limits(found: Mapping[tuple[str, int, str], BuildingResponse]) -> tuple[float, float]:
    """Between which nearly all shears of motions lie that do not overturn, in halves."""
    shears = [one["shear"][np.isfinite(one["tilt"])] for one in found.values()]
    low, high = (np.percentile(np.concatenate(shears), share) for share in (1, 99))
    return float(np.floor(2 * low) / 2), float(np.floor(2 * high) / 2 + 0.5)


def _thousandths(value: float) -> str:
    return fixed(value, 3)


def _table(buildings: list[BuildingLaws]) -> PageTable:
    columns = (
        PageColumn("profile", "profile", text=True),
        PageColumn("storeys", "storeys"),
        PageColumn("motions", "motions"),
        PageColumn("still", "start no rocking", percent),
        PageColumn("overturned_crv", "over\N{SOFT HYPHEN}turned, CRV", percent),
        PageColumn("overturned_cav", "over\N{SOFT HYPHEN}turned, CAV", percent),
        PageColumn("distance_tilt", "D, tilt", _thousandths),
        PageColumn("p_tilt", "p", p_value),
        PageColumn("distance_shear", "D, shear", _thousandths),
        PageColumn("p_shear", "p", p_value),
        PageColumn("median_ratio", "median shear, CAV over CRV", _thousandths),
    )
    rows = [
        (
            one.profile,
            one.storeys,
            one.motions,
            one.still,
            *one.overturned,
            *one.tilt,
            *one.shear,
            one.median_ratio,
        )
        for one in buildings
    ]
    return PageTable(
        "laws",
        columns,
        rows,
        "Both laws on the same motions. D and p: paired Kolmogorov-Smirnov test; "
        "shears of motions that overturn the podium under neither law.",
    )


def _verdicts(claims: list[Claim]) -> list[PageBlock]:
    columns = (
        PageColumn("claim", "claim", text=True),
        PageColumn("paper", "the paper’s finding", text=True),
        PageColumn(
            "verdict", "here", lambda verdict: verdict.replace(" ", "\N{NO-BREAK SPACE}"), text=True
        ),
    )
    table = PageTable(
        "verdicts",
        columns,
        [(claim.key, claim.paper, claim.verdict) for claim in claims],
        f"{count(len(claims), 'finding')} of {AUTHORS} and this study’s verdicts.",
    )
    return [table, ClaimList(claims, AUTHORS)]
