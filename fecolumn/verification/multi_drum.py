"""The multi-drum column of HybriDFEM's benchmark: least accelerations of a pulse that overturn it,
beside three programs and the planar one of benchmarks/planar.

Seven drums of 0.82 m and a capital of 0.21 m, whose widths taper from 1.11 to 0.90 m so that
neighbouring faces are equal; rigid bodies, steps of 1e-3 s.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import meshio
import numpy as np

from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model
from fecolumn.verification.result import Row

#: Step [s]
DRUMS_DT = 1e-3
# Heights [m] from below, widths of foot and head of the column [m], density [kg/m3], friction
_HEIGHTS, _WIDTHS, _DENSITY, _FRICTION = 7 * (0.82,) + (0.21,), (1.11, 0.90), 2620.0, 0.7
#: Of a first half of the pulse [s], accelerations [g] and whether the planar program (1e-4 s) says
#: that they overturn; benchmarks/tables/drums_pushed.csv has both programs' scan, and what UDEC,
#: HybriDFEM and LMGC90 say. At 0.1 s rounding decides between 4.12 and 4.32 g: there a pulse
#: stronger by 1e-9 g overturns it or does not.
OUTCOMES = {
    0.1: {4.0: False, 4.4: True},
    0.34: {
        0.43: False,
        0.44: True,
        0.455: False,
        0.47: True,
        0.48: False,
        0.5: True,
        0.55: False,
        0.75: False,
        0.765: True,
    },
    0.5: {0.25: False, 0.26: True},
    1.0: {0.203: False, 0.207: True},
}


def multi_drum_rows() -> Iterator[Row]:
    """Whether it overturns where the planar program says so."""
    with tempfile.TemporaryDirectory() as folder:
        case = drum_case(Path(folder))
        model = structure_model(case)
    for tp, outcomes in OUTCOMES.items():
        found = [
            bool(engine_of(case, model, "verify").advance(drum_pulse(a, tp, 12.0 - 3 * tp))[1])
            for a in outcomes
        ]
        differ = sum(one != exact for one, exact in zip(found, outcomes.values()))
        yield Row(
            f"multi-drum column, pulse of {tp:g} s of "
            f"{', '.join(f'{a:g}' for a in outcomes)} g: outcomes other than those of a "
            "planar program",
            0,
            differ,
            0.5,
        )


def drum_pulse(a: float, tp: float, rest: float, dt: float = DRUMS_DT) -> np.ndarray:
    """Ground accelerations (n, 3) [m/s2] at the ends of steps: a [g] along x for tp [s], -a/2 for
    twice as long, then rest [s].
    """
    time = dt * np.arange(1, round((3 * tp + rest) / dt) + 1)
    return np.outer(
        a * GRAVITY * np.where(time <= tp + 1e-9, 1.0, np.where(time <= 3 * tp + 1e-9, -0.5, 0.0)),
        [1.0, 0.0, 0.0],
    )


def drums_of_column() -> list[np.ndarray]:
    """Outlines (4, 2) [m] of the seven drums and the capital as they stand: foot from left to
    right, head from left to right.
    """
    heights, (wide, narrow) = np.array(_HEIGHTS), _WIDTHS
    levels = np.concatenate([[0.0], np.cumsum(heights)])
    half = (wide + (narrow - wide) * levels / levels[-1]) / 2
    return [
        np.array([[-a, low], [a, low], [-b, high], [b, high]])
        for a, b, low, high in zip(half, half[1:], levels, levels[1:])
    ]


def drum_case(folder: Path) -> Case:
    """Case of the column; the drums are mesh files in the folder, 1 m deep."""
    bodies, joints = {}, {}
    for k, ((a, low), (b, high)) in enumerate(drum[[1, 3]] for drum in drums_of_column()):
        file = folder / f"drum{k}.vtk"
        corners = [
            [x * half, y / 2, z]
            for z, half in ((0.0, a), (high - low, b))
            for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
        meshio.Mesh(np.array(corners), [("hexahedron", [list(range(8))])]).write(file)
        bodies[f"d{k}"] = dict(
            kind="mesh", mesh_file=str(file), density_kg_m3=_DENSITY, at_m=[0.0, 0.0, float(low)]
        )
        joints[f"j{k}"] = dict(between=[f"d{k}", f"d{k - 1}" if k else "ground"])
    return case_from_tables(
        dict(
            bodies=bodies,
            joints=joints,
            contact=dict(friction_coefficient=_FRICTION, interior_points=0),
            integration=dict(engine="rigid", dt_s=DRUMS_DT, duration_s=20.0),
        ),
        "drums.toml",
    )
