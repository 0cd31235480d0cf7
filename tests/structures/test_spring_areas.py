"""Areas of springs at few points: they resist sinking and rocking as the whole face does."""

from __future__ import annotations

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.structures.model import Surface
from fecolumn.structures.spring_areas import LEAST_SHARE, areas_by_moments
from fecolumn.structures.structure import structure_model

pytestmark = pytest.mark.filterwarnings("error")

SQUARE = np.array([[[-1.0, -1], [1, -1], [1, 1]], [[-1, -1], [1, 1], [-1, 1]]])


def foot_of(body: dict, interior: int) -> tuple[Surface, np.ndarray]:
    """Foot of a body on soil, and the places (n, 2) [m] of its points."""
    case = case_from_tables(
        dict(
            bodies=dict(a=body),
            contact=dict(friction_coefficient=0.6, interior_points=interior),
            grounds=dict(soil=dict(kind="pad", stiffness_n_m3=1e8, damping_ratio=0.1)),
            joints=dict(foot=dict(between=["a", "soil"])),
            integration=dict(engine="rigid", dt_s=1e-3, duration_s=1.0),
        ),
        "case",
    )
    model = structure_model(case).parts[0].model
    foot = model.surfaces["foot"]
    return foot, foot.plane(model.arms[foot.nodes])[:, :2]


BODIES = {
    "block": dict(kind="block", length_m=0.6, width_m=0.4, height_m=1.0, element_size_m=0.1),
    "drum": dict(kind="cylinder", outer_diameter_m=1.0, height_m=2.0, element_size_m=0.1),
    "tube": dict(kind="tube", outer_diameter_m=1.0, wall_m=0.05, height_m=2.0, element_size_m=0.05),
}
SECOND = {"block": (0.6 * 0.4) / 12 * np.array([0.6**2, 0.4**2]), "drum": np.pi / 64 * np.ones(2)}
SECOND["tube"] = np.pi / 64 * (1 - 0.9**4) * np.ones(2)


@pytest.mark.parametrize("interior", [9, 81])
@pytest.mark.parametrize("name", BODIES)
def test_second_moments_are_those_of_the_section(name, interior):
    """With the default nine points inside as with 81: that of a polygon stands for a circle's."""
    foot, places = foot_of(BODIES[name], interior)
    areas = foot.spring_areas
    assert areas.sum() == pytest.approx(foot.areas.sum(), rel=1e-12)
    assert np.abs(areas @ places).max() < 1e-12 and abs(areas @ np.prod(places, axis=1)) < 1e-12
    np.testing.assert_allclose(areas @ places**2, SECOND[name], rtol=0.015)
    assert (areas >= LEAST_SHARE * foot.areas).all()
    # tributary areas alone are up to a fifth off
    assert name == "tube" or (foot.areas @ places**2 > 1.01 * SECOND[name]).any()


def test_points_that_cannot_have_the_moments_keep_area_and_centre():
    corners = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
    uneven = areas_by_moments(corners, np.array([1.1, 0.9, 1.0, 1.2]), SQUARE)
    np.testing.assert_allclose(uneven, 1.0, atol=1e-12)
    angles = 2 * np.pi * np.arange(12) / 12
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    chance = np.random.default_rng(3)
    around = np.array([(0.0 * ring[0], ring[k - 1], ring[k]) for k in range(12)])
    found = areas_by_moments(ring, chance.uniform(0.2, 0.3, 12), around)
    assert found.sum() == pytest.approx(3.0) and np.abs(found @ ring).max() < 1e-12
    inertia = found @ ring**2
    assert inertia[0] == pytest.approx(inertia[1]) and (found > 0).all()


def test_one_point_and_points_on_a_line_keep_what_they_have():
    assert areas_by_moments(np.zeros((1, 2)), np.array([4.0]), SQUARE) == [4.0]
    line = np.column_stack([np.linspace(-1, 1, 5), np.zeros(5)])
    found = areas_by_moments(line, np.full(5, 0.8), SQUARE)
    assert found.sum() == pytest.approx(4.0) and found @ line[:, 0] ** 2 == pytest.approx(4 / 3)


def test_a_pad_under_a_body_that_overhangs_is_told():
    block = dict(kind="block", length_m=0.4, width_m=0.3, height_m=0.4, density_kg_m3=2000.0)

    def stacked(aside):
        return case_from_tables(
            dict(
                bodies=dict(low=block, up=block | dict(at_m=[aside, 0.0, 0.4])),
                joints=dict(
                    foot=dict(between=["low", "ground"]),
                    pad=dict(between=["low", "up"], stiffness_n_m3=2e8),
                ),
                integration=dict(engine="rigid", dt_s=1e-3, duration_s=1.0),
            ),
            "case",
        )

    structure_model(stacked(0.0))  # no warning: they are errors in tests of this file
    with pytest.warns(UserWarning, match='joints.pad: "up" overhangs'):
        structure_model(stacked(0.05))
