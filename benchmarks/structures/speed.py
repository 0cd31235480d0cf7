"""What a step of a structure costs by the number of its bodies: drums on one another, and columns
below a slab, standing and rocking.
"""

from __future__ import annotations

import math
import time

import numpy as np

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.contact.problem import N_ASSEMBLED, N_CONTACT, N_ITERATIONS
from fecolumn.engines.reduced.observe import column_index
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

NUMBERS = (1, 2, 4, 8, 16)
#: Of a column of the frame, and of a drum: diameter, height [m]; 24 points around each face
COLUMN, DRUM = (0.2, 1.5), (1.6, 0.5)
#: Standing: amplitude over that of uplift, and frequency [Hz] of a sine along x: all feet stay
#: closed. Rocking: tilt of each body over its slenderness; none lands within the steps
SHAKEN, RATE, LET_GO = 0.1, 3.0, 0.2
_STUFF = dict(poissons_ratio=0.2, modes=10)


def frame_case(columns: int, rocks: bool, dt: float = 1e-3, engine: str = "reduced"):
    """A slab on so many columns of concrete, a power of two, in a square or two beside each
    other.
    """
    (diameter, height), rows = COLUMN, 2 ** (int(math.log2(columns)) // 2)
    many = columns // rows
    places = [
        [2.0 * (i - (many - 1) / 2), 2.0 * (j - (rows - 1) / 2), 0.0]
        for j in range(rows)
        for i in range(many)
    ]
    slab = dict(
        kind="slab",
        length_m=2.0 * many,
        width_m=2.0 * rows,
        thickness_m=0.4,
        at_m=[0.0, 0.0, height],
        density_kg_m3=2500.0,
        youngs_modulus_pa=30e9,
    )
    column = dict(
        kind="cylinder",
        outer_diameter_m=diameter,
        height_m=height,
        copies_m=places,
        density_kg_m3=2500.0,
        youngs_modulus_pa=30e9,
    )
    return _case(
        dict(column=column | _STUFF, slab=slab | _STUFF),
        dict(feet=dict(slave="column", on="ground"), heads=dict(slave="column", on="slab")),
        dict(column=dict(tilt_rad=LET_GO * diameter / height)) if rocks else {},
        dt,
        engine,
    )


def stack_case(drums: int, rocks: bool, dt: float = 1e-3, engine: str = "reduced"):
    """So many drums of marble on one another; all lean as one where they rock."""
    diameter, height = DRUM
    drum = dict(
        kind="cylinder",
        outer_diameter_m=diameter,
        height_m=height,
        copies_m=[[0.0, 0.0, height * i] for i in range(drums)],
        density_kg_m3=2700.0,
        youngs_modulus_pa=50e9,
    )
    joints = dict(ground=dict(slave="drum", on="ground")) | (
        dict(joints=dict(slave="drum", on="drum")) if drums > 1 else {}
    )
    return _case(
        dict(drum=drum | _STUFF),
        joints,
        dict(drum=dict(tilt_rad=LET_GO * diameter / (height * drums))) if rocks else {},
        dt,
        engine,
    )


def _case(bodies, interfaces, initial, dt, engine):
    return case_from_tables(
        dict(
            bodies=bodies,
            interfaces=interfaces,
            contact=dict(friction_coefficient=0.7, interior_points=0),
            initial=initial,
            integration=dict(dt_s=dt, duration_s=60.0, engine=engine),
        ),
        "speed",
    )


def grounds(case, steps: int, slenderness: float) -> np.ndarray:
    """Accelerations (steps, 3) [m/s2] of a sine that does not make a body of that slenderness
    rock.
    """
    t = case.integration.dt_s * np.arange(1, steps + 1)
    return np.outer(
        SHAKEN * slenderness * GRAVITY * np.sin(2 * math.pi * RATE * t), [1.0, 0.0, 0.0]
    )


def compile_time() -> float:
    """CPU time [s] until the smallest structure is ready to step."""
    case = stack_case(2, True)
    model, began = structure_model(case), time.process_time()
    engine_of(case, model, "speed")
    return time.process_time() - began


def least_cost(kind: str, number: int, rocks: bool, steps: int = 200, runs: int = 3) -> dict:
    """`cost` of the fastest of several runs."""
    case = (frame_case if kind == "frame" else stack_case)(number, rocks)
    diameter, height = COLUMN if kind == "frame" else (DRUM[0], DRUM[1] * number)
    ground = np.zeros((steps, 3)) if rocks else grounds(case, steps, diameter / height)
    model = structure_model(case)
    return min((cost(case, model, ground, 50) for _ in range(runs)), key=lambda found: found["us"])


def cost(case, model, ground: np.ndarray, first: int) -> dict:
    """CPU time a step [us] after the first steps, and what a step is made of; model: the
    StructureModel of the case.
    """
    engine = engine_of(case, model, "speed")
    engine.advance(ground[:first])
    counts, began = engine.counts.copy(), time.process_time()
    rows, _ = engine.advance(ground[first:])
    spent, made = time.process_time() - began, engine.counts - counts
    near = float(np.mean(rows[:, column_index("active_nodes")]))
    return dict(
        us=1e6 * spent / len(rows),
        steps=len(rows),
        points=len(engine.points),
        carrying=near,
        iterations=made[N_ITERATIONS] / len(rows),
        newton=made[N_CONTACT] / len(rows),
        assembled=made[N_ASSEMBLED] / len(rows),
    )
