"""The region in which both faces of a joint overlap, and its corners.

A joint of two plane faces carries on the region where they overlap. What a body pivots on is a
corner of that region: a corner of the slave's face over the master's, a corner of the master's face
under the slave's, or a place where an edge of one crosses an edge of the other. Outlines are
polygons, convex or not, or circles. Places on a face are coordinates (2,) [m] along the two
tangents of its own frame; the slave's face is OWN, the master's OTHER.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.record import record
from fecolumn.contact.tolerances import CROSSES_FROM, ONE_CORNER, OUTLINE_BAND, SAME_OUTLINE
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

OWN, OTHER = range(2)

#: A straight side of an outline, counter-clockwise seen along the outward normal of the face.
#: start, end: (2,) its corners [m]; along, normal: (2,) unit vectors, the normal out of the
#: outline; length [m]. inner: (2, 2) both corners of the outline that is smaller by CROSSES_FROM of
#: SAME_OUTLINE, so that two equal faces in one place have one outline, not two. first, count: its
#: nodes among those of `Overlaps.nodes`. far: node farthest from it, `far_place` (2,) along it and
#: inwards [m].
SIDE = record(
    ("start", "f8", 2),
    ("end", "f8", 2),
    ("along", "f8", 2),
    ("normal", "f8", 2),
    ("length", "f8"),
    ("inner", "f8", (2, 2)),
    ("first", "i8"),
    ("count", "i8"),
    ("far", "i8"),
    ("far_place", "f8", 2),
)

#: A node on a side: row among the nodes of all bodies, place `at` along the side [m].
SIDE_NODE = record(("node", "i8"), ("at", "f8"))

#: A joint of two sides. forward: interface whose slave has the face OWN; reverse: the interface
#: with the roles exchanged. first, count: (2,) sides of OWN and OTHER, none of a circle; center:
#: (2, 2), radius: (2,) [m] of the circles, 0 of a polygon. convex: (2,) 1 of a convex outline.
#: slot, slots: first of its slots and their number. size: larger side of OWN [m]. arm: (2,)
#: of the farthest corner of each face from the centre of mass of its body [m]. within: whether the
#: outline of OWN lies within that of OTHER at the start of the step; plain: whether the points are
#: laid as for such a one; left: whether no point takes part, as the faces were apart when they were
#: laid last.
OVERLAP = record(
    ("forward", "i8"),
    ("reverse", "i8"),
    ("first", "i8", 2),
    ("count", "i8", 2),
    ("center", "f8", (2, 2)),
    ("radius", "f8", 2),
    ("convex", "i8", 2),
    ("slot", "i8"),
    ("slots", "i8"),
    ("size", "f8"),
    ("arm", "f8", 2),
    ("within", "?"),
    ("plain", "?"),
    ("left", "?"),
)

#: A place of contact that may be a point of the slave, `forward`, or a point of the master,
#: `reverse`, -1 where it cannot be. side: side of OWN on which its node lies, -1 of a node inside
#: and of a corner of the region; corner: whether the node is the first corner of that side; place:
#: (2,) of the node on OWN [m].
SLOT = record(
    ("forward", "i8"),
    ("reverse", "i8"),
    ("side", "i8"),
    ("corner", "?"),
    ("free", "?"),
    ("place", "f8", 2),
)


class Overlaps(NamedTuple):
    """Joints of two sides: of OVERLAP, SIDE, SIDE_NODE and SLOT."""

    joints: Array
    sides: Array
    nodes: Array
    slots: Array


def no_overlaps() -> Overlaps:
    """No joint of two sides, as of a single foot on the base."""
    return Overlaps(
        np.zeros(0, OVERLAP), np.zeros(0, SIDE), np.zeros(0, SIDE_NODE), np.zeros(0, SLOT)
    )


@njit
def map_between(
    interface: Record, other: Record, frames: Array, pose: Record, slope: Array, shift: Array
) -> None:
    """Find slope (3, 2) and shift (3,) [m]: a place p of the slave's face is at slope p + shift in
    the frame of the interface. other: the interface with the roles exchanged, whose master's
    surface that face is.
    """
    axes, origin, center = other.axes, other.origin, frames[interface.slave].center
    turned, Q = pose.turned[0], pose.frame
    for a in range(3):
        shift[a] = 0.0
        for c in range(3):
            shift[a] += turned[a, c] * origin[c] + Q[c, a] * (center[c] - pose.origin[c])
        for t in range(2):
            slope[a, t] = (
                turned[a, 0] * axes[0, t] + turned[a, 1] * axes[1, t] + turned[a, 2] * axes[2, t]
            )


@njit
def beyond(overlap: Record, sides: Array, which: int, x: float, y: float) -> tuple[float, int]:
    """How far [m] a place on a face is beyond the outline OWN or OTHER, below 0 within it, and the
    side that it is most beyond, -1 of a circle.
    """
    if overlap.radius[which] > 0.0:
        return np.hypot(
            x - overlap.center[which, 0], y - overlap.center[which, 1]
        ) - overlap.radius[which], -1
    if not overlap.convex[which]:
        first = overlap.first[which]
        return _beyond_any(sides[first : first + overlap.count[which]], first, False, x, y)
    most, side = -np.inf, -1
    for q in range(overlap.first[which], overlap.first[which] + overlap.count[which]):
        out = sides[q].normal[0] * (x - sides[q].start[0]) + sides[q].normal[1] * (
            y - sides[q].start[1]
        )
        if out > most:
            most, side = out, q
    return most, side


@njit
def _beyond_any(sides: Array, first: int, inner: bool, x: float, y: float) -> tuple[float, int]:
    """Signed distance [m] of a place x, y from a polygon of sides (n,), positive outside, and the
    nearest side, counted from `first`; the polygon need not be convex.

    inner: of the smaller outline, whose ends are `inner` of each side. Beyond a corner both sides
    are equally near: the larger distance from their lines counts, as for a convex outline.
    """
    least, farther, nearest, inside = np.inf, 0.0, -1, False
    for q in range(len(sides)):
        side = sides[q]
        if inner:
            x0, y0, x1, y1 = side.inner[0, 0], side.inner[0, 1], side.inner[1, 0], side.inner[1, 1]
        else:
            x0, y0, x1, y1 = side.start[0], side.start[1], side.end[0], side.end[1]
        at = (x - x0) * side.along[0] + (y - y0) * side.along[1]
        out = (x - x0) * side.normal[0] + (y - y0) * side.normal[1]
        length = (x1 - x0) * side.along[0] + (y1 - y0) * side.along[1]
        away = np.hypot(max(-at, at - length, 0.0), out)
        if nearest >= 0 and abs(away - least) <= 1e-6 * least:
            farther = max(farther, out)
        elif away < least:
            least, farther, nearest = away, out, q
        if (y0 > y) != (y1 > y) and x < x0 + (y - y0) / (y1 - y0) * (x1 - x0):
            inside = not inside
    return -least if inside else farther, first + nearest


@njit
def height_over(overlap: Record, sides: Array, slope: Array, shift: Array) -> float:
    """Least height [m] of the face OWN over the plane of OTHER; slope, shift: of `map_between`."""
    if overlap.radius[OWN] > 0.0:
        x, y = overlap.center[OWN, 0], overlap.center[OWN, 1]
        down = overlap.radius[OWN] * np.hypot(slope[2, 0], slope[2, 1])
        return slope[2, 0] * x + slope[2, 1] * y + shift[2] - down
    least = np.inf
    for q in range(overlap.first[OWN], overlap.first[OWN] + overlap.count[OWN]):
        x, y = sides[q].start[0], sides[q].start[1]
        least = min(least, slope[2, 0] * x + slope[2, 1] * y + shift[2])
    return least


@njit
def lies_within(overlap: Record, sides: Array, slope: Array, shift: Array) -> bool:
    """Whether the outline of OWN lies within that of OTHER, but for SAME_OUTLINE; slope, shift: of
    `map_between`.
    """
    if overlap.radius[OWN] > 0.0:
        x, y = _mapped(slope, shift, overlap.center[OWN, 0], overlap.center[OWN, 1])
        return (
            beyond(overlap, sides, OTHER, x, y)[0] + overlap.radius[OWN]
            <= SAME_OUTLINE * overlap.size
        )
    first, last = overlap.first[OTHER], overlap.first[OTHER] + overlap.count[OTHER]
    for q in range(overlap.first[OWN], overlap.first[OWN] + overlap.count[OWN]):
        x, y = _mapped(slope, shift, sides[q].inner[0, 0], sides[q].inner[0, 1])
        if beyond(overlap, sides, OTHER, x, y)[0] > 0.0:
            return False
        if not overlap.convex[OTHER]:
            # corners within an outline with notches do not tell that the side between them is
            u, v = _mapped(slope, shift, sides[q].inner[1, 0], sides[q].inner[1, 1])
            for e in range(first, last):
                if 0.0 <= _crossing(sides[e], x, y, u, v, 0.0) <= 1.0:
                    return False
    return True


@njit
def find_corners(
    overlap: Record,
    sides: Array,
    slope: Array,
    shift: Array,
    back: Array,
    back_shift: Array,
    own: Array,
    other: Array,
    on: Array,
) -> int:
    """Find the corners of the region that are no corners of OWN: their number.

    Parameters
    ----------
    slope, shift
        from OWN to OTHER
    back, back_shift
        from OTHER to OWN, of `map_between`.
    own, other
        (n, 2) get the corner's place on either face [m].
    on
        (n, 2) gets the sides of OWN and OTHER on which it lies, -1 of a circle or of none.
    """
    count, center, radius = 0, overlap.center, overlap.radius
    first, last = overlap.first, overlap.first + overlap.count
    inner_radius = radius[OWN] - CROSSES_FROM * SAME_OUTLINE * overlap.size
    if radius[OWN] > 0.0 and radius[OTHER] > 0.0:
        x, y = _mapped(slope, shift, center[OWN, 0], center[OWN, 1])
        dx, dy = center[OTHER, 0] - x, center[OTHER, 1] - y
        apart = np.hypot(dx, dy)
        if apart + radius[OWN] - radius[OTHER] <= OUTLINE_BAND * overlap.size:
            return 0
        ahead = (apart**2 + inner_radius**2 - radius[OTHER] ** 2) / (2 * apart)
        if abs(ahead) >= inner_radius:
            return 0
        across = np.sqrt(inner_radius**2 - ahead**2)
        for sign in range(-1, 2, 2):
            px = x + (ahead * dx - sign * across * dy) / apart
            py = y + (ahead * dy + sign * across * dx) / apart
            count = _add(back, back_shift, px, py, -1, -1, own, other, on, count)
        return count
    if radius[OWN] > 0.0:
        x, y = _mapped(slope, shift, center[OWN, 0], center[OWN, 1])
        for q in range(first[OTHER], last[OTHER]):
            low, high = _cut(
                sides[q].start[0],
                sides[q].start[1],
                sides[q].along[0],
                sides[q].along[1],
                x,
                y,
                inner_radius,
            )
            for end in range(2):
                at = high if end else low
                if 0.0 <= at <= sides[q].length:
                    px, py = (
                        sides[q].start[0] + at * sides[q].along[0],
                        sides[q].start[1] + at * sides[q].along[1],
                    )
                    count = _add(back, back_shift, px, py, -1, q, own, other, on, count)
            if np.hypot(sides[q].start[0] - x, sides[q].start[1] - y) < inner_radius:
                px, py = sides[q].start[0], sides[q].start[1]
                count = _add(back, back_shift, px, py, -1, q, own, other, on, count)
        return count
    for q in range(first[OWN], last[OWN]):
        x0, y0 = _mapped(slope, shift, sides[q].inner[0, 0], sides[q].inner[0, 1])
        x1, y1 = _mapped(slope, shift, sides[q].inner[1, 0], sides[q].inner[1, 1])
        if radius[OTHER] > 0.0:
            low, high = _cut(
                x0, y0, x1 - x0, y1 - y0, center[OTHER, 0], center[OTHER, 1], radius[OTHER]
            )
            begins, ends = (-1, -1) if low < high else (-2, -2)
            begins, ends = (-2 if low <= 0.0 else begins), (-2 if high >= 1.0 else ends)
        elif overlap.convex[OTHER]:
            low, high, begins, ends = _clip(sides, first[OTHER], last[OTHER], x0, y0, x1, y1)
        else:
            low, high, begins, ends = _clip_any(overlap, sides, x0, y0, x1, y1)
        if not low < high or low >= 1.0 or high <= 0.0:
            continue
        for end in range(2):
            at, met = (high, ends) if end else (low, begins)
            if met != -2:
                count = _add_crossing(
                    overlap, sides, slope, shift, q, at, met, own, other, on, count
                )
    if radius[OTHER] > 0.0:
        return count
    for q in range(first[OTHER], last[OTHER]):
        x, y = _mapped(back, back_shift, sides[q].start[0], sides[q].start[1])
        inside, most, nearest = True, -np.inf, -1
        if not overlap.convex[OWN]:
            most, nearest = _beyond_any(sides[first[OWN] : last[OWN]], first[OWN], True, x, y)
            inside = most < 0.0
        for e in range(first[OWN], last[OWN] if overlap.convex[OWN] else first[OWN]):
            out = sides[e].normal[0] * (x - sides[e].inner[0, 0]) + sides[e].normal[1] * (
                y - sides[e].inner[0, 1]
            )
            inside &= out < 0.0
            if out > most:
                most, nearest = out, e
        if inside:
            own[count, 0], own[count, 1] = x, y
            other[count, 0], other[count, 1] = sides[q].start[0], sides[q].start[1]
            on[count, OWN], on[count, OTHER] = nearest, q
            count += _is_new(other, count, overlap.size)
    return count


@njit
def _mapped(slope: Array, shift: Array, x: float, y: float) -> tuple[float, float]:
    """First two coordinates of a place in the other frame."""
    return slope[0, 0] * x + slope[0, 1] * y + shift[0], slope[1, 0] * x + slope[1, 1] * y + shift[
        1
    ]


@njit
def _cut(
    x: float, y: float, u: float, v: float, cx: float, cy: float, radius: float
) -> tuple[float, float]:
    """Where the line (x, y) + s (u, v) enters and leaves a circle, in s; an empty way where it
    misses it.
    """
    square, half = u * u + v * v, (x - cx) * u + (y - cy) * v
    root = half * half - square * ((x - cx) ** 2 + (y - cy) ** 2 - radius**2)
    if root <= 0.0:
        return np.inf, -np.inf
    return (-half - np.sqrt(root)) / square, (-half + np.sqrt(root)) / square


@njit
def _clip(
    sides: Array, first: int, last: int, x0: float, y0: float, x1: float, y1: float
) -> tuple[float, float, int, int]:
    """Clip the way from a place to another one to a polygon (Cyrus and Beck 1978).

    Returns: low, high: fractions of the way, from 0 to 1, between which it is within the polygon;
    begins, ends: sides of the polygon at which it comes in and goes out, -2 where it does neither,
    as its own end is within.
    """
    low, high, begins, ends = 0.0, 1.0, -2, -2
    for q in range(first, last):
        d0 = sides[q].normal[0] * (x0 - sides[q].start[0]) + sides[q].normal[1] * (
            y0 - sides[q].start[1]
        )
        d1 = sides[q].normal[0] * (x1 - sides[q].start[0]) + sides[q].normal[1] * (
            y1 - sides[q].start[1]
        )
        if d0 > 0.0 and d1 > 0.0:
            return 1.0, 0.0, -2, -2
        if d0 > 0.0 and d0 / (d0 - d1) > low:
            low, begins = d0 / (d0 - d1), q
        if d1 > 0.0 and d0 / (d0 - d1) < high:
            high, ends = d0 / (d0 - d1), q
    return low, high, begins, ends


@njit
def _crossing(side: Record, x0: float, y0: float, x1: float, y1: float, slack: float) -> float:
    """Share of the way from one place to another at which it crosses a side, which is longer by
    `slack` [m] at both ends; nan where it does not.
    """
    d0 = side.normal[0] * (x0 - side.start[0]) + side.normal[1] * (y0 - side.start[1])
    d1 = side.normal[0] * (x1 - side.start[0]) + side.normal[1] * (y1 - side.start[1])
    if (d0 > 0.0) == (d1 > 0.0):
        return np.nan
    share = d0 / (d0 - d1)
    along = side.along[0] * (x0 + share * (x1 - x0) - side.start[0]) + side.along[1] * (
        y0 + share * (y1 - y0) - side.start[1]
    )
    return share if -slack <= along <= side.length + slack else np.nan


@njit
def _clip_any(
    overlap: Record, sides: Array, x0: float, y0: float, x1: float, y1: float
) -> tuple[float, float, int, int]:
    """As `_clip`, by the outline OTHER of any kind: from the first place on the way that is within
    it to the last one. What lies between two such places can be no corner of the region's hull.
    """
    begins, ends, low, high = -2, -2, 1.0, 0.0
    for q in range(overlap.first[OTHER], overlap.first[OTHER] + overlap.count[OTHER]):
        share = _crossing(sides[q], x0, y0, x1, y1, SAME_OUTLINE * overlap.size)
        if share < low or share <= low and begins < 0:
            low, begins = share, q
        if share > high or share >= high and ends < 0:
            high, ends = share, q
    if beyond(overlap, sides, OTHER, x0, y0)[0] <= 0.0:
        low, begins = 0.0, -2
    if beyond(overlap, sides, OTHER, x1, y1)[0] <= 0.0:
        high, ends = 1.0, -2
    return low, high, begins, ends


@njit
def _add(
    back: Array,
    back_shift: Array,
    x: float,
    y: float,
    own_side: int,
    other_side: int,
    own: Array,
    other: Array,
    on: Array,
    count: int,
) -> int:
    """Add the corner at a place x, y of OTHER: the number of corners then."""
    other[count, 0], other[count, 1] = x, y
    own[count, 0], own[count, 1] = _mapped(back, back_shift, x, y)
    on[count, OWN], on[count, OTHER] = own_side, other_side
    return count + 1


@njit
def _add_crossing(
    overlap: Record,
    sides: Array,
    slope: Array,
    shift: Array,
    q: int,
    at: float,
    met: int,
    own: Array,
    other: Array,
    on: Array,
    count: int,
) -> int:
    """Add the corner where side q of OWN, at the share `at` of it, crosses the side `met` of OTHER,
    -1 the circle.
    """
    side, size = sides[q], overlap.size
    own[count, 0] = side.start[0] + at * side.length * side.along[0]
    own[count, 1] = side.start[1] + at * side.length * side.along[1]
    x, y = _mapped(slope, shift, own[count, 0], own[count, 1])
    if met >= 0:
        crossed = sides[met]
        way = (x - crossed.start[0]) * crossed.along[0] + (y - crossed.start[1]) * crossed.along[1]
        way = min(max(way, 0.0), crossed.length)
        x, y = crossed.start[0] + way * crossed.along[0], crossed.start[1] + way * crossed.along[1]
    other[count, 0], other[count, 1] = x, y
    on[count, OWN], on[count, OTHER] = q, met
    return count + _is_new(other, count, size)


@njit
def _is_new(other: Array, count: int, size: float) -> int:
    """1 where the corner `count` is in the place of none before it, else 0."""
    for k in range(count):
        if (
            np.hypot(other[k, 0] - other[count, 0], other[k, 1] - other[count, 1])
            <= ONE_CORNER * size
        ):
            return 0
    return 1
