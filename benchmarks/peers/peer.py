"""The peers: how each is started, how far it is to run, and what is known of it beforehand."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from benchmarks.peers import calculix
from benchmarks.peers.case import Release
from benchmarks.peers.child import Outcome, run_child
from benchmarks.peers.install import SYSTEM_PYTHON, mujoco_python
from benchmarks.peers.track import Track, read_track

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
CPU_LIMIT_S = 300.0
LONG_LIMIT_S = 3600.0
NO_LIMIT_S = 36000.0


class Missing(RuntimeError):
    """The peer is not there; the message is its row's remark."""


@dataclass(frozen=True, slots=True)
class Peer:
    """A program that rocks the column.

    Attributes
    ----------
    name
        on the command line.
    label
        in the table.
    start
        function of (peer, release, job file, folder, limit [CPU s]) that runs it.
    version
        function that gives the command which prints the version where the peer can run, and fails
        elsewhere; None for this project's engines.
    elements
        another finite-element program.
    modes
        of a body that moves in so many, 0 of a rigid one; None where all nodes move.
    steps
        it makes unless asked for a long run; 0 for all.
    step_share
        of its own step in the case's.
    """

    name: str
    label: str
    start: Callable
    version: Callable[[], list[str]] | None = None
    elements: bool = False
    modes: int | None = 0
    steps: int = 0
    step_share: float = 1.0


@dataclass(frozen=True, slots=True)
class Run:
    """A peer on a case: version, dofs, steps asked for, what it wrote (None: nothing), how it ended
    (None: it was not started) and why not.
    """

    peer: Peer
    given: Release
    dofs: int
    asked: int
    version: str = ""
    track: Track | None = None
    outcome: Outcome | None = None
    reason: str = ""


def _script(name, python, *extra):
    def start(peer, given, job, folder, limit):
        return run_child(
            [
                str(python() if callable(python) else python),
                "-P",
                str(HERE / name),
                str(job),
                str(folder),
                *extra,
            ],
            folder,
            limit,
        )

    return start


def _ccx(peer, given, job, folder, limit):
    return calculix.run(job, folder, limit)


def _engine(peer, given, job, folder, limit):
    command = [sys.executable, "-m", "benchmarks.peers.ours", peer.name, given.name, str(folder)]
    return run_child(command, folder, NO_LIMIT_S, extra={"PYTHONPATH": str(ROOT)})


def _debian(package, module):
    says = (
        f"import {module}, subprocess as s; print(s.check_output(['dpkg-query', '-W', '-f', "
        f"'${{Version}}', '{package}'], text=True))"
    )
    return lambda: [SYSTEM_PYTHON, "-I", "-c", says]


def _mujoco():
    return [str(mujoco_python()), "-I", "-c", "import mujoco; print(mujoco.__version__)"]


PEERS = (
    Peer("full", "fecolumn, full order, corotated", _engine, modes=None),
    Peer("reduced", "fecolumn, reduced, 100 modes", _engine, modes=100),
    Peer("rigid", "fecolumn, rigid", _engine),
    Peer(
        "getfem",
        "GetFEM",
        _script("getfem.py", SYSTEM_PYTHON),
        _debian("python3-getfem", "getfem"),
        elements=True,
        modes=None,
        steps=240,
    ),
    Peer(
        "calculix",
        "CalculiX",
        _ccx,
        lambda: ["ccx", "-v"],
        elements=True,
        modes=None,
        steps=50,
    ),
    Peer("mujoco", "MuJoCo, rigid, dt 1e-3", _script("mujoco.py", mujoco_python, "1e-3"), _mujoco),
    Peer(
        "mujoco-fine",
        "MuJoCo, rigid, dt 1e-4",
        _script("mujoco.py", mujoco_python, "1e-4"),
        _mujoco,
        step_share=0.1,
    ),
    Peer(
        "siconos",
        "Siconos, rigid",
        _script("siconos.py", SYSTEM_PYTHON),
        _debian("python3-siconos", "siconos.kernel"),
    ),
)


def version(peer: Peer) -> str:
    """Version of a peer; empty for this program, whose version stands above the table.

    Raises
    ------
    Missing
        it cannot be started.
    """
    if peer.version is None:
        return ""
    environment = {
        key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "VIRTUAL_ENV")
    }
    try:
        done = subprocess.run(
            peer.version(), capture_output=True, text=True, timeout=120, env=environment
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Missing(f"cannot run: {error}; --install installs it") from None
    # code of ccx -v is not 0
    found = re.search(r"\d+\.\d+(\.\d+)?", done.stdout)
    if not found:
        words = done.stderr.strip().splitlines() or [f"code {done.returncode}"]
        raise Missing(f"cannot run: {words[-1]}; --install installs it")
    return found.group()


def run_peer(
    peer: Peer, given: Release, folder: Path, long: bool = False, limit: float = CPU_LIMIT_S
) -> Run:
    """Run a peer on a case in a folder of its own below `folder`; a peer that is missing or fails
    says so in the result.
    """
    bodies = len(given.mesh.body.points)
    nodes = bodies if peer.elements else bodies + len(given.mesh.base.points)
    dofs = 3 * nodes if peer.modes is None else 6 + peer.modes
    steps = given.steps if long or not peer.steps else min(peer.steps, given.steps)
    run = Run(peer, given, dofs, round(steps / peer.step_share))
    try:
        run = replace(run, version=version(peer))
        work = folder / f"{given.name}-{peer.name}"
        work.mkdir(parents=True, exist_ok=True)
        (work / "track.csv").unlink(missing_ok=True)
        job = work / "job.npz"
        given.write(job, steps)
        outcome = peer.start(peer, given, job, work, LONG_LIMIT_S if long else limit)
    except (Missing, OSError) as error:
        return replace(run, reason=str(error))
    return replace(run, track=read_track(work / "track.csv"), outcome=outcome)


def record(run: Run) -> dict:
    """Everything measured in a run, for the JSON file."""
    track, outcome = run.track, run.outcome
    found = dict(
        case=run.given.name,
        name=run.peer.name,
        peer=run.peer.label,
        version=run.version,
        elements=run.peer.elements,
        dofs=run.dofs,
        asked_steps=run.asked,
        reason=run.reason,
    )
    if outcome:
        found |= dict(
            code=outcome.code,
            cpu_s=outcome.cpu,
            timed_out=outcome.timed_out,
            last_words=outcome.words,
        )
    if track:
        found |= dict(
            steps=round(track.steps / run.peer.step_share),
            cpu_s_per_step=track.cpu_per_step * run.peer.step_share,
            iterations_per_step=float(track.iterations[1:].mean()) if track.steps else None,
            converged=bool(track.converged.all()),
            impacts_s=track.impacts.tolist(),
            theory_s=run.given.impacts.tolist(),
            toe_creep_m=track.creep,
            energy_kept=track.kept,
            theory_energy_kept=run.given.rigid.restitution**2,
            reached_s=float(track.time[-1]),
        )
    return json.loads(json.dumps(found, default=float).replace("NaN", "null"))
