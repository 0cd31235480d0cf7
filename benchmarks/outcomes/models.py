"""Analyses by models of rigid bodies that do not slide: the planar block and the rolling column."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.outcomes.draws import Drawn, drawn
from benchmarks.outcomes.motions import stored
from fecolumn.case.model_sections import WobblingModel
from fecolumn.engines.ending import OVERTURNED
from fecolumn.engines.rocking.impact import housner_restitution
from fecolumn.engines.rocking.swing import rock_all
from fecolumn.engines.rocking.swing_equations import row_of_block
from fecolumn.engines.rocking.swing_motion import IMPACT_COUNT, PEAK_TILT
from fecolumn.engines.rocking.wobbling import Wobbling
from fecolumn.motions.processing import scale

BLOCK, ROLLING = "planar block", "rolling column"
SAFE = "safe"  # of what did not overturn: whether it is at rest is not asked
#: Followed after a motion, of a rolling column [s]; what is upright within this share of its
#: critical tilt has not moved.
FREE_S, STILL = 3.0, 1e-9


def planar_blocks(file: Path, part: int, count: int) -> list[dict]:
    """Rows of planar rocking blocks (Housner 1963), shaken along x, until nothing can overturn
    them any more.
    """
    ensemble = stored(file)
    bodies = [replace(one, round=False) for one in drawn(BLOCK, part, count, ensemble, True)]
    grounds = [
        np.column_stack([motion.acceleration[:, 0], np.zeros(len(motion.acceleration))])
        for motion in ensemble.motions
    ]
    kept = [min(one.restitution * housner_restitution(one.slenderness), 1.0) for one in bodies]
    found = rock_all(
        grounds,
        [motion.dt for motion in ensemble.motions],
        [one.motion for one in bodies],
        [one.scale for one in bodies],
        np.array(
            [
                row_of_block(one.slenderness, one.frequency, restitution)
                for one, restitution in zip(bodies, kept)
            ]
        ),
        threads=1,
    )
    rows = []
    for one, restitution, (peak, impacts) in zip(bodies, kept, found[:, [PEAK_TILT, IMPACT_COUNT]]):
        fell = math.isinf(peak)
        rows.append(
            one.columns(ensemble, True)
            | _response(one, one.slenderness if fell else peak, one.slenderness, fell)
            | {
                "model": BLOCK,
                "slenderness_rad": one.slenderness,
                "p_rad_s": one.frequency,
                "restitution": restitution,
                "impacts": int(impacts),
            }
        )
    return rows


def rolling_columns(file: Path, part: int, count: int) -> list[dict]:
    """Rows of rigid cylinders that roll on their rims, without loss but where they pass upright."""
    ensemble = stored(file)
    rows = []
    for one in drawn(ROLLING, part, count, ensemble, False):
        one = replace(one, round=True)
        section = WobblingModel(outer_diameter_m=one.width, height_m=one.height)
        model = Wobbling.of_section(section, "outcomes")
        motion = scale(ensemble.motions[one.motion], one.scale)
        response = model.respond(motion, free_s=FREE_S)
        rows.append(
            one.columns(ensemble, False)
            | _response(
                one,
                min(float(response.tilt.max()), model.critical_tilt),
                model.critical_tilt,
                response.overturned,
            )
            | {
                "model": ROLLING,
                "slenderness_rad": model.slenderness,
                "p_rad_s": model.frequency,
                "restitution": float(model.restitution),
                "impacts": len(response.impact_times),
            }
        )
    return rows


def _response(one: Drawn, peak: float, critical: float, fell: bool) -> dict:
    """The top moves by H sin(tilt) + W/2 (1 - cos(tilt)) while the edge stays where it is."""
    return {
        "outcome": OVERTURNED if fell else SAFE,
        "peak_over_critical": peak / critical,
        "peak_displacement_m": one.height * math.sin(peak) + one.width / 2 * (1 - math.cos(peak)),
        "censored": fell,
    }
