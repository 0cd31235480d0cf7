"""Joints with two sides in full order, until the first impact: elements so large that a run takes a
second.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fecolumn.case.case import case_from_tables
from fecolumn.engines.dynamics.history import read_history
from fecolumn.simulation import run as analyse
from fecolumn.verification.joint_bodies import BELOW, TILT, H, arms, block_tables, region, rocks
from fecolumn.verification.result import Row

_SIZE, _LAST = dict(element_size_m=0.1), 0.1


def full_joint_rows() -> Iterator[Row]:
    """Tilts 0.1 s after the release; the summary's closure of each run."""
    closures = []

    def lean(above: dict, below: dict, towards: float) -> float:
        tilt, closure = _lean(above, below, towards)
        closures.append(closure)
        return tilt

    errors = [
        lean(dict(at_m=[way, 0.0, BELOW]), {}, 0.0) - rocks(*arms(way)).of(_LAST)[0]
        for way in (0.0, 1e-9, 1e-6, -1e-6, 1e-4, 1e-3, -1e-3, 1e-2, -1e-2)
    ]
    yield Row(
        "equal blocks, the upper displaced by up to 10 mm: tilt before the first "
        "impact, largest error over 0.05 rad",
        0.0,
        max(np.abs(errors)) / TILT,
        1e-4,
    )
    square, errors = dict(length_m=0.3, width_m=0.3), []
    for angle in (5.0, 45.0):
        corners = region(angle, (0.0, 0.0), (0.15, 0.15))
        edge = corners[1] - corners[0]
        tilt = lean(
            square | dict(turned_deg=angle),
            square,
            float(np.degrees(np.arctan2(-edge[0], edge[1]))),
        )
        errors.append(tilt - rocks(0.15, 0.15, (0.15**2 + H**2) / 3).of(_LAST)[0])
    yield Row(
        "square blocks, the upper turned by 5 and 45 deg, let go over an edge of their "
        "region: tilt before the impact, largest error over 0.05 rad",
        0.0,
        max(np.abs(errors)) / TILT,
        1e-4,
    )
    drum = dict(kind="tube", outer_diameter_m=0.9, wall_m=0.3, element_size_m=None)
    leans = [
        lean(drum | dict(height_m=1.6, at_m=[0.0, 0.0, BELOW]), drum, towards)
        for towards in (0.0, 45.0, 90.0, 135.0)
    ]
    yield Row(
        "equal drums: tilt 0.1 s after the release in 4 directions, largest distance "
        "from their mean over it",
        0.0,
        float(np.abs(np.array(leans) - np.mean(leans)).max() / np.mean(leans)),
        1e-6,
    )
    yield Row(
        "error of the energy balance of these over the energy moved", 0.0, max(closures), 1e-9
    )


def _lean(above: dict, below: dict, towards: float) -> tuple[float, float]:
    """Tilt [rad] 0.1 s after the release towards a direction [deg], and the error of the energy
    balance over the energy moved.
    """
    upper, lower = (
        {key: value for key, value in (_SIZE | one).items() if value is not None}
        for one in (above, below)
    )
    case = block_tables(
        "full", upper, lower, dt=1e-3, initial=dict(up=dict(tilt_rad=TILT, direction_deg=towards))
    )
    case["integration"]["duration_s"] = _LAST
    with tempfile.TemporaryDirectory() as folder:
        summary = analyse(case_from_tables(case, "case"), Path(folder) / "run", quiet=True)
        return float(
            read_history(Path(folder) / "run" / "history.h5")["body/up/tilt"][-1]
        ), summary["energy_closure_rel"]
