"""A file with a body's shape: elements, a closed surface, or a body of a CAD program."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

#: Metres of each unit of length in which a file may be.
METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
#: Endings of closed surfaces, of CAD bodies (which state their unit), and of Gmsh's own scripts.
SURFACES = (".stl", ".obj", ".ply")
CAD = (".step", ".stp", ".iges", ".igs")
SCRIPTS = (".geo",)
# Sizes [m] of a body that no unit was stated for; of one that there can be at all
_LIKELY, _POSSIBLE = (0.01, 100.0), (5e-3, 1e4)
# Size [m] from which a body without a unit is told of: 30 mm drawn in millimetres would be as large
_LARGE = 10.0


class UnusableShape(ValueError):
    """What is wrong with a file, and what to do: value, such as "12 holes", and allowed."""

    def __init__(self, value: str | None, allowed: str) -> None:
        super().__init__(f"{value}: {allowed}" if value else allowed)
        self.value, self.allowed = value, allowed


@dataclass(frozen=True, slots=True)
class MeshFile:
    """Where a body's shape is, and how it is made into elements.

    Attributes
    ----------
    path
        the file.
    unit
        of its lengths, one of METRES; "" is the metre, or what a CAD file says.
    size
        size of the elements made inside a surface, a CAD body or a script [m]; None: one that
        follows from the body.
    cut_foot
        height above its lowest point at which a surface is cut off, so that it stands on a flat
        foot [m]; None leaves it as it is.
    """

    path: str
    unit: str = ""
    size: float | None = None
    cut_foot: float | None = None

    @property
    def metres(self) -> float:
        """Metres of a unit of the file."""
        return METRES[self.unit or "m"]

    @property
    def kind(self) -> str:
        """What it holds by its ending: "surface", "CAD", "script" or "elements"."""
        ending = Path(self.path).suffix.lower()
        kinds = {"surface": SURFACES, "CAD": CAD, "script": SCRIPTS}
        return next((kind for kind, endings in kinds.items() if ending in endings), "elements")

    def check_size(self, extents: np.ndarray) -> None:
        """Refuse a body whose largest side of the three [m] tells of another unit.

        Raises
        ------
        UnusableShape
            names the unit that may be meant.
        """
        size = float(max(extents))
        low, high = _POSSIBLE if self.unit else _LIKELY
        if low <= size <= high:
            return
        likely = [
            f'mesh_unit = "{unit}" makes it {size * metres / self.metres:.3g} m'
            for unit, metres in METRES.items()
            if unit != (self.unit or "m") and 0.1 <= size * metres / self.metres <= 20
        ]
        ways = " or ".join(likely) or "export it in metres"
        same = (
            ""
            if self.unit
            else f'; if it is so large, state mesh_unit = "m" (up to {_POSSIBLE[1]:g} m)'
        )
        if size < low and not self.unit:
            same = ""
        raise UnusableShape(
            f"{size:.4g} m from side to side",
            f"must be {low:g} to {high:g} m in {self.unit or 'm'}: {ways}{same}",
        )

    def doubt_of_size(self, extents: np.ndarray) -> str:
        """What to say of so large a body, by its three sides [m], that no unit was stated for, ""
        of others.
        """
        size = float(max(extents))
        if self.unit or self.kind == "CAD" or size <= _LARGE:
            return ""
        return (
            f"is {size:.3g} m from side to side, as its lengths are taken for metres: state "
            f'mesh_unit = "mm" if it is {1e-3 * size:.3g} m, or mesh_unit = "m"'
        )

    def unfit(self) -> tuple[str, object, str] | None:
        """Key, value and reason of the first key that says nothing of a file of this kind."""
        if self.cut_foot is not None and self.kind != "surface":
            what = f"says nothing of {self._told}; only a surface ({', '.join(SURFACES)}) is cut"
            return "cut_foot_m", self.cut_foot, what
        if self.size is not None and self.kind == "elements":
            what = f"says nothing of {self._told}, whose elements are in the file"
            return "mesh_size_m", self.size, what
        if self.unit and self.kind == "CAD":
            what = "must be left out: a STEP or IGES file states its unit itself"
            return "mesh_unit", self.unit, what
        return None

    @property
    def _told(self) -> str:
        return f"a {Path(self.path).suffix or 'nameless'} file"
