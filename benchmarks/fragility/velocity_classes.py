"""What became of structures by the motion's PGV: shares that are lost, with their intervals, and
shifts of those that are not.
"""

from __future__ import annotations

import numpy as np

from benchmarks.beside import markdown
from fecolumn.statistics.ecdf import proportion_interval

#: Edges of the classes of PGV [m/s]: from the weakest motion that is drawn to the strongest
EDGES = (0.15, 0.3, 0.6, 1.2, 2.5)


def table(found: dict[str, list[dict]], lost) -> str:
    """Of each structure and class P(lost), its 95 % interval (Wilson) and the number of motions;
    and the median shift at the end of those not lost.

    Parameters
    ----------
    found
        rows of analyses that ended, by structure.
    lost
        tells of a row whether it is.
    """
    classes = list(zip(EDGES, EDGES[1:]))
    names = [f"PGV {low:g} to {high:g} m/s" for low, high in classes]
    head = ["structure", *(f"P(lost), {name}" for name in names)]
    head += [f"shift at the end, median, {name} [m]" for name in names]
    lines = []
    for structure, rows in found.items():
        shares, shifts = [], []
        for low, high in classes:
            # the strongest motion may lie on the last edge
            of_class = [
                row
                for row in rows
                if low <= row["pgv_m_s"] < high or high == EDGES[-1] == row["pgv_m_s"]
            ]
            number, fell = len(of_class), sum(map(lost, of_class))
            shares.append(_share(fell, number) if number else "-")
            stayed = [row["shift_m"] for row in of_class if not lost(row)]
            shifts.append(f"{np.median(stayed):.2g}" if stayed else "-")
        lines.append([structure, *shares, *shifts])
    return markdown(head, lines)


def _share(fell: int, number: int) -> str:
    low, high = proportion_interval(fell, number)
    return f"{fell / number:.3f} ({low:.3f} to {high:.3f}; {number})"
