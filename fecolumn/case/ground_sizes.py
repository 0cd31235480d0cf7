"""Sizes that a plate or layer leaves open, by the feet on it; one law of a column's base and of the
grounds of a structure.

Chosen: a foot may slide by a quarter of its smaller side, the plate goes on by one and a half of
its larger side all round, and is as thick as a quarter of the smaller one.
"""

from __future__ import annotations

from collections.abc import Iterable


def open_allowance(shorter: float, room: Iterable[float]) -> float:
    """How far [m] feet may slide.

    shorter: the smallest side of a foot [m]; room: what stated sides of the plate leave beside all
    feet, on either side [m].
    """
    return max(0.0, min(shorter / 4, *room, shorter / 4))


def open_side(own: float, longer: float, allowance: float) -> float:
    """Side [m] of a plate below feet that are `own` [m] long together, the longest of them `longer`
    [m], and may slide by `allowance` [m].
    """
    return own + max(3 * longer, 2 * allowance)


def least_side(own: float, allowance: float) -> float:
    """Smallest side [m] of a plate, likewise."""
    return own + 2 * allowance


def open_thickness(shorter: float) -> float:
    """Thickness [m] of a plate or layer; shorter: the smallest side of a foot on it [m]."""
    return shorter / 4
