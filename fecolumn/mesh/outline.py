"""Outlines in plan of a column and of its foot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fecolumn.mesh.upright import Upright

if TYPE_CHECKING:
    from fecolumn.mesh.imported import OwnMesh


def foot_sides(case: Upright) -> tuple[float, float]:
    """Length along x and width along y [m] of the rectangle around the foot."""
    return foot_of_column(case.column, case.flange)


def foot_of_column(column: Any, flange: Any) -> tuple[float, float]:
    """As `foot_sides`, of a [column] on its [flange] or None."""
    if flange:
        return flange.outer_diameter_m, flange.outer_diameter_m
    if column.mesh_file:
        return own_of(column).foot
    return outline_sides(column)


def outline_sides(column: Any) -> tuple[float, float]:
    """Length and width [m] of a built column's section."""
    return (
        (column.length_m, column.width_m)
        if column.shape == "block"
        else (column.outer_diameter_m, column.outer_diameter_m)
    )


def own_of(column: Any) -> OwnMesh:
    """The user's own mesh of a [column]."""
    from fecolumn.mesh.imported import own_mesh  # which brings numba

    return own_mesh(column.drawn)


def is_solid(column: Any) -> bool:
    """Whether the round section of a [column] has no hole."""
    return column.shape == "solid" or column.wall_m >= column.outer_diameter_m / 2 * (1 - 1e-6)
