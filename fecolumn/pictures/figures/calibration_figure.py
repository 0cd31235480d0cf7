"""Measured tilt beside the fitted one, and how much worse other values of each key fit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.statistics.profile import THRESHOLD, ProfiledFit
from fecolumn.statistics.rocking_test import RockingTest

_POINTS = 150  # of the measured tilt


def calibration_figure(
    test: RockingTest,
    fitted: Any,
    ranges: dict[str, tuple[float, float]],
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
    path
        file name without suffix.
    """
    thin = slice(None, None, max(1, test.time.size // _POINTS))

    def measured(axes: Any) -> None:
        axes.plot(test.time[thin], 1e3 * test.tilt[thin], "o", color="0.55", markersize=2, zorder=1)
        axes.lines[-1].set_label("measured")

    def threshold(axes: Any) -> None:
        axes.axhline(THRESHOLD, color="0.35", linewidth=0.8, linestyle=":", label="95 %")

    profiles = [
        Curve(f"{key}, {low:g} to {high:g}", one.at, one.deviance, markers=True)
        for (key, (low, high)), one in zip(ranges.items(), fit.parameters)
    ]
    near = [one.at[one.deviance <= 3 * THRESHOLD] for one in fit.parameters]
    least, most = (float(pick([pick(at) for at in near])) for pick in (np.min, np.max))
    spread = 0.1 * (most - least) + 1e-3
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
                "share of the range [-]",
                r"deviance $n\,\ln(S/S_{\min})$",
                profiles,
                {"ylim": (0, 3 * THRESHOLD), "xlim": (least - spread, most + spread)},
                prepare=threshold,
                legend="upper center",
            ),
        ],
        path,
    )
