"""Contact that is found, from a `structures.model.StructureModel` to the compiled engine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from fecolumn.contact.convex import hull_of, hulls_of, no_hull
from fecolumn.contact.interface import INTERFACE
from fecolumn.contact.meet import room_for
from fecolumn.contact.nearby import boxes_for, pair_keys
from fecolumn.contact.points import FLAT_GROUND, GROUND, POINT
from fecolumn.contact.tolerances import FOUND_SLOTS
from fecolumn.engines.reduced.found import Found
from fecolumn.foundation.arrays import Array
from fecolumn.structures.hulls import HULL

if TYPE_CHECKING:
    from fecolumn.structures.model import StructureModel


class NoRoom(Exception):
    """More pairs of bodies are near each other than there is room for."""


def found_of(
    model: StructureModel, first: Array, reach: Array, interface: int, point: int, rows: int
) -> Found:
    """Found of a model, of no body where its contact is not found.

    Parameters
    ----------
    first
        (nb + 1,) rows of each body among the nodes of all.
    reach
        (N,) as of `model.Structure`.
    interface, point
        the first ones of its own.
    rows
        pairs for which there is room.
    """
    parts, grounds, meet = model.parts, len(model.levels), model.found.parts if model.found else ()
    hulls, nodes, reaches = [no_hull()] * len(parts), [], np.zeros(len(parts))
    made: dict[int, tuple] = {}
    for b in sorted(meet):
        body = parts[b].model
        own = body.surfaces[HULL].nodes
        if id(body) not in made:
            # copies share their model
            hull = hull_of(body.arms[own])
            made[id(body)] = hull, own[cKDTree(body.arms[own]).query(hull.corners)[1]]
        hulls[b], at = made[id(body)]
        nodes.append(first[b] + at)
        reaches[b] = reach[first[b] + own].max()
    held = [b for b in meet if parts[b].held >= 0]
    friction, restitution = np.zeros((2, len(parts) + grounds, len(parts)))
    joint = np.full(friction.shape, -1)
    if model.found:
        friction[:], restitution[:] = model.found.friction, model.found.restitution
    replaced = sorted(model.replaced)
    for number in replaced:
        one = model.joints[number]
        if one.pair >= 0:
            continue
        other = len(parts) + one.ground if one.master == GROUND else one.master
        pairs = [(other, one.slave)] + [(one.slave, other)] * (one.master != GROUND)
        for pair in pairs:
            friction[pair], restitution[pair], joint[pair] = one.friction, one.restitution, number
    whole = hulls_of(hulls)
    return Found(
        whole,
        np.concatenate(nodes) if nodes else np.zeros(0, np.int64),
        interface,
        point,
        pair_keys([(a, b) for a in held for b in held if a < b], len(parts)),
        friction,
        restitution,
        joint,
        np.isin(np.arange(len(model.joints)), replaced),
        np.tile(np.eye(3), (grounds, 1, 1)),
        reaches,
        boxes_for(len(parts)),
        np.zeros((rows, 2), np.int64),
        room_for(whole),
    )


def found_interfaces(found: Found, rows: int) -> Array:
    """Interfaces (rows,) of INTERFACE of which no pair has any."""
    interfaces = np.zeros(rows, INTERFACE)
    interfaces["master"], interfaces["axes"], interfaces["sector"] = GROUND, np.eye(3), 1.0
    thickness = found.hulls.thickness
    interfaces["width"] = thickness[thickness > 0].min()
    return interfaces


def found_points(found: Found, rows: int) -> Array:
    """Points (FOUND_SLOTS rows,) of POINT that take no part."""
    points = np.zeros(FOUND_SLOTS * rows, POINT)
    points["interface"] = found.interface + np.repeat(np.arange(rows), FOUND_SLOTS)
    points["master"], points["facet"], points["idle"] = GROUND, FLAT_GROUND, True
    points["node"], points["count"], points["weights"][:, 0] = found.nodes[0], 1, 1.0
    points["carriers"] = points["node"][:, None]
    return points
