"""What contact costs of bodies that are apart: a pair beside two standing blocks, a row of blocks
with a gap between each two; and what a step of a wall costs whose stones touch everywhere.
"""

from __future__ import annotations

import time
import warnings

import numpy as np

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model
from fecolumn.verification.any_joint_walls import wall, wall_shaking

#: Length, width and height of a block and the gap to the next one [m]; steps of a run and runs
BLOCK, GAP = (0.4, 0.3, 0.8), 0.02
STEPS, FIRST, RUNS = 1000, 50, 9
NUMBERS = (10, 25, 50, 100)
#: Courses, stones of the lowest, and gap of the head joints [m]
WALLS = ((3, 3, 0.0), (5, 6, 0.0), (5, 6, 0.002), (9, 11, 0.0))
ENGINES = ("rigid", "reduced")


def row_of_blocks(number: int, engine: str, pairs: str):
    """Engine of so many blocks that stand beside each other.

    pairs: "absent"; "joint", each may meet the next; "found", any may meet any other.
    """
    length, width, height = BLOCK
    block = dict(
        kind="block",
        length_m=length,
        width_m=width,
        height_m=height,
        element_size_m=0.3,
        density_kg_m3=2500.0,
        youngs_modulus_pa=30e9,
        poissons_ratio=0.2,
        copies_m=[[k * (length + GAP), 0.0, 0.0] for k in range(number)],
    )
    joints = dict(feet=dict(between=["block", "ground"]))
    if pairs == "joint":
        joints["sides"] = dict(between=["block", "block"], open=True)
    tables = dict(
        bodies=dict(block=block),
        joints=joints,
        contact=dict(friction_coefficient=0.7, interior_points=0)
        | (dict(between="all") if pairs == "found" else {}),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=60.0)
        | (dict(n_modes=10) if engine == "reduced" else {}),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        case = case_from_tables(tables, "apart")
        return engine_of(case, structure_model(case), "apart")


def standing_us(made, steps: int = STEPS) -> float:
    """Processor time of a step [us] of bodies that are shaken so little that none lifts."""
    times = made.hht.dt * np.arange(1, steps + 1)
    ground = np.outer(0.05 * GRAVITY * np.sin(6 * np.pi * times), [1.0, 0.0, 0.0])
    made.advance(ground[:FIRST])
    began = time.process_time()
    made.advance(ground[FIRST:])
    return 1e6 * (time.process_time() - began) / (steps - FIRST)


def in_turns(number: int, engine: str) -> dict[str, float]:
    """Least processor time of a step [us] by kind of pairs, measured in turns: other work on the
    machine slows down all alike.
    """
    found: dict[str, float] = {}
    for _ in range(RUNS):
        for pairs in ("absent", "joint", "found"):
            spent = standing_us(row_of_blocks(number, engine, pairs))
            found[pairs] = min(found.get(pairs, np.inf), spent)
    return found


def wall_costs(courses: int, stones: int, gap: float, engine: str) -> dict[str, float]:
    """Processor time until a wall is at rest [s], of a step at rest and of one shaken by 1.5 times
    what lifts its half stones [ms].
    """
    began = time.process_time()
    made = wall(courses, stones, engine, gap)
    start = time.process_time() - began
    spent = []
    for ground in (np.zeros((100, 3)), wall_shaking(made, 1.5)):
        began = time.process_time()
        rows, _ = made.advance(ground)
        spent.append(1e3 * (time.process_time() - began) / len(rows))
    return dict(start_s=start, rest_ms=spent[0], shaken_ms=spent[1])
