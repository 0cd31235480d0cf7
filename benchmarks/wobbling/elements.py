"""A study of the frame of the tests in finite elements beside the wobbling model, on the motions of
the bins: its files, for `fecolumn study`.

Columns and slab are rigid but for their contact points, twelve a rim; contact decides on rolling,
sliding and lifting. Sliding restrainers as in the tests let each foot and head move by 5 mm along x
and y; they are links of 0.45 m, so that lifting does not stretch them. Tendons do not break, and
join column and slab on the axis.
"""

from __future__ import annotations

import itertools
from pathlib import Path

from benchmarks.wobbling.frame import SPECIMEN, specimen
from fecolumn.foundation.atomic import write_bytes
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.ensemble_file import write_ensemble

ENGINES = ("rigid", "wobbling_frame")
_STIFF = 1e14  # Young's modulus [Pa] of what should give nothing
_FRICTION = 0.7
_CASE = """# Restrained wobbling frame, 1:5: four columns, a slab on them, tendons between
# them, restrainers against sliding. [S] stated by the study, [D] derived from it, [A] assumption
# of this project.
# The same frame twice: integration.engine = "rigid" takes the bodies, "wobbling_frame" the model.
title = "Restrained wobbling frame"

[wobbling_frame]                    # [S]
{model}
friction_coefficient = {friction}           # [A] checked alone

[bodies.column]
kind = "cylinder"
outer_diameter_m = {diameter:.9g}         # [D]
height_m = {height:.9g}                # [D]
mass_kg = {mass:.9g}                 # [S]
rigid = true
youngs_modulus_pa = {stiff:g}
poissons_ratio = 0.2
element_size_m = {size:.6g}
copies_m = [[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]]   # [A]

[bodies.slab]
kind = "slab"
length_m = 3.0                      # [A]
width_m = 3.0                       # [A]
thickness_m = 0.43                  # [A]
mass_kg = {slab:.9g}                   # [S]
rigid = true
youngs_modulus_pa = {stiff:g}
poissons_ratio = 0.2
at_m = [0.0, 0.0, {height:.9g}]

[joints]
feet = {{between = ["column", "ground"]}}
heads = {{between = ["column", "slab"]}}

[links.tendon]
kind = "tendon"
body = "column"
to = "slab"
to_point_m = [0.0, 0.0, {height:.9g}]
stiffness_n_m = {tendon:g}            # [S]
{restrainers}
[contact]
friction_coefficient = {friction}           # [A]
interior_points = 0

[integration]
dt_s = 1e-3
"""
_RESTRAINER = """
[links.{name}]
kind = "restrainer"
body = "column"
to = "{to}"
point_m = [0.0, 0.0, {at:.9g}]
to_point_m = [{x:g}, {y:g}, {at:.9g}]
slack_m = 0.005                     # [S]
stiffness_n_m = 2e6                 # [A]
"""
_STUDY = """title = "Restrained wobbling frame"

[case]
extends = "frame.toml"
motion.strong_part = [0.001, 0.999]   # [A] of the Arias intensity: before it the frame stands

[axes]
"motion.source" = [
    {motions}]
"integration.engine" = [{engines}]
"""


def write_study(motions, folder: Path) -> Path:
    """Write frame.toml, the motions of each bin and study.toml into a folder; the study file.

    Parameters
    ----------
    motions
        by (set, level), as of `bins`.
    """
    frame = specimen()
    radius, _, height, mass, slab, *_, tendon, _, _ = frame.body
    places = [
        (f"{word}_{axis}", to, at, 0.45 * (axis == "x"), 0.45 * (axis == "y"))
        for word, to, at in (("foot", "ground", 0.0), ("head", "slab", height))
        for axis in "xy"
    ]
    restrainers = "".join(
        _RESTRAINER.format(name=name, to=to, at=at, x=x, y=y) for name, to, at, x, y in places
    )
    vertical = any(
        motion.acceleration[:, 2].any() for members in motions.values() for motion in members
    )
    text = _CASE.format(
        model="\n".join(f"{key} = {value:.9g}" for key, value in SPECIMEN.items()),
        friction=_FRICTION,
        diameter=2 * radius,
        height=height,
        mass=mass,
        slab=frame.columns * slab,
        stiff=_STIFF,
        size=radius / 2,
        tendon=tendon,
        restrainers=restrainers,
    )
    folder.mkdir(parents=True, exist_ok=True)
    write_bytes(folder / "frame.toml", text.encode())
    for (name, level), members in motions.items():
        write_ensemble(
            Ensemble(f"{name} {level}", tuple(members), {}, {}), folder / f"{name}_{level}.h5"
        )
    # bins in turn, in proportion to their numbers: a study that is stopped has motions of all of
    # them
    turns = sorted(
        (number / len(members), key)
        for key, members in motions.items()
        for number in range(len(members))
    )
    numbers = {key: itertools.count(1) for key in motions}
    sources = ",\n    ".join(
        f'"{name}_{level}.h5#{next(numbers[name, level])}"' for _, (name, level) in turns
    )
    study = _STUDY.format(engines=", ".join(f'"{one}"' for one in ENGINES), motions=sources)
    write_bytes(
        folder / "study.toml",
        (study + ('"motion.vertical" = [true]\n' if vertical else "")).encode(),
    )
    return folder / "study.toml"
