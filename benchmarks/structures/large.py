"""What a step of a large structure costs in full order: a temple column of five drums and its
capital, standing and rocking.
"""

from __future__ import annotations

import math
import tempfile
import time
import tomllib
from pathlib import Path

import numpy as np

from benchmarks.profile import shares
from fecolumn.case.case import case_from_tables
from fecolumn.engines.full_analysis import FullAnalysis
from fecolumn.foundation.toml_file import merge

CASE = Path(__file__).parents[2] / "meshes" / "temple_column.toml"
#: Height of a drum [m]; element size [m] that makes 225,000 degrees of freedom; how far points may
#: slide [m]
HEIGHT, SIZE, ALLOWANCE = 2.0, 0.04, 0.03
#: Amplitude [m/s2] and frequency [Hz] of the sines along x and y. After so many steps of the second
#: the column rocks
STILL, SHAKEN, RATES, ROCKS = 0.05, 6.0, (2.0, 1.3), 100


def temple_case(size: float = SIZE, dt: float = 1e-3):
    """The example of `meshes` with higher drums and contact on their rims alone."""
    tables = tomllib.loads(CASE.read_text())
    del tables["motion"]
    drums = len(tables["bodies"]["drum"]["copies_m"])
    larger = dict(
        drum=dict(
            height_m=HEIGHT,
            element_size_m=size,
            copies_m=[[0.0, 0.0, HEIGHT * i] for i in range(drums)],
        ),
        capital=dict(element_size_m=size, at_m=[0.0, 0.0, HEIGHT * drums]),
    )
    joints = {name: dict(allowance_m=ALLOWANCE) for name in ("joints", "capital")}
    return case_from_tables(
        merge(
            tables,
            dict(
                bodies=larger,
                joints=joints,
                contact=dict(interior_points=0),
                integration=dict(engine="full", dt_s=dt, duration_s=10.0),
            ),
        ),
        "large",
    )


def costs(comm, standing: int = 20, rocking: int = 50, parted: int = 10) -> dict:
    """Degrees of freedom; time [s] until the first step; CPU time [s] and iterations of a step, the
    median of those that stand and the mean of those that rock; and the share of the time of what
    the next `parted` steps of each do.
    """
    began, case = time.perf_counter(), temple_case()
    with tempfile.TemporaryDirectory() as folder:
        analysis = FullAnalysis(case, Path(folder), comm, "large", True)
        start, spent, iterations = time.perf_counter() - began, [], []

        def make(step: int) -> None:
            still = step <= standing + parted
            amplitude = STILL if still else SHAKEN
            at = case.integration.dt_s * (step if still else step - standing - parted)
            ground = amplitude * np.array(
                [
                    math.sin(2 * math.pi * RATES[0] * at),
                    0.3 * math.sin(2 * math.pi * RATES[1] * at),
                    0.0,
                ]
            )
            before, clock = analysis.stepper.record.iterations, time.process_time()
            analysis.state = analysis.stepper.step(analysis.state, ground)
            spent.append(time.process_time() - clock)
            iterations.append(analysis.stepper.record.iterations - before)

        parts = []
        for steps in (standing, ROCKS + rocking):
            for _ in range(steps):
                make(len(spent) + 1)
            with shares() as part:
                for _ in range(parted):
                    make(len(spent) + 1)
            parts.append(part)
        rocked = slice(-parted - rocking, -parted)
        tilt = max(
            float(value)
            for name, value in analysis.observer.measure(analysis.state).items()
            if name.startswith("body/") and name.endswith("/tilt")
        )
        return dict(
            dofs=3 * analysis.system.bodies.n_nodes,
            ranks=comm.size,
            start_s=start,
            standing_s=float(np.median(spent[2:standing])),
            rocking_s=float(np.mean(spent[rocked])),
            standing_iterations=float(np.mean(iterations[:standing])),
            rocking_iterations=float(np.mean(iterations[rocked])),
            tilt_rad=tilt,
            parts=parts,
        )
