"""Where the time of an analysis goes, by the parts a reader knows."""

from __future__ import annotations

import contextlib
import cProfile
import pstats

# (file ending, function): part; each is counted with all it calls, and none calls another
PARTS = {
    ("fem/effective.py", "solve"): "solves with the effective matrix",
    ("fem/foot.py", "position"): "filtered positions of the foot",
    ("fem/foot.py", "acceleration"): "motion by contact forces",
    ("fem/foot.py", "displacement"): "motion by contact forces",
    ("dynamics/interface.py", "solve"): "contact problem",
    ("dynamics/interface.py", "begin_step"): "rolling of the rim",
    ("fem/composite.py", "internal"): "internal forces and energy",
    ("fem/total_lagrangian.py", "tangent"): "tangent",
}


@contextlib.contextmanager
def shares():
    """Dictionary of part: share of the time in Stepper.step [-], filled when the block ends."""
    result = {}
    profile = cProfile.Profile()
    profile.enable()
    try:
        yield result
    finally:
        profile.disable()
        stats = pstats.Stats(profile).stats
        total = next(
            cumulative
            for (file, _, name), (_, _, _, cumulative, _) in stats.items()
            if file.endswith("dynamics/stepper.py") and name == "step"
        )
        for (file, _, name), (_, _, _, cumulative, _) in stats.items():
            for (ending, function), part in PARTS.items():
                if file.endswith(ending) and name == function:
                    result[part] = result.get(part, 0.0) + cumulative / total
        result["products with the mass, everything else"] = 1 - sum(result.values())
