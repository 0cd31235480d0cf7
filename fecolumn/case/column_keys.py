"""Keys of a column on its base: [column], [base] and [mesh] of the short form."""

from __future__ import annotations

from typing import ClassVar

from fecolumn.case.mesh_file_keys import cut_key, size_key, unit_key
from fecolumn.case.sections import Cap, Flange
from fecolumn.foundation.schema import Section, parameter
from fecolumn.foundation.section_class import section_class
from fecolumn.mesh.mesh_file import MeshFile
from fecolumn.mesh.upright import Upright


@section_class()
class Column(Section):
    """Upright column, its axis along z, its foot at z = 0: tube, solid cylinder, block, or the
    user's own mesh.
    """

    outer_diameter_m: float | None = parameter(
        None, doc="outer diameter; a tube and a solid cylinder need it", unit="m", above=0, high=100
    )
    height_m: float | None = parameter(
        None,
        doc="height of the column without cap and flange; every built column needs it",
        unit="m",
        above=0,
        high=1000,
    )
    wall_m: float | None = parameter(
        None,
        doc="wall thickness, which a tube needs; half the diameter makes a solid cylinder",
        unit="m",
        above=0,
        high=50,
    )
    fine_height_m: float | None = parameter(
        None,
        doc="height of the finely meshed lower part; left out: half the width of the foot",
        unit="m",
        low=0,
        high=1000,
    )
    mesh_file: str = parameter(
        "",
        doc="shape of the body, z up: elements, 8-node bricks or tetrahedra, in any format meshio "
        "reads; a closed surface (.stl, .obj, .ply), a CAD body (.step, .iges) or a script of Gmsh "
        "(.geo), in which elements are made; replaces the built column",
    )
    mesh_unit: str | None = unit_key()
    mesh_size_m: float | None = size_key()
    cut_foot_m: float | None = cut_key()
    shape: str = parameter(
        "tube",
        doc="built column: tube, solid cylinder or rectangular block",
        choices=("tube", "solid", "block"),
        since="0.2",
    )
    length_m: float | None = parameter(
        None, doc="length along x, which a block needs", unit="m", above=0, high=100, since="0.2"
    )
    width_m: float | None = parameter(
        None, doc="width along y, which a block needs", unit="m", above=0, high=100, since="0.2"
    )

    @property
    def drawn(self) -> MeshFile:
        """What mesh_file is, and how it is made into elements."""
        return MeshFile(self.mesh_file, self.mesh_unit or "", self.mesh_size_m, self.cut_foot_m)


@section_class()
class Base(Section):
    """What the column stands on: an elastic plate held at its bottom, a flat of the same layer
    without edges, or a pad of springs and dashpots.
    """

    length_m: float | None = parameter(
        None,
        doc="length along x; left out: the foot's and three times the larger side of the foot",
        unit="m",
        above=0,
        high=1000,
    )
    width_m: float | None = parameter(
        None,
        doc="length along y; left out: the foot's and three times the larger side of the foot",
        unit="m",
        above=0,
        high=1000,
    )
    thickness_m: float | None = parameter(
        None,
        doc="thickness along z; left out: a quarter of the foot's smaller side",
        unit="m",
        above=0,
        high=100,
    )
    slide_allowance_m: float | None = parameter(
        None,
        doc="finely meshed margin around the footprint; left out: a quarter of the foot's "
        "smaller side",
        unit="m",
        low=0,
        high=1000,
    )
    youngs_modulus_pa: float = parameter(
        200e9, doc="Young's modulus of the base", unit="Pa", above=0, high=1e15
    )
    poissons_ratio: float = parameter(0.3, doc="Poisson's ratio of the base", low=0, high=0.49)
    density_kg_m3: float = parameter(
        7850.0, doc="density of the base", unit="kg/m3", above=0, high=1e5
    )
    kind: str = parameter(
        "plate",
        doc="plate: elastic plate with edges; unbounded: the same layer without edges; "
        "pad: springs and dashpots per area, without edges",
        choices=("plate", "unbounded", "pad"),
        since="0.2",
    )
    stiffness_n_m3: float = parameter(
        0.0,
        doc="springs across a pad per area (subgrade modulus); needed for a pad",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.2",
    )
    shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="springs along a pad per area; 0: 0.8 of stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.2",
    )
    damping_ratio: float = parameter(
        0.0,
        doc="of the dashpots of a pad: that of the standing column's vertical mode",
        low=0,
        high=10,
        since="0.2",
    )


@section_class()
class MeshSizes(Section):
    """Element sizes."""

    SECTION: ClassVar[str] = "mesh"  # of its table [mesh]

    fine_size_m: float | None = parameter(
        None,
        doc="brick size of the column's lower part, of the flange and of the base below; "
        "left out: 48 around the wall of a tube, 32 around a cylinder, 12 along the side of a "
        "block; 40 around a flange, or three times these sizes; of a mesh of one's own as its foot "
        "has, between 8 and 24 along the side",
        unit="m",
        above=0,
        high=10,
    )
    coarse_size_m: float | None = parameter(
        None,
        doc="brick size along height and circumference of the column's upper part; left "
        "out: three fine bricks of a tube, two of a solid column",
        unit="m",
        above=0,
        high=10,
    )
    cap_size_m: float | None = parameter(
        None,
        doc="brick size of the cap plate; left out: a coarse brick, but 16 of the cap's "
        "longer side at most",
        unit="m",
        above=0,
        high=10,
    )
    base_size_m: float | None = parameter(
        None,
        doc="largest brick size of the base, away from the footprint; left out: six fine bricks",
        unit="m",
        above=0,
        high=10,
    )
    element_order: int | None = parameter(
        None,
        doc="polynomial order of the column's and cap's elements; left out: 1 for bricks, "
        "2 for tetrahedra",
        low=1,
        high=2,
    )
    limit_dofs: int = parameter(
        500_000,
        doc="degrees of freedom above which a mesh is refused before it is built",
        low=100,
        high=10**9,
        counts=False,
    )


class ColumnSections(Section, Upright):
    """Sections of the short form that say how a column and its base are meshed."""

    __slots__ = ()
    column: Column
    base: Base
    mesh: MeshSizes
    flange: Flange | None
    cap: Cap | None
