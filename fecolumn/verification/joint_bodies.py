"""A body on a heavy flat one with an equal face, and its closed forms, for `verification.joints`
and its tests.

The body below is a thousand times as heavy as the one on it and flat, so that it stays and the one
above has closed forms. Stones are so stiff that what their modes store is not seen.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

#: Half length, half width, half height of the block above and height of the one below [m]
B, W, H, BELOW = 0.2, 0.15, 0.4, 0.1
#: Step [s]; tilt of a block that is let go [rad]
JOINT_DT, TILT = 5e-4, 0.05
#: Displacements of the block above [m], each to both sides.
DISPLACED = (0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1e-2)
#: Inertia of the block above about its middle axis along y, over its mass [m2]
INERTIA = (B**2 + H**2) / 3


def block_tables(
    engine: str, above: dict, below: dict | None = None, dt: float = JOINT_DT, **more: Any
) -> dict:
    """Tables of a case; above, below: keys beside those of a block."""
    shape = dict(kind="block", length_m=2 * B, width_m=2 * W) if "kind" not in above else {}
    stone = dict(youngs_modulus_pa=5e12, poissons_ratio=0.2) | shape
    heavy, light = (
        dict(height_m=BELOW, density_kg_m3=1e5),
        dict(height_m=2 * H, density_kg_m3=100.0, at_m=[0.0, 0.0, BELOW]),
    )
    return (
        dict(
            bodies=dict(low=stone | heavy | (below or {}), up=stone | light | above),
            contact=dict(friction_coefficient=0.8, interior_points=0),
            joints=dict(feet=dict(between=["low", "ground"]), joint=dict(between=["low", "up"])),
            integration=dict(engine=engine, dt_s=dt, duration_s=5.0)
            | (dict(n_modes=10) if engine == "reduced" else {}),
        )
        | more
    )


def engines(tables: dict) -> Callable[[], Engine]:
    """Function that makes an engine at the start of a case."""
    case = case_from_tables(tables, "verify")
    model = structure_model(case)
    return lambda: engine_of(case, model, "verify")


def two(engine: str, above: dict, below: dict | None = None, **more: Any) -> Engine:
    """Engine of a body on a heavy one; arguments as of `block_tables`."""
    return engines(block_tables(engine, above, below, **more))()


class Rocks(NamedTuple):
    """A block let go: of(time) gives tilt [rad] and rate [rad/s]; time of the first impact [s], the
    rates' ratio over it.
    """

    of: Callable[[float], np.ndarray]
    impact: float
    ratio: float


def rocks(near: float, far: float, inertia: float = INERTIA, end: float = 0.5) -> Rocks:
    """Closed form of a block let go from TILT about an edge at the arm `near` [m], which lands on
    one at `far` on the other side, until a second impact.

    An impact keeps the angular momentum about the edge on which the block lands. inertia: about the
    middle, over the mass [m2].
    """

    def turn(arm: float) -> Callable[[float, np.ndarray], list[float]]:
        return lambda _, state: [
            state[1],
            -GRAVITY * (arm * np.cos(state[0]) - H * np.sin(state[0])) / (inertia + arm**2 + H**2),
        ]

    def lands(_: object, state: np.ndarray) -> float:
        return state[0]

    lands.terminal = True  # type: ignore[attr-defined]  # as solve_ivp asks for it
    lands.direction = -1  # type: ignore[attr-defined]
    exactly = dict(rtol=1e-12, atol=1e-14, dense_output=True)
    first = solve_ivp(turn(near), (0, end), [TILT, 0.0], events=lands, **exactly)
    time, rate = float(first.t_events[0][0]), float(first.y_events[0][0][1])
    ratio = (inertia + H**2 - near * far) / (inertia + H**2 + far**2)
    then = solve_ivp(turn(far), (time, end), [0.0, -ratio * rate], **exactly)
    return Rocks(lambda at: first.sol(at) if at < time else -then.sol(at), time, ratio)


def arms(displaced: float) -> tuple[float, float]:
    """Arms [m] of a block displaced towards the side to which it leans: of the edge there, of the
    block below where it is nearer, and of that on the other side.
    """
    return B - max(displaced, 0.0), B - max(-displaced, 0.0)


def rocked_block(made: Engine, exact: Rocks, angle: float, last: float = 0.2) -> np.ndarray:
    """Errors of a block let go towards `angle` [deg]: tilt before its first impact over TILT, mean
    rates in the last and next 10 ms beside the impact, tilt at the last instant [s].

    Rates are means, read from tilts 2.5 and 12.5 ms from the impact: an edge that stays has a
    velocity that changes its sign in each step.
    """
    turn, dt = np.radians(angle), made.hht.dt
    direction = np.array([np.cos(turn), np.sin(turn), 0.0])
    impact, beside, away = exact.impact / dt, round(0.0025 / dt), round(0.0125 / dt)
    steps = [
        int(impact) - away,
        int(impact) - beside,
        int(impact) + beside,
        int(impact) + away,
        round(last / dt),
    ]
    tilts = []
    for before, now in zip([0, *steps], steps):
        made.advance(np.zeros((now - before, 3)))
        rotation = made.motion.rotation[1]
        tilts.append(np.arctan2(rotation[:, 2] @ direction, rotation[2, 2]))
    true = [exact.of(step * dt)[0] for step in steps]
    return np.array(
        [
            (tilts[1] - true[1]) / TILT,
            (tilts[1] - tilts[0]) / (true[1] - true[0]) - 1,
            (tilts[3] - tilts[2]) / (true[3] - true[2]) - 1,
            tilts[4] / true[4] - 1,
        ]
    )


def lifts(make: Callable[[], Engine], push: float, towards: np.ndarray) -> float:
    """Acceleration of the ground [m/s2] at which the body above lifts, pushed `towards` a direction
    (2,) across an edge, near a foreseen one.

    Pushed by more it leans as the excess times a function of time: two pushes, by 0.5 and 1
    thousandths more, tell by which it would not. Both grow within 30 ms to 0.5 thousandths less and
    are then met by what contact gives: a kick, which second differences of tilts at 0, 50 and 100
    ms leave out.
    """
    bends = []
    for more in (5e-4, 1e-3):
        made, leans = make(), []
        grows, stays = (round(time / made.hht.dt) for time in (0.03, 0.05))
        for level in (
            0.9995 * np.sin(np.pi / 2 * np.arange(1, grows + 1) / grows) ** 2,
            *[np.full(stays, 1 + more)] * 2,
        ):
            made.advance(-push * np.outer(level, [*towards, 0.0]))
            leans.append(made.motion.rotation[1][:2, 2] @ towards)
        bends.append(leans[2] - 2 * leans[1] + leans[0])
    return push * (1 + 5e-4 * (1 - bends[0] / (bends[1] - bends[0])))


def turning_error(
    made: Engine, push: float, towards: np.ndarray, normal: np.ndarray, apart: float, inertia: float
) -> float:
    """Error of the angular acceleration of the body above about an edge, over that of the closed
    form; pushed `towards` a direction (2,) across it by the ground [m/s2].

    The second difference of tilts at 20, 30 and 40 ms, set beside that of the motion that leans as
    much at 20 ms: in its first step the push is not whole, and contact kicks.

    Parameters
    ----------
    normal
        (2,) of the edge, outwards
    apart
        its distance from the middle [m].
    inertia
        about any horizontal axis through the middle, over the mass [m2].
    """
    step, across, leans = round(0.01 / made.hht.dt), push * (towards @ normal), []
    for steps in (2 * step, step, step):
        made.advance(np.tile(-push * np.array([*towards, 0.0]), (steps, 1)))
        rotation = made.motion.rotation[1]
        leans.append(np.arctan2(normal @ rotation[:2, 2], rotation[2, 2]))

    def rate(_: object, state: np.ndarray) -> list[float]:
        moment = across * (H * np.cos(state[0]) + apart * np.sin(state[0])) - GRAVITY * (
            apart * np.cos(state[0]) - H * np.sin(state[0])
        )
        return [state[1], moment / (inertia + apart**2 + H**2)]

    exact = solve_ivp(rate, (0, 0.06), [0.0, 0.0], rtol=1e-11, atol=1e-14, dense_output=True).sol
    start = brentq(lambda time: exact(time)[0] - leans[0], 1e-3, 0.03)
    true = [exact(start + time)[0] for time in (0.0, 0.01, 0.02)]
    return (leans[2] - 2 * leans[1] + leans[0]) / (true[2] - 2 * true[1] + true[0]) - 1


def region(angle: float, displaced: ArrayLike, half: tuple[float, float] = (B, W)) -> np.ndarray:
    """Corners (n, 2) [m] from the middle of the block above of the region in which two equal faces
    overlap, one turned by an angle [deg] (Sutherland and Hodgman 1974).
    """
    b, w = half
    corners = np.array([[-b, -w], [b, -w], [b, w], [-b, w]])
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    found = corners @ np.array([[cosine, sine], [-sine, cosine]])
    below = corners - displaced
    for start, end in zip(below, np.roll(below, -1, axis=0)):
        way = end - start
        left = way[0] * (found[:, 1] - start[1]) - way[1] * (found[:, 0] - start[0])
        kept = []
        for k in range(len(found)):
            if left[k - 1] * left[k] < 0:
                kept.append(
                    found[k - 1] + (found[k] - found[k - 1]) * left[k - 1] / (left[k - 1] - left[k])
                )
            if left[k] >= 0:
                kept.append(found[k])
        found = np.array(kept)
    return found


def met(corners: np.ndarray, towards: np.ndarray) -> tuple[float, np.ndarray, float, float]:
    """Edge of an outline with these corners that a ray from the middle along a direction (2,)
    meets: length of the ray [m], normal and distance [m] of the edge, and by which factor the ray
    may be longer until its way along the edge comes to a corner.
    """
    edges = np.roll(corners, -1, axis=0) - corners
    edges /= np.linalg.norm(edges, axis=1)[:, None]
    normals = np.column_stack([edges[:, 1], -edges[:, 0]])
    apart, along = (normals * corners).sum(axis=1), normals @ towards
    ways = np.where(along > 0, apart / np.where(along > 0, along, 1.0), np.inf)
    k = int(ways.argmin())
    met, end = (
        ways[k] * towards @ edges[k],
        corners[k if towards @ edges[k] < 0 else (k + 1) % len(corners)] @ edges[k],
    )
    return (
        float(ways[k]),
        normals[k],
        float(apart[k]),
        float(end / met) if abs(met) > 1e-9 else np.inf,
    )


def tips(
    half: float, over: float, speed: float, friction: float, tilt: float
) -> tuple[float, float, float]:
    """Closed form of a block of half height H that slides flat over an edge and tips about it,
    sliding on the same way.

    Parameters
    ----------
    half
        length of the block [m].
    over
        way [m] from its middle to the edge at the start; speed [m/s].
    tilt
        at which it is read [rad].

    Returns: time [s] of that tilt, rate then [rad/s] and how far it has slid [m].
    """
    # friction at the foot shifts the pressure forward: it tips before its middle is over the edge
    way = over - friction * H
    slower = np.sqrt(speed**2 - 2 * friction * GRAVITY * way)
    inertia, began = (half**2 + H**2) / 3, 2 * way / (speed + slower)

    def moves(_: object, state: np.ndarray) -> list[float]:
        x, z, theta, u, w, rate = state
        normal, along = (
            np.array([np.sin(theta), np.cos(theta)]),
            np.array([np.cos(theta), -np.sin(theta)]),
        )
        arm, slides = np.array([over - x, -z]) @ along, np.array([u, w]) @ along
        # the edge stays on the foot
        push = (GRAVITY * np.cos(theta) - 2 * rate * slides + rate**2 * H) / (
            1 + arm * (arm - friction * H) / inertia
        )
        a = push * (normal - friction * along) - [0.0, GRAVITY]
        return [u, w, rate, *a, push * (friction * H - arm) / inertia]

    def leans(_: object, state: np.ndarray) -> float:
        return state[2] - tilt

    leans.terminal = True  # type: ignore[attr-defined]  # as solve_ivp asks for it
    found = solve_ivp(
        moves, (0, 5), [way, H, 0.0, slower, 0.0, 0.0], rtol=1e-11, atol=1e-13, events=leans
    )
    end = found.y_events[0][0]
    return began + float(found.t_events[0][0]), float(end[5]), float(end[0])
