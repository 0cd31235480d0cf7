"""Two settings, or programs, on the same motions; and tables as text."""

from __future__ import annotations

import numpy as np

from fecolumn.engines.ending import lost
from fecolumn.statistics.ecdf import censored
from fecolumn.statistics.flips import contingency, mcnemar
from fecolumn.statistics.two_sample import paired_kolmogorov_smirnov


def compared(first: dict, second: dict) -> tuple[float, float, int, int, float]:
    """D and its p, motions that overturn in the first alone and in the second alone, McNemar's p;
    of summaries by motion.
    """
    common = [motion for motion in first if motion in second]
    sides = [[runs[motion] for motion in common] for runs in (first, second)]
    distance = paired_kolmogorov_smirnov(
        *(
            censored(
                np.array([run["u_max_m"] for run in side]), np.array([lost(run) for run in side])
            )
            for side in sides
        )
    )
    table = contingency(*([bool(run["overturned"]) for run in side] for side in sides))
    return distance.statistic, distance.p, int(table[1, 0]), int(table[0, 1]), mcnemar(table)


def told(p: float) -> str:
    """A probability."""
    return f"{p:.3f}" if p >= 0.001 else "<0.001"


def pair_cells(first: dict, second: dict) -> tuple[str, ...]:
    """As `compared`, in words; dashes where they have no motion in common."""
    if not set(first) & set(second):
        return ("-",) * 5
    distance, p, alone, other, flips = compared(first, second)
    return f"{distance:.3f}", told(p), str(alone), str(other), told(flips)


def cost(runs) -> str:
    """Mean processor time [s] of some summaries, of those that know it: an analysis that went on
    after a stop does not.
    """
    known = [run["cpu_s"] for run in runs if run.get("cpu_s") is not None]
    return f"{np.mean(known):.2g}" if known else "-"


def markdown(head, rows) -> str:
    """A table as text."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)
