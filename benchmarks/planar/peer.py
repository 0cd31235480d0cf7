"""Siconos on the same structures and motions: `siconos.py`, run by the system's Python."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.peers import peer
from benchmarks.peers.child import run_child
from benchmarks.peers.install import SYSTEM_PYTHON
from benchmarks.planar.advance import FALLEN, History
from benchmarks.planar.bodies import GRAVITY, Structure
from benchmarks.planar.shaken import EVERY, Response, Shaken

_SCRIPT = Path(__file__).with_name("siconos.py")
#: What a motion depends on, besides the structure
SOURCES = (Path(__file__), _SCRIPT, _SCRIPT.with_name("siconos_corner.c"))
_CPU_LIMIT_S = 7200.0
#: theta: no numerical damping; tolerance of NSGS and its most sweeps; tolerance of Newton's loop
SETTINGS = dict(theta=0.5, tolerance=1e-10, sweeps=20000, newton=1e-9)
#: Corners of a fixed body farther from the other one are out of reach, the ends of the ground [m]
_REACH = 20.0


def version() -> str:
    """Of Siconos.

    Raises
    ------
    benchmarks.peers.peer.Missing
        it cannot be run.
    """
    return peer.version(next(one for one in peer.PEERS if one.name == "siconos"))


def moved(
    structure: Structure, ground, dt: float, *, place=None, every: int = 1, settings=SETTINGS
) -> History:
    """As `advance.advance`, by Siconos; works of ground and contacts are not told, nan.

    Raises
    ------
    RuntimeError
        it ended with an error.
    """
    moving = [number for number, body in enumerate(structure.bodies) if not body.fixed]
    mass, inertia = structure.mass[moving], structure.inertia[moving]
    place = (structure.place if place is None else place)[moving]
    job = dict(
        dt=dt,
        ground=ground,
        every=every,
        gravity=GRAVITY,
        fallen=FALLEN,
        mass=mass,
        inertia=inertia,
        place=place,
        velocity=np.zeros_like(place),
        settings=json.dumps(settings),
    )
    with tempfile.TemporaryDirectory() as folder:
        given, written = Path(folder) / "job.npz", Path(folder) / "found.npz"
        np.savez(given, **job, **_corners(structure, moving))
        command = [SYSTEM_PYTHON, "-P", str(_SCRIPT), str(given), str(written), folder]
        ended = run_child(command, Path(folder), _CPU_LIMIT_S)
        if ended.code or not written.exists():
            raise RuntimeError(
                f"Siconos ended with code {ended.code} after {ended.cpu:.0f} CPU s "
                f"(limit {_CPU_LIMIT_S:.0f} s): {ended.words or 'no reason given'}"
            )
        with np.load(written) as found:
            places = np.repeat(structure.place[None], len(found["place"]), axis=0)
            velocities = np.zeros_like(places)
            places[:, moving], velocities[:, moving] = found["place"], found["velocity"]
            fallen, unsolved = bool(found["fallen"]), int(found["unsolved"])
            cost = float(found["cpu_s"]), int(found["steps"])
    energy, speed = np.full((len(places), 5), np.nan), velocities[:, moving]
    energy[:, 0] = ((speed[..., :2] ** 2).sum(axis=-1) @ mass + speed[..., 2] ** 2 @ inertia) / 2
    energy[:, 1] = places[:, moving, 1] @ mass * GRAVITY
    time = dt * every * np.arange(len(places))
    return History(structure, time, places, velocities, energy, fallen, unsolved, *cost)


def _corners(structure: Structure, moving: list[int]) -> dict:
    """Corners and the faces they may touch.

    pairs: (nc, 2) numbers of both among the bodies that move, -1 of a fixed one. shape: (nc, 9)
    as of `siconos_corner.c`. friction: (nc,).
    """
    pairs, shapes, frictions = [], [], []
    for pair, shape, friction in zip(structure.pairs, structure.shape, structure.friction):
        moves, shape = [number in moving for number in pair], shape.copy()
        for number, part in zip(pair, (slice(0, 2), slice(2, 4))):
            if number not in moving:
                shape[part] += structure.place[number, :2]
        if moves[0] or np.abs(shape[:2] - structure.place[pair[1], :2]).max() < _REACH:
            pairs.append([moving.index(one) if one in moving else -1 for one in pair])
            shapes.append([*shape, *moves])
            frictions.append(friction)
    return dict(pairs=pairs, shape=shapes, friction=frictions)


def respond(case: Shaken, ground: np.ndarray, dt: float) -> Response:
    """By Siconos."""
    found = moved(case.structure, ground, dt, every=round(EVERY / dt))
    moving = [number for number, body in enumerate(case.structure.bodies) if not body.fixed]
    tilt = np.abs(found.tilt[:, moving])
    return Response(
        found.time, found.top(case.observed), tilt, found.fallen, unsolved=found.unsolved
    )
