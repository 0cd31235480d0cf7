"""A podium made of bodies: four rigid columns, a slab on them and a building of storeys on it.

Dimensions are those of the paper on impact modelling of multi-storey podium structures.
"""

from __future__ import annotations

import math

import numpy as np

from fecolumn.case.case import Case, case_from_tables
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

#: Half diagonal of a column [m], its slenderness [rad], mass of the slab over that of a column [-]
HALF_DIAGONAL, ALPHA, GAMMA = 1.5, math.atan(0.15), 10.0
#: Young's modulus [Pa] of bodies whose contact points hardly give
STIFF = 1e14


def let_go(case: Case, seconds: float) -> dict[str, np.ndarray]:
    """Columns of the history of a structure that is let go on ground at rest."""
    engine = engine_of(case, structure_model(case), "case")
    rows, _ = engine.advance(np.zeros((round(seconds / float(case.integration.dt_s)), 3)))
    return columns_of(np.concatenate([engine.made[:0], rows]), engine.model)


def podium_case(
    floors: int,
    period: float,
    tilt: float,
    dt: float,
    column: dict | None = None,
    building: dict | None = None,
) -> Case:
    """The podium of [P] in bodies, let go at a tilt [rad]; period: of the building on a fixed slab
    [s].

    column, building: keys of the bodies in place of those of rigid ones that touch at stiff points.
    """
    width, height, mass = (
        2 * HALF_DIAGONAL * math.sin(ALPHA),
        2 * HALF_DIAGONAL * math.cos(ALPHA),
        1500.0,
    )
    material, slab = dict(youngs_modulus_pa=3 * STIFF, poissons_ratio=0.2), 4 * GAMMA * mass
    return case_from_tables(
        dict(
            bodies=dict(
                column=dict(
                    kind="block",
                    length_m=width,
                    width_m=width,
                    height_m=height,
                    mass_kg=mass,
                    rigid=True,
                    element_size_m=width,
                    copies_m=[
                        [2.5, 2.5, 0.0],
                        [-2.5, 2.5, 0.0],
                        [-2.5, -2.5, 0.0],
                        [2.5, -2.5, 0.0],
                    ],
                )
                | material
                | (column or {}),
                building=dict(
                    kind="storeys",
                    length_m=6.0,
                    width_m=6.0,
                    thickness_m=0.5,
                    mass_kg=slab,
                    floors=floors,
                    floor_masses_kg=[slab],
                    storey_heights_m=[3.0],
                    profile="triangular",
                    damping="rayleigh",
                    damping_ratio=0.05,
                    period_s=period,
                    modes=2 * floors,
                    at_m=[0.0, 0.0, height],
                )
                | material
                | (building or {}),
            ),
            joints=dict(
                feet=dict(between=["column", "ground"]), heads=dict(between=["column", "building"])
            ),
            contact=dict(friction_coefficient=0.7, interior_points=0),
            initial=dict(column=dict(tilt_rad=tilt)),
            integration=dict(dt_s=dt, duration_s=60.0),
        ),
        "podium",
    )


def tilt_of(rows: dict) -> np.ndarray:
    """Tilt (n,) [rad] of the podium's columns along x, with its sign."""
    moved = rows["body/column 1/displacement"][:, 0]
    return np.sign(moved) * (
        ALPHA - np.arcsin(np.clip(math.sin(ALPHA) - np.abs(moved) / HALF_DIAGONAL, -1, 1))
    )
