"""Polygons by their corners, in either sense."""

from __future__ import annotations

from collections.abc import Sequence

_Point = Sequence[float]  # x, y
_Side = tuple[_Point, _Point]

# Of the polygon's size: sides that come nearer touch
_TOUCH = 1e-9


def signed_area(corners: Sequence[_Point]) -> float:
    """Area [m2] that corners (x, y) enclose, negative where they go clockwise."""
    x0, y0 = corners[0]
    moved = [(x - x0, y - y0) for x, y in corners]
    return sum(a * d - b * c for (a, b), (c, d) in zip(moved, moved[1:] + moved[:1])) / 2


def crossing(corners: Sequence[_Point]) -> tuple[int, int] | None:
    """Two sides, by the numbers of the corners at which they begin, that cross or touch elsewhere
    than at their common corner; None of a simple polygon.
    """
    count = len(corners)
    sides = list(zip(corners, [*corners[1:], corners[0]]))
    size = max(max(values) - min(values) for values in zip(*corners))
    for first in range(count):
        for second in range(first + 1, count):
            one, other = sides[first], sides[second]
            if second == first + 1 or (first, second) == (0, count - 1):
                common = one[1] if second == first + 1 else one[0]
                if _turns_back(one, other, common, size):
                    return first, second
            elif _distance(one, other) <= _TOUCH * size:
                return first, second
    return None


def _turns_back(one: _Side, other: _Side, common: _Point, size: float) -> bool:
    """Whether a side lies on its neighbour, beyond their common corner."""
    ends = [side[1] if side[0] == common else side[0] for side in (one, other)]
    return min(_from_side(ends[0], other), _from_side(ends[1], one)) <= _TOUCH * size


def _distance(one: _Side, other: _Side) -> float:
    """Distance [m] of two sides, 0 where they cross."""
    left = [_left(*one, point) for point in other] + [_left(*other, point) for point in one]
    if left[0] * left[1] < 0 and left[2] * left[3] < 0:
        return 0.0
    return min(
        *(_from_side(point, other) for point in one), *(_from_side(point, one) for point in other)
    )


def _left(start: _Point, end: _Point, point: _Point) -> float:
    """Positive where a point lies to the left of the way from start to end."""
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])


def _from_side(point: _Point, side: _Side) -> float:
    """Distance [m] of a point from a side."""
    (x, y), (u, v) = side[0], (side[1][0] - side[0][0], side[1][1] - side[0][1])
    share = min(max(((point[0] - x) * u + (point[1] - y) * v) / (u * u + v * v), 0.0), 1.0)
    return float(((x + share * u - point[0]) ** 2 + (y + share * v - point[1]) ** 2) ** 0.5)
