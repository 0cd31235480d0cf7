"""Compliance among those nodes of the base that have been below the foot, together in memory.

A foot stands on a few hundred nodes of a base whose compliance takes tens of megabytes: to pick
them out of it anew in each step would take longer than all that is done with them.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


class Gathered(NamedTuple):
    """The gathered nodes. number: (1,) of them; slots: (k,) in the base's compliance; place: (k,)
    of each slot among them, -1 of one that is not; matrix: (3 k, 3 k) compliance [m/N], its first 3
    number rows and columns filled; k: slots of the base.
    """

    number: Array
    slots: Array
    place: Array
    matrix: Array


def none_gathered(slots: int) -> Gathered:
    """Of a base of so many slots."""
    return Gathered(
        np.zeros(1, np.int64),
        np.zeros(slots, np.int64),
        np.full(slots, -1, np.int64),
        np.empty((3 * slots, 3 * slots)),
    )


def gathered_nodes(base: Any) -> Array:
    """Top nodes (k,) of a base whose compliance is gathered, in their order: for a checkpoint,
    since sums are taken in this order.
    """
    nodes = np.empty(len(base.gathered.slots), np.int64)
    nodes[base.slot[base.slot >= 0]] = np.flatnonzero(base.slot >= 0)
    return nodes[base.gathered.slots[: base.gathered.number[0]]]


def base_to_resume(base: Any) -> dict[str, Array]:
    """Top nodes of a base whose compliance is known, and those that are gathered, for a
    checkpoint.
    """
    return {
        "base.known": np.flatnonzero(base.slot >= 0),
        "base.gathered": gathered_nodes(base),
    }


def gather_again(base: Any, nodes: Array) -> None:
    """Gather the top nodes (k,) of a base of which nothing is gathered, in their order."""
    gathered, slots, k = base.gathered, base.slot[nodes], len(nodes)
    rows = (3 * slots[:, None] + np.arange(3)).ravel()
    gathered.number[0], gathered.slots[:k], gathered.place[slots] = k, slots, np.arange(k)
    gathered.matrix[: 3 * k, : 3 * k] = base.compliance[np.ix_(rows, rows)]


@njit
def gather(base: Any, points: Array, listed: Array) -> None:
    """Gather the nodes below the listed points (k,); where far more are gathered than all points
    can have, as a foot goes on its way, from the beginning.
    """
    gathered, compliance = base.gathered, base.compliance
    if gathered.number[0] > 8 * len(points):
        gathered.place[:] = -1
        gathered.number[0] = 0
    for i in listed:
        if points[i].master != GROUND:
            continue
        for q in range(4):
            slot = points[i].below[q]
            if points[i].shares[q] == 0.0 or gathered.place[slot] >= 0:
                continue
            new = gathered.number[0]
            gathered.number[0], gathered.slots[new], gathered.place[slot] = new + 1, slot, new
            for other in range(new + 1):
                row, column = 3 * slot, 3 * gathered.slots[other]
                for a in range(3):
                    for b in range(3):
                        gathered.matrix[3 * new + a, 3 * other + b] = compliance[
                            row + a, column + b
                        ]
                        gathered.matrix[3 * other + b, 3 * new + a] = compliance[
                            column + b, row + a
                        ]
