"""This project's engines on a case of the comparison, as a program of its own like every peer.

    python -m benchmarks.peers.ours ENGINE CASE FOLDER [STEPS]

Full is the corotated full-order engine; reduced and rigid are timed as they run in an analysis,
whole stretches at a time, again and again for a second at least, and then stepped singly to look at
the toe.
"""

from __future__ import annotations

import dataclasses
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.peers.case import Release, release
from benchmarks.peers.track import write_rows
from fecolumn.case.case import Case
from fecolumn.engines.dynamics.gravity import tilted
from fecolumn.verification import rocking
from fecolumn.verification.models import system_of
from fecolumn.verification.trial import Trial

# CPU seconds that the timing of a compiled engine takes at least
ENOUGH_S = 1.0


def toes_of(reference, radius: float) -> list[int]:
    """Contact points (of (n, 3) [m], before the release) at the rim's +x and -x ends."""
    return [
        int(np.linalg.norm(reference - [sign * radius, 0.0, 0.0], axis=1).argmin())
        for sign in (1, -1)
    ]


def full(given: Release, steps: int):
    """Rows of the track, one a step, of the full-order engine."""
    rocking.release("corotated", 0.4)  # compiles what a release and an impact call
    trial = Trial(
        system_of(Case.of_column(given.case)),
        lambda system: tilted(system, given.tilt, 0.0),
    )
    interface = trial.system.interface
    reference = interface.reference[interface.points["node"]]
    toes, standing, cpu, made = (
        toes_of(reference, given.radius),
        trial.mechanical() - given.rigid.energy(given.tilt),
        0.0,
        0,
    )
    for step in range(steps + 1):
        if step:
            began = time.process_time()
            trial.step()
            cpu += time.process_time() - began
        state, made, before = trial.state, trial.stepper.record.iterations, made
        R = state.rotation[0]
        yield (
            state.time,
            np.arctan2(R[0, 2], R[2, 2]),
            *(state.relative[toes, 0] - reference[toes, 0]),
            trial.mechanical() - standing,
            cpu,
            made - before,
            1,
        )


def reduced(given: Release, steps: int):
    """Rows of the track of a compiled engine."""
    from fecolumn.engines.reduced_engine import engine_of
    from fecolumn.structures.structure import structure_model

    case = Case.of_column(given.case)
    model = structure_model(case)
    still = np.zeros((steps, 3))
    engine_of(case, model, "peers").advance(still)  # compiles
    spent = made = 0
    while spent < ENOUGH_S:
        engine = engine_of(case, model, "peers")
        began = time.process_time()
        engine.advance(still)
        spent += time.process_time() - began
        made += steps
    engine = engine_of(case, model, "peers")
    reference = model.parts[0].model.reference[engine.points["node"]]
    toes, standing, seen = (
        toes_of(reference, given.radius),
        engine.mechanical() - given.rigid.energy(given.tilt),
        0,
    )
    for step in range(steps + 1):
        if step:
            engine.advance(still[:1])
        motion, seen, before = engine.motion, engine.record.iterations, seen
        R = motion.rotation[0]
        yield (
            motion.time,
            np.arctan2(R[0, 2], R[2, 2]),
            *(motion.contact["relative"][toes, 0] - reference[toes, 0]),
            engine.mechanical() - standing,
            step * spent / made,
            seen - before,
            1,
        )


def main(engine: str, name: str, folder: str, steps: str = "") -> None:
    given = release(name)
    plan = dataclasses.replace(given.case.integration, engine=engine)
    given = dataclasses.replace(given, case=dataclasses.replace(given.case, integration=plan))
    rows = (full if engine == "full" else reduced)(given, int(steps or given.steps))
    write_rows(Path(folder) / "track.csv", rows)


if __name__ == "__main__":
    main(*sys.argv[1:])
