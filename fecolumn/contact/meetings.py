"""Contact that is found: for each step, pairs of convex bodies that are near, or a body and a plane
ground, and the places at which they may touch.

In a step::

    find_boxes(hulls, centers, rotations, margins, boxes)
    found = find_pairs(hulls, boxes, left_out, pairs)
    found = add_grounds(hulls, boxes, ground_places, ground_axes, pairs, found)
    # where found > len(pairs), or a row is missing: `meetings_for` more rows has to be asked
    missing = keep_rows(meetings, pairs[:found])
    changed = find_meetings(
        hulls, centers, rotations, ground_places, ground_axes, reach, meetings, room
    )

A row of `Meetings` is a pair, and stays its row as long as the pair is near; a slot of a row is a
place, and stays its slot as long as the place is known again, by its name, or else by where it is
on the first body. So what a contact carries from step to step needs no search: contact points may
be numbered `row * slots + slot`, those without a name take no part.

A row is an interface of that step: `master`, `slave`, `origin` and `axes` are what an INTERFACE
has, fixed in the master's frame. Of two edges the first tangent is the edge of the master and the
normal changes as the slave turns. Where the axis is of another face or other edges than in the step
before, `exchanged` says so; frame_before then has the axes of the step before in the table frame,
to turn forces by, which change sign where another body is the master now, `master_before`.

While bodies have moved against each other by less than OTHER_AXIS / 4 since all axes were looked
at, theirs is still good enough: a pair that rests costs one axis, as one that is apart.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.convex import TOGETHER
from fecolumn.contact.record import record
from fecolumn.contact.separation import NO_AXIS
from fecolumn.foundation._compiled import interpreted, njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.convex import Hulls
    from fecolumn.contact.nearby import Boxes

#: Kind of axis of a body over a plane ground, beside those of `contact.separation`
GROUND_NORMAL = 4
#: First number of a row without a pair; that of ground g is -1 - g
NO_PAIR = -(2**62)


#: A pair. pair: (2,) bodies, the first -1 - g of ground g, NO_PAIR of an unused row; kind of the
#: axis, feature: (2,) its face or edges, facing: face of the slave; separation along the axis [m].
#: master: -1 of a ground, slave. origin: (3,) [m], axes: (3, 3) in the master's frame, frame: (3,
#: 3) in the table frame; exchanged: whether the axis is another than before, frame_before and
#: master_before: of the step before. turn_then: (3, 3), shift_then: (3,) [m] how the bodies were to
#: each other when all axes were looked at; seen: own to `keep_rows`.
MEETING = record(
    ("pair", "i8", 2),
    ("kind", "i8"),
    ("feature", "i8", 2),
    ("facing", "i8"),
    ("separation", "f8"),
    ("master", "i8"),
    ("slave", "i8"),
    ("origin", "f8", 3),
    ("axes", "f8", (3, 3)),
    ("frame", "f8", (3, 3)),
    ("exchanged", "?"),
    ("frame_before", "f8", (3, 3)),
    ("master_before", "i8"),
    ("turn_then", "f8", (3, 3)),
    ("shift_then", "f8", 3),
    ("seen", "?"),
)

#: A place in a slot. name: 0 of an unused one; arm: (3,) from the slave's centre of mass in its
#: frame, seat: (3,) from the master's in its own [m], of a ground from its place in the table
#: frame; gap along the normal [m]; fresh: whether the slot was unused before; lift: height that a
#: place which was found below the surface is given [m], see `reduced.found`.
PLACE_MET = record(
    ("name", "i8"),
    ("arm", "f8", 3),
    ("seat", "f8", 3),
    ("gap", "f8"),
    ("fresh", "?"),
    ("lift", "f8"),
)


class Meetings(NamedTuple):
    """Pairs and their places: (P,) of MEETING and (P, S) of PLACE_MET; buckets: (2^n,) rows by
    their pair, own to `keep_rows`.
    """

    rows: Array
    places: Array
    buckets: Array


def meetings_for(rows: int, slots: int = 8) -> Meetings:
    """Rows without a pair."""
    buckets = np.full(2 ** int(np.ceil(np.log2(2 * rows + 2))), -1)
    meetings = Meetings(np.zeros(rows, MEETING), np.zeros((rows, slots), PLACE_MET), buckets)
    for row, places in zip(meetings.rows, meetings.places):
        interpreted(_free)(row, places)
    return meetings


@njit(alone=TOGETHER)
def add_grounds(
    hulls: Hulls, boxes: Boxes, ground_places: Array, ground_axes: Array, pairs: Array, found: int
) -> int:
    """Add to `found` pairs those of a body and a ground that are as near as boxes are grown; how
    many there are then.

    Parameters
    ----------
    ground_places, ground_axes
        (G, 3) a point of each plane in the table frame [m] and (G, 3, 3), whose columns are two
        tangents and the normal.
    """
    for g in range(len(ground_places)):
        n, place = ground_axes[g, :, 2], ground_places[g]
        for b in range(len(boxes.low)):
            if hulls.first[b + 1, 0] == hulls.first[b, 0]:
                continue
            over = 0.0
            for i in range(3):
                over += n[i] * (boxes.low[b, i] if n[i] > 0.0 else boxes.high[b, i])
                over -= n[i] * place[i]
            if over > 0.0:
                continue
            if found < len(pairs):
                pairs[found, 0], pairs[found, 1] = -1 - g, b
            found += 1
    return found


@njit(alone=TOGETHER)
def _bucket(meetings: Meetings, first: int, second: int) -> int:
    """The bucket in which the row of a pair is or would be."""
    buckets, mask = meetings.buckets, len(meetings.buckets) - 1
    k = (first * 73856093 ^ second * 19349663) & mask
    while buckets[k] >= 0:
        pair = meetings.rows[buckets[k]].pair
        if pair[0] == first and pair[1] == second:
            break
        k = (k + 1) & mask
    return k


@njit(alone=TOGETHER)
def keep_rows(meetings: Meetings, pairs: Array) -> int:
    """Give each of pairs (k, 2) a row, the one it has where it has one, and free all others; how
    many pairs found no row.
    """
    buckets, rows, missing, free = meetings.buckets, meetings.rows, 0, 0
    for k in range(len(buckets)):
        buckets[k] = -1
    for r in range(len(rows)):
        rows[r].seen = False
        if rows[r].pair[0] != NO_PAIR:
            buckets[_bucket(meetings, rows[r].pair[0], rows[r].pair[1])] = r
    for k in range(len(pairs)):
        r = buckets[_bucket(meetings, pairs[k, 0], pairs[k, 1])]
        if r >= 0:
            rows[r].seen = True
    for r in range(len(rows)):
        if not rows[r].seen and rows[r].pair[0] != NO_PAIR:
            _free(rows[r], meetings.places[r])
    for k in range(len(pairs)):
        # a row freed above is in its bucket still, but has lost its pair
        bucket = _bucket(meetings, pairs[k, 0], pairs[k, 1])
        if buckets[bucket] >= 0:
            continue
        while free < len(rows) and rows[free].seen:
            free += 1
        if free == len(rows):
            missing += 1
            continue
        rows[free].pair[0], rows[free].pair[1], rows[free].seen = pairs[k, 0], pairs[k, 1], True
        buckets[bucket] = free
    return missing


@njit(alone=TOGETHER)
def _free(row: Record, places: Array) -> None:
    """Take the pair from a row."""
    row.pair[0] = row.pair[1] = NO_PAIR
    row.kind, row.separation, row.facing = NO_AXIS, np.inf, -1
    row.master = row.slave = row.master_before = row.feature[0] = row.feature[1] = -1
    row.exchanged, row.turn_then[0, 0] = False, np.inf
    for slot in range(len(places)):
        places[slot].name, places[slot].fresh = 0, False
