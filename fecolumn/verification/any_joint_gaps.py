"""Blocks beside each other or beside a wall on one shaken ground, a gap between them, beside an
independent planar program and plane problems in closed form.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced.engine import Engine
from fecolumn.verification.boxes import sine_pulse
from fecolumn.verification.joint_bodies import engines
from fecolumn.verification.result import Row

# Width and height of the block on the left, of that on the right [m]
_LEFT, _RIGHT = (0.3, 1.0), (0.4, 1.0)
# Steps [s] of rigid bodies and of elastic ones, which bounce in shorter ones and slide meanwhile
_STEPS = {"rigid": 1e-4, "reduced": 1e-3}
# One cycle of a sine: amplitude [g] and period [s]
_CYCLE = (0.4, 0.6)
# Peak tilts [rad] of both blocks by a planar program written independently, by mu of their sides
_PEAKS = {0.7: (0.0466, 0.0294), 0.0: (0.0506, 0.0330)}
# Peak tilt [rad] beside a wall, by gap [m]
_STOPPED = {0.02: 0.0200, 0.05: 0.0500}
# Under cycles of a sine of these amplitudes [g] and periods [s], gap 0.02 m, side friction 0.7:
# tilts towards +x [rad] of both blocks at times [s] up to their third impact, by
# benchmarks/planar with steps of 2e-5 s
_TILTS = {
    (0.4, 0.6): {
        0.1812: (-0.004174, 0.0),
        0.3624: (-0.005250, 0.0),
        0.5436: (0.040314, 0.023089),
        0.7248: (0.017363, 0.000027),
    },
    (0.35, 0.8): {
        0.2095: (-0.001123, 0.0),
        0.419: (0.000078, 0.0),
        0.6286: (0.019693, 0.0),
        0.8381: (0.000016, 0.000083),
    },
    (-0.35, 0.8): {
        0.2487: (0.003067, 0.0),
        0.4975: (-0.009486, 0.0),
        0.7462: (-0.036578, 0.0),
        0.995: (0.019988, 0.0),
    },
    (0.5, 0.5): {
        0.1014: (-0.001237, -0.000147),
        0.2028: (-0.020840, -0.006651),
        0.3042: (-0.035635, 0.003987),
        0.4056: (0.020133, 0.029813),
    },
    (-0.5, 0.5): {
        0.0864: (0.000448, 0.000015),
        0.1727: (0.012845, 0.004141),
        0.2591: (0.028411, 0.009224),
        0.3455: (0.000031, -0.010595),
    },
    (0.45, 0.7): {
        0.1308: (-0.000734, -0.000003),
        0.2617: (-0.022371, -0.003789),
        0.3925: (-0.046259, 0.000886),
        0.5234: (0.019963, 0.004594),
    },
    (0.6, 0.4): {
        0.0905: (-0.002869, -0.001047),
        0.181: (-0.029223, -0.014459),
        0.2715: (-0.042020, -0.003111),
        0.362: (0.020431, 0.049868),
    },
}


# By how much a velocity after an impact may miss momentum and restitution, over the approach:
# `tolerances.RIGID_GIVE`. The points store that share of it where they land just at the end of a
# step, and give it back in the next one
_SLID = 1e-3
# Where in a step the blocks meet: how much narrower than 400 steps their gap is [steps]. At 0
# rounding says which points carry at the end of the step, which differs from processor to processor
_SHORT = (-0.5, -1e-6, 0.0, 1e-6, 0.5)


def gap_rows(engine: str) -> Iterator[Row]:
    """Rows of one engine; single histories and the share of one impact are those of rigid bodies:
    what elastic faces store at an impact, and give back, moves them by per cent.
    """
    yield from _peak_rows(engine)
    if engine == "rigid":
        yield from _history_rows(engine)
        yield from _slide_rows()
    yield from _wall_rows(engine)


def _slide_rows() -> Iterator[Row]:
    """A block slides without friction into one twice as heavy, which stands: their velocities after
    by momentum and restitution; neither is lifted. They meet at several moments of a step, of which
    the row has the one farthest from the closed form.
    """
    for restitution in (0.0, 0.5, 1.0):
        after, lifted = zip(*(_slid_into(restitution, short) for short in _SHORT))
        told = f"a block slides into one twice as heavy, restitution {restitution:g}"
        shares = {"left": (1 - 2 * restitution) / 3, "right": (1 + restitution) / 3}
        for body, (name, share) in enumerate(shares.items()):
            yield Row(
                f"{told}: velocity of the {name} one after over that before",
                share,
                max((one[body] for one in after), key=lambda one: abs(one - share)),
                _SLID,
                scale=1.0,
            )
        yield Row(f"{told}: how far either is lifted [m]", 0.0, max(lifted), 1e-7)


def _slid_into(restitution: float, short: float) -> tuple[list[float], float]:
    """Velocities of both blocks after the impact over that before, and how far either is lifted
    [m]. short: the gap is this many steps narrower than 400 of them.
    """
    speed, dt, steps = 0.5, 1e-4, 400
    gap = (steps - short) * speed * dt
    side = dict(kind="block", length_m=0.4, width_m=0.5, height_m=0.4, element_size_m=0.4)
    bodies = dict(
        left=side | dict(mass_kg=100.0),
        right=side | dict(mass_kg=200.0, at_m=[0.4 + gap, 0.0, 0.0]),
    )
    joints = dict(
        foot=dict(between=["left", "ground"]),
        feet=dict(between=["right", "ground"]),
        side=dict(between=["left", "right"], restitution=restitution),
    )
    made = engines(
        dict(
            bodies=bodies,
            joints=joints,
            contact=dict(friction_coefficient=0.0, interior_points=0),
            initial=dict(left=dict(velocity_m_s=[speed, 0.0, 0.0])),
            integration=dict(engine="rigid", dt_s=dt, duration_s=1.0, start="drawn"),
        )
    )()
    rows, _ = made.advance(np.zeros((2 * steps, 3)))
    columns = columns_of(rows, made.model)
    ways = [columns[f"body/{name}/displacement"] for name in bodies]
    after = [float(way[-1, 0] - way[-2, 0]) / dt / speed for way in ways]
    return after, float(max(way[:, 2].max() for way in ways))


def _beside(
    engine: str, gap: float, friction: float, wall: bool, dt: float, start: dict | None = None
) -> Engine:
    """Engine of a block and, a gap [m] away on its right, another block or a wall; friction: of
    their sides.
    """
    stone = dict(kind="block", width_m=0.3, density_kg_m3=2500.0, element_size_m=0.3)
    (left, height), (right, other) = _LEFT, _RIGHT
    bodies = dict(
        left=stone | dict(length_m=left, height_m=height, at_m=[-left / 2, 0.0, 0.0]),
        right=stone
        | dict(length_m=right, height_m=other, at_m=[gap + right / 2, 0.0, 0.0], fixed=wall),
    )
    joints = dict(
        foot=dict(between=["left", "ground"]),
        side=dict(between=["left", "right"], friction_coefficient=friction),
    )
    if not wall:
        joints["feet"] = dict(between=["right", "ground"])
    tables = dict(
        bodies=bodies,
        joints=joints,
        contact=dict(friction_coefficient=0.7, interior_points=0),
        integration=dict(engine=engine, dt_s=dt, duration_s=10.0)
        | (dict(n_modes=10) if engine == "reduced" else {}),
    )
    if start:
        tables["initial"] = dict(left=start)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return engines(tables)()


def _cycle(dt: float, amplitude: float, period: float, lasts: float) -> np.ndarray:
    return sine_pulse(amplitude * GRAVITY, period, round(lasts / dt), dt)


def _shaken(made: Engine, grounds: np.ndarray) -> dict[str, np.ndarray]:
    """History under ground accelerations, with the tilts towards +x [rad] of both blocks."""
    columns = columns_of(made.advance(grounds)[0], made.model)
    return columns | {name: columns[f"body/{name}/rotation"][:, 1] for name in ("left", "right")}


def _closure(columns: Mapping[str, np.ndarray]) -> float:
    moved = max(np.ptp(columns["energy/gravity"]) + columns["energy/kinetic"].max(), 1e-9)
    return float(np.abs(columns["energy/closure"]).max() / moved)


def _peak_rows(engine: str) -> Iterator[Row]:
    dt, closures = _STEPS[engine], []
    for friction, peaks in _PEAKS.items():
        columns = _shaken(_beside(engine, 0.02, friction, False, dt), _cycle(dt, *_CYCLE, 3.0))
        closures.append(_closure(columns))
        for name, (width, _), peak in zip(("left", "right"), (_LEFT, _RIGHT), peaks):
            yield Row(
                f"blocks 0.3 x 1.0 and 0.4 x 1.0 m, gap 0.02 m, side friction {friction:g}, one "
                f"sine 0.4 g, 0.6 s: peak tilt of that of {width:g} m [rad]",
                peak,
                np.abs(columns[name]).max(),
                0.02,
            )
    for gap, peak in _STOPPED.items():
        columns = _shaken(_beside(engine, gap, 0.7, True, dt), _cycle(dt, *_CYCLE, 3.0))
        closures.append(_closure(columns))
        yield Row(
            f"block 0.3 x 1.0 m, a wall {gap:g} m away, the same motion: peak tilt [rad]",
            peak,
            np.abs(columns["left"]).max(),
            0.02,
        )
    columns = _shaken(_beside(engine, 0.02, 0.7, True, dt), -_cycle(dt, *_CYCLE, 3.0))
    closures.append(_closure(columns))
    yield Row(
        "block 0.3 x 1.0 m, a wall 0.02 m away, the motion reversed: peak tilt [rad], Housner's of "
        "the block alone",
        _housner_peak(*_CYCLE),
        np.abs(columns["left"]).max(),
        1e-3,
    )
    yield Row(
        "blocks and walls with gaps: error of the energy balance over the energy that moved, "
        "largest",
        0.0,
        max(closures),
        1e-11,
    )


def _history_rows(engine: str) -> Iterator[Row]:
    dt = 1e-4
    for motion, tilts in _TILTS.items():
        columns = _shaken(_beside(engine, 0.02, 0.7, False, dt), _cycle(dt, *motion, max(tilts)))
        places = [round(time / dt) - 1 for time in tilts]
        found = np.column_stack([columns[name][places] for name in ("left", "right")])
        exact = np.array(list(tilts.values()))
        yield Row(
            f"the two blocks, gap 0.02 m, one sine {motion[0]:g} g, {motion[1]:g} s: tilts until "
            "the third impact beside an independent planar program, error over the largest",
            0.0,
            np.abs(found - exact).max() / np.abs(exact).max(),
            0.01,
        )


def _wall_rows(engine: str) -> Iterator[Row]:
    """A block at a wall falls back to it and stops: it cannot turn on over its corner there, nor
    slide. One that rocks towards a wall a gap away meets it with its top corner: without friction
    there, the impulse at that corner alone decides, and the corner on which it stood lifts.
    """
    dt = _STEPS[engine]
    for friction in (0.0, 0.7):
        label = f"block at a wall, gap 0, side friction {friction:g}"
        made = _beside(engine, 0.0, friction, True, dt, dict(tilt_rad=0.05, direction_deg=180.0))
        columns = _shaken(made, np.zeros((round(0.4 / dt), 3)))
        fell = columns["energy/kinetic"].max()
        yield Row(
            f"{label}, let go at 0.05 rad: kinetic energy after its return over that before, by "
            "the plane problem",
            0.0,
            columns["energy/kinetic"][-round(0.2 / dt) :].max() / fell,
            1e-3,
        )
        columns = _shaken(_beside(engine, 0.0, friction, True, dt), _cycle(dt, *_CYCLE, 3.0))
        yield Row(
            f"{label}, one sine 0.4 g, 0.6 s: largest tilt towards the wall over that from it",
            0.0,
            max(columns["left"].max(), 0.0) / -columns["left"].min(),
            1e-3,
        )
        yield Row(
            f"{label}, the same motion: peak tilt from the wall [rad], by Housner's block that "
            "stops at its return",
            _housner_peak(*_CYCLE, one_side=True),
            -columns["left"].min(),
            1e-3,
        )
    if engine != "rigid":
        return
    yield Row(
        "block that rocks towards a wall 0.02 m away, frictionless: energy that the impact takes "
        "over the kinetic energy before it",
        *_top_impact(engine),
        1e-3,
    )


def _top_impact(engine: str) -> tuple[float, float]:
    """Share of its kinetic energy that a block loses whose top corner meets a wall: by the plane
    problem, and by what kinetic energy and that of gravity fall in the step of the impact.
    """
    dt, (width, height) = 2e-5, _LEFT
    made = _beside(engine, 0.02, 0.0, True, dt, dict(spin_rad_s=[0.0, 0.6, 0.0]))
    columns = _shaken(made, np.zeros((round(0.1 / dt), 3)))
    lost = -columns["energy/impact"]
    step = int(np.argmax(lost > lost[-1] / 2))
    tilt, before = columns["left"][step - 1], columns["energy/kinetic"][step - 1]
    # over mass and rate: the centre's velocity, about the right corner of the foot
    arm = np.array([-width / 2, height / 2]) @ [
        [np.cos(tilt), -np.sin(tilt)],
        [np.sin(tilt), np.cos(tilt)],
    ]
    top = width / 2 * -np.sin(tilt) + height / 2 * np.cos(tilt)
    inertia = (width**2 + height**2) / 12
    # it takes what the corner has across the wall, over what a unit impulse there gives it
    approach = arm[1] + top
    taken = approach**2 / (1 + top**2 / inertia)
    falls = columns["energy/kinetic"] + columns["energy/gravity"]
    return taken / (arm @ arm + inertia), float((falls[step - 1] - falls[step]) / before)


def _housner_peak(amplitude: float, period: float, one_side: bool = False) -> float:
    """Peak tilt [rad] of the left block alone that rocks without sliding (Housner 1963), under one
    cycle of a sine [g], [s], which turns it to the left first; one_side: until its return.
    """
    width, height = _LEFT
    alpha, radius = np.arctan(width / height), np.hypot(width, height) / 2
    squared, kept = 0.75 * GRAVITY / radius, 1 - 1.5 * np.sin(alpha) ** 2

    def push(time: float) -> float:
        return -amplitude * np.sin(2 * np.pi * time / period) * (time <= period)

    def rocks(side: float) -> Callable[[float, np.ndarray], list[float]]:
        def rate(time: float, state: np.ndarray) -> list[float]:
            lean = alpha - abs(state[0])
            return [state[1], squared * (push(time) * np.cos(lean) - side * np.sin(lean))]

        return rate

    def lands(_: object, state: np.ndarray) -> float:
        return state[0]

    event: Any = lands
    event.terminal = True
    time = np.arcsin(np.tan(alpha) / amplitude) * period / (2 * np.pi)
    state, side, peak = [0.0, 0.0], -1.0, 0.0
    for _ in range(1 if one_side else 6):
        event.direction = -side
        found = solve_ivp(
            rocks(side), (time, 3.0), state, events=event, rtol=1e-10, atol=1e-13, max_step=1e-3
        )
        peak = max(peak, float(np.abs(found.y[0]).max()))
        if not found.t_events[0].size:
            break
        time, rate = float(found.t_events[0][0]), float(found.y_events[0][0][1])
        state, side = [0.0, kept * rate], -side
    return peak
