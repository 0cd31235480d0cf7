"""Which settings of a peer are best: each beside the planar program, of structures that are let go
and of structures that should stand still.

Let go from 0.4 of the critical tilt: how far the top is off until the third impact (drums: the
first one, after which joints open and close), over its largest way, and what contact feeds in.
Standing: the ground shakes by half of what lifts them, a sine of 3 Hz for two seconds: how far the
top goes. Cost: processor time of a second of both. The best setting errs least; of equal ones the
cheapest. Of the tube there is no exact motion: it takes what is best for the others.
"""

from __future__ import annotations

import functools
import sys

import numpy as np

from benchmarks.beside import markdown
from benchmarks.planar.advance import advance
from benchmarks.planar.compare import impacts
from benchmarks.planar.structures import leaning_frame
from benchmarks.programs.analysis import RUNS, by_judge
from benchmarks.programs.course import EVERY, fed_in, in_plane, way_of_top
from benchmarks.programs.programs import BY_NAME, PLANE, mujoco_settings
from benchmarks.programs.structures import planar_of, rigid_bodies

_SHARE, _SECONDS, _RATE = 0.4, 2.0, 3.0
_JUDGE = 1e-4
#: Impacts until which histories are compared
_IMPACTS = dict(block=3, drums=1, trilith=3)
HEAD = (
    "program, step and setting",
    *(f"{name}: off [%]" for name in PLANE),
    "fed in, most [%]",
    *(f"{name}: creep [um]" for name in PLANE),
    "CPU of a second [ms]",
)


def settings(program: str) -> list[tuple[float, str, dict]]:
    """Step, words and settings that are tried."""
    defaults = BY_NAME[f"{program}-defaults"]
    tried = [(defaults.dt, "defaults", defaults.settings)]
    if program == "mujoco":
        tried += [(dt, "defaults", defaults.settings) for dt in (1e-3, 1e-4)]
        for dt in (1e-3, 2.5e-4, 1e-4):
            tried.append((dt, "stiff: impratio 100, solref 2 dt", mujoco_settings(dt)))
        dt = 1e-4
        pyramid = mujoco_settings(dt)
        pyramid["option"] = pyramid["option"].replace("elliptic", "pyramidal")
        cg = mujoco_settings(dt, more='solver="CG"')
        noslip = mujoco_settings(dt, more='noslip_iterations="20"')
        return [
            *tried,
            (dt, "stiff, impratio 1", mujoco_settings(dt, ratio=1.0)),
            (dt, "stiff, impratio 10", mujoco_settings(dt, ratio=10.0)),
            (dt, "stiff, impratio 1000", mujoco_settings(dt, ratio=1000.0)),
            (dt, "stiff, solref 4 dt", mujoco_settings(dt, 4.0)),
            (dt, "stiff, solref 20 dt", mujoco_settings(dt, 20.0)),
            (dt, "stiff, pyramidal cones", pyramid),
            (dt, "stiff, solver CG", cg),
            (dt, "stiff, noslip_iterations 20", noslip),
        ]
    exact = BY_NAME["siconos"].settings
    return [
        *tried,
        *((dt, "theta 0.5, NSGS to 1e-10", exact) for dt in (1e-3, 5e-4, 1e-4)),
        (1e-4, "theta 0.5, NSGS to 1e-4", exact | dict(tolerance=1e-4, sweeps=1000)),
        (1e-4, "theta 1, NSGS to 1e-10", exact | dict(theta=1.0)),
    ]


@functools.cache
def let_go(name: str) -> tuple[np.ndarray, np.ndarray, int]:
    """Places (nb, 3) of `planar.advance` at which a structure is let go, way of its top by the
    planar program, and rows until those of _IMPACTS.
    """
    structure, bodies = planar_of(name).structure, rigid_bodies(name)
    tilt = _SHARE * bodies.critical
    if name == "trilith":
        place = leaning_frame(structure, tilt)
    else:
        total = bodies.sizes[:, 2].sum() * 2
        tilt = _SHARE * np.arctan2(2 * bodies.sizes[0, 0], total)
        place = structure.place
        for number in range(1, len(structure.bodies)):
            place = structure.turned(place, number, (bodies.sizes[0, 0], 0.0), -tilt)
    ground = np.zeros((round(_SECONDS / _JUDGE) + 1, 3))
    every = round(EVERY / _JUDGE)
    times = impacts(advance(structure, ground[:, 0], _JUDGE, place=place, every=every))
    until = times[_IMPACTS[name] - 1]
    way = way_of_top(bodies, by_judge(name, ground, _JUDGE, place=place))[:, 0]
    return place, way, round(until / EVERY)


def start_of(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (nb, 3) and quaternions (nb, 4) in space of places (1 + nb, 3) in the plane, the
    ground first.
    """
    rows = in_plane(place[None, 1:], np.zeros_like(place[None, 1:]))
    return rows["place"][0], rows["turn"][0]


def measured_trial(program: str, dt: float, chosen: dict) -> tuple[list, list, float, float]:
    """Of a setting: off [-] and creep [m] of each structure, fed in [-], cost [s of a second]."""
    off, creep, risen, cpu = [], [], 0.0, 0.0
    for name in PLANE:
        bodies, (place, way, until) = rigid_bodies(name), let_go(name)
        begin = dict(place=place)
        if program == "mujoco":
            begin = dict(start=start_of(place))
        still = np.zeros((round(_SECONDS / dt) + 1, 3))
        gone = RUNS[program](name, still, dt, chosen, **begin)
        every = max(1, round(dt / EVERY))
        top = way_of_top(bodies, gone)[:, 0]
        exact = way[::every][: until // every]
        n = min(len(top), len(exact))
        off.append(np.abs(top[:n] - exact[:n]).max() / np.abs(exact).max())
        time = dt * np.arange(len(still))
        shaken = still.copy()
        shaken[:, 0] = planar_of(name).uplift / 2 * np.sin(2 * np.pi * _RATE * time)
        stood = RUNS[program](name, shaken, dt, chosen)
        creep.append(np.abs(way_of_top(bodies, stood)).max())
        risen = max(risen, *(fed_in(bodies, one)[0] / bodies.barrier for one in (gone, stood)))
        cpu += (gone.cpu_s / gone.steps + stood.cpu_s / stood.steps) / (2 * dt * len(PLANE))
    return off, creep, risen, cpu


def table(programs) -> str:
    """A line for each setting of the programs."""
    rows = []
    for program in ("mujoco", "siconos"):
        if program not in programs:
            continue
        for dt, words, chosen in settings(program):
            off, creep, risen, cpu = measured_trial(program, dt, chosen)
            print(".", end="", file=sys.stderr, flush=True)
            rows.append(
                (
                    f"{BY_NAME[program].label.partition(',')[0]}, {dt:g} s, {words}",
                    *(f"{100 * one:.2g}" for one in off),
                    f"{100 * risen:.2g}",
                    *(f"{1e6 * one:.2g}" for one in creep),
                    f"{1e3 * cpu:.1f}",
                )
            )
    return markdown(HEAD, rows)
