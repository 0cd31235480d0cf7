"""Where these benchmarks keep what they computed, and the ground motions they share with the
study.
"""

from __future__ import annotations

from pathlib import Path

from benchmarks.engines.pair import case_of
from fecolumn.motions.load import load_motion
from fecolumn.motions.record import GroundMotion

RESULTS = Path(__file__).parents[2] / "results" / "engines"


def strong_shaking(number: int, begin: float) -> GroundMotion:
    """A motion of the Lick ensemble from a share of its Arias intensity on, at the specimen's
    dt.
    """
    case = case_of(motion={"source": f"lick:{number}", "strong_part": [begin, 1.0]})
    return load_motion(case.motion, case.integration.dt_s, "benchmarks.engines")
