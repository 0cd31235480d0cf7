"""A formula of the map: loss over Housner's of stiff bodies by slenderness and section.

    L = a_section + b B/H,    E B / (rho g H^2) of STIFF and more

fitted by least squares to all cells alike. What it misses is told beside what the mean of the cells
misses: a formula that is no better explains nothing. Both are told where nothing was fitted, too:
cells of one slenderness by the fit to the others, or by the mean of these. Of softer bodies no
formula was found that is better there, and a term of the stiffness makes it worse.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.impact.sections import SHAPES

#: Least E B / (rho g H^2) of the cells that are fitted.
STIFF = 1e5


@dataclass(frozen=True)
class Formula:
    """Parameters of the formula; root mean square of what it misses, of the cells that it was
    fitted to and of cells of a slenderness that it was not; and of what their mean misses.
    """

    base: dict[str, float]
    slope: float
    error: float
    left_out: float
    error_of_mean: float
    left_out_by_mean: float

    def loss(self, shape: str, ratio) -> np.ndarray:
        """Over Housner's at H/B."""
        return self.base[shape] + self.slope / np.asarray(ratio, float)

    def rows(self) -> list[tuple[str, str]]:
        """Names and values."""
        return [
            *((f"a, {shape}", f"{value:.3f}") for shape, value in self.base.items()),
            ("b", f"{self.slope:.3f}"),
            ("root mean square error", f"{self.error:.3f}"),
            ("of a slenderness left out", f"{self.left_out:.3f}"),
            ("root mean square error of the mean", f"{self.error_of_mean:.3f}"),
            ("of a slenderness left out, by the mean", f"{self.left_out_by_mean:.3f}"),
        ]


def stiff_cells(cells: list[dict]) -> list[dict]:
    """Of the rows of `grid.by_cell` those of STIFF and more that have a loss."""
    return [one for one in cells if np.isfinite(one["loss"]) and one["group"] >= STIFF]


def fit(cells: list[dict]) -> Formula:
    """Fit to the stiff ones of the rows of `grid.by_cell`.

    Raises
    ------
    ValueError
        fewer of these with a loss than twice the parameters.
    """
    told = stiff_cells(cells)
    shapes = [shape for shape in SHAPES if any(one["shape"] == shape for one in told)]
    if len(told) < 2 * (len(shapes) + 1):
        raise ValueError(f"{len(told)} stiff cells are too few for {len(shapes) + 1} parameters")

    def by_formula(known: list[dict], asked: list[dict]) -> np.ndarray:
        return _columns(asked, shapes) @ _fitted(known, shapes)

    def by_mean(known: list[dict], asked: list[dict]) -> np.ndarray:
        return np.full(len(asked), np.mean(_losses(known)))

    values = _fitted(told, shapes)
    return Formula(
        dict(zip(shapes, map(float, values[:-1]))),
        float(values[-1]),
        _miss(by_formula, [(told, told)]),
        _miss(by_formula, _left_out(told)),
        _miss(by_mean, [(told, told)]),
        _miss(by_mean, _left_out(told)),
    )


def _left_out(cells: list[dict]) -> list[tuple[list[dict], list[dict]]]:
    """Of each slenderness the cells of the others, where these have all its sections, and its
    own.
    """
    parts = [
        (
            [one for one in cells if one["ratio"] != ratio],
            [one for one in cells if one["ratio"] == ratio],
        )
        for ratio in sorted({one["ratio"] for one in cells})
    ]
    return [
        (rest, own)
        for rest, own in parts
        if {one["shape"] for one in rest} >= {one["shape"] for one in own}
    ]


def _miss(told: Callable, parts: list[tuple[list[dict], list[dict]]]) -> float:
    """Root mean square of what is missed of the second cells of each part, by the first."""
    misses = [told(known, asked) - _losses(asked) for known, asked in parts if known]
    return float(np.sqrt(np.mean(np.concatenate(misses) ** 2))) if misses else float("nan")


def _losses(cells: list[dict]) -> np.ndarray:
    return np.array([one["loss"] for one in cells])


def _columns(cells: list[dict], shapes: list[str]) -> np.ndarray:
    return np.array(
        [[*(one["shape"] == shape for shape in shapes), 1 / one["ratio"]] for one in cells], float
    )


def _fitted(cells: list[dict], shapes: list[str]) -> np.ndarray:
    return np.linalg.lstsq(_columns(cells, shapes), _losses(cells), rcond=None)[0]
