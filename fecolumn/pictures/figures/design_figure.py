"""Probability of a limit state over a key, and the size for which it is kept with its interval."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Protocol

import numpy as np

from fecolumn.pictures.figures.line_figure import Curve, CurvePanel, line_figure


class DrawnLimit(Protocol):
    """A limit state as the figure needs it: its event in words and the share it may have."""

    @property
    def event(self) -> Any:
        """Has `text`."""

    @property
    def share(self) -> float:
        """Of all motions."""


def design_figure(
    rows: list[list[float]], label: str, limit: DrawnLimit, answer: dict[str, Any], path: Path
) -> list[Path]:
    """Write the figure.

    Parameters
    ----------
    rows
        value, n, k, P, and the ends of its interval, one a value that was looked at.
    label
        of the key with its unit.
    answer
        "size" and "interval", None where it is not known.
    path
        file name without suffix.
    """
    value, _, _, p, low, high = np.array(rows).T

    def prepare(axes: Any) -> None:
        axes.axhline(limit.share, color="0.35", linewidth=0.8, linestyle=":")
        axes.annotate(
            f"limit {limit.share:g}",
            (1.0, limit.share),
            xycoords=("axes fraction", "data"),
            xytext=(-3, 2),
            textcoords="offset points",
            ha="right",
            fontsize=7.5,
            color="0.35",
        )
        if answer["size"] is None:
            return
        axes.axvline(answer["size"], color="C3", linewidth=1.0, label=f"size {answer['size']:g}")
        ends = axes.get_xlim()
        least, most = answer["interval"]
        axes.axvspan(
            ends[0] if least is None else least,
            ends[1] if most is None else most,
            color="C3",
            alpha=0.12,
            linewidth=0,
            label="95 % interval of the size",
        )
        axes.set_xlim(ends)

    spread = 0.04 * (value.max() - value.min())
    return line_figure(
        [
            CurvePanel(
                label,
                f"$P$({limit.event.text})",
                [Curve("all motions, 95 % interval", value, p, bars=(low, high))],
                {"ylim": (0, 1), "xlim": (value.min() - spread, value.max() + spread)},
                prepare=prepare,
            )
        ],
        path,
    )
