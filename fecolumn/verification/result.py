"""What a verification case finds: rows of exact against computed, and how to draw it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike


@dataclass(frozen=True, slots=True)
class Row:
    """One quantity of a case.

    Attributes
    ----------
    quantity
        what it is, with its unit in brackets.
    exact
        closed form, or the bound's ideal 0.
    computed
        by the engine.
    tolerance
        largest `error` allowed.
    scale
        what the error is relative to; |exact| unless given, 1 where exact is 0.
    order
        measured order of convergence, where the row is the finest of a series.
    """

    quantity: str
    exact: float
    computed: float
    tolerance: float
    scale: float | None = None
    order: float | None = None

    @property
    def error(self) -> float:
        """|computed - exact| / scale."""
        return abs(self.computed - self.exact) / (self.scale or abs(self.exact) or 1.0)

    @property
    def ok(self) -> bool:
        """Whether the error is within the tolerance."""
        return bool(self.error <= self.tolerance)  # a NaN is not


@dataclass(slots=True)
class CaseRows:
    """Rows of a case, and `draw(figure)` that fills a matplotlib figure of `size` (width, height)
    [in].
    """

    rows: list[Row] = field(default_factory=list)
    draw: Callable | None = None
    size: tuple[float, float] = (7.2, 2.8)


def order_of(sizes: ArrayLike, errors: ArrayLike) -> float:
    """Order of convergence: slope of ln error over ln size, by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])
