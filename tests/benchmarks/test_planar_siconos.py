"""Siconos as a peer of the planar program: corners and faces of its relations, closed forms."""

import dataclasses
import sys

import numpy as np
import pytest

from benchmarks.peers.peer import Missing
from benchmarks.planar import __main__ as command
from benchmarks.planar import compare, ensembles, peer, structures, theory
from benchmarks.planar.advance import advance
from benchmarks.planar.bodies import GRAVITY, Structure

WIDTH, HEIGHT = structures.BLOCK


@pytest.fixture(scope="module")
def siconos():
    try:
        return peer.version()
    except Missing as error:
        pytest.skip(f"Siconos: {error}")


def on_a_fixed_block(d):
    """The upper one of two equal blocks, displaced by d [m], on a lower one that is held."""
    whole = structures.two_blocks(d)
    held = dataclasses.replace(whole.bodies[1], fixed=True)
    return Structure((whole.bodies[0], held, whole.bodies[2]), whole.joints[1:])


@pytest.mark.parametrize("d", [0.0, 1e-6, -1e-6, 1e-2])
def test_displaced_block_swings_and_loses_as_its_closed_form(siconos, d):
    """Let go from 0.05 rad: quarter period, rate before and after the impact, first order in dt."""
    structure, block = on_a_fixed_block(d), theory.displaced_block(WIDTH, HEIGHT, abs(d))
    side, dt = (0 if d >= 0 else 1), 2e-4
    corner = (WIDTH / 2 + min(d, 0.0), HEIGHT)
    place = structure.turned(structure.place, 2, corner, -0.05)
    found = peer.moved(structure, np.zeros(751), dt, place=place)
    tilt, rate = found.tilt[:, 2], -found.velocity[:, 2, 2]
    after = int(np.argmax(tilt < 0))
    landing = np.interp(0.0, -tilt[after - 1 : after + 1], found.time[after - 1 : after + 1])
    assert landing == pytest.approx(block.quarter_period(0.05, side), abs=dt / 10)
    before = block.rate(tilt[after - 5], side, rate[after - 5])
    assert before == pytest.approx(block.rate(0.05, side), rel=2e-4)
    kept = block.rate(-tilt[after + 5], 1 - side, rate[after + 5]) / before
    assert kept == pytest.approx(block.kept[side], abs=4e-3)
    mechanical = found.energy[:, :2].sum(axis=1)
    assert np.abs(mechanical[: after - 1] - mechanical[0]).max() < 5e-4 * np.ptp(mechanical)


def test_two_blocks_lose_energy_only_and_tend_to_the_planar_program(siconos):
    """Both may rock; a tenth of the step brings the two programs nearer, at least threefold."""
    structure = structures.two_blocks(1e-2)
    place = structure.turned(structure.place, 2, (WIDTH / 2, HEIGHT), -0.05)
    apart = []
    for dt in (1e-3, 1e-4):
        still = np.zeros(round(0.5 / dt) + 1)
        found = peer.moved(structure, still, dt, place=place)
        apart.append(np.abs(found.tilt - advance(structure, still, dt, place=place).tilt).max())
        mechanical = found.energy[:, :2].sum(axis=1)
        assert np.diff(mechanical).max() < dt * np.ptp(mechanical)
    assert apart[1] < apart[0] / 3 and apart[1] < 1e-3


def test_ground_shakes_it(siconos):
    """mu 0.2, the ground at 0.5 g for 0.3 s: slips at 0.3 g, then stops within 0.45 s."""
    structure, dt = structures.stack([(2.0, 0.2)], friction=0.2), 1e-3
    ground = np.where(np.arange(1001) < 300, 0.5 * GRAVITY, 0.0)
    ground[300] = 0.25 * GRAVITY
    way = peer.moved(structure, ground, dt).place[:, 1, 0]
    speed = 0.3 * GRAVITY * 0.3
    assert way[300] == pytest.approx(-speed * 0.15, rel=5e-3)
    assert way[-1] == pytest.approx(-speed * 0.15 - speed**2 / (0.4 * GRAVITY), rel=5e-3)


def test_response_is_kept_and_compared(siconos, tmp_path, monkeypatch):
    first, judge = (
        ensembles.response("trilith", program, 1, 1e-3, tmp_path, until=4.0)
        for program in (ensembles.SICONOS, ensembles.PLANAR)
    )
    assert first.tilt.shape == judge.tilt.shape and first.time[-1] == pytest.approx(4.0)
    assert compare.compared([judge], [first]).n == 1
    monkeypatch.setattr(peer, "moved", None)
    again = ensembles.response("trilith", ensembles.SICONOS, 1, 1e-3, tmp_path, until=4.0)
    assert np.array_equal(first.top, again.top) and first.unsolved == again.unsolved


def test_missing_siconos_is_said_and_left_out(monkeypatch, capsys):
    def missing():
        raise Missing("cannot run: No module named siconos")

    monkeypatch.setattr(peer, "version", missing)
    assert command.there([ensembles.PACKAGE, ensembles.SICONOS]) == [ensembles.PACKAGE]
    assert "Siconos is left out: cannot run" in capsys.readouterr().err


def test_error_of_siconos_is_told(monkeypatch, tmp_path):
    script = tmp_path / "siconos.py"
    script.write_text("raise SystemExit('no such law')")
    monkeypatch.setattr(peer, "_SCRIPT", script)
    monkeypatch.setattr(peer, "SYSTEM_PYTHON", sys.executable)
    with pytest.raises(RuntimeError, match="Siconos ended with code 1.*no such law"):
        peer.moved(structures.two_blocks(), np.zeros(3), 1e-3)
