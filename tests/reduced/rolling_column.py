"""A rigid body of revolution that rolls without slip on the round rim of its foot, exact: what an
engine's column is compared with.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from fecolumn.case.sections import GRAVITY


def roll(rim, tilt, spin, seconds):
    """Leans (2, n) [-], horizontal part of the axis, at n times, and the energy [J] at start and
    end.

    It leans by `tilt` [rad] towards +x and turns with `spin` (3,) [rad/s] about the lowest point p
    of its rim. In the body's frame, r from the centre of mass to p, v = -w x r, the force m (v' + w
    x v - g) at p, and the moment of momentum I w' + w x I w = r x force.

    Parameters
    ----------
    rim
        RollingRim.
    """
    inertia, mass, radius = (
        np.diag([rim.transverse, rim.transverse, rim.axial]),
        rim.mass,
        rim.radius,
    )

    def lowest(up):
        sine = np.hypot(up[0], up[1])
        return np.array([-radius * up[0] / sine, -radius * up[1] / sine, -rim.height]), sine

    def rates(_, y):
        attitude, w = y[:4] / np.linalg.norm(y[:4]), y[4:]
        up = Rotation.from_quat(attitude).as_matrix()[2]
        r, sine = lowest(up)
        turning = np.cross(up, w)
        # the lowest point runs along the rim as the way up turns in the body's frame
        along = (up[0] * turning[1] - up[1] * turning[0]) / sine**2 * np.array([-r[1], r[0], 0.0])
        v = -np.cross(w, r)
        about = inertia + mass * (r @ r * np.eye(3) - np.outer(r, r))
        moment = mass * np.cross(r, np.cross(w, v) - np.cross(w, along) + GRAVITY * up) - np.cross(
            w, inertia @ w
        )
        return np.concatenate(
            [
                np.append(attitude[3] * w + np.cross(attitude[:3], w), -attitude[:3] @ w) / 2,
                np.linalg.solve(about, moment),
            ]
        )

    def energy(y):
        up = Rotation.from_quat(y[:4]).as_matrix()[2]
        r, _ = lowest(up)
        v = -np.cross(y[4:], r)
        return (y[4:] @ inertia @ y[4:] + mass * v @ v) / 2 - mass * GRAVITY * (up @ r + rim.height)

    start = Rotation.from_rotvec([0.0, tilt, 0.0])
    found = solve_ivp(
        rates,
        (0.0, seconds),
        np.concatenate([start.as_quat(), start.inv().apply(spin)]),
        "DOP853",
        rtol=1e-10,
        atol=1e-13,
        dense_output=True,
    )
    axes = Rotation.from_quat(found.sol(np.linspace(0, seconds, 100001))[:4].T).as_matrix()[
        :, :2, 2
    ]
    return axes.T, energy(found.y[:, 0]), energy(found.y[:, -1])
