"""Restitution: what of the impulse of a plastic impact is given once more."""

from __future__ import annotations

import numpy as np

from fecolumn.foundation._compiled import njit


@njit
def returned_share(taken: float, arrived: float, square: float) -> float:
    """Share of the impulses E Q that is given back: all, less where contact would make energy.

    Q are the plastic impulses, which make v+ = v- + W Q, E the restitutions e of their points:
    each joint gives back e of what it took, normal and tangential (Poisson 1817). With the same e
    everywhere (1 + e) Q is Moreau's (1988) law, that impact for (v+ + e v-) / (1 + e). It takes
    (1 - e^2) Q.W Q / 2 at least, Q.v+ <= 0 in the plastic state, for any number of points and any
    friction. A step of finite length ends a little after that state: what contact has taken of the
    energy in it is the limit.

    Parameters
    ----------
    taken
        energy that contact added in the step without restitution [J], < 0.
    arrived
        E Q . v of the plastic state [J].
    square
        E Q . W E Q [J].
    """
    # taken + s arrived + s^2 square / 2 <= 0
    root = np.sqrt(arrived**2 - 2 * square * taken)
    most = (root - arrived) / square if square > 0 else 0.0
    return min(1.0, most)
