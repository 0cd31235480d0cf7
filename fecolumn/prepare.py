"""What is compiled on each machine, compiled before somebody waits for it: finite-element forms,
contact, curves of figures.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from fecolumn.foundation.interrupt import ended_at_a_stop

# A short tube of few bricks: what is compiled does not depend on it
_TUBE = dict(
    column=dict(outer_diameter_m=0.1, wall_m=0.02, height_m=0.3, fine_height_m=0.0),
    base=dict(length_m=0.2, width_m=0.2, thickness_m=0.05),
    mesh=dict(fine_size_m=0.02, coarse_size_m=0.03, base_size_m=0.05),
)
# Two blocks, of which the upper one leans so far that it is lost
_BLOCK = dict(kind="block", length_m=0.2, width_m=0.1, height_m=0.3, element_size_m=0.1)
_STACK = dict(
    bodies=dict(low=_BLOCK, up=_BLOCK | dict(at_m=[0.0, 0.0, 0.3])),
    joints=dict(foot=dict(between=["low", "ground"]), joint=dict(between=["up", "low"])),
    initial=dict(up=dict(tilt_rad=0.7)),
)
_PODIUM = dict(podium=dict(column_mass_kg=1.0, floor_mass_kg=10.0, width_m=0.1, height_m=0.5))

# Cases that share what they compile stand in one lot; each lot is run by a process of its own
_LOTS = (
    (("full", _TUBE), ("full", _STACK)),
    (
        ("reduced", _TUBE),
        ("reduced", _STACK),
        ("housner", _TUBE),
        ("wobbling", _TUBE),
        ("podium", _PODIUM),
    ),
)


def prepare(say: Callable[..., Any]) -> None:
    """Run one step of every engine, which compiles what is missing on this machine; seconds where
    nothing is. Two processes work side by side.

    Parameters
    ----------
    say
        told what is done and how long it took.
    """
    from fecolumn.pictures.figures.thinning import thinned

    with contextlib.ExitStack() as stack:
        began = []
        for lot in _LOTS:
            alone = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"))
            process = stack.enter_context(alone)
            stack.enter_context(ended_at_a_stop(alone))
            began += [process.submit(_compile, *one) for one in lot]
        for done in as_completed(began):
            say(done.result())
    thinned([0.0, 1.0], [[0.0], [1.0]], [1.0])


def _compile(engine: str, tables: dict) -> str:
    """Run one step of a case; what is told of it."""
    from fecolumn.case.case import case_from_tables
    from fecolumn.simulation import run

    began, of = time.perf_counter(), " of structures" if "bodies" in tables else ""
    plan = dict(engine=engine, duration_s=1e-3, dt_s=1e-3)
    case = case_from_tables(tables | dict(integration=plan), "fecolumn prepare")
    with tempfile.TemporaryDirectory() as folder:
        run(case, Path(folder) / engine, file="fecolumn prepare", quiet=True)
    return f"{engine} engine{of} ready after {time.perf_counter() - began:.0f} s"
