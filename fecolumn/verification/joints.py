"""Joints of equal faces have two sides: what a body pivots on is the outline of the region where both faces overlap.

The body below is a thousand times as heavy as the one on it and flat, so that it stays and the one above has closed forms.
"""

from __future__ import annotations

import itertools

import numpy as np
from scipy.integrate import solve_ivp

from fecolumn.case import GRAVITY, case_from_tables
from fecolumn.reduced.observe import ENERGY, WIDTH
from fecolumn.structures.engine import engine_of
from fecolumn.structures.structure import structure_model
from fecolumn.verification.result import Result, Row

# Half length, half width, half height of the block above and height of the one below [m]
_B, _W, _H, _BELOW = 0.2, 0.15, 0.4, 0.1
_DT = 5e-4
_TILT = 0.05
#: Displacements of the block above [m], each to both sides.
DISPLACED = (0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1e-2)
# Angle about the vertical [deg] and displacement [m] of the block above
_TURNED = tuple(itertools.product((0.0, 0.1, 5.0, 45.0), ((0.0, 0.0), (1e-6, 1e-6), (0.02, 0.013))))


def run(engine: str, long: bool = False) -> Result:
    """Rows of one engine: with modes what happens before and after an impact is elastic, so that its rows allow more."""
    elastic = engine == "reduced"
    rows = [*_displaced(engine, 1e-3 if elastic else 1e-4), *_turned(engine, 2e-2 if elastic else 1e-3)]
    rows += [*_drums(engine), *_exchange(engine), *_slides(engine)]
    return Result(rows, lambda figure: draw(engine, figure))


def draw(engine: str, figure) -> None:
    """Rates 2.5 ms before and 2.5 ms after the first impact over the displacement of the block above, beside the closed form."""
    small = np.logspace(-9, np.log10(0.05), 24)
    ways = np.concatenate([-small[::-1], [0.0], small])
    computed, exact = np.array([rocked(engine, way) for way in ways]).transpose(1, 2, 0)
    for axes, place, label in zip(figure.subplots(1, 2), (1, 2), ("before the impact", "after the impact")):
        axes.plot(ways, -exact[place], color="0.5", label="closed form")
        axes.plot(ways, -computed[place], "o", markersize=3, color="C3", label=f"{engine} engine")
        axes.set_xscale("symlog", linthresh=1e-9)
        axes.set_xticks([-1e-2, -1e-5, -1e-8, 0, 1e-8, 1e-5, 1e-2], ["−1e-2", "−1e-5", "−1e-8", "0", "1e-8", "1e-5", "1e-2"])
        axes.set(xlabel="displacement of the upper block [m]", ylabel=f"rate {label} [rad/s]")
        axes.legend(frameon=False, fontsize=8)
    figure.tight_layout()


def two(engine: str, above: dict, below: dict | None = None, **more):
    """Engine of a body on a heavy one; above, below: keys beside those of a block."""
    shape = dict(kind="block", length_m=2 * _B, width_m=2 * _W) if above.get("kind") not in ("cylinder", "tube") else {}
    stone = dict(youngs_modulus_pa=5e10, poissons_ratio=0.2) | shape
    heavy, light = dict(height_m=_BELOW, density_kg_m3=1e5), dict(height_m=2 * _H, density_kg_m3=100.0, at_m=[0.0, 0.0, _BELOW])
    tables = dict(bodies=dict(low=stone | heavy | (below or {}), up=stone | light | above), contact=dict(friction_coefficient=0.8, interior_points=0),
                  interfaces=dict(feet=dict(between=["low", "ground"]), joint=dict(between=["low", "up"])),
                  integration=dict(engine=engine, dt_s=_DT, duration_s=5.0, n_modes=10))
    return engine_of(*_case_and_model(tables | more), "verify")


def _case_and_model(tables):
    case = case_from_tables(tables, "verify")
    return case, structure_model(case)


def leaning(displaced: float, duration: float):
    """Closed form of the block above, let go from _TILT towards +x: tilt and its rate over time, its first impact's time, rate and the ratio of rates over it.

    It turns about the edge that is nearer to its middle, of the block below where it is displaced towards it, of its own else; an impact keeps the angular
    momentum about the edge on the other side.
    """
    near, far = _B - max(displaced, 0.0), _B - max(-displaced, 0.0)
    inertia = (_B**2 + _H**2) / 3

    def rates(_, state):
        return [state[1], -GRAVITY * (near * np.cos(state[0]) - _H * np.sin(state[0])) / (inertia + near**2 + _H**2)]

    def lands(_, state):
        return state[0]

    lands.terminal = True
    found = solve_ivp(rates, (0, duration), [_TILT, 0.0], rtol=1e-11, atol=1e-13, events=lands, dense_output=True)
    ratio = (inertia + _H**2 - near * far) / (inertia + _H**2 + far**2)
    return found.sol, float(found.t_events[0][0]), float(found.y_events[0][0][1]), ratio


def rocked(engine: str, displaced: float, angle: float = 0.0):
    """Tilt [rad] and rate [rad/s] of a displaced block shortly before its first impact and rate after it, and the same of the closed form; angle [deg] by which all is turned."""
    turn = np.radians(angle)
    direction = np.array([np.cos(turn), np.sin(turn), 0.0])
    made = two(engine, dict(at_m=[*(displaced * direction[:2]), _BELOW], turned_deg=angle), dict(turned_deg=angle),
               initial=dict(up=dict(tilt_rad=_TILT, direction_deg=angle)))
    solution, time, rate, ratio = leaning(displaced, 0.5)
    axis = np.array([-direction[1], direction[0], 0.0])

    def turning():
        rotation = made.motion.rotation[1]
        return float(np.arctan2(rotation[:, 2] @ direction, rotation[2, 2])), float(axis @ rotation @ made.motion.frames["spin"][1])

    steps = int(round(time / _DT)) - 5
    made.advance(np.zeros((steps, 3)))
    tilt, before = turning()
    exact = solution(steps * _DT)
    made.advance(np.zeros((10, 3)))
    # back at the time of the impact: gravity has turned it since, about the other edge
    far = _B - max(-displaced, 0.0)
    after = turning()[1] - GRAVITY * far / ((_B**2 + _H**2) / 3 + far**2 + _H**2) * ((steps + 10) * _DT - time)
    return (tilt, before, after), (*exact, ratio * rate)


def _displaced(engine: str, allowed: float):
    for angle, name in ((0.0, "along x"), (30.0, "askew, all turned by 30 degrees")):
        found, exact = np.array([rocked(engine, sign * way, angle) for way in DISPLACED for sign in (1, -1)]).transpose(1, 0, 2)
        found = (found - exact) / [_TILT, np.abs(exact[:, 1]).max(), np.abs(exact[:, 2]).max()]
        yield Row(f"equal blocks, the upper displaced by up to 10 mm {name}: tilt before the first impact, largest error over 0.05 rad", 0.0, np.abs(found[:, 0]).max(), 2 * allowed)
        yield Row(f"{name}: its rate, largest error over that at the impact", 0.0, np.abs(found[:, 1]).max(), allowed)
        if engine == "rigid":
            yield Row(f"{name}: rate after the impact over that of the closed form, largest error", 0.0, np.abs(found[:, 2]).max(), 5e-4)
        small = found[:6]
        yield Row(f"{name}: change of the tilt over displacements of up to a nanometre, over 0.05 rad", 0.0, np.ptp(small[:, 0]), 1e-7)


def region(angle: float, displaced) -> np.ndarray:
    """Corners (n, 2) [m] from the middle of the block above of the region in which two equal faces overlap, one turned by an angle [deg] (Sutherland and Hodgman 1974)."""
    corners = np.array([[-_B, -_W], [_B, -_W], [_B, _W], [-_B, _W]])
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    found = corners @ np.array([[cosine, sine], [-sine, cosine]])
    below = corners - displaced
    for start, end in zip(below, np.roll(below, -1, axis=0)):
        way = end - start
        left = way[0] * (found[:, 1] - start[1]) - way[1] * (found[:, 0] - start[0])
        kept = []
        for k in range(len(found)):
            if left[k - 1] * left[k] < 0:
                kept.append(found[k - 1] + (found[k] - found[k - 1]) * left[k - 1] / (left[k - 1] - left[k]))
            if left[k] >= 0:
                kept.append(found[k])
        found = np.array(kept)
    return found


def _turned(engine: str, allowed: float):
    """Pushed across each edge of the region, the block turns about that edge: I w' = m (a h - g s), s the edge's distance from the middle."""
    for angle, displaced in _TURNED:
        corners, errors = region(angle, displaced), []
        for start, end in zip(corners, np.roll(corners, -1, axis=0)):
            length = np.linalg.norm(end - start)
            if length < 1e-4:
                continue
            normal = np.array([end[1] - start[1], start[0] - end[0]]) / length
            apart = normal @ start
            if not 0.02 < (apart * normal - start) @ (end - start) / length**2 < 0.98:
                continue  # it would turn about a corner
            errors.append(_edge_error(engine, angle, displaced, normal, apart))
        if errors:
            yield Row(f"the upper block turned by {angle:g} deg, displaced by ({displaced[0]:g}, {displaced[1]:g}) m: angular acceleration about each of "
                      f"{len(errors)} edges of the region, largest error", 0.0, max(errors), allowed)


def _edge_error(engine: str, angle: float, displaced, normal, apart: float) -> float:
    made = two(engine, dict(turned_deg=angle, at_m=[*displaced, _BELOW]))
    pushed, steps = 1.3 * GRAVITY * apart / _H, int(0.02 / _DT)
    axis, ground = np.array([-normal[1], normal[0], 0.0]), np.tile(-pushed * np.array([*normal, 0.0]), (steps, 1))
    rates = []
    for _ in range(2):
        made.advance(ground)
        rates.append(axis @ made.motion.rotation[1] @ made.motion.frames["spin"][1])
    turn = np.radians(angle)
    across = axis[0] * np.cos(turn) + axis[1] * np.sin(turn), axis[1] * np.cos(turn) - axis[0] * np.sin(turn)
    inertia = (_W**2 + _H**2) / 3 * across[0] ** 2 + (_B**2 + _H**2) / 3 * across[1] ** 2 + apart**2 + _H**2

    def rate(_, state):
        moment = pushed * (_H * np.cos(state[0]) + apart * np.sin(state[0])) - GRAVITY * (apart * np.cos(state[0]) - _H * np.sin(state[0]))
        return [state[1], moment / inertia]

    exact = solve_ivp(rate, (0, 2 * steps * _DT), [0.0, 0.0], rtol=1e-10, atol=1e-12, t_eval=[steps * _DT, 2 * steps * _DT]).y[1]
    return abs((rates[1] - rates[0]) / (exact[1] - exact[0]) - 1)


def _drums(engine: str):
    """A round drum on an equal one rocks alike whichever way it leans, after a slide as before."""
    drum = dict(kind="cylinder", outer_diameter_m=0.9)
    for slide, way in ((0.0, 0.0), (1e-6, 0.0), (1e-6, 0.6)):
        tilts = []
        for k in range(24):
            made = two(engine, drum | dict(height_m=1.6, at_m=[slide * np.cos(way), slide * np.sin(way), _BELOW]), drum,
                       initial=dict(up=dict(tilt_rad=_TILT, direction_deg=15.0 * k)))
            made.advance(np.zeros((160, 3)))
            tilts.append(np.arccos(min(made.motion.rotation[1][2, 2], 1.0)))
        yield Row(f"equal drums, the upper slid by {slide:g} m{f' at {way:g} rad' if slide else ''}: tilt in 24 directions 0.08 s after its release, spread over the mean", 0.0,
                  float(np.ptp(tilts) / np.mean(tilts)), 1e-5 if engine == "reduced" else 1e-6)


def _exchange(engine: str):
    """Whoever is named first in `between`, the motion is the same."""
    tilts = []
    for order in (["low", "up"], ["up", "low"]):
        made = two(engine, dict(at_m=[0.03, 0.01, _BELOW]), interfaces=dict(feet=dict(between=["low", "ground"]), joint=dict(between=order)),
                   initial=dict(up=dict(tilt_rad=_TILT, direction_deg=20.0)))
        tilts.append(made.advance(np.zeros((1000, 3)))[0][:, WIDTH + 7])
    yield Row("bodies of a joint exchanged: largest difference of tilt over the peak", 0.0, float(np.abs(tilts[1] - tilts[0]).max() / tilts[0].max()), 1e-6)


def _slides(engine: str):
    """A block that is shaken over the edge of a smaller one and back, sliding and rocking: energy and depth."""
    made = two(engine, dict(length_m=0.44, width_m=0.28), contact=dict(friction_coefficient=0.25, interior_points=0),
               integration=dict(engine=engine, dt_s=1e-3, duration_s=5.0, n_modes=10))
    time = 1e-3 * np.arange(1, 2001)
    ground = 6.0 * np.sin(2 * np.pi * 1.5 * time)[:, None] * [1.0, 0.4, 0.0]
    rows, _ = made.advance(ground)
    moved = np.abs(rows[:, ENERGY + 3]).max()
    yield Row("a block shaken and sliding over the edges of another: error of the energy balance over the work of the base", 0.0,
              float(np.abs(rows[:, WIDTH - 1]).max() / moved), 1e-11)
    yield Row("how deep a point sinks [m]", 0.0, float(max(rows[:, 12].max(), 0.0)), 1e-10)
