"""A formula of the map: loss over Housner's by stiffness, slenderness and section, and its error.

    L = a_section + b (B/H) + c / (1 + (G / G_c)^m),    G = S (B/H)^k,    S = E / (rho g H)

with the power k of the slenderness that makes the curves of all slendernesses one, fitted with the
rest by least squares. Cells count by how sure their means are. The error is told where the formula
was not fitted, too: cells of one slenderness by the fit to the others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from benchmarks.impact.sections import SHAPES

#: Added to the standard error of a cell: what mesh, modes and steps leave (`grid.CHECKED`).
FLOOR = 0.03


@dataclass(frozen=True)
class Formula:
    """Parameters of the formula, and the root mean square of what it misses: of the cells that it
    was fitted to, and of cells of a slenderness that it was not.
    """

    base: dict[str, float]
    slope: float
    rise: float
    centre: float
    steepness: float
    power: float
    error: float
    left_out: float

    def loss(self, shape: str, ratio, group) -> np.ndarray:
        """At H/B and E B / (rho g H^2)."""
        ratio, group = np.asarray(ratio, float), np.asarray(group, float)
        values = [self.base[shape], self.slope, self.rise, self.centre, self.steepness, self.power]
        return _loss(np.array(values), ratio, group)

    def group(self, ratio, group) -> np.ndarray:
        """G of the cells onto which the slendernesses fall."""
        return np.asarray(group) * np.asarray(ratio, float) ** (1 - self.power)

    def rows(self) -> list[tuple[str, str]]:
        """Names and values."""
        return [
            *((f"a, {shape}", f"{value:.3f}") for shape, value in self.base.items()),
            ("b", f"{self.slope:.3f}"),
            ("c", f"{self.rise:.3f}"),
            ("G_c", f"{self.centre:.3g}"),
            ("m", f"{self.steepness:.3f}"),
            ("k", f"{self.power:.3f}"),
            ("root mean square error", f"{self.error:.3f}"),
            ("of a slenderness left out", f"{self.left_out:.3f}"),
        ]

    def text(self) -> str:
        """In one line."""
        base = ", ".join(f"{value:.2f} ({shape})" for shape, value in self.base.items())
        return (
            f"L = a {self.slope:+.2f} B/H {self.rise:+.2f} / (1 + (G / {self.centre:.2g})^"
            f"{self.steepness:.2f}), G = S (B/H)^{self.power:.2f}, a = {base}; root mean square "
            f"error {self.error:.2f}, of a slenderness left out {self.left_out:.2f}"
        )


def _loss(values, ratio, group):
    base, slope, rise, centre, steepness, power = values
    made = group * ratio ** (1 - power)
    return base + slope / ratio + rise / (1 + (made / centre) ** steepness)


def fit(cells: list[dict]) -> Formula:
    """Fit to the rows of `grid.by_cell`.

    Raises
    ------
    ValueError
        fewer cells with a loss than twice the parameters.
    """
    told = [one for one in cells if np.isfinite(one["loss"] + one["half_width"])]
    shapes = [shape for shape in SHAPES if any(one["shape"] == shape for one in told)]
    if len(told) < 2 * (len(shapes) + 5):
        raise ValueError(f"{len(told)} cells are too few for a formula of {len(shapes) + 5}")
    values = _fitted(told, shapes)
    misses = _misses(values, told, shapes)
    left_out = []
    for ratio in {one["ratio"] for one in told}:
        rest = [one for one in told if one["ratio"] != ratio]
        if {one["shape"] for one in rest} == set(shapes):
            out = [one for one in told if one["ratio"] == ratio]
            left_out.extend(_misses(_fitted(rest, shapes), out, shapes))
    n = len(shapes)
    slope, rise, centre, steepness, power = values[n:]
    return Formula(
        dict(zip(shapes, map(float, values[:n]))),
        float(slope),
        float(rise),
        float(np.exp(centre)),
        float(np.exp(steepness)),
        float(power),
        float(np.sqrt(np.mean(np.square(misses)))),
        float(np.sqrt(np.mean(np.square(left_out)))) if left_out else float("nan"),
    )


def _arrays(cells, shapes):
    return (
        np.array([shapes.index(one["shape"]) for one in cells]),
        *(np.array([one[key] for one in cells], float) for key in ("ratio", "group", "loss")),
    )


def _misses(values, cells, shapes) -> np.ndarray:
    place, ratio, group, loss = _arrays(cells, shapes)
    slope, rise, centre, steepness, power = values[len(shapes) :]
    rest = slope, rise, np.exp(centre), np.exp(steepness), power
    return _loss((values[place], *rest), ratio, group) - loss


def _fitted(cells, shapes) -> np.ndarray:
    weight = 1 / np.array([one["half_width"] / 1.96 + FLOOR for one in cells])
    best = None
    for centre in np.log([1e3, 1e5, 1e7]):
        start = np.concatenate([np.full(len(shapes), 0.7), [0.0, 0.3, centre, 0.0, 1.0]])
        low = np.concatenate([np.full(len(shapes), -3.0), [-5, -5, np.log(1e-2), np.log(0.2), -4]])
        high = np.concatenate([np.full(len(shapes), 3.0), [5, 5, np.log(1e9), np.log(4), 6]])
        found = least_squares(
            lambda values: weight * _misses(values, cells, shapes),
            start,
            bounds=(low, high),
            loss="soft_l1",
        )
        best = found if best is None or found.cost < best.cost else best
    return best.x
