"""What the history of an analysis and its ending say, as entries of its summary."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.ending import OVERTURNED, SLID_OFF, Ending


def entries_of(rows: dict[str, Any], ending: Ending) -> dict[str, Any]:
    """Outcome, largest values and energies at the end, in SI units.

    What overturns or slides off goes further than its analysis: its largest displacement is where
    that stopped, and no peak.

    Parameters
    ----------
    rows
        datasets of the history, as of `fecolumn help outputs`.
    """
    from fecolumn.engines.dynamics.energy import TERMS

    overturned, slid_off = ending.outcome == OVERTURNED, ending.outcome == SLID_OFF
    top, slide, end = rows["u_top"], rows["slide"][-1], float(rows["time"][-1])
    lost_at = end if ending.lost_at_s is None else ending.lost_at_s
    overturned_at, slid_off_at = lost_at if overturned else None, end if slid_off else None
    deep = rows.get("penetration")  # a rigid model has none
    return dict(
        duration_s=end,
        outcome=ending.outcome,
        ended_by=ending.ended_by,
        u_max_m=float(np.hypot(top[:, 0], top[:, 1]).max()),
        u_max_censored=overturned or slid_off,
        overturned=overturned,
        overturned_at_s=overturned_at,
        overturn_time_s=overturned_at,  # its older name
        overturn_direction_deg=direction_deg(top[-1]) if overturned else None,
        slid_off=slid_off,
        slid_off_at_s=slid_off_at,
        slid_off_time_s=slid_off_at,  # its older name
        slid_off_direction_deg=direction_deg(slide) if slid_off else None,
        tilt_max_rad=float(rows["tilt"].max()),
        residual_slide_m=float(np.hypot(*slide)),
        **({"penetration_max_m": float(deep.max())} if deep is not None else {}),
        energy_j={name: float(rows[f"energy/{name}"][-1]) for name in TERMS},
    )


def direction_deg(way: NDArray[Any]) -> float:
    """Direction of a horizontal displacement from x to y [degrees]."""
    return float(np.degrees(np.arctan2(way[1], way[0])))


#: Error of the energy balance over the largest energy exchanged above which a motion is not to be
#: used unseen: engines close to 1e-10 and better where every step converges.
CLOSES = 1e-3


def unclosed_text(closure: float) -> str:
    """Warning of an energy balance with the error `closure` [-]; "" where it closes."""
    if closure <= CLOSES:
        return ""
    return (
        f"the energy balance does not close: its error is {closure:.2g} of the largest energy "
        f"exchanged, more than {CLOSES:g}; do not use this motion before you know why: compare it "
        "with one of a shorter integration.dt_s"
    )


def energy_closure(rows: dict[str, Any]) -> float:
    """Largest closure error relative to the largest energy that moved, or is held [-].

    Reference is the largest of kinetic energy, swing of the gravity energy, work of the base
    motion, and strain energy: that which a standing structure holds where nothing moves.
    """
    moved = max(
        rows["energy/kinetic"].max(),
        np.ptp(rows["energy/gravity"]),
        np.abs(rows["energy/base_work"]).max(),
        np.max(rows.get("energy/strain", 0.0)),
    )
    return float(np.abs(rows["energy/closure"]).max() / moved) if moved > 0 else 0.0
