"""The laws of contact, Signorini's and Coulomb's: what they ask of forces, slips and gaps, and how
far forces are from them.
"""

from __future__ import annotations

import numpy as np

from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


@njit
def in_cone(x: float, y: float, normal: float, friction: float) -> tuple[float, float, float]:
    """Coulomb's projection of a trial force: its normal part not below 0, its tangential part not
    above friction times that.
    """
    normal = max(0.0, normal)
    length = np.sqrt(x * x + y * y)
    if length > friction * normal:
        share = friction * normal / length
        return x * share, y * share, normal
    return x, y, normal


@njit
def law_error(
    r0: float,
    r1: float,
    r2: float,
    s0: float,
    s1: float,
    s2: float,
    stiffness: float,
    friction: float,
) -> float:
    """Violation of the contact laws by a force r and a slip and gap s [m]: distance of r from the
    projection of r - stiffness s, over stiffness.

    Zero exactly when gap >= 0, r_n >= 0, r_n gap = 0, |r_t| <= friction r_n and slip is opposed by
    r_t.
    """
    x, y, normal = in_cone(r0 - stiffness * s0, r1 - stiffness * s1, r2 - stiffness * s2, friction)
    return np.sqrt((r0 - x) ** 2 + (r1 - y) ** 2 + (r2 - normal) ** 2) / stiffness


@njit
def violation(relative: Array, forces: Array, friction: Array, rho: Array) -> float:
    """Largest violation of the contact laws [m], see `law_error`, by forces (n, 3) under slips and
    gaps (n, 3); rho: (n,) stiffness by which it is measured [N/m].
    """
    worst = 0.0
    for i in range(len(forces)):
        worst = max(
            worst,
            law_error(
                forces[i, 0],
                forces[i, 1],
                forces[i, 2],
                relative[i, 0],
                relative[i, 1],
                relative[i, 2],
                rho[i],
                friction[i],
            ),
        )
    return worst
