"""Largest values of the history of a structure's bodies, joints, links and glued joints."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.history_columns import glued_names
from fecolumn.engines.peak_acceleration import peak_acceleration, window_s
from fecolumn.engines.reduced.observe import OF_BOND, OF_LINK
from fecolumn.structures.model import LinkModel, StructureModel

# Rounding of the sum of areas that have failed, over all
_ALL = 1e-9

# Share of its yield force at which a link is said to yield that comes to it along a curve
_YIELDED = 0.9


def peaks(rows: dict[str, NDArray[Any]], structure: StructureModel) -> dict[str, Any]:
    """Of the summary: largest values of bodies, interfaces, storeys, links and glued joints by
    name, from the columns of a history.
    """

    def largest(name: str) -> float:
        values = rows[name]
        return float(
            np.abs(values).max() if values.ndim == 1 else np.linalg.norm(values, axis=1).max()
        )

    bodies = {
        part.name: dict(
            tilt_max_rad=largest(f"body/{part.name}/tilt"),
            acceleration_max_m_s2=peak_acceleration(
                rows["time"], rows[f"body/{part.name}/displacement"], rows["ground"]
            ),
            acceleration_window_s=window_s(rows["time"]),
        )
        for part in structure.parts
    }
    interfaces = {
        joint.name: dict(
            tilt_max_rad=largest(f"interface/{joint.name}/tilt"),
            rise_max_m=largest(f"interface/{joint.name}/rise"),
            slide_max_m=largest(f"interface/{joint.name}/slide"),
            residual_slide_m=float(np.hypot(*rows[f"interface/{joint.name}/slide"][-1])),
            force_max_n=largest(f"interface/{joint.name}/force"),
        )
        for joint in structure.joints
        if joint.pair < 0
    }
    storeys = {
        name[7:-6]: dict(drift_max_m=largest(name), shear_max_n=largest(f"{name[:-5]}shear"))
        for name in rows
        if name.startswith("storey/") and name.endswith("/drift")
    }
    links = {
        link.name: _peaks_of_link(
            rows["time"], {name: rows[f"link/{link.name}/{name}"] for name, _ in OF_LINK}, link
        )
        for link in structure.links
    }
    bonds = {
        name: _peaks_of_bond(rows["time"], {one: rows[f"bond/{name}/{one}"] for one, _ in OF_BOND})
        for name in glued_names(structure)
    }
    return dict(bodies=bodies, interfaces=interfaces, storeys=storeys, links=links) | (
        dict(bonds=bonds) if bonds else {}
    )


def _peaks_of_bond(time: NDArray[Any], rows: dict[str, NDArray[Any]]) -> dict[str, Any]:
    """Largest stresses of a glued joint, the share of its area that has failed, when the first and
    the last of it did, and what it has taken; from its columns.
    """
    begun, done = rows["failed"] > 0, rows["failed"] > 1 - _ALL
    return dict(
        tension_max_pa=float(rows["stress"].max()),
        shear_max_pa=float(rows["shear_stress"].max()),
        failed_share=float(rows["failed"][-1]) if not done[-1] else 1.0,
        work_j=float(rows["work"][-1]),
        first_failed_at_s=float(time[np.argmax(begun)]) if begun.any() else None,
        all_failed_at_s=float(time[np.argmax(done)]) if done.any() else None,
    )


def _peaks_of_link(
    time: NDArray[Any], rows: dict[str, NDArray[Any]], link: LinkModel
) -> dict[str, Any]:
    """Extremes of a Link's tension and of its elongation until it breaks, what it has taken, and
    when it first yielded, broke, and was slack after it had been tight; from its columns.
    """

    def first(mask: NDArray[Any]) -> float | None:
        return float(time[np.argmax(mask)]) if mask.any() else None

    tension, broken, over = (
        rows["tension"],
        rows["broken"] > 0,
        rows["elongation"] - rows["yielded"],
    )
    yielded = rows["yielded"] != 0
    if link.bends < np.inf:
        # along a curve some of it yields from the start
        stretch = np.sign(over) * np.maximum(np.abs(over) - link.slack, 0.0)
        stretch = np.where(over > 0, stretch * link.pulls, stretch * link.pushes)
        hardens = link.hardening / (1 - link.hardening) * rows["yielded"]
        yielded &= link.stiffness * np.abs(stretch - hardens) >= _YIELDED * link.yield_n
    whole = rows["elongation"][: max(1, int((~broken).sum()))]
    tight = (link.pulls & (over > link.slack)) | (link.pushes & (over < -link.slack))
    slackens = (
        ~tight
        & ~broken
        & np.logical_or.accumulate(tight)
        & (link.slack > 0 or not (link.pulls and link.pushes))
    )
    return dict(
        tension_max_n=float(tension.max()),
        tension_min_n=float(tension.min()),
        compression_max_n=max(0.0, -float(tension.min())),
        elongation_max_m=float(whole.max()),
        elongation_min_m=float(whole.min()),
        shortening_max_m=max(0.0, -float(whole.min())),
        yielded_m=float(rows["yielded"][-1]),
        work_j=float(rows["work"][-1]),
        yielded_at_s=first(yielded),
        broke_at_s=first(broken),
        slack_at_s=first(slackens),
    )
