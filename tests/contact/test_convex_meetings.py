"""Places of contact that is found, and how they are known again from step to step."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from convex_bodies import box, frustum, on_bodies, row_of, step, turned, used_rows, world
from scipy.spatial.transform import Rotation

from fecolumn.contact.best_axis import largest_separation
from fecolumn.contact.meetings import GROUND_NORMAL, keep_rows, meetings_for
from fecolumn.contact.separation import (
    FACE_OF_FIRST,
    FACE_OF_SECOND,
    TWO_EDGES,
    relate,
    relation_for,
)
from fecolumn.contact.tolerances import OTHER_AXIS

CUBE = box(1, 1, 1)
FLAT = np.tile(np.eye(3), (2, 1, 1))


def in_order(places):
    """Rows (n, 3) in an order that does not depend on rounding."""
    return places[np.lexsort(places.round(6).T)]


@pytest.mark.long
@pytest.mark.parametrize("gap", [5e-3, 0.0, -5e-3])
def test_places_of_crossed_squares_are_the_corners_of_their_overlap(gap):
    w, rotations = world(CUBE, CUBE), FLAT.copy()
    rotations[1] = turned(0, 0, np.pi / 4)
    centers = np.array([[0, 0, 0], [0, 0, 1 + gap]])
    assert step(w, centers, rotations)
    row, places = row_of(w, 0, 1)
    assert row.kind == FACE_OF_FIRST and row.separation == pytest.approx(gap, abs=1e-14)
    own, other = on_bodies(row, places, centers, rotations)
    near = np.sqrt(0.5) - 0.5
    signs = [[-1, -1], [-1, 1], [1, -1], [1, 1]]
    corners = np.multiply(signs * 2, np.repeat([[0.5, near], [near, 0.5]], 4, axis=0))
    assert in_order(own) == pytest.approx(in_order(np.insert(corners, 2, 0.5 + gap, 1)), abs=1e-12)
    assert in_order(other) == pytest.approx(in_order(np.insert(corners, 2, 0.5, 1)), abs=1e-12)
    assert places["gap"] == pytest.approx(gap, abs=1e-14)


def test_equal_faces_have_the_corners_of_the_slave_and_overhang_those_of_both():
    w, centers = world(CUBE, CUBE), np.array([[0, 0, 0], [0, 0, 1.0]])
    step(w, centers, FLAT)
    row, places = row_of(w, 0, 1)
    assert {int(name) >> 48 for name in places["name"]} == {2} and len(places) == 4
    step(w, centers + [[0, 0, 0], [0.3, 0, 0]], FLAT)
    row, places = row_of(w, 0, 1)
    own = in_order(on_bodies(row, places, centers + [[0, 0, 0], [0.3, 0, 0]], FLAT)[0])
    assert own == pytest.approx(
        in_order(np.array([[x, y, 0.5] for x in (-0.2, 0.5) for y in (-0.5, 0.5)])), abs=1e-12
    )


def test_two_crossed_edges_touch_in_one_place():
    w = world(CUBE, CUBE)
    rotations = np.stack([turned(np.pi / 4, 0, 0), turned(0, np.pi / 4, 0)])
    centers = np.array([[0, 0, 0], [0.1, 0.05, np.sqrt(2) + 1e-3]])
    step(w, centers, rotations)
    row, places = row_of(w, 0, 1)
    own, other = on_bodies(row, places, centers, rotations)
    assert row.kind == TWO_EDGES and len(places) == 1 and row.master == 0
    # the lower roof runs along x through y = 0, the upper one along y through x = 0.1
    assert other[0] == pytest.approx([0.1, 0.0, np.sqrt(0.5)], abs=1e-12)
    assert own[0] - other[0] == pytest.approx([0, 0, 1e-3], abs=1e-12)
    assert row.frame[:, 2] == pytest.approx([0, 0, 1], abs=1e-12)
    assert rotations[0] @ row.axes == pytest.approx(row.frame, abs=1e-12)
    # beside each other, beyond the ends of the edges, none
    step(w, centers + [[0, 0, 0], [0.55, 0, 0]], rotations)
    assert row_of(w, 0, 1) is None or len(row_of(w, 0, 1)[1]) == 0


def touching_pairs(count):
    """Worlds of two bodies that touch or nearly do, in any pose: the upper one is lowered on the
    other along z.
    """
    rng = np.random.default_rng(5)
    shapes = [CUBE, box(0.3, 1, 2), frustum(24, 0.5, 0.4, 0.8), frustum(5, 0.6, 0.3, 0.5)]
    for k in range(count):
        one, two = shapes[rng.integers(4)], shapes[rng.integers(4)]
        rotations = Rotation.random(2, random_state=k).as_matrix()
        if k % 2:
            rotations[0], rotations[1] = np.eye(3), turned(*rng.normal(size=3) * [0.02, 0.02, 1])
        low, high, w = 0.0, 4.0, world(one, two)
        shift = rng.uniform(-0.2, 0.2, 2)
        for _ in range(40):
            middle = (low + high) / 2
            step(w, np.array([[0, 0, 0], [*shift, middle]]), rotations, 0.5)
            found = row_of(w, 0, 1)
            apart = found is None or found[0].separation > -1e-4
            low, high = (low, middle) if apart else (middle, high)
        yield one, two, np.array([[0, 0, 0], [*shift, high]]), rotations


def test_each_place_is_on_both_bodies_as_far_apart_as_its_gap_along_the_normal():
    kinds = set()
    for one, two, centers, rotations in touching_pairs(40):
        w = world(one, two)
        step(w, centers, rotations)
        row, places = row_of(w, 0, 1)
        kinds.add(int(row.kind))
        own, other = on_bodies(row, places, centers, rotations)
        assert len(places) > 0
        assert own - other == pytest.approx(places["gap"][:, None] * row.frame[:, 2], abs=1e-12)
        # the deepest place is as deep as the bodies are in each other, but where the axis is a
        # face's that is hardly worse than two edges
        assert places["gap"].min() == pytest.approx(row.separation, abs=2e-4)
        for body, at in ((row.slave, own), (row.master, other)):
            local, first = (at - centers[body]) @ rotations[body], w.hulls.first
            faces = slice(first[body, 1], first[body + 1, 1])
            over = local @ w.hulls.normals[faces].T - w.hulls.offsets[faces]
            assert np.abs(over.max(axis=1)).max() < 1e-3
        # the normal is out of the master
        assert (centers[row.slave] - centers[row.master]) @ row.frame[:, 2] > 0
    assert kinds == {FACE_OF_FIRST, FACE_OF_SECOND, TWO_EDGES}


def test_rigid_motion_moves_the_places_and_exchange_of_the_bodies_leaves_them():
    motion = turned(0.3, 0.9, -0.5)
    for one, two, centers, rotations in touching_pairs(30):
        found = []
        for bodies, at, turn in (
            ((one, two), centers, rotations),
            ((one, two), centers @ motion.T, motion @ rotations),
            ((two, one), centers[::-1], rotations[::-1]),
        ):
            w = world(*bodies, slots=32)
            at, turn = np.ascontiguousarray(at), np.ascontiguousarray(turn)
            step(w, at, turn)
            row, places = row_of(w, 0, 1)
            found.append((row, (sum(on_bodies(row, places, at, turn)) / 2), places["gap"]))
        (row, here, gaps), (_, moved, _), (other, there, _) = found
        assert in_order(moved @ motion) == pytest.approx(in_order(here), abs=1e-9)
        if (row.kind == TWO_EDGES) == (other.kind == TWO_EDGES) and row.kind != other.kind:
            # the same faces
            assert in_order(there) == pytest.approx(in_order(here), abs=1e-9)


def test_places_keep_their_slots_and_move_as_little_as_the_bodies():
    """A cube that rocks, twists and slides on another one; nothing jumps."""
    w, before, was = world(CUBE, CUBE), None, None
    for t in np.linspace(0, 1, 400):
        tilt = 0.02 * np.sin(6 * t)
        rotations = np.stack([np.eye(3), turned(0, 0, 0.3 * t) @ turned(0, tilt, 0)])
        # pivots on the lower edge of its face
        lift = 0.5 * (np.cos(tilt) + np.sin(abs(tilt)))
        centers = np.array([[0, 0, 0], [0.1 * t, 0.05, 0.5 + lift]])
        step(w, centers, rotations, 0.1)
        row, places = row_of(w, 0, 1)
        assert row.kind == FACE_OF_FIRST and row.master == 0 and not row.exchanged
        slots = w.meetings.places[used_rows(w)[0]].copy()
        if before is not None:
            used = (slots["name"] != 0) & (before["name"] != 0)
            same = used & (slots["name"] == before["name"])
            assert same.sum() >= used.sum() - 2
            assert not slots["fresh"][used].any()
            way = np.abs(slots["arm"] - before["arm"])[used].max(initial=0.0)
            assert way < 6e-3, (t, way)
            # every place is found again, or is at an edge that another one has left
            assert abs(len(places) - was) <= 2
        before, was = slots, len(places)
    assert was >= 4


def test_a_place_keeps_its_name_and_slot_where_the_other_body_becomes_the_master():
    w = world(box(0.5, 0.5, 0.5), box(2, 2, 0.5))
    masters, names, slots = [], [], []
    for tilt in (1e-6, 1e-3, 0.05, 0.2):
        # the upper one leans on the upper right edge of the lower one
        edge, rotation = np.array([0.25, 0, 0.25]), turned(0, tilt, 0)
        centers = np.array([[0, 0, 0], edge + rotation @ [0, 0, 0.25]])
        step(w, centers, np.stack([np.eye(3), rotation]))
        row, places = row_of(w, 0, 1)
        masters.append(int(row.master))
        lowest = np.argsort(places["gap"])[:2]
        assert places["gap"][lowest] == pytest.approx(0, abs=1e-12)
        names.append(sorted(places["name"][lowest]))
        all_slots = w.meetings.places[used_rows(w)[0]]["name"]
        slots.append([int(np.flatnonzero(all_slots == name)[0]) for name in names[-1]])
    assert masters[0] == 0 and masters[-1] == 1
    assert all(one == names[0] for one in names) and all(one == slots[0] for one in slots)


def test_the_axis_stays_as_good_as_the_best_while_bodies_move_slowly():
    """It is looked at again once they have moved by less than makes it worse by OTHER_AXIS."""
    w, kept = world(box(0.5, 0.5, 0.5), box(2, 2, 0.5)), 0
    relation = relation_for(w.hulls)
    for k, tilt in enumerate(np.linspace(0, 0.02, 2000)):
        rotation = turned(0, tilt, 0)
        centers = np.array([[0, 0, 0], np.array([0.25, 0, 0.25]) + rotation @ [0, 0, 0.25]])
        rotations = np.stack([np.eye(3), rotation])
        step(w, centers, rotations)
        relate(centers, rotations, 0, 1, relation)
        best = largest_separation(w.hulls, 0, 1, relation)[0]
        row = row_of(w, 0, 1)[0]
        assert best - 1.6 * OTHER_AXIS * 0.5 <= row.separation <= best + 1e-12
        kept += k > 0 and not row.exchanged
    assert kept >= 1990


def test_roles_and_frames_say_how_to_turn_forces():
    w = world(box(0.5, 0.5, 0.5), box(2, 2, 0.5))
    frames = []
    for tilt in (1e-6, 0.2):
        rotation = turned(0, tilt, 0)
        centers = np.array([[0, 0, 0], np.array([0.25, 0, 0.25]) + rotation @ [0, 0, 0.25]])
        step(w, centers, np.stack([np.eye(3), rotation]))
        row, _ = row_of(w, 0, 1)
        frames.append(row.frame.copy())
    assert row.exchanged and row.master_before == 0 and row.master == 1 and row.slave == 0
    assert (row.frame_before == frames[0]).all()
    # normals out of the master: the small body is below now
    assert frames[0][2, 2] == pytest.approx(1, abs=1e-9)
    assert frames[1][2, 2] == pytest.approx(-np.cos(0.2), abs=1e-9)


@pytest.mark.parametrize("tilt, count", [((0, 0, 0), 4), ((0.1, 0, 0), 2), ((0.1, 0.1, 0), 1)])
def test_a_body_over_the_ground_touches_with_its_lowest_corners(tilt, count):
    w, rotation = world(CUBE, ground=-0.2), turned(*tilt)
    low = (CUBE @ rotation.T)[:, 2].min()
    centers = np.array([[0.3, 0.1, -0.2 - low + 1e-3]])
    step(w, centers, rotation[None])
    row, places = row_of(w, -1, 0)
    assert len(places) == count and row.kind == GROUND_NORMAL
    assert (row.master, row.slave) == (-1, 0)
    own, seats = on_bodies(row, places, centers, rotation[None])
    assert places["gap"] == pytest.approx(1e-3, abs=1e-13)
    assert own - seats == pytest.approx(np.tile([0, 0, -0.2 + 1e-3], (count, 1)), abs=1e-12)


def test_of_many_corners_the_lowest_is_kept_and_the_others_span():
    drum = frustum(24, 0.5, 0.5, 1.0)
    for k in range(24):
        way = np.array([np.sin(2 * np.pi * k / 24), -np.cos(2 * np.pi * k / 24), 0])
        rotation = turned(*(-1e-3 * way))
        low = (drum @ rotation.T)[:, 2].min()
        w, few = world(drum, ground=0.0, slots=64), world(drum, ground=0.0)
        centers = np.array([[0, 0, -low - 1e-6]])
        for one in (w, few):
            step(one, centers, rotation[None])
        every, chosen = row_of(w, -1, 0)[1], row_of(few, -1, 0)[1]
        assert len(every) == 24 and len(chosen) == 8
        assert chosen["gap"].min() == every["gap"].min()
        plane = chosen["arm"][:, :2]
        gaps = np.diff(np.sort(np.arctan2(plane[:, 1], plane[:, 0])))
        assert gaps.max() <= 2 * np.pi * 4 / 24 + 1e-9
    # and stays so
    names = {int(name) for name in chosen["name"]}
    for seed in range(20):
        shake = turned(*np.random.default_rng(seed).normal(size=3) * 1e-9)
        assert not step(few, centers, (shake @ rotation)[None])
    assert names == {int(name) for name in row_of(few, -1, 0)[1]["name"]}


def test_rows_stay_while_their_pairs_are_near():
    meetings, rng = meetings_for(6), np.random.default_rng(2)
    every = [(a, b) for a in range(-2, 6) for b in range(6) if a < b and b >= 0]
    rows = {}
    for _ in range(200):
        pairs = np.array([every[k] for k in rng.permutation(len(every))[: rng.integers(0, 7)]])
        assert keep_rows(meetings, pairs.reshape(-1, 2).astype(np.int64)) == 0
        now = {
            tuple(int(n) for n in row.pair): r
            for r, row in enumerate(meetings.rows)
            if row.pair[1] >= 0
        }
        assert set(now) == {(int(a), int(b)) for a, b in pairs}
        assert all(now[pair] == row for pair, row in rows.items() if pair in now)
        rows = now
    pairs = np.array(every[:8])
    assert keep_rows(meetings, pairs) == 2


def history():
    """What a falling, sliding, tilting set of bodies finds in thirty steps."""
    w = world(CUBE, frustum(24, 0.4, 0.3, 0.5), box(0.3, 0.3, 2), ground=-0.5)
    rng, found = np.random.default_rng(1), []
    centers = np.array([[0, 0, 0], [0.1, 0, 0.75], [0.66, 0, 0.5]])
    vectors = np.zeros((3, 3))
    for _ in range(30):
        rotations = Rotation.from_rotvec(vectors).as_matrix()
        step(w, centers, rotations, 0.05)
        for r in used_rows(w):
            row, places = w.meetings.rows[r], w.meetings.places[r]
            found += [[*map(float, (*row.pair, row.kind, row.separation))]]
            for place in places[places["name"] != 0]:
                found += [[float(place["name"]), float(place["gap"]), *place["arm"].tolist()]]
        centers = centers + rng.normal(size=(3, 3)) * 3e-3
        vectors = vectors + rng.normal(size=(3, 3)) * 1e-2
    return found


def test_compiled_code_finds_what_plain_python_finds():
    here = Path(__file__).parent
    program = "import json, test_convex_meetings as t; print(json.dumps(t.history()))"
    plain = subprocess.run(
        [sys.executable, "-c", program],
        cwd=here,
        env=os.environ
        | {
            "NUMBA_DISABLE_JIT": "1",
            "PYTHONPATH": os.pathsep.join([str(here.parents[1]), os.environ.get("PYTHONPATH", "")]),
        },
        capture_output=True,
        text=True,
        check=True,
    )
    compiled, plain = history(), json.loads(plain.stdout)
    assert len(compiled) == len(plain) > 200
    for one, other in zip(compiled, plain):
        assert one == pytest.approx(other, abs=1e-12)


def test_edges_of_a_bar_that_turns_about_its_length_take_turns():
    """All four long edges of a bar have one perpendicular with an edge of another bar: the one that
    is nearest is that of the contact, also where the bar turns past a face within a step.
    """
    bar, rotations = box(2.0, 0.1, 0.1), np.zeros((2, 3, 3))
    w, rotations[0] = world(bar, bar), turned(np.pi / 4, 0, 0)
    centers, names = np.array([[0, 0, 0], [0, 0, np.sqrt(0.5) * 0.1 + 0.053]]), set()
    for roll in np.arange(-0.75, 0.8, 0.1):
        rotations[1] = turned(0, 0, np.pi / 3) @ turned(roll, 0, 0)
        step(w, centers, rotations, 0.1)
        row, places = row_of(w, 0, 1)
        assert row.kind == TWO_EDGES and len(places) == 1
        assert places["gap"][0] == pytest.approx(row.separation, abs=OTHER_AXIS * 0.1)
        names.add(tuple(row.feature))
    assert len(names) == 2
