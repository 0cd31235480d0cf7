"""The same shaking seen from other frames: base moving, turned, mirrored, later.

Requirement: the answer does not depend on whether the base moves or inertia forces stand for it, on
the direction of the axes, on their hand, or on when the motion begins.

Derivation. Table frame (what the engine does): base at rest, loads M (g - a_g). Inertial frame:
loads M g alone, unknown the absolute motion x_abs = x + x_g; contact sees positions x_abs - x_g and
velocities v_abs - v_g. HHT's acceleration of the absolute motion is a + A_g, A_g1 = (1 + al) a_g1 -
al a_g0, so that the two analyses are the same equations once the base is moved by the formulas of
HHT,

    x_g1 = x_g0 + dt v_g0 + dt^2 [(1/2 - be) A_g0 + be A_g1],
    v_g1 = v_g0 + dt [(1 - ga) A_g0 + ga A_g1].

Moved on its exact path instead, the base differs from these by e_g(t), second order in dt and known
beforehand. Energy: in the inertial frame the base works through the contact forces, W_b = sum r1 .
(x_g1 - x_g0) + sum v_g1 . p, p the impulses by which an impact replaces those of the step. With
alpha = 0 friction, impact and contact together lose the same in both frames: T_abs + U = start +
W_b + losses; the ledger of the table frame has the work of the inertia forces in its place.

A turn Q of body and motion about z gives x Q^T: the coarse mesh is its own image under 90 degrees
and under y -> -y, so that the motion alone is turned; for 30 degrees the body's mesh is turned too.
The base's grid stays, and its bricks answer turned loads otherwise: exact only on a rigid base (E =
1e15 Pa). A round rim does not know where its nodes are: the motion alone may be turned by 10
degrees, a sector and two thirds.

The reduced engine's compiled steps know no moving base: it is turned, mirrored and put off only.

Source. Newton's laws; the discrete form follows from Hilber, Hughes and Taylor (1977) by adding
x_g.

Tolerances. `solver_drift`: unbalanced forces of eps = max(1e-7, rounding) of the weight left in
every step give eps g t cosh(p t) in velocity and t / 2 times that in displacement; twice as much
between two analyses. Energies, quadratic in velocity: twice the relative error of the velocity (2 E
/ m)^(1/2). Exact base path: the error e_v of the base's velocity, which the column takes over where
it lands and drifts with, and that of its displacement in the base's place and in the column's: (e_v
t + 2 e_g) cosh(p t). Turned by 10 or 30 degrees: no more than the whole effect of the base's
elasticity, the difference between elastic and rigid base; on the base of E = 1e15 Pa its share
200e9 / 1e15. Growth of differences by chaos would break these bounds: the figure shows that a
disturbance of 1 um/s does not grow in this window.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.engines.dynamics.system import State, System
from fecolumn.engines.elements import checked_layout
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.pictures.figures.style import LINES
from fecolumn.structures.shape import Shape
from fecolumn.verification import FULL
from fecolumn.verification.models import (
    column_case,
    column_system,
    shaking,
    system_of,
    with_shape,
)
from fecolumn.verification.moving_base import (
    InertialTrial,
    by_hht,
    exact_path,
    hht_path,
    on_exact_path,
)
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.trial import RigidRocking, Trial, solver_drift

if TYPE_CHECKING:
    from matplotlib.figure import Figure


RIGID = {"base": {"youngs_modulus_pa": 1e15}}
QUIET_STEPS = 50
DISTURBANCE = 1e-6  # m/s
# of the ledger; the work of a moving base is not told apart by them
_LOSSES = ("friction", "impact", "contact")


def turned_system(turn: np.ndarray, engine: str, **tables: Any) -> System:
    """The coarse specimen with its body's mesh turned by `turn` (3, 3); the base stays."""
    case = column_case(engine, **tables)

    def turned(shape: Shape) -> Shape:
        return replace(shape, mesh=replace(shape.mesh, points=shape.mesh.points @ turn.T))

    return system_of(case, with_shape(checked_layout(case, "verification"), turned, turn))


def run(engine: str, long: bool) -> CaseRows:
    """Rows of shaking seen from a moving, a turned, a mirrored and a later frame."""
    result = CaseRows(size=(7.2, 3.7))
    system = column_system(engine)
    times = system.hht.dt * np.arange(1, (200 if long or engine != "total_lagrangian" else 125) + 1)
    motion, drift = shaking(times), solver_drift(system, times)
    table = begin_trial(engine, system)
    reference = table.shake(motion)
    largest, series = np.linalg.norm(reference, axis=2).max(), {}
    allowed = (drift * times).max() / largest

    def standing(_: System, disturbance: float = 0.0) -> State:
        start = table.start.copy()
        start.v = start.v + disturbance * np.array([1.0, 0.7, 0.0])
        return start

    def compare(
        name: str, path: np.ndarray, tolerance: float = allowed, against: np.ndarray = reference
    ) -> None:
        difference = np.linalg.norm(path - against, axis=2).max(axis=1)
        series[name] = difference
        result.rows.append(
            Row(
                f"{name}: path of top and foot [m]", 0.0, difference.max(), tolerance, scale=largest
            )
        )

    if engine in FULL:  # compiled steps know no moving base
        inertial = InertialTrial(system, standing, by_hht)
        relative = inertial.shake(motion)
        compare("base moving", relative)
        result.rows += frame_ledgers(table, inertial, drift[-1])
        damped = column_system(engine, integration={"alpha_hht": -0.2})
        still = Trial(damped)
        compare(
            "base moving, alpha -0.2",
            InertialTrial(damped, lambda _: still.start.copy(), by_hht).shake(motion),
            against=still.shake(motion),
        )
        coarse = Trial(column_system(engine, integration={"dt_s": 2 * system.hht.dt}))
        exact = InertialTrial(coarse.system, lambda _: coarse.start.copy(), on_exact_path).shake(
            motion[1::2]
        )
        double = np.linalg.norm(exact - coarse.shake(motion[1::2]), axis=2).max()
        off = [
            np.linalg.norm(exact - stepped, axis=1).max()
            for exact, stepped in zip(exact_path(times), hht_path(system.hht, motion))
        ]
        compare(
            "base moving on its exact path",
            InertialTrial(system, standing, on_exact_path).shake(motion),
            (off[1] * times[-1] + 2 * off[0])
            * np.cosh(RigidRocking(system).p * times[-1])
            / largest,
        )
        result.rows[-1] = replace(
            result.rows[-1], order=float(np.log2(double / result.rows[-1].computed))
        )

    quarter, mirror = np.round(rotation_matrix([0, 0, np.pi / 2])), np.diag([1.0, -1.0, 1.0])
    compare(
        "motion turned by 90 deg",
        begin_trial(engine, system, standing).shake(motion @ quarter.T) @ quarter,
    )
    compare(
        "motion mirrored", begin_trial(engine, system, standing).shake(motion @ mirror) @ mirror
    )
    later = np.vstack([np.zeros((QUIET_STEPS, 3)), motion])
    compare(
        f"{QUIET_STEPS} quiet steps before",
        begin_trial(engine, system, standing).shake(later)[QUIET_STEPS:],
    )
    turn = rotation_matrix([0, 0, np.pi / 6])
    turned = partial(turned_system, turn, engine)
    rigid = begin_trial(engine, column_system(engine, **RIGID)).shake(motion)
    elasticity = np.linalg.norm(rigid - reference, axis=2).max() / largest
    compare(
        "body and motion turned by 30 deg, rigid base",
        begin_trial(engine, turned(**RIGID)).shake(motion @ turn.T) @ turn,
        allowed + 200e9 / 1e15 * elasticity,
        rigid,
    )
    compare(
        "body and motion turned by 30 deg, elastic base",
        begin_trial(engine, turned()).shake(motion @ turn.T) @ turn,
        allowed + elasticity,
    )
    between = rotation_matrix([0, 0, np.radians(10)])
    compare(
        "motion turned by 10 deg, between nodes of the rim",
        begin_trial(engine, system, standing).shake(motion @ between.T) @ between,
        allowed + elasticity,
    )
    disturbed = begin_trial(engine, system, lambda _: standing(_, DISTURBANCE)).shake(motion)
    grown = np.linalg.norm(disturbed - reference, axis=2).max(axis=1)

    def draw(figure: Figure) -> None:
        panels, below = figure.subfigures(2, 1, height_ratios=(1, 0.3))
        left, right = panels.subplots(1, 2, width_ratios=(1, 1.5))
        left.plot(
            *1e3 * exact_path(times)[0][:, :2].T, color="0.6", linewidth=0.8, label="base, absolute"
        )
        left.plot(*1e3 * reference[:, 0, :2].T, color=LINES[0][0], label="top, table frame")
        if engine in FULL:
            left.plot(
                *1e3 * relative[::5, 0, :2].T,
                "o",
                color=LINES[1][0],
                markersize=3,
                fillstyle="none",
                label="top, base moving",
            )
        left.set(xlabel="$u_x$ [mm]", ylabel="$u_y$ [mm]", aspect="equal")
        left.legend(loc="upper left")
        for (name, difference), (colour, dashes) in zip(
            series.items(), (*LINES, ("#7F3F00", "-."), ("#882255", (0, (3, 1))))
        ):
            right.semilogy(
                times, np.maximum(difference, 1e-17), color=colour, linestyle=dashes, label=name
            )
        right.semilogy(
            times,
            grown,
            color="0.7",
            linewidth=2.5,
            label=f"disturbed by {1e6 * DISTURBANCE:g} µm/s",
            zorder=0,
        )
        right.semilogy(
            times,
            drift * times,
            color="k",
            linewidth=0.8,
            linestyle=":",
            label="what the solver may leave",
        )
        right.set(xlabel="time [s]", ylabel="largest difference [m]", xlim=(0, times[-1]))
        below.legend(*right.get_legend_handles_labels(), loc="center", ncols=3)

    result.draw = draw
    return result


def frame_ledgers(table: Trial, inertial: InertialTrial, drift: float) -> list[Row]:
    """The ledgers of the two frames at the end, `drift` [m/s] apart."""
    of_table, of_inertial = table.energy(), inertial.trial.energy()
    start = inertial.trial.ledger.start
    assert start is not None
    gained = inertial.trial.mechanical() - start
    lost = sum(of_table[name] for name in (*_LOSSES, "closure"))
    allowed = 2 * drift / np.sqrt(2 * gained / table.system.body.total_mass)
    return [
        Row("base moving: work of the base [J]", gained - lost, inertial.work, allowed),
        Row(
            "base moving: loss of friction, impact and contact [J]",
            sum(of_table[name] for name in _LOSSES),
            sum(of_inertial[name] for name in _LOSSES) - inertial.work,
            allowed,
            scale=gained,
        ),
        Row(
            "base moving: closure of the inertial ledger [J]",
            of_table["closure"],
            of_inertial["closure"],
            allowed,
            scale=gained,
        ),
    ]
