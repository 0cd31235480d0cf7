"""Structures of many copies: what touches, what leans, and how many points there is room for."""

import itertools
import warnings
from pathlib import Path

import pytest
from small_structures import structure

from fecolumn.case.case import load_case
from fecolumn.engines import reduced_engine
from fecolumn.foundation.schema import InputError
from fecolumn.simulation import run
from fecolumn.structures import barrier, meetings
from fecolumn.structures.barrier import least_barrier
from fecolumn.structures.bodies import drawing
from fecolumn.structures.standing import from_below, remembered, supports_of, touching
from fecolumn.structures.structure import standing_of, structure_model

MESHES = Path(__file__).parents[2] / "meshes"


def wall(courses=4, bricks=5, **joints):
    """Bricks in running bond, rigid, a corner each."""
    copies = [
        [0.5 * number + 0.25 * (course % 2), 0.0, 0.2 * course]
        for course in range(courses)
        for number in range(bricks - course % 2)
    ]
    brick = dict(
        kind="block", length_m=0.485, width_m=0.25, height_m=0.2, density_kg_m3=2000.0, rigid=True
    )
    return structure(
        bodies=dict(brick=brick | dict(element_size_m=0.25, copies_m=copies)),
        joints=dict(
            foot=dict(between=["brick", "ground"]), courses=dict(between=["brick", "brick"])
        )
        | joints,
        contact=dict(friction_coefficient=0.6, interior_points=0),
        integration=dict(engine="rigid", duration_s=0.01),
    )


@pytest.mark.parametrize("file", ["wall_with_opening", "trilith", "greek_column", "arch"])
def test_only_near_pairs_need_be_looked_at(file, monkeypatch):
    """What touches is the same where each copy is looked at with each."""
    case = load_case(MESHES / f"{file}.toml")
    faces = {name: drawing(case, name, "").faces for name in case.bodies}
    found = meetings.meetings_of(case, faces, file)
    monkeypatch.setattr(
        meetings,
        "_pairs",
        lambda case, slaves, masters, faces, only_near: itertools.product(slaves, masters),
    )
    assert meetings.meetings_of(case, faces, file) == found


def test_a_wall_of_bricks_has_the_joints_of_its_bond():
    model = structure_model(wall(), "wall")
    pairs = {frozenset((one.slave, one.master)) for one in model.joints if one.master >= 0}
    # two below each of the 4 + 5 + 4 bricks of the upper courses, but one below the ends of the 5
    assert len(pairs) == 2 * 4 + 2 * 3 + 2 + 2 * 4
    assert sum(one.master < 0 for one in model.joints) == 5


def test_parts_come_after_what_they_stand_on():
    case = wall()
    model = structure_model(case, "wall")
    supports = supports_of(standing_of(case, model), list(model.joints))
    order = from_below(supports)
    assert sorted(order) == list(range(len(supports)))
    for place, below in enumerate(supports):
        assert all(one < 0 or order.index(one) < order.index(place) for one, _ in below)


@pytest.mark.parametrize("file", ["rocking_frame", "colonnade_that_collapses", "trilith"])
def test_what_stands_on_a_body_that_leans_is_all_that_moves(file, monkeypatch):
    """The least barrier is that of placing all bodies anew with each that leans."""
    case = load_case(MESHES / f"{file}.toml").replace({"integration.engine": "rigid"})
    model = structure_model(case, file)
    found = least_barrier(model, standing_of(case, model))
    monkeypatch.setattr(barrier, "_with_what_stands_on", lambda places, supports: None)
    assert found == pytest.approx(least_barrier(model, standing_of(case, model)), rel=1e-12)
    monkeypatch.setattr(barrier, "_with_what_stands_on", lambda places, supports: set(places))
    alone = least_barrier(model, standing_of(case, model))
    assert alone < 0.9 * found


def test_nothing_of_a_structure_is_kept_for_others():
    case = wall()
    model = structure_model(case, "wall")
    standing = standing_of(case, model)
    least_barrier(model, standing)
    first = touching(standing, model.joints[-1])
    assert first is not touching(standing, model.joints[-1])
    with remembered():
        assert touching(standing, model.joints[-1]) is touching(standing, model.joints[-1])


def test_many_points_of_rigid_bricks_are_told_of():
    case = wall()
    brick = {"bodies.brick.element_size_m": 0.02, "contact.interior_points": 64}
    with pytest.warns(UserWarning, match=r"[\d,]+ contact points of rigid bodies, \d+ in joint"):
        structure_model(case.replace(brick), "wall")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        structure_model(case, "wall")


def test_more_points_than_the_machine_has_room_for_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(reduced_engine.os, "sysconf", lambda name: 1024)
    with pytest.raises(InputError, match=r"joints: [\d,]+ contact points in all: what these give"):
        run(wall(), tmp_path / "out", quiet=True)
