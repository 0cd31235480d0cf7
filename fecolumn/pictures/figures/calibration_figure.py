"""Measured tilt beside the fitted one, and how much worse other values of each key fit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.pictures.figures.axis_text import axis_unit
from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.statistics.profile import THRESHOLD, ProfiledFit, ProfiledParameter
from fecolumn.statistics.rocking_test import RockingTest

_POINTS = 150  # of the measured tilt


def calibration_figure(
    test: RockingTest,
    fitted: Any,
    ranges: dict[str, tuple[float, float]],
    value: Callable[[str, float], float],
    fit: ProfiledFit,
    path: Path,
) -> list[Path]:
    """Write the figure.

    Parameters
    ----------
    test
        what was measured.
    fitted
        (n,) tilt of the best fit at its times [rad].
    ranges
        of the keys, in the order of the fit's parameters.
    value
        of a key at a share of its range.
    path
        file name without suffix.
    """
    thin = slice(None, None, max(1, test.time.size // _POINTS))

    def measured(axes: Any) -> None:
        axes.plot(test.time[thin], 1e3 * test.tilt[thin], "o", color="0.55", markersize=2, zorder=1)
        axes.lines[-1].set_label("measured")

    def threshold(axes: Any) -> None:
        axes.axhline(THRESHOLD, color="0.35", linewidth=0.8, linestyle=":", label="95 %")

    labels = [f"{key}, {low:g} to {high:g}" for key, (low, high) in ranges.items()]
    # several of them side by side, whatever their intervals
    places = [(one.at - one.best) / _half(one) for one in fit.parameters]
    across = "from the best fit, over half of the 95 % interval [-]"
    if len(ranges) == 1:  # in its own unit
        (key,) = ranges
        labels, across = ["profile"], f"{key} [{axis_unit(key)}]"
        places = [np.array([value(key, float(at)) for at in fit.parameters[0].at])]
    profiles = [
        Curve(label, at, one.deviance, markers=True)
        for label, at, one in zip(labels, places, fit.parameters)
    ]
    near = [at[one.deviance <= 3 * THRESHOLD] for at, one in zip(places, fit.parameters)]
    least, most = (float(pick([pick(at) for at in near])) for pick in (np.min, np.max))
    spread = 0.1 * (most - least) or 1e-3 * max(abs(most), 1.0)
    return line_figure(
        [
            CurvePanel(
                "time [s]",
                "tilt [mrad]",
                [Curve("fitted", test.time, 1e3 * np.asarray(fitted))],
                {"xlim": (0, float(test.time[-1])), "ylim": (0, None)},
                prepare=measured,
                legend="upper right",
            ),
            CurvePanel(
                across,
                r"deviance $n\,\ln(S/S_{\min})$",
                profiles,
                {"ylim": (0, 3 * THRESHOLD), "xlim": (least - spread, most + spread)},
                prepare=threshold,
                legend="upper center",
            ),
        ],
        path,
    )


def _half(one: ProfiledParameter) -> float:
    """Half of a parameter's interval, in shares of its range."""
    low, high = 0.0 if one.low is None else one.low, 1.0 if one.high is None else one.high
    return max((high - low) / 2, 1e-9)
