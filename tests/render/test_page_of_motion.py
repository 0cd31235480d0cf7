"""The page of a motion: one file for any browser, whose bodies are where the history has them."""

import base64
import json
import re
import shutil
import sys

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fecolumn.case.sections import GRAVITY
from fecolumn.cli import main
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.draw import render
from fecolumn.pictures.render.page.arrows import arrows_of
from fecolumn.pictures.render.page.document import times_of
from fecolumn.pictures.render.page.flexure import flexure_of
from fecolumn.pictures.render.page.ground import ground_of
from fecolumn.pictures.render.page.parts import MOST_TRIANGLES, parts_of
from fecolumn.pictures.render.page.rods import rods_of_links, rods_of_storeys
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.pictures.render.result import read_result
from fecolumn.pictures.render.strips import rows_between

PAGE = RenderOptions(html=True)
INSTALLED = "k3d is not installed: pip install 'k3d>=2.18,<3'"


def told_by(file) -> dict:
    """What the program of a page is told."""
    text = file.read_text()
    begin = text.index("{", text.index("showMotion(K3DInstance, "))
    return json.JSONDecoder().raw_decode(text[begin:])[0]


def numbers(text: str, *shape: int) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), "<f4").reshape(-1, *shape)


def top_of_part(part: dict, top: np.ndarray) -> np.ndarray:
    """Where a point of a part is at each instant, from where it is at rest."""
    turn = Rotation.from_quat(numbers(part["turn"], 4))
    return numbers(part["place"], 3) + turn.apply(top - part["rest"])


@pytest.mark.parametrize("name", ["drum", "gate", "building"])
def test_page_is_one_small_file_that_asks_for_no_other(name, request):
    pytest.importorskip("k3d", reason=INSTALLED)
    folder = request.getfixturevalue(name)
    (file,) = render(folder, PAGE, quiet=True)
    text = file.read_text()
    assert file == folder / "render" / "motion.html" and 1e5 < file.stat().st_size < 3e6
    asked = re.findall(
        r"<(?:script|link|img|iframe)[^>]*(?:src|href)\s*=\s*[\"']?([^\s>\"']+)", text
    )
    assert not [one for one in asked if not one.startswith("data:")]
    assert text.startswith("<!doctype html>") and 'name="viewport"' in text[:400]


def test_page_of_a_column_has_its_top_where_the_history_has_it(drum):
    pytest.importorskip("k3d", reason=INSTALLED)
    (file,) = render(drum, PAGE, quiet=True)
    told, result = told_by(file), read_result(drum)
    # fifty instants a second of 0.24 s, the first and the last
    assert told["count"] == 13 and told["step"] == pytest.approx(0.02)
    times = told["start"] + told["step"] * np.arange(told["count"])
    (part,) = told["parts"]
    top = result.scene_history.top
    way = [np.interp(times, result.time, one) for one in result.u_top.T]
    # to single precision, and by how much the drum deforms
    assert top_of_part(part, top) - top == pytest.approx(np.transpose(way), abs=2e-5)
    assert np.abs(way[0]).max() > 0.01
    assert told["groundMoves"] is False and not told["rods"]
    assert [strip["title"] for strip in told["strips"]] == ["top", "tilt", "uplift", "energy"]


def test_page_of_a_part_of_the_motion_in_slow_motion(drum):
    pytest.importorskip("k3d", reason=INSTALLED)
    (file,) = render(drum, RenderOptions(html=True, start=0.05, end=0.15, speed=0.1, view="front"))
    told = told_by(file)
    assert told["count"] == 51 and told["step"] == pytest.approx(0.002)
    assert told["start"] == pytest.approx(0.05) and told["speed"] == 0.1
    assert told["toward"][1] < -0.9


def test_page_of_a_structure_has_bodies_links_and_forces_of_its_history(gate):
    result = read_result(gate)
    times = times_of(result, (0.0, 0.1), 1.0)
    parts = parts_of(result, times)
    rows = np.searchsorted(result.time, times - 1e-9)
    assert [part.name for part in parts] == ["column 1", "column 2", "lintel"]
    assert len(times) == 6
    for part in parts:
        surface = part.points + part.rest
        middle = surface[surface[:, 2] > surface[:, 2].max() - 1e-9]
        low, high = middle.min(axis=0), middle.max(axis=0)
        turn, top = Rotation.from_quat(part.turn), (low + high) / 2
        moved = part.place + turn.apply(top - part.rest) - top
        known = result.history[f"mark/{part.name}.top/displacement"][rows]
        assert moved == pytest.approx(known, abs=1e-5) and np.abs(moved).max() > 1e-3
    (tendon,) = rods_of_links(result, parts, times)
    assert tendon.tension == pytest.approx(result.history["link/tendon/tension"][rows])
    ends = [
        parts[part].place + Rotation.from_quat(parts[part].turn).apply(arm)
        for part, arm in zip(tendon.parts, tendon.arms)
    ]
    long = np.linalg.norm(ends[1] - ends[0], axis=1)
    # stiffness times elongation
    assert np.diff(tendon.tension) == pytest.approx(1e5 * np.diff(long), abs=2.0)


def test_arrows_at_the_feet_of_an_arch_at_rest_carry_its_weight(arch, monkeypatch):
    # before the push is felt
    monkeypatch.setattr("fecolumn.pictures.render.page.arrows._MEAN_S", 0.0)
    result = read_result(arch)
    arrows = arrows_of(result, np.array([0.0]))
    joints = [result.scene.contacts[k] for k in result.scene.shown]
    feet = [k for k, joint in enumerate(joints) if joint.interface == "feet"]
    # a half ring of mean radius 1 m, 0.15 m thick and 0.5 m wide
    weight = GRAVITY * 2400.0 * np.pi * 0.15 * 0.5
    assert len(feet) == 2
    assert arrows.forces[feet, 0, 2].sum() == pytest.approx(weight, rel=2e-3)
    # they push towards each other, and point upwards
    assert arrows.forces[feet, 0, 0].sum() == pytest.approx(0.0, abs=0.01 * weight)
    assert np.abs(arrows.forces[feet, 0, 0]).min() > 0.1 * weight
    assert (arrows.forces[:, 0, 2] >= 0).all()


def test_floors_of_a_building_are_parts_with_columns_between(building):
    result = read_result(building)
    parts = parts_of(result, np.array([0.0, 0.06]))
    assert [part.body for part in parts] == [0, 0, 0]
    sway = [part.place[1, 0] - part.place[0, 0] for part in parts]
    row = np.searchsorted(result.time, 0.06 - 1e-9)
    floors = result.scene_history.floors[0][row, :, 0] - result.scene_history.floors[0][0, :, 0]
    assert np.subtract(sway, sway[0]) == pytest.approx(floors - floors[0], abs=1e-9)
    assert abs(sway[2] - sway[0]) > 1e-4
    columns = rods_of_storeys(result, parts)
    assert [rod.parts for rod in columns] == [(0, 1)] * 4 + [(1, 2)] * 4


def test_ground_that_comes_to_rest_is_told_from_one_that_runs_away():
    time = np.linspace(0.0, 2.0, 2001)
    # one wave of 1 - cos has ended where it began to move
    swing = np.zeros((2001, 3))
    swing[:, 0] = np.sin(np.pi * time)
    path = ground_of({"time": time, "ground": swing}, np.array([0.0, 1.0, 2.0]))
    # integrated twice: t/pi - sin(pi t)/pi^2
    assert path.place[:, 0] == pytest.approx([0.0, 1 / np.pi, 2 / np.pi], abs=1e-6)
    assert path.rests and path.largest == pytest.approx(2 / np.pi, abs=1e-6)
    swing[:, 0] = 1.0
    assert not ground_of({"time": time, "ground": swing}, time).rests


def test_surfaces_too_fine_for_a_page_are_made_coarser(drum, monkeypatch):
    result, times = read_result(drum), np.array([0.0, 0.1])
    (fine,) = parts_of(result, times)
    monkeypatch.setattr("fecolumn.pictures.render.page.parts.MOST_TRIANGLES", 200)
    (coarse,) = parts_of(result, times)
    assert len(fine.triangles) < MOST_TRIANGLES
    assert len(coarse.triangles) <= 220 < len(fine.triangles)
    assert np.ptp(coarse.points, axis=0) == pytest.approx(np.ptp(fine.points, axis=0), rel=0.05)


@pytest.mark.parametrize("most", [300, 3000])
def test_points_of_strips_hold_the_peaks_of_each_line(most):
    time = np.linspace(0, 90, 90_001)
    ground = np.random.default_rng(1).normal(size=(len(time), 2))
    lean = np.abs(np.sin(time))
    rows = rows_between(time, [lean, *ground.T], np.array([0.0, 90.0]), most)
    assert most / 2 < len(rows) <= most and (np.diff(rows) > 0).all()
    for line in (lean, *ground.T):
        assert (line[rows].max(), line[rows].min()) == (line.max(), line.min())


@pytest.mark.parametrize(
    "options, told",
    [
        (["--gif"], "--gif: is not for --html"),
        (["--only", "movie"], "--only: is not for --html"),
        (["--paraview"], "--paraview: is not for --html"),
        (["--colour", "stress"], "--colour: is not for --html"),
        (["--exaggerate", "20"], "--exaggerate: is not for --html"),
        (["--instants", "0.1"], "--instants: is not for --html"),
        (["--size", "640x360"], "--size: is not for --html"),
        (["--start", "0.2", "--end", "0.1"], "--end = 0.1: must be later than the begin, 0.2 s"),
        (["--speed", "0"], "--speed = 0.0: must lie between 0.001 and 100"),
    ],
)
def test_what_a_page_does_not_do_is_one_line(block, capsys, options, told):
    assert main(["render", str(block), "--html", *options]) == 2
    error = capsys.readouterr().err
    assert told in error and error.count("\n") == 1


def test_without_k3d_it_is_told_how_to_install_it(block, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "k3d", None)
    assert main(["render", str(block), "--html"]) == 2
    error = capsys.readouterr().err
    assert "--html: needs k3d: pip install 'k3d>=2.18,<3'" in error and error.count("\n") == 1


def test_folders_without_a_motion_and_files_of_others_are_refused(gate, block, tmp_path):
    pytest.importorskip("k3d", reason=INSTALLED)
    with pytest.raises(InputError, match="no such folder"):
        render(tmp_path / "none", PAGE)
    with pytest.raises(InputError, match="not a result folder"):
        render(tmp_path, PAGE)
    own = shutil.copytree(block, tmp_path / "run", ignore=shutil.ignore_patterns("render"))
    (own / "render").mkdir()
    (own / "render" / "motion.html").write_text("mine")
    with pytest.raises(InputError, match="motion.html"):
        render(own, PAGE)
    assert (own / "render" / "motion.html").read_text() == "mine"


def test_bodies_bend_on_the_page_as_their_states_do(gate):
    """Lengths between points of a body, which rigid motion leaves, change by as much: to 3 % of the
    largest deformation, of which the shapes leave 1 % in the mean square.
    """
    result = read_result(gate)
    times = times_of(result, (result.time[0], result.time[-1]), 1.0)
    parts = parts_of(result, times)
    found = flexure_of(result, parts, times)
    assert found.largest > 0 and len(found.times) > 3
    for part, one in zip(parts, found.deformations):
        own = result.scene.own(part.body)
        upright = result.scene.points[own]
        rows = [
            int(np.abs(upright - part.rest - point).sum(axis=1).argmin()) for point in part.points
        ]
        ends = np.array([rows[0], rows[-1], rows[len(rows) // 2]])
        bent = part.points + np.einsum("tr,rna->tna", one.shares, one.shapes)
        for k, time in enumerate(found.times):
            fields = result.frames.read(int(result.frames.nearest(np.array([time]))[0]))
            true = (upright + fields.displacement[own])[ends]
            drawn = bent[k][[0, -1, len(rows) // 2]]
            for a, b in ((0, 1), (1, 2)):
                assert np.linalg.norm(drawn[a] - drawn[b]) == pytest.approx(
                    np.linalg.norm(true[a] - true[b]), abs=0.03 * found.largest
                )


def test_faces_on_the_page_have_the_pressure_of_the_states(gate):
    """A colour is 1/254 of three decades: pressure is known to half of that, 1.4 %."""
    result = read_result(gate)
    times = times_of(result, (result.time[0], result.time[-1]), 1.0)
    found = flexure_of(result, parts_of(result, times), times)
    least, most = found.pressures
    assert 0 < least < most and len(found.faces) == len(result.scene.contacts)
    for k, time in enumerate(found.times):
        fields = result.frames.read(int(result.frames.nearest(np.array([time]))[0]))
        for face, contact in zip(found.faces, result.scene.contacts):
            true = fields.pressure[contact.faces].mean(axis=1)
            assert ((face.levels[k] > 0) == (true > 0)).all()
            shown = least * 10 ** (3 * (face.levels[k].astype(float) - 1) / 254)
            inside = (true > least) & (true < most)
            assert shown[inside] == pytest.approx(true[inside], rel=0.014)


def test_a_page_of_the_history_alone_tells_that_bodies_are_rigid(gate, tmp_path):
    pytest.importorskip("k3d", reason=INSTALLED)
    shutil.copytree(gate, tmp_path / "run")
    (tmp_path / "run" / "states.h5").unlink()
    (file,) = render(tmp_path / "run", PAGE, quiet=True)
    told = told_by(file)["flexure"]
    assert told["parts"] == told["faces"] == []
