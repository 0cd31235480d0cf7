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
    """Upright column with its axis along z and its foot at z = 0: a tube, a solid cylinder, a
    block, or the shape in mesh_file.
    """

    outer_diameter_m: float | None = parameter(
        None,
        doc="outer diameter; needed for a tube and a solid cylinder",
        unit="m",
        above=0,
        high=100,
    )
    height_m: float | None = parameter(
        None,
        doc="height of the column without cap and flange; needed without mesh_file",
        unit="m",
        above=0,
        high=1000,
    )
    wall_m: float | None = parameter(
        None,
        doc="wall thickness; needed for a tube; half the diameter: a solid cylinder",
        unit="m",
        above=0,
        high=50,
    )
    fine_height_m: float | None = parameter(
        None,
        doc="height of the finely meshed lower part; left out: half the column's diameter or "
        "smaller side, at most its height",
        unit="m",
        low=0,
        high=1000,
    )
    mesh_file: str = parameter(
        "",
        doc="file with the shape of the body, z up: elements (8-node bricks or tetrahedra) in "
        "any format that meshio reads; or a closed surface (.stl, .obj, .ply), a CAD body "
        "(.step, .iges) or a script of Gmsh (.geo), which are then meshed; takes the place "
        "of the built column",
    )
    mesh_unit: str | None = unit_key()
    mesh_size_m: float | None = size_key()
    cut_foot_m: float | None = cut_key()
    shape: str = parameter(
        "tube",
        doc="shape of the built column: tube, solid cylinder or rectangular block",
        choices=("tube", "solid", "block"),
        since="0.2",
    )
    length_m: float | None = parameter(
        None, doc="length along x; needed for a block", unit="m", above=0, high=100, since="0.2"
    )
    width_m: float | None = parameter(
        None, doc="width along y; needed for a block", unit="m", above=0, high=100, since="0.2"
    )

    @property
    def drawn(self) -> MeshFile:
        """What mesh_file is, and how it is made into elements."""
        return MeshFile(self.mesh_file, self.mesh_unit or "", self.mesh_size_m, self.cut_foot_m)


@section_class()
class Base(Section):
    """What the column stands on: an elastic plate fixed at its bottom, the same layer without
    edges, or a pad of springs and dashpots.
    """

    length_m: float | None = parameter(
        None,
        doc="length along x; left out: the length of the foot plus three times the foot's larger "
        "side",
        unit="m",
        above=0,
        high=1000,
    )
    width_m: float | None = parameter(
        None,
        doc="width along y; left out: the width of the foot plus three times the foot's larger "
        "side",
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
        doc="finely meshed margin around the foot, over which it may slide; left out: a quarter "
        "of the foot's smaller side, or less where the stated length and width leave less",
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
        doc="stiffness of a pad per area across the contact (subgrade modulus); needed for a pad",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.2",
    )
    shear_stiffness_n_m3: float = parameter(
        0.0,
        doc="stiffness of a pad per area along the contact (shear); 0: 0.8 of stiffness_n_m3",
        unit="N/m3",
        low=0,
        high=1e15,
        since="0.2",
    )
    damping_ratio: float = parameter(
        0.0,
        doc="damping ratio, by the dashpots of a pad, of the vertical vibration of the column "
        "that stands on it",
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
        doc="brick size of the column's lower part, of the flange and of the base below; left "
        "out: 48 bricks around the wall of a tube, 32 around a cylinder, 12 along the mean "
        "side of a block; with a flange 40 around it, but not more than three times these "
        "sizes; with mesh_file as in its foot, between 8 and 24 along the foot",
        unit="m",
        above=0,
        high=10,
    )
    coarse_size_m: float | None = parameter(
        None,
        doc="brick size of the column's upper part, along height and circumference; left out: "
        "three times the fine size in a tube, twice in a solid column or block",
        unit="m",
        above=0,
        high=10,
    )
    cap_size_m: float | None = parameter(
        None,
        doc="brick size of the cap; left out: coarse_size_m, but at most 16 bricks along the "
        "cap's longer side",
        unit="m",
        above=0,
        high=10,
    )
    base_size_m: float | None = parameter(
        None,
        doc="largest brick size of the base, away from the foot; left out: six times fine_size_m",
        unit="m",
        above=0,
        high=10,
    )
    element_order: int | None = parameter(
        None,
        doc="polynomial order of the elements of column and cap; left out: 1 for bricks, 2 for "
        "tetrahedra",
        low=1,
        high=2,
    )
    limit_dofs: int = parameter(
        500_000,
        doc="number of degrees of freedom above which a mesh is refused before it is built",
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
