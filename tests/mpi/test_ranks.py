"""Two ranks give the answer of one."""

import json
import os
import subprocess
import sys

import h5py
import numpy as np
import pytest

from fecolumn.foundation._mpi import launch_environment

# Ranks give way to others while they wait: they would take a core each from tests that run beside
# them
MPIRUN = ["mpirun", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]

SHAKEN = """
extends = "{specimen}"
[column]
wall_m = 0.02
height_m = 0.5
fine_height_m = 0.02
[base]
slide_allowance_m = 0.01
[mesh]
fine_size_m = 0.02
coarse_size_m = 0.03
cap_size_m = 0.05
base_size_m = 0.05
[motion]
source = "motion.csv"
[integration]
duration_s = 0.1
dt_s = 2e-3
alpha_hht = -0.05
engine = "full"
kinematics = "{kinematics}"
[output]
fields_every_s = 0.1
"""


def _run(n, case, out):
    command = [
        *MPIRUN,
        "-n",
        str(n),
        sys.executable,
        "-m",
        "fecolumn.cli",
        "run",
        str(case),
        "-o",
        str(out),
    ]
    done = subprocess.run(command, capture_output=True, text=True, env=launch_environment())
    assert done.returncode == 0, done.stderr
    with h5py.File(out / "history.h5") as history:
        return (
            json.loads((out / "summary.json").read_text()),
            history["u_top"][:],
            history["active_nodes"][:],
        )


@pytest.mark.parametrize(
    "kinematics", ["corotated", pytest.param("total_lagrangian", marks=pytest.mark.slow)]
)
def test_two_ranks_give_the_history_of_one(tmp_path, kinematics):
    time = np.arange(0, 0.5, 0.0025)
    rows = [f"{t:.4f},{0.4 * np.sin(25 * t):.6f},{0.3 * np.sin(33 * t):.6f}\n" for t in time]
    (tmp_path / "motion.csv").write_text("time [s],ax [g],ay [g]\n" + "".join(rows))
    case = tmp_path / "case.toml"
    case.write_text(
        SHAKEN.format(specimen=os.path.abspath("meshes/stout.toml"), kinematics=kinematics)
    )
    one, two = (_run(n, case, tmp_path / str(n)) for n in (1, 2))
    assert (one[0]["ranks"], two[0]["ranks"]) == (1, 2)
    np.testing.assert_allclose(two[1], one[1], rtol=0, atol=1e-6 * np.abs(one[1]).max())
    np.testing.assert_array_equal(two[2], one[2])
    assert np.abs(one[1]).max() > 1e-4 and len(np.unique(one[2])) > 2  # the foot lifts and lands


def test_refusal_is_said_once_and_ends_both_ranks(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text("[column]\nwall = 1\n")
    command = [
        *MPIRUN,
        "-n",
        "2",
        sys.executable,
        "-m",
        "fecolumn.cli",
        "run",
        str(case),
        "-o",
        str(tmp_path / "out"),
    ]
    done = subprocess.run(command, capture_output=True, text=True, env=launch_environment())
    assert done.returncode == 2
    assert done.stderr.count("unknown key") == 1


STACKED = """
integration = {engine = "full", duration_s = 0.08, dt_s = 1e-3}
contact = {friction_coefficient = 0.7, interior_points = 0}
initial.upper.tilt_rad = 0.008
output.fields_every_s = 0.04
interfaces.foot = {between = ["lower", "ground"]}
interfaces.joint = {between = ["upper", "lower"]}
[bodies.lower]
kind = "block"
length_m = 0.6
width_m = 0.6
height_m = 0.5
element_size_m = 0.2
[bodies.upper]
kind = "cylinder"
outer_diameter_m = 0.3
height_m = 0.9
element_size_m = 0.07
coarse_size_m = 0.3
at_m = [0, 0, 0.5]
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("keys", "more"), [("kinematics", "total_lagrangian"), ("impact", "none")], ids=str
)
def test_two_ranks_give_the_motion_of_every_kind_of_structure(tmp_path, keys, more):
    text = STACKED.replace("output.fields_every_s = 0.04\n", "")
    section = "contact = {" if keys == "impact" else "integration = {"
    case = tmp_path / "case.toml"
    case.write_text(text.replace(section, f'{section}{keys} = "{more}", '))
    one, two = (_run(n, case, tmp_path / str(n)) for n in (1, 2))
    np.testing.assert_allclose(two[1], one[1], rtol=0, atol=1e-8)
    assert np.ptp(one[1][:, 0]) > 5e-3


def test_two_ranks_give_the_motion_of_a_structure_that_one_gives(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(STACKED)
    one, two = (_run(n, case, tmp_path / str(n)) for n in (1, 2))
    assert (one[0]["ranks"], two[0]["ranks"]) == (1, 2) and one[0]["dofs"] == two[0]["dofs"]
    np.testing.assert_allclose(two[1], one[1], rtol=0, atol=1e-9)
    assert np.ptp(one[1][:, 0]) > 5e-3 and one[0]["impacts"] == two[0]["impacts"] > 0
    with (
        h5py.File(tmp_path / "1" / "fields" / "frame_000000040000.h5") as first,
        h5py.File(tmp_path / "2" / "fields" / "frame_000000040000.h5") as second,
    ):
        for name in ("displacement", "von_mises", "pressure"):
            np.testing.assert_allclose(
                second[name][:], first[name][:], rtol=0, atol=1e-6 * np.abs(first[name][:]).max()
            )


def test_a_structure_of_the_reduced_engine_is_refused_on_two_ranks(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(
        STACKED.replace('"full"', '"reduced"').replace("output.fields_every_s = 0.04", "")
    )
    command = [
        *MPIRUN,
        "-n",
        "2",
        sys.executable,
        "-m",
        "fecolumn.cli",
        "run",
        str(case),
        "-o",
        str(tmp_path / "out"),
    ]
    done = subprocess.run(command, capture_output=True, text=True, env=launch_environment())
    assert done.returncode == 2 and done.stderr.count("runs on one process") == 1


REFUSED = """
from mpi4py import MPI
from fecolumn.fem.tied_body import known_to_all
from fecolumn.foundation.schema import InputError

def damaged():
    raise MemoryError("no room")

def refused():
    raise InputError("case", "key", 1, "must be 2")

for make in (lambda: 7, refused, damaged):
    try:
        told = known_to_all(MPI.COMM_WORLD, make)
    except Exception as error:
        told = f"{type(error).__name__}: {error}"
    # by one rank, as mpirun mixes what several print
    for line in MPI.COMM_WORLD.gather(f"{MPI.COMM_WORLD.rank} {told}") or ():
        print(line, flush=True)
"""


@pytest.mark.long
def test_what_one_rank_cannot_make_ends_all():
    command = [*MPIRUN, "-n", "2", sys.executable, "-c", REFUSED]
    done = subprocess.run(
        command, capture_output=True, text=True, env=launch_environment(), timeout=120
    )
    assert sorted(done.stdout.splitlines()) == [
        "0 7",
        "0 InputError: case: key = 1: must be 2",
        "0 MemoryError: no room",
        "1 7",
        "1 InputError: case: key = 1: must be 2",
        "1 RuntimeError: MemoryError on rank 0: no room",
    ]
