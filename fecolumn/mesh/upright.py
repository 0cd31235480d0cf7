"""What a column is meshed from: sections of a case, whoever states them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    import dataclasses


class Upright:
    """What a column is meshed from: sections by their names in the short form of a case.

    Attributes
    ----------
    column, mesh
        dimensions, and element sizes, all of them known.
    flange, cap
        plates at foot and top, or None.
    base, material
        below it and of it; only the mesh of a whole case asks for them.
    integration
        of a whole case; only an estimate asks for it.
    """

    __slots__ = ()
    column: Any
    mesh: Any
    flange: Any
    cap: Any
    base: Any
    material: Any
    integration: Any

    if TYPE_CHECKING:  # whatever states them is a dataclass
        __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[Any]]]

    @property
    def mean_radius_m(self) -> float:
        """Radius of the wall's middle surface."""
        return (self.column.outer_diameter_m - self.column.wall_m) / 2

    @property
    def seat_m(self) -> float:
        """Height at which the column begins: the flange's thickness."""
        return self.flange.thickness_m if self.flange else 0.0

    @property
    def top_m(self) -> float:
        """Height of the top of column and cap."""
        return self.seat_m + self.column.height_m + (self.cap.thickness_m if self.cap else 0.0)
