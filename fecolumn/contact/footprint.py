"""Which nodes of a foot are contact points: all on its outlines, and inside them as many as the
case says.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from fecolumn.contact.tolerances import SAME_PLACE
from fecolumn.foundation.arrays import Array


def footprint(
    nodes: Array,
    positions: Array,
    areas: Array,
    on_outline: Array,
    interior: int,
) -> tuple[Array, Array]:
    """Contact points of a foot: the outlines, and at most about `interior` nodes inside, evenly
    spread.

    Each further point is the one farthest from all others, together with its mirror images, so that
    the choice prefers no direction. A column rocks, rolls and lands on its outlines; inside, points
    only share the pressure while it stands.

    Parameters
    ----------
    nodes
        (m,) of the foot.
    positions
        (m, 3) [m].
    areas
        (m,) [m2].
    on_outline
        (m,) mask.
    interior
        largest number of points inside but for mirror images.

    Returns
    -------
    nodes (n,) that are contact points, and the areas (n,) [m2] that belong to them: each node's
    own goes to the nearest point.
    """
    inside = np.flatnonzero(~on_outline)
    kept = np.ones(len(nodes), bool)
    if len(inside) > interior:
        kept = on_outline.copy()
        plane = positions[:, :2]
        middle = (plane.min(axis=0) + plane.max(axis=0)) / 2
        width = np.ptp(plane, axis=0).max()
        tree = cKDTree(plane)
        # of points equally far the first from above, then from the left: no order of nodes decides
        places = np.round(plane / width, 9)
        inside = inside[np.lexsort([places[inside, 0], -places[inside, 1]])]
        away = cKDTree(plane[kept]).query(plane)[0] if kept.any() else np.full(len(nodes), np.inf)
        while kept[inside].sum() < interior:
            # rounded, so that rounding does not decide between mirror images
            farthest = inside[np.argmax(np.round(away[inside] / width / SAME_PLACE))]
            images = middle + (plane[farthest] - middle) * np.array(
                [[1, 1], [-1, 1], [1, -1], [-1, -1]]
            )
            distance, found = tree.query(images)
            chosen = np.unique(found[(distance < SAME_PLACE * width) & ~kept[found]])
            kept[chosen] = True
            away = np.minimum(away, cKDTree(plane[chosen]).query(plane)[0])
    nearest = cKDTree(positions[kept]).query(positions)[1]
    return nodes[kept], np.bincount(nearest, areas, minlength=int(kept.sum()))
