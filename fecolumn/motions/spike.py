"""A sample of a record that stands out alone, as a changed digit makes it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Times by which a spike jumps farther, up and down again, than any two samples else; samples that
#: a record needs for that to be told
SPIKE_JUMPS, SPIKE_SAMPLES = 5.0, 20


def spike_in(values: NDArray[Any]) -> int | None:
    """Index of the one sample that leaves its two neighbours on the same side by five times more
    than any other two samples part; None of a sound record.

    Parameters
    ----------
    values
        (n,) of one component.
    """
    if len(values) < SPIKE_SAMPLES:
        return None
    jumps = np.diff(values)
    back_and_forth = np.minimum(np.abs(jumps[:-1]), np.abs(jumps[1:]))
    back_and_forth[jumps[:-1] * jumps[1:] >= 0] = 0.0
    place = int(back_and_forth.argmax())
    others = np.abs(np.delete(jumps, [place, place + 1])).max()
    return place + 1 if back_and_forth[place] > SPIKE_JUMPS * others else None
