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
    """Keys of tubes, cylinders and blocks: a foot that is not flat, in the reduced and rigid engine
    only; a finely meshed lower part, and the cap.
    """

    foot_radius_m: float | None = parameter(
        None,
        doc="radius of the sphere that forms the foot, its lowest point at the place of the "
        "body; the body rolls on the sphere and, when tilted further, on the edge of the "
        "sphere; at least the radius of a round body, the half diagonal of a block; left "
        "out: a flat foot",
        unit="m",
        above=0,
        high=1e5,
        since="0.6",
    )
    edge_radius_m: float = parameter(
        0.0,
        doc="radius by which the outer edge of a flat foot is rounded, less than half the foot's "
        "smaller side; 0: a sharp edge",
        unit="m",
        low=0,
        high=50,
        since="0.6",
    )
    fine_height_m: float | None = parameter(
        None,
        doc="height of a lower part that is finely meshed, with element_size_m; a coarser upper "
        "part, with coarse_size_m, is tied to it; for a body that touches others with its "
        "foot only; left out: one grid, fine at both ends, but in a block with cap or flange "
        "as fine_height_m of [column]",
        unit="m",
        low=0,
        high=1000,
        since="0.8",
    )
    cap_size_m: float | None = parameter(
        None,
        doc="element size of the cap of a block, or with fine_height_m; left out: coarse_size_m, "
        "but at most 16 elements along the cap's longer side; in other bodies the cap has "
        "element_size_m",
        unit="m",
        above=0,
        high=10,
        since="0.8",
    )
    flange: Flange | None = None
    cap: Cap | None = None


@section_class()
class Tube(Footed):
    """kind = "tube": a hollow cylinder with its axis along z."""

    kind: str = parameter("tube", doc="kind of body", choices=("tube",))
    outer_diameter_m: float = required(doc="outer diameter", unit="m", above=0, high=100)
    wall_m: float = required(doc="wall thickness", unit="m", above=0, high=50)
    height_m: float = required(doc="height without flange and cap", unit="m", above=0, high=1000)


@section_class()
class Cylinder(Footed):
    """kind = "cylinder": a solid cylinder with its axis along z, such as a column or a drum."""

    kind: str = parameter("cylinder", doc="kind of body", choices=("cylinder",))
    outer_diameter_m: float = required(doc="diameter", unit="m", above=0, high=100)
    height_m: float = required(doc="height without flange and cap", unit="m", above=0, high=1000)


@section_class()
class Block(Footed):
    """kind = "block": a rectangular block."""

    kind: str = parameter("block", doc="kind of body", choices=("block",))
    length_m: float = required(doc="length along x", unit="m", above=0, high=100)
    width_m: float = required(doc="width along y", unit="m", above=0, high=100)
    height_m: float = required(doc="height along z", unit="m", above=0, high=1000)
    turned_deg: float = parameter(
        0.0,
        doc="angle by which the body is turned about the vertical axis through the middle of its "
        "foot, from x towards y",
        unit="deg",
        low=-360,
        high=360,
        since="0.7",
    )


@section_class()
class Plate(Solid):
    """kind = "plate" or "slab": a flat rectangular body above or below others, finely meshed where
    they touch it.
    """

    kind: str = parameter("plate", doc="kind of body", choices=("plate", "slab"))
    length_m: float = required(doc="length along x", unit="m", above=0, high=1000)
    width_m: float = required(doc="width along y", unit="m", above=0, high=1000)
    thickness_m: float = required(doc="thickness along z", unit="m", above=0, high=100)


@section_class()
class Cone(Solid):
    """kind = "cone": a solid truncated cone with its axis along z, such as a tapered drum."""

    kind: str = parameter("cone", doc="kind of body", choices=("cone",))
    bottom_diameter_m: float = required(doc="diameter of the foot", unit="m", above=0, high=100)
    top_diameter_m: float = required(doc="diameter of the head", unit="m", above=0, high=100)
    height_m: float = required(doc="height", unit="m", above=0, high=1000)

    @property
    def outer_diameter_m(self) -> float:
        """The larger diameter."""
        return max(self.bottom_diameter_m, self.top_diameter_m)


@section_class()
class Prism(Solid):
    """kind = "prism": an extruded polygon, such as a voussoir, a wedge, a tapered pier or a
    buttress; all its elements are of element_size_m, with a node at every corner of the polygon.
    """

    kind: str = parameter("prism", doc="kind of body", choices=("prism",))
    at_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="point [x, y, z] from which the outline is measured; the same for many prisms that "
        "are drawn in one system of coordinates",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    outline_m: tuple[tuple[float, ...], ...] = required(
        doc="corners of the polygon in order, clockwise or not: [x, z] of each corner, with "
        'along = "z" [x, y]',
        unit="m",
        low=-1e4,
        high=1e4,
    )
    width_m: float = required(
        doc='width along y, half of it on each side of at_m; with along = "z" the height, from '
        "at_m upwards",
        unit="m",
        above=0,
        high=1000,
    )
    along: str = parameter("y", doc="axis along which the outline is extruded", choices=("y", "z"))
    turned_deg: float = parameter(
        0.0,
        doc="angle by which the body is turned about the vertical axis through at_m, from x "
        "towards y",
        unit="deg",
        low=-360,
        high=360,
    )


@section_class()
class Arch(Solid):
    """kind = "arch": equal voussoirs that form a part of a ring in the plane of x and z: prisms
    "NAME 1", "NAME 2" ..., counted from from_deg. NAME stands for all of them; a joint between NAME
    and NAME connects neighbours. mass_kg is the mass of the whole arch. A table [bodies."NAME 3"]
    beside it states what is different in this voussoir: material, mass, mesh, whether it is fixed.
    """

    kind: str = parameter("arch", doc="kind of body", choices=("arch",))
    at_m: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0),
        doc="place [x, y, z] of the centre of the arch's circle",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    mean_radius_m: float = required(
        doc="radius of the arch's middle line", unit="m", above=0, high=1000
    )
    thickness_m: float = required(
        doc="thickness along the radius; less than twice mean_radius_m",
        unit="m",
        above=0,
        high=1000,
    )
    width_m: float = required(
        doc="width along y, half of it on each side of at_m", unit="m", above=0, high=1000
    )
    voussoirs: int = required(doc="number of voussoirs", low=2, high=500)
    from_deg: float = parameter(
        0.0,
        doc="angle of the first springing, measured from the x axis",
        unit="deg",
        low=-360,
        high=360,
    )
    to_deg: float = parameter(
        180.0,
        doc="angle of the last springing; greater than from_deg, by less than 360",
        unit="deg",
        low=-360,
        high=360,
    )
    arc_sides: int = parameter(
        4,
        doc="number of straight sides of each voussoir along its inner arc, and along its outer "
        "arc; the corners lie so far outside these arcs that the voussoir has the area of "
        "the true sector",
        low=1,
        high=100,
    )
    turned_deg: float = parameter(
        0.0,
        doc="angle by which the arch is turned about the vertical axis through at_m, from x "
        "towards y",
        unit="deg",
        low=-360,
        high=360,
    )


@section_class()
class MeshBody(Solid):
    """kind = "mesh": a body from your own mesh file. It stays where the file has it, unless at_m or
    copies_m is stated; element_size_m is the length in penalty_factor.
    """

    SECTION: ClassVar[str] = "mesh body"  # other than the table [mesh]

    kind: str = parameter("mesh", doc="kind of body", choices=("mesh",))
    at_m: tuple[float, ...] | None = parameter(  # type: ignore[assignment]  # None: as drawn
        None,
        doc="place [x, y, z] to which the middle of the body's flat foot is moved; left out: the "
        "body stays where its file has it",
        unit="m",
        low=-1e4,
        high=1e4,
    )
    mesh_file: str = required(
        doc="file with the shape of the body, z up: elements (8-node bricks or tetrahedra) in "
        "any format that meshio reads; or a closed surface (.stl, .obj, .ply), a CAD body "
        "(.step, .iges) or a script of Gmsh (.geo), which are then meshed"
    )
    mesh_unit: str | None = unit_key()
    mesh_size_m: float | None = size_key()
    cut_foot_m: float | None = cut_key()
    turned_deg: float = parameter(
        0.0,
        doc="angle by which the body is turned about the vertical axis through the middle of its "
        "foot, or of its lowest points, from x towards y",
        unit="deg",
        low=-360,
        high=360,
        since="0.7",
    )
    cap_size_m: float | None = parameter(
        None,
        doc="element size of the cap; left out: three times the element size of the foot, but at "
        "most 16 elements along the cap's longer side",
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
    each list has one number per floor, from below, or one number for all floors.
    """

    kind: str = parameter("storeys", doc="kind of body", choices=("storeys",))
    length_m: float = required(
        doc="length of slab and floors along x", unit="m", above=0, high=1000
    )
    width_m: float = required(doc="width of slab and floors along y", unit="m", above=0, high=1000)
    thickness_m: float = required(
        doc="thickness of the slab; the mass of the slab is mass_kg, or follows from its density",
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
        doc="stiffness of each storey along x; needed without period_s",
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
        doc="first period of the building on a fixed slab, the same along x and y; instead of "
        "stiffnesses",
        unit="s",
        above=0,
        high=100,
    )
    profile: str = parameter(
        "uniform",
        doc="distribution of the storey stiffnesses that have period_s: uniform: all equal; "
        "triangular, shear, flexural: such that floors at height z of H move in the first "
        "mode as z / H, sin(pi z / 2 H), 1 - cos(pi z / 2 H)",
        choices=("uniform", "triangular", "shear", "flexural"),
    )
    damping: str = parameter(
        "rayleigh",
        doc="rayleigh: damping_ratio in the two rayleigh_modes of the building on a fixed slab, in "
        "the other modes by Rayleigh's law; modal: damping_ratio in every mode, in the podium "
        "engine on a fixed slab, in the reduced engine of the free building. The reduced engine "
        "damps the modes of the free building alone, so that one with several floors, or by modal, "
        "sways with less while its slab stands",
        choices=("modal", "rayleigh"),
    )
    rayleigh_modes: tuple[int, ...] = parameter(
        (1, 2),
        doc="the two modes along each axis that have damping_ratio in Rayleigh's law",
        low=1,
        high=100,
    )


@section_class()
class Matrices(Placed):
    """kind = "matrices": an elastic body by its mass and stiffness matrices from another program;
    they are those of the free body, without supports.
    """

    kind: str = parameter("matrices", doc="kind of body", choices=("matrices",))
    mass_file: str = required(
        doc="mass matrix [kg]: a file of MatrixMarket (.mtx) or of scipy.sparse.save_npz, or "
        ".npz with the array mass"
    )
    stiffness_file: str = required(
        doc="stiffness matrix [N/m]: in the same formats; in .npz the array stiffness"
    )
    nodes_file: str = required(
        doc=".npz with the arrays dofs (n, 3): rows of the matrices, counted from 0, for x, y, z "
        "of each contact node; coordinates (n, 3) [m]; optionally triangles (t, 3) of the "
        "faces; or a text file with the first six numbers on each line"
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
