"""Which nodes of a foot are contact points: all on its outlines, and inside them as many as the case says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from fecolumn.dynamics.effective import unit_loads
from fecolumn.dynamics.free_body import FreeBody

# Unit forces solved for at once
BATCH = 40
# Largest factor on the relief of the points
MOST = 1.5
# Least share of its compliance that the stiffest distribution of forces keeps: with 0.12 the reduced engine found no forces at the moment at
# which a sliding marble block of 85 points came to rest, with 0.3 it did
STIFFEST = 0.3
# Places of nodes count as equal up to this, over the foot's width
_SAME = 1e-9


@dataclass(frozen=True)
class Footprint:
    """Contact points of a foot, and the nodes that they stand for.

    nodes: (n,) nodes of the column that are contact points; areas: (n,) of the foot that belong to them [m2].
    all_nodes: (m,) nodes of the foot; all_areas: (m,) tributary to them [m2]; nearest: (m,) the point that each belongs to.
    inner: (n,) whether a point lies inside the outlines, so that it stands for others than itself.
    """

    nodes: np.ndarray
    areas: np.ndarray
    all_nodes: np.ndarray
    all_areas: np.ndarray
    nearest: np.ndarray
    inner: np.ndarray

    @classmethod
    def of_all(cls, nodes: np.ndarray, areas: np.ndarray) -> Footprint:
        """The foot of which all nodes are points."""
        return cls(nodes, areas, nodes, areas, np.arange(len(nodes)), np.zeros(len(nodes), bool))


def footprint(nodes: np.ndarray, positions: np.ndarray, areas: np.ndarray, on_outline: np.ndarray, interior: int) -> Footprint:
    """Choose contact points: the outlines, and at most about `interior` nodes inside, evenly spread.

    Each further point is the one farthest from all others, together with its mirror images, so that the choice prefers no direction.
    A column rocks, rolls and lands on its outlines; inside, points only share the pressure while it stands.

    Args:
        nodes: (m,) of the foot. positions: (m, 3) [m]. areas: (m,) [m2]. on_outline: (m,) mask.
        interior: largest number of points inside but for mirror images.
    """
    inside = np.flatnonzero(~on_outline)
    kept = np.ones(len(nodes), bool)
    if len(inside) > interior:
        kept = on_outline.copy()
        plane = positions[:, :2]
        middle = (plane.min(axis=0) + plane.max(axis=0)) / 2
        width = np.ptp(plane, axis=0).max()
        tree = cKDTree(plane)
        away = cKDTree(plane[kept]).query(plane)[0] if kept.any() else np.full(len(nodes), np.inf)
        while kept[inside].sum() < interior:
            # rounded, so that rounding does not decide between mirror images
            farthest = inside[np.argmax(np.round(away[inside] / width / _SAME))]
            images = middle + (plane[farthest] - middle) * np.array([[1, 1], [-1, 1], [1, -1], [-1, -1]])
            distance, found = tree.query(images)
            chosen = np.unique(found[(distance < _SAME * width) & ~kept[found]])
            kept[chosen] = True
            away = np.minimum(away, cKDTree(plane[chosen]).query(plane)[0])
    nearest = cKDTree(positions[kept]).query(positions)[1]
    shared = np.bincount(nearest, areas, minlength=int(kept.sum()))
    return Footprint(nodes[kept], shared, nodes, areas, nearest, ~on_outline[kept])


def relief(body, plate, foot: Footprint) -> np.ndarray:
    """Compliance (n, 3) [m/N], none above zero, by which points that stand for more than their node give less than it.

    The pressure on a patch presses it in less than the same force on one node in its middle. Each inner point gets the difference of
    the two, of the column and of the base below its nodes; one factor on all of them makes the stiffness of the standing foot against
    its weight that of the foot with all its nodes, as far as STIFFEST allows. Zero where all nodes are points.

    Args:
        body: of the column. plate: BasePlate or another holder of its compliance.
    """
    n, m = len(foot.nodes), len(foot.all_nodes)
    given = np.zeros((n, 3))
    if n == m:
        return given
    whole = _compliance(body, plate, foot.all_nodes)
    where = np.flatnonzero(np.isin(foot.all_nodes, foot.nodes))
    for i in np.flatnonzero(foot.inner):
        members = np.flatnonzero(foot.nearest == i)
        share = foot.all_areas[members] / foot.all_areas[members].sum()
        for axis in range(3):
            patch = share @ whole[3 * members[:, None] + axis, 3 * members + axis] @ share
            given[i, axis] = min(0.0, patch - whole[3 * where[i] + axis, 3 * where[i] + axis])
    rows = (3 * where[:, None] + np.arange(3)).ravel()
    points, arms = whole[np.ix_(rows, rows)], body.all_X[foot.all_nodes] - body.center
    wanted = _settlement(whole, arms)

    def beyond(factor):
        return _settlement(points + factor * np.diag(given.ravel()), arms[where]) / wanted - 1

    # the patches' own difference is nearly right: the factor is near 1
    if not given.any() or beyond(0.0) <= 0:
        return np.zeros((n, 3))
    high = 1.0
    while beyond(high) > 0 and high < MOST:
        high *= 1.1
    # every pressure must still press in: the least of it keeps so much of its compliance
    least = STIFFEST * np.linalg.eigvalsh(points)[0]
    while np.linalg.eigvalsh(points + high * np.diag(given.ravel()))[0] < least:
        high *= 0.97
    return (brentq(beyond, 0.0, high, xtol=1e-9) if beyond(high) < 0 else high) * given


def _compliance(body, plate, nodes) -> np.ndarray:
    """Static compliance (3 m, 3 m) of the column's nodes, as a free body, and of the base below them [m/N]."""
    m, free = len(nodes), FreeBody(body)
    whole = np.empty((3 * m, 3 * m))
    for first in range(0, m, BATCH):
        batch = nodes[first:first + BATCH]
        columns = free.response(unit_loads(body, batch)).reshape(body.n_owned, 3, -1)
        whole[:, 3 * first:3 * (first + len(batch))] = body.gather(nodes, columns).reshape(3 * m, -1)
    below, weights = plate.grid.project(body.all_X[nodes])
    plate.need(np.unique(below))
    share = np.zeros((m, len(plate.compliance)))
    np.add.at(share, (np.arange(m)[:, None], plate.slot[below]), weights)
    half = np.tensordot(share, plate.compliance, 1)
    whole += np.einsum("jq,iqab->iajb", share, half, optimize=True).reshape(3 * m, 3 * m)
    return (whole + whole.T) / 2


def _settlement(compliance, arms) -> float:
    """How far [m/N] a rigid foot at arms (n, 3) [m] sinks under a force of 1 N through the centre of mass; -inf where the compliance is not positive definite."""
    rigid = np.concatenate([np.tile(np.eye(3), (len(arms), 1, 1)), np.cross(np.eye(3)[None], arms[:, None]).transpose(0, 2, 1)], axis=2)
    rigid = rigid.reshape(-1, 6)
    try:
        stiffness = rigid.T @ cho_solve(cho_factor(compliance), rigid)
    except np.linalg.LinAlgError:
        return -np.inf
    return float(np.linalg.inv(stiffness)[2, 2])
