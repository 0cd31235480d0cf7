"""Many tests at once: p values that hold for the whole family."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def holm(p: ArrayLike) -> NDArray[Any]:
    """Adjusted p values (n,) of n tests: to reject where they are below a level keeps the chance of
    any false rejection below it.

    Step-down Bonferroni, whatever the dependence of the tests (Holm 1979, Scandinavian Journal of
    Statistics 6).

    Parameters
    ----------
    p
        (n,) p values.
    """
    p = np.asarray(p, float)
    order = np.argsort(p)
    adjusted = np.maximum.accumulate(p[order] * np.arange(p.size, 0, -1))
    result = np.empty_like(p)
    result[order] = np.minimum(adjusted, 1.0)
    return result
