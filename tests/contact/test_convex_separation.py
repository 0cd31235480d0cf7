"""The axis of largest separation: closed forms, the bodies' difference, motion, exchange."""

import numpy as np
import pytest
from convex_bodies import box, frustum, prism, turned
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from fecolumn.contact.best_axis import choose_axis, largest_separation
from fecolumn.contact.convex import hull_of, hulls_of
from fecolumn.contact.separation import (
    FACE_OF_FIRST,
    FACE_OF_SECOND,
    NO_AXIS,
    TWO_EDGES,
    relate,
    relation_for,
    separation_along,
)


def separation(one, two, center, rotation, first=None):
    """Of two bodies, the first at the origin and turned by `first`."""
    hulls = hulls_of([hull_of(one), hull_of(two)])
    relation = relation_for(hulls)
    rotations = np.stack([np.eye(3) if first is None else first, rotation])
    relate(np.array([[0.0, 0, 0], center]), rotations, 0, 1, relation)
    found = largest_separation(hulls, 0, 1, relation)
    assert separation_along(hulls, 0, 1, relation, *found[1:]) == pytest.approx(found[0], abs=1e-12)
    return found


CUBE = box(1, 1, 1)


@pytest.mark.parametrize("gap", [0.2, 0.0, -0.2])
def test_closed_forms_of_cubes(gap):
    # face on face, edge on face, corner on face
    found = separation(CUBE, CUBE, [0.1, 0.2, 1 + gap], np.eye(3))
    assert found[0] == pytest.approx(gap, abs=1e-14) and found[1] == FACE_OF_FIRST
    found = separation(CUBE, CUBE, [0.1, 0.2, 0.5 + np.sqrt(0.5) + gap], turned(0, np.pi / 4, 0))
    assert found[0] == pytest.approx(gap, abs=1e-14) and found[1] == FACE_OF_FIRST
    on_corner = turned(*np.arccos(np.sqrt(1 / 3)) * np.sqrt(0.5) * np.array([1, -1, 0]))
    center = np.array([0.1, 0.05, 0.5 + np.sqrt(0.75) + gap])
    found = separation(CUBE, CUBE, center, on_corner)
    assert found[0] == pytest.approx(gap, abs=1e-14) and found[1] == FACE_OF_FIRST
    # the corner of the first against a face of the second
    found = separation(CUBE, CUBE, center * [-1, 1, 1], np.eye(3), on_corner)
    assert found[0] == pytest.approx(gap, abs=1e-14) and found[1] == FACE_OF_SECOND
    # edges crossed at an angle
    for angle in (np.pi / 2, 0.3):
        roof = turned(np.pi / 4, 0, 0)
        center = [0.02, 0.01, np.sqrt(2) + gap / 10]
        found = separation(CUBE, CUBE, center, turned(0, 0, angle) @ roof, roof)
        assert found[0] == pytest.approx(gap / 10, abs=1e-13) and found[1] == TWO_EDGES


def random_pairs(count, seed):
    """Bodies and poses, a third nearly aligned, from apart to deep in each other."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        both = []
        for _ in range(2):
            kind = rng.integers(3)
            both.append(
                box(*rng.uniform(0.2, 1.5, 3))
                if kind == 0
                else prism(rng, rng.integers(3, 9), rng.uniform(0.2, 1.0))
                if kind == 1
                else frustum(24, *rng.uniform(0.3, 1.0, 2), rng.uniform(0.2, 1.5))
            )
        first = Rotation.random(random_state=rng.integers(2**31)).as_matrix()
        other = Rotation.random(random_state=rng.integers(2**31)).as_matrix()
        if k % 3 == 0:
            other = first @ turned(*rng.normal(size=3) * 10 ** rng.uniform(-9, -1))
        way = rng.normal(size=3)
        yield *both, way / np.linalg.norm(way) * rng.uniform(0.1, 1.6), other, first


def distance_from_origin(points):
    """Least distance of the hull of points (n, 3) from the origin, which is outside: of its
    triangles, inside one or on an edge.
    """
    corners = points[ConvexHull(points).simplices]
    start, side = corners, np.roll(corners, -1, axis=1) - corners
    normal = np.cross(side[:, 0], side[:, 1])
    foot = normal * ((start[:, 0] * normal).sum(1) / (normal**2).sum(1))[:, None]
    beside = np.cross(side, foot[:, None] - start)
    inside = ((beside * normal[:, None]).sum(2) >= 0).all(1)
    along = np.clip(-(start * side).sum(2) / (side**2).sum(2), 0, 1)
    on_edges = np.linalg.norm(start + along[..., None] * side, axis=2).min()
    return min(on_edges, np.linalg.norm(foot[inside], axis=1).min(initial=np.inf))


def test_separation_is_that_of_the_difference_of_the_bodies():
    """The hull of all differences of corners has the faces that the axes stand for."""
    apart = kinds = 0
    for one, two, center, rotation, first in random_pairs(150, 1):
        found = separation(one, two, center, rotation, first)
        difference = ((center + two @ rotation.T)[:, None] - one @ first.T).reshape(-1, 3)
        planes = ConvexHull(difference).equations
        # the origin is beyond a plane by its offset
        size = np.ptp(difference, axis=0).max()
        assert found[0] == pytest.approx(planes[:, 3].max(), abs=1e-9 * size)
        kinds |= 1 << found[1]
        if found[0] > 1e-6:
            apart += 1
            distance = distance_from_origin(difference)
            assert found[0] <= distance + 1e-9 * size
            normal, offset = planes[np.argmax(planes[:, 3]), :3], planes[:, 3].max()
            if (planes[:, :3] @ (-offset * normal) + planes[:, 3]).max() < 1e-9:
                # the nearest place is inside a face
                assert found[0] == pytest.approx(distance, abs=1e-9 * size)
    assert apart > 40 and kinds == 1 << FACE_OF_FIRST | 1 << FACE_OF_SECOND | 1 << TWO_EDGES


def test_rigid_motion_and_exchange_of_the_bodies_change_nothing():
    motion = turned(0.4, -1.1, 0.7)
    for one, two, center, rotation, first in random_pairs(100, 2):
        found = separation(one, two, center, rotation, first)
        moved = separation(one, two, motion @ center, motion @ rotation, motion @ first)
        assert moved[0] == pytest.approx(found[0], abs=1e-12)
        exchanged = separation(two, one, -center, first, rotation)
        assert exchanged[0] == pytest.approx(found[0], abs=1e-12)


@pytest.mark.long
def test_the_axis_of_the_step_before_is_kept_while_it_is_as_good():
    """Equal cubes on one another: both faces that touch are as good, and neither changes."""
    hulls = hulls_of([hull_of(CUBE), hull_of(CUBE)])
    relation, rng = relation_for(hulls), np.random.default_rng(0)
    for start in (FACE_OF_FIRST, FACE_OF_SECOND):
        face = int(np.argmax(hulls.normals[:6] @ [0, 0, 1 if start == FACE_OF_FIRST else -1.0]))
        axis = (start, face, -1) if start == FACE_OF_FIRST else (start, -1, face)
        for _ in range(50):
            rotations = np.stack([turned(*rng.normal(size=3) * 1e-6) for _ in range(2)])
            centers = np.array([[0, 0, 0], [*rng.normal(size=2) * 1e-6, 1 - 1e-6]])
            relate(centers, rotations, 0, 1, relation)
            before = separation_along(hulls, 0, 1, relation, *axis)
            found = choose_axis(hulls, 0, 1, relation, 0.01, *axis, before)
            assert found[1:] == axis
            # and never two edges, which rounding would choose
            fresh = choose_axis(hulls, 0, 1, relation, 0.01, NO_AXIS, -1, -1, -np.inf)
            assert fresh[1] == FACE_OF_FIRST


def test_two_edges_give_way_to_a_face_that_is_as_good():
    """A roof that comes to lie flat touches with its face."""
    hulls = hulls_of([hull_of(CUBE), hull_of(CUBE)])
    relation, axis, before = relation_for(hulls), (NO_AXIS, -1, -1), -np.inf
    kinds = []
    for tilt in np.geomspace(0.5, 1e-7, 40):
        # over the edge of the lower one, turned about its own axis
        rotation = turned(0, 0, 0.5) @ turned(tilt, 0, 0)
        low = (box(1, 1, 1) @ rotation.T)[:, 2].min()
        relate(
            np.array([[0, 0, 0], [0.75, 0.3, 0.5 - low - 0.3 * tilt]]),
            np.stack([np.eye(3), rotation]),
            0,
            1,
            relation,
        )
        if axis[0] != NO_AXIS:
            before = separation_along(hulls, 0, 1, relation, *axis)
        axis = choose_axis(hulls, 0, 1, relation, 1.0, *axis, before)[1:]
        kinds.append(axis[0])
    assert kinds[-1] != TWO_EDGES and TWO_EDGES in kinds
