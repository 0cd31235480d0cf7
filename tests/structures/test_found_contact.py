"""Contact that is found while bodies move: falls, collisions, slides and rolls beside closed forms,
beside joints, and interrupted.
"""

import h5py
import numpy as np
import pytest
from small_collapses import box, falling, rod, unclosed, watched
from small_structures import structure

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.fallen_bodies import FallenBodies
from fecolumn.engines.reduced import structure as engine_structure
from fecolumn.simulation import run
from fecolumn.structures.structure import structure_model

FOOT = dict(foot=dict(between=["block", "ground"]))
TIPS = dict(block=dict(spin_rad_s=[0.0, 2.5, 0.0]))
DOMINO = box(0.1, 0.5, 1.0, copies_m=[[0.45 * k, 0, 0] for k in range(4)])
DOMINOES = dict(
    joints=dict(foot=dict(between=["domino", "ground"])),
    initial={"domino 1": dict(spin_rad_s=[0.0, 1.2, 0.0])},
)


def states(engine):
    """Centres of mass (nb, 3) [m], velocities (nb, 3) [m/s], spins (nb, 3) [rad/s] in the table
    frame.
    """
    frames = engine.motion.frames
    return (
        frames["center"].copy(),
        frames["velocity"].copy(),
        np.einsum("bij,bj->bi", engine.motion.rotation, frames["spin"]),
    )


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
def test_a_block_overturns_and_lies_on_its_side(engine):
    """Its centre of mass comes to lie half its length above the ground, and stays there."""
    elastic = {} if engine == "rigid" else dict(youngs_modulus_pa=3e10, element_size_m=0.2, modes=4)
    case = falling(
        dict(block=box(0.3, 0.4, 1.0) | elastic),
        FOOT,
        initial=TIPS,
        integration=dict(engine=engine),
    )
    _, rows = watched(case, 2.0)
    # four corners of coarse elements carry its weight
    settles = 1e-8 if engine == "rigid" else 5e-6
    assert rows["body/block/tilt"][-1] == pytest.approx(np.pi / 2, abs=10 * settles)
    assert rows["body/block/displacement"][-1, 2] == pytest.approx(0.15 - 0.5, abs=settles)
    assert rows["energy/kinetic"][-1] < 1e-9 * rows["energy/kinetic"].max()
    assert unclosed(rows) < 1e-12


def test_dominoes_fall_one_after_another():
    case = falling(dict(domino=DOMINO), **DOMINOES, friction=0.4)
    engine, rows = watched(case, 2.5)
    fell = FallenBodies(engine.model).fallen(rows)
    assert list(fell) == [f"domino {k}" for k in range(1, 5)]
    assert np.diff(list(fell.values())).min() > 0.05
    assert rows["energy/kinetic"][-1] < 1e-6 * rows["energy/kinetic"].max()
    assert unclosed(rows) < 1e-12


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_an_edge_that_falls_on_an_edge_across_it(restitution):
    """A square bar falls by 0.1 m with its lower edge on the upper one of a fixed bar across it,
    beside its middle: the place where they meet then has -e times its velocity along the normal,
    and does not slide.
    """
    bar = rod(4, 0.2, 1.0)
    aside, drop = 0.13, 0.1
    case = falling(
        dict(
            sill=bar | dict(at_m=[0, 0, 0.3], fixed=True),
            bar=bar | dict(at_m=[aside, 0.0, 0.7 + drop], turned_deg=90),
        ),
        friction=5.0,
        contact=dict(restitution=restitution),
        integration=dict(dt_s=1e-4),
    )
    struck = np.sqrt(2 * drop / GRAVITY)
    engine, rows = watched(case, struck + 2e-3)
    _, velocity, spin = states(engine)
    body = engine.structure.bodies.body[1]
    before, arm = np.array([0, 0, -GRAVITY * struck]), np.array([-aside, 0.0, -0.2])
    inertia = (
        engine.motion.rotation[1]
        @ engine.model.parts[1].model.inertia
        @ (engine.motion.rotation[1].T)
    )
    lever = np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
    gives = np.eye(3) / body["mass"] - lever @ np.linalg.solve(inertia, lever)
    impulse = np.linalg.solve(gives, -(1 + restitution) * before)
    assert velocity[1] == pytest.approx(before + impulse / body["mass"], abs=0.03)
    assert spin[1] == pytest.approx(np.linalg.solve(inertia, lever @ impulse), abs=0.15)
    assert unclosed(rows) < 1e-12


@pytest.mark.parametrize("apart, aside", [(0.501, 0.0), (0.501, 0.1), (0.5, 0.0)])
def test_bodies_that_collide_in_flight_keep_their_momentum(apart, aside):
    """A block runs into one of a third of its mass: they go on together, where one is not beside
    the other; what both have of momentum and of its moment stays in any case.
    """
    case = falling(
        dict(
            runner=box(0.6, 0.4, 0.5, at_m=[0.0, 0.0, 5.0]),
            stands=box(0.2, 0.4, 0.5, at_m=[apart, aside, 5.0]),
        ),
        initial=dict(runner=dict(velocity_m_s=[2.0, 0.0, 0.0])),
    )
    engine, rows = watched(case, 0.4)
    centers, velocity, spin = states(engine)
    mass = engine.structure.bodies.body["mass"][:, None]
    fallen = np.array([0.0, 0.0, -GRAVITY * 0.4])
    assert (mass * velocity).sum(axis=0) == pytest.approx(
        mass[0] * [2, 0, 0] + mass.sum() * fallen, abs=1e-9 * mass.sum()
    )
    turns = [part.model.inertia for part in engine.model.parts]
    moment = sum(
        R @ own @ R.T @ w + m * np.cross(x, v)
        for R, own, w, m, x, v in zip(engine.motion.rotation, turns, spin, mass, centers, velocity)
    )
    middle = (mass * centers).sum(axis=0) / mass.sum()
    moment -= np.cross(middle, (mass * velocity).sum(axis=0))
    gap, reduced = np.array([apart, aside, 0.0]), mass.prod() / mass.sum()
    assert moment == pytest.approx(reduced * np.cross(gap, [-2.0, 0.0, 0.0]), abs=1e-7 * mass.sum())
    if not aside:
        # points of rigid bodies give a little: 2e-3 of the approach at most is left
        assert velocity[:, 0] == pytest.approx([1.5, 1.5], abs=4e-3)
        assert np.abs(spin).max() < 1e-6
    assert unclosed(rows) < 1e-12


def test_a_cube_slides_off_a_table_and_falls_to_the_ground():
    """At the table's edge it has lost mu g d of its speed squared over two; it ends on the ground
    on one of its faces.
    """
    side, friction, speed = 0.2, 0.3, 3.0
    case = falling(
        dict(
            table=box(2.0, 1.0, 0.5, fixed=True),
            cube=box(side, side, side, at_m=[0.0, 0.0, 0.5]),
        ),
        initial=dict(cube=dict(velocity_m_s=[speed, 0.0, 0.0])),
        friction=friction,
    )
    engine, rows = watched(case, 2.5)
    way = rows["body/cube/displacement"]
    edge = int(np.searchsorted(way[:, 0], 0.9))
    there = np.interp(0.9, way[:, 0], rows["time"])
    # of the way back from the speed: constant deceleration
    assert there == pytest.approx(
        (speed - np.sqrt(speed**2 - 2 * friction * GRAVITY * 0.9)) / (friction * GRAVITY), rel=2e-3
    )
    assert np.abs(way[:edge, 2]).max() < 1e-7 and np.abs(way[:, 1]).max() < 1e-6
    assert way[-1, 2] == pytest.approx(-0.5, abs=1e-6)
    assert rows["energy/kinetic"][-1] < 1e-9 * rows["energy/kinetic"].max()
    assert unclosed(rows) < 1e-12


def test_a_stone_that_is_thrown_flies_its_parabola():
    case = falling(
        dict(stone=box(0.2, 0.2, 0.2, at_m=[0, 0, 1.0])),
        initial=dict(stone=dict(velocity_m_s=[1.0, -2.0, 3.0])),
    )
    _, rows = watched(case, 0.6)
    t = rows["time"]
    flown = np.column_stack([t, -2.0 * t, 3.0 * t - GRAVITY * t**2 / 2])
    assert np.abs(rows["body/stone/displacement"] - flown).max() < 1e-9


def test_found_contact_of_a_rocking_block_is_that_of_its_joint():
    """Until the third impact, with the corners of the foot as the joint's points."""
    block, seconds = box(0.3, 0.4, 1.0), 1.6
    tables = dict(
        bodies=dict(block=block),
        joints=FOOT,
        initial=dict(block=dict(tilt_rad=0.15)),
        contact=dict(interior_points=0, friction_coefficient=0.5),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=1.0),
    )
    _, alone = watched(structure(**tables), seconds)
    tables["contact"] = tables["contact"] | dict(between="all")
    _, found = watched(structure(**tables), seconds)
    moved, peak = alone["body/block/displacement"], 0.15
    struck = np.flatnonzero(np.diff(np.sign(alone["body/block/rotation"][:, 1])))
    assert len(struck) >= 2
    last = struck[2] if len(struck) > 2 else len(moved)
    off = np.abs(found["body/block/rotation"] - alone["body/block/rotation"])[:last].max()
    assert off < 1e-6 * peak


def test_a_rod_of_many_sides_rolls_as_a_rimless_wheel():
    """At each edge it keeps (I + m r^2 cos(2 pi / n)) / (I + m r^2) of its spin, [McGeer 1990]."""
    sides, radius, spin = 12, 0.4, 4.0
    half = np.pi / sides
    # about the edge over which it tips first
    velocity = [spin * radius * np.cos(half), 0.0, spin * radius * np.sin(half)]
    case = falling(
        dict(rod=rod(sides, radius, 1.0, -np.pi / 2 - half, at_m=[0, 0, radius * np.cos(half)])),
        initial=dict(rod=dict(spin_rad_s=[0.0, spin, 0.0], velocity_m_s=velocity)),
        friction=1.0,
        integration=dict(dt_s=2e-4),
    )
    engine, rows = watched(case, 1.0)
    mass = engine.structure.bodies.body["mass"][0]
    own = engine.model.parts[0].model.inertia[1, 1]
    about = own + mass * radius**2
    kept = (own + mass * radius**2 * np.cos(2 * half)) / about
    turned = rows["body/rod/rotation"][:, 1]
    kinetic = rows["energy/kinetic"]
    for k in range(1, 4):
        # midway between two impacts it stands on an edge
        rise = mass * GRAVITY * radius * (1 - np.cos(half))
        when = int(np.argmax(turned > (2 * k + 1) * half))
        expected = about * spin**2 / 2 * kept ** (2 * k) - rise
        assert kinetic[when] == pytest.approx(expected, rel=5e-3)
    assert unclosed(rows) < 1e-12


def _history(folder):
    found = {}
    with h5py.File(folder / "history.h5") as file:
        file.visititems(
            lambda name, item: found.update({name: item[()]}) if hasattr(item, "shape") else None
        )
    return found


def test_an_interrupted_fall_goes_on_to_the_last_digit(tmp_path):
    case = falling(
        dict(domino=DOMINO),
        **DOMINOES,
        friction=0.4,
        integration=dict(duration_s=1.2, dt_s=2e-3),
        output=dict(states_every_s=0.04),
    )
    run(case, tmp_path / "whole", quiet=True)
    whole = _history(tmp_path / "whole")
    for asked in (5, 17, 24):
        times = iter([False] * asked + [True])
        with pytest.raises(KeyboardInterrupt):
            run(case, tmp_path / str(asked), quiet=True, stop=times.__next__)
        run(case, tmp_path / str(asked), quiet=True)
        again = _history(tmp_path / str(asked))
        assert all(np.array_equal(values, again[name]) for name, values in whole.items()), asked


def test_room_for_pairs_is_made_when_it_is_wanted(tmp_path, monkeypatch):
    """The history is the same, also of an analysis that is interrupted after more was made."""
    case = falling(
        dict(domino=DOMINO),
        **DOMINOES,
        friction=0.4,
        integration=dict(duration_s=1.2, dt_s=2e-3),
        output=dict(states_every_s=0.04),
    )
    run(case, tmp_path / "whole", quiet=True)
    whole = _history(tmp_path / "whole")
    monkeypatch.setattr(engine_structure, "FOUND_ROWS", 1)
    times = iter([False] * 20 + [True])
    with pytest.raises(KeyboardInterrupt):
        run(case, tmp_path / "small", quiet=True, stop=times.__next__)
    run(case, tmp_path / "small", quiet=True)
    small = _history(tmp_path / "small")
    for name, values in whole.items():
        assert values.shape == small[name].shape, name
    for name in ("body/domino 4/tilt", "body/domino 1/displacement", "energy/kinetic"):
        assert np.abs(small[name] - whole[name]).max() < 1e-6 * np.abs(whole[name]).max(), name


def test_a_fall_is_told_and_ends_at_rest(tmp_path):
    """Of a motion of no acceleration after which all is awaited to lie still."""
    (tmp_path / "none.csv").write_text("time [s],ax [m/s2]\n0,0\n0.05,0\n0.1,0\n")
    case = falling(
        dict(domino=DOMINO | dict(copies_m=[[0, 0, 0], [0.45, 0, 0], [3.0, 0, 0]])),
        **DOMINOES,
        friction=0.4,
        integration=dict(duration_s=0.0),
        motion=dict(source=str(tmp_path / "none.csv"), free_vibration_s="rest"),
    )
    summary = run(case, tmp_path / "out", quiet=True)
    assert summary["overturned"] and summary["outcome"] == "overturned"
    assert '2 of 3 bodies fell: "domino 1", "domino 2", from' in summary["ended_by"]
    assert "at rest" in summary["ended_by"]
    rows = _history(tmp_path / "out")
    first = rows["time"][np.flatnonzero(rows["body/domino 1/tilt"] > np.pi / 4)[0]]
    assert 0 < summary["overturn_time_s"] < first + 0.3
    assert rows["time"][-1] < 20.0
    assert rows["energy/kinetic"][-1] <= FallenBodies(structure_model(case)).still_j


def test_what_stays_standing_is_not_told_as_fallen(tmp_path):
    case = falling(dict(block=box(0.3, 0.4, 1.0)), FOOT, integration=dict(duration_s=0.1))
    summary = run(case, tmp_path, quiet=True)
    assert not summary["overturned"] and summary["overturn_time_s"] is None


@pytest.mark.parametrize("friction, follows", [(0.5, True), (0.1, False)])
def test_a_block_on_a_fixed_body_that_moves_with_its_own_ground(friction, follows):
    """A fixed table is pushed along x with 2 m/s2: the block on it goes along, or slides behind
    with mu g.
    """
    case = falling(
        dict(
            table=box(3.0, 1.0, 0.5, fixed=True, moves_with="quay"),
            block=box(0.4, 0.4, 0.3, at_m=[0, 0, 0.5]),
            other=box(0.4, 0.4, 0.3, at_m=[0, 3, 0]),
        ),
        dict(foot=dict(between=["other", "ground"])),
        friction=friction,
        grounds=dict(ground={}, quay=dict(level_m=-1.0)),
    )
    grounds = np.zeros((400, 6))
    grounds[:, 3] = 2.0
    engine, rows = watched(case, 0.4, grounds)
    pushed = min(2.0, friction * GRAVITY)
    moved = pushed * rows["time"] ** 2 / 2
    assert rows["body/block/displacement"][:, 0] == pytest.approx(moved, abs=3e-3 * moved[-1])
    assert np.abs(rows["body/block/displacement"][:, 2]).max() < 1e-8
    assert np.abs(rows["body/other/displacement"]).max() < 1e-8
    assert unclosed(rows) < 1e-12
