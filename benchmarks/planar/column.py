"""Column of seven drums and a capital under a pulse of the ground: which accelerations overturn it.

The ground accelerates by +a for tp, then -a/2 for 2 tp, then rests. What overturns is not monotone
in a near tp = 0.34 s, so that a grid is scanned.
"""

from __future__ import annotations

import numpy as np

from benchmarks.planar.advance import History, advance
from benchmarks.planar.bodies import GRAVITY
from benchmarks.planar.structures import tapering_column

#: By tp [s]: accelerations [g] of the scan
SCANS = {
    0.1: np.arange(3.96, 4.501, 0.02),
    0.34: np.concatenate([np.arange(0.42, 0.521, 0.005), np.arange(0.74, 0.781, 0.005)]),
    0.5: np.arange(0.245, 0.2601, 0.001),
    1.0: np.arange(0.2, 0.2101, 0.001),
}
#: Least a [g] by UDEC, HybriDFEM and LMGC90 (the fourth paper of HybriDFEM)
OTHERS = {
    0.1: (3.6, 4.16, 4.3),
    0.34: (0.46, 0.39, 0.44),
    0.5: (0.27, 0.25, 0.25),
    1.0: (0.20, 0.21, 0.21),
}
#: After the pulse [s]
_REST = 6.0


def pulse(a: float, tp: float, dt: float, rest: float = _REST) -> np.ndarray:
    """Accelerations [m/s2] at the ends of steps of dt [s]; a in g.

    The mean where they jump, so that straight lines have the same area.
    """
    k, first, last = np.arange(round((3 * tp + rest) / dt) + 1), round(tp / dt), round(3 * tp / dt)
    level = np.select([k < first, k == first, k < last, k == last], [1.0, 0.25, -0.5, -0.25], 0.0)
    return a * GRAVITY * level


def pushed(a: float, tp: float, dt: float = 1e-4, every: int = 10) -> History:
    """Motion of the column under a pulse."""
    return advance(tapering_column(), pulse(a, tp, dt), dt, every=every)


def windows(accelerations, fallen) -> str:
    """Accelerations [g] of a scan that overturn, runs of neighbours in one: "0.435-0.445, from
    0.757".
    """
    words, run = [], []
    for number, (a, fell) in enumerate(zip(accelerations, fallen)):
        if fell:
            run.append(a)
        if run and (not fell or number == len(accelerations) - 1):
            words.append(
                f"from {run[0]:.4g}"
                if fell
                else f"{run[0]:.4g}"
                if len(run) == 1
                else f"{run[0]:.4g}-{run[-1]:.4g}"
            )
            run = []
    return ", ".join(words) or "none"
