"""Rolling on a round rim: where its contact points are in a step, and what resists."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fecolumn._compiled import njit
from fecolumn.fem.free_body import rigid_fields

# Tilt below which the points stay where they are on the rim: circle and polygon are then nanometres apart [rad]
FLAT = 1e-4
# The lowest point may move along the rim so far in a step and still be the contact that rolls on [rad]
ROLL = 0.8
# Points so many sectors before and behind the lowest one belong to the same contact
REACH = 2


def rolled(system, state, dt: float, rolls: bool = True):
    """The state with the contact points of the rim where they are in the step `dt` [s] that begins.

    The points turn with the lowest one of the circle. For a step they are those of the rotation halfway, lifted to the height
    at which steady rolling has them at both its ends. The lowest point's gap then changes by its displacement (a discrete gradient,
    Gonzalez 1996), those before and behind it do opposite work: rolling takes no energy up to dt^3, and what is left of
    the third order stays in the lift while the rim carries, so that it makes none either. Where the points stick moves on by the length
    of rim rolled.

    Where the lowest point leaps, in a column that rocks over, they stay until the part of the rim that carried is free;
    also where `rolls` is False.
    """
    interface, rim = system.interface, system.interface.rim
    if rim is None:
        return state
    n = len(rim.nodes)
    angle, tilt = rim.lowest(system.kinematics.rotation(state.x + dt / 2 * state.v))
    old = rim.points(rim.first if np.isnan(state.rim_angle) else state.rim_angle)
    new, like = rim.points(angle), rim.points(rim.lowest(state.rotation)[0])

    def sectors(number):
        return (number + n / 2) % n - n / 2

    turned = sectors((new.index + new.phase) - (old.index + old.phase))
    leaps = np.isnan(state.rim_angle) or abs(turned) * rim.sector > ROLL
    loaded = np.flatnonzero(state.forces[rim.nodes, 2] > 0)
    past = loaded + old.phase - (new.index + new.phase if leaps else old.index + old.phase)
    carrying = loaded[np.abs(sectors(past)) <= REACH]
    if tilt < FLAT or not rolls or leaps and len(loaded) and not len(carrying):
        # nothing stands on a point below the rim; one above it only carries less
        lift = np.maximum(state.rim_lift, 0.0) if tilt < FLAT else state.rim_lift
        interface.place(None if np.isnan(state.rim_angle) else old, _lifted(n, _near(old, n), lift))
        return replace(state, rim_lift=lift)
    if leaps:
        # a part of the rim that rested takes over: the nearest of its points goes to the lowest place
        turned -= round(turned)

    # by so many nodes the points' slots move
    passed = round(turned - new.phase + old.phase)
    numbers = (np.arange(n) - passed) % n
    places = interface.node_positions(state.x, state.rotation)
    before, now = old.of(places), new.of(places)
    start = np.roll(like.of(places), new.index - like.index, axis=0)
    # only near the lowest point is a point the contact that its like was; at the step's end the height of the points
    # before it will be what that of the points behind it is now
    near, lowest = _near(new, n), new.index
    lift = start[near, 2] - now[near[::-1], 2]
    if leaps and len(carrying):
        strongest = carrying[np.argmax(state.forces[rim.nodes[carrying], 2])]
        lift += before[strongest, 2] - start[lowest, 2]
    elif len(carrying):
        lift += before[numbers[lowest], 2] + state.rim_lift[REACH] - start[lowest, 2]

    slots, taken = rim.nodes, rim.nodes[numbers]
    forces, anchors, relative = state.forces.copy(), state.anchors.copy(), state.relative.copy()
    indent = state.indent.copy()
    forces[slots], anchors[slots], relative[slots] = state.forces[taken], state.anchors[taken], state.relative[taken]
    indent[slots] = state.indent[taken]
    shift = now - before[numbers]
    shift[near, 2] = (start - before[numbers])[near, 2] if leaps else 0.0
    anchors[slots] += shift[:, :2]
    relative[slots] += shift
    interface.place(new, _lifted(n, near, lift))
    return replace(state, forces=forces, anchors=anchors, relative=relative, indent=indent, rim_angle=angle, rim_lift=lift)


def _near(points, n: int) -> np.ndarray:
    """Numbers of the points within reach of the one asked for, in order."""
    return (points.index + np.arange(-REACH, REACH + 1)) % n


def _lifted(n: int, near: np.ndarray, lift) -> np.ndarray:
    """Lift (n,) of all points from that of the near ones."""
    lifts = np.zeros(n)
    lifts[near] = lift
    return lifts


@njit
def rolling_moment(rotation, spin, load, radius, coefficient, inverse, dt):
    """Moment (3,) [N m] in the column's frame by which a rim resists to roll: it takes coefficient * load per length rolled.

    With d the way down seen from the column and s its part along the foot's plane, the lowest point runs along the rim by the angle a.w dt, w the
    spin and a = (dz dx / s^2, dz dy / s^2, -1). The moment is -coefficient load radius sign(a.w) a: to first order a load that acts
    coefficient radius / s ahead of the lowest point, at most the radius. It does not turn the rolling round within the step.

    Args:
        rotation: (3, 3) column to table. spin: (3,) in the column's frame [rad/s]. load: normal contact force [N]. radius: of the rim [m].
        inverse: (3, 3) of the inertia about the centre of mass [1/(kg m2)].
    """
    moment, x, y, z = np.zeros(3), -rotation[2, 0], -rotation[2, 1], -rotation[2, 2]
    sine = np.hypot(x, y)
    if sine < FLAT or load <= 0.0:
        return moment
    along = np.array([z * x / sine**2, z * y / sine**2, -1.0])
    rate = along[0] * spin[0] + along[1] * spin[1] + along[2] * spin[2]
    yielding = 0.0
    for a in range(3):
        for b in range(3):
            yielding += along[a] * inverse[a, b] * along[b]
    size = min(min(coefficient, sine) * load * radius, abs(rate) / (yielding * dt))
    for a in range(3):
        moment[a] = -size * np.sign(rate) * along[a]
    return moment


class Resistance:
    """Rolling resistance of the rim of a body in full order: a moment on its rigid motion, which strains nothing.

    Args:
        body: Body. rim: Rim of its foot. coefficient: energy lost per length rolled over the contact force [-].
    """

    def __init__(self, body, rim, coefficient: float):
        self._body, self._rim, self._coefficient = body, rim, coefficient
        fields, momentum, masses = rigid_fields(body)
        self._turns, self._momenta, self._inverse = fields[:, 3:], momentum[:, 3:], np.linalg.inv(masses[3:, 3:])

    def acceleration(self, state, dt: float) -> np.ndarray:
        """Acceleration (n_owned, 3) [m/s2] in a step of `dt` [s] from a state."""
        spin = self._inverse @ self._body.sum(self._momenta.T @ (state.v @ state.rotation).ravel())
        moment = rolling_moment(state.rotation, spin, state.forces[:, 2].sum(), self._rim.radius, self._coefficient, self._inverse, dt)
        return (self._turns @ (self._inverse @ moment)).reshape(-1, 3) @ state.rotation.T
