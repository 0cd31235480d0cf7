"""The table of outcomes: its data dictionary, and what made it."""

from __future__ import annotations

from datetime import date
from pathlib import Path

from benchmarks.outcomes.bodies import ELASTIC, RIGID
from benchmarks.outcomes.models import BLOCK, ROLLING, SAFE
from benchmarks.outcomes.motions import FAMILIES
from benchmarks.tables import commit, this_machine
from fecolumn import __version__
from fecolumn.engines.ending import AT_REST, OVERTURNED, SLID_OFF, STILL_ROCKING
from fecolumn.foundation.sources import PHYSICS
from fecolumn.study.results.outcomes import TableColumn, write_outcomes

COLUMNS = {
    "model": TableColumn(
        "planar block: Housner's rigid block, shaken along x, does not slide; rolling column: "
        "rigid cylinder that rolls on its rim, does not slide; rigid body, elastic body: contact "
        "and friction in three dimensions",
        words=(BLOCK, ROLLING, RIGID, ELASTIC),
    ),
    "shape": TableColumn(
        "of the body, homogeneous of 2500 kg/m3, on a flat ground", words=("block", "cylinder")
    ),
    "width_m": TableColumn("side of a block's square foot, or diameter", "m"),
    "height_m": TableColumn("of the body", "m"),
    "slenderness_rad": TableColumn("alpha: angle whose tangent is width over height", "rad"),
    "p_rad_s": TableColumn(
        "frequency parameter sqrt(m g R / I_O) about an edge of the foot", "rad/s"
    ),
    "friction": TableColumn("Coulomb coefficient; nan of models that do not slide"),
    "youngs_modulus_pa": TableColumn("of an elastic body; nan of rigid ones", "Pa"),
    "restitution": TableColumn(
        "angular velocity after over before an impact of a planar block, rate of tilt where a "
        "rolling column passes upright; nan of bodies with contact, whose impacts are plastic at "
        "each point"
    ),
    "motion_family": TableColumn(
        "near fault: pulse on a stochastic part; lick: synthetic motions of the Lick ensemble at "
        "three time scales; pulse: closed forms",
        words=FAMILIES,
    ),
    "motion": TableColumn("number of the motion: equal numbers are one motion, maybe scaled"),
    "scale": TableColumn("factor on the motion's accelerations"),
    "pulse_period_s": TableColumn("of the motion's pulse; nan where it has none", "s"),
    "pga_m_s2": TableColumn("PGA of what shook it: RotD50, of a planar block along x", "m/s2"),
    "pgv_m_s": TableColumn("PGV likewise", "m/s"),
    "pgd_m": TableColumn("PGD likewise, integrated from rest", "m"),
    "arias_m_s": TableColumn("Arias intensity of both components", "m/s"),
    "ds5_75_s": TableColumn("time between 5 and 75 % of it", "s"),
    "ds5_95_s": TableColumn("time between 5 and 95 % of it", "s"),
    "cav_m_s": TableColumn("cumulative absolute velocity, geometric mean of x and y", "m/s"),
    "housner_m": TableColumn("Housner's spectrum intensity, 0.1 to 2.5 s, 5 % damping", "m"),
    "outcome": TableColumn(
        "safe: of the first two models, did not overturn; at rest or still rocking 2 s after the "
        "motion; overturned; slid off",
        words=(SAFE, AT_REST, STILL_ROCKING, OVERTURNED, SLID_OFF),
    ),
    "peak_over_critical": TableColumn("largest tilt over the critical one; a bound where censored"),
    "peak_displacement_m": TableColumn("of the top's centre; a bound where censored", "m"),
    "residual_slide_m": TableColumn("of the foot at the end; nan of models that do not slide", "m"),
    "impacts": TableColumn("that the model counts; ways of counting differ between models"),
    "censored": TableColumn("true: it was lost, and its peaks are only lower bounds"),
}


def write(path: Path, rows: list[dict], command: str) -> None:
    """Write the table, and what makes it."""
    made = dict(
        command=command,
        version=__version__,
        physics=PHYSICS,
        commit=commit(),
        date=date.today().isoformat(),
        machine=this_machine(),
        analyses=len(rows),
    )
    write_outcomes(path, rows, COLUMNS, made)
