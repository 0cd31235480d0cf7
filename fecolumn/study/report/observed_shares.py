"""Shares observed beside a fragility curve, in groups of runs of rising intensity."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.line_figure import Curve
from fecolumn.statistics.bands import wilson

_FEWEST, _MOST = 5, 6  # runs in a group, and groups


def share_groups(n: int) -> int:
    """Number of groups of n runs: six at most, of five runs at least."""
    return min(_MOST, max(1, n // _FEWEST))


def observed_shares(im: NDArray[Any], happened: NDArray[Any]) -> Curve:
    """Points of the shares of n runs in `share_groups` groups of equal number, each at the median
    of its intensities, with Wilson's 95 % interval of independent runs as a bar.

    Parameters
    ----------
    im
        (n,) intensities.
    happened
        (n,) bool.
    """
    groups = np.array_split(np.argsort(im, kind="stable"), share_groups(im.size))
    bars = [np.ravel(wilson([happened[place].sum()], place.size)) for place in groups]
    low, high = np.transpose(bars)
    return Curve(
        "observed, groups of equal number",
        np.array([np.median(im[place]) for place in groups]),
        np.array([happened[place].mean() for place in groups]),
        bars=(low, high),
    )
