"""Smallest parts of verification cases that once did not run: cheap enough for every change."""

import numpy as np
import pytest

from fecolumn.fem import effective
from fecolumn.verification.hertz import LARGEST, Hertz, press
from fecolumn.verification.hht_scheme import Mode, amplification


@pytest.mark.long
@pytest.mark.parametrize(
    "exact, bricks",
    [(Hertz(1, 0.0, 64), 4), (Hertz(2, 0.3, 8), 3)],
    ids=lambda one: getattr(one, "name", None),
)
def test_hertz_on_the_coarsest_bricks_has_the_contact_radius_to_what_bricks_allow(exact, bricks):
    """The block's slice is as wide as its base, and its material is one that a case may have."""
    (one,) = press("corotated", exact, bricks, [LARGEST])
    assert abs(one.radius) < exact.allowed(LARGEST, LARGEST / bricks)


@pytest.mark.parametrize("package", ["mumps", effective._OF_ONE_RANK])
def test_a_step_of_15_s_has_the_amplification_matrix_whatever_factors_it(package, monkeypatch):
    """Solvers differ in rounding alone: neither needs a step cut in halves."""
    monkeypatch.setattr(effective, "_OF_ONE_RANK", package)
    assert np.abs(Mode("corotated").matrix(-0.333, 1e5) - amplification(-0.333, 1e5)).max() < 1e-6
