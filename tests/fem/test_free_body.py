"""Static response of a free body against all modes of a small mesh, found densely: tall and soft,
short and stiff.
"""

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc
from scipy.linalg import eigh

from fecolumn.case.sections import Material
from fecolumn.fem import free_body
from fecolumn.fem.body import Body
from fecolumn.fem.free_body import FreeBody
from fecolumn.fem.modes import free_modes
from fecolumn.fem.rayleigh import elastic_bound
from fecolumn.verification.models import box


def _of(modulus: float, ratio: float, density: float) -> Material:
    return Material(youngs_modulus_pa=modulus, poissons_ratio=ratio, density_kg_m3=density)


# Width and height [m], material, and first bending frequency [Hz] to tell them by
BARS = {
    "chimney of 1000 m": (20.0, 1000.0, _of(50e9, 0.25, 2700.0), 0.09),
    "rubber post": (0.4, 1.2, _of(2e6, 0.45, 1100.0), 9.0),
    "marble block": (0.4, 1.2, _of(50e9, 0.25, 2700.0), 950.0),
    "glass rod": (0.002, 0.01, _of(70e9, 0.22, 2500.0), 97e3),
}


@pytest.fixture(scope="module", params=BARS, ids=str)
def bar(request):
    """A bar of six bricks of second order, its eigenvalues [1/s2] and modes (3 n, 3 n) of unit
    modal mass, and its frequency [Hz].
    """
    width, height, material, frequency = BARS[request.param]
    side = np.array([-width / 2, width / 2])
    body = Body(MPI.COMM_SELF, box(side, side, np.linspace(0, height, 7)), material, order=2)
    # the arrays are those of the matrices, and go with them
    dense = [matrix.copy().convert(PETSc.Mat.Type.DENSE) for matrix in (body.stiffness, body.mass)]
    return body, *eigh(*(matrix.getDenseArray() for matrix in dense)), frequency


def _compliance(body, values, modes):
    """Displacements (3 n, 3) of a body under unit forces at a corner, by FreeBody and as the sum
    over all elastic modes [m/N].
    """
    loads = np.zeros((3 * body.n_owned, 3))
    loads[3 * np.argmin(body.X.sum(axis=1)) + np.arange(3), np.arange(3)] = 1.0
    elastic = modes[:, 6:]
    return FreeBody(body).response(loads), elastic @ ((elastic.T @ loads) / values[6:, None])


def test_compliance_is_the_sum_over_all_elastic_modes(bar):
    body, values, modes, _ = bar
    found, exact = _compliance(body, values, modes)
    assert (np.linalg.norm(found - exact, axis=0) / np.linalg.norm(exact, axis=0)).max() < 1e-8


def test_compliance_does_not_depend_on_the_shift(bar, monkeypatch):
    body, values, modes, _ = bar
    monkeypatch.setattr(free_body, "_SHARE", 1.0)
    found, exact = _compliance(body, values, modes)
    assert (np.linalg.norm(found - exact, axis=0) / np.linalg.norm(exact, axis=0)).max() < 1e-8


def test_modes_of_any_bar_are_those_of_its_dense_matrices(bar):
    body, values, _, frequency = bar
    found = free_modes(body, 10).frequencies
    exact = np.sqrt(values[6:10]) / (2 * np.pi)
    assert exact[0] == pytest.approx(frequency, rel=0.2)
    assert found[6:] == pytest.approx(exact, rel=1e-6)
    assert np.abs(found[:6]).max() < 1e-2 * exact[0]


def test_bound_is_above_the_first_elastic_frequency_and_close(bar):
    body, values, *_ = bar
    assert 1 <= elastic_bound(body) / values[6] < 2
