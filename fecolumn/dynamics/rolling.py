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
    that their like have at its start: the gap's change is then the points' displacement, so that force and gap stay conjugate and
    rolling takes no energy up to dt^3 (a discrete gradient, Gonzalez 1996). Where they stick moves on by the length of rim rolled.

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

    turn = (angle - last + np.pi) % (2 * np.pi) - np.pi
    carrying = np.flatnonzero(state.forces[rim.nodes, 2] > 0)
    sectors = (rim.first + carrying * rim.sector - angle) / rim.sector
    n = len(rim.nodes)
    beside = np.abs((sectors + n / 2) % n - n / 2).min(initial=n) <= REACH
    leaps = abs(turn) > REACH * rim.sector
    if leaps and len(carrying) and not beside:
        interface.place(rim.points(last))
        return state
    if leaps:
        # a part of the rim that rested takes over: the nearest of its points goes to the lowest place
        turn = (turn / rim.sector + 0.5) % 1 * rim.sector - rim.sector / 2

    places = interface.node_positions(state.x, state.rotation)
    old, new = rim.points(last), rim.points(last + turn)
    numbers = np.roll(np.arange(n), new.index - old.index)
    before, now = old.of(places), new.of(places)
    like = rim.points(last + turn + rim.lowest(state.rotation)[0] - angle)
    start = np.roll(like.of(places), new.index - like.index, axis=0)
    lift = start[:, 2] - now[:, 2]
    # only near the lowest point is a point the contact that its like was
    near = np.abs((np.arange(n) - new.index + n // 2) % n - n // 2) <= REACH
    lift[~near] = 0.0

    slots, taken = rim.nodes, rim.nodes[numbers]
    forces, anchors, relative = state.forces.copy(), state.anchors.copy(), state.relative.copy()
    forces[slots], anchors[slots], relative[slots] = state.forces[taken], state.anchors[taken], state.relative[taken]
    shift = now - before[numbers]
    shift[:, 2] = np.where(near & ~leaps, 0.0, shift[:, 2] + lift)
    anchors[slots] += shift[:, :2]
    relative[slots] += shift
    interface.place(new, lift)
    return replace(state, forces=forces, anchors=anchors, relative=relative, rim_angle=last + turn)
