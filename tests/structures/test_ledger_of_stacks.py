"""The energy ledger of shaken stacks of tapered drums and blocks, step by step: impacts and
friction take energy, and take none that contact makes in the same step.
"""

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.engines.reduced.observe import ENERGY
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

# of each body [m]
HEIGHT, WIDTHS, DT = 0.82, 1.11 - 0.04 * np.arange(6), 1e-3


def stack(kind: str, engine: str):
    """Six bodies on one another, each 40 mm narrower than the one below."""
    stone, bodies, joints = (
        dict(youngs_modulus_pa=5e10, poissons_ratio=0.2, density_kg_m3=2620.0),
        {},
        {},
    )
    for k, width in enumerate(WIDTHS):
        shape = (
            dict(outer_diameter_m=width)
            if kind == "cylinder"
            else dict(length_m=width, width_m=0.9 * width)
        )
        bodies[f"d{k}"] = (
            dict(kind=kind, height_m=HEIGHT, at_m=[0.0, 0.0, HEIGHT * k]) | shape | stone
        )
        joints[f"j{k}"] = dict(between=[f"d{k}", f"d{k - 1}" if k else "ground"])
    case = case_from_tables(
        dict(
            bodies=bodies,
            joints=joints,
            contact=dict(friction_coefficient=0.7, interior_points=0),
            integration=dict(engine=engine, dt_s=DT, duration_s=20.0, n_modes=4),
        ),
        "stack.toml",
    )
    return engine_of(case, structure_model(case), "stack.toml")


def motion(seed: int, steps: int) -> np.ndarray:
    """Eight sines in each direction, up to twice the acceleration at which the stack lifts off."""
    random, time, ground = np.random.default_rng(seed), DT * np.arange(1, 3001), np.zeros((3000, 3))
    for axis, share in ((0, 1.0), (1, 0.7)):
        for frequency in random.uniform(0.5, 6.0, 8):
            ground[:, axis] += share * np.sin(
                2 * np.pi * frequency * time + random.uniform(0, 2 * np.pi)
            )
    ground *= np.minimum(1, time / 0.3)[:, None]
    return (2 * GRAVITY * WIDTHS[0] / (6 * HEIGHT) * ground / np.abs(ground).max())[:steps]


@pytest.mark.long
@pytest.mark.parametrize(
    "kind, engine, seed, steps",
    [
        ("cylinder", "rigid", 2, 2700),
        ("block", "rigid", 1, 2400),
        ("cylinder", "reduced", 2, 1000),
        ("block", "reduced", 1, 700),
    ],
)
def test_no_step_books_a_term_of_the_wrong_sign(kind, engine, seed, steps):
    """In one step a drum's impact was booked as 28 J that contact had made: the corner of two rims,
    open, had gone on where the gap was another.
    """
    rows, _ = stack(kind, engine).advance(motion(seed, steps))
    energy = rows[:, ENERGY : ENERGY + len(TERMS)]
    booked = dict(zip(TERMS, np.diff(energy, axis=0, prepend=0).T))
    largest = np.abs(energy[:, :3]).max()
    assert energy[:, 0].max() > 30 and booked["impact"].sum() < -1
    assert max(booked["impact"].max(), booked["friction"].max()) <= 1e-9 * largest
    assert np.minimum(-booked["impact"], booked["contact"]).max() <= 2e-3 * largest
    assert np.abs(energy[:, -1]).max() <= 1e-11 * largest
