"""Friction problems of real steps: what the running engine had to solve, as it left it after the
step.

Structures of boxes that are rigid but for their contact points (`verification.boxes`) and the foot
of a finite-element column. A step ends with slips and gaps s under the forces r that it found and
with the compliance W of the points that take part; the last friction problem of the step was W, q =
s - W r. Its points come and go with the motion, and the forces of the step before are the guess
from which the engine starts.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import partial

import numpy as np

from benchmarks.friction.problem import Problem
from fecolumn.contact.points import GROUND
from fecolumn.contact.problem import STICKS_STILL, near_points
from fecolumn.contact.stick import operator_of
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation._compiled import interpreted
from fecolumn.verification.boxes import box_model, engine, frame, joint, part, sine_pulse, stack


def problem_of(engine, name: str, start) -> Problem | None:
    """The last friction problem of the step that an Engine has made, None where no point takes
    part; start: (P, 3) forces [N] at its start.
    """
    left, stick = engine.work.problem, engine.work.stick
    points = [i for i in interpreted(near_points)(left) if left.active[i]]
    if not points:
        return None
    rows = (
        3 * np.flatnonzero(left.active[interpreted(near_points)(left)])[:, None] + np.arange(3)
    ).ravel()
    if left.flags[STICKS_STILL]:
        W = interpreted(operator_of)(stick, int(left.count[0]))[np.ix_(rows, rows)]
    else:
        W = left.W[: len(rows) ** 2].reshape(len(rows), -1).copy()
    # symmetric to rounding only
    W = (W + W.T) / 2
    forces = engine.motion.forces[points]
    q = left.slack[points] - (W @ forces.ravel()).reshape(-1, 3)
    friction = engine.points["friction"][points]
    return Problem(
        name, W, q, float(friction[0]) if np.ptp(friction) == 0 else friction, start[points].copy()
    )


def recorded(engine, name: str, grounds, every: int) -> Iterator[Problem]:
    """Problems of every so many steps of an Engine under ground accelerations (k, 3) [m/s2], and of
    all steps in which a point lands or the way to stand changes.
    """
    last = 0
    for k, ground in enumerate(grounds):
        start = engine.motion.forces.copy()
        engine.advance(ground[None])
        problem = problem_of(engine, f"{name}, step {k + 1}", start)
        if problem is not None and (k % every == 0 or problem.points > last):
            yield problem
        last = problem.points if problem is not None else 0


def _still(steps):
    return np.zeros((steps, 3))


def _tilted_block(per_side, mu=0.7, height=1.2, breadth=0.4):
    """A block that falls back on its foot: tilted by a tenth of its slenderness about an edge."""
    model, tilt = box_model(breadth, breadth, height, per_side=per_side), 0.1 * breadth / height
    turn, edge = (
        rotation_matrix(np.array([0.0, tilt, 0.0])),
        np.array([breadth / 2, 0.0, -height / 2]),
    )
    # stands on the edge: its centre moves with the turn
    shift = turn @ -edge + edge
    made = part("block", model, shift, rotation=turn)
    return engine([made], [joint(0, GROUND, model, friction=mu)], stands=False)


def structures(few: bool = False) -> Iterator[Problem]:
    """Of two blocks on one another, of a slab on four columns and of a block on 96 and more points,
    at rest, shaken and landing; few: of the stack alone.
    """
    yield from recorded(stack(), "two blocks, rest", _still(2), 1)
    yield from recorded(
        stack(), "two blocks, shaken", sine_pulse(7.0, 0.4, 12 if few else 400), 4 if few else 20
    )
    if few:
        return
    yield from recorded(frame(4)[0], "slab on four, rest", _still(2), 1)
    yield from recorded(frame(4)[0], "slab on four, shaken", sine_pulse(3.0, 0.6, 600), 30)
    yield from recorded(_tilted_block(10), "block on 100, landing", _still(300), 30)


def column(file) -> Iterator[Problem]:
    """Of the column of a case file, standing, shaken, and landing after a release from a small
    tilt, reduced engine.
    """
    from fecolumn.case.case import load_case
    from fecolumn.engines.reduced_engine import engine_of
    from fecolumn.structures.structure import structure_model

    def engine_at(case):
        told = partial(print, file=sys.stderr)
        return engine_of(case, structure_model(case, file, told), file)

    case = load_case(file)
    yield from recorded(engine_at(case), "column, stands", _still(3), 1)
    yield from recorded(
        engine_at(case),
        "column, shaken",
        sine_pulse(4.0, 0.3, 400, case.integration.dt_s),
        20,
    )
    released = case.replace({"initial.tilt_rad": 0.01})
    yield from recorded(engine_at(released), "column, landing", _still(250), 25)
