"""Small structures whose contact is found while bodies move, of rigid bodies of few elements."""

import numpy as np

from fecolumn.case.case import case_from_tables
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.foundation.toml_file import merge
from fecolumn.structures.structure import structure_model

DENSITY = 2500.0
ENERGIES = ("kinetic", "gravity", "strain")


def box(length: float, width: float, height: float, **keys) -> dict:
    """Table of a block of few elements."""
    size = min(length, width, height)
    return dict(
        kind="block",
        length_m=length,
        width_m=width,
        height_m=height,
        density_kg_m3=DENSITY,
        element_size_m=size,
        coarse_size_m=size,
    ) | (keys)


def rod(sides: int, radius: float, width: float, first: float = 0.0, **keys) -> dict:
    """Table of a prism along y, a polygon of so many corners about its at_m; the first of them at
    an angle [rad] from x to z.
    """
    angles = first + 2 * np.pi * np.arange(sides) / sides
    outline = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    return dict(
        kind="prism",
        outline_m=outline.tolist(),
        width_m=width,
        density_kg_m3=DENSITY,
        element_size_m=radius,
    ) | (keys)


def falling(bodies: dict, joints: dict | None = None, friction: float = 0.5, **tables):
    """Case of bodies that may meet anywhere, which begin where they are drawn."""
    return case_from_tables(
        merge(
            dict(
                integration=dict(engine="rigid", start="drawn", duration_s=1.0, dt_s=1e-3),
                contact=dict(between="all", friction_coefficient=friction),
                bodies=bodies,
            )
            | (dict(joints=joints) if joints else {}),
            tables,
        ),
        "fall.toml",
    )


def watched(case, seconds: float, grounds=None):
    """Engine after a time, and the columns of its history; grounds: (k, 3 G) accelerations [m/s2]
    of the grounds at the ends of the steps, none unless given.
    """
    engine = engine_of(case, structure_model(case), "case")
    count = round(seconds / case.integration.dt_s)
    first = engine.row()[None]
    rows, _ = engine.advance(
        np.zeros((count, 3 * len(engine.bases))) if grounds is None else grounds
    )
    return engine, columns_of(np.concatenate([first, rows]), engine.model)


def unclosed(rows) -> float:
    """How far energy does not close, over the largest energy."""
    largest = max(np.abs(rows[f"energy/{name}"]).max() for name in ENERGIES)
    closure = rows["energy/closure"]
    return float(np.abs(closure - closure[0]).max() / largest)
