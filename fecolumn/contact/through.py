"""Bodies that came through each other though no contact between them was asked for."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.best_axis import largest_separation
from fecolumn.contact.convex import TOGETHER, Hulls
from fecolumn.contact.nearby import Boxes, boxes_for, find_boxes, find_pairs
from fecolumn.contact.separation import Relation, relate, relation_for
from fecolumn.contact.tolerances import THROUGH
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array


class ThroughCheck:
    """Looks, every some steps, for pairs of convex bodies that are in each other.

    Parameters
    ----------
    hulls
        of all bodies; those without a hull, or not convex, are in no pair.
    left_out
        keys (k,) of pairs that are not looked at, see `nearby.pair_keys`: those with a joint.
    share
        depth over the thickness of the thinner body above which a pair is named.
    """

    def __init__(self, hulls: Hulls, left_out: Array, share: float = THROUGH) -> None:
        self.hulls, self.left_out, self.share = hulls, left_out, share
        self.boxes: Boxes = boxes_for(len(hulls.thickness))
        self.relation: Relation = relation_for(hulls)
        self.margins = np.zeros(len(hulls.thickness))
        self.pairs, self.depths = np.zeros((16, 2), np.int64), np.zeros(16)

    def deepest(self, centers: Array, rotations: Array) -> list[tuple[int, int, float]]:
        """Pairs in each other and the least way by which they come apart [m], the deepest first.

        centers: (N, 3) of mass [m], rotations: (N, 3, 3) of all bodies.
        """
        find_boxes(self.hulls, centers, rotations, self.margins, self.boxes)
        found = find_pairs(self.hulls, self.boxes, self.left_out, self.pairs)
        if found > len(self.pairs):
            self.pairs, self.depths = np.zeros((2 * found, 2), np.int64), np.zeros(2 * found)
            find_pairs(self.hulls, self.boxes, self.left_out, self.pairs)
        find_depths(
            self.hulls, centers, rotations, self.pairs[:found], self.relation, self.depths[:found]
        )
        thickness = self.hulls.thickness[self.pairs[:found]].min(axis=1)
        rows = np.flatnonzero(self.depths[:found] > self.share * thickness)
        rows = rows[np.argsort(-self.depths[rows], kind="stable")]
        return [(int(self.pairs[k, 0]), int(self.pairs[k, 1]), float(self.depths[k])) for k in rows]


@njit(alone=TOGETHER)
def find_depths(
    hulls: Hulls, centers: Array, rotations: Array, pairs: Array, relation: Relation, depths: Array
) -> None:
    """Find the depth (k,) [m] of pairs (k, 2) of bodies in each other, below 0 of those apart."""
    for k in range(len(pairs)):
        a, b = pairs[k, 0], pairs[k, 1]
        relate(centers, rotations, a, b, relation)
        depths[k] = -largest_separation(hulls, a, b, relation)[0]
