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
        doc="unit of the lengths in mesh_file; left out: the metre, of STEP and IGES what the file "
        "says",
        choices=("m", "cm", "mm", "in", "ft"),
        since="0.10",
    )


def size_key() -> Any:
    """Size of the elements made in what a mesh file draws [m]."""
    return parameter(
        None,
        doc="size of the elements made inside a surface, a CAD body or by a script; left out: an "
        "eighth of the cube root of the volume, less of a thin body",
        unit="m",
        above=0,
        high=100,
        since="0.10",
    )


def cut_key() -> Any:
    """Height at which a drawn surface is cut off [m]."""
    return parameter(
        None,
        doc="height above its lowest point at which a surface is cut off, so that it has a flat "
        "foot; left out: not cut",
        unit="m",
        above=0,
        high=1000,
        since="0.10",
    )
