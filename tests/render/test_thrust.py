"""Forces in joints as pictures show them: resultants, thrust line, hinges, and their files."""

import shutil

import h5py
import numpy as np
import pytest
from rocking_structures import ARCH

from fecolumn.case.sections import GRAVITY
from fecolumn.cli import main
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.draw import render
from fecolumn.pictures.render.frames import Frames
from fecolumn.pictures.render.overlay import legend_force
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.pictures.render.result import read_result
from fecolumn.pictures.render.thrust import LEAST_TURN, JointForces, _inside, arrow_length

THICKNESS = ARCH["bodies"]["arch"]["thickness_m"]
OPEN = 1e-2


@pytest.fixture(scope="module")
def result(arch):
    return read_result(arch)


def _instants(result):
    """At rest, and where the joint that turns most has opened by OPEN."""
    tilts = [v for k, v in result.history.items() if k.startswith("interface/") and "/tilt" in k]
    opened = np.max(tilts, axis=0) > OPEN
    assert opened.any()
    return np.array([0.0, result.time[int(np.argmax(opened))]])


def _frames(result):
    return list(Frames(result, _instants(result), 1e-3, forces=True))


def test_thrust_line_of_an_arch_at_rest_lies_within_the_ring(result):
    thrust = _frames(result)[0].thrust
    assert len(thrust.centers) == 12
    # voussoirs of straight sides have their corners beyond the true circles, by their area
    corners = np.hypot(*result.scene.points[:, [0, 2]].T)
    radius = np.hypot(*thrust.centers[:, [0, 2]].T)
    assert np.abs(radius - 1.0).max() < THICKNESS / 2 + 1e-3
    assert corners.min() - 1e-6 < radius.min() and radius.max() < corners.max() + 1e-6
    # it runs from each joint's centre half-way to that of the next
    ends = thrust.lines[:, :, 1]
    for k, contact in enumerate(result.scene.contacts[j] for j in result.scene.shown):
        assert len(np.unique(ends[k], axis=0)) == 2, contact.joint


def test_joints_of_a_voussoir_carry_its_weight_at_rest(result):
    history, scene = read_history(result.folder / "history.h5"), result.scene
    for k, piece in enumerate(scene.bodies):
        total = np.zeros(3)
        for contact in (scene.contacts[j] for j in scene.shown):
            force = history[f"interface/{contact.joint}/resultant"][0]
            total += force * ((contact.piece == k) - 1.0 * (contact.master == k))
        area = THICKNESS * 1.0 * np.pi / 11
        weight = 2400.0 * GRAVITY * area * 0.5
        assert total == pytest.approx([0.0, 0.0, weight], abs=1e-9 * weight), piece.name


def test_four_hinges_open_on_alternate_sides_of_the_ring(result):
    rest, fallen = _frames(result)
    assert not rest.thrust.hinges.any() and rest.thrust.at_edges.sum() <= 3
    hinges = fallen.thrust.hinges
    contacts = [result.scene.contacts[k] for k in result.scene.shown]
    turned = [
        result.history[f"interface/{one.joint}/tilt"][np.searchsorted(result.time, fallen.time)]
        for one in contacts
    ]
    opened = np.array(turned) > OPEN / 10
    assert opened.sum() == 4 and hinges[opened].all()
    places = fallen.thrust.centers[opened]
    places = places[np.argsort(places[:, 0])]
    outside = np.hypot(places[:, 0], places[:, 2]) > 1.0
    assert (outside[1:] != outside[:-1]).all()


def test_joints_that_have_not_opened_are_no_hinges(result):
    """Before the arch moves the thrust comes to edges; only joints that have turned are hinges."""
    contacts = [result.scene.contacts[k] for k in result.scene.shown]
    columns = [f"interface/{one.joint}/tilt" for one in contacts]
    tilts = np.stack([result.history[one] for one in columns], axis=1)
    still = np.flatnonzero(tilts.max(axis=1) < LEAST_TURN)
    times = result.time[still[np.linspace(0, len(still) - 1, 20).astype(int)]]
    frames = list(Frames(result, times, 1e-3, forces=True))
    assert not any(frame.thrust.hinges.any() for frame in frames)
    assert frames[-1].thrust.at_edges.any()
    fallen = _frames(result)[1].thrust
    assert fallen.hinges.any() and not (fallen.hinges & fallen.at_edges).any()


def test_forces_through_a_body_meet_half_way_and_others_end_beside_its_centre():
    feet = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 2.0]])
    middle = np.array([0.0, 0.0, 1.0])
    through = _inside(middle, feet, np.array([[0, 0, 3.0], [0, 0, -2.0]]))
    assert np.allclose(through, feet.mean(axis=0))
    beam = _inside(middle, np.array([[-1.0, 0, 0], [1.0, 0, 0]]), np.array([[0, 0, 3.0]] * 2))
    assert np.allclose(beam, [[-1, 0, 1], [1, 0, 1]])
    (alone,) = _inside(middle, feet[:1], np.array([[1.0, 0, 1.0]]))
    assert np.allclose(alone, [0.5, 0, 0.5])


def test_a_rocking_body_is_hinged_at_its_edge_and_pushed_upwards_there(block):
    result = read_result(block)
    row = int(np.argmax(result.history["tilt"]))
    (frame,) = Frames(result, result.time[[row]], 1e-3, forces=True)
    assert frame.thrust.hinges.tolist() == [True] and frame.thrust.resultants[0, 2] > 0
    plan = result.scene.contacts[0].plan(result.scene.points[result.scene.contacts[0].points])
    place = result.scene.contacts[0].plan(frame.thrust.centers[0])
    assert np.abs(np.abs(place) - np.abs(plan).max(axis=0)).min() < 0.1 * np.abs(plan).max()


def test_an_elastic_gate_stands_on_hinges(gate):
    result = read_result(gate)
    thrust = Frames(result, np.array([0.0, 0.05]), 0.01, forces=True).frame(1).thrust
    weight = sum(
        thrust.resultants[k, 2]
        for k, j in enumerate(result.scene.shown)
        if result.scene.contacts[j].on_ground
    )
    assert len(thrust.centers) == 4 and weight > 0
    assert (thrust.hinges | thrust.at_edges).any()


def test_impulses_are_shared_out_over_the_interval(result):
    # the same force in the mean over one step and over many of a structure at rest
    one, many = (JointForces(result, interval) for interval in (1e-3, 4e-3))
    a, b = (forces.at(0.0, result.poses, 0) for forces in (one, many))
    assert np.allclose(a.resultants, b.resultants, rtol=0.01, atol=0.01 * one.largest)
    assert one.scale * one.largest == pytest.approx(arrow_length(result.scene))


def test_force_of_the_legend_is_a_round_one():
    assert legend_force(1e5, 6e4) == 5e4 and legend_force(2e4, 6e4) == 1e4
    assert legend_force(1e5, 900.0) == 500.0


@pytest.mark.long
def test_command_draws_forces_into_movie_stills_and_sequence(arch, tmp_path, capsys):
    folder = shutil.copytree(arch, tmp_path / "run")
    line = ["render", str(folder), "--forces", "--view", "front", "-q"]
    small = ["--size", "360x240", "--fps", "10"]
    assert main([*line, "--instants", "0,0.4", *small]) == 0
    names = {file.name for file in (folder / "render").iterdir()}
    assert names >= {"motion.mp4", "sequence.png", "sequence.pdf", "still_0.000s.png"}


@pytest.mark.long
def test_forces_are_seen(arch, tmp_path):
    from PIL import Image

    folder = shutil.copytree(arch, tmp_path / "run")
    options = dict(only="pictures", instants=(0.0,), view="front")

    def orange(forces):
        files = render(folder, RenderOptions(**options, color="none", forces=forces), quiet=True)
        (still,) = (file for file in files if file.name.startswith("still"))
        picture = np.asarray(Image.open(still).convert("RGB"), int)
        near = np.abs(picture - [0xD5, 0x5E, 0x00]).max(axis=2) < 40
        return near[: int(0.85 * len(near))].sum()

    assert orange(True) > 100 > orange(False)


def test_history_without_resultants_is_refused(arch, tmp_path):
    folder = shutil.copytree(arch, tmp_path / "run")
    with h5py.File(folder / "history.h5", "a") as file:
        gone = []
        file.visit(lambda name: gone.append(name) if name.endswith("/resultant") else None)
        for name in gone:
            del file[name]
    with pytest.raises(InputError, match=r"history\.h5: has no column .*/resultant.*--forces"):
        render(folder, RenderOptions(only="pictures", forces=True), quiet=True)
