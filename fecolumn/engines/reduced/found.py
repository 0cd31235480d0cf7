"""Contact that is found while bodies move: each pair of `contact.meetings` is an interface of the
step, and its places are contact points.

The meetings belong to the motion. A step begins with those of its start, looks for pairs that may
touch within it, and lays the points of each on the places where they may. A point that stays takes
along its force, its slip and its gap, also where another face or the other body carries from now
on. One that is found below the surface is lifted to it, and sinks back slowly.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fecolumn.contact.arrays import put, put_matrix
from fecolumn.contact.convex import Hulls
from fecolumn.contact.manifold import CORNER_OF_FIRST, CORNER_OF_SECOND
from fecolumn.contact.meet import Room, find_meetings
from fecolumn.contact.meetings import NO_PAIR, add_grounds, keep_rows
from fecolumn.contact.nearby import Boxes, find_boxes, find_pairs
from fecolumn.contact.points import FLAT_GROUND, GROUND
from fecolumn.contact.problem import NO_ROOM, OK, list_present
from fecolumn.contact.separation import FACE_OF_FIRST, TWO_EDGES
from fecolumn.contact.tolerances import FOUND_NEAR, OPEN, SAME_PLACE, STAYS_DEEP
from fecolumn.engines.reduced.motion import copy_meetings
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.meetings import Meetings
    from fecolumn.engines.reduced.motion import MotionState


class Found(NamedTuple):
    """What is known of contact that is found, for nb bodies and G grounds.

    hulls: of all bodies, none of one that is left out. nodes: (V,) the node of each corner among
    those of all bodies. interface, point: the first of its interfaces and points in the structure.
    left_out: keys of pairs, see `nearby.pair_keys`. friction, restitution: (nb + G, nb) of a pair,
    the first a body or, after all bodies, a ground. joint: (nb + G, nb) the joint between the two,
    in whose place the pair is, or -1; replaced: (ni,) mask of these joints. axes: (G, 3, 3) of the
    grounds. reach: (nb,) as of INTERFACE. boxes, pairs, room: of the search.
    """

    hulls: Hulls
    nodes: Array
    interface: int
    point: int
    left_out: Array
    friction: Array
    restitution: Array
    joint: Array
    replaced: Array
    axes: Array
    reach: Array
    boxes: Boxes
    pairs: Array
    room: Room


@njit
def lay_found(structure: Any, dt: float, work: Any, start: MotionState, end: MotionState) -> int:
    """Find the pairs and places of a step dt [s] and lay its points on them: OK, or NO_ROOM where
    more pairs are near than there are rows.

    work.before, which has what the start brings, is changed; end gets the meetings and which
    interfaces have no points.
    """
    found, bodies = structure.found, len(start.frames)
    copy_meetings(start.meetings, end.meetings)
    if len(end.meetings.rows) == 0:
        return OK
    centers, margins = np.empty((bodies, 3)), np.empty(bodies)
    most, thinnest = _travel_bounds(structure, dt, start, margins)
    for b in range(bodies):
        for a in range(3):
            centers[b, a] = start.frames[b].center[a]
    places = np.empty((len(start.grounds), 3))
    for g in range(len(start.grounds)):
        for a in range(3):
            places[g, a] = start.grounds[g].place[a]
    find_boxes(found.hulls, centers, start.rotation, margins, found.boxes)
    count = find_pairs(found.hulls, found.boxes, found.left_out, found.pairs)
    count = add_grounds(found.hulls, found.boxes, places, found.axes, found.pairs, count)
    if count <= len(found.pairs):
        count = _without_held(structure, count)
    if count > len(found.pairs) or keep_rows(end.meetings, found.pairs[:count]) > 0:
        return NO_ROOM
    find_meetings(
        found.hulls,
        centers,
        start.rotation,
        places,
        found.axes,
        2 * most + FOUND_NEAR * thinnest,
        end.meetings,
        found.room,
    )
    changed = False
    for k in range(found.interface):
        if found.replaced[k]:
            end.rims[k].apart = True
    for r in range(len(end.meetings.rows)):
        changed |= _lay_row(structure, work, start, end, r)
    if changed:
        list_present(work.problem, work.points)
        # the operator is that of other points
        work.stick.key[1] = 0.0
    return OK


@njit
def _without_held(structure: Any, count: int) -> int:
    """Take the pairs of a ground and a body that a ground holds from the first `count`, which are
    not to be pushed apart; how many are left.
    """
    pairs, left = structure.found.pairs, 0
    for k in range(count):
        if pairs[k, 0] < 0 and structure.bodies.body[pairs[k, 1]].held >= 0:
            continue
        pairs[left, 0], pairs[left, 1] = pairs[k, 0], pairs[k, 1]
        left += 1
    return left


@njit
def has_pairs(meetings: Meetings) -> bool:
    """Whether any two bodies are near each other."""
    for row in meetings.rows:
        if row.pair[0] != NO_PAIR:
            return True
    return False


@njit
def _travel_bounds(
    structure: Any, dt: float, start: MotionState, margins: Array
) -> tuple[float, float]:
    """Find how far each body may go in a step, margins (nb,) [m] with half of the distance at
    which places are found; the longest way and the least thickness [m].
    """
    hulls, g, most, thinnest = structure.found.hulls, structure.gravity, 0.0, np.inf
    fall = dt * dt * np.sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2])
    for b in range(len(margins)):
        if hulls.first[b + 1, 0] == hulls.first[b, 0]:
            margins[b] = 0.0
            continue
        v, w, radius = start.frames[b].velocity, start.frames[b].spin, 0.0
        for a in range(3):
            radius += (abs(hulls.middle[b, a]) + hulls.half[b, a]) ** 2
        speed = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        turn = np.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
        margins[b] = dt * (speed + turn * np.sqrt(radius)) + fall
        most, thinnest = max(most, margins[b]), min(thinnest, hulls.thickness[b])
    for b in range(len(margins)):
        margins[b] += FOUND_NEAR * thinnest / 2
    return most, thinnest


@njit
def _lay_row(structure: Any, work: Any, start: MotionState, end: MotionState, r: int) -> bool:
    """Lay the points of a row; whether others take part than before, or in other places."""
    found, row, slots = structure.found, end.meetings.rows[r], end.meetings.places.shape[1]
    k, changed, any_place = found.interface + r, False, False
    if row.pair[0] != NO_PAIR:
        set_interface(structure, row, k)
        if row.pair[0] < 0:
            # of a body the frame is found along with its motion
            put_matrix(found.axes[-1 - row.pair[0]], work.action.frames[k])
    for s in range(slots):
        i, place = found.point + slots * r + s, end.meetings.places[r, s]
        point, now = work.points[i], work.before[i]
        if place.name == 0:
            changed |= not point.idle
            point.idle = True
            for a in range(3):
                now.force[a] = 0.0
            now.located = now.beyond = now.present = False
            continue
        any_place = True
        changed |= _lay_point(structure, row, place, k, point)
        _transfer_contact_state(
            start, end, r, s, structure.interfaces[k].width, start.contact[i], now
        )
        point.lift = place.lift
    end.rims[k].apart = not any_place
    return changed


@njit
def _place_of(found: Found, first: int) -> int:
    """Row, in tables of Found by pair, of the first of a pair: a body, or one of the grounds, which
    are -1, -2, ... and come after all bodies.
    """
    return first if first >= 0 else len(found.reach) - 1 - first


@njit
def set_interface(structure: Any, row: Record, k: int) -> None:
    """Let interface k be that of a row of MEETING."""
    interface, found = structure.interfaces[k], structure.found
    first, second = row.pair[0], row.pair[1]
    interface.slave, interface.master = second, GROUND
    interface.ground, interface.width = 0, found.hulls.thickness[second]
    if first < 0:
        interface.ground = -1 - first
    else:
        interface.slave, interface.master = row.slave, row.master
        interface.width = min(interface.width, found.hulls.thickness[first])
        interface.reach = found.reach[max(row.master, 0)]
    interface.restitution = found.restitution[_place_of(found, first), second]
    for a in range(3):
        interface.origin[a] = row.origin[a]
        for c in range(3):
            interface.axes[a, c] = row.axes[a, c]


@njit
def _lay_point(structure: Any, row: Record, place: Record, k: int, point: Record) -> bool:
    """Lay a point of interface k on a place; whether it took no part or was elsewhere before."""
    found, interface = structure.found, structure.interfaces[k]
    moved = 0.0
    for a in range(3):
        moved = max(moved, abs(point.arm[a] - place.arm[a]))
    changed = point.idle or point.slave != interface.slave or point.master != interface.master
    changed |= moved > SAME_PLACE * interface.width
    point.idle, point.rolls = False, False
    point.slave, point.master, point.ground = interface.slave, interface.master, interface.ground
    point.friction = found.friction[_place_of(found, row.pair[0]), row.pair[1]]
    put(place.arm, point.arm)
    for q in range(4):
        point.weights[q] = point.shares[q] = 0.0
    kind = place.name >> 48
    own = CORNER_OF_FIRST if row.slave == row.pair[0] else CORNER_OF_SECOND
    corners = found.hulls.first[row.slave, 0]
    if kind == own:
        point.count = 1
        corner = (place.name >> 24) & (2**24 - 1)
        for q in range(4):
            point.carriers[q] = found.nodes[corners + corner]
        point.weights[0] = 1.0
    elif row.kind == TWO_EDGES:
        point.count = 2
        _share_edge(found, row.slave, row.feature[1], place.arm, point.carriers, point.weights)
    else:
        point.count = 3
        _share_face(found, row.slave, row.facing, place.arm, point.carriers, point.weights)
    point.node = point.carriers[0]
    if interface.master == GROUND:
        point.facet = FLAT_GROUND
    else:
        point.facet = 0
        if row.kind == TWO_EDGES:
            _share_edge(found, row.master, row.feature[0], place.seat, point.below, point.shares)
        else:
            face = row.feature[0] if row.kind == FACE_OF_FIRST else row.feature[1]
            _share_face(found, row.master, face, place.seat, point.below, point.shares)
        put(place.seat, point.seat)
    return changed


@njit
def _share_edge(found: Found, b: int, edge: int, place: Array, nodes: Array, shares: Array) -> None:
    """Nodes (4,) at the ends of an edge of body b, and their shares (4,) in a place (3,) on it."""
    hulls = found.hulls
    first, e, along, length = hulls.first[b, 0], hulls.first[b, 2] + edge, 0.0, 0.0
    p, q = hulls.corners[first + hulls.ends[e, 0]], hulls.corners[first + hulls.ends[e, 1]]
    for a in range(3):
        along += (place[a] - p[a]) * (q[a] - p[a])
        length += (q[a] - p[a]) ** 2
    nodes[0], nodes[1] = (
        found.nodes[first + hulls.ends[e, 0]],
        found.nodes[first + hulls.ends[e, 1]],
    )
    nodes[2] = nodes[3] = nodes[0]
    shares[1] = along / length
    shares[0] = 1 - shares[1]
    shares[2] = shares[3] = 0.0


@njit
def _share_face(found: Found, b: int, face: int, place: Array, nodes: Array, shares: Array) -> None:
    """Nodes (4,) at three corners of a face of body b, and their shares (4,) in a place (3,) on it:
    of the triangle about the first corner in which the place is, or lacks least.
    """
    hulls, first, f, best = found.hulls, found.hulls.first[b, 0], found.hulls.first[b, 1] + face, 0
    start, n, most, one, other = hulls.loop_first[f], hulls.normals[f], -np.inf, 0.0, 0.0
    o = hulls.corners[first + hulls.loop[start]]
    for k in range(start + 1, hulls.loop_first[f + 1] - 1):
        p, q = hulls.corners[first + hulls.loop[k]], hulls.corners[first + hulls.loop[k + 1]]
        whole = second = third = 0.0
        for a in range(3):
            c, d = (a + 1) % 3, (a + 2) % 3
            pc, pd, qc, qd = p[c] - o[c], p[d] - o[d], q[c] - o[c], q[d] - o[d]
            xc, xd = place[c] - o[c], place[d] - o[d]
            whole += n[a] * (pc * qd - pd * qc)
            second += n[a] * (xc * qd - xd * qc)
            third += n[a] * (pc * xd - pd * xc)
        second, third = second / whole, third / whole
        least = min(second, third, 1 - second - third)
        if least > most:
            best, most, one, other = k, least, second, third
    nodes[0] = nodes[3] = found.nodes[first + hulls.loop[start]]
    nodes[1] = found.nodes[first + hulls.loop[best]]
    nodes[2] = found.nodes[first + hulls.loop[best + 1]]
    shares[0], shares[1], shares[2], shares[3] = 1 - one - other, one, other, 0.0


@njit
def _transfer_contact_state(
    start: MotionState, end: MotionState, r: int, s: int, width: float, was: Record, now: Record
) -> None:
    """Bring to the place in slot s of row r what its point carried at the start, `was` of CONTACT:
    `now` has it in the frame that the row has now.

    Gap and slip stay, which are those of the place before and of what bodies give. Where the place
    is deeper now than it was there, it is lifted by as much.
    """
    row_was, row = start.meetings.rows[r], end.meetings.rows[r]
    place_was, place = start.meetings.places[r, s], end.meetings.places[r, s]
    if place.fresh or not was.present:
        for a in range(3):
            now.force[a] = 0.0
        now.located = now.beyond = False
        # above the surface, as one that is found there has landed when it carries
        above = 2 * OPEN * width
        place.lift = above - place.gap if place.gap < -above else 0.0
    else:
        frame_was, frame = np.empty((3, 3)), np.empty((3, 3))
        before, after = np.empty(3), np.empty(3)
        _place_in(start, row_was, was.arm, frame_was, before)
        _place_in(start, row, place.arm, frame, after)
        sign = 1.0 if row.slave == row_was.slave else -1.0
        slip = np.empty(3)
        slip[0], slip[1] = was.relative[0] - was.anchor[0], was.relative[1] - was.anchor[1]
        for a in range(3):
            force = give = slid = 0.0
            for c in range(3):
                turn = 0.0
                for e in range(3):
                    turn += sign * frame[e, a] * frame_was[e, c]
                force += turn * was.force[c]
                give += turn * (was.relative[c] - before[c])
                slid += turn * slip[c] if c < 2 else 0.0
            now.force[a] = force
            if a < 2:
                now.relative[a] = after[a] + give
                now.anchor[a] = now.relative[a] - slid
        gap = was.relative[2] - place_was.lift + after[2] - before[2]
        if now.force[2] > 0.0:
            place.lift = max(0.0, STAYS_DEEP * place_was.lift + before[2] - after[2])
        else:
            for a in range(3):
                now.force[a] = 0.0
            # above the surface it keeps no more than its lift, whatever the bodies bend by
            high = min(-place.gap, place_was.lift + before[2] - after[2])
            place.lift = max(0.0, -gap if was.located else high)
        now.relative[2], now.beyond = gap + place.lift, False
    now.present = True
    put(place.arm, now.arm)


@njit
def _place_in(motion: MotionState, row: Record, arm: Array, frame: Array, place: Array) -> None:
    """Frame (3, 3) of a row in the table frame, and the place (3,) [m] of an arm of its slave in
    it, of bodies that do not deform.
    """
    R, center, m = motion.rotation[row.slave], motion.frames[row.slave].center, row.master
    way = np.empty(3)
    for a in range(3):
        way[a] = center[a] + R[a, 0] * arm[0] + R[a, 1] * arm[1] + R[a, 2] * arm[2]
        if m < 0:
            way[a] -= motion.grounds[-1 - row.pair[0]].place[a]
        else:
            M, origin = motion.rotation[m], row.origin
            way[a] -= motion.frames[m].center[a]
            way[a] -= M[a, 0] * origin[0] + M[a, 1] * origin[1] + M[a, 2] * origin[2]
        for c in range(3):
            frame[a, c] = row.axes[a, c]
            if m >= 0:
                M = motion.rotation[m]
                frame[a, c] = (
                    M[a, 0] * row.axes[0, c] + M[a, 1] * row.axes[1, c] + M[a, 2] * row.axes[2, c]
                )
    for c in range(3):
        place[c] = frame[0, c] * way[0] + frame[1, c] * way[1] + frame[2, c] * way[2]
