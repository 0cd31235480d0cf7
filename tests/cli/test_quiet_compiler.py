"""What the form compiler says on first use stays out of the terminal; warnings do not."""

import os
import subprocess
import sys

FIRST_USE = """
import warnings
from mpi4py import MPI
from fecolumn.foundation import _dolfinx
import numpy as np
import ufl
points = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
mesh = _dolfinx.create_brick_mesh(MPI.COMM_WORLD, points, np.arange(8)[None])
space = _dolfinx.vector_space(mesh, 1)
# from 0.8 on a space alone asks for no code
u, w = ufl.TrialFunction(space), ufl.TestFunction(space)
_dolfinx.assemble_matrix(ufl.inner(u, w) * ufl.dx)
warnings.warn("the step is coarse")
"""


def test_first_use_of_dolfinx_prints_no_compiler_calls_and_keeps_warnings(tmp_path):
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    result = subprocess.run(
        [sys.executable, "-c", FIRST_USE],
        capture_output=True,
        text=True,
        env=environment,
        timeout=300,
    )
    assert result.returncode == 0 and list((tmp_path / "fenics").glob("*.so"))  # it did compile
    assert (
        "gcc" not in result.stdout + result.stderr
        and "build_ext" not in result.stdout + result.stderr
    )
    assert "UserWarning: the step is coarse" in result.stderr
