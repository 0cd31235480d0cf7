"""What the benchmark of structures reads from a motion, of motions that are known."""

import csv

import numpy as np
import pytest

from benchmarks.structures import figure, podium
from fecolumn.case.model_sections import CAV, CRV
from fecolumn.verification.podium_structure import ALPHA, HALF_DIAGONAL, tilt_of


def rows_of(response):
    """Columns of a history with the tilt of a model's response."""
    theta = response.coordinates["theta"]
    moved = np.sign(theta) * HALF_DIAGONAL * (np.sin(ALPHA) - np.sin(ALPHA - np.abs(theta)))
    return {"time": response.time, "body/column 1/displacement": moved[:, None] * [1.0, 0.0, 0.0]}


@pytest.mark.parametrize("law", [CRV, CAV])
def test_velocity_kept_at_an_impact_is_that_of_its_law(law):
    rows = rows_of(podium.model_rocking(3, law, 10.0, 0.3, 0.5))
    assert tilt_of(rows).max() == pytest.approx(0.3 * ALPHA)
    assert podium.kept_rate(rows) == pytest.approx(podium.laws(3)[law == CAV], rel=2e-3)


def test_next_top_of_a_rigid_podium_has_the_energy_that_its_law_leaves():
    tilt = tilt_of(rows_of(podium.model_rocking(3, CRV, 0.01, 0.3, 2.0)))
    assert podium.risen(tilt, 0.3) == pytest.approx(podium.laws(3)[0], rel=2e-3)
    assert podium.tops(tilt)[0] * ALPHA == pytest.approx(-tilt.min(), rel=1e-9)


def test_figure_is_drawn_from_what_is_there(tmp_path):
    with open(tmp_path / "forces.csv", "w", newline="") as file:
        csv.writer(file).writerows(
            [
                ["tendons", "tilt_rad", "slab_m", "virtual_work_n", "slender_n", "elements_n"],
                [True, 0.01, 0.014, 12716, 12649, 12700],
                [False, 0.01, 0.014, 12250, 12185, 12220],
            ]
        )
    figure.draw(tmp_path)
    assert (tmp_path / "structures.png").stat().st_size > 10_000
