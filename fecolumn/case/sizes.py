"""Sizes that a case leaves open, from its column's own, and whether all of them fit together.

Brick sizes follow the perimeter of what is meshed, so that a glass tube and a marble drum have some
thousands of bricks alike:

    tube            48 fine bricks around its middle surface, 16 coarse ones
    solid cylinder  32 fine bricks around, 16 coarse ones
    block           12 fine bricks along the geometric mean of its sides, 6 coarse ones; at least
                    4 and 2 along the shorter side
    flange          40 fine bricks around, unless the tube's own are still three times smaller
    own mesh        the base below has bricks as large as the foot's faces, but 8 to 24 along
                    the foot
"""

from __future__ import annotations

import dataclasses
import functools
import math
from pathlib import Path
from typing import TypeVar

from fecolumn.case.check_plates import OwnSize, check_fine_height, check_plates
from fecolumn.case.checked import refuse_in
from fecolumn.case.column_keys import Base, Column, ColumnSections, MeshSizes
from fecolumn.case.ground_sizes import least_side, open_allowance, open_side, open_thickness
from fecolumn.case.sections import Cap, Flange
from fecolumn.foundation.content import content
from fecolumn.foundation.files import is_file
from fecolumn.foundation.schema import Section
from fecolumn.mesh.outline import foot_of_column, foot_sides, is_solid, outline_sides, own_of

_Case = TypeVar("_Case", bound=ColumnSections)
_Filled = TypeVar("_Filled", bound=Section)

# keys that each shape needs, and those that say nothing of it
NEEDED = {
    "tube": ("outer_diameter_m", "height_m", "wall_m"),
    "solid": ("outer_diameter_m", "height_m"),
    "block": ("length_m", "width_m", "height_m"),
}
_IDLE = {
    "tube": ("length_m", "width_m"),
    "solid": ("wall_m", "length_m", "width_m"),
    "block": ("outer_diameter_m", "wall_m"),
}
# fine bricks of a coarse one
_COARSE = {"tube": 3, "solid": 2, "block": 2}


def check_shape(case: ColumnSections, file: Path | str) -> None:
    """Refuse a column whose shape misses dimensions, all of them told at once, or has some that say
    nothing of it.
    """
    column, refuse = case.column, refuse_in(file)
    if column.mesh_file:
        if not is_file(column.mesh_file):
            refuse("column.mesh_file", column.mesh_file, "no such file")
        if column.shape != "tube":
            refuse(
                "column.shape",
                column.shape,
                "says nothing where column.mesh_file gives the column; leave it out",
            )
        if case.flange:
            refuse(
                "flange",
                None,
                "a mesh of one's own has its flange in column.mesh_file; leave the section out",
            )
        for key in ("length_m", "width_m"):
            if getattr(column, key) is not None:
                refuse(
                    f"column.{key}",
                    getattr(column, key),
                    "is read from column.mesh_file; leave it out",
                )
        if unfit := column.drawn.unfit():
            refuse(f"column.{unfit[0]}", *unfit[1:])
        return
    for key in ("mesh_unit", "mesh_size_m", "cut_foot_m"):
        if (value := getattr(column, key)) is not None:
            refuse(f"column.{key}", value, "says nothing without column.mesh_file")
    # a finished case states the wall of a solid cylinder, its radius
    implied = (
        {"wall_m": column.outer_diameter_m / 2}
        if column.shape == "solid" and column.outer_diameter_m
        else {}
    )
    needed, idle = (
        NEEDED[column.shape],
        [
            key
            for key in _IDLE[column.shape]
            if getattr(column, key) not in (None, implied.get(key))
        ],
    )
    missing = [key for key in needed if getattr(column, key) is None]
    if missing:
        refuse(
            ", ".join(f"column.{key}" for key in missing),
            None,
            f'missing; a column of shape = "{column.shape}" needs {", ".join(needed)}, '
            "in metres (or a mesh_file of its own)",
        )
    if idle:
        refuse(
            f"column.{idle[0]}",
            getattr(column, idle[0]),
            f'says nothing of a column of shape = "{column.shape}", which has {", ".join(needed)}',
        )


def with_sizes(case: _Case) -> _Case:
    """The case with every size that it leaves open.

    Raises
    ------
    InputError
        a mesh of one's own cannot be read.
    """
    mesh = content(case.column.mesh_file) if case.column.mesh_file else ""
    column, base, sizes = sized(case.column, case.flange, case.cap, case.base, case.mesh, mesh)
    if (column, base, sizes) == (case.column, case.base, case.mesh):
        return case
    return dataclasses.replace(case, column=column, base=base, mesh=sizes)


def opened(case: _Case) -> _Case:
    """A finished case with those sizes left open that it would be given anyway, so that another
    column gets its own.
    """
    followers = {
        "mesh": [field.name for field in dataclasses.fields(case.mesh) if field.default is None],
        "base": [field.name for field in dataclasses.fields(case.base) if field.default is None],
        "column": [
            "fine_height_m",
            *(["height_m"] if case.column.mesh_file else []),
            *(["wall_m"] if case.column.shape == "solid" else []),
        ],
    }
    for name, keys in followers.items():
        for key in keys:
            trial = dataclasses.replace(
                case, **{name: dataclasses.replace(getattr(case, name), **{key: None})}
            )
            if with_sizes(trial) == with_sizes(case):
                case = trial
    return case


@functools.lru_cache(maxsize=256)
def sized(
    column: Column,
    flange: Flange | None,
    cap: Cap | None,
    base: Base,
    mesh: MeshSizes,
    mesh_content: str,
) -> tuple[Column, Base, MeshSizes]:
    """Column, base and mesh sections without open sizes, those of the short form; `mesh_content`
    tells that a file is still the one read before.
    """
    foot = foot_of_column(column, flange)
    shorter, longer = min(foot), max(foot)
    filled = dict(element_order=1)
    if column.mesh_file:
        own = own_of(column)
        column = _filled(column, height_m=own.height, fine_height_m=0.0)
        filled = dict(element_order=2 if own.is_tetrahedral else 1)
        side = math.sqrt(foot[0] * foot[1])
        fine, times = min(max(own.foot_edge, side / 24), side / 8), 3
        coarse = times * fine
    else:
        if column.shape == "solid" and column.wall_m is None:
            column = dataclasses.replace(
                column, wall_m=_known(column.outer_diameter_m) / 2
            )  # to the last digit: a finished case is finished again
        fine, times = (
            _fine(column),
            _COARSE["solid" if column.shape == "tube" and is_solid(column) else column.shape],
        )
        coarse = times * fine
        if flange:
            fine = min(math.pi * flange.outer_diameter_m / 40, 3 * fine)
        if column.fine_height_m is None:
            half, height = min(outline_sides(column)) / 2, _known(column.height_m)
            column = _filled(column, fine_height_m=half if half < height else height)
    mesh = _filled(mesh, fine_size_m=fine, **filled)
    # what is stated goes before: other bricks follow a stated fine one, none smaller than it
    fine = _known(mesh.fine_size_m)
    mesh = _filled(
        mesh,
        coarse_size_m=max(min(coarse, times * fine), fine),
        base_size_m=6 * fine,
    )
    coarse = _known(mesh.coarse_size_m)
    mesh = _filled(
        mesh,
        cap_size_m=max(coarse, max(cap.length_m, cap.width_m) / 16) if cap else coarse,
    )
    room = [
        (stated - side) / 2
        for side, stated in zip(foot, (base.length_m, base.width_m))
        if stated is not None
    ]
    base = _filled(
        base,
        slide_allowance_m=open_allowance(shorter, room),
        thickness_m=open_thickness(shorter),
    )
    allowance = _known(base.slide_allowance_m)
    sides = [open_side(side, longer, allowance) for side in foot]
    return column, _filled(base, length_m=sides[0], width_m=sides[1]), mesh


def _fine(column: Column) -> float:
    """Size [m] of fine bricks of a built column."""
    if column.shape == "block":
        sides = outline_sides(column)
        return min(math.sqrt(sides[0] * sides[1]) / 12, min(sides) / 4)
    outer = _known(column.outer_diameter_m)
    if is_solid(column):
        return math.pi * outer / 32
    return math.pi * (outer - _known(column.wall_m)) / 48


def _known(size: float | None) -> float:
    """A size [m] that the shape needs, or that is filled."""
    assert size is not None
    return size


def _filled(section: _Filled, **values: float) -> _Filled:
    """A section with values for the keys that it leaves open, rounded down to four digits and no
    larger than the keys may be.
    """
    most = {one.name: one.metadata.get("high") for one in dataclasses.fields(section)}
    found = {
        key: value if isinstance(value, int) else _rounded(min(value, most[key] or math.inf))
        for key, value in values.items()
        if getattr(section, key) is None
    }
    return dataclasses.replace(section, **found) if found else section


def _rounded(value: float) -> float:
    unit = 10.0 ** (math.floor(math.log10(value)) - 3) if value > 0 else 1.0
    return float(f"{math.floor(value / unit * (1 + 1e-12)) * unit:.4g}")


def check_sizes(case: ColumnSections, file: Path | str) -> None:
    """Refuse parts that do not fit, and a mesh above `mesh.limit_dofs`."""
    column, base, mesh, cap, flange = case.column, case.base, case.mesh, case.cap, case.flange
    outline = foot_sides(case) if column.mesh_file else outline_sides(column)
    refuse = refuse_in(file)
    fine, coarse = _known(mesh.fine_size_m), _known(mesh.coarse_size_m)
    if column.mesh_file:
        from fecolumn.mesh.imported import imported_column

        imported_column(case)
    else:
        if column.shape == "tube" and _known(column.wall_m) > (
            (radius := _known(column.outer_diameter_m) / 2) * (1 + 1e-9)
        ):
            refuse(
                "column.wall_m",
                column.wall_m,
                f"must be at most the outer radius, {radius:g} m",
            )
        check_fine_height(
            "column.fine_height_m", column.fine_height_m, _known(column.height_m), refuse
        )
        if (
            column.shape == "tube"
            and not flange
            and fine > max(wall := _known(column.wall_m), _fine(column)) * (1 + 1e-9)
        ):
            refuse(
                "mesh.fine_size_m",
                fine,
                f"must be at most the wall, column.wall_m = {wall:g} m, or a "
                f"48th of the circumference, {_fine(column):.4g} m",
            )
        if column.shape == "block":
            if coarse > min(outline_sides(column)) * (1 + 1e-9):
                refuse(
                    "mesh.coarse_size_m",
                    coarse,
                    f"must be at most the block's shorter side, {min(outline_sides(column)):g} m",
                )
        else:
            around = math.pi * (
                _known(column.outer_diameter_m) if is_solid(column) else 2 * case.mean_radius_m
            )
            if around / coarse < 8:
                refuse(
                    "mesh.coarse_size_m",
                    coarse,
                    f"must be at most {around / 8:.4g} m: fewer than 8 bricks around do "
                    "not make a round column",
                )
    for key in ("coarse_size_m", "base_size_m"):
        if getattr(mesh, key) < fine * (1 - 1e-9):
            refuse(
                f"mesh.{key}",
                getattr(mesh, key),
                f"must be at least mesh.fine_size_m = {fine:g} m",
            )
    if not column.mesh_file:
        sides = ("length_m", "width_m") if column.shape == "block" else ("outer_diameter_m",) * 2
        bore = 0.0
        if column.shape == "tube" and not is_solid(column):
            bore = outline[0] - 2 * _known(column.wall_m)
        own = OwnSize(outline, (f"column.{sides[0]}", f"column.{sides[1]}"), bore)
        check_plates("", own, flange, cap, refuse)
    for key, side in zip(("length_m", "width_m"), foot_sides(case)) if base.kind == "plate" else ():
        least = least_side(side, _known(base.slide_allowance_m))
        if getattr(base, key) < least * (1 - 1e-9):
            refuse(
                f"base.{key}",
                getattr(base, key),
                f"must be at least the foot and twice slide_allowance_m, {least:g} m",
            )
    from fecolumn.mesh.estimate import refuse_large_column

    refuse_large_column(case, file)
