"""What is compiled on each machine, compiled before somebody waits for it: finite-element forms,
contact, curves of figures.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

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


def prepare(say) -> None:
    """Run one step of every engine, which compiles what is missing on this machine; seconds where
    nothing is.

    Parameters
    ----------
    say
        told what is done and how long it took.
    """
    from fecolumn.case.case import case_from_tables
    from fecolumn.pictures.figures.thinning import thinned
    from fecolumn.simulation import run

    for engine, tables in (
        ("full", _TUBE),
        ("full", _STACK),
        ("reduced", _TUBE),
        ("reduced", _STACK),
        ("housner", _TUBE),
        ("wobbling", _TUBE),
        ("podium", _PODIUM),
    ):
        began, of = time.perf_counter(), " of structures" if tables is _STACK else ""
        plan = dict(engine=engine, duration_s=1e-3, dt_s=1e-3)
        case = case_from_tables(tables | dict(integration=plan), "fecolumn prepare")
        with tempfile.TemporaryDirectory() as folder:
            run(case, Path(folder) / engine, file="fecolumn prepare", quiet=True)
        say(f"{engine} engine{of} ready after {time.perf_counter() - began:.0f} s")
    thinned([0.0, 1.0], [[0.0], [1.0]], [1.0])
