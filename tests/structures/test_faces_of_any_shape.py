"""Joints of faces that are not convex: a body lifts about the hull of the region where both faces
overlap, however their outlines cross.
"""

import meshio
import numpy as np
import pytest
from scipy.spatial import ConvexHull

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model
from fecolumn.verification.joint_bodies import lifts, met

# Half height of the body above, height of the one below [m]
HALF, BELOW = 0.6, 0.1
# Shapes in plan as rectangles (low x, low y, high x, high y) [m] that meet along whole sides
PLUS = [
    (-0.3, -0.1, -0.1, 0.1),
    (-0.1, -0.3, 0.1, -0.1),
    (-0.1, -0.1, 0.1, 0.1),
    (-0.1, 0.1, 0.1, 0.3),
    (0.1, -0.1, 0.3, 0.1),
]
ELL = [(-0.2, -0.2, 0.0, 0.0), (-0.2, 0.0, 0.0, 0.2), (0.0, -0.2, 0.2, 0.0)]
SQUARE = [(-0.25, -0.25, 0.25, 0.25)]
# one face in two pieces, and what joins them below
PIECES = [(-0.3, -0.2, -0.15, 0.2), (0.15, -0.2, 0.3, 0.2)]
JOINED = [*PIECES, (-0.15, -0.2, 0.15, 0.2)]
STEP = [
    (-0.3, -0.15, 0.0, -0.05),
    (-0.3, -0.05, 0.0, 0.05),
    (-0.3, 0.05, 0.0, 0.15),
    (0.0, -0.05, 0.3, 0.05),
]


def body(folder, name, shape, height, density):
    """A rigid body with this plan in its upper half."""
    lower = JOINED if shape is PIECES else shape
    levels = [(0.0, height / 2, lower), (height / 2, height, shape)]
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    points = [
        (box[2 * a], box[1 + 2 * b], z)
        for low, high, plan in levels
        for box in plan
        for z in (low, high)
        for a, b in corners
    ]
    places, cells = np.unique(np.array(points), axis=0, return_inverse=True)
    meshio.Mesh(places, [("hexahedron", cells.reshape(-1, 8))]).write(folder / f"{name}.vtk")
    return dict(
        kind="mesh",
        mesh_file=str(folder / f"{name}.vtk"),
        density_kg_m3=density,
        youngs_modulus_pa=5e12,
        poissons_ratio=0.2,
    )


def engines(folder, low, up, **keys):
    """Function that makes a rigid engine of one body on a heavy one, and the middle of the upper
    one in plan [m].
    """
    case = case_from_tables(
        dict(
            bodies=dict(
                low=body(folder, "low", low, BELOW, 1e5),
                up=body(folder, "up", up, 2 * HALF, 100.0) | keys,
            ),
            contact=dict(friction_coefficient=0.8, interior_points=0),
            joints=dict(feet=dict(between=["low", "ground"]), joint=dict(between=["low", "up"])),
            integration=dict(engine="rigid", dt_s=5e-4, duration_s=5.0),
        ),
        "a test",
    )
    model = structure_model(case)
    return lambda: engine_of(case, model, "a test")


def turned(points, angle):
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def hull(low, up, angle, place, middle):
    """Corners (n, 2) [m] from the upper body's middle of the hull of the region of both faces: of
    each two of their rectangles (Sutherland and Hodgman 1974).
    """
    found = []
    for box in up:
        for other in low:
            part = turned(np.array(box)[[[0, 1], [2, 1], [2, 3], [0, 3]]], angle) + place
            below = np.array(other)[[[0, 1], [2, 1], [2, 3], [0, 3]]]
            for start, way in zip(below, np.roll(below, -1, axis=0) - below):
                left = way[0] * (part[:, 1] - start[1]) - way[1] * (part[:, 0] - start[0])
                kept = []
                for k in range(len(part)):
                    if left[k - 1] * left[k] < 0:
                        share = left[k - 1] / (left[k - 1] - left[k])
                        kept.append(part[k - 1] + (part[k] - part[k - 1]) * share)
                    if left[k] >= 0:
                        kept.append(part[k])
                part = np.array(kept).reshape(-1, 2)
            found.extend(part)
    found = np.round(np.array(found), 12)
    return found[ConvexHull(found).vertices] - middle


@pytest.mark.long
@pytest.mark.parametrize(
    "low, up, angle, place",
    [
        pytest.param(PLUS, PLUS, 45.0, (0.0, 0.0), id="plus on plus, askew"),
        pytest.param(PLUS, PLUS, 0.0, (0.0, 0.0), id="plus on plus"),
        pytest.param(PLUS, PLUS, 10.0, (0.02, 0.01), id="plus on plus, displaced"),
        pytest.param(SQUARE, ELL, 0.0, (0.11, 0.07), id="ell on a square, displaced"),
        pytest.param(SQUARE, ELL, 30.0, (0.1, -0.12), id="ell on a square, askew"),
        pytest.param(PIECES, SQUARE, 40.0, (0.03, 0.0), id="square on two pieces"),
        pytest.param(STEP, PLUS, 0.0, (0.0, 0.0), id="plus on a step"),
    ],
)
def test_a_body_lifts_about_the_hull_of_the_region(tmp_path, low, up, angle, place):
    make = engines(tmp_path, low, up, turned_deg=angle, at_m=[*place, BELOW])
    middle = make().motion.frames["center"][1][:2]
    corners, errors = hull(low, up, angle, np.array(place), middle), []
    for k in range(16):
        # of each sixteenth the direction farthest from a corner
        ways = [
            np.array([np.cos(a), np.sin(a)])
            for a in (k + np.array([0.1, 0.3, 0.5, 0.7])) * np.pi / 8
        ]
        towards = max(ways, key=lambda one: met(corners, one)[3])
        push = GRAVITY * met(corners, towards)[0] / HALF
        errors.append(lifts(make, push, towards) / push - 1)
    assert np.abs(errors).max() < 1e-4


@pytest.mark.long
@pytest.mark.parametrize("angle", [0.0, 20.0, 32.0, 58.0, 90.0])
def test_a_drum_over_the_corner_of_a_block_lifts_about_its_edges(angle):
    """The corner lies 0.07 m to both sides of the drum's middle, within its circle of 0.15 m."""
    stone = dict(youngs_modulus_pa=5e12, poissons_ratio=0.2)
    case = case_from_tables(
        dict(
            bodies=dict(
                low=dict(kind="block", length_m=0.4, width_m=0.4, height_m=BELOW)
                | dict(density_kg_m3=1e5)
                | stone,
                up=dict(kind="cylinder", outer_diameter_m=0.3, height_m=2 * HALF)
                | dict(density_kg_m3=100.0, at_m=[0.13, 0.13, BELOW])
                | stone,
            ),
            contact=dict(friction_coefficient=0.8, interior_points=0),
            joints=dict(feet=dict(between=["low", "ground"]), joint=dict(between=["low", "up"])),
            integration=dict(engine="rigid", dt_s=5e-4, duration_s=5.0),
        ),
        "a test",
    )
    model = structure_model(case)
    towards = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    push = GRAVITY * 0.07 / towards.max() / HALF
    assert abs(lifts(lambda: engine_of(case, model, "drum"), push, towards) / push - 1) < 1e-4
