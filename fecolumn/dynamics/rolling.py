"""Rolling on a round rim: where its contact points are in a step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

# Tilt below which the points stay where they are on the rim: circle and polygon are then nanometres apart [rad]
FLAT = 1e-4
# Sectors: the lowest point may move by so many in a step and still be the contact that rolls on
REACH = 2


def rolled(system, state, dt: float):
    """The state with the contact points of the rim where they are in the step `dt` [s] that begins.

    The points turn with the lowest one of the circle. For a step they are those of the rotation halfway, lifted to the height
    at which steady rolling has them at both its ends. The lowest point's gap then changes by its displacement (a discrete gradient,
    Gonzalez 1996), those before and behind it do opposite work: rolling takes no energy up to dt^3. Where the points stick moves
    on by the length of rim rolled.

    Where the lowest point leaps, in a column that rocks over, they stay until the part of the rim that carried is free.
    """
    interface = system.interface
    rim = interface.rim
    if rim is None:
        return state
    angle, tilt = rim.lowest(system.kinematics.rotation(state.x + dt / 2 * state.v))
    last = rim.first if np.isnan(state.rim_angle) else state.rim_angle
    if tilt < FLAT:
        interface.place(None if np.isnan(state.rim_angle) else rim.points(last))
        return state

    n = len(rim.nodes)

    def sectors(number):
        return (number + n / 2) % n - n / 2

    old, new, like = rim.points(last), rim.points(angle), rim.points(rim.lowest(state.rotation)[0])
    turned = sectors((angle - last) / rim.sector)
    leaps = abs(turned) > REACH
    if leaps:
        carrying = np.flatnonzero(state.forces[rim.nodes, 2] > 0)
        beside = np.abs(sectors(carrying + old.phase - new.index - new.phase)) <= REACH
        if len(carrying) and not beside.any():
            interface.place(old)
            return state
        # a part of the rim that rested takes over: the nearest of its points goes to the lowest place
        turned -= round(turned)

    # by so many nodes the points' slots move
    passed = round(turned - new.phase + old.phase)
    numbers = np.roll(np.arange(n), passed)
    places = interface.node_positions(state.x, state.rotation)
    before, now = old.of(places), new.of(places)
    start = np.roll(like.of(places), new.index - like.index, axis=0)
    # only near the lowest point is a point the contact that its like was; at the step's end the height of the points
    # before it will be what that of the points behind it is now
    near = (new.index + np.arange(-REACH, REACH + 1)) % n
    lift = np.zeros(n)
    lift[near] = start[near, 2] - now[near[::-1], 2]

    slots, taken = rim.nodes, rim.nodes[numbers]
    forces, anchors, relative = state.forces.copy(), state.anchors.copy(), state.relative.copy()
    forces[slots], anchors[slots], relative[slots] = state.forces[taken], state.anchors[taken], state.relative[taken]
    shift = now - before[numbers]
    shift[near, 2] = (start - before[numbers])[near, 2] if leaps else 0.0
    anchors[slots] += shift[:, :2]
    relative[slots] += shift
    interface.place(new, lift)
    return replace(state, forces=forces, anchors=anchors, relative=relative, rim_angle=angle)
