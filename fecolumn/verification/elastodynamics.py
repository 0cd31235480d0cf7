"""A standing shear wave of a free cube that touches nothing: convergence in space and in time to
the exact solution.

Requirement: displacement and velocity converge with order 2 in the brick size for bricks of degree
1, 3 for degree 2, on straight and on crooked bricks, and with order 2 in the time step for every
alpha.

Derivation. With X, Y, Z = k x, k y, k z and k = pi / side,

    u = A sin(w t) (cos X sin Y, -cos Y (sin X + sin Z), sin Y cos Z),    w = k (2 mu / rho)^(1/2),

is the sum of two of Lame's modes, in the planes xy and yz: div u = 0, the strains e_xy, e_yz, e_zx
vanish and e_xx, e_yy, e_zz are nil on the faces normal to x, y, z, so that all six faces are free
for any Poisson's ratio. It starts unstrained, so that a0 = g. The error is that of u and v
together, each over its amplitude: a frequency that is off by dw then shows as dw t at any moment.
Straight trilinear bricks of size h interpolate with strain errors (k h / 2) (1 - 2 s) k u', s the
place in the brick, u' the terms of a component that vary in the direction. Their energy over the
wave's is (k h)^2 / 12 (lambda / 2 mu + 1 + 1 / 2 N), N = 1 + 4 / pi^2 the mean of (u / A)^2, and
the frequency is too high by half of that share (Galerkin's error of an eigenvalue is the energy of
the interpolation's): 0.088 (k h)^2 for nu = 0.3. Crooked bricks have their inner corners moved by
0.15 h to and fro, so that they are no parallelepipeds at any h: the order holds for full
tensor-product spaces (Arnold, Boffi and Falk 2002), the constant does not.

Source. Lame (1852), Lecons sur la theorie mathematique de l'elasticite; Hughes (1987), The Finite
Element Method, sections 8 and 9.

Tolerances. Error of degree 1 after a period: the frequency's times w t = 2 pi, and the sag of the
interpolation, (k h)^2 / 8 for each of two directions. Orders by least squares: the next term of the
expansion is (k h)^2 / 4 of the first or less, (k h / 2)^2, 0.07 on the coarsest bricks of degree 1
and 0.27 of degree 2; over sizes in the ratio 2 that turns the slope by 0.1 and 0.4: 5 % of 2, 13 %
of 3. Degree 2 is seen after an eighth of a period, before its frequency error, of order 4, outgrows
the order 3 of the field. In dt the next term is 3 / 20 (w dt)^2 of the first, and the error in
space its own share of the smallest error in time; both over the logarithm of the steps' ratio.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import ufl
from dolfinx import fem
from matplotlib.figure import Figure
from petsc4py import PETSc

from fecolumn.engines.dynamics.hht import HHT
from fecolumn.fem.body import Body
from fecolumn.mesh.bricks import BrickMesh
from fecolumn.pictures.figures.style import LINES
from fecolumn.verification.models import block_system, box
from fecolumn.verification.result import CaseRows, Row, order_of
from fecolumn.verification.trial import Trial, afloat

# Steel of models.block_system; strains of 3e-5 keep both kinematics linear
_SIDE, _AMPLITUDE, _SHEAR, POISSON, _DENSITY = 0.1, 1e-6, 200e9 / 2.6, 0.3, 7850.0
_WAVE = np.pi / _SIDE
_FREQUENCY = _WAVE * np.sqrt(2 * _SHEAR / _DENSITY)
# Mean square of the mode's shape
MEAN = 1 + 4 / np.pi**2
PERIOD = 2 * np.pi / _FREQUENCY
# [m/s2], [m]. The solver's tolerance is a share of the weight and must lie above rounding, which
# for steps this short is that of 10 g
_GRAVITY, _HEIGHT = 300.0, 1e-3
CROOKED = 0.15
# By degree: bricks a side, the periods they run through, steps a period, tolerance of the order
MESHES = {1: (6, 8, 12), 2: (3, 4, 6)}
_PERIODS = {1: 1.0, 2: 0.125}
_STEPS = {1: 120, 2: 480}
BEND = {1: 0.05, 2: 0.13}
_ALPHAS = (0.0, -0.1, -0.333)
# Steps a period of the convergence in dt, on bricks of degree 2
_COUNTS = (16, 24, 36)


def bricks(number: int, crooked: float) -> BrickMesh:
    """Cube of `number` bricks a side, inner corners moved along the diagonal by `crooked` of a
    brick to and fro.
    """
    line = np.linspace(0, _SIDE, number + 1)
    mesh = box(line, line, line)
    place = np.rint(mesh.points / _SIDE * number)
    inner = np.all((place > 0) & (place < number), axis=1)
    sign = np.where(place.sum(axis=1) % 2, 1.0, -1.0) * inner
    return replace(
        mesh, points=mesh.points + (crooked * _SIDE / number) * sign[:, None] * [1.0, -1.0, 1.0]
    )


def shape(x: Any, sin: Callable[[Any], Any], cos: Callable[[Any], Any]) -> tuple[Any, Any, Any]:
    """The mode (3,) at x, in the functions of numpy or ufl."""
    X, Y, Z = (_WAVE * x[axis] for axis in range(3))
    return cos(X) * sin(Y), -cos(Y) * (sin(X) + sin(Z)), sin(Y) * cos(Z)


def error(
    engine: str,
    number: int,
    degree: int,
    steps: int,
    periods: float = 1.0,
    alpha: float = 0.0,
    crooked: float = 0.0,
) -> float:
    """L2 error of displacement and velocity after `periods` of `steps` each, over their amplitudes
    [-].
    """
    plate, dt = [-_SIDE, 2 * _SIDE], PERIOD / steps
    system = block_system(
        engine,
        bricks(number, crooked),
        box(plate, plate, [-_SIDE, 0]),
        HHT(dt, alpha),
        gravity=(0, 0, -_GRAVITY),
        order=degree,
    )
    column = system.body
    mode, fall = (
        np.stack(shape(column.X.T, np.sin, np.cos), axis=1),
        np.array([0.0, 0.0, -_GRAVITY]),
    )
    still = np.zeros_like(mode)
    trial = Trial(
        system,
        lambda system: afloat(
            system, still, _AMPLITUDE * _FREQUENCY * mode, still + fall, height=_HEIGHT
        ),
    )
    for _ in range(round(periods * steps)):
        trial.step()
    time = periods * PERIOD
    moved = trial.state.x - column.X - [0.0, 0.0, _HEIGHT] - fall * time**2 / 2
    speed = trial.state.v - fall * time
    return float(
        np.hypot(
            distance(column, moved / _AMPLITUDE, np.sin(2 * np.pi * periods)),
            distance(column, speed / (_AMPLITUDE * _FREQUENCY), np.cos(2 * np.pi * periods)),
        )
    )


def distance(column: Body, field: np.ndarray, factor: float) -> float:
    """L2 distance of a finite-element field (n, 3) from `factor` times the mode, over the mode's
    norm; inside the bricks, not at nodes.
    """
    found, scale = fem.Function(column.space), fem.Constant(column.mesh, PETSc.ScalarType(factor))
    found.x.array[:] = field.reshape(-1)
    wrong = found - scale * ufl.as_vector(
        shape(ufl.SpatialCoordinate(column.mesh), ufl.sin, ufl.cos)
    )
    square = fem.assemble_scalar(
        fem.form(ufl.inner(wrong, wrong) * ufl.dx(metadata={"quadrature_degree": 6}))
    )
    return float(np.sqrt(square / (_SIDE**3 * MEAN)))


def run(engine: str, long: bool) -> CaseRows:
    """The slower engine has coarser bricks of degree 2 and one alpha unless `long`."""
    whole = long or engine == "corotated"
    meshes = MESHES if whole else MESHES | {2: (2, 3, 4)}
    result, spatial = CaseRows(size=(7.2, 2.9)), {}
    for degree, numbers in meshes.items():
        for crooked in (0.0, CROOKED):
            errors = [
                error(engine, number, degree, _STEPS[degree], _PERIODS[degree], crooked=crooked)
                for number in numbers
            ]
            spatial[degree, crooked] = np.pi / np.array(numbers), errors
    sizes, errors = spatial[1, 0.0]
    stiff = sizes[-1] ** 2 / 24 * (POISSON / (1 - 2 * POISSON) + 1 + 0.5 / MEAN)
    result.rows.append(
        Row(
            f"L2 error after a period, straight bricks, k h = {sizes[-1]:.3g} [-]",
            0.0,
            errors[-1],
            2 * np.pi * stiff + sizes[-1] ** 2 / 4,
            order=order_of(sizes, errors),
        )
    )
    for (degree, crooked), series in spatial.items():
        kind, order = "crooked" if crooked else "straight", order_of(*series)
        result.rows.append(
            Row(
                f"order in h, degree {degree}, {kind} bricks [-]",
                degree + 1.0,
                order,
                BEND[degree],
                order=order,
            )
        )
    number = meshes[2][-1]
    remains = error(engine, number, 2, 240)
    temporal = {
        alpha: [error(engine, number, 2, count, alpha=alpha) for count in _COUNTS]
        for alpha in (_ALPHAS if whole else _ALPHAS[1:2])
    }
    steps = 2 * np.pi / np.array(_COUNTS)
    for alpha, errors in temporal.items():
        bend = (remains / errors[-1] + 0.15 * steps[0] ** 2) / np.log(steps[0] / steps[-1])
        order = order_of(steps, errors)
        result.rows.append(
            Row(f"order in dt, alpha {alpha:g} [-]", 2.0, order, bend / 2, order=order)
        )
    result.draw = lambda figure: draw_orders(figure, spatial, steps, temporal)
    return result


def draw_orders(
    figure: Figure,
    spatial: Mapping[tuple[int, float], tuple[np.ndarray, Sequence[float]]],
    steps: np.ndarray,
    temporal: Mapping[float, Sequence[float]],
) -> None:
    """Displacement errors against brick size and time step, with the orders."""
    left, right = figure.subplots(1, 2)
    for (degree, crooked), (sizes, errors) in spatial.items():
        colour, dashes = LINES[degree - 1]
        kind = "crooked" if crooked else "straight"
        left.loglog(
            sizes,
            errors,
            color=colour,
            linestyle=dashes,
            marker="s" if crooked else "o",
            markersize=3.5,
            markerfacecolor="none" if crooked else colour,
            label=f"degree {degree}, {kind}: order {order_of(sizes, errors):.2f}",
        )
    left.set(xlabel=r"$k\,h$ [-]", ylabel="error / amplitude ($L_2$)")
    for (alpha, errors), mark, (colour, dashes) in zip(temporal.items(), "os^", LINES):
        right.loglog(
            steps,
            errors,
            color=colour,
            linestyle=dashes,
            marker=mark,
            markersize=3.5,
            label=rf"$\alpha$ = {alpha:g}: order {order_of(steps, errors):.2f}",
        )
    right.set(xlabel=r"$\omega\,\Delta t$ [-]", ylabel="error after a period / amplitude ($L_2$)")
    for axes, ticks in (
        (left, sorted({size for sizes, _ in spatial.values() for size in sizes})),
        (right, steps),
    ):
        axes.set_xticks(ticks, [f"{tick:.2g}" for tick in ticks])
        axes.set_xticks([], minor=True)
        axes.legend()
