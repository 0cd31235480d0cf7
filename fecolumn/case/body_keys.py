"""Keys that bodies of several kinds have."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fecolumn.foundation.schema import Section, parameter
from fecolumn.foundation.section_class import section_class


@section_class()
class Placed(Section):
    """Keys of every body: its place at the start, upright, and its modes."""

    at_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="place [x, y, z] of the middle of the body's foot",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    copies_m: tuple[tuple[float, ...], ...] = parameter(
        (),
        doc="places of several equal bodies, a list, instead of at_m: NAME then stands for all "
        'of them, "NAME 1" for the first',
        unit="m",
        low=-1e4,
        high=1e4,
    )
    modes: int | None = parameter(
        None,
        doc="number of elastic modes in the reduced engine, as integration.n_modes, which counts "
        "where it is left out",
        low=0,
        high=1000,
    )
    damping_ratio: float | None = parameter(
        None,
        doc="damping ratio of the elastic modes of the free body; rigid-body motion is not damped, "
        "so that the sway of a slender body that stands has a fraction of it; left out: that of "
        "its material, 0 for matrices",
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
    """Keys of every body except matrices: its material, and the stiffness of its faces where it
    does not deform.
    """

    material: str = parameter(
        "",
        doc="name of a table of [materials]; the keys below take the place of single values "
        "of it; left out: steel",
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
        None,
        doc="mass, instead of density_kg_m3, which then follows from it",
        unit="kg",
        above=0,
        high=1e12,
    )
    contact_stiffness_n_m3: float | None = parameter(
        None,
        doc="contact stiffness per area of the faces of a rigid or fixed body; left out: that of "
        "a rigid punch of the face's area A on the body's material, 2 E / ((1 - nu^2) "
        "sqrt(pi A)); in the rigid engine no compliance",
        unit="N/m3",
        above=0,
        high=1e20,
    )
    element_size_m: float | None = parameter(
        None,
        doc="element size at foot and head, and where other bodies stand; left out: 24 elements "
        "around a round body, 8 along the mean side of a block or prism; with fine_height_m, "
        "and in a block with cap or flange, 48, 32 and 12 as fine_size_m of [mesh]; in a "
        "plate half the smaller side of what stands on it, a quarter where its elements are "
        "of order 1",
        unit="m",
        above=0,
        high=100,
    )


@section_class()
class Solid(WithMaterial):
    """Keys of every body except matrices and storeys: its finite elements, and whether it is rigid
    or fixed.
    """

    coarse_size_m: float | None = parameter(
        None,
        doc="largest element size elsewhere; left out: a fifth of the diameter or smaller side; "
        "in a plate an eighth of its longer side; in a body with fine_height_m, and in a "
        "block with cap or flange, as coarse_size_m of [mesh]; not for prisms and meshes",
        unit="m",
        above=0,
        high=100,
    )
    centre_m: tuple[float, ...] = parameter(
        (),
        doc="centre of mass [x, y, z], if known by weighing, measured from the same point as "
        "point_m of a link, but before turned_deg; left out: that of the body's shape",
        unit="m",
        low=-1e4,
        high=1e4,
        since="0.10",
    )
    inertia_kg_m2: tuple[float, ...] = parameter(
        (),
        doc="inertia tensor about the centre of mass, [xx, yy, zz] or [xx, yy, zz, xy, xz, yz], "
        "before turned_deg; left out: that of the body's shape",
        unit="kg m2",
        low=-1e15,
        high=1e15,
        since="0.10",
    )
    element_order: int | None = parameter(
        None,
        doc="polynomial order of the body's elements; left out: 1, but 2 for plates and tetrahedra",
        low=1,
        high=2,
    )
    rigid: bool = parameter(
        False,
        doc="true: a rigid body that is compliant only at its contact points, by "
        "contact_stiffness_n_m3; in the rigid engine every body is rigid, with compliant "
        "contact points only where that key is stated",
    )
    fixed: bool = parameter(
        False,
        doc="true: a rigid body that is fixed to a ground, such as an abutment, a springer, a "
        "wall; other bodies touch it at joints, as they touch any body",
        since="0.9",
    )
    moves_with: str = parameter(
        "", doc="ground to which a fixed body is fixed; left out: the first ground", since="0.9"
    )

    @property
    def deforms(self) -> bool:
        """Whether its finite elements deform."""
        return not (self.rigid or self.fixed)
