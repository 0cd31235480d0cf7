"""Outlines of the two faces of a joint, and the slots of its points, from the plain numbers of
`structures.model`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fecolumn.contact.overlap import OVERLAP, OWN, SIDE, SIDE_NODE, SLOT, Overlaps
from fecolumn.contact.points import POINT
from fecolumn.contact.tolerances import CROSSES_FROM, SAME_OUTLINE
from fecolumn.foundation.arrays import Array

# Over the size of a face: a node is on a side of its outline
_ON_SIDE = 1e-7


class OverlapBuilder:
    """Collects the joints of two sides of a structure, whose points it completes."""

    def __init__(self) -> None:
        self.joints: list[Any] = []
        self.sides: list[Any] = []
        self.nodes: list[Any] = []
        self.slots: list[Any] = []

    def add(self, forward: tuple, reverse: tuple, arms: list[float]) -> tuple[Array, Array]:
        """Add a joint; the points (k,) of POINT of its two interfaces, with those that nodes do not
        carry.

        Parameters
        ----------
        forward, reverse
            number of the interface, points (n,) of POINT, places (n, 2) [m] of the slave's nodes on
            their face, ends (m, 2, 2) [m] of the sides of its outline counter-clockwise, circle:
            centre (2,) and radius or None.
        arms
            of the farthest corner of each face from the centre of mass of its body [m].
        """
        (k, own, places, ends, circle), (r, other, other_places, other_ends, other_circle) = (
            forward,
            reverse,
        )
        joint = np.zeros(1, OVERLAP)
        joint["forward"], joint["reverse"], joint["size"] = k, r, np.ptp(ends, axis=(0, 1)).max()
        joint["arm"], sides = arms, []
        for which, (points, at, outline, of) in enumerate(
            ((own, places, ends, circle), (other, other_places, other_ends, other_circle))
        ):
            joint["first"][0, which] = len(self.sides)
            joint["convex"][0, which] = of is not None or _is_convex(outline)
            if of is None:
                sides.append(self._add_sides(outline, at, points["node"], float(joint["size"][0])))
                joint["count"][0, which] = len(outline)
            else:
                joint["center"][0, which], joint["radius"][0, which] = of
                sides.append(np.full(len(at), -1))
        joint["slot"] = sum(map(len, self.slots))
        free = _most_corners(
            len(ends) if circle is None else 0,
            len(other_ends) if other_circle is None else 0,
            bool(joint["convex"].all()),
        )
        twin = circle is None and other_circle is None
        slots = np.zeros(len(own) + free, SLOT)
        slots["forward"], slots["reverse"], slots["side"] = -1, -1, -1
        slots["side"][: len(own)], slots["place"][: len(own)] = sides[OWN], places
        if circle is None:
            starts = np.array(
                [side["start"] for side in self.sides[joint["first"][0, OWN] :][: len(ends)]]
            )
            apart = np.linalg.norm(places[:, None] - starts, axis=2)
            slots["corner"][: len(own)] = apart.min(axis=1) < _ON_SIDE * joint["size"][0]
            # of a corner the side that begins there
            at_corner = np.flatnonzero(slots["corner"])
            slots["side"][at_corner] = joint["first"][0, OWN] + apart.argmin(axis=1)[at_corner]
        slots["free"][len(own) :] = True
        on_rim = (
            np.zeros(len(own), bool)
            if circle is None
            else np.abs(np.linalg.norm(places - circle[0], axis=1) - circle[1])
            < _ON_SIDE * joint["size"][0]
        )
        forward_points = np.concatenate([own, _more(own, free)])
        twins = slots["side"][: len(own)] >= 0 if twin else np.zeros(len(own), bool)
        kept = other if other_circle is not None else other[:0]
        reverse_points = np.concatenate([kept, _more(other, int(twins.sum()) + free)])
        reverse_points["idle"] = True
        slots["forward"] = np.arange(len(slots))
        slots["reverse"][np.flatnonzero(np.concatenate([twins, np.ones(free, bool)]))] = len(
            kept
        ) + np.arange(twins.sum() + free)
        slots = slots[~np.concatenate([on_rim, np.zeros(free, bool)])]
        joint["slots"] = len(slots)
        self.joints.append(joint)
        self.slots.append(slots)
        return forward_points, reverse_points

    def finish(self, first: Array) -> Overlaps:
        """The Overlaps; first: number of the first point of each interface."""
        for joint, slots in zip(self.joints, self.slots):
            slots["forward"] += first[joint["forward"][0]]
            slots["reverse"][slots["reverse"] >= 0] += first[joint["reverse"][0]]
        return Overlaps(
            *(
                np.concatenate(rows) if rows else np.zeros(0, kind)
                for rows, kind in (
                    (self.joints, OVERLAP),
                    ([np.array(self.sides, SIDE)], SIDE),
                    (self.nodes, SIDE_NODE),
                    (self.slots, SLOT),
                )
            )
        )

    def _add_sides(self, ends: Array, places: Array, nodes: Array, size: float) -> Array:
        """Add the sides (m, 2, 2) of a polygon; the number (n,) of a side on which each of the
        nodes lies, -1 of those on none.
        """
        found, inner = np.full(len(places), -1), _inset(ends, CROSSES_FROM * SAME_OUTLINE * size)
        for q, (start, end) in enumerate(ends):
            side, length = np.zeros((), SIDE), np.linalg.norm(end - start)
            along = (end - start) / length
            normal = np.array([along[1], -along[0]])
            out, at = (places - start) @ normal, (places - start) @ along
            on = np.flatnonzero(
                (np.abs(out) < _ON_SIDE * size)
                & (at > -_ON_SIDE * size)
                & (at < length + _ON_SIDE * size)
            )
            on = on[np.argsort(at[on])]
            found[on] = np.where(found[on] < 0, len(self.sides), found[on])
            far = int(np.argmin(out))
            side["start"], side["end"], side["along"], side["normal"], side["length"] = (
                start,
                end,
                along,
                normal,
                length,
            )
            side["inner"] = inner[q]
            side["first"], side["count"] = sum(map(len, self.nodes)), len(on)
            side["far"], side["far_place"] = nodes[far], (at[far], -out[far])
            rows = np.zeros(len(on), SIDE_NODE)
            rows["node"], rows["at"] = nodes[on], at[on]
            self.nodes.append(rows)
            self.sides.append(side)
        return found


def _most_corners(own: int, other: int, convex: bool) -> int:
    """Corners of the region of two outlines of so many sides, 0 of a circle, that are no corners of
    the first, at most: of each side of the first the two ends of what is within the second.
    """
    if own and other:
        return (1 if convex else 2) * own + other
    return 2 * max(own, other, 1)


def _more(points: Array, count: int) -> Array:
    """So many points (count,) of POINT like the first of `points`, idle, with the mean contact
    law.
    """
    more = np.repeat(points[:1], count) if len(points) else np.zeros(count, POINT)
    more["idle"] = True
    if len(points):
        more["law"] = points["law"].mean(axis=0)
    return more


def _is_convex(ends: Array) -> bool:
    """Whether the sides (n, 2, 2) of an outline turn to the left alone, once around."""
    along = ends[:, 1] - ends[:, 0]
    after = along[_next(ends)]
    turn = np.arctan2(
        along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0], np.einsum("na,na->n", along, after)
    )
    return bool((turn > 0).all() and turn.sum() < 3 * np.pi)


def _next(ends: Array) -> Array:
    """Place (n,) of the side that begins where each of the sides (n, 2, 2) ends."""
    return np.abs(ends[:, 1, None] - ends[None, :, 0]).max(axis=2).argmin(axis=1)


def _inset(ends: Array, way: float) -> Array:
    """Ends (n, 2, 2) of the sides of an outline that are moved inwards by `way`."""
    after = _next(ends)
    along = ends[:, 1] - ends[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    # of two unit vectors along the sides that meet, both away from the corner
    bisector = along[after] - along
    turn = along[:, 0] * along[after, 1] - along[:, 1] * along[after, 0]
    last = ends[:, 1] + way * bisector / turn[:, None]
    first = np.empty_like(last)
    first[after] = last
    return np.stack([first, last], axis=1)
