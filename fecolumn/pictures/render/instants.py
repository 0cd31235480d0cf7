"""Instants of a motion that a figure shows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fecolumn.pictures.render.result import Result


#: How many are chosen where none are given
CHOSEN = 5
# Shares of the time shown [-]: between two instants at least, and a displacement that counts as a
# peak, of the largest
_APART, _PEAK = 1 / 25, 0.15
# Displacement at which the motion begins, of the largest [-]
_BEGUN = 0.01


def chosen_instants(result: Result, start: float, end: float) -> np.ndarray:
    """The peaks of the top's displacement between two times [s], the largest first to be taken, and
    the end where the column was lost; in order of time.

    Where there are fewer peaks than CHOSEN, as of a column that only slides, instants spread evenly
    from the begin of its motion are added.
    """
    from scipy.signal import find_peaks

    time = result.time
    rows = np.flatnonzero((time >= start - 1e-9) & (time <= end + 1e-9))
    if len(rows) <= CHOSEN:
        return time[rows]
    reach = np.hypot(*result.u_top[rows, :2].T)
    peaks = (
        find_peaks(reach, height=_PEAK * reach.max())[0] if reach.max() > 0 else np.empty(0, int)
    )
    lost = result.summary.get("overturned") or result.summary.get("slid_off")
    ranked = [*([len(rows) - 1] if lost else []), *peaks[np.argsort(-reach[peaks], kind="stable")]]
    apart = _APART * (end - start)
    found: list[int] = []
    begun = int(np.argmax(reach > _BEGUN * reach.max()))
    even = np.linspace(begun, len(rows) - 1, CHOSEN).round().astype(int)
    for row in (*ranked, *even):
        if len(found) < CHOSEN and all(
            abs(time[rows[row]] - time[rows[other]]) >= apart for other in found
        ):
            found.append(row)
    return time[rows[np.sort(found)]]
