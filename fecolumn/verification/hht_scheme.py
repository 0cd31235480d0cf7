"""The time integration alone: one free vibration mode of a block that touches nothing.

Requirement: order 2 in dt for displacement, velocity and acceleration; numerical damping, period
error and spectral radius are those of the method for every alpha; alpha = 0 keeps the energy.

Derivation. In a mode of frequency w, with W = w dt and z = (u, dt v, dt^2 a), a step is z1 = A z0:

    a1 + (1 + al) W^2 u1 - al W^2 u0 = 0,
    u1 = u0 + v0 + (1/2 - be) a0 + be a1,   v1 = v0 + (1 - ga) a0 + ga a1,
    be = (1 - al)^2 / 4,   ga = 1/2 - al.

The principal eigenvalues exp(W' (-xi +- i)) of A give the damping ratio xi and the period error W /
W' - 1 (Hughes 1987); at infinite W the largest one has the modulus (1 + al) / (1 - al). The forces
are in balance at t1 + al dt: there the acceleration is second order, a1 = a(t1 + al dt) + O(dt^2),
while read at t1 it is off by |al| w dt for any alpha but 0 (Erlicher, Bonaventura and Bursi 2002).
The mode is the lowest elastic one of the free block's own mass and stiffness, so that the mesh has
no part in the errors; it starts from u0 = phi, a0 = -w^2 phi. Rigid motion is orthogonal to it, so
that gravity has no part either.

Source. Hilber, Hughes and Taylor (1977); Hughes (1987), The Finite Element Method, section 9.3;
Erlicher et al. (2002).

Tolerances. Order: the series of the error goes on with a relative W^2 / 2 or less; at 16 steps a
period that bends a least-squares slope over a factor of 8 by W^2 / (2 ln 8) = 0.037, 2 % of 2.
Departure from A: the solver leaves an unbalanced force of 4 eps k L, 1e-7 of the mode's, in a step,
and a few of these add up; the strains of 1e-5 make the total Lagrangian block stiffer by no more:
1e-6 of the amplitude, of its energy, of W' and of ln |A|. Entries of A: a block that moves by 1e-6
m, position rounding of 1e-16 m and an unbalanced force of 1e-6 of the mode's, in one step: 1e-6. It
moves so little because of the moment of second order that internal forces have: in a step of 15 s
it turns a block far, and the iteration that takes it away, of which the factored matrix knows
nothing, contracts by 5e-2 at w dt = 1e5, and diverges where the block moves ten times as far.
Spectral radius: the modulus at infinity is a double eigenvalue, that perturbations e of A split by
(e / d)^(1/2), d the distance of its modulus to the third one's, -al / (1 + al): 1e-3 at alpha =
-0.333, else more. With e = 1e-10, both of rounding and of (w dt)^-2 at w dt = 1e5: 1e-3.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.system import System
from fecolumn.fem.modes import free_modes
from fecolumn.pictures.figures.style import LINES
from fecolumn.verification.models import block_system, box
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.trial import afloat

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_ALPHAS = (0.0, -0.05, -0.1, -0.2, -0.333)
PER_PERIOD = (16, 32, 64, 128)
_PERIODS = 2
# dt over period of the damping and period error: the rows are of the middle one
_COARSE = (0.05, 0.1, 0.2, 0.4)
_STIFF = 1e5
FIELDS = ("u", "v", "a at t + alpha dt")
# Amplitude of the modal coordinate [m sqrt(kg)]: the block moves by 1e-5 m, far above rounding and
# far below finite strains
_AMPLITUDE = 1e-4
# Of the amplification matrix, whose longest step lasts 15 s: see Tolerances
MATRIX_AMPLITUDE = 1e-5


class Mode:
    """The lowest elastic mode of a free block in the solver.

    Attributes
    ----------
    shape
        (n, 3) with unit modal mass.
    frequency
        w [rad/s].
    """

    def __init__(self, engine: str) -> None:
        self.engine = engine
        modes = free_modes(self.system(1e-4, 0.0).body, 7)
        self.frequency, self.shape = 2 * np.pi * modes.frequencies[6], modes.shapes[6]

    def system(self, dt: float, alpha: float) -> System:
        """Block above a base, nearly without weight, so that it vibrates and never lands."""
        body = box(np.linspace(-0.1, 0.1, 3), np.linspace(-0.15, 0.15, 3), np.linspace(0, 1, 7))
        return block_system(
            self.engine,
            body,
            box([-1, 1], [-1, 1], [-0.1, 0]),
            HHT(dt, alpha),
            gravity=(0, 0, -1e-6),
        )

    def steps(
        self,
        alpha: float,
        angle: float,
        start: ArrayLike,
        count: int,
        amplitude: float = _AMPLITUDE,
    ) -> tuple[np.ndarray, np.ndarray, float]:
        """Z = (u, dt v, dt^2 a) of the mode (count + 1, 3) from z0 = `start`, at w dt = `angle`;
        with the mechanical energy (count + 1,) and the ledger's closure, both over the first
        energy.
        """
        dt = angle / self.frequency
        system = self.system(dt, alpha)
        first, scale = np.asarray(start, float), amplitude * np.array([1, 1 / dt, 1 / dt**2])
        moved, velocity, acceleration = (value * self.shape for value in scale * first)
        trial = begin_trial(
            self.engine,
            system,
            lambda system: afloat(system, moved, velocity, acceleration, height=1e-3),
        )
        rest, measure = (
            trial.state.x - scale[0] * first[0] * self.shape,
            system.body.momentum(self.shape),
        )
        history, energy = [np.array(start, float)], [trial.mechanical()]
        for _ in range(count):
            state = trial.step()
            history.append(
                [system.body.dot(measure, field) for field in (state.x - rest, state.v, state.a)]
                / scale
            )
            energy.append(trial.mechanical())
        return (
            np.array(history),
            np.array(energy) / energy[0],
            trial.energy()["closure"] / energy[0],
        )

    def matrix(self, alpha: float, angle: float) -> np.ndarray:
        """Amplification matrix (3, 3) of the solver, one step from each of three starts."""
        return np.column_stack(
            [self.steps(alpha, angle, start, 1, MATRIX_AMPLITUDE)[0][1] for start in np.eye(3)]
        )


def amplification(alpha: float, angle: float) -> np.ndarray:
    """Amplification matrix (3, 3) of the method for z = (u, dt v, dt^2 a) at w dt = `angle`."""
    hht = HHT(1.0, alpha)
    guess = np.array([1, 1, 0.5 - hht.beta])
    a = (
        angle**2
        * (alpha * np.array([1, 0, 0]) - (1 + alpha) * guess)
        / (1 + hht.beta * (1 + alpha) * angle**2)
    )
    return np.array([guess + hht.beta * a, np.array([0, 1, 1 - hht.gamma]) + hht.gamma * a, a])


def principal(eigenvalues: np.ndarray) -> tuple[float, float]:
    """(damping ratio, w dt of the numerical period) of the oscillating pair among eigenvalues of a
    step.
    """
    pair = eigenvalues[np.argmax(eigenvalues.imag)]
    angle = float(np.angle(pair))
    return float(-np.log(abs(pair))) / angle, angle


def of_history(values: np.ndarray) -> tuple[float, float]:
    """`principal` of a decaying oscillation (n,), from the recurrence u2 = p u1 + q u0 that fits it
    best after its first quarter.
    """
    values = values[len(values) // 4 :]
    (p, q), *_ = np.linalg.lstsq(
        np.column_stack([values[1:-1], values[:-2]]), values[2:], rcond=None
    )
    return principal(np.roots([1, -p, -q]).astype(complex))


def run(engine: str, long: bool) -> CaseRows:
    """The whole case in either engine; `long` has nothing to add."""
    mode = Mode(engine)
    result, errors, departure = CaseRows(size=(7.2, 5.2)), {}, 0.0
    for alpha in _ALPHAS:
        found = []
        for number in PER_PERIOD:
            angle = 2 * np.pi / number
            error, away, drift = convergence(mode, alpha, angle, _PERIODS * number)
            found.append(error)
            departure = max(departure, away)
        errors[alpha] = np.array(found)
        for field, series in zip(FIELDS, errors[alpha].T):
            slope = -np.polyfit(np.log(PER_PERIOD), np.log(series), 1)[0]
            result.rows.append(
                Row(
                    f"slope of the error of {field}, alpha {alpha:g} [-]",
                    2.0,
                    slope,
                    0.02,
                    order=slope,
                )
            )
        if alpha == 0:
            result.rows.append(
                Row(f"energy, largest change in {_PERIODS} periods, alpha 0 [-]", 0.0, drift, 1e-6)
            )
    result.rows.append(
        Row(
            "u, v, a: largest departure from the amplification matrix / amplitude [-]",
            0.0,
            departure,
            1e-6,
        )
    )

    damped = {alpha: decays(mode, alpha) for alpha in _ALPHAS}
    for alpha, series in damped.items():
        exact, computed, closure = series[_COARSE.index(0.1)]
        result.rows += [
            Row(
                f"damping ratio at dt / T = 0.1, alpha {alpha:g} [-]",
                round(exact[0], 12),
                computed[0],
                1e-6,
                scale=1.0,
            ),
            Row(
                f"period error at dt / T = 0.1, alpha {alpha:g} [-]",
                exact[1],
                computed[1],
                1e-6,
                scale=1.0,
            ),
        ]
    worst = max(abs(closure) for series in damped.values() for _, _, closure in series)
    result.rows.append(Row("ledger closure / energy, worst alpha and dt [-]", 0.0, worst, 1e-6))

    angles, radii, departure = 2 * np.pi * np.geomspace(0.05, _STIFF / (2 * np.pi), 12), {}, 0.0
    for alpha in _ALPHAS:
        matrices = [mode.matrix(alpha, angle) for angle in angles]
        departure = max(
            departure,
            *(
                np.abs(found - amplification(alpha, angle)).max()
                for found, angle in zip(matrices, angles)
            ),
        )
        radii[alpha] = [np.abs(np.linalg.eigvals(found)).max() for found in matrices]
        limit = (1 + alpha) / (1 - alpha)
        result.rows.append(
            Row(
                f"spectral radius at w dt = {_STIFF:g}, alpha {alpha:g} [-]",
                limit,
                radii[alpha][-1],
                1e-3,
            )
        )
    result.rows.append(
        Row(
            f"entries of the amplification matrix, w dt 0.3 to {_STIFF:g}, largest departure [-]",
            0.0,
            departure,
            1e-6,
        )
    )
    result.draw = lambda figure: draw_scheme(figure, errors, damped, angles, radii)
    return result


def convergence(
    mode: Mode, alpha: float, angle: float, count: int
) -> tuple[np.ndarray, float, float]:
    """Largest errors (4,) of FIELDS and of a at t over their amplitudes, departure from the
    amplification matrix, and change of energy.
    """
    history, energy, _ = mode.steps(alpha, angle, (1, 0, -(angle**2)), count)
    phase, scale = angle * np.arange(1, count + 1), np.array([1, angle, angle**2])
    exact = np.column_stack(
        [np.cos(phase), -np.sin(phase), -np.cos(phase + alpha * angle), -np.cos(phase)]
    )
    error = np.abs((history[1:] / scale)[:, [0, 1, 2, 2]] - exact).max(axis=0)
    z, A, away = history[0], amplification(alpha, angle), 0.0
    for found in history[1:]:
        z = A @ z
        away = max(away, np.abs((found - z) / scale).max())
    return error, away, float(np.abs(energy - 1).max())


def decays(
    mode: Mode, alpha: float
) -> list[tuple[tuple[float, float], tuple[float, float], float]]:
    """(damping ratio, period error) of the method and of five periods of the solver, and its
    closure, for each of _COARSE.
    """
    found = []
    for ratio in _COARSE:
        angle = 2 * np.pi * ratio
        history, _, closure = mode.steps(alpha, angle, (1, 0, -(angle**2)), round(5 / ratio))
        both = principal(np.linalg.eigvals(amplification(alpha, angle))), of_history(history[:, 0])
        exact, computed = ((damping, angle / turned - 1) for damping, turned in both)
        found.append((exact, computed, closure))
    return found


def draw_scheme(
    figure: Figure,
    errors: Mapping[float, np.ndarray],
    damped: Mapping[float, list[tuple[tuple[float, float], tuple[float, float], float]]],
    angles: np.ndarray,
    radii: Mapping[float, list[float]],
) -> None:
    """Convergence, damping ratio, period error and spectral radius against dt over the period;
    lines exact but for the first.
    """
    (converged, damping), (period, radius) = figure.subplots(2, 2)
    ratios, fine, wide = (
        1 / np.array(PER_PERIOD),
        np.linspace(0.01, 0.42, 42),
        np.geomspace(0.05, angles[-1] / (2 * np.pi), 300),
    )
    shapes = ("o", 3, "$u$"), ("s", 6, "$v$"), ("^", 3.5, r"$a$, as of $t + \alpha\,\Delta t$")
    for alpha, (colour, dashes) in zip(_ALPHAS, LINES):
        line = dict(color=colour, linestyle=dashes, label=rf"$\alpha$ = {alpha:g}")
        mark = dict(color=colour, linestyle="none", markersize=3.5)
        pairs = np.array(
            [
                principal(np.linalg.eigvals(amplification(alpha, 2 * np.pi * ratio)))
                for ratio in fine
            ]
        )
        found = np.array([computed for _, computed, _ in damped[alpha]])
        largest = [
            np.abs(np.linalg.eigvals(amplification(alpha, 2 * np.pi * ratio))).max()
            for ratio in wide
        ]
        for axes, exact, computed in (
            (damping, pairs[:, 0], found[:, 0]),
            (period, 2 * np.pi * fine / pairs[:, 1] - 1, found[:, 1]),
        ):
            axes.plot(fine, 100 * exact, **line)
            axes.plot(_COARSE, 100 * computed, marker="o", **mark)
        radius.semilogx(wide, largest, **line)
        radius.semilogx(angles / (2 * np.pi), radii[alpha], marker="o", **mark)
        if alpha in (0.0, -0.333):
            for series, (shape, size, _) in zip(errors[alpha].T, shapes):
                converged.loglog(
                    ratios,
                    series,
                    color=colour,
                    linestyle=dashes,
                    linewidth=0.7,
                    marker=shape,
                    markersize=size,
                    markerfacecolor="none",
                )
    for shape, size, field in shapes:
        converged.plot(
            [],
            [],
            "k",
            linestyle="none",
            marker=shape,
            markersize=size,
            markerfacecolor="none",
            label=field,
        )
    converged.loglog(
        ratios,
        errors[-0.333][:, 3],
        "k",
        linestyle=":",
        marker="x",
        markersize=4,
        linewidth=0.7,
        label=r"$a$, as of $t$ ($\alpha$ = -0.333)",
    )
    converged.loglog(
        ratios,
        0.4 * errors[0.0][-1, 0] * (ratios / ratios[-1]) ** 2,
        "k--",
        linewidth=0.8,
        label="order 2",
    )
    converged.set_xticks(ratios, [f"1/{number}" for number in PER_PERIOD])
    converged.set_xticks([], minor=True)
    converged.set(ylabel=f"largest error / amplitude, {_PERIODS} periods")
    damping.plot([], [], "ko", markersize=3.5, label="solver")
    damping.set(ylabel="damping ratio [%]", xlim=(0, None), ylim=(-0.2, None))
    period.set(ylabel="period error [%]", xlim=(0, None), ylim=(0, None))
    radius.set(ylabel="spectral radius [-]", ylim=(0.4, 1.05))
    for axes in (converged, damping, period, radius):
        axes.set_xlabel(r"$\Delta t / T$")
    converged.legend()
    damping.legend(loc="upper left")
