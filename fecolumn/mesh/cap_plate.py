"""Bricks of the cap plate on top of the column."""

from __future__ import annotations

import numpy as np

from fecolumn.mesh.bricks import CAP, BrickMesh
from fecolumn.mesh.column import divisions
from fecolumn.mesh.gmsh_section import swept_grid
from fecolumn.mesh.upright import Upright


def cap_mesh(case: Upright) -> BrickMesh | None:
    """Rectangular plate of equal bricks, centred on the axis, its bottom at the column's top; None
    without a cap.
    """
    cap, size, bottom = case.cap, case.mesh.cap_size_m, case.seat_m + case.column.height_m
    if cap is None:
        return None
    x, y = (
        np.linspace(-length / 2, length / 2, divisions(length, size) + 1)
        for length in (cap.length_m, cap.width_m)
    )
    z = np.linspace(bottom, bottom + cap.thickness_m, divisions(cap.thickness_m, size) + 1)
    return swept_grid(x, y, z, CAP)
