import math

import numpy as np
import pytest
from scipy.linalg import eigvals
from small_specimen import small_case

from fecolumn.mesh.bending import cowper_coefficient, free_free_bending_frequency
from fecolumn.mesh.bricks import CAP, brick_mesh
from fecolumn.mesh.cap_plate import cap_mesh
from fecolumn.mesh.column import column_mesh, section
from fecolumn.mesh.mass import mass_properties
from fecolumn.mesh.quality import exact_cap, exact_column, quality_table
from fecolumn.mesh.specimen import specimen_mesh

STEEL = 7850.0


@pytest.mark.parametrize("wall", [0.01, 0.05], ids=["tube", "solid"])
def test_mass_is_exact_and_inertia_converges_with_the_fourth_power_of_the_brick_size(wall):
    """An equal-area polygon has the second moment of the circle up to (2 pi / n)^4 / 180."""
    errors, sizes = [], []
    for size in (0.018, 0.009, 0.0045):
        case = small_case(
            column_wall_m=wall,
            mesh_fine_size_m=min(size, wall),
            mesh_coarse_size_m=size,
            column_fine_height_m=0.0,
        )
        found, exact = mass_properties(column_mesh(case), STEEL), exact_column(case)
        assert found.mass == pytest.approx(exact.mass, rel=1e-12)
        errors.append(found.inertia[2, 2] / exact.inertia[2, 2] - 1)
        sizes.append(1 / section(case, 2).n_around)
    assert errors[0] < 2 * (2 * math.pi * sizes[0]) ** 4 / 180
    assert abs(np.polyfit(np.log(sizes), np.log(errors), 1)[0] - 4) < 0.2


def test_cap_has_the_mass_and_inertia_of_a_box():
    case = small_case()
    found, exact = mass_properties(cap_mesh(case), STEEL), exact_cap(case)
    assert found.mass == pytest.approx(exact.mass, rel=1e-13)
    assert found.centre == pytest.approx(exact.centre, abs=1e-14)
    assert found.inertia == pytest.approx(exact.inertia, rel=1e-11, abs=1e-12)


def test_quadrature_is_exact_for_distorted_bricks():
    # One brick against the same brick cut into 20^3 by its own trilinear map: midpoint sums,
    # refined by Richardson.
    cube = np.array(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
        float,
    )
    corners = cube + np.random.default_rng(3).uniform(-0.15, 0.15, (8, 3))
    found = mass_properties(brick_mesh(corners, [range(8)], CAP), 2.0)

    def cut(n):
        t = np.linspace(0, 1, n + 1)
        local = np.stack(np.meshgrid(t, t, t, indexing="ij"), -1).reshape(-1, 3)
        weights = np.prod(np.where(cube, local[:, None], 1 - local[:, None]), axis=2)
        number = np.arange((n + 1) ** 3).reshape((n + 1,) * 3)
        cells = np.stack(
            [number[a : a + n, b : b + n, c : c + n].ravel() for a, b, c in cube.astype(int)],
            axis=1,
        )
        return mass_properties(brick_mesh(weights @ corners, cells, CAP), 2.0)

    fine = cut(3)
    assert fine.volume == pytest.approx(found.volume, rel=1e-13)
    assert fine.centre == pytest.approx(found.centre, rel=1e-13)
    assert fine.inertia == pytest.approx(found.inertia, rel=1e-12)


def test_assembly_of_column_and_cap_equals_one_merged_body():
    case = small_case()
    specimen = specimen_mesh(case)
    whole = mass_properties(specimen.body, case.material.density_kg_m3)
    rows = {row.name: row for row in quality_table(case, specimen)}
    assert rows["column with cap: mass"].mesh == pytest.approx(whole.mass, rel=1e-13)
    assert rows["column with cap: inertia I_xx about the centre of mass"].mesh == pytest.approx(
        whole.inertia[0, 0], rel=1e-12
    )
    assert rows["column: mass"].difference == pytest.approx(0, abs=1e-3)
    assert rows["cap: mass"].difference == pytest.approx(0, abs=1e-13)
    assert rows["base: volume"].difference == pytest.approx(0, abs=1e-13)
    assert all(row.exact is not None or "Jacobian" in row.name for row in rows.values())


def test_shear_coefficient_has_cowpers_limits():
    nu = 0.3
    assert cowper_coefficient(0, 1, nu) == pytest.approx(6 * (1 + nu) / (7 + 6 * nu))
    assert cowper_coefficient(1 - 1e-9, 1, nu) == pytest.approx(2 * (1 + nu) / (4 + 3 * nu))


def test_slender_beam_has_the_frequency_of_euler_and_bernoulli():
    outer, inner, length = 0.01, 0.009, 100.0
    gyration2 = (outer**2 + inner**2) / 4
    euler = 22.373285 / (2 * math.pi * length**2) * math.sqrt(200e9 * gyration2 / STEEL)
    assert free_free_bending_frequency(outer, inner, length, 200e9, 0.3, STEEL) == pytest.approx(
        euler, rel=1e-6
    )


@pytest.mark.parametrize(
    "outer, inner, length",
    [(0.0508, 0.0458, 1.0), (0.0508, 0.0, 0.3), (0.05, 0.04, 0.15), (0.05, 0.01, 0.1)],
)
def test_timoshenko_frequency_equals_collocation_of_the_beam_equations(outer, inner, length):
    frequency = free_free_bending_frequency(outer, inner, length, 200e9, 0.3, STEEL)
    assert frequency == pytest.approx(collocated_frequency(outer, inner, length), rel=1e-7)


def collocated_frequency(outer, inner, length, n=40):
    """Chebyshev collocation of kAG (w'' - psi') = -rho A omega^2 w, EI psi'' + kAG (w' - psi) =
    -rho I omega^2 psi.
    """
    modulus, nu = 200e9, 0.3
    area, second = math.pi * (outer**2 - inner**2), math.pi / 4 * (outer**4 - inner**4)
    shear = cowper_coefficient(inner, outer, nu) * area * modulus / (2 * (1 + nu))
    x = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.r_[2, np.ones(n - 1), 2] * (-1.0) ** np.arange(n + 1)
    slope = np.outer(c, 1 / c) / (x[:, None] - x + np.eye(n + 1))
    slope = (slope - np.diag(slope.sum(axis=1))) * 2 / length
    one, none = np.eye(n + 1), np.zeros((n + 1, n + 1))
    stiffness = (
        np.block(
            [
                [shear * slope @ slope, -shear * slope],
                [shear * slope, modulus * second * slope @ slope - shear * one],
            ]
        )
        / modulus
    )
    mass = -np.block([[STEEL * area * one, none], [none, STEEL * second * one]]) / modulus
    for end in (0, n):  # no shear force, no moment
        stiffness[end], stiffness[n + 1 + end] = (
            np.r_[slope[end], -one[end]],
            np.r_[none[end], slope[end]],
        )
        mass[end] = mass[n + 1 + end] = 0
    squares = eigvals(stiffness, mass)
    squares = squares[np.isfinite(squares)].real
    frequencies = np.sort(np.sqrt(squares[squares > 0])) / (2 * math.pi)
    return frequencies[frequencies > 1][0]
