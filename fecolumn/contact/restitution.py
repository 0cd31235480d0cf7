"""Restitution: what of the impulse of a plastic impact is given once more."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit


@njit
def returned_share(restitution, taken, arrived, square):
    """Share of the plastic impulse Q that is given back: the restitution e, less where contact
    would make energy.

    With Q the plastic impact makes v+ = v- + W Q; (1 + e) Q is Moreau's (1988) law, that impact for
    (v+ + e v-) / (1 + e), with the same e for all points, normal and tangential. It takes (1 - e^2)
    Q.W Q / 2 at least, Q.v+ <= 0 in the plastic state, for any number of points and any friction. A
    step of finite length ends a little after that state: what contact has taken of the energy in it
    is the limit.

    Parameters
    ----------
    taken
        energy that contact added in the step without restitution [J], < 0.
    arrived
        Q . v of the plastic state [J].
    square
        Q . W Q [J].
    """
    # taken + e arrived + e^2 square / 2 <= 0
    root = np.sqrt(arrived**2 - 2 * square * taken)
    most = (root - arrived) / square if square > 0 else 0.0
    return min(restitution, most)
