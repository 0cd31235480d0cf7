"""Keys that bodies of several kinds have."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fecolumn.foundation.schema import Section, parameter
from fecolumn.foundation.section_class import section_class


@section_class()
class Placed(Section):
    """Every body: where it is at the start, upright, and its modes."""

    at_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="place [x, y, z] of the middle of its foot",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    copies_m: tuple[tuple[float, ...], ...] = parameter(
        (),
        doc="places of equal bodies in a list, instead of at_m: NAME then stands for all "
        'of them, "NAME 1" for the first',
        unit="m",
        low=-1e4,
        high=1e4,
    )
    modes: int | None = parameter(
        None,
        doc="elastic modes of the reduced engine; left out: integration.n_modes",
        low=0,
        high=1000,
    )
    damping_ratio: float | None = parameter(
        None,
        doc="damping ratio of its elastic modes, never of rigid motion; left out: that of "
        "its material",
        low=0,
        high=0.5,
    )

    if TYPE_CHECKING:  # a key of each kind of body

        @property
        def kind(self) -> str:
            """What the body is."""

    @property
    def places(self) -> tuple[tuple[float, ...], ...]:
        """Place of each copy [m]."""
        return self.copies_m or (self.at_m,)

    @property
    def as_drawn(self) -> bool:
        """Whether it stays where its file has it."""
        return False


@section_class()
class WithMaterial(Placed):
    """Every body but one of matrices: what it is made of, and how stiff its faces are where it does
    not deform.
    """

    material: str = parameter(
        "", doc="name of a table of [materials]; left out: steel, but for the keys below"
    )
    youngs_modulus_pa: float | None = parameter(
        None, doc="Young's modulus; left out: the material's", unit="Pa", above=0, high=1e15
    )
    poissons_ratio: float | None = parameter(
        None, doc="Poisson's ratio; left out: the material's", low=0, high=0.49
    )
    density_kg_m3: float | None = parameter(
        None, doc="density; left out: the material's", unit="kg/m3", above=0, high=1e5
    )
    mass_kg: float | None = parameter(
        None, doc="mass; its density follows from it", unit="kg", above=0, high=1e12
    )
    contact_stiffness_n_m3: float | None = parameter(
        None,
        doc="stiffness per area of the faces of a body that does not deform; left out: "
        "that of a rigid punch of the face's area on its material, 2 E / ((1 - nu^2) "
        "sqrt(pi A)), none in the rigid engine",
        unit="N/m3",
        above=0,
        high=1e20,
    )
    element_size_m: float | None = parameter(
        None,
        doc="element size at feet, heads and where other bodies stand; left out: 24 "
        "elements around, 8 along a block, a half of what stands on a plate",
        unit="m",
        above=0,
        high=100,
    )


@section_class()
class Solid(WithMaterial):
    """Every body but one of matrices or storeys: its finite elements."""

    coarse_size_m: float | None = parameter(
        None,
        doc="largest element size away from there; left out: a fifth of the smaller side, "
        "of a plate an eighth of its longer one",
        unit="m",
        above=0,
        high=100,
    )
    centre_m: tuple[float, ...] = parameter(
        (),
        doc="centre of mass [x, y, z] where it was found by weighing, measured as point_m of a "
        "link is; left out: that of its shape",
        unit="m",
        low=-1e4,
        high=1e4,
        since="0.10",
    )
    inertia_kg_m2: tuple[float, ...] = parameter(
        (),
        doc="inertia about the centre of mass, [xx, yy, zz] or [xx, yy, zz, xy, xz, yz] of the "
        "tensor, before turned_deg; left out: that of its shape",
        unit="kg m2",
        low=-1e15,
        high=1e15,
        since="0.10",
    )
    element_order: int | None = parameter(
        None,
        doc="polynomial order of its elements; left out: 1, but 2 of plates and tetrahedra",
        low=1,
        high=2,
    )
    rigid: bool = parameter(
        False,
        doc="a rigid body, whose contact points alone are compliant, by "
        "contact_stiffness_n_m3; in the rigid engine every body is rigid, with contact points "
        "that are compliant where that key is stated",
    )
    fixed: bool = parameter(
        False,
        doc="a rigid body that a ground holds: an abutment, a springer, a wall; bodies meet it by "
        "joints, as any other body",
        since="0.9",
    )
    moves_with: str = parameter(
        "", doc="ground with which a fixed body moves; left out: the first", since="0.9"
    )

    @property
    def deforms(self) -> bool:
        """Whether its finite elements deform."""
        return not (self.rigid or self.fixed)
