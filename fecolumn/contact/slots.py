"""Which places of a pair are kept, and in which slots: so that a place of the step before is found
where it was.
"""

from __future__ import annotations

import numpy as np

from fecolumn.contact.convex import TOGETHER
from fecolumn.contact.tolerances import OTHER_AXIS, SAME_POINT_BY_PLACE
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record


@njit(alone=TOGETHER)
def is_idle(places: Array) -> bool:
    """Whether no slot of places (S,) is used."""
    for slot in range(len(places)):
        if places[slot].name != 0:
            return False
    return True


@njit(alone=TOGETHER)
def _apart(one: Array, other: Array) -> float:
    x, y, z = one[0] - other[0], one[1] - other[1], one[2] - other[2]
    return np.sqrt(x * x + y * y + z * z)


@njit(alone=TOGETHER)
def _keep_spanning(places: Array, found: Array, count: int, size: float) -> None:
    """Mark the places found, as many as there are slots, that stand for all: the lowest, and each
    further one the farthest from those; one of the step before is preferred by OTHER_AXIS.
    """
    slots, chosen, least, preferred = len(places), 0, np.inf, OTHER_AXIS * size
    for q in range(count):
        found[q].kept, found[q].slot, found[q].away = count <= slots, -1, np.inf
        for slot in range(slots):
            if places[slot].name == found[q].name:
                found[q].slot = slot
                break
        gap = found[q].gap - (preferred if found[q].slot >= 0 else 0.0)
        if gap < least:
            least, chosen = gap, q
    if count <= slots:
        return
    for left in range(slots - 1, -1, -1):
        found[chosen].kept = True
        last, most = chosen, -np.inf
        for q in range(count if left > 0 else 0):
            if found[q].kept:
                continue
            found[q].away = min(found[q].away, _apart(found[last].seat, found[q].seat))
            away = found[q].away + (preferred if found[q].slot >= 0 else 0.0)
            if away > most:
                chosen, most = q, away


@njit(alone=TOGETHER)
def _is_taken(found: Array, count: int, slot: int) -> bool:
    for q in range(count):
        if found[q].kept and found[q].slot == slot:
            return True
    return False


@njit(alone=TOGETHER)
def settle_places(row: Record, places: Array, found: Array, count: int, size: float) -> bool:
    """Put the places found into the slots of a row: each into its own, where its name is known, or
    else into that of the nearest place that has gone; whether others take part than before.

    size: thickness of the thinner body [m].
    """
    if count == 0 and is_idle(places):
        return False
    changed = False
    _keep_spanning(places, found, count, size)
    # places on the first body; on the other one, where the first is a ground
    first = row.pair[0]
    was, now = first >= 0 and row.master_before == first, first >= 0 and row.master == first
    for q in range(count):
        if not found[q].kept or found[q].slot >= 0:
            continue
        nearest = SAME_POINT_BY_PLACE * size
        for slot in range(len(places)):
            if places[slot].name == 0 or _is_taken(found, count, slot):
                continue
            away = _apart(
                found[q].seat if now else found[q].arm,
                places[slot].seat if was else places[slot].arm,
            )
            if away < nearest:
                nearest, found[q].slot = away, slot
    for q in range(count):
        if not found[q].kept or found[q].slot >= 0:
            continue
        for slot in range(len(places)):
            # a slot of one that has gone is as good as an unused one
            if not _is_taken(found, count, slot):
                found[q].slot, places[slot].name, changed = slot, 0, True
                break
    for slot in range(len(places)):
        if not _is_taken(found, count, slot):
            changed |= places[slot].name != 0
            places[slot].name, places[slot].fresh = 0, False
    for q in range(count):
        if not found[q].kept:
            continue
        place = places[found[q].slot]
        place.fresh = place.name == 0
        place.name, place.gap = found[q].name, found[q].gap
        for i in range(3):
            place.arm[i], place.seat[i] = found[q].arm[i], found[q].seat[i]
    return changed
