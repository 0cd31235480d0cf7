"""Contact formulations: augmented Lagrangian (rigid interface) and penalty (compliant
interface).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fecolumn.foundation.arrays import Array


def interface_compliance(contact: Any, youngs_modulus: float, size: float, areas: Array) -> Array:
    """Compliance (n, 3) [m/N] of the interface at each contact point.

    `augmented_lagrange` has none: gap and slip vanish to the tolerance of the contact solver.
    `penalty` has a normal and tangential stiffness per area of penalty_factor E / h, so that it
    scales with mesh and material.

    Parameters
    ----------
    contact
        the [contact] section of a case.
    youngs_modulus
        of the column [Pa].
    size
        brick size h at the foot [m].
    areas
        (n,) tributary area of each point [m2].
    """
    if contact.law == "augmented_lagrange":
        return np.zeros((len(areas), 3))
    stiffness = contact.penalty_factor * youngs_modulus / size * areas
    return np.repeat(1 / stiffness[:, None], 3, axis=1)
