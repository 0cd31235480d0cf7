from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from fecolumn.case import manual
from fecolumn.case.sections import Material
from fecolumn.contact.base_plate import BasePlate
from fecolumn.contact.layer import layer_response
from fecolumn.contact.projection import nodes_under
from fecolumn.contact.unbounded_base import shear_frequency, unbounded_base
from fecolumn.fem.body import Body
from fecolumn.mesh.bricks import BASE
from fecolumn.mesh.gmsh_section import swept_grid

STEEL, SIZE, DEPTHS = Material(), 0.005, -np.array([0.0, 0.005, 0.0125, 0.02])


def test_layer_is_the_middle_of_a_wide_plate_of_the_same_bricks():
    lines = SIZE * np.arange(-20, 21)

    def held(body):
        return {}, np.flatnonzero(body.all_X[:, 2] < DEPTHS[-1] + 1e-9)

    plate = BasePlate(
        Body(MPI.COMM_SELF, swept_grid(lines, lines, DEPTHS[::-1], BASE), STEEL, 1, held)
    )
    under, beside, across = (
        plate.grid.number[20, 20],
        plate.grid.number[20, 24],
        plate.grid.number[23, 18],
    )
    plate.need(np.array([under, beside, across]))
    response = layer_response(SIZE, DEPTHS, STEEL, 6)
    for node, i, j in ((under, 0, 0), (beside, 0, 4), (across, 3, -2)):
        found = plate.compliance[plate.slot[node], plate.slot[under]]
        # the plate's edge is five thicknesses away
        assert np.abs(found - response[6 + i, 6 + j]).max() < 2e-5 * response.max()


def test_uniform_load_compresses_the_layer_as_an_oedometer_and_shears_it_as_a_block():
    reach = 60
    response = layer_response(SIZE, DEPTHS, STEEL, reach).sum(axis=(0, 1)) * SIZE**2
    E, nu = STEEL.youngs_modulus_pa, STEEL.poissons_ratio
    oedometer, shear = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
    assert response[2, 2] == pytest.approx(0.02 / oedometer, rel=1e-6)
    assert response[0, 0] == pytest.approx(0.02 / shear, rel=1e-6) and response[
        1, 1
    ] == pytest.approx(response[0, 0], rel=1e-12)


def test_layer_too_thick_for_its_bricks_is_refused_with_what_fits():
    with pytest.raises(ValueError, match="must be at most 1 m where its bricks are 0.005 m"):
        layer_response(SIZE, np.array([0.0, -5.0]), STEEL, 20)


def test_unbounded_base_gives_as_much_wherever_the_foot_is():
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    foot = 0.05 * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    base = unbounded_base(SIZE, DEPTHS, STEEL, foot)
    found = []
    for moved in (np.zeros(3), np.array([1234 * SIZE, -77 * SIZE, 0.0])):
        nodes, weights = nodes_under(base.grid, foot + moved + [0.0013, 0.0004, 0.0])
        base.need(nodes.ravel())
        found.append(
            np.einsum(
                "np,npnqab,nq->nab",
                weights,
                base.compliance[base.slot[nodes][:, :, None, None], base.slot[nodes]],
                weights,
            )
        )
    np.testing.assert_allclose(found[0], found[1], atol=1e-11 * base.compliance.max())
    whole = base.compliance.transpose(0, 2, 1, 3).reshape(3 * len(base.known), -1)
    assert (
        np.linalg.eigvalsh(whole).min() > 0 and np.abs(whole - whole.T).max() < 1e-12 * whole.max()
    )


def test_manual_states_the_frequency_of_the_base_as_it_is():
    assert (
        f"at {shear_frequency(STEEL, 0.02) / 1e3:.0f} kHz for 20 mm of steel"
        in (Path(manual.__file__).parent / "theory.md").read_text()
    )
