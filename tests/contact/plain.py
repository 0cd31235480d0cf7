"""Points without pads, and interfaces on the base, as tests make them."""

import numpy as np

from fecolumn.contact.pad import Springs
from fecolumn.contact.pose import MASTER, POSE, SLAVE


def no_pads(own: np.ndarray) -> Springs:
    """Springs of points (n,) that alone give (n, 3) [m/N], without pads."""
    n = len(own)
    return Springs(own, np.zeros((n, 3)), np.zeros(n), np.zeros(n), np.zeros(n, bool))


def poses_on_base(rotations: np.ndarray) -> np.ndarray:
    """(n,) of POSE of interfaces on the base, whose slaves are turned by (n, 3, 3)."""
    poses = np.zeros(len(rotations), POSE)
    poses["frame"], poses["turned"][:, SLAVE], poses["turned"][:, MASTER] = (
        np.eye(3),
        rotations,
        np.eye(3),
    )
    return poses
