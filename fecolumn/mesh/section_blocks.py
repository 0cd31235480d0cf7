"""Blocks of which Gmsh draws round sections: each is meshed in quadrilaterals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np


def ring_of_blocks(
    geo: Any,
    centre: int,
    inner: Sequence[int],
    outer: Sequence[int],
    n_arcs: Sequence[int] | np.ndarray,
    n_radial: int,
    *,
    curved_inside: bool,
    inner_curves: list[int] | None = None,
) -> list[int]:
    """Surfaces of four blocks between four inner and four outer points."""

    def curve(start: int, end: int, curved: bool, n: int) -> int:
        tag = geo.addCircleArc(start, centre, end) if curved else geo.addLine(start, end)
        geo.mesh.setTransfiniteCurve(tag, int(n) + 1)
        return tag

    follow = [1, 2, 3, 0]
    insides = [curve(inner[i], inner[follow[i]], curved_inside, n_arcs[i]) for i in range(4)]
    outsides = [curve(outer[i], outer[follow[i]], True, n_arcs[i]) for i in range(4)]
    spokes = [curve(inner[i], outer[i], False, n_radial) for i in range(4)]
    if inner_curves is not None:
        inner_curves.extend(insides)
    return [
        quadrilateral(
            geo,
            [spokes[i], outsides[i], -spokes[follow[i]], -insides[i]],
            [inner[i], outer[i], outer[follow[i]], inner[follow[i]]],
        )
        for i in range(4)
    ]


def quadrilateral(geo: Any, curves: Sequence[int], corners: Sequence[int]) -> int:
    """Surface of a quadrilateral between four curves, meshed in quadrilaterals."""
    surface = geo.addPlaneSurface([geo.addCurveLoop(curves)])
    geo.mesh.setTransfiniteSurface(surface, cornerTags=corners)
    geo.mesh.setRecombine(2, surface)
    return surface
