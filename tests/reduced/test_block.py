"""A block rocks over its edges: no rim, its contact points stay on the nodes."""

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.engines.reduced.observe import WIDTH
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

SIDE, HEIGHT, START = 0.4, 1.2, 0.4


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
def test_a_marble_block_rocks_as_housner_says(engine):
    """Quarter period acosh(1 / (1 - th0/al)) / p, p^2 = 3 g / 4 R, and restitution 1 - 3/2 sin^2 al
    of a slender block.
    """
    slenderness, diagonal = np.arctan(SIDE / HEIGHT), np.hypot(SIDE, HEIGHT) / 2
    case = case_from_tables(
        {
            "column": {"shape": "block", "length_m": SIDE, "width_m": SIDE, "height_m": HEIGHT},
            "contact": {"friction_coefficient": 0.8},
            "material": {"youngs_modulus_pa": 50e9, "density_kg_m3": 2700.0},
            "mesh": {"fine_size_m": 0.05},
            "initial": {"tilt_rad": START * slenderness},
            "integration": {"engine": engine, "duration_s": 1.0},
        },
        "block.toml",
    )
    engine = engine_of(case, structure_model(case), "block.toml")
    rows, _ = engine.advance(np.zeros((900, 3)))
    time, lean, tilt = rows[:, 0], rows[:, 1], rows[:, 4]
    quarter = time[np.argmax(lean < 0)]
    assert quarter == pytest.approx(
        np.arccosh(1 / (1 - START)) / np.sqrt(3 * 9.80665 / (4 * diagonal)), rel=0.01
    )
    assert np.abs(rows[:, 2]).max() < 1e-6 * HEIGHT
    after = tilt[time > quarter + 0.05].max() / slenderness
    restitution = np.sqrt((1 - (1 - after) ** 2) / (1 - (1 - START) ** 2))
    assert restitution == pytest.approx(1 - 1.5 * np.sin(slenderness) ** 2, abs=0.01)
    assert (
        np.abs(rows[:, WIDTH - 1]).max()
        < 1e-9 * case.short.material.density_kg_m3 * SIDE**2 * HEIGHT * 9.8 * diagonal
    )
