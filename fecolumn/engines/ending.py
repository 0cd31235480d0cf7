"""How an analysis ends: what became of the column, and why the analysis stopped there."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

#: Outcomes. Only a column at rest has shown its residual slide, and only one that is not lost,
#: overturned or slid off, its peak.
AT_REST, STILL_ROCKING, OVERTURNED, SLID_OFF = "at rest", "still rocking", "overturned", "slid off"

#: Names of a share of columns: of those that overturned, and of those that overturned or slid off
#: where both are counted together.
P_OVERTURN, P_LOST = "P(overturn)", "P(lost: overturned or slid off)"

#: A column whose foot meets the edge of the base has come as near to it before as it goes in a step
#: and this share of the foot's width; else a step went astray.
EDGE_SHARE = 0.05

#: A column is at rest when its mechanical energy above gravity equilibrium is below this share of
#: the energy that lifts it onto its edge. A slender column with this energy rocks with 1/2000 of
#: its critical tilt, and as nothing feeds it, never with more again.
REST_SHARE = 1e-3

#: Tilt over the critical one from which on a body counts as one that rocks.
ROCKS = 0.02


@dataclass(frozen=True, slots=True)
class Ending:
    """How an analysis ended.

    Attributes
    ----------
    outcome
        one of the words above.
    ended_by
        what stopped the analysis, in words, with its time [s].
    lost_at_s
        when the first body was lost, None of one that ended the analysis.
    """

    outcome: str
    ended_by: str
    lost_at_s: float | None = None


def ending_text(summary: dict[str, Any]) -> str:
    """What became of the column, for a reader, from the summary of its analysis."""
    if summary["overturned"]:
        return (
            "overturned "
            f"({summary.get('ended_by') or 'at {:.3f} s'.format(summary['overturn_time_s'])})"
        )
    if lost(summary):
        return f"{SLID_OFF} ({summary['ended_by']})"
    text = (
        f"{summary.get('outcome', 'standing')}, residual slide "
        f"{1e3 * summary['residual_slide_m']:.3f} mm"
    )
    if summary.get("outcome") == STILL_ROCKING and _slides_only(summary):
        text = (
            f"still moving at {summary['duration_s']:.3f} s, never tilted by more than "
            f"{ROCKS:.0%} of its critical tilt, residual slide "
            f"{1e3 * summary['residual_slide_m']:.3f} mm"
        )
    elif summary.get("outcome") == STILL_ROCKING:
        text = (
            f"{STILL_ROCKING} at {summary['duration_s']:.3f} s with "
            f"{energy_text(summary['energy_left_j'], summary['energy_to_overturn_j'])}"
        )
    if summary.get("motion_cut_at_s") is not None:
        text += (
            f"; the motion was cut at {summary['motion_cut_at_s']:g} s, by integration.duration_s"
        )
    return text


def _slides_only(summary: dict[str, Any]) -> bool:
    """Whether what moves at the end has hardly tilted, so that no energy to overturn is beside
    it.
    """
    tilt, critical = summary.get("tilt_max_rad"), summary.get("critical_tilt_rad")
    if tilt is None or not critical:
        return False
    others = (body["tilt_max_rad"] for body in summary.get("bodies", {}).values())
    return bool(max([tilt, *others]) < ROCKS * critical)


def energy_text(left: float, barrier: float | None) -> str:
    """Energy left [J] beside that which overturns a column, or the weakest part of a structure,
    slowly [J], None or 0 where that is not known: what moves may have more, and all of a structure
    has.
    """
    if not barrier:
        return f"{left:.3g} J"
    if left <= barrier:
        return f"{left:.3g} J of the {barrier:.3g} J to overturn"
    return f"{left:.3g} J, more than the {barrier:.3g} J that overturn it slowly"


def cut_text(file: Path | str, end_s: float, motion_s: float) -> str:
    """Warning of a motion that is not analysed to its end."""
    return (
        f"{file}: integration.duration_s = {end_s:g} s cuts the motion short, which "
        f"lasts {motion_s:g} s; without integration.duration_s "
        "the whole motion is analysed"
    )


def cut_short(summaries: Iterable[dict[str, Any]]) -> str:
    """How many of some analyses ended within their motion, and what that means, from their
    summaries; "" where none did.
    """
    summaries = list(summaries)
    ends = [
        summary["motion_cut_at_s"]
        for summary in summaries
        if summary.get("motion_cut_at_s") is not None and not lost(summary)
    ]
    if not ends:
        return ""
    low, high = min(ends), max(ends)
    return (
        f"{len(ends)} of {len(summaries)} analyses cut their motion short, at "
        f"{low:g}{f' to {high:g}' if high > low else ''} s by "
        "integration.duration_s: peaks and outcomes are of that part alone"
    )


def lost(summary: dict[str, Any]) -> bool:
    """Whether the column overturned or slid off its base: what its top did after that is not
    known.
    """
    return bool(summary["overturned"] or summary.get("slid_off"))


def peak_text(summary: dict[str, Any]) -> str:
    """Largest top displacement of an analysis, for a reader; of a column that is lost it is only
    where the analysis stopped.
    """
    return f"u_max {'> ' if lost(summary) else ''}{1e3 * summary['u_max_m']:.3f} mm"
