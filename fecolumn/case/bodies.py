"""Keys of a body, by its kind."""

from __future__ import annotations

import math
from typing import ClassVar

from fecolumn.case.body_keys import Placed, Solid, WithMaterial
from fecolumn.case.mesh_file_keys import cut_key, size_key, unit_key
from fecolumn.case.sections import Cap, Flange
from fecolumn.foundation.schema import parameter, required
from fecolumn.foundation.section_class import section_class
from fecolumn.mesh.mesh_file import MeshFile


@section_class()
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


@section_class()
class Tube(Footed):
    """kind = "tube": a hollow cylinder, its axis along z."""

    kind: str = parameter("tube", doc="what the body is", choices=("tube",))
    outer_diameter_m: float = required(doc="outer diameter", unit="m", above=0, high=100)
    wall_m: float = required(doc="wall thickness", unit="m", above=0, high=50)
    height_m: float = required(doc="height without flange and cap", unit="m", above=0, high=1000)


@section_class()
class Cylinder(Footed):
    """kind = "cylinder": a solid cylinder, its axis along z: a column, a drum."""

    kind: str = parameter("cylinder", doc="what the body is", choices=("cylinder",))
    outer_diameter_m: float = required(doc="diameter", unit="m", above=0, high=100)
    height_m: float = required(doc="height without flange and cap", unit="m", above=0, high=1000)


@section_class()
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


@section_class()
class Plate(Solid):
    """kind = "plate" or "slab": a flat rectangular body on or below others, meshed finely where
    they meet it.
    """

    kind: str = parameter("plate", doc="what the body is", choices=("plate", "slab"))
    length_m: float = required(doc="length along x", unit="m", above=0, high=1000)
    width_m: float = required(doc="width along y", unit="m", above=0, high=1000)
    thickness_m: float = required(doc="thickness along z", unit="m", above=0, high=100)


@section_class()
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


@section_class()
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


@section_class()
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


@section_class()
class MeshBody(Solid):
    """kind = "mesh": a body of one's own mesh, where its file has it unless at_m or copies_m says
    otherwise; element_size_m is the length that penalty_factor refers to.
    """

    SECTION: ClassVar[str] = "mesh body"  # other than the table [mesh]

    kind: str = parameter("mesh", doc="what the body is", choices=("mesh",))
    at_m: tuple[float, ...] | None = parameter(  # type: ignore[assignment]  # None: as drawn
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


@section_class()
class Storeys(WithMaterial):
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
        (),
        doc="stiffness of each storey along x; or state period_s",
        unit="N/m",
        above=0,
        high=1e15,
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
        doc="how the stiffnesses that have period_s are distributed: uniform: all alike; "
        "triangular, shear, flexural: such that floors at height z of H move in the first mode "
        "as z / H, sin(pi z / 2 H), 1 - cos(pi z / 2 H)",
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


@section_class()
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


#: Class of the keys by kind of body.
BODY_KINDS: dict[str, type[Placed]] = {
    "tube": Tube,
    "cylinder": Cylinder,
    "block": Block,
    "plate": Plate,
    "slab": Plate,
    "cone": Cone,
    "prism": Prism,
    "arch": Arch,
    "mesh": MeshBody,
    "storeys": Storeys,
    "matrices": Matrices,
}


def half_sides(body: Tube | Cylinder | Block | Cone) -> tuple[float, float]:
    """Radius [m] of a round foot and 0, or half the sides of a rectangular one, as of
    `model.Ball.edge`.
    """
    if isinstance(body, Block):
        return body.length_m / 2, body.width_m / 2
    if isinstance(body, Cone):
        return body.bottom_diameter_m / 2, 0.0
    return (body.flange.outer_diameter_m if body.flange else body.outer_diameter_m) / 2, 0.0


def rise(body: Tube | Cylinder | Block) -> float:
    """Height [m] of the highest point of a dome over its lowest one."""
    radius = body.foot_radius_m or 0.0
    return radius - math.sqrt(max(radius**2 - sum(half**2 for half in half_sides(body)), 0.0))
