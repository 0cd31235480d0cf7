"""Which nodes of the base, or of the body on which it stands, lie below a point."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fecolumn.contact.bodies import GOES_ON, node_matrix
from fecolumn.contact.gathered import Gathered, none_gathered
from fecolumn.contact.points import (
    BEYOND,
    FLAT_GROUND,
    GROUND,
    OVER,
    POINT,
    SUNK,
    UNPREPARED,
)
from fecolumn.contact.pose import into_frame
from fecolumn.contact.record import record
from fecolumn.contact.tolerances import CLOSE, EDGE_REACH
from fecolumn.foundation._compiled import interpreted, njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.base_top import BaseTop
    from fecolumn.contact.bodies import Bodies
    from fecolumn.contact.unbounded_base import MovingTop

# Answers of `project`
ON, OFF, UNKNOWN = range(3)


#: Grid of the top of one ground: first_x, count_x, first_y, count_y: its lines among those of all;
#: first: place of its numbers; square: side of the squares [m] by which an unbounded one follows
#: the feet, 0 for a plate that stays; stiff: whether it gives nowhere.
TOP = record(
    ("first_x", "i8"),
    ("count_x", "i8"),
    ("first_y", "i8"),
    ("count_y", "i8"),
    ("first", "i8"),
    ("square", "f8"),
    ("stiff", "?"),
)


class GroundTops(NamedTuple):
    """Tops of the grounds for compiled code: tops: (G,) of TOP; grid lines x, y of all [m]; number:
    (n,) of their nodes, row by row; slot: (n_top,) of a node in `compliance`, -1 where it is not
    known yet; compliance: (3 k, 3 k) [m/N]. gathered: of it.
    """

    tops: Array
    x: Array
    y: Array
    number: Array
    slot: Array
    compliance: Array
    gathered: Gathered


def base_of(
    x: Array, y: Array, number: Array, slot: Array, compliance: Array, square: float = 0.0
) -> GroundTops:
    """GroundTops of one ground, of which nothing is gathered."""
    top = np.zeros(1, TOP)
    top["count_x"], top["count_y"], top["square"] = len(x), len(y), square
    top["stiff"] = not compliance.any()
    gathered = none_gathered(len(compliance) // 3)
    return GroundTops(top, x, y, np.ascontiguousarray(number).ravel(), slot, compliance, gathered)


def base_for_steps(base: Any) -> GroundTops:
    """GroundTops of a `contact.base_plate.BasePlate`, or what answers as it does, as far as its
    compliance is known.
    """
    return base_of(
        base.grid.x,
        base.grid.y,
        base.grid.number,
        base.slot.copy(),
        node_matrix(base.compliance),
        base.grid.square,
    )


def grounds_for_steps(bases: tuple[Any, ...]) -> GroundTops:
    """GroundTops of several grounds; nodes and slots of one come after those of the others."""
    each = [base_for_steps(base) for base in bases]
    if len(each) == 1:
        return each[0]
    slots = [len(one.compliance) // 3 for one in each]
    before = np.cumsum([0, *slots])
    compliance = np.zeros((3 * before[-1], 3 * before[-1]))
    for one, first, last in zip(each, 3 * before, 3 * before[1:]):
        compliance[first:last, first:last] = one.compliance
    tops = np.concatenate([one.tops for one in each])
    for name, arrays in (
        ("first_x", [one.x for one in each]),
        ("first_y", [one.y for one in each]),
        ("first", [one.number for one in each]),
    ):
        tops[name] = np.cumsum([0, *map(len, arrays[:-1])])
    nodes = np.cumsum([0, *(len(one.slot) for one in each)])
    return GroundTops(
        tops,
        np.concatenate([one.x for one in each]),
        np.concatenate([one.y for one in each]),
        np.concatenate([one.number + first for one, first in zip(each, nodes)]),
        np.concatenate(
            [np.where(one.slot < 0, -1, one.slot + first) for one, first in zip(each, before)]
        ),
        compliance,
        none_gathered(int(before[-1])),
    )


@njit
def project(base: GroundTops, positions: Array, listed: Array, points: Array) -> int:
    """Find the base's nodes under those of the listed points (k,) at positions (n, 3) that stand on
    it: ON, OFF its top, or UNKNOWN compliance.

    Bilinear interpolation on the facet vertically below: the top's slope under load is about 1e-5
    rad and changes gap and cone by 1e-5 of themselves. An unbounded ground is moved along with the
    middle of the points on it by whole squares. A point that is beyond the edge by rounding, or by
    the first slip of a foot as wide as its plate, stands on the edge.
    """
    answer, moved = ON, np.zeros((len(base.tops), 2))
    for g in range(len(base.tops)):
        if base.tops[g].square > 0 and not base.tops[g].stiff:
            _follow(base.tops[g].square, g, positions, points, moved[g])
    for i in listed:
        if points[i].master != GROUND or points[i].facet == FLAT_GROUND:
            continue
        g = points[i].ground
        top = base.tops[g]
        if top.stiff and top.square > 0:
            # without end, and the same everywhere
            continue
        lines_x = base.x[top.first_x : top.first_x + top.count_x]
        lines_y = base.y[top.first_y : top.first_y + top.count_y]
        x, far_x = _within(lines_x, positions[i, 0] - moved[g, 0])
        y, far_y = _within(lines_y, positions[i, 1] - moved[g, 1])
        if far_x or far_y:
            return OFF
        a, b = _cell(lines_x, x), _cell(lines_y, y)
        s, t = (
            (x - lines_x[a]) / (lines_x[a + 1] - lines_x[a]),
            (y - lines_y[b]) / (lines_y[b + 1] - lines_y[b]),
        )
        for q in range(4):
            node = base.number[top.first + (a + q % 2) * top.count_y + b + q // 2]
            slot = base.slot[node]
            points[i].below[q] = slot
            points[i].shares[q] = (s if q % 2 else 1 - s) * (t if q // 2 else 1 - t)
            if slot < 0:
                answer = UNKNOWN
    return answer


@njit
def _follow(square: float, ground: int, positions: Array, points: Array, moved: Array) -> None:
    """Moved (2,): way [m] in whole squares to the middle of the points on a ground."""
    dx, dy, count = 0.0, 0.0, 0
    for i in range(len(positions)):
        on_it = points[i].master == GROUND and points[i].ground == ground
        if on_it and points[i].facet != FLAT_GROUND:
            dx, dy, count = dx + positions[i, 0], dy + positions[i, 1], count + 1
    dx, dy = dx / max(count, 1), dy / max(count, 1)
    moved[0], moved[1] = square * np.rint(dx / square), square * np.rint(dy / square)


@njit
def _within(lines: Array, x: float) -> tuple[float, bool]:
    """The place nearest to x from the first to the last of the grid lines [m], and whether x is
    farther from it than EDGE_REACH of the last brick there.
    """
    nearest = min(max(x, lines[0]), lines[-1])
    brick = lines[1] - lines[0] if x < lines[0] else lines[-1] - lines[-2]
    # not `>`: a place that is not a number is on no base
    return nearest, not abs(x - nearest) <= EDGE_REACH * brick


@njit
def project_on_body(bodies: Bodies, interface: Record, point: Record, x: float, y: float) -> int:
    """Find the three nodes of a moving master's surface around the place x, y [m] in its frame, and
    their shares: ON or OFF the surface, or UNKNOWN where the face goes on without nodes that are
    known.

    From the facet where the point was found last towards the place; all facets are looked at where
    nodes that are not known are in the way, or an outline of a surface that is not convex. Off the
    surface, of the facet with the nearest side where it ends, or of a convex one of the last on the
    way.
    """
    first, count, facet, margin = (
        interface.facet_first,
        interface.facet_count,
        point.facet,
        EDGE_REACH * interface.width + interface.bulge,
    )
    # of room of their own, made at each call, they would take longer than to find
    shares, nearest, least, goes_on = point.shares, 0, np.inf, False
    for _ in range(count):
        across = _shares_of(bodies.facets[first + facet], x, y, margin, shares)
        if across < 0:
            _take(bodies.facets[first + facet], facet, point)
            return ON
        beside = bodies.facets[first + facet].neighbours[across]
        if beside < 0 and beside != GOES_ON and interface.convex:
            _take(bodies.facets[first + facet], facet, point)
            return OFF
        if beside < 0:
            break
        facet = beside
    for facet in range(count):
        corners = bodies.facets[first + facet].corners
        across = _shares_of(bodies.facets[first + facet], x, y, margin, shares)
        if across < 0:
            _take(bodies.facets[first + facet], facet, point)
            return ON
        for q in range(3):
            beside = bodies.facets[first + facet].neighbours[q]
            if beside >= 0:
                continue
            away = distance_from_side(corners[(q + 1) % 3], corners[(q + 2) % 3], x, y)
            # where the face ends and where it goes on meet in a corner: beyond it is off the face
            if away < least or away == least and beside != GOES_ON:
                nearest, least, goes_on = facet, away, beside == GOES_ON
    _shares_of(bodies.facets[first + nearest], x, y, margin, shares)
    _take(bodies.facets[first + nearest], nearest, point)
    return UNKNOWN if goes_on else OFF


@njit
def distance_from_side(start: Array, end: Array, x: float, y: float) -> float:
    """Distance [m] of a place x, y from the side between two corners (2,)."""
    u, v = end[0] - start[0], end[1] - start[1]
    at = ((x - start[0]) * u + (y - start[1]) * v) / (u * u + v * v)
    at = min(max(at, 0.0), 1.0)
    return np.hypot(x - start[0] - at * u, y - start[1] - at * v)


@njit
def side_of_outline(answer: int, was: int, height: float, width: float) -> int:
    """Where a point of a slave of some `width` is at the start of a step, `height` [m] above the
    surface of its master; answer: of `project_on_body`; `was`: SUNK is known.
    """
    if was == SUNK:
        return SUNK
    if answer == UNKNOWN and height < CLOSE * width:
        return UNPREPARED
    return OVER if answer == ON else BEYOND


@njit(inline="always")
def find_seat(bodies: Bodies, interface: Record, point: Record, pose: Record, place: Array) -> Any:
    """Bring the place (3,) of a point [m] from the table frame into that of its interface, and find
    its seat and the nodes below it on the moving master: as `project_on_body`. Of an interface
    without facets the nodes are known, and the point is ON the surface.
    """
    axes, origin = interface.axes, interface.origin
    into_frame(pose, place)
    for a in range(3):
        point.seat[a] = (
            origin[a] + axes[a, 0] * place[0] + axes[a, 1] * place[1] + axes[a, 2] * place[2]
        )
    if interface.facet_count == 0:
        return ON
    return project_on_body(bodies, interface, point, place[0], place[1])


@njit(inline="always")
def take_surface(interface: Record, point: Record, q: Array, moved: Array, place: Array) -> None:
    """Take from a place (3,) in the frame of the interface what displacement or velocity `moved`
    (3,) of node q below it, in the master's frame, gives the surface.
    """
    w, axes = point.shares[q], interface.axes
    for a in range(3):
        place[a] -= w * (axes[0, a] * moved[0] + axes[1, a] * moved[1] + axes[2, a] * moved[2])


@njit
def place_on_masters(
    bodies: Bodies,
    interfaces: Array,
    points: Array,
    poses: Array,
    moved: Array,
    starts: bool,
    places: Array,
) -> None:
    """Bring the places (P, 3) [m] of the points that stand on moving masters from the table frame
    to the masters' surfaces.

    Parameters
    ----------
    moved
        (N, 3) displacement of all nodes in the frames of their bodies [m].
    starts
        whether at the start of a step, within which no point comes or goes over an outline: one
        that is beyond it then is put high above the surface.
    """
    for i in range(len(points)):
        if points[i].master == GROUND:
            continue
        interface = interfaces[points[i].interface]
        answer = find_seat(bodies, interface, points[i], poses[points[i].interface], places[i])
        for q in range(3):
            take_surface(interface, points[i], q, moved[points[i].below[q]], places[i])
        if starts:
            points[i].beyond = side_of_outline(
                answer, points[i].beyond, places[i, 2] + points[i].lift, interface.width
            )
        if points[i].beyond != OVER:
            places[i, 2] = interface.width


@njit
def _shares_of(facet: Record, x: float, y: float, margin: float, shares: Array) -> int:
    """The first three shares: of a facet's corners in the place x, y; the side most beyond which it
    lies, -1 where it lies within, or by `margin` [m] beyond an outline.
    """
    corners = facet.corners
    ax, ay = corners[1, 0] - corners[0, 0], corners[1, 1] - corners[0, 1]
    bx, by = corners[2, 0] - corners[0, 0], corners[2, 1] - corners[0, 1]
    px, py, twice = x - corners[0, 0], y - corners[0, 1], ax * by - ay * bx
    shares[1], shares[2] = (px * by - py * bx) / twice, (ax * py - ay * px) / twice
    shares[0] = 1 - shares[1] - shares[2]
    worst, across = 0.0, -1
    for q in range(3):
        if shares[q] >= 0:
            continue
        # height of the triangle over the side opposite to the corner
        x0, y0 = corners[(q + 1) % 3, 0], corners[(q + 1) % 3, 1]
        x1, y1 = corners[(q + 2) % 3, 0], corners[(q + 2) % 3, 1]
        beyond = -shares[q] * abs(twice) / np.hypot(x1 - x0, y1 - y0)
        allowed = margin if facet.neighbours[q] < 0 else 1e-3 * margin
        if beyond > allowed and beyond > worst:
            worst, across = beyond, q
    return across


@njit
def _take(facet: Record, number: int, point: Record) -> None:
    """Let a point stand on a facet, of whose corners it has the shares."""
    point.facet = number
    for q in range(3):
        point.below[q] = facet.nodes[q]
    point.below[3], point.shares[3] = facet.nodes[0], 0.0


@njit
def _cell(lines: Array, value: float) -> int:
    """Number of the cell of the rising `lines` that holds `value`, by bisection."""
    low, high = 0, len(lines) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if lines[middle] <= value:
            low = middle
        else:
            high = middle
    return low


def nodes_under(
    grid: BaseTop | MovingTop, positions: Array, wanted: Array | None = None
) -> tuple[Array, Array]:
    """Nodes (n, 4) of a `contact.base_top.BaseTop` under `positions` (n, 3) [m] and their shares
    (n, 4), of the wanted ones (mask) if it is given.
    """
    points, listed = (
        np.zeros(len(positions), POINT),
        np.arange(len(positions)) if wanted is None else np.flatnonzero(wanted),
    )
    points["master"] = GROUND
    base = base_of(
        grid.x, grid.y, grid.number, np.arange(len(grid.points)), np.empty((0, 0)), grid.square
    )
    interpreted(project)(base, positions, listed, points)
    return points["below"], points["shares"]
