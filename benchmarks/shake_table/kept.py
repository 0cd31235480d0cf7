"""Classes of the reliability diagram as benchmarks/tables holds them."""

from __future__ import annotations

from benchmarks import tables
from benchmarks.shake_table.probability import Class


def kept_classes() -> list[Class]:
    """Of the table `shake_table_reliability`."""
    found = []
    for name, n, told, share, interval in tables.read("shake_table_reliability").rows:
        (low, high), ends = (
            [float(one) for one in cell.split(" to ")] for cell in (name, interval)
        )
        found.append(Class(low, high, int(n), float(told), float(share), (ends[0], ends[1])))
    return found
