"""One test: the rock under the table's motion, and whether it overturned."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

from benchmarks.shake_table.campaign import (
    SAMPLING_HZ,
    SOURCES,
    Campaign,
    TableView,
    Test,
    table_motion,
)
from benchmarks.shake_table.rock import OVERTURNED, Stone, body_of, engine_of
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.cuts import StepFailed
from fecolumn.engines.dynamics.gravity import NoEquilibrium
from fecolumn.engines.reduced.observe import ENERGY, WIDTH

#: The table is quiet below this [m/s2]; of its quiet beginning and end this much is computed [s].
QUIET, BEFORE_S, AFTER_S = 0.02 * GRAVITY, 0.5, 3.0
#: Columns of the table of tests.
COLUMNS = (
    "test",
    "pga_g",
    "pgv_pga_s",
    "measured",
    "computed",
    "peak_tilt_deg",
    "at_s",
    "steps",
    "closure_rel",
    "cpu_s",
    "failed",
)


def ground_of(acceleration: np.ndarray, dt: float) -> np.ndarray:
    """Ground accelerations (k, 3) [m/s2] at the ends of steps of dt [s], from samples (n,) along x
    at SAMPLING_HZ, without the quiet time around.
    """
    loud = np.flatnonzero(np.abs(acceleration) > QUIET)
    if not len(loud):
        return np.zeros((1, 3))
    first, last = max(loud[0] / SAMPLING_HZ - BEFORE_S, 0.0), loud[-1] / SAMPLING_HZ + AFTER_S
    at = first + dt * np.arange(1, int(np.ceil((last - first) / dt)) + 1)
    ground = np.zeros((len(at), 3))
    ground[:, 0] = np.interp(
        at, np.arange(len(acceleration)) / SAMPLING_HZ, acceleration, right=0.0
    )
    return ground


def run(campaign: Campaign, test: Test, stone: Stone, dt: float, view: TableView = SOURCES) -> dict:
    """Row of COLUMNS of a test; `computed` is None where the engine failed, `failed` says how.

    measured, computed: 1 overturned, 0 stood; at_s: when the tilt from rest passed OVERTURNED, from
    the beginning of the computation; closure_rel: largest error of the energy balance over the
    largest kinetic energy.
    """
    row = {
        "test": test.number,
        "pga_g": test.pga,
        "pgv_pga_s": test.pgv_pga,
        "measured": int(test.overturned),
        "computed": None,
        "peak_tilt_deg": None,
        "at_s": None,
        "steps": 0,
        "closure_rel": None,
        "cpu_s": None,
        "failed": "",
    }
    began = time.process_time()
    engine = None
    try:
        engine = engine_of(body_of(campaign.scan, stone), stone, dt)
        rows, ended = engine.advance(ground_of(table_motion(campaign.file(test), view), dt))
        row["computed"] = int(ended)
    except (NoEquilibrium, StepFailed) as error:
        rows = engine.made if engine is not None else np.zeros((0, WIDTH))
        row["failed"] = str(error)
    if len(rows):
        tilt = np.degrees(rows[:, 4])
        row.update(
            peak_tilt_deg=float(tilt.max()),
            steps=len(rows),
            closure_rel=float(np.abs(rows[:, WIDTH - 1]).max() / max(rows[:, ENERGY].max(), 1e-12)),
        )
        if tilt.max() > np.degrees(OVERTURNED):
            row["at_s"] = dt * (1 + int(tilt.argmax()))
    row["cpu_s"] = time.process_time() - began
    return row


def folder_name(test: Test, draw: int | None = None) -> Path:
    """File of a test's row below the output folder, of a draw of `uncertain` where one is named."""
    folder = Path("tests") if draw is None else Path("draws") / f"{draw:03d}"
    return folder / f"{test.number:03d}.json"
