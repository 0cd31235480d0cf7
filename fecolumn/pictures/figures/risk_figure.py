"""Hazard curve, fragility, and from which intensities the frequency of a limit state comes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure
from fecolumn.statistics.hazard import (
    AnnualFrequency,
    HazardCurve,
    lognormal_probabilities,
    probit_probabilities,
)


def risk_figure(
    curve: HazardCurve, fragility: Any, found: AnnualFrequency, names: tuple[str, str], path: Path
) -> list[Path]:
    """Write the figure.

    Parameters
    ----------
    fragility
        has median, beta, and `regions` of lines (r, 2), as `KnownFragility`.
    names
        the limit state in words, and the label of the intensity.
    path
        file name without suffix.
    """
    limit, label = names
    grid = np.exp(np.linspace(np.log(curve.im[0]), np.log(curve.im[-1]), 200))
    p = lognormal_probabilities(fragility.median, fragility.beta)(grid)[0]
    around = np.concatenate([probit_probabilities(lines)(grid) for lines in fragility.regions])
    band = around.min(axis=0), around.max(axis=0)
    share = found.parts[0] / max(found.value[0], 1e-300)

    def bars(axes: Any) -> None:
        axes.bar(
            found.edges[:-1],
            share,
            np.diff(found.edges),
            align="edge",
            color="0.75",
            edgecolor="white",
            linewidth=0.4,
            label="share of the frequency",
            zorder=0,
        )

    scale = {"xscale": "log", "xlim": (curve.im[0], curve.im[-1])}
    return line_figure(
        [
            CurvePanel(
                label,
                "annual frequency of exceedance [1/year]",
                [Curve("", curve.im, curve.frequency, markers=True)],
                {**scale, "yscale": "log"},
            ),
            CurvePanel(
                label,
                f"$P$({limit}), share",
                [Curve("fragility, 95 % band", grid, p, (band[0], band[1]))],
                {**scale, "ylim": (0, 1)},
                prepare=bars,
                legend="upper left",
            ),
        ],
        path,
    )
