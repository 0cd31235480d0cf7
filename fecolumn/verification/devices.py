"""Devices that hold a mass: a block slides without friction against bars that harden or bend, a
friction damper, a viscous damper and a stop with a gap, and through ropes that break.

Requirement: each lets the block go as far, and takes as much, as its law says, whatever the step,
and the energy balance closes. Glued joints: see `glue`.

Closed forms, of a block of mass m and velocity v, with F the yield force, k the stiffness, E = F /
k, h the hardening:
bilinear: F E / 2 + F x + h k x^2 / 2 = m v^2 / 2 at the elongation E + x, where it stops, and (1 -
h) F x is taken; friction: h = 0; curve of exponent 2: F E ln cosh(e / E) = m v^2 / 2; viscous, c
|v|^a: v^(1-a) falls by (1 - a) c t / m; stop: after the gap half a period pi sqrt(m / k), force v
sqrt(k m), back as fast as it came; ropes: each takes B^2 / 2 k, B the force at which it breaks.

Tolerances. A peak is that of the steps about it: 1e-5, times the square of a longer step. The mean
rate of a step of a viscous damper: 1e-5. A rope breaks at the end of the step in which it passes
its force, up to v dt farther: 1e-2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.case.case import case_from_tables
from fecolumn.verification.glue import glue_rows
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.structures_feet import CLOSED, closure_over_kinetic, columns_and_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_MASS, _SPEED, _STIFFNESS, _FORCE, _STEP = 200.0, 0.5, 2e5, 800.0, 2e-4
_YIELDS, _KINETIC = _FORCE / _STIFFNESS, _MASS * _SPEED**2 / 2
_BAR = dict(kind="spring", stiffness_n_m=_STIFFNESS, yield_n=_FORCE)
_FRICTION = dict(kind="friction", stiffness_n_m=_STIFFNESS, slip_n=_FORCE)
_PEAK, _BREAK = 1e-5, 1e-2


def run(engine: str, long: bool = False) -> CaseRows:
    """The rows; engine: reduced or rigid; long: at steps ten times as long, too."""
    rows: list[Row] = []
    drawn: list[tuple] = []
    for step in (_STEP, 10 * _STEP) if long else (_STEP,):
        for name, device, hardening in (
            ("friction damper", _FRICTION, 0.0),
            ("bar of hardening 0.1", _BAR | dict(hardening=0.1), 0.1),
        ):
            rows += _until_it_stops(name, device, *_bilinear(hardening), engine, step, drawn)
        rows += _until_it_stops(
            "bar of exponent 2", _BAR | dict(yield_exponent=2), *_curved(), engine, step, drawn
        )
        rows += _viscous(engine, step, drawn)
    rows += [*_stop(engine, drawn), *_ropes(engine)]
    torn: list[tuple] = []
    rows += glue_rows(engine, torn)

    def draw(figure: Figure) -> None:
        grid = figure.subplots(1, 6, squeeze=False)[0]
        for axes, (name, way, force) in zip(grid, drawn):
            axes.plot(1e3 * way, 1e-3 * force)
            axes.set(title=name, xlabel="elongation [mm]")
        grid[0].set_ylabel("force [kN]")
        for name, way, stress in torn:
            grid[-1].plot(1e3 * way, 1e-3 * stress, label=name)
        grid[-1].set(title="wax torn off", xlabel="opening [mm]", ylabel="stress [kPa]")
        grid[-1].legend(fontsize="x-small")

    return CaseRows(rows, draw, (13.0, 2.6))


def pushed(
    links: dict, engine: str, seconds: float, step: float
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Columns and rows of the history of a block that is pushed along x without friction, held by
    links of these keys to points 5 m behind it.
    """
    ends = dict(body="block", point_m=[0, 0, 0.25], to_point_m=[-5.0, 0, 0.25])
    case = case_from_tables(
        dict(
            bodies=dict(
                block=dict(
                    kind="block",
                    length_m=1.0,
                    width_m=1.0,
                    height_m=0.5,
                    mass_kg=_MASS,
                    youngs_modulus_pa=50e9,
                    element_size_m=0.5,
                )
            ),
            joints=dict(foot=dict(between=["block", "ground"])),
            links={name: ends | keys for name, keys in links.items()},
            contact=dict(friction_coefficient=0.0, interior_points=0),
            initial=dict(block=dict(velocity_m_s=[_SPEED, 0.0, 0.0])),
            integration=dict(dt_s=step, duration_s=100.0, engine=engine, start="drawn")
            | (dict(n_modes=6) if engine == "reduced" else {}),
        ),
        "devices",
    )
    return columns_and_rows(case, seconds)


def _bilinear(hardening: float) -> tuple[float, float]:
    """Elongation [m] at which a bilinear bar stops the block, and what it has taken then [J]."""
    left = _KINETIC - _FORCE * _YIELDS / 2
    if hardening:
        k = hardening * _STIFFNESS
        beyond = (math.sqrt(_FORCE**2 + 2 * k * left) - _FORCE) / k
    else:
        beyond = left / _FORCE
    return _YIELDS + beyond, (1 - hardening) * _FORCE * beyond


def _curved() -> tuple[float, float]:
    """The same of a bar with a curve of exponent 2 and without hardening."""
    cosh = math.exp(_KINETIC / (_FORCE * _YIELDS))
    return _YIELDS * math.acosh(cosh), _KINETIC - _FORCE * _YIELDS * (1 - 1 / cosh**2) / 2


def _until_it_stops(
    name: str, device: dict, far: float, taken: float, engine: str, step: float, drawn: list[tuple]
) -> Iterator[Row]:
    columns, rows = pushed(dict(device=device), engine, 0.4, step)
    way = columns["link/device/elongation"]
    # of the parabola through the largest and its neighbours: the block turns within a step
    top = int(np.argmax(way))
    fit = np.polyfit([-1, 0, 1], way[top - 1 : top + 2], 2)
    yield Row(
        f"{name}, step of {step:g} s: elongation at which the block stops [m]",
        far,
        float(np.polyval(fit, -fit[1] / (2 * fit[0]))),
        _PEAK * (step / _STEP) ** 2,
    )
    yield Row(
        "the same: energy taken until then [J]",
        taken,
        float(columns["link/device/work"][top]),
        _PEAK * (step / _STEP) ** 2,
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(rows), CLOSED)
    if step == _STEP:
        drawn.append((name, way, columns["link/device/tension"]))


def _viscous(
    engine: str, step: float, drawn: list[tuple], damping: float = 300.0, power: float = 0.5
) -> Iterator[Row]:
    seconds = 0.3
    keys = dict(kind="dashpot", damping_n_s_m=damping, damping_exponent=power)
    columns, rows = pushed(dict(device=keys), engine, seconds, step)
    # v^(1/2) falls linearly
    slope = damping / (2 * _MASS)
    last = math.sqrt(_SPEED) - slope * seconds
    yield Row(
        f"viscous damper of exponent 0.5, step of {step:g} s: way in {seconds:g} s [m]",
        (_SPEED**1.5 - last**3) / (3 * slope),
        float(columns["link/device/elongation"][-1]),
        _PEAK,
    )
    yield Row(
        "the same: energy taken [J]",
        _KINETIC - _MASS * last**4 / 2,
        float(columns["link/device/work"][-1]),
        _PEAK,
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(rows), CLOSED)
    if step == _STEP:
        # swings on a spring beside it
        spring = dict(kind="spring", stiffness_n_m=_STIFFNESS / 10)
        swung, _ = pushed(dict(device=keys, spring=spring), engine, 3.0, step)
        of = (swung[f"link/device/{one}"] for one in ("elongation", "tension"))
        drawn.append(("viscous damper of 0.5", *of))


def _stop(engine: str, drawn: list[tuple], gap: float = 0.01) -> Iterator[Row]:
    keys = dict(kind="stop", stiffness_n_m=_STIFFNESS, gap_m=gap, to_point_m=[5.0, 0, 0.25])
    columns, rows = pushed(dict(device=keys), engine, 0.2, _STEP)
    moved, time = columns["body/block/displacement"][:, 0], columns["time"]
    force = columns["link/device/tension"]
    yield Row(
        "stop with a gap: largest force [N]",
        _SPEED * math.sqrt(_STIFFNESS * _MASS),
        -float(force.min()),
        1e-4,
    )
    held = gap / _SPEED + math.pi * math.sqrt(_MASS / _STIFFNESS)
    back = (moved[-1] - moved[-11]) / (time[-1] - time[-11])
    yield Row(
        "the same: time at which it is let go, from the way back [s]",
        held,
        float(time[-1] - (moved[-1] - gap) / back),
        1e-4,
    )
    yield Row("the same: velocity back [m/s]", -_SPEED, float(back), 1e-8)
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(rows), CLOSED)
    drawn.append(("stop with a gap", columns["link/device/elongation"], force))


def _ropes(engine: str, breaks: float = 600.0) -> Iterator[Row]:
    rope = dict(kind="tendon", stiffness_n_m=_STIFFNESS, breaking_n=breaks)
    columns, rows = pushed(
        {f"rope_{n}": rope | dict(slack_m=0.01 * n) for n in range(4)}, engine, 0.2, _STEP / 10
    )
    moved, time = columns["body/block/displacement"][:, 0], columns["time"]
    taken = breaks**2 / (2 * _STIFFNESS)
    for n in range(4):
        broken = np.flatnonzero(columns[f"link/rope_{n}/broken"])
        yield Row(
            f"rope {n} of four of other slack: way at which it breaks [m]",
            0.01 * n + breaks / _STIFFNESS,
            float(moved[broken[0]]) if broken.size else math.nan,
            _BREAK,
            scale=breaks / _STIFFNESS,
        )
        yield Row(
            "the same: energy that it takes [J]",
            taken,
            float(columns[f"link/rope_{n}/work"][-1]),
            _BREAK,
        )
    yield Row(
        "four ropes: velocity after them [m/s]",
        math.sqrt(_SPEED**2 - 8 * taken / _MASS),
        float((moved[-1] - moved[-11]) / (time[-1] - time[-11])),
        _BREAK,
    )
    yield Row("the same: error of the energy balance", 0.0, closure_over_kinetic(rows), CLOSED)
