"""The restrained wobbling frame of finite elements (`meshes/wobbling_frame.toml`) beside the model
with two degrees of freedom.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.toml_file import merge
from fecolumn.verification.podium_structure import let_go
from fecolumn.verification.structures import (
    energy_at,
    frame_model,
    planar_restitution,
    restoring_force,
    rolling_start,
    slab_path,
)

MESHES = Path(__file__).parents[2] / "meshes"
TILTS = (0.01, 0.03, 0.06, 0.1, 0.13)  # [rad]
#: Tilt [rad] and rate of the azimuth [rad/s] at the start of free motions
PLANAR, ROUND = (0.03, 0.0), (0.05, 1.5)
_DT = 5e-4


def frame_of_elements(model, initial: dict, dt: float = _DT):
    """The case of the file, let go as `initial` says; 12 points a rim, no tendon breaks, none where
    the model has none.
    """
    file = MESHES / "wobbling_frame.toml"
    tables = tomllib.loads(file.read_text())
    if model.body[7]:
        del tables["links"]["tendon"]["breaking_n"]
    else:
        del tables["links"]
    del tables["initial"]
    return case_from_tables(
        merge(
            tables,
            dict(
                bodies=dict(column=dict(element_size_m=0.05)),
                contact=dict(interior_points=0),
                initial=initial,
                integration=dict(dt_s=dt),
            ),
        ),
        file,
    )


def forces() -> list[tuple]:
    """Of frames with and without tendons at TILTS: tendons, tilt [rad], displacement of the slab
    [m], force [N] by virtual work, of slender columns, of elements.
    """
    found = []
    for held in (True, False):
        model = frame_model() if held else frame_model(tendon_n_m=0.0)
        for tilt in TILTS:
            moved, exact = model.pushover(tilt)
            # the release rings for some hundredths of a second
            rows = let_go(frame_of_elements(model, rolling_start(model, tilt)), 0.06)
            found.append(
                (
                    held,
                    tilt,
                    moved,
                    exact,
                    float(model.planar.linear_pushover(moved)),
                    restoring_force(model, rows, tilt),
                )
            )
    return found


def planar(seconds: float = 3.0):
    """Free motion in a plane: rows of elements, times and slab displacements [m] of the model, and
    of each impact its time [s] and share of the energy kept.
    """
    model = frame_model()
    rows = let_go(frame_of_elements(model, rolling_start(model, PLANAR[0])), seconds)
    time, moved, tilt = (
        rows["time"],
        rows["body/slab/displacement"][:, 0],
        rows["body/column 1/tilt"],
    )
    passed = [int(i) for i in np.flatnonzero(np.diff(np.sign(moved)) != 0)]
    ends = [0, *passed, len(time) - 1]
    tops = [energy_at(model, float(tilt[a:b].max())) for a, b in zip(ends, ends[1:]) if b - a > 50]
    impacts = [
        (float(time[i]), after / before) for i, before, after in zip(passed, tops, tops[1:-1])
    ]
    return rows, slab_path(model, *PLANAR, time), impacts, planar_restitution(model) ** 2


def rolled(seconds: float = 3.0):
    """Free motion that rolls round: rows of elements, and the slab's displacement (n, 2) [m] by the
    model.
    """
    model = frame_model()
    rows = let_go(frame_of_elements(model, rolling_start(model, *ROUND)), seconds)
    return rows, slab_path(model, *ROUND, rows["time"])
