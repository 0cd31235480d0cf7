"""Drums on one another, and columns below a slab, of whom the costs of a step are measured."""

from __future__ import annotations

import math

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.toml_file import merge

#: Diameter and height [m] of a column of the frame, and of a drum
COLUMN, DRUM = (0.2, 1.5), (1.6, 0.5)
#: Frequency [Hz] of the sine that shakes them; tilt at which they are let go, over the slenderness
#: of what rocks as one
RATE, LET_GO = 3.0, 0.2
_STONE = dict(poissons_ratio=0.2, modes=10)


def frame_case(
    columns: int,
    rocks: bool,
    engine: str = "reduced",
    points: int = 24,
    tables: dict | None = None,
    column: tuple[float, float] = COLUMN,
):
    """A slab on so many columns of concrete, a power of two, in a square or two beside each other,
    of a diameter and height [m]; further tables as of `stack_case`.
    """
    (diameter, height), rows = column, 2 ** (int(math.log2(columns)) // 2)
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
    body = _around(diameter, points) | dict(
        kind="cylinder",
        outer_diameter_m=diameter,
        height_m=height,
        copies_m=places,
        density_kg_m3=2500.0,
        youngs_modulus_pa=30e9,
    )
    return _case(
        dict(column=body | _STONE, slab=slab | _STONE),
        dict(feet=dict(between=["column", "ground"]), heads=dict(between=["column", "slab"])),
        dict(column=dict(tilt_rad=LET_GO * diameter / height)) if rocks else {},
        engine,
        tables,
    )


def stack_case(
    drums: int,
    rocks: bool,
    engine: str = "reduced",
    points: int = 24,
    tables: dict | None = None,
    drum: tuple[float, float] = DRUM,
):
    """So many drums of marble on one another, of a diameter and height [m]; all lean as one where
    they rock. Further tables are merged into those of the case.
    """
    diameter, height = drum
    body = _around(diameter, points) | dict(
        kind="cylinder",
        outer_diameter_m=diameter,
        height_m=height,
        copies_m=[[0.0, 0.0, height * i] for i in range(drums)],
        density_kg_m3=2700.0,
        youngs_modulus_pa=50e9,
    )
    joints = dict(ground=dict(between=["drum", "ground"])) | (
        dict(joints=dict(between=["drum", "drum"])) if drums > 1 else {}
    )
    return _case(
        dict(drum=body | _STONE),
        joints,
        dict(drum=dict(tilt_rad=LET_GO * diameter / (height * drums))) if rocks else {},
        engine,
        tables,
    )


def _around(diameter: float, points: int) -> dict:
    """Element size that makes so many contact points around a face; 24 are the default."""
    return {} if points == 24 else dict(element_size_m=math.pi * diameter / points)


def _case(bodies, joints, initial, engine, tables):
    own = dict(
        bodies=bodies,
        joints=joints,
        contact=dict(friction_coefficient=0.7, interior_points=0),
        initial=initial,
        integration=dict(dt_s=1e-3, duration_s=60.0, engine=engine),
    )
    return case_from_tables(merge(own, tables or {}), "frames and stacks")
