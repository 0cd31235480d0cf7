"""The contact solver beside Siconos: with it, without it, and on problems of the running engine."""

import json
import os
import subprocess

import numpy as np
import pytest

from benchmarks.friction import __main__ as friction
from benchmarks.friction.assemblies import drum, stack
from benchmarks.friction.figure import profile
from benchmarks.friction.problem import violation
from benchmarks.friction.recorded import recorded
from benchmarks.peers.install import SYSTEM_PYTHON
from fecolumn.verification import boxes


@pytest.mark.slow
def test_without_siconos_two_small_problems_are_compared_and_it_is_said_how_to_install_it(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr(friction, "SYSTEM_PYTHON", "/bin/false")
    monkeypatch.setattr(
        friction, "problems", lambda: [stack(1).problem("shake", 0.3), drum(8).problem("rest", 0.0)]
    )
    monkeypatch.setattr(friction, "structures", lambda: ())
    assert friction.main(["-o", str(tmp_path), "--every"]) == 0
    records = json.loads((tmp_path / "friction.json").read_text())
    assert [list(record["solvers"]) for record in records] == [["fecolumn"]] * 2
    assert max(record["solvers"]["fecolumn"]["violation"] for record in records) < friction.SOLVED
    printed = capsys.readouterr()
    row = next(line for line in printed.out.splitlines() if "stack of 1, shake" in line)
    assert [cell.strip() for cell in row.split("|")[-4:-1]] == ["-"] * 3
    assert "2 of 2" in printed.out
    assert (
        "Siconos ended with code 1" in printed.err and "benchmarks.peers --install" in printed.err
    )
    assert (tmp_path / "friction.png").stat().st_size > 10_000 and (
        tmp_path / "friction.pdf"
    ).exists()


@pytest.fixture(scope="module")
def beside_siconos(tmp_path_factory):
    """Problems at rest, the forces of both and Siconos' error of ours."""
    environment = {
        key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "VIRTUAL_ENV")
    }
    try:
        there = (
            subprocess.run(
                [SYSTEM_PYTHON, "-I", "-c", "import siconos.numerics"],
                env=environment,
                capture_output=True,
                timeout=60,
            ).returncode
            == 0
        )
    except OSError:
        there = False
    if not there:
        pytest.skip(friction.MISSING)
    given = [stack(2).problem("rest", 0.6), drum(8).problem("shake", 0.2)]
    own = [friction.ours(problem)["forces"] for problem in given]
    found, remark = friction.siconos(given, tmp_path_factory.mktemp("siconos"), own)
    assert not remark
    return given, own, found


@pytest.mark.parametrize("solver", ["nsgs", "newton", "admm"])
def test_both_agree_on_the_resultant_of_the_normal_forces(beside_siconos, solver):
    """Which of the four corners carry is open, what a joint carries is not: blocks 0.4 x 0.4 x 0.3
    m, a drum 0.5 x 1.6 m, 2700 kg/m3, for 5 ms.
    """
    given, own, found = beside_siconos
    block, solid = (
        mass * 9.81 * 5e-3 for mass in (2700 * 0.4 * 0.4 * 0.3, 2700 * np.pi * 0.25**2 * 1.6)
    )
    for forces in (own, [theirs[solver]["forces"] for theirs in found]):
        assert forces[0][:4, 2].sum() == pytest.approx(2 * block, rel=1e-5) and forces[0][
            4:, 2
        ].sum() == pytest.approx(block, rel=1e-5)
        assert forces[1][:, 2].sum() == pytest.approx(solid, rel=1e-5)


def test_siconos_finds_no_fault_with_our_forces(beside_siconos):
    for theirs in beside_siconos[2]:
        assert theirs["fecolumn"]["own_error"] < 1e-9


@pytest.mark.long
def test_problem_recorded_from_a_step_is_the_one_that_the_engine_solved():
    """Its forces obey the laws of W and q to what a step is solved to, 1e-11 of the foot's width;
    the solver finds the weight of both blocks from nothing.
    """
    made = boxes.stack()
    weight = sum(body["mass"] for body in made.structure.bodies.body) * 9.81
    for problem in recorded(made, "stack", boxes.sine_pulse(7.0, 0.4, 3), 1):
        assert problem.points == 8
        scale = np.abs(problem.q).max()
        assert violation(problem, made.motion.forces) * scale < 1e-11
        assert violation(problem, friction.ours(problem)["forces"]) < friction.SOLVED
    assert made.motion.forces[:4, 2].sum() == pytest.approx(weight, rel=1e-3)


def test_profile_is_the_share_solved_in_so_many_times_the_least_time():
    """Three problems, two solvers: the first is twice as fast once, the second once, and solves
    alone what the first does not.
    """
    ratios, shares = profile(np.array([[1.0, 2.0], [2.0, 1.0], [np.inf, 1.0]]))
    assert ratios.tolist() == [1.0, 2.0]
    assert shares == pytest.approx(np.array([[1 / 3, 2 / 3], [2 / 3, 1.0]]))


def test_solvers_in_turn_end_with_the_first_that_solves_and_cost_what_was_tried():
    def solvers(**violations):
        return {name: dict(violation=v, seconds=1.0, own_error=v) for name, v in violations.items()}

    first = dict(name="a", mu=[0.3], solvers=solvers(fecolumn=1e-14, newton=1.0, nsgs=1e-12))
    other = dict(name="b", mu=[0.3], solvers=solvers(newton=1.0, nsgs=1e-3, admm=1e-2))
    (row,) = [line for line in friction.shares([first, other]).splitlines() if "in turn" in line]
    cells = [cell.strip() for cell in row.split("|")]
    assert cells[2] == "1 of 2" and cells[3] == "2.5e+03, 5e+03" and cells[4] == "1e-03, b, mu 0.3"
    alone = friction.shares([dict(first, solvers=solvers(fecolumn=1e-14))])
    assert "in turn" not in alone
