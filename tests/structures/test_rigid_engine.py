"""Bodies of the rigid engine: they give nowhere, and an impact takes what rigid-body theory
says.
"""

import numpy as np
import pytest
from small_structures import frame, structure

from fecolumn.structures.structure import structure_model
from fecolumn.verification.podium_structure import let_go

CONCRETE = dict(youngs_modulus_pa=30e9, poissons_ratio=0.2, density_kg_m3=2500.0)
BREADTH, HEIGHT, TILT = 1.2, 8.0, 0.04


def bent(engine: str, dt: float, cap_kg: float, **keys):
    """Two piers and a cap, let go where the piers lean."""
    pier = (
        dict(
            kind="block",
            length_m=BREADTH,
            width_m=BREADTH,
            height_m=HEIGHT,
            element_size_m=BREADTH,
            copies_m=[[-3.0, 0, 0], [3.0, 0, 0]],
        )
        | CONCRETE
        | keys
    )
    cap = (
        dict(
            kind="slab",
            length_m=9.0,
            width_m=2.0,
            thickness_m=1.5,
            at_m=[0, 0, HEIGHT],
            element_size_m=0.75,
        )
        | CONCRETE
        | keys
        | dict(density_kg_m3=cap_kg / 27)
    )
    return structure(
        bodies=dict(pier=pier, cap=cap),
        joints=dict(feet=dict(between=["pier", "ground"]), heads=dict(between=["pier", "cap"])),
        initial=dict(pier=dict(tilt_rad=TILT)),
        contact=dict(friction_coefficient=0.7, interior_points=0),
        integration=dict(engine=engine, dt_s=dt, n_modes=0),
    )


def lost(engine: str, dt: float, cap_kg: float, **keys) -> float:
    """Energy that the first impact takes over what Makris and Vassiliou (2013) say."""
    rows = let_go(bent(engine, dt, cap_kg, **keys), 0.85)
    mechanical = sum(rows[f"energy/{name}"] for name in ("kinetic", "gravity", "strain"))
    struck, near = int(np.argmin(rows["body/pier 1/tilt"])), round(0.05 / dt)
    alpha, ratio = (
        np.arctan(BREADTH / HEIGHT),
        cap_kg / (2 * CONCRETE["density_kg_m3"] * BREADTH**2 * HEIGHT),
    )
    kept = (1 - 1.5 * np.sin(alpha) ** 2 + 3 * ratio * np.cos(2 * alpha)) / (1 + 3 * ratio)
    # to upright from where they leant: a pier's centre by half of what its head goes down
    diagonal = np.hypot(BREADTH, HEIGHT)
    down = diagonal * (np.cos(alpha - TILT) - np.cos(alpha))
    fallen = 9.80665 * down * (cap_kg + cap_kg / (2 * ratio))
    return (
        (mechanical[struck - near] - mechanical[struck + near])
        / (mechanical[struck - near] - mechanical[0] + fallen)
        / (1 - kept**2)
    )


@pytest.mark.long
@pytest.mark.parametrize(
    "dt, cap_kg, keys",
    [(1e-3, 400e3, {}), (2.5e-4, 400e3, dict(rigid=True)), (1e-3, 6e3, {}), (1e-3, 1.15e6, {})],
)
def test_an_impact_of_a_bent_takes_the_rigid_loss(dt, cap_kg, keys):
    """Within 1 % of it, whatever concrete would give, the cap's mass and the step."""
    assert lost("rigid", dt, cap_kg, **keys) == pytest.approx(1.0, abs=0.01)


def test_elastic_faces_belong_to_the_reduced_engine():
    """Without modes they are what is left of concrete, and give back at 2.5e-4 s what they stored
    at landing.
    """
    assert lost("reduced", 2.5e-4, 400e3) < 0.95


@pytest.mark.parametrize(
    "engine, keys, gives",
    [
        ("rigid", {}, False),
        ("rigid", dict(rigid=True), False),
        ("rigid", dict(rigid=True, contact_stiffness_n_m3=1e10), True),
        ("reduced", dict(rigid=True), True),
        ("reduced", {}, True),
    ],
)
def test_the_rigid_engine_gives_where_a_stiffness_is_stated_alone(engine, keys, gives):
    assert [
        part.model.flexibility.any()
        for part in structure_model(bent(engine, 1e-3, 400e3, **keys)).parts
    ] == [gives] * 3


def test_a_frame_of_many_points_stands_and_rocks_without_making_energy():
    """Four columns of 24 points at each end, more than rigid bodies need to share their forces; the
    slab is pushed.
    """
    case = structure(
        **frame(
            column=dict(element_size_m=0.026),
            integration=dict(engine="rigid", dt_s=1e-3),
            contact=dict(interior_points=0),
            initial=dict(slab=dict(velocity_m_s=[0.25, 0.1, 0.0])),
        )
    )
    rows = let_go(case, 1.0)
    energy = sum(rows[f"energy/{name}"] for name in ("kinetic", "gravity", "strain"))
    moved, rises = np.ptp(rows["energy/gravity"]), np.diff(energy)
    assert moved > 100.0 and rises[rises > 0].sum() < 1e-4 * moved
    assert np.abs(rows["energy/closure"] - rows["energy/closure"][0]).max() < 1e-11 * moved
    assert rows["penetration"].max() < 1e-10
