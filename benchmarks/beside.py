"""Two settings, or programs, on the same motions; and tables as text."""

from __future__ import annotations

import numpy as np

from fecolumn.engines.ending import lost
from fecolumn.statistics.ecdf import censored, percentile, proportion_interval
from fecolumn.statistics.flips import contingency, mcnemar
from fecolumn.statistics.two_sample import paired_kolmogorov_smirnov

#: Heads of `share_cells`
SHARE_HEAD = "motions", "overturned", "P [%]", "95 % interval [%]", "median u_max [mm]"


def share_cells(runs: dict) -> tuple[str, ...]:
    """Motions, how many overturn, their share with its interval, and the median peak, of summaries
    by motion.
    """
    each, n = list(runs.values()), len(runs)
    over = sum(bool(run["overturned"]) for run in each)
    low, high = proportion_interval(over, n)
    u, off = np.array([run["u_max_m"] for run in each]), np.array([lost(run) for run in each])
    median = percentile(u, off, fraction=0.5)
    return (
        str(n),
        str(over),
        f"{100 * over / n:.1f}",
        f"{100 * low:.1f} to {100 * high:.1f}",
        f"{1e3 * median:.1f}" if np.isfinite(median) else "overturn",
    )


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
