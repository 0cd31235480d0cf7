"""A rigid body of revolution that rolls on its rim, exact: steady precession, and what corners on
the rim cost.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.system import System


@dataclass(frozen=True, slots=True)
class RollingRim:
    """Rigid body on the rim of its foot.

    Attributes
    ----------
    mass
        [kg].
    transverse, axial
        inertia about the centre of mass, across and along the axis [kg m2].
    radius
        of the rim [m].
    height
        of the centre of mass above the foot [m].
    """

    mass: float
    transverse: float
    axial: float
    radius: float
    height: float

    @classmethod
    def of(cls, system: System) -> RollingRim:
        """That of a system's column, from its consistent mass and the farthest nodes of its
        foot.
        """
        column = system.body
        turns = [np.cross(axis, column.X - column.center) for axis in np.eye(3)]
        transverse, _, axial = (column.dot(turn, column.momentum(turn)) for turn in turns)
        return cls(
            column.total_mass,
            transverse,
            axial,
            float(np.linalg.norm(system.interface.reference[:, :2], axis=1).max()),
            float(column.center[2]),
        )

    def rate(self, tilt: float, spin: float) -> float:
        """Steady precession [rad/s] at a tilt [rad]; `spin` is the angular velocity along the axis
        over it.
        """
        s, c = np.sin(tilt), np.cos(tilt)
        inertia = (self.transverse * c - self.axial * spin) * s
        inertia += (
            self.mass * (self.height * s - self.radius * spin) * (self.radius * s + self.height * c)
        )
        return float(np.sqrt(self.mass * GRAVITY * (self.radius * c - self.height * s) / inertia))

    def untwisted(self, tilt: float) -> float:
        """Spin of a body that rolls around without turning: the path of its rim is a circle of the
        rim's radius.
        """
        return np.cos(tilt) - 1

    def centred(self, tilt: float) -> float:
        """Spin of a body whose centre of mass rests (Euler's disk)."""
        return self.height / self.radius * np.sin(tilt)

    def angular_velocity(self, tilt: float, spin: float) -> np.ndarray:
        """Angular velocity (3,) [rad/s] in steady precession of a body that leans towards +x."""
        s, c = np.sin(tilt), np.cos(tilt)
        return self.rate(tilt, spin) * (spin * np.array([s, 0.0, c]) - s * np.array([c, 0.0, -s]))

    def energy(self, tilt: float, spin: float) -> float:
        """Kinetic and gravity energy of steady precession above standing [J]."""
        s, c, rate = np.sin(tilt), np.cos(tilt), self.rate(tilt, spin)
        speed = self.height * s - self.radius * spin
        kinetic = (
            rate**2 / 2 * (self.mass * speed**2 + self.transverse * s**2 + self.axial * spin**2)
        )
        return float(
            kinetic + self.mass * GRAVITY * (self.radius * s + self.height * c - self.height)
        )

    def landing(self, tilt: float, spin: float, corners: int) -> np.ndarray:
        """Velocity (3,) [m/s] at which the next corner lands, to leading order in 1 / corners."""
        return np.cross(
            self.angular_velocity(tilt, spin), [0.0, 2 * self.radius * np.sin(np.pi / corners), 0.0]
        )

    def corner_loss(self, tilt: float, spin: float, corners: int) -> float:
        """Energy [J] of the plastic impact of one corner on the next, to leading order in 1 /
        corners.
        """
        s, c = np.sin(tilt), np.cos(tilt)
        axis = np.array([s, 0.0, c])
        inertia = self.transverse * np.eye(3) + (self.axial - self.transverse) * np.outer(
            axis, axis
        )
        lever = np.cross(np.eye(3), self.radius * np.array([c, 0.0, -s]) - self.height * axis)
        mobility = np.eye(3) / self.mass + lever @ np.linalg.solve(inertia, lever.T)
        landing = self.landing(tilt, spin, corners)
        return float(landing @ np.linalg.solve(mobility, landing) / 2)

    def polygon(self, tilt: float, spin: float, corners: int, seconds: float) -> np.ndarray:
        """Rolling on a regular polygon in the circle, from steady precession on a corner: (k, 3)
        time [s], energy above standing [J] and azimuth of the lean [rad] at the start, after each
        impact and after `seconds`.

        Between impacts the body turns about a corner that neither slips nor bounces; when the next
        one lands, the angular momentum about it is kept and the old one goes free.
        """
        angle = 2 * np.pi * np.arange(corners) / corners
        corner = np.stack(
            [
                self.radius * np.cos(angle),
                self.radius * np.sin(angle),
                np.full(corners, -self.height),
            ],
            axis=1,
        )
        centre = np.diag([self.transverse, self.transverse, self.axial])
        start = Rotation.from_rotvec([0.0, tilt, 0.0])
        # attitude, body's rates
        y = np.concatenate([start.as_quat(), start.inv().apply(self.angular_velocity(tilt, spin))])
        time, foot, path = 0.0, 0, []

        def down(y: np.ndarray) -> np.ndarray:
            return Rotation.from_quat(y[:4]).as_matrix()[2]

        def about(point: np.ndarray) -> np.ndarray:
            return centre + self.mass * (point @ point * np.eye(3) - np.outer(point, point))

        def turning(point: np.ndarray) -> Callable[[float, np.ndarray], np.ndarray]:
            inertia, inverse = about(point), np.linalg.inv(about(point))

            def rate(t: float, y: np.ndarray) -> np.ndarray:
                spin = y[4:]
                moment = self.mass * GRAVITY * np.cross(point, down(y))
                attitude = (np.append(y[3] * spin + np.cross(y[:3], spin), -y[:3] @ spin)) / 2
                return np.concatenate(
                    [attitude, inverse @ (moment - np.cross(spin, inertia @ spin))]
                )

            return rate

        def record() -> None:
            turn = Rotation.from_quat(y[:4]).as_matrix()
            kinetic = y[4:] @ about(corner[foot]) @ y[4:] / 2
            path.append(
                (
                    time,
                    kinetic - self.mass * GRAVITY * (turn[2] @ corner[foot] + self.height),
                    np.arctan2(turn[1, 2], turn[0, 2]),
                )
            )

        while True:
            record()
            neighbours = [(foot + 1) % corners, (foot - 1) % corners]
            events = [
                lambda t, y, edge=corner[n] - corner[foot]: down(y) @ edge for n in neighbours
            ]
            for event in events:
                event.terminal = True  # type: ignore[attr-defined]  # as solve_ivp asks for it
                event.direction = -1  # type: ignore[attr-defined]
            found = solve_ivp(
                turning(corner[foot]),
                (time, seconds),
                y,
                "DOP853",
                rtol=1e-10,
                atol=1e-13,
                events=events,
                first_step=1e-6,
            )
            time, y = found.t[-1], found.y[:, -1]
            if found.status != 1:
                record()
                return np.array(path)
            landed = neighbours[0 if len(found.t_events[0]) else 1]
            momentum = centre @ y[4:] + self.mass * np.cross(
                corner[landed], np.cross(y[4:], corner[foot])
            )
            y[4:], foot = np.linalg.solve(about(corner[landed]), momentum), landed
