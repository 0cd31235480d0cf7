"""The moment of internal forces in a step, compiled: one pass over the nodes in place of a dozen arrays."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit


@njit(alone=True)
def moment_in_step(first_arms, first_forces, first_turn, last_arms, last_forces, last_turn, arms):
    """Moment (3,) [N m] of the mean of forces (n, 3) at start and end of a step, each turned by its (3, 3), about the means of their arms (n, 3), which are filled in."""
    moment, force = np.zeros(3), np.zeros(3)
    for i in range(len(arms)):
        for a in range(3):
            arm = push = 0.0
            for b in range(3):
                arm += first_turn[a, b] * first_arms[i, b] + last_turn[a, b] * last_arms[i, b]
                push += first_turn[a, b] * first_forces[i, b] + last_turn[a, b] * last_forces[i, b]
            arms[i, a], force[a] = arm / 2, push / 2
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            moment[a] += arms[i, b] * force[c] - arms[i, c] * force[b]
    return moment
