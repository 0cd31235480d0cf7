"""The comparison with peers: its theory, its table, and what it says of a peer that is not
there.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.peers import ours
from benchmarks.peers import peer as peers
from benchmarks.peers.calculix import displacements, increments
from benchmarks.peers.case import release
from benchmarks.peers.table import HEAD, ratios, table
from benchmarks.peers.theory import Housner
from benchmarks.peers.track import read_track, write_rows


def test_impacts_of_the_published_pipe_are_housner_s():
    """Published with the case: 0.2225, 0.6588, 1.0864, 1.5057 s; the restitution of bricks and tube
    differ by 1e-5.
    """
    assert release("pipe").impacts[:4] == pytest.approx([0.2225, 0.6588, 1.0864, 1.5057], abs=3e-4)


def test_impact_times_are_those_of_the_integrated_equation_of_motion():
    """th'' = -p^2 sin(alpha - th) until th = 0, then the velocity times r and the same on the other
    side; a tilt that is not small.
    """
    rigid = Housner(slenderness=0.3, moment=40.0, inertia=5.0, restitution=0.9)
    tilt, time, state = 0.2, 0.0, [0.2, 0.0]

    def slope(_, s):
        return [s[1], -rigid.moment / rigid.inertia * np.sin(rigid.slenderness - s[0])]

    def upright(_, s):
        return s[0]

    upright.terminal, upright.direction, expected = True, -1, []
    for _ in range(3):
        found = solve_ivp(slope, (0, 10), state, events=upright, rtol=1e-11, atol=1e-13)
        time += found.t[-1]
        expected.append(time)
        state = [0.0, -rigid.restitution * found.y[1, -1]]
        state[0] = 1e-12
    assert rigid.impact_times(tilt, 3) == pytest.approx(expected, rel=1e-7)


def rocking_rows(rigid, tilt, dt, slip=0.0):
    """Rows of a track of a slender rigid block until 20 ms after its first impact; its toe creeps
    by `slip` [m/s].
    """
    quarter, p = rigid.quarter_period(tilt), np.sqrt(rigid.moment / rigid.inertia)
    for step in range(int((quarter + 0.02) / dt)):
        time = step * dt
        lean = rigid.slenderness - (rigid.slenderness - tilt) * np.cosh(p * time)
        energy = rigid.energy(tilt) * (1.0 if time < quarter else rigid.restitution**2)
        yield time, lean, slip * time, 0.0, energy, 0.25 * step, 2, 1


def test_track_tells_impact_creep_and_energy(tmp_path):
    rigid = Housner(slenderness=0.1, moment=197.0, inertia=20.2, restitution=0.985)
    write_rows(tmp_path / "track.csv", rocking_rows(rigid, 0.02, 1e-3, slip=1e-3))
    track = read_track(tmp_path / "track.csv")
    quarter = rigid.quarter_period(0.02)
    assert track.impacts == pytest.approx([quarter], rel=2e-3)
    assert track.creep == pytest.approx(1e-3 * (quarter - 0.013), rel=0.01)
    assert track.kept == pytest.approx(rigid.restitution**2)
    assert track.cpu_per_step == pytest.approx(0.25)


@pytest.mark.long
@pytest.mark.parametrize("engine", ["rigid", "reduced"])
def test_toes_of_this_program_start_where_they_stand(engine, tmp_path):
    """The one turned about is not moved by the release, the other one by radius (1 - cos)."""
    given = ours.release("pipe")
    ours.main(engine, "pipe", tmp_path, "50")
    track = read_track(tmp_path / "track.csv")
    raised = 2 * given.radius * (1 - np.cos(given.tilt))
    assert abs(track.right[0]) < 1e-12 and track.left[0] == pytest.approx(raised, rel=1e-3)
    assert track.creep < 1e-7


def test_line_that_was_being_written_is_left_out(tmp_path):
    path = tmp_path / "track.csv"
    write_rows(path, [(0, 0.02, 0, 0, 1, 0, 0, 1), (0.001, 0.02, 0, 0, 1, 0.5, 3, 1)])
    path.write_text(path.read_text() + "0.002,0.02,0,0,1,0.")
    assert read_track(path).steps == 1


def measured(label, cost, **more):
    return (
        dict(
            case="pipe",
            name=label.lower(),
            peer=label,
            version="5.4.2",
            elements=True,
            dofs=35328,
            asked_steps=240,
            reason="",
            code=0,
            timed_out=False,
            last_words="",
            steps=240,
            cpu_s_per_step=cost,
            iterations_per_step=2.3,
            converged=True,
            impacts_s=[0.2225],
            theory_s=[0.2220, 0.6588],
            toe_creep_m=8e-4,
            energy_kept=0.98,
            theory_energy_kept=0.97,
            reached_s=0.24,
        )
        | more
    )


def test_table_has_a_row_a_peer_and_says_how_each_ended():
    found = [
        measured("GetFEM", 1.2),
        measured(
            "CalculiX",
            5.6,
            steps=53,
            reached_s=0.053,
            timed_out=True,
            impacts_s=[],
            energy_kept=None,
        ),
        measured("fecolumn", 0.03, name="full", elements=False),
    ]
    lines = table(found).splitlines()
    assert len(lines) == 2 + len(found) and len({len(line) for line in lines}) == 1
    assert all(line.count("|") == len(HEAD) + 1 for line in lines)
    cells = [cell.strip() for cell in lines[2].split("|")[1:-1]]
    assert cells == [
        "GetFEM (5.4.2)",
        "35,328",
        "1.2",
        "2.3",
        "240",
        "1",
        "0.23%",
        "8e+02",
        "0.9800 / 0.9700",
        "converged; reached 0.240 s asked for",
    ]
    assert "CPU limit; reached 0.053 s" in lines[3] and " - / 0.9700 " in lines[3]
    assert ratios(found) == ["fecolumn: 40 times as fast a step as GetFEM"]


def test_peer_that_is_missing_says_so_in_its_row(tmp_path, monkeypatch):
    """A program that does not exist, in an environment that does not exist: a row with the reason,
    and no folder of results.
    """
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "nowhere"))
    mujoco = next(peer for peer in peers.PEERS if peer.name == "mujoco")
    found = peers.record(peers.run_peer(mujoco, release("specimen"), tmp_path / "out"))
    last = table([found]).splitlines()[-1]
    assert "MuJoCo" in last and "cannot run" in last and "nowhere" in last and "--install" in last
    assert not (tmp_path / "out").exists()


def test_peer_that_spends_its_limit_is_ended(tmp_path):
    from benchmarks.peers.child import run_child

    outcome = run_child(["/usr/bin/python3", "-c", "while True: pass"], tmp_path, 1)
    assert outcome.timed_out and outcome.cpu < 3


def test_increments_and_displacements_of_ccx_are_read_up_to_the_last_whole_one():
    status = (
        "  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME\n"
        "     1          1     1     2  0.100000E-02  0.100000E-02  0.100000E-02\n"
        "     1          2     1     4  0.200000E-02  0.200000E-02  0.100000E-02\n"
    )
    assert increments(status) == [2, 4]
    head = " displacements (vx,vy,vz) for set WATCHED and time  {}\n\n"
    rows = (
        "         1  1.000000E-03  0.000000E+00  0.000000E+00\n         7  2.000000E-03  "
        "0.000000E+00 -1.000000E-05\n"
    )
    text = (
        "\n"
        + head.format("0.1000000E-02")
        + rows
        + "\n"
        + head.format("0.2000000E-02")
        + rows.splitlines()[0]
        + "\n"
    )
    found = displacements(text)
    assert [time for time, _ in found] == [0.001]
    assert found[0][1][6] == pytest.approx([2e-3, 0, -1e-5])
