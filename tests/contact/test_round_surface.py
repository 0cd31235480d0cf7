"""A round surface below others is the circle that it is, not the polygon of its nodes."""

from dataclasses import replace

import numpy as np

from fecolumn.contact.bodies import Bodies
from fecolumn.contact.interface import INTERFACE
from fecolumn.contact.joints import facets_of, is_convex, joints_of
from fecolumn.contact.points import GROUND, POINT
from fecolumn.contact.projection import OFF, ON, UNKNOWN, project_on_body
from fecolumn.foundation._compiled import interpreted
from fecolumn.structures.model import Surface
from fecolumn.verification.boxes import box_model, joint, part

RADIUS, NODES = 0.5, 12


def drum():
    """A box whose foot and head are discs of twelve nodes around a middle."""
    angle = 2 * np.pi / NODES * np.arange(NODES)
    ring = np.concatenate(
        [np.zeros((1, 2)), RADIUS * np.column_stack([np.cos(angle), np.sin(angle)])]
    )
    arms = np.concatenate([np.column_stack([ring, np.full(NODES + 1, z)]) for z in (-0.5, 0.5)])
    around = np.array([(0, 1 + i, 1 + (i + 1) % NODES) for i in range(NODES)])
    model, areas, outlines = box_model(1.0, 1.0, 1.0), np.ones(NODES + 1), np.arange(NODES + 1) > 0
    down = np.diag([1.0, -1.0, -1.0])
    surfaces = {
        "foot": Surface(
            np.arange(NODES + 1), np.array([0.0, 0, -0.5]), down, areas, outlines, around[:, ::-1]
        ),
        "head": Surface(
            NODES + 1 + np.arange(NODES + 1),
            np.array([0.0, 0, 0.5]),
            np.eye(3),
            areas,
            outlines,
            around,
        ),
    }
    return replace(
        model,
        arms=arms,
        shapes=np.zeros((len(arms), 3, 0)),
        flexibility=np.zeros((len(arms), len(arms), 3, 3)),
        surfaces=surfaces,
    )


def test_a_rim_that_rolls_on_a_drum_stands_on_its_circle_between_the_nodes():
    model = drum()
    parts = [part("low", model, (0, 0, 0.5)), part("up", model, (0, 0, 1.5))]
    made = joints_of(
        parts,
        [replace(joint(0, GROUND, model), round=True), replace(joint(1, 0, model), round=True)],
    )
    assert made.interfaces["rim_count"].tolist() == [NODES, NODES]
    bodies = Bodies(np.zeros(2), model.arms, np.zeros((0, 0)), np.zeros((0, 0)), made.facets)
    between = np.pi / NODES * np.array([1, 3, 9])
    for place, answer in ((RADIUS, ON), (1.01 * RADIUS, OFF)):
        for angle in between:
            point = made.points[made.points["interface"] == 1][0]
            assert (
                interpreted(project_on_body)(
                    bodies, made.interfaces[1], point, place * np.cos(angle), place * np.sin(angle)
                )
                == answer
            )


def grid_of(present, goes_on=False, known=True):
    """Facets of unit squares, each two triangles, where `present` (n, m) is true; goes_on: no node
    is on an outline; known: False: of the nodes inside, too.
    """
    n, m = np.array(present).shape
    number = np.arange((n + 1) * (m + 1)).reshape(n + 1, m + 1)
    corners = np.array([(i, j, 0.0) for i in range(n + 1) for j in range(m + 1)])
    triangles = [
        three
        for i, j in zip(*np.nonzero(present))
        for three in (
            (number[i, j], number[i + 1, j], number[i + 1, j + 1]),
            (number[i, j], number[i + 1, j + 1], number[i, j + 1]),
        )
    ]
    outlines = np.full(len(corners), not goes_on)
    if not known:
        outlines &= np.isin(corners[:, 0], (0, n)) | np.isin(corners[:, 1], (0, m))
    return facets_of(
        Surface(
            np.arange(len(corners)),
            np.zeros(3),
            np.eye(3),
            np.ones(len(corners)),
            outlines,
            np.array(triangles),
        ),
        corners,
        0,
    )


def test_surfaces_without_corners_holes_and_parts_left_out_are_convex():
    model = drum()
    arms, head = model.arms, model.surfaces["head"]
    assert is_convex(facets_of(head, arms, 0)) and is_convex(grid_of([[1, 1], [1, 1]]))
    assert not is_convex(grid_of([[1, 1], [1, 0]]))
    assert not is_convex(grid_of([[1, 1, 1], [1, 0, 1], [1, 1, 1]]))
    assert not is_convex(grid_of([[1, 1], [1, 1]], goes_on=True))
    assert is_convex(grid_of([[1, 1, 1], [1, 0, 1], [1, 1, 1]], known=False))
    assert not is_convex(grid_of([[1, 1, 1], [1, 0, 0], [1, 1, 1]], known=False))


def test_points_over_missing_nodes_of_a_surface_are_unknown_and_those_beyond_its_outline_off_it():
    facets, rng = grid_of([[1, 1, 1], [1, 0, 1], [1, 1, 1]], known=False), np.random.default_rng(7)
    interface = np.zeros(1, INTERFACE)
    interface["facet_count"], interface["width"], interface["convex"] = len(facets), 1.0, True
    bodies, point = (
        Bodies(np.zeros(1), np.zeros((16, 3)), np.zeros((0, 0)), np.zeros((0, 0)), facets),
        np.zeros(1, POINT)[0],
    )
    for x, y in rng.uniform(-1, 4, (300, 2)):
        answer = UNKNOWN if 1 < x < 2 and 1 < y < 2 else ON if 0 < x < 3 and 0 < y < 3 else OFF
        assert interpreted(project_on_body)(bodies, interface[0], point, x, y) == answer


def test_points_around_a_convex_surface_are_on_or_off_it_as_when_all_its_facets_are_looked_at():
    facets, rng = grid_of([[1, 1], [1, 1]]), np.random.default_rng(7)
    interface = np.zeros(1, INTERFACE)
    interface["facet_count"], interface["width"] = len(facets), 1.0
    bodies, point, kept = (
        Bodies(np.zeros(1), np.zeros((9, 3)), np.zeros((0, 0)), np.zeros((0, 0)), facets),
        np.zeros(1, POINT)[0],
        [],
    )
    for x, y in rng.uniform(-1, 3, (200, 2)):
        answers = []
        for convex in (True, False):
            interface["convex"] = convex
            answers.append(
                (
                    interpreted(project_on_body)(bodies, interface[0], point, x, y),
                    point["below"].tolist(),
                    point["shares"].tolist(),
                )
            )
        kept.append(answers[0][0])
        assert answers[0][0] == answers[1][0]
        if answers[0][0] == ON:
            places = facets["corners"].reshape(-1, 2)[
                [facets["nodes"].ravel().tolist().index(node) for node in answers[0][1][:3]]
            ]
            np.testing.assert_allclose(np.array(answers[0][2][:3]) @ places, (x, y), atol=1e-12)
    assert {ON, OFF} == set(kept)
