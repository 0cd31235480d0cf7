"""A round surface below others is the circle that it is, not the polygon of its nodes."""

from dataclasses import replace

import numpy as np

from fecolumn._compiled import interpreted
from fecolumn.contact.bodies import Bodies
from fecolumn.contact.joints import joints_of
from fecolumn.contact.projection import OFF, ON, project_on_body
from fecolumn.structures.model import GROUND, Surface
from fecolumn.verification.boxes import box, joint, part

RADIUS, NODES = 0.5, 12


def drum():
    """A box whose foot and head are discs of twelve nodes around a middle."""
    angle = 2 * np.pi / NODES * np.arange(NODES)
    ring = np.concatenate([np.zeros((1, 2)), RADIUS * np.column_stack([np.cos(angle), np.sin(angle)])])
    arms = np.concatenate([np.column_stack([ring, np.full(NODES + 1, z)]) for z in (-0.5, 0.5)])
    around = np.array([(0, 1 + i, 1 + (i + 1) % NODES) for i in range(NODES)])
    model, areas, outlines = box(1.0, 1.0, 1.0), np.ones(NODES + 1), np.arange(NODES + 1) > 0
    down = np.diag([1.0, -1.0, -1.0])
    surfaces = {"foot": Surface(np.arange(NODES + 1), np.array([0.0, 0, -0.5]), down, areas, outlines, around[:, ::-1]),
                "head": Surface(NODES + 1 + np.arange(NODES + 1), np.array([0.0, 0, 0.5]), np.eye(3), areas, outlines, around)}
    return replace(model, arms=arms, shapes=np.zeros((len(arms), 3, 0)), flexibility=np.zeros((len(arms), len(arms), 3, 3)), surfaces=surfaces)


def test_a_rim_that_rolls_on_a_drum_stands_on_its_circle_between_the_nodes():
    model = drum()
    parts = [part("low", model, (0, 0, 0.5)), part("up", model, (0, 0, 1.5))]
    made = joints_of(parts, [replace(joint(0, GROUND, model), round=True), replace(joint(1, 0, model), round=True)])
    assert made.interfaces["rim_count"].tolist() == [NODES, NODES]
    bodies = Bodies(np.zeros(2), model.arms, np.zeros((0, 0)), np.zeros((0, 0)), made.facets)
    between = np.pi / NODES * np.array([1, 3, 9])
    for place, answer in ((RADIUS, ON), (1.01 * RADIUS, OFF)):
        for angle in between:
            point = made.points[made.points["interface"] == 1][0]
            assert interpreted(project_on_body)(bodies, made.interfaces[1], point, place * np.cos(angle), place * np.sin(angle)) == answer
