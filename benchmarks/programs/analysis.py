"""One motion in a program that is not the package: an analysis of `fecolumn.study`, which makes
what is missing and keeps what is done.
"""

from __future__ import annotations

import functools
import json
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.peers.child import run_child
from benchmarks.peers.install import SYSTEM_PYTHON, mujoco_python
from benchmarks.planar import peer as planar_siconos
from benchmarks.planar.advance import advance
from benchmarks.planar.bodies import GRAVITY
from benchmarks.programs.course import EVERY, Course, in_plane, measured
from benchmarks.programs.programs import BY_NAME
from benchmarks.programs.structures import (
    MONOLITH,
    OVERTURNED,
    RigidBodies,
    ground_of,
    planar_of,
    rigid_bodies,
)
from fecolumn import __version__
from fecolumn.engines.summary import write_sealed

_CPU_LIMIT_S = 7200.0


def every_of(dt: float) -> int:
    """Steps between rows."""
    return max(1, round(EVERY / dt))


def child(script: str, python, bodies: RigidBodies, ground, dt: float, settings, start) -> Course:
    """Course of bodies by a script of this folder; start: place (nb, 3) [m] and turn (nb, 4).

    Raises
    ------
    RuntimeError
        it ended with an error.
    """
    every = every_of(dt)
    with tempfile.TemporaryDirectory() as folder:
        given, written = Path(folder) / "job.npz", Path(folder) / "found.npz"
        np.savez(
            given,
            dt=dt,
            every=every,
            ground=ground,
            gravity=GRAVITY,
            fallen=OVERTURNED,
            settings=json.dumps(settings),
            place=start[0],
            turn=start[1],
            friction=bodies.friction,
            **{
                key: getattr(bodies, key) for key in ("kinds", "sizes", "mass", "inertia", "middle")
            },
        )
        command = [str(python), "-P", str(Path(__file__).with_name(script)), given, written]
        ended = run_child(list(map(str, command)), Path(folder), _CPU_LIMIT_S)
        if ended.code or not written.exists():
            raise RuntimeError(
                f"{script} ended with code {ended.code} after {ended.cpu:.0f} CPU s: {ended.words}"
            )
        with np.load(written) as found:
            rows = {key: found[key] for key in ("place", "velocity", "turn", "spin")}
            cost = float(found["cpu_s"]), int(found["steps"]), int(found["unsolved"])
    ground = ground[::every][: len(rows["place"])]
    return Course(**rows, ground=ground, row_s=every * dt, **_named(cost))


def _named(cost) -> dict:
    return dict(zip(("cpu_s", "steps", "unsolved"), cost))


def standing(bodies: RigidBodies):
    """Places and turns at the start."""
    return bodies.place, np.tile([1.0, 0.0, 0.0, 0.0], (len(bodies.place), 1))


def by_mujoco(name: str, ground, dt: float, settings, start=None) -> Course:
    """By MuJoCo."""
    bodies = rigid_bodies(name)
    python, begin = mujoco_python(), start or standing(bodies)
    return child("mujoco.py", python, bodies, ground, dt, settings, begin)


def by_siconos(name: str, ground, dt: float, settings, place=None, start=None) -> Course:
    """By Siconos: the tube in three dimensions, from `start`; other structures in their plane, from
    `place` as of `planar.advance`.
    """
    if name == "tube":
        bodies = rigid_bodies(name)
        begin = start or standing(bodies)
        return child("siconos.py", SYSTEM_PYTHON, bodies, ground, dt, settings, begin)
    structure, every = planar_of(name).structure, every_of(dt)
    found = planar_siconos.moved(
        structure, ground[:, 0], dt, place=place, every=every, settings=settings
    )
    cost = found.cpu_s, found.steps, found.unsolved
    return _of_history(found, ground[::every], every * dt, cost)


def by_judge(name: str, ground, dt: float, settings=None, place=None) -> Course:
    """By the planar program."""
    structure, every = planar_of(name).structure, every_of(dt)
    advance(structure, np.zeros(3), dt)  # compiles
    began = time.process_time()
    found = advance(structure, ground[:, 0], dt, place=place, every=every)
    cost = time.process_time() - began, every * (len(found.time) - 1), found.unsolved
    return _of_history(found, ground[::every], every * dt, cost)


def _of_history(found, ground, row_s: float, cost) -> Course:
    moving = [number for number, body in enumerate(found.structure.bodies) if not body.fixed]
    rows = in_plane(found.place[:, moving], found.velocity[:, moving])
    ground = ground[: len(found.place)]
    return Course(**rows, ground=ground, row_s=row_s, **_named(cost))


def by_housner(ground, dt: float) -> dict:
    """The block by its closed form: what `measured` tells of the others."""
    closed, (width, height) = planar_of("block").closed, MONOLITH
    closed.shaken(np.zeros(3), dt)  # compiles
    began = time.process_time()
    tilt = np.abs(closed.shaken(ground[:, 0], dt))
    cpu, most = time.process_time() - began, float(tilt.max())
    # the middle of the top turns about a corner of the foot
    top = width / 2 * (1 - np.cos(most)) + height * np.sin(most)
    return dict(
        u_max_m=float(top),
        overturned=most > OVERTURNED,
        fed_in=0.0,
        energy_closure_rel=0.0,
        steps=len(tilt) - 1,
        cpu_s=cpu,
        unsolved=0,
    )


RUNS = dict(mujoco=by_mujoco, siconos=by_siconos, judge=by_judge)


def analyse(name: str, case, folder, *, comm, file, quiet) -> dict:
    """Run a case in the program of that name, and write its summary."""
    program, began = BY_NAME[name], time.perf_counter()
    ground, dt = ground_of(case, file), float(case.integration.dt_s)
    if name == "housner":
        found = by_housner(ground, dt)
    else:
        run = RUNS[name.partition("-")[0]]
        course = run(case.title, ground, dt, program.settings)
        found = measured(rigid_bodies(case.title), course)
    wall = time.perf_counter() - began
    said = dict(case_id=case.id, title=case.title, version=__version__, engine=program.label)
    said |= dict(dt=dt, wall_s=wall, s_per_step=found["cpu_s"] / found["steps"])
    return write_sealed(folder, said | found | dict(residual_slide_m=0.0))


housner, judge, mujoco, siconos, siconos_tube, mujoco_defaults, siconos_defaults = (
    functools.partial(analyse, name)
    for name in (
        "housner",
        "judge",
        "mujoco",
        "siconos",
        "siconos-tube",
        "mujoco-defaults",
        "siconos-defaults",
    )
)
