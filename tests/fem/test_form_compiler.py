"""The form compiler: killed at any moment while it compiles for the first time, the next process
goes on as if it had not been.
"""

import os
import random
import signal
import subprocess
import sys
import time

import pytest

FIRST_USE = """
from mpi4py import MPI
from fecolumn.foundation import _dolfinx
import numpy as np
import ufl
points = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
mesh = _dolfinx.create_brick_mesh(MPI.COMM_WORLD, points, np.arange(8)[None])
print("begins", flush=True)
space = _dolfinx.vector_space(mesh, 1)
u, w = ufl.TrialFunction(space), ufl.TestFunction(space)
mass = _dolfinx.assemble_matrix(ufl.inner(u, w) * ufl.dx)
print("mass", sum(mass.getRow(row)[1].sum() for row in range(24)))
"""


def _start(cache):
    process = subprocess.Popen(
        [sys.executable, "-c", FIRST_USE],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"XDG_CACHE_HOME": str(cache)},
        start_new_session=True,
    )
    assert process.stdout.readline() == "begins\n", process.stderr.read()
    return process


def _whole(cache):
    process = subprocess.run(
        [sys.executable, "-c", FIRST_USE],
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | {"XDG_CACHE_HOME": str(cache)},
    )
    assert process.returncode == 0, process.stderr
    # a cube of unit density, along three axes
    assert float(process.stdout.split()[-1]) == pytest.approx(3.0)
    kept = sorted(file.name for file in (cache / "fenics").iterdir())
    # neither locks nor unfinished folders are left
    assert sum(name.endswith(".so") for name in kept) and not [
        name for name in kept if name.startswith(".")
    ]


def _killed(cache, times, seed):
    process, began = _start(cache / "timed"), time.perf_counter()
    process.communicate(timeout=300)
    span, draw = time.perf_counter() - began, random.Random(seed)
    for _ in range(times):
        process = _start(cache / "killed")
        time.sleep(draw.uniform(0.0, span))
        # the process alone: what its C compiler does meanwhile, it does
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=300)
    _whole(cache / "killed")


@pytest.mark.long
def test_killed_while_it_compiles_the_next_process_compiles_again(tmp_path):
    _killed(tmp_path, 5, 1)


@pytest.mark.slow
def test_killed_fifty_times_while_it_compiles_the_next_process_compiles_again(tmp_path):
    for round_ in range(10):
        _killed(tmp_path / str(round_), 5, round_)


@pytest.mark.long
def test_what_a_killed_compiler_of_other_programs_left_is_made_again(tmp_path):
    _whole(tmp_path)
    for file in (tmp_path / "fenics").iterdir():
        # the lock of ffcx itself, and no sign that its module is ready
        if not file.name.endswith(".c"):
            file.unlink()
    _whole(tmp_path)


@pytest.mark.long
def test_processes_that_start_at_once_compile_once_and_all_go_on(tmp_path):
    processes = [_start(tmp_path) for _ in range(3)]
    assert all(
        process.communicate(timeout=300) and process.returncode == 0 for process in processes
    )
    _whole(tmp_path)


@pytest.mark.long
def test_error_of_the_compiler_is_told_and_the_next_process_tries_again(tmp_path):
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "CC": "false"}
    failed = subprocess.run(
        [sys.executable, "-c", FIRST_USE],
        capture_output=True,
        text=True,
        env=environment,
        timeout=300,
    )
    assert (
        failed.returncode
        and "false" in failed.stderr
        and "timed out" not in failed.stderr
        and "No such file" not in failed.stderr
    )
    _whole(tmp_path)
