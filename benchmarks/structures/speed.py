"""What a step costs where structures are shaken so that they slide, lift and land, beside MuJoCo.

The structures of `frames_and_stacks`, of rigid bodies and with ten modes each, under a sine of the
ground: a tenth of what lifts a foot, half of it, and 1.5 times it; and let go from a tilt. Beside
the time stands what it buys: the balance of energy, how far a cube slides, how far a stack creeps.
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
from benchmarks.programs.programs import BY_NAME
from benchmarks.structures import frames_and_stacks as cases
from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced.observe import column_index
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

KINDS, NUMBERS, FACTORS = ("frame", "drums"), (1, 2, 4, 8, 16), (0.1, 0.5, 1.5, 0.0)
#: Structure, number of columns or drums, and what shakes it over what lifts or moves a foot; 0: let
#: go
ROWS = [(kind, number, factor) for kind in KINDS for number in NUMBERS for factor in FACTORS]
#: What RESULTS prints
PRINTED = (("frame", 4), ("drums", 8))
SECONDS, POINTS, FRICTION, FIRST = 2.0, 24, 0.7, 20
# Steps that are timed together: their median tells what most steps take, their mean what an
# analysis takes
_TIMED = 10
#: Numbers of drums, and of contact points a face of two of them, over which costs grow; of these
#: how far they may slide [m]: more would make all nodes of a fine face contact points, and a body
#: has 1000 at most
ALLOWED = 0.02
DRUMS, POINTS_A_FACE = (1, 2, 4, 8, 16, 32), (12, 24, 48, 96)
#: Cube that slides: side [m], velocity [m/s], friction; how long the stack of `CREEPS` drums
#: stands [s]
SIDE, SLIDES, CUBE_FRICTION = 0.5, 6.0, 0.5
CREEPS, STANDS = 4, 10.0


def case_of(kind: str, number: int, factor: float, engine: str, points: int | None = None):
    """Case of a row; points: on each face of drums, which then slide by less than ALLOWED."""
    make = cases.frame_case if kind == "frame" else cases.stack_case
    if points is None:
        return make(number, factor == 0.0, engine=engine, points=POINTS)
    near = dict(joints=dict(joints=dict(allowance_m=ALLOWED)))
    return make(number, factor == 0.0, engine=engine, points=points, tables=near)


def size_of(kind: str, number: int) -> tuple[float, float, float]:
    """Diameter and height [m] of a column or drum, and height of what rocks as one."""
    diameter, height = cases.COLUMN if kind == "frame" else cases.DRUM
    return diameter, height, height * (1 if kind == "frame" else number)


def amplitude_of(kind: str, number: int, factor: float) -> float:
    """Of the ground's sine [m/s2]: over what lifts a foot, or lets it slide where that is less."""
    diameter, _, tall = size_of(kind, number)
    return factor * GRAVITY * min(diameter / tall, FRICTION)


def cost(kind: str, number: int, factor: float, engine: str, points: int | None = None) -> dict:
    """Processor time of a step [us], mean and median, of a case of `case_of`; greatest way of the
    structure's top [m]; error of the energy balance over the largest kinetic energy.
    """
    case = case_of(kind, number, factor, engine, points)
    dt = case.integration.dt_s
    t = dt * np.arange(1, round(SECONDS / dt) + 1)
    ground = np.outer(
        amplitude_of(kind, number, factor) * np.sin(2 * math.pi * cases.RATE * t), [1.0, 0.0, 0.0]
    )
    model = structure_model(case)
    made = engine_of(case, model, "shaken")
    made.advance(ground[:FIRST])
    found, spent, ended = [], [], None
    for part in np.array_split(ground[FIRST:], (len(ground) - FIRST) // _TIMED):
        began = time.process_time()
        rows, ended = made.advance(part)
        spent.append((time.process_time() - began) / max(len(rows), 1))
        found.append(rows.copy())
        if ended:
            break
    rows = np.concatenate(found)
    columns = columns_of(rows, model)
    return dict(
        us=1e6 * float(np.average(spent, weights=[len(one) for one in found])),
        median_us=1e6 * float(np.median(spent)),
        peak_m=float(np.abs(rows[:, column_index("u_top")]).max()),
        closure=float(
            np.abs(columns["energy/closure"]).max() / columns["energy/kinetic"].max(initial=1e-300)
        ),
        steps=len(rows),
        ended=str(ended) if ended else "",
    )


def mujoco(**job) -> dict | None:
    """What MuJoCo answers to a job of `mujoco_structures`; None where it is not installed."""
    python = mujoco_python()
    if not python.exists():
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "job.json"
        file.write_text(json.dumps(dict(dt=1e-3, points=POINTS, rate=cases.RATE) | job))
        child = Path(__file__).with_name("mujoco_structures.py")
        done = subprocess.run(
            [str(python), "-P", str(child), str(file)], capture_output=True, text=True, check=True
        )
    return json.loads(done.stdout)


def mujoco_cost(kind: str, number: int, factor: float, settings: str) -> dict | None:
    """Time of a step of 1e-3 s and way of the top of MuJoCo; settings: of `mujoco_structures`, or
    "best", those of `benchmarks.programs`, whose shorter steps are counted together.
    """
    diameter, height, tall = size_of(kind, number)
    steps, said = 1, settings
    if settings == "best":
        best = BY_NAME["mujoco"]
        steps, said = round(1e-3 / best.dt), list(map(best.settings.get, ("option", "contact")))
    found = mujoco(
        dt=1e-3 / steps,
        structure=kind,
        number=number,
        seconds=SECONDS,
        amplitude=amplitude_of(kind, number, factor),
        tilt=0.0 if factor else cases.LET_GO * diameter / tall,
        size=[diameter, height],
        friction=FRICTION,
        settings=said,
    )
    return found and found | dict(us=steps * found["us"])


def slid_exactly() -> float:
    """How far the cube slides [m] until friction stops it."""
    return SLIDES**2 / (2 * CUBE_FRICTION * GRAVITY)


def slid(engine: str) -> float:
    """How far the cube slides [m] in this program."""
    case = case_from_tables(
        dict(
            bodies=dict(
                cube=dict(
                    kind="block",
                    length_m=SIDE,
                    width_m=SIDE,
                    height_m=SIDE,
                    density_kg_m3=2700.0,
                    youngs_modulus_pa=50e9,
                    poissons_ratio=0.2,
                    modes=10,
                )
            ),
            joints=dict(foot=dict(between=["cube", "ground"], allowance_m=5.0)),
            contact=dict(friction_coefficient=CUBE_FRICTION, interior_points=0),
            initial=dict(cube=dict(velocity_m_s=[SLIDES, 0.0, 0.0])),
            integration=dict(dt_s=1e-3, duration_s=2.0, engine=engine),
        ),
        "slide",
    )
    rows, _ = engine_of(case, structure_model(case), "slide").advance(np.zeros((2000, 3)))
    return float(rows[-1, column_index("u_top")])


def crept(engine: str) -> float:
    """How far the top of a stack moves that stands [m], in this program."""
    case = case_of("drums", CREEPS, 0.1, engine)
    rows, _ = engine_of(case, structure_model(case), "creep").advance(
        np.zeros((round(STANDS / 1e-3), 3))
    )
    at = column_index("u_top")
    return float(np.linalg.norm(rows[:, at : at + 3], axis=1).max())


def mujoco_slid(settings: str) -> float:
    """The same slide in MuJoCo [m]; nan where it is not installed."""
    found = mujoco(
        structure="cube",
        seconds=2.0,
        amplitude=0.0,
        velocity=SLIDES,
        points=8,
        size=[SIDE],
        friction=CUBE_FRICTION,
        settings=settings,
    )
    return found["moved_m"] if found else math.nan


def mujoco_crept(settings: str) -> float:
    """The same creep in MuJoCo [m]; nan where it is not installed."""
    found = mujoco(
        structure="drums",
        number=CREEPS,
        seconds=STANDS,
        amplitude=0.0,
        tilt=0.0,
        size=list(cases.DRUM),
        friction=FRICTION,
        settings=settings,
    )
    return found["moved_m"] if found else math.nan


def growth(numbers, us) -> float:
    """Exponent of the growth of costs with a number, by least squares of the logarithms."""
    return float(np.polyfit(np.log(numbers), np.log(us), 1)[0])
