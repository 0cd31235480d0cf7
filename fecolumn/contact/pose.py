"""Where an interface is and how its bodies are turned towards it."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.record import record

#: The frame of an interface, of its master's surface: frame: (3, 3) its axes in the table frame, two tangents and the normal; origin: (3,) in the table
#: frame [m]; turned: (2, 3, 3) of slave and master to this frame; foot: (3,) middle of the slave's foot in it [m]. That of the base is the table frame.
POSE = record(("frame", "f8", (3, 3)), ("origin", "f8", 3), ("turned", "f8", (2, 3, 3)), ("foot", "f8", 3))

#: Sides of an interface.
SLAVE, MASTER = range(2)


def poses_on_base(rotations: np.ndarray) -> np.ndarray:
    """(n,) of POSE of interfaces on the base, whose slaves are turned by (n, 3, 3)."""
    poses = np.zeros(len(rotations), POSE)
    poses["frame"], poses["turned"][:, SLAVE], poses["turned"][:, MASTER] = np.eye(3), rotations, np.eye(3)
    return poses


@njit
def turns(poses):
    """(ni, 2, 3, 3): what of poses (ni,) loops over points need; from a record each of them would take as long as what is done with it."""
    result = np.empty((len(poses), 2, 3, 3))
    for k in range(len(poses)):
        for side in range(2):
            for a in range(3):
                for c in range(3):
                    result[k, side, a, c] = poses[k].turned[side, a, c]
    return result
