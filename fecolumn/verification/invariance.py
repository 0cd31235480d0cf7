"""What must not matter: an interruption, the number of ranks, the numbers of the nodes.

Requirement: an analysis stopped and resumed from its checkpoint is the uninterrupted one; two ranks
give the answer of one; node and brick numbers change nothing beyond rounding.

Derivation. A checkpoint holds the whole state in binary, and a step depends on nothing else:
equality to the last bit but for sums whose order the restart may change. Ranks and numbers change
the order of sums and the elimination order of the factor: differences of eps = 2e-16 of positions
and internal forces, and, since an iteration ends where the unbalanced force falls below the
tolerance, of that tolerance: the bound of `trial.solver_drift`. No closed form is needed: the
computation itself is the reference.

Source. Requirement; growth of differences as in `fecolumn.verification.trial.solver_drift`.

Tolerances. Restart: 1e-10 of the path's peak, as required. Ranks: 1e-6, as required. Numbers: twice
the solver's drift at the end.
"""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from mpi4py import MPI

from fecolumn import simulation
from fecolumn.case.case import load_case
from fecolumn.engines.dynamics.checkpoint import read_checkpoint, write_checkpoint
from fecolumn.engines.dynamics.history import read_history
from fecolumn.engines.dynamics.system import State
from fecolumn.engines.elements import checked_layout
from fecolumn.foundation._mpi import launch_environment
from fecolumn.foundation.toml_file import merge
from fecolumn.pictures.figures.style import LINES
from fecolumn.structures.layout import Layout
from fecolumn.structures.shape import Shape
from fecolumn.verification import FULL
from fecolumn.verification.models import COARSE, column_case, shaking, system_of, with_shape
from fecolumn.verification.reduced_trial import begin_trial
from fecolumn.verification.result import CaseRows, Row
from fecolumn.verification.trial import Trial, solver_drift

_STEPS, SHAKEN_DT = 200, 1e-3
TIMES = SHAKEN_DT * np.arange(1, _STEPS + 1)
FLOOR = 1e-18  # m, drawn for no difference at all


def run(engine: str, long: bool) -> CaseRows:
    """The reduced engine runs on one core; it is interrupted where it looks for Ctrl-C, between
    chunks of steps.
    """
    case, motion = column_case(engine), shaking(TIMES)
    layout, off = checked_layout(case, "verification"), {}

    def trial(meshes: Layout = layout) -> Trial:
        return begin_trial(engine, system_of(case, meshes))

    whole, result = trial(), CaseRows()
    path = whole.shake(motion)
    peak = np.abs(path).max()
    drift = 2 * solver_drift(whole.system, TIMES) * TIMES / 2
    if engine in FULL:
        one, two = (on_ranks(engine, n, motion) for n in (1, 2))
        off["restart"] = np.abs(interrupted(trial, motion) - path).max(axis=(1, 2))
        off["two ranks"] = np.abs(two - one)[1:].max(axis=1)
        result.rows.append(
            Row(
                f"two ranks against one, {_STEPS} steps: top's path off / peak",
                0.0,
                off["two ranks"].max() / np.abs(one).max(),
                1e-6,
            )
        )
    else:
        off["restart"] = np.abs(resumed(engine, motion, 2) - resumed(engine, motion, 1))[1:].max(
            axis=1
        )
    off["renumbered"] = np.abs(trial(with_shape(layout, shuffled)).shake(motion) - path).max(
        axis=(1, 2)
    )
    result.rows = [
        Row(
            f"restart at half, {_STEPS} steps: path off / peak",
            0.0,
            off["restart"].max() / peak,
            1e-10,
        ),
        *result.rows,
        Row(
            f"nodes and bricks renumbered, {_STEPS} steps: path off [m]",
            0.0,
            off["renumbered"].max(),
            drift[-1],
        ),
    ]

    def draw(figure: Figure) -> None:
        axes = figure.subplots()
        for (label, difference), (colour, dashes) in zip(off.items(), LINES):
            axes.semilogy(
                TIMES, np.maximum(difference, FLOOR), color=colour, linestyle=dashes, label=label
            )
        axes.semilogy(TIMES, drift, "k:", label="solver's drift, bound")
        axes.semilogy(
            TIMES, np.abs(path[:, 0]).max(axis=1), "k-", linewidth=0.6, label="the path itself"
        )
        axes.set(
            xlabel="time [s]",
            ylabel="difference of displacement [m]",
            ylim=(FLOOR / 10, None),
            xlim=(0, TIMES[-1]),
        )
        axes.legend(ncols=2)

    result.draw = draw
    return result


def interrupted(trial: Callable[[], Trial], motion: np.ndarray) -> np.ndarray:
    """Path of an analysis that ends at half, and of one in a new system that goes on from its
    checkpoint.
    """
    first, half = trial(), _STEPS // 2
    before = first.shake(motion[:half])
    assert isinstance(first.state, State)
    with tempfile.TemporaryDirectory() as folder:
        write_checkpoint(Path(folder) / "state.npz", first.system, first.state, {})
        second = trial()
        second.state, _ = read_checkpoint(Path(folder) / "state.npz", second.system)
    return np.concatenate([before, second.shake(motion[half:])])


def shuffled(shape: Shape, seed: int = 1) -> Shape:
    """The same mesh with its points and bricks in random order."""
    body, random = shape.mesh, np.random.default_rng(seed)
    order, bricks = random.permutation(len(body.points)), random.permutation(len(body.cells))
    number = np.argsort(order)  # new number of each old point
    mixed = replace(
        body, points=body.points[order], cells=number[body.cells][bricks], part=body.part[bricks]
    )
    ties = tuple(
        replace(tie, slave_nodes=number[tie.slave_nodes], master_quads=number[tie.master_quads])
        for tie in shape.ties
    )
    return replace(shape, mesh=mixed, ties=ties)


def on_ranks(engine: str, n: int, motion: np.ndarray) -> np.ndarray:
    """Path of the top (steps + 1, 3) [m] by the command line on n ranks."""
    with tempfile.TemporaryDirectory() as folder:
        case, out = _case_file(Path(folder), engine, motion), Path(folder) / "out"
        done = subprocess.run(
            [
                "mpirun",
                "-n",
                str(n),
                sys.executable,
                "-m",
                "fecolumn.cli",
                "run",
                str(case),
                "-q",
                "-o",
                str(out),
            ],
            env=launch_environment(),
            capture_output=True,
            text=True,
        )
        if done.returncode:
            raise RuntimeError(f"mpirun -n {n}: {done.stderr}")
        return read_history(out / "history.h5")["u_top"]


def resumed(engine: str, motion: np.ndarray, parts: int) -> np.ndarray:
    """Path of the top (steps + 1, 3) [m] of an analysis in one part, or in two by Ctrl-C at
    half.
    """
    with tempfile.TemporaryDirectory() as folder:
        # fields and states at half: what is written must not matter either, and the reduced engine
        # looks for Ctrl-C wherever it writes
        half = len(motion) // 2
        case, out = (
            load_case(
                _case_file(
                    Path(folder),
                    engine,
                    motion,
                    {
                        "output": dict.fromkeys(
                            ("fields_every_s", "states_every_s"), half * SHAKEN_DT
                        )
                    },
                )
            ),
            Path(folder) / "out",
        )

        def stop() -> bool:
            # of a slow machine it looks sooner as well: the second frame is that at half
            return len(list((out / "fields").glob("frame_*.h5"))) > 1

        if parts == 2:
            with contextlib.suppress(KeyboardInterrupt):
                simulation.run(case, out, comm=MPI.COMM_SELF, quiet=True, stop=stop)
            if (made := len(read_history(out / "history.h5")["u_top"]) - 1) != half:
                raise RuntimeError(
                    f"the analysis was interrupted after {made} steps, not at half of {len(motion)}"
                )
        simulation.run(case, out, comm=MPI.COMM_SELF, quiet=True)
        return read_history(out / "history.h5")["u_top"]


def _case_file(folder: Path, engine: str, motion: np.ndarray, more: dict | None = None) -> Path:
    times = SHAKEN_DT * np.arange(len(motion) + 1)
    rows = [f"{t:.17g},{a[0]:.17g},{a[1]:.17g}\n" for t, a in zip(times, [np.zeros(3), *motion])]
    (folder / "motion.csv").write_text("time [s],ax [m/s2],ay [m/s2]\n" + "".join(rows))
    tables = merge(
        merge(COARSE, more or {}),
        {
            "integration": {
                **(
                    {"engine": "full", "kinematics": engine}
                    if engine in FULL
                    else {"engine": engine}
                ),
                "dt_s": SHAKEN_DT,
                "duration_s": times[-1],
            },
            "motion": {"source": "motion.csv"},
        },
    )
    del tables["title"]
    lines = [
        line
        for name, table in tables.items()
        for line in (f"[{name}]", *(f"{key} = {json.dumps(value)}" for key, value in table.items()))
    ]
    (folder / "case.toml").write_text("\n".join(lines))
    return folder / "case.toml"
