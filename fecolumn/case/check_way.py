"""The way of the top at which a structure counts as overturned."""

from __future__ import annotations

from fecolumn.case.checked import Refuse
from fecolumn.case.sections import Overturn

# Over the height of a structure: way of its top that is no overturning; 0.1 mm of 1 m
_WAY = 1e-4


def check_way(overturn: Overturn, height: float, refuse: Refuse) -> None:
    """Refuse a cap of the top's way that nothing of this height [m] stays below."""
    if 0 < (cap := overturn.displacement_m) < _WAY * height:
        refuse(
            "overturn.displacement_m",
            cap,
            f"must be 0 for none, or at least {_WAY * height:.3g} m, {_WAY:g} of the height: less "
            "is no overturning",
        )
