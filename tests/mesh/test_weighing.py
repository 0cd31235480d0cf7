"""Densities with which a mesh has a mass, a centre and an inertia that were measured."""

import numpy as np
import pytest
from own_meshes import SIDES, bricks, tetrahedra

from fecolumn.mesh.bricks import UPPER, brick_mesh
from fecolumn.mesh.mass import mass_properties
from fecolumn.mesh.weighing import NoSuchDensity, relative_densities

VOLUME = float(np.prod(SIDES))
OWN = VOLUME / 12 * np.diag([0.1**2 + 0.4**2, 0.2**2 + 0.4**2, 0.2**2 + 0.1**2])


def weighed(made, mass, centre, inertia):
    import dataclasses

    mesh = brick_mesh(*made((4, 3, 6)), UPPER)
    inertia = None if inertia is None else np.array(inertia)
    shares = relative_densities(mesh, mass, np.array(centre), inertia)
    return shares, mass_properties(dataclasses.replace(mesh, relative_density=shares), 1.0)


@pytest.mark.parametrize("made", [bricks, tetrahedra], ids=["bricks", "tetrahedra"])
def test_a_hollow_body_has_the_moments_that_are_stated(made):
    turned = 0.03 * OWN[0, 0] * np.array([[0, 1, 0], [1, 0, 0], [0, 0, 0]])
    inertia = 0.5 * (1.15 * OWN + turned)
    shares, found = weighed(made, 0.5 * VOLUME, [0.01, -0.005, 0.22], inertia)
    assert shares.min() > 0
    assert found.volume == pytest.approx(VOLUME, rel=1e-12)
    assert found.mass == pytest.approx(0.5 * VOLUME, rel=1e-9)
    assert found.centre == pytest.approx([0.01, -0.005, 0.22], rel=1e-8)
    assert found.inertia == pytest.approx(inertia, rel=1e-7, abs=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("made", [bricks, tetrahedra], ids=["bricks", "tetrahedra"])
def test_moments_that_differ_a_little_are_found_whatever_is_rounded(made):
    rng = np.random.default_rng(0)
    for _ in range(400):
        mass = VOLUME * (1 + 1e-3 * rng.normal())
        centre = [0, 0, 0.2] + 1e-4 * rng.normal(size=3)
        inertia = mass / VOLUME * OWN * (1 + 1e-3 * rng.normal(size=3))
        _, found = weighed(made, mass, centre, inertia)
        assert found.inertia == pytest.approx(inertia, rel=1e-7, abs=1e-12)


def test_even_density_is_left_even():
    shares, _ = weighed(bricks, VOLUME, [0, 0, 0.2], OWN)
    assert shares == pytest.approx(np.ones(72), rel=1e-9)


def test_the_centre_alone_may_be_stated():
    _, found = weighed(bricks, VOLUME, [0, 0, 0.12], None)
    assert found.centre == pytest.approx([0, 0, 0.12], abs=1e-9)


@pytest.mark.parametrize(
    "centre, inertia",
    [
        ([0.2, 0, 0.2], None),
        ([0, 0, 0.39], None),
        ([0, 0, 0.2], 4 * OWN),
        ([0, 0, 0.2], 0.01 * OWN),
        ([0, 0, 0.2], OWN * [[3, 0, 0], [0, 1, 0], [0, 0, 1]]),
    ],
)
def test_what_no_matter_within_the_outline_has_is_refused(centre, inertia):
    with pytest.raises(NoSuchDensity):
        weighed(bricks, VOLUME, centre, inertia)
