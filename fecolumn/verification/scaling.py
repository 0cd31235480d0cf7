"""Specimens of different size under the same motion stretched in time: one answer.

Requirement: a specimen L times larger, under the motion of the same amplitude stretched by sqrt(L),
has the same history of u / D (D the diameter), so that a shaking table test of a quarter-size
column speaks for the column.

Derivation. With lengths x L and accelerations x 1, times go by sqrt(L), forces by rho L^3, stresses
by rho L. Strains, friction cone, impact law and time steps are the same where E goes by L too: the
discrete equations of the two analyses are then the same numbers, and energies go by L^4. With the
same E, L times larger is the same as E / L in the first specimen, exactly, and differs from it by
elasticity alone: a column that rocks at the tilt th presses its rim into itself and the base by d
along an arc of half-angle phi = sqrt(2 d / (th R)). With k ~ E the force per length and
penetration,

    N = (4/3) k R d phi,   so that d ~ (N / k)^(2/3),

and the resultant lies inside the rim by

    e = R phi^2 / 10 = d / (5 th) ~ E^(-2/3).

The restoring moment, and the response with it, is off that of a rigid rim by c E^(-2/3). From the
change d4 when E is multiplied by 4: u(E / 4) - u(E) = d4 (4^(2/3) - 1) / (1 - 4^(-2/3)) = 4^(2/3)
d4. Where the arc is no longer short e grows slower, so that this is an upper bound for a column
that rocks (standing, its deflections go with 1 / E).

Source. Housner (1963) for the scale effect of rocking, Winkler (1867) for the rim's bedding.

Tolerances. Same numbers: `solver_drift`, twice; the engine's own tolerances of length go with the
foot's width. Same E: the bound above.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.system import System
from fecolumn.foundation.toml_file import merge
from fecolumn.pictures.figures.style import LINES
from fecolumn.verification.models import COARSE, STEEL, column_system, shaking
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.trial import Trial, solver_drift

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_STEP = 1e-3  # s, of the first specimen
_LOSSES = ("friction", "impact", "contact")


def sized_system(engine: str, size: float, modulus: float) -> System:
    """System of the coarse specimen `size` times larger, of Young's modulus `modulus` [Pa], with a
    step sqrt(size) times longer.
    """
    tables = {
        name: {key: size * value for key, value in table.items() if key.endswith("_m")}
        for name, table in COARSE.items()
        if isinstance(table, dict)
    }
    elastic = {"youngs_modulus_pa": modulus}
    return column_system(
        engine,
        **merge(
            tables,
            {"material": elastic, "base": elastic, "integration": {"dt_s": np.sqrt(size) * _STEP}},
        ),
    )


def run(engine: str, long: bool) -> CaseRows:
    """Rows of specimens of three sizes, with E in proportion and with the same E."""
    result = CaseRows(size=(7.2, 3.6))
    steps = 200 if long or engine != "total_lagrangian" else 125
    diameter, times = COARSE["column"]["outer_diameter_m"], _STEP * np.arange(1, steps + 1)

    def analysed(size: float, modulus: float) -> tuple[np.ndarray, Trial]:
        """Path of top and foot over the diameter, (n, 2, 3), and the trial."""
        trial = begin_trial(engine, sized_system(engine, size, modulus))
        return trial.shake(shaking(times)) / (size * diameter), trial

    def apart(path: np.ndarray, other: np.ndarray) -> np.ndarray:
        return np.linalg.norm(path - other, axis=2).max(axis=1)

    first, trial = analysed(1, STEEL)
    largest, drift = np.linalg.norm(first, axis=2).max(), solver_drift(trial.system, times)
    allowed, lost = (
        (drift * times).max() / diameter / largest,
        sum(trial.energy()[name] for name in _LOSSES),
    )
    paths, series = {}, {}
    for size in (4, 16, 0.25) if long or engine != "total_lagrangian" else (4,):
        paths[size], larger = analysed(size, size * STEEL)
        series[f"size x {size:g}, E x {size:g}"] = difference = apart(paths[size], first)
        result.rows.append(
            Row(
                f"size and E x {size:g}: path of top and foot over D [-]",
                0.0,
                difference.max(),
                allowed,
                scale=largest,
            )
        )
        if size == 4:
            speed = np.sqrt(2 * trial.energy()["base_work"] / trial.system.body.total_mass)
            result.rows.append(
                Row(
                    "size and E x 4: energy lost [J]",
                    size**4 * lost,
                    sum(larger.energy()[name] for name in _LOSSES),
                    2 * drift[-1] / speed,
                    scale=size**4 * trial.energy()["base_work"],
                )
            )
    same, _ = analysed(4, STEEL)
    softer, _ = analysed(1, STEEL / 4)
    stiffer, _ = analysed(1, 4 * STEEL)
    bound = 4 ** (2 / 3) * apart(stiffer, first)
    equal, elastic = apart(same, softer), apart(same, first)
    series["size x 4, same E, against E / 4"] = equal
    result.rows += [
        Row(
            "size x 4, same E, against E / 4: path over D [-]",
            0.0,
            equal.max(),
            allowed,
            scale=largest,
        ),
        Row(
            "size x 4, same E, effect of elasticity: path over D [-]",
            0.0,
            elastic.max(),
            bound.max() / largest,
            scale=largest,
        ),
    ]

    def draw(figure: Figure) -> None:
        panels, below = figure.subfigures(2, 1, height_ratios=(1, 0.2))
        left, right = panels.subplots(1, 2)
        scaled = times * np.sqrt(GRAVITY / diameter)
        for axis, name in enumerate("xy"):
            # one entry of the legend for both axes
            specimen, stiffer, same_e = (
                ["specimen", "size x 4, E x 4", "size x 4, same E"] if axis == 0 else [None] * 3
            )
            left.plot(scaled, first[:, 0, axis], color=LINES[0][0], label=specimen)
            left.plot(
                scaled[::8],
                paths[4][::8, 0, axis],
                "o",
                color=LINES[1][0],
                markersize=3,
                fillstyle="none",
                label=stiffer,
            )
            left.plot(
                scaled,
                same[:, 0, axis],
                color="k",
                linestyle="--",
                linewidth=0.8,
                label=same_e,
            )
            low = np.argmin(first[:, 0, axis])
            left.annotate(
                f"$u_{name}$",
                (scaled[low], first[low, 0, axis]),
                xytext=(0, -11),
                textcoords="offset points",
                ha="center",
            )
        left.margins(y=0.12)
        left.set(xlabel=r"$t\,\sqrt{g/D}$", ylabel="$u/D$ of the top", xlim=(0, scaled[-1]))
        left.legend()
        for (name, difference), (colour, dashes) in zip(series.items(), LINES):
            right.semilogy(
                scaled, np.maximum(difference, 1e-16), color=colour, linestyle=dashes, label=name
            )
        right.semilogy(
            scaled, elastic, color="k", linestyle="--", linewidth=0.8, label="size x 4, same E"
        )
        right.semilogy(
            scaled, bound, color="0.6", label=r"its bound, $4^{2/3}$ times the effect of E x 4"
        )
        right.semilogy(
            scaled,
            drift * times / diameter,
            color="k",
            linewidth=0.8,
            linestyle=":",
            label="what the solver may leave",
        )
        right.set(
            xlabel=r"$t\,\sqrt{g/D}$",
            ylabel="largest difference of $u/D$",
            xlim=(0, scaled[-1]),
            ylim=(1e-14, 1),
        )
        below.legend(*right.get_legend_handles_labels(), loc="center", ncols=3)

    result.draw = draw
    return result
