"""Wax and mortar below a block: torn off, sheared off, peeled by a moment, overturned.

Requirement: each point of a glued joint carries what its strength says and no more, takes the
energy that its law says, and the joint is a plain one afterwards.

Closed forms, of a block of mass m, weight W, half length b and height 2 h on a layer of stiffness k
and k_s, area A, tensile strength f, cohesion c, fracture energy G, points of area A_i at x_i from
the toe:
thrown up at v: the largest stress k z with w^2 = k A / m and z = sqrt((g / w^2)^2 + (v / w)^2) - g
/ w^2, and v^2 - f^2 A / (k m) - 2 g f / k left when it breaks, v^2 - 2 G A / m - 2 g z_f of one
that softens until z_f = 2 G / f; thrown along without friction: v^2 - c^2 A / (k_s m) left;
pulled by H at the top: a rigid foot turns about its toe, stress k t x at x with t = (2 H h - W b) /
(k sum A_i x_i^2 - W h - H b), on a pad of the same stiffness - W / A + k t (x - b) with t = 2 H h /
(k sum A_i (x_i - b)^2 - W h);
shaken by a slowly growing acceleration: it begins to fail at W b + M = m a h with M = f sum A_i
x_i^2 / (2 b), what a rigid block overturns at and the moment of the wax.

Tolerances. A point breaks at the end of the step in which it passes its strength: v dt k / f, below
1e-2. Stresses at rest: 1e-3, of a body that deforms 5e-3. A peak of a swing: 1e-3,
by the steps about it. Softening follows the law from step to step: 1e-2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.bonds import bonded
from fecolumn.structures.structure import structure_model
from fecolumn.verification.result import Row
from fecolumn.verification.structures_feet import CLOSED, closure_over_kinetic, columns_and_rows

_LENGTH, _WIDTH, _MASS, _STEP = 0.4, 0.3, 200.0, 1e-4
_AREA = _LENGTH * _WIDTH
_STIFFNESS, _STRENGTH = 5e7, 3e4
_WAX = dict(bond_tension_pa=_STRENGTH, bond_stiffness_n_m3=_STIFFNESS)
_STRONG = 1e8


def waxed_block(
    engine: str, joint: dict, height: float = 1.0, step: float = _STEP, **more: Any
) -> Case:
    """Case of a block on the ground with wax of these keys below it."""
    body = dict(
        kind="block",
        length_m=_LENGTH,
        width_m=_WIDTH,
        height_m=height,
        mass_kg=_MASS,
        youngs_modulus_pa=50e9,
        element_size_m=0.1,
    )
    tables = dict(
        bodies=dict(block=body),
        joints=dict(foot=dict(between=["block", "ground"]) | joint),
        contact=dict(friction_coefficient=0.6, interior_points=9),
        integration=dict(dt_s=step, duration_s=100.0, engine=engine)
        | (dict(n_modes=6) if engine == "reduced" else {}),
    )
    return case_from_tables(tables | more, "glue")


def glue_rows(engine: str, drawn: list) -> Iterator[Row]:
    """The rows; drawn: gets names, openings [m] and stresses [Pa] of what is torn off."""
    yield from _torn_off(engine, drawn)
    yield from _sheared_off(engine)
    yield from _peeled(engine)
    yield from _overturned(engine)


def _thrown(
    engine: str,
    joint: dict,
    velocity: list[float],
    seconds: float,
    step: float = _STEP,
    height: float = 1.0,
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    case = waxed_block(
        engine,
        joint,
        height,
        step,
        initial=dict(block=dict(velocity_m_s=velocity)),
    )
    # as drawn where no friction holds it, whose way to rest rounding would decide
    drawn = joint.get("friction_coefficient") == 0
    case = case.replace({"integration.start": "drawn"}) if drawn else case
    return columns_and_rows(case, seconds)


def _of(columns: Mapping[str, np.ndarray], what: str) -> np.ndarray:
    return next(
        value
        for name, value in columns.items()
        if name.startswith("bond/") and name.endswith(f"/{what}")
    )


def _torn_off(engine: str, drawn: list) -> Iterator[Row]:
    square, speed = _STIFFNESS * _AREA / _MASS, 0.06
    columns, rows = _thrown(engine, _WAX, [0.0, 0.0, speed], 0.02)
    still = GRAVITY / square
    yield Row(
        "wax below a block thrown up: largest tension [Pa]",
        _STIFFNESS * (math.sqrt(still**2 + speed**2 / square) - still),
        float(_of(columns, "stress").max()),
        1e-2,
    )
    yield Row("the same: share that fails", 0.0, float(_of(columns, "failed")[-1]), 1e-15)
    speed = 0.5
    energy = 4 * _STRENGTH**2 / (2 * _STIFFNESS)
    for name, joint, far, taken in (
        ("brittle wax", _WAX, _STRENGTH / _STIFFNESS, _STRENGTH**2 / (2 * _STIFFNESS)),
        (
            "wax that softens",
            _WAX | dict(bond_fracture_energy_j_m2=energy),
            2 * energy / _STRENGTH,
            energy,
        ),
    ):
        columns, rows = _thrown(engine, joint, [0.0, 0.0, speed], 0.02, _STEP / 10)
        rise, time = columns["body/block/displacement"][:, 2], columns["time"]
        failed = _of(columns, "failed")
        whole = int(np.argmax(failed > 1 - 1e-9))
        yield Row(f"{name} torn off: share that fails", 1.0, float(failed[-1]), 1e-12)
        yield Row(
            "the same: largest tension [Pa]", _STRENGTH, float(_of(columns, "stress").max()), 1e-2
        )
        yield Row("the same: opening at which it has failed [m]", far, float(rise[whole]), 1e-2)
        yield Row(
            "the same: energy taken [J]", taken * _AREA, float(_of(columns, "work")[-1]), 1e-2
        )
        after = (rise[-1] - rise[-11]) / (time[-1] - time[-11])
        later = (time[-1] + time[-11]) / 2 - time[whole]
        yield Row(
            "the same: velocity after it [m/s]",
            math.sqrt(speed**2 - 2 * taken * _AREA / _MASS - 2 * GRAVITY * far) - GRAVITY * later,
            float(after),
            1e-2,
        )
        yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(rows), CLOSED)
        drawn.append((name, rise[: whole + 2], _of(columns, "stress")[: whole + 2]))


def _sheared_off(engine: str, cohesion: float = 2e4, speed: float = 0.2) -> Iterator[Row]:
    shear = 0.4 * _STIFFNESS
    joint = _WAX | dict(
        bond_tension_pa=_STRONG, bond_cohesion_pa=cohesion, friction_coefficient=0.0
    )
    columns, rows = _thrown(engine, joint, [speed, 0.0, 0.0], 0.02, _STEP / 10, height=0.1)
    moved, time = columns["body/block/displacement"][:, 0], columns["time"]
    whole = int(np.argmax(_of(columns, "failed") > 1 - 1e-9))
    yield Row(
        "wax sheared off without friction: slip at which it fails [m]",
        cohesion / shear,
        float(moved[whole]),
        1e-2,
    )
    yield Row(
        "the same: velocity after it [m/s]",
        math.sqrt(speed**2 - cohesion**2 * _AREA / (shear * _MASS)),
        float((moved[-1] - moved[-11]) / (time[-1] - time[-11])),
        1e-2,
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(rows), CLOSED)


def _peeled(engine: str, height: float = 1.0) -> Iterator[Row]:
    """By a long soft tendon at the top, at rest."""
    tendon = dict(
        kind="tendon",
        body="block",
        point_m=[0.0, 0.0, height],
        to_point_m=[200.0, 0.0, height],
        stiffness_n_m=100.0,
    )
    pad = dict(stiffness_n_m3=_STIFFNESS)
    for name, below, pull in (("a rigid foot", {}, 600.0), ("a pad of its stiffness", pad, 300.0)):
        links = dict(tendon=tendon | dict(prestress_n=pull))
        case = waxed_block(engine, _WAX | below, height, 1e-3, links=links)
        columns, _ = columns_and_rows(case, 2e-3)
        force = float(columns["link/tendon/tension"][0])
        x, areas = points_of(case)
        weight, half = _MASS * GRAVITY, _LENGTH / 2
        # its weight and the pull move as it turns
        if below:
            inertia = areas @ (x - half) ** 2
            turn = force * height / (_STIFFNESS * inertia - weight * height / 2)
            stress = _STIFFNESS * turn * half - weight / areas.sum()
        else:
            arms = _STIFFNESS * (areas @ x**2) - weight * height / 2 - force * half
            stress = _STIFFNESS * (force * height - weight * half) / arms * _LENGTH
        yield Row(
            f"wax on {name}, block pulled at its top: tension at the edge [Pa]",
            stress,
            float(_of(columns, "stress")[0]),
            1e-3 if engine == "rigid" else 5e-3,
        )


def points_of(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Of the points of the joint of a case of `waxed_block`: places along x from the edge at +x
    (k,) [m], and areas (k,) [m2].
    """
    model = structure_model(case)
    (joint,) = bonded(model)
    surface = model.parts[joint.slave].model.surfaces[joint.slave_surface]
    arms = model.parts[joint.slave].model.arms[surface.nodes[joint.bond.rows]]
    return _LENGTH / 2 - arms[:, 0], joint.bond.areas


def _overturned(
    engine: str, height: float = 1.0, most: float = 10.0, seconds: float = 2.0
) -> Iterator[Row]:
    case = waxed_block(engine, _WAX | dict(friction_coefficient=0.9), height, 1e-3)
    x, areas = points_of(case)
    wax = _STRENGTH * (areas @ x**2) / _LENGTH
    ramp = np.zeros((round(seconds / 1e-3), 3))
    # the ground to -x: the block leans towards +x
    ramp[:, 0] = -most * np.arange(1, len(ramp) + 1) / len(ramp)
    columns, rows = columns_and_rows(case, seconds, ramp)
    first = int(np.argmax(_of(columns, "failed") > 0))
    yield Row(
        "waxed block in a growing acceleration: that at which it begins to overturn [m/s2]",
        GRAVITY * _LENGTH / height + 2 * wax / (_MASS * height),
        float(-columns["ground"][first, 0]),
        1e-2,
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(rows), CLOSED)
