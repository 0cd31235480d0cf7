"""Keys of a structure's case: bodies of each kind, interfaces, links."""

from __future__ import annotations

import math

from fecolumn.case.mesh_file_keys import cut_key, size_key, unit_key
from fecolumn.case.sections import Cap, Flange, Motion
from fecolumn.foundation.schema import Section, parameter, required
from fecolumn.foundation.section_class import section_class
from fecolumn.mesh.mesh_file import MeshFile

#: Name of the ground of a case that states none: a rigid flat at z = 0.
GROUND = "ground"
#: Kinds of links that pull, and that push.
PULLING = ("tendon", "spring", "restrainer", "friction")
PUSHING = ("spring", "restrainer", "friction", "strut", "stop")


@section_class(kw_only=True)
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

    @property
    def places(self) -> tuple[tuple[float, ...], ...]:
        """Place of each copy [m]."""
        return self.copies_m or (self.at_m,)

    @property
    def as_drawn(self) -> bool:
        """Whether it stays where its file has it."""
        return False


@section_class(kw_only=True)
class Stuff(Placed):
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


@section_class(kw_only=True)
class Solid(Stuff):
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
        doc="a rigid body that gives only at its contact points, by "
        "contact_stiffness_n_m3; in the rigid engine every body is rigid and gives "
        "nowhere unless that is stated",
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


@section_class(kw_only=True)
class Footed(Solid):
    """Tubes, cylinders and blocks: a foot that is not flat, in the reduced and rigid engine."""

    foot_radius_m: float | None = parameter(
        None,
        doc="radius of the sphere of which the foot is a cap, its lowest point at the "
        "place of the body; the body rolls on it, and beyond its edge on that; at "
        "least the radius of a round body, the half diagonal of a block; left out: a "
        "flat foot",
        unit="m",
        above=0,
        high=1e5,
        since="0.6",
    )
    edge_radius_m: float = parameter(
        0.0,
        doc="radius by which the outer edge of a flat foot is rounded; less than half its "
        "smaller side",
        unit="m",
        low=0,
        high=50,
        since="0.6",
    )
    fine_height_m: float | None = parameter(
        None,
        doc="height of a finely meshed lower part, of element_size_m, to which a coarser upper "
        "part is tied, of coarse_size_m: what stands on one foot alone; left out: one grid, "
        "fine at both ends",
        unit="m",
        low=0,
        high=1000,
        since="0.8",
    )
    cap_size_m: float | None = parameter(
        None,
        doc="element size of the cap; left out: element_size_m, with fine_height_m a coarse "
        "element, but 16 of the cap's longer side at most",
        unit="m",
        above=0,
        high=10,
        since="0.8",
    )
    flange: Flange | None = None
    cap: Cap | None = None


@section_class(kw_only=True)
class Tube(Footed):
    """kind = "tube": a hollow cylinder, its axis along z."""

    kind: str = parameter("tube", doc="what the body is", choices=("tube",))
    outer_diameter_m: float = required(doc="outer diameter", unit="m", above=0, high=100)
    wall_m: float = required(doc="wall thickness", unit="m", above=0, high=50)
    height_m: float = required(doc="height without flange and cap", unit="m", above=0, high=1000)


@section_class(kw_only=True)
class Cylinder(Footed):
    """kind = "cylinder": a solid cylinder, its axis along z: a column, a drum."""

    kind: str = parameter("cylinder", doc="what the body is", choices=("cylinder",))
    outer_diameter_m: float = required(doc="diameter", unit="m", above=0, high=100)
    height_m: float = required(doc="height without flange and cap", unit="m", above=0, high=1000)


@section_class(kw_only=True)
class Block(Footed):
    """kind = "block": a rectangular block."""

    kind: str = parameter("block", doc="what the body is", choices=("block",))
    length_m: float = required(doc="length along x", unit="m", above=0, high=100)
    width_m: float = required(doc="width along y", unit="m", above=0, high=100)
    height_m: float = required(doc="height along z", unit="m", above=0, high=1000)
    turned_deg: float = parameter(
        0.0,
        doc="angle by which it is turned about the vertical through the middle of its "
        "foot, from x to y",
        unit="deg",
        low=-360,
        high=360,
        since="0.7",
    )


@section_class(kw_only=True)
class Plate(Solid):
    """kind = "plate" or "slab": a flat rectangular body on or below others, meshed finely where
    they meet it.
    """

    kind: str = parameter("plate", doc="what the body is", choices=("plate", "slab"))
    length_m: float = required(doc="length along x", unit="m", above=0, high=1000)
    width_m: float = required(doc="width along y", unit="m", above=0, high=1000)
    thickness_m: float = required(doc="thickness along z", unit="m", above=0, high=100)


@section_class(kw_only=True)
class Cone(Solid):
    """kind = "cone": a solid frustum of a cone, its axis along z: a tapered drum."""

    kind: str = parameter("cone", doc="what the body is", choices=("cone",))
    bottom_diameter_m: float = required(doc="diameter of its foot", unit="m", above=0, high=100)
    top_diameter_m: float = required(doc="diameter of its head", unit="m", above=0, high=100)
    height_m: float = required(doc="height", unit="m", above=0, high=1000)

    @property
    def outer_diameter_m(self) -> float:
        """The larger diameter."""
        return max(self.bottom_diameter_m, self.top_diameter_m)


@section_class(kw_only=True)
class Prism(Solid):
    """kind = "prism": an extruded polygon: a voussoir, a wedge, a tapered pier, a buttress; meshed
    in elements of element_size_m, which every corner of it is a node of.
    """

    kind: str = parameter("prism", doc="what the body is", choices=("prism",))
    at_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="place [x, y, z] from which its outline is measured, so that many prisms may be drawn "
        "in one frame",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    outline_m: tuple[tuple[float, ...], ...] = required(
        doc="corners of the polygon in their order, in either sense: [x, z] of each, with "
        'along = "z" [x, y]',
        unit="m",
        low=-1e4,
        high=1e4,
    )
    width_m: float = required(
        doc="length along y, half of it to each side of at_m; with "
        'along = "z" its height, from at_m upwards',
        unit="m",
        above=0,
        high=1000,
    )
    along: str = parameter("y", doc="axis along which the outline is extruded", choices=("y", "z"))
    turned_deg: float = parameter(
        0.0,
        doc="angle by which it is turned about the vertical through at_m, from x to y",
        unit="deg",
        low=-360,
        high=360,
    )


@section_class(kw_only=True)
class Arch(Solid):
    """kind = "arch": a ring sector in the plane of x and z of equal voussoirs, prisms "NAME 1",
    "NAME 2" ... from from_deg on; NAME stands for all of them, in a joint between NAME and NAME for
    neighbours. mass_kg is that of all. A table [bodies."NAME 3"] beside it has what differs of that
    voussoir: its material, mass, mesh, whether it is fixed.
    """

    kind: str = parameter("arch", doc="what the body is", choices=("arch",))
    at_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="place [x, y, z] of the middle of its circle",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    mean_radius_m: float = required(doc="radius of its middle line", unit="m", above=0, high=1000)
    thickness_m: float = required(
        doc="thickness along the radius; less than 2 mean_radius_m", unit="m", above=0, high=1000
    )
    width_m: float = required(
        doc="length along y, half of it to each side of at_m", unit="m", above=0, high=1000
    )
    voussoirs: int = required(doc="number of voussoirs", low=2, high=500)
    from_deg: float = parameter(
        0.0, doc="angle of its first springing from the x axis", unit="deg", low=-360, high=360
    )
    to_deg: float = parameter(
        180.0,
        doc="angle of its last springing; greater than from_deg, by less than 360",
        unit="deg",
        low=-360,
        high=360,
    )
    arc_sides: int = parameter(
        4,
        doc="straight sides of each voussoir along its inner and its outer arc, corners so far "
        "outside these that its area is that of the true sector",
        low=1,
        high=100,
    )
    turned_deg: float = parameter(
        0.0,
        doc="angle by which it is turned about the vertical through at_m, from x to y",
        unit="deg",
        low=-360,
        high=360,
    )


@section_class(kw_only=True)
class Meshed(Solid):
    """kind = "mesh": a body of one's own mesh, where its file has it unless at_m or copies_m says
    otherwise; element_size_m is the length that penalty_factor refers to.
    """

    @classmethod
    def section_name(cls) -> str:
        """Other than the table [mesh]."""
        return "mesh body"

    @classmethod
    def public_name(cls) -> str:
        """Of a script."""
        return "MeshBody"

    kind: str = parameter("mesh", doc="what the body is", choices=("mesh",))
    at_m: tuple[float, ...] | None = parameter(
        None,
        doc="place [x, y, z] to which the middle of its flat foot is moved; left out: nothing is "
        "moved",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    mesh_file: str = required(
        doc="shape of the body, z up: elements, 8-node bricks or tetrahedra, in any format meshio "
        "reads; a closed surface (.stl, .obj, .ply), a CAD body (.step, .iges) or a script of Gmsh "
        "(.geo), in which elements are made"
    )
    mesh_unit: str | None = unit_key()
    mesh_size_m: float | None = size_key()
    cut_foot_m: float | None = cut_key()
    turned_deg: float = parameter(
        0.0,
        doc="angle by which it is turned about the vertical through the middle of its "
        "foot, or of its lowest points, from x to y",
        unit="deg",
        low=-360,
        high=360,
        since="0.7",
    )
    cap_size_m: float | None = parameter(
        None,
        doc="element size of the cap; left out: 16 elements along the cap's longer side",
        unit="m",
        above=0,
        high=10,
        since="0.8",
    )
    cap: Cap | None = None

    @property
    def drawn(self) -> MeshFile:
        """What mesh_file is, and how it is made into elements."""
        return MeshFile(self.mesh_file, self.mesh_unit or "", self.mesh_size_m, self.cut_foot_m)

    @property
    def places(self) -> tuple[tuple[float, ...], ...]:
        """Place of each copy [m]; the origin of its file where it stays as drawn."""
        return self.copies_m or (self.at_m or (0.0, 0.0, 0.0),)

    @property
    def as_drawn(self) -> bool:
        """Whether it stays where its file has it."""
        return self.at_m is None and not self.copies_m


@section_class(kw_only=True)
class Storeys(Stuff):
    """kind = "storeys": a rigid slab with a building on it, whose floors move sideways on springs;
    each list has a number a floor, from below, or one for all.
    """

    kind: str = parameter("storeys", doc="what the body is", choices=("storeys",))
    length_m: float = required(
        doc="length of slab and floors along x", unit="m", above=0, high=1000
    )
    width_m: float = required(doc="width of slab and floors along y", unit="m", above=0, high=1000)
    thickness_m: float = required(
        doc="thickness of the slab; its mass is mass_kg or by its density",
        unit="m",
        above=0,
        high=100,
    )
    floors: int = required(doc="number of floors above the slab", low=1, high=100)
    floor_masses_kg: tuple[float, ...] = required(
        doc="mass of each floor", unit="kg", above=0, high=1e12
    )
    storey_heights_m: tuple[float, ...] = required(
        doc="height of each storey, the first above the slab's top", unit="m", above=0, high=100
    )
    stiffness_x_n_m: tuple[float, ...] = parameter(
        (), doc="stiffness of each storey along x; or give period_s", unit="N/m", above=0, high=1e15
    )
    stiffness_y_n_m: tuple[float, ...] = parameter(
        (),
        doc="stiffness of each storey along y; left out: as along x",
        unit="N/m",
        above=0,
        high=1e15,
    )
    period_s: float | None = parameter(
        None,
        doc="first period of the building on a fixed slab, along x and y, instead of stiffnesses",
        unit="s",
        above=0,
        high=100,
    )
    profile: str = parameter(
        "uniform",
        doc="stiffnesses that give period_s: uniform: all alike; triangular, shear, "
        "flexural: such that floors at height z of H move in the first mode as z / H, "
        "sin(pi z / 2 H), 1 - cos(pi z / 2 H)",
        choices=("uniform", "triangular", "shear", "flexural"),
    )
    damping: str = parameter(
        "modal",
        doc="modal: damping_ratio in each mode; rayleigh: damping_ratio in rayleigh_modes "
        "of the building on a fixed slab, in others by Rayleigh's law",
        choices=("modal", "rayleigh"),
    )
    rayleigh_modes: tuple[int, ...] = parameter(
        (1, 2),
        doc="two modes along an axis that have damping_ratio by Rayleigh's law",
        low=1,
        high=100,
    )


@section_class(kw_only=True)
class Matrices(Placed):
    """kind = "matrices": mass and stiffness of an elastic body from another program; it is free,
    nothing holds it.
    """

    kind: str = parameter("matrices", doc="what the body is", choices=("matrices",))
    mass_file: str = required(
        doc="mass matrix [kg]: MatrixMarket (.mtx), scipy.sparse.save_npz, or .npz with "
        "the array mass"
    )
    stiffness_file: str = required(
        doc="stiffness matrix [N/m]: likewise, in .npz the array stiffness"
    )
    nodes_file: str = required(
        doc=".npz with the arrays dofs (n, 3), rows of the matrices for x, y, z of each "
        "contact node counted from 0, and coordinates (n, 3) [m], if wanted triangles "
        "(t, 3) of its faces; or text with these six numbers a line"
    )


@section_class(kw_only=True)
class MeshLimits(Section):
    """How large the meshes of a structure may be; sizes of elements are those of its bodies."""

    limit_dofs: int = parameter(
        500_000,
        doc="degrees of freedom of all different bodies together above which their meshes "
        'are refused before they are built; with engine = "full" of all copies',
        low=100,
        high=10**9,
        counts=False,
        since="0.7",
    )

    @classmethod
    def section_name(cls) -> str:
        """As its table."""
        return "mesh"


#: Class of the keys by kind of body.
KINDS = {
    "tube": Tube,
    "cylinder": Cylinder,
    "block": Block,
    "plate": Plate,
    "slab": Plate,
    "cone": Cone,
    "prism": Prism,
    "arch": Arch,
    "mesh": Meshed,
    "storeys": Storeys,
    "matrices": Matrices,
}


@section_class(kw_only=True)
class Ground(Section):
    """What bodies stand on, and what moves with the ground motion: a rigid flat, an elastic plate
    held at its bottom, the same layer without edges, or a pad of springs and dashpots, such as
    soil.
    """

    kind: str = parameter(
        "rigid",
        doc="rigid: a flat that does not give; plate: elastic plate with edges; unbounded: the "
        "same layer without edges; pad: springs and dashpots per area, without edges",
        choices=("rigid", "plate", "unbounded", "pad"),
    )
    level_m: float = parameter(0.0, doc="height of its top", unit="m", low=-1e4, high=1e4)
    length_m: float | None = parameter(
        None,
        doc="length of a plate along x, its middle below that of all that stands on it; left "
        "out: the feet's and three times the larger side of the largest foot",
        unit="m",
        above=0,
        high=1000,
    )
    width_m: float | None = parameter(
        None, doc="width of a plate along y, likewise", unit="m", above=0, high=1000
    )
    thickness_m: float | None = parameter(
        None,
        doc="thickness of plate or layer; left out: a quarter of the smallest foot's smaller side",
        unit="m",
        above=0,
        high=100,
    )
    slide_allowance_m: float | None = parameter(
        None,
        doc="finely meshed margin around each foot, on an unbounded ground with several feet how "
        "far they may slide apart; left out: a quarter of the smallest foot's smaller side",
        unit="m",
        low=0,
        high=1000,
    )
    youngs_modulus_pa: float = parameter(
        200e9, doc="Young's modulus of plate or layer", unit="Pa", above=0, high=1e15
    )
    poissons_ratio: float = parameter(
        0.3, doc="Poisson's ratio of plate or layer", low=0, high=0.49
    )
    density_kg_m3: float = parameter(
        7850.0, doc="density of plate or layer", unit="kg/m3", above=0, high=1e5
    )
    element_size_m: float | None = parameter(
        None,
        doc="size of the elements of plate or layer below feet; left out: a twelfth of the "
        "smallest foot's side, by its area",
        unit="m",
        above=0,
        high=10,
    )
    coarse_size_m: float | None = parameter(
        None,
        doc="largest size of the elements of plate or layer; left out: six times element_size_m",
        unit="m",
        above=0,
        high=10,
    )
    stiffness_n_m3: float = parameter(
        0.0,
        doc="springs across a pad per area (subgrade modulus); a pad needs it",
        unit="N/m3",
        low=0,
        high=1e15,
    )
    shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="springs along a pad per area; 0 takes 0.8 of stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
    )
    damping_ratio: float = parameter(
        0.0,
        doc="of the dashpots of a pad: that of the vertical vibration of all that stands on it",
        low=0,
        high=10,
    )
    yield_pa: float | None = parameter(
        None,
        doc="pressure at which a pad yields, and settles for good; left out: never",
        unit="Pa",
        above=0,
        high=1e12,
    )
    motion: Motion | None = None


@section_class(kw_only=True)
class Interface(Section):
    """A joint: faces of two bodies, or of a body and a ground, that touch at the start, or look at
    one another across a gap; copies each with each. Which body comes first decides nothing.
    """

    @classmethod
    def section_name(cls) -> str:
        """As of its table [joints.NAME]."""
        return "joint"

    @classmethod
    def public_name(cls) -> str:
        """Of a script."""
        return "Joint"

    between: tuple[str, ...] = parameter(
        (),
        doc='the two bodies that touch, or a body and a ground, as in ["drum", "ground"]; '
        "the same body twice where copies stand on one another, or voussoirs of an arch touch",
    )
    slave: str = parameter("", doc="instead of between: one of the two bodies")
    on: str = parameter("", doc="instead of between: the other body, or a ground")
    friction_coefficient: float | None = parameter(
        None, doc="Coulomb friction coefficient; left out: that of [contact]", low=0, high=10
    )
    law: str | None = parameter(
        None,
        doc="contact formulation; left out: that of [contact]",
        choices=("augmented_lagrange", "penalty"),
    )
    penalty_factor: float | None = parameter(
        None,
        doc="penalty stiffness per area as a multiple of E / element size of the slave; "
        "left out: that of [contact]",
        above=0,
        high=1e9,
    )
    restitution: float | None = parameter(
        None, doc="velocity after over before an impact; left out: that of [contact]", low=0, high=1
    )
    rolling_resistance: float | None = parameter(
        None,
        doc="energy that a rolling rim loses per length rolled, over the contact force; left "
        "out: that of [contact], 0 on a pad",
        low=0,
        high=0.1,
        since="0.7",
    )
    stiffness_n_m3: float | None = parameter(
        None,
        doc="springs across a pad between the two, per area; left out: that of the ground, "
        "between bodies no pad",
        unit="N/m3",
        above=0,
        high=1e15,
        since="0.7",
    )
    shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="springs along the pad per area; 0 takes 0.8 of stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.7",
    )
    damping_ratio: float = parameter(
        0.0,
        doc="of the dashpots of the pad: that of the vertical vibration on it of what it carries",
        low=0,
        high=10,
        since="0.7",
    )
    yield_pa: float | None = parameter(
        None,
        doc="pressure at which the pad yields, and settles for good; left out: never",
        unit="Pa",
        above=0,
        high=1e12,
        since="0.7",
    )
    tension_pa: float = parameter(
        0.0,
        doc="tensile strength of wax, putty or mortar between the faces, which holds each contact "
        "point until it fails there; 0: nothing holds them together",
        unit="Pa",
        low=0,
        high=1e9,
        since="0.11",
    )
    cohesion_pa: float | None = parameter(
        None,
        doc="shear strength of that layer without pressure, friction comes on top; left out: "
        "tension_pa",
        unit="Pa",
        above=0,
        high=1e9,
        since="0.11",
    )
    fracture_energy_j_m2: float = parameter(
        0.0,
        doc="energy that the layer takes per area until it has failed, its stress falling in a "
        "straight line; 0: it fails at once",
        unit="J/m2",
        low=0,
        high=1e7,
        since="0.11",
    )
    bond_stiffness_n_m3: float = parameter(
        0.0,
        doc="stiffness of that layer per area: its modulus over its thickness",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.11",
    )
    bond_shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="stiffness of that layer per area along the faces; 0 takes 0.4 of bond_stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.11",
    )
    interior_points: int | None = parameter(
        None,
        doc="contact points inside the outlines of the slave's face; left out: that of [contact]",
        low=0,
        high=10**6,
    )
    open: bool | None = parameter(
        None,
        doc="whether faces that look at one another across a gap belong to it, too, and may meet; "
        "left out: where no faces of the two touch at the start",
        since="0.9",
    )
    allowance_m: float | None = parameter(
        None,
        doc="how far the slave may slide on a body before its compliance ends; left out: a "
        "quarter of the slave's smaller side, its larger one across a gap",
        unit="m",
        low=0,
        high=1000,
    )


@section_class(kw_only=True)
class LinkKeys(Section):
    """A tendon, spring, strut, stop, damper or restrainer between two points; of a body with copies
    one at each. Its length is the points' distance.
    """

    @classmethod
    def section_name(cls) -> str:
        """As of its table [links.NAME]."""
        return "link"

    @classmethod
    def public_name(cls) -> str:
        """Of a script."""
        return "Link" if cls is LinkKeys else cls.__name__

    kind: str = required(
        doc="tendon: only pulls; spring: pulls and pushes; restrainer: pulls and pushes beyond "
        "slack_m; strut: only pushes; stop: only pushes, beyond gap_m; dashpot: damps; friction: "
        "a friction damper, elastic until it slips at slip_n",
        choices=("tendon", "spring", "restrainer", "strut", "stop", "dashpot", "friction"),
    )
    body: str = required(doc="body at one end")
    point_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="point [x, y, z] of that body, from the middle of its foot; of a prism from its at_m, "
        "of a mesh that stays as drawn as its file has it",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    to: str = parameter(GROUND, doc="body at the other end, or a ground")
    to_point_m: tuple[float, ...] = required(
        doc="point [x, y, z] of the other end at the start, from the same place of "
        "`body` as point_m, so that it holds for each copy",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    stiffness_n_m: float = parameter(
        0.0, doc="axial stiffness; all but a dashpot need it", unit="N/m", low=0, high=1e15
    )
    damping_n_s_m: float = parameter(
        0.0,
        doc="axial damping; with damping_exponent the force at 1 m/s; a dashpot needs it",
        unit="N s/m",
        low=0,
        high=1e15,
    )
    damping_exponent: float = parameter(
        1.0,
        doc="power of the rate of elongation to which the damping force is proportional: "
        "c |v|^a sign(v), as of viscous dampers with orifices",
        above=0,
        high=2,
        since="0.11",
    )
    linear_below_m_s: float = parameter(
        1e-3,
        doc="rate below which a damping force of damping_exponent < 1 is proportional to the rate, "
        "as its slope would have no bound",
        unit="m/s",
        above=0,
        high=1,
        since="0.11",
    )
    prestress_n: float = parameter(
        0.0,
        doc="tension at the start, of a strut or stop compression",
        unit="N",
        low=0,
        high=1e12,
    )
    slack_m: float = parameter(
        0.0,
        doc="elongation, of a restrainer to each side, before it acts",
        unit="m",
        low=0,
        high=100,
    )
    gap_m: float = parameter(
        0.0, doc="shortening of a stop before it acts", unit="m", low=0, high=100, since="0.11"
    )
    yield_n: float | None = parameter(
        None,
        doc="force at which it yields, both ways as far as it pulls and pushes: it stays at that "
        "force, or hardens, and keeps what has yielded as residual elongation; left out: never",
        unit="N",
        above=0,
        high=1e12,
    )
    hardening: float = parameter(
        0.0,
        doc="stiffness after yielding over that before; kinematic: it yields back after 2 yield_n",
        low=0,
        high=0.99,
        since="0.11",
    )
    yield_exponent: float | None = parameter(
        None,
        doc="exponent n of the curve along which it comes to yield or slip (Bouc-Wen): the larger "
        "the sharper; left out: a corner",
        low=1,
        high=50,
        since="0.11",
    )
    slip_n: float | None = parameter(
        None,
        doc="force at which a friction damper slips, both ways",
        unit="N",
        above=0,
        high=1e12,
        since="0.11",
    )
    breaking_n: float | None = parameter(
        None,
        doc="force at which it breaks for good, of one that yields at the elongation at "
        "which it would have that force had it not; left out: never",
        unit="N",
        above=0,
        high=1e12,
    )


def half_sides(body) -> tuple[float, float]:
    """Radius [m] of a round foot and 0, or half the sides of a rectangular one, as of
    `model.Ball.edge`.
    """
    if isinstance(body, Block):
        return body.length_m / 2, body.width_m / 2
    if isinstance(body, Cone):
        return body.bottom_diameter_m / 2, 0.0
    return (body.flange.outer_diameter_m if body.flange else body.outer_diameter_m) / 2, 0.0


def rise(body) -> float:
    """Height [m] of the highest point of a dome over its lowest one."""
    return body.foot_radius_m - math.sqrt(
        max(body.foot_radius_m**2 - sum(half**2 for half in half_sides(body)), 0.0)
    )
