"""What a step costs where structures are shaken so that they slide, lift and land, beside MuJoCo.

The structures of `speed`, of rigid bodies and with ten modes each, under a sine of the ground: a
tenth of what lifts a foot, half of it, and 1.5 times it; and let go from a tilt.
"""

from __future__ import annotations

import json
import math
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.peers.install import mujoco_python
from benchmarks.structures import speed
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.reduced.observe import column_index
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

#: Structure, number of columns or drums, and what shakes it over what lifts a foot, 0: let go
ROWS = [
    (kind, number, factor)
    for kind, number in (("frame", 4), ("drums", 8))
    for factor in (0.1, 0.5, 1.5, 0.0)
]
SECONDS, POINTS, FRICTION, FIRST = 2.0, 24, 0.7, 20


def case_of(kind: str, number: int, factor: float, engine: str):
    """Case of a row."""
    make = speed.frame_case if kind == "frame" else speed.stack_case
    return make(number, factor == 0.0, engine=engine)


def amplitude_of(kind: str, number: int, factor: float) -> float:
    """Of the ground's sine [m/s2]."""
    diameter, height = speed.COLUMN if kind == "frame" else speed.DRUM
    return factor * GRAVITY * diameter / (height * (1 if kind == "frame" else number))


def cost(kind: str, number: int, factor: float, engine: str) -> dict:
    """Processor time of a step [us] and greatest way of the structure's top [m]."""
    case = case_of(kind, number, factor, engine)
    dt = case.integration.dt_s
    t = dt * np.arange(1, round(SECONDS / dt) + 1)
    ground = np.outer(
        amplitude_of(kind, number, factor) * np.sin(2 * math.pi * speed.RATE * t), [1.0, 0.0, 0.0]
    )
    engine_made = engine_of(case, structure_model(case), "shaken")
    engine_made.advance(ground[:FIRST])
    began = time.process_time()
    rows, ended = engine_made.advance(ground[FIRST:])
    spent = time.process_time() - began
    u = rows[:, column_index("u_top")]
    return dict(
        us=1e6 * spent / max(len(rows), 1),
        steps=len(rows),
        peak_m=float(np.abs(u).max()),
        ended=str(ended) if ended else "",
    )


def mujoco_cost(kind: str, number: int, factor: float, settings: str) -> dict | None:
    """The same of MuJoCo, where it is installed; settings: of `mujoco_structures`."""
    python = mujoco_python()
    if not python.exists():
        return None
    diameter, height = speed.COLUMN if kind == "frame" else speed.DRUM
    tall = height * (1 if kind == "frame" else number)
    job = dict(
        structure=kind,
        number=number,
        dt=1e-3,
        seconds=SECONDS,
        amplitude=amplitude_of(kind, number, factor),
        rate=speed.RATE,
        tilt=0.0 if factor else speed.LET_GO * diameter / tall,
        points=POINTS,
        size=[diameter, height],
        friction=FRICTION,
        settings=settings,
    )
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "job.json"
        file.write_text(json.dumps(job))
        child = Path(__file__).with_name("mujoco_structures.py")
        done = subprocess.run(
            [str(python), "-P", str(child), str(file)], capture_output=True, text=True, check=True
        )
    return json.loads(done.stdout)
