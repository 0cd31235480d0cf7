"""Areas of springs at few points: they resist sinking and rocking as the whole face does."""

from __future__ import annotations

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.outlines import cross_product
from fecolumn.structures.spring_areas import (
    LEAST_SHARE,
    areas_by_moments,
    overlap_of,
    spring_areas,
)
from fecolumn.structures.standing import as_standing
from fecolumn.structures.structure import structure_model

pytestmark = pytest.mark.filterwarnings("error")

SQUARE = np.array([[[-1.0, -1], [1, -1], [1, 1]], [[-1, -1], [1, 1], [-1, 1]]])


def foot_of(body: dict, interior: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Of the foot of a body on soil: areas (n,) [m2] of its springs, places (n, 2) [m] of its
    points, and least share of its tributary area that a point keeps.
    """
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
    structure = structure_model(case)
    model = structure.parts[0].model
    foot = model.surfaces["foot"]
    areas, rows = spring_areas(as_standing(structure), structure.joints[0])
    assert len(rows) == len(areas)
    scaled = foot.areas * areas.sum() / foot.areas.sum()
    return areas, foot.plane(model.arms[foot.nodes])[:, :2], (areas / scaled).min()


BODIES = {
    "block": dict(kind="block", length_m=0.6, width_m=0.4, height_m=1.0, element_size_m=0.1),
    "drum": dict(kind="cylinder", outer_diameter_m=1.0, height_m=2.0, element_size_m=0.1),
    "tube": dict(kind="tube", outer_diameter_m=1.0, wall_m=0.05, height_m=2.0, element_size_m=0.05),
}
SECOND = {"block": (0.6 * 0.4) / 12 * np.array([0.6**2, 0.4**2]), "drum": np.pi / 64 * np.ones(2)}
SECOND["tube"] = np.pi / 64 * (1 - 0.9**4) * np.ones(2)

AREA = {"block": 0.24, "drum": np.pi / 4, "tube": np.pi / 4 * (1 - 0.9**2)}


@pytest.mark.long
@pytest.mark.parametrize("interior", [9, 81])
@pytest.mark.parametrize("name", BODIES)
def test_second_moments_are_those_of_the_section(name, interior):
    """With the default nine points inside as with 81; of a circle, not of the polygon drawn."""
    areas, places, least = foot_of(BODIES[name], interior)
    assert areas.sum() == pytest.approx(AREA[name], rel=1e-9)
    assert np.abs(areas @ places).max() < 1e-12 and abs(areas @ np.prod(places, axis=1)) < 1e-12
    np.testing.assert_allclose(areas @ places**2, SECOND[name], rtol=2e-4)
    assert least >= LEAST_SHARE


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


def test_two_faces_that_overlap_have_the_moments_of_the_region_in_which_they_do():
    turned = SQUARE @ np.array([[1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(2)
    region = overlap_of(SQUARE, turned)
    first, second = region[:, 1] - region[:, 0], region[:, 2] - region[:, 0]
    # an octagon
    assert cross_product(first, second).sum() / 2 == pytest.approx(8 * (np.sqrt(2) - 1))
    assert len(overlap_of(SQUARE, SQUARE + 2.5)) == 0
    assert len(overlap_of(SQUARE, SQUARE[:, ::-1])) and not len(overlap_of(SQUARE, SQUARE[:0]))


BLOCK = dict(kind="block", length_m=0.4, width_m=0.3, height_m=0.4, density_kg_m3=2000.0)
STIFFNESS = 2e9


def stacked(aside: float, interior: int = 9, **keys):
    return case_from_tables(
        dict(
            bodies=dict(low=BLOCK, up=BLOCK | dict(at_m=[aside, 0.0, 0.4])),
            joints=dict(
                foot=dict(between=["low", "ground"]),
                pad=dict(between=["low", "up"], stiffness_n_m3=STIFFNESS),
            ),
            contact=dict(interior_points=interior),
            integration=dict(engine="rigid", dt_s=2e-4, duration_s=1.0) | keys,
        ),
        "case",
    )


@pytest.mark.parametrize("aside", [0.02, 0.05, 0.06])
def test_a_body_that_overhangs_a_pad_leans_as_the_overlap_says(aside):
    """Closed form: k I phi = M about the centre of the region in which both faces touch."""
    case = stacked(aside)
    engine = engine_of(case, structure_model(case), "case")
    weight, length = 0.4 * 0.3 * 0.4 * 2000 * GRAVITY, 0.4 - aside
    leans = weight * aside / 2 / (STIFFNESS * 0.3 * length**3 / 12)
    assert engine.motion.rotation[1, 0, 2] == pytest.approx(leans, rel=2e-3)


def test_points_too_few_for_a_pad_are_told():
    structure_model(stacked(0.0))  # no warning: they are errors in tests of this file
    told = 'joints.pad: the 32 contact points of "up" on it resist rocking 2.16 times'
    with pytest.warns(UserWarning, match=told):
        structure_model(stacked(0.0, 0))
