"""Rolling on a round rim: where its contact points are in a step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

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
