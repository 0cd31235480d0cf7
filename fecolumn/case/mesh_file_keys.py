"""Keys of a mesh file that a body of [bodies] and the column of the short form share.

Each is the default of a field of another type, as `parameter` is.
"""

from __future__ import annotations

from typing import Any

from fecolumn.foundation.schema import parameter


def unit_key() -> Any:
    """Unit of a mesh file."""
    return parameter(
        None,
        doc="unit of the lengths in mesh_file; left out: metres, for STEP and IGES the unit that "
        "the file states",
        choices=("m", "cm", "mm", "in", "ft"),
        since="0.10",
    )


def size_key() -> Any:
    """Size of the elements made in what a mesh file draws [m]."""
    return parameter(
        None,
        doc="size of the elements with which a surface, a CAD body or a script of Gmsh is "
        "meshed; left out: an eighth of the cube root of the volume, less for a thin body",
        unit="m",
        above=0,
        high=100,
        since="0.10",
    )


def cut_key() -> Any:
    """Height at which a drawn surface is cut off [m]."""
    return parameter(
        None,
        doc="height above the lowest point at which a surface is cut off, so that the body has a "
        "flat foot; left out: not cut",
        unit="m",
        above=0,
        high=1000,
        since="0.10",
    )
