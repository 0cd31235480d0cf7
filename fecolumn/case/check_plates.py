"""Parts of a body or a column that must fit it: flange, cap, and the finely meshed lower part."""

from __future__ import annotations

import math
from typing import NamedTuple

from fecolumn.case.checked import Refuse
from fecolumn.case.sections import Cap, Flange

# Over a length: typed sizes that are rounded are equal
_ROUNDING = 1e-9


class OwnSize(NamedTuple):
    """What flange and cap are measured by.

    sides: length along x and width along y [m], of a round body twice the diameter. named: their
    keys. bore: diameter of its hole [m], 0 of a solid one.
    """

    sides: tuple[float, float]
    named: tuple[str, str]
    bore: float

    @property
    def is_round(self) -> bool:
        """Whether both sides are one diameter."""
        return self.named[0] == self.named[1]


def check_plates(
    prefix: str, own: OwnSize, flange: Flange | None, cap: Cap | None, refuse: Refuse
) -> None:
    """Refuse plates that leave a part of the body without support, by their keys after `prefix`."""
    if flange:
        across = own.sides[0] if own.is_round else math.hypot(*own.sides)
        if flange.outer_diameter_m < across * (1 - _ROUNDING):
            told = f"{own.named[0]} =" if own.is_round else "the diagonal of the foot,"
            refuse(
                f"{prefix}flange.outer_diameter_m",
                flange.outer_diameter_m,
                f"must be at least {told} {across:g} m",
            )
        if flange.inner_diameter_m > own.bore * (1 + _ROUNDING):
            refuse(
                f"{prefix}flange.inner_diameter_m",
                flange.inner_diameter_m,
                f"must be at most the tube's bore, {own.bore:g} m"
                if own.bore
                else "must be 0 below a body without a bore",
            )
    for key, side, named in zip(("length_m", "width_m"), own.sides, own.named):
        if cap and getattr(cap, key) < side * (1 - _ROUNDING):
            told = f"must be at least {named} = {side:g} m"
            refuse(f"{prefix}cap.{key}", getattr(cap, key), told)


def check_fine_height(key: str, fine: float | None, height: float, refuse: Refuse) -> None:
    """Refuse a lower part that is higher than the body, whose height is in [m]."""
    if fine is not None and fine > height:
        refuse(key, fine, f"must lie in [0, height_m = {height:g}] m")
