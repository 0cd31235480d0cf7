"""Products of vectors are those of NumPy, to the last digit."""

import numpy as np
import pytest

from fecolumn.fem.rotation import vector_product


@pytest.mark.parametrize("shapes", [((3,), (3,)), ((3,), (7, 3)), ((7, 3), (3,)), ((2, 5, 3),) * 2])
def test_cross_products_are_those_of_numpy(shapes):
    random = np.random.default_rng(7)
    a, b = (random.normal(size=shape) for shape in shapes)
    assert np.array_equal(vector_product(a, b), np.cross(a, b))
