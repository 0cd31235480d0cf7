"""What an ensemble is, in lines of text."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.schema import build
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.target import Target, agreement, time_scaled

_LABELS = {
    "pga_m_s2": ("PGA [g]", 1 / GRAVITY),
    "pgv_m_s": ("PGV [cm/s]", 100),
    "pgd_m": ("PGD [cm]", 100),
    "arias_m_s": ("Arias, x + y [m/s]", 1),
    "ds5_75_s": ("Ds5-75 [s]", 1),
    "ds5_95_s": ("Ds5-95 [s]", 1),
    "cav_m_s": ("CAV [m/s]", 1),
    "housner_m": ("Housner [m]", 1),
}


def stored_target(ensemble: Ensemble) -> tuple[Target, float] | None:
    """Target of the ensemble at the scale of its motions, with the time scale; None where it has
    none.
    """
    table = ensemble.provenance.get("target")
    if table is None:
        return None
    factor = float(ensemble.provenance.get("arguments", {}).get("time_scale", 1.0))
    return time_scaled(build(Target, table, ensemble.name, "target."), factor), factor


def report(ensemble: Ensemble, columns: dict[str, NDArray[Any]]) -> str:
    """Median, spread and agreement with the target.  columns: of ensemble_file.summary."""
    steps, lengths = np.unique(columns["dt_s"]), columns["duration_s"]
    model, seed = ensemble.provenance.get("model", "not stated"), ensemble.provenance.get("seed")
    lines = [
        f"{ensemble.name}: {len(ensemble.motions)} motions, dt {_range(steps)} s, "
        f"{_range(lengths)} s long",
        f"model: {model}" + (f", seed {seed}" if seed is not None else ""),
        f"{'':22} {'16 %':>9} {'median':>9} {'84 %':>9} {'sd of ln':>9}",
    ]
    for key, (label, factor) in _LABELS.items():
        values = factor * columns[key]
        low, middle, high = np.percentile(values, [16, 50, 84])
        spread = (
            f"{np.log(values).std(ddof=1):9.2f}"
            if len(values) > 1 and (values > 0).all()
            else f"{'-':>9}"
        )
        lines.append(f"{label:22} {low:9.4g} {middle:9.4g} {high:9.4g} {spread}")
    lines.append(
        f"PGA, PGV, PGD and Housner: {measured_along(ensemble)}; CAV: "
        f"{measured_along(ensemble, 'mean of x and y')}"
    )
    found = stored_target(ensemble)
    if found:
        rows = agreement(ensemble.motions, *found)
        lines.append(
            f"{'median against target':22} {'target':>9} {'median':>9} {'off':>9} {'allowed':>9}"
        )
        lines += [
            f"{row.name:22} {row.target:9.4g} {row.median:9.4g} "
            f"{100 * (row.median / row.target - 1):+8.1f}% "
            f"{100 * row.tolerance:8.0f}%{'' if row.within else '  missed'}"
            for row in rows
        ]
        lines.append(
            f"{sum(row.within for row in rows)} of {len(rows)} figures within what is allowed"
        )
    return "\n".join(lines)


def measured_along(ensemble: Ensemble, over_both: str = "RotD50") -> str:
    """What measures of the horizontal motion are of: RotD50, say, or the one component."""
    moved = {motion.horizontal_axes for motion in ensemble.motions}
    if moved == {(0,)} or moved == {(1,)}:
        return f"along {'xy'[moved.pop()[0]]}"
    return over_both if not moved & {(0,), (1,)} else f"{over_both}, or the only component"


def _range(values: ArrayLike) -> str:
    low, high = float(np.min(values)), float(np.max(values))
    return f"{low:.4g}" if np.isclose(low, high) else f"{low:.4g} to {high:.4g}"
