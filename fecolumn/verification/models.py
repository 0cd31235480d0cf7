"""Small systems to verify: the specimen on a coarse mesh, and blocks of bricks on blocks of
bricks.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypedDict, Unpack, cast

import numpy as np
from mpi4py import MPI
from numpy.typing import ArrayLike

from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.sections import Material
from fecolumn.contact.base_plate import BasePlate
from fecolumn.contact.known_base import KnownBase
from fecolumn.contact.points import GROUND
from fecolumn.contact.unbounded_base import UnboundedBase
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.structure import kinematics_of, structure_system
from fecolumn.engines.dynamics.system import System
from fecolumn.engines.full_system import full_system
from fecolumn.fem.body import Body
from fecolumn.foundation.gravity import GRAVITY
from fecolumn.foundation.toml_file import merge
from fecolumn.mesh.bricks import LOWER, BrickMesh, boundary_faces
from fecolumn.mesh.gmsh_section import swept_grid
from fecolumn.mesh.surface import nodal_areas
from fecolumn.structures.faces import plane_faces
from fecolumn.structures.layout import Layout
from fecolumn.structures.model import BodyModel, JointModel, Part, StructureModel, Surface
from fecolumn.structures.reduction import bare_model
from fecolumn.structures.shape import Shape
from fecolumn.verification import REDUCED
from fecolumn.verification.trial import highest_nodes

# The stout column on the coarsest mesh that keeps every part; meshes/stout.toml has the sources of
# the numbers.
COARSE: dict = {
    "title": "Coarse specimen",
    "column": {"outer_diameter_m": 0.1016, "wall_m": 0.005, "height_m": 1.0, "fine_height_m": 0.03},
    "cap": {"length_m": 0.15, "width_m": 0.15, "thickness_m": 0.01},
    "base": {"length_m": 0.2, "width_m": 0.2, "thickness_m": 0.02, "slide_allowance_m": 0.01},
    "mesh": {"fine_size_m": 0.005, "coarse_size_m": 0.03, "cap_size_m": 0.05, "base_size_m": 0.05},
    "integration": {"duration_s": 1.0, "alpha_hht": 0.0},
}

#: Young's modulus of steel [Pa].
STEEL = 200e9
# Of `shaking`: amplitudes of x, y, z [m/s2], and sign and angular frequencies [rad/s] of its two
# tones
AMPLITUDES = np.array([8.0, 6.0, 0.0])
TONES = ((1, np.array([30.0, 31.0, 1.0])), (-1, np.array([75.0, 73.0, 1.0])))


def column_case(engine: str, **tables: Any) -> Case:
    """Case of the coarse specimen; `tables`, such as contact={"friction_coefficient": 0.8}, are
    merged over it.
    """
    plan = {"engine": engine} if engine in REDUCED else {"engine": "full", "kinematics": engine}
    return case_from_tables(merge(merge(COARSE, tables), {"integration": plan}), "verification")


def column_system(engine: str, **tables: Any) -> System:
    """The coarse specimen as a system of its own on this process; that of a reduced engine is
    reduced by its trial.
    """
    return system_of(column_case(engine, **tables))


def system_of(case: Case, layout: Layout | None = None) -> System:
    """The full-order system of a case on this process; layout: as of `full_system`."""
    return full_system(case, MPI.COMM_SELF, "verification", layout).system


def with_shape(
    layout: Layout, change: Callable[[Shape], Shape], turn: np.ndarray | None = None
) -> Layout:
    """The layout of a column with its mesh changed.

    Parameters
    ----------
    change
        function of its Shape that returns the new one.
    turn
        (3, 3) that carries the places of the former mesh into those of the new one; None where
        they are the same.
    """
    turn = np.eye(3) if turn is None else turn
    column = layout.drawings["column"]
    shape = change(cast(Shape, column.shape))
    patches = {
        name: replace(
            patch,
            positions=patch.positions @ turn.T,
            origin=turn @ patch.origin,
            axes=turn @ patch.axes,
        )
        for name, patch in layout.patches["column"].items()
    }
    return replace(
        layout,
        drawings={"column": replace(column, shape=shape, faces=plane_faces(shape.mesh))},
        patches={"column": patches},
    )


def on_ground(
    model: BodyModel,
    base: BasePlate | KnownBase | UnboundedBase,
    friction: float,
    damping_ratio: float = 0.0,
    **joint: Any,
) -> StructureModel:
    """The structure of one body, "column", whose surface "foot" stands on a ground.

    Parameters
    ----------
    base
        what the ground is, as of StructureModel.
    damping_ratio
        of the elastic modes.
    joint
        what is not nil of the joint: round, restitution.
    """
    part = Part("column", model, model.center, np.eye(3), damping_ratio, np.zeros(3), np.zeros(3))
    law = np.zeros((len(model.surfaces["foot"].nodes), 3))
    given = {"round": False, "restitution": 0.0} | joint
    joints = (
        JointModel("foot: column on ground", 0, "foot", GROUND, None, friction, law, **given),
    )
    return StructureModel((part,), joints, (), base, (0, "top"))


def level_foot(arms: np.ndarray, areas: ArrayLike) -> Surface:
    """A foot of all nodes of a model, at arms (n, 3) [m] from its centre of mass, which have
    areas (n,) [m2].
    """
    nodes, ways = np.arange(len(arms)), np.diag([1.0, -1.0, -1.0])
    outlines = np.ones(len(arms), bool)
    no_triangles = np.zeros((0, 3), np.int64)
    return Surface(nodes, arms.mean(axis=0), ways, np.asarray(areas), outlines, no_triangles)


def roll_on_corners(system: System) -> None:
    """Let the foot of a column roll from node to node."""
    (joint,) = system.model.joints
    system.model = replace(system.model, joints=(replace(joint, round=False),))
    system.interface.interfaces["rim_count"] = 0


def shaking(times: ArrayLike) -> np.ndarray:
    """Two-tone ground acceleration (n, 3) [m/s2] that slides the coarse specimen, rocks it over
    twice and lands it six times in 0.2 s.

    It starts from zero and its velocity has no mean, so that the column tilts to both sides; almost
    in one direction, else it would roll around and not land.
    """
    times = np.asarray(times, float)[:, None]
    return sum(sign * AMPLITUDES * np.cos(tone * times) for sign, tone in TONES)


def box(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> BrickMesh:
    """Bricks between grid lines x, y, z [m], each rising."""
    return swept_grid(np.asarray(x, float), np.asarray(y, float), np.asarray(z, float), LOWER)


class BlockSettings(TypedDict, total=False):
    """Settings of a `block_system`.

    Attributes
    ----------
    material, base_material
        steel unless given; the base is of the body's material unless given.
    friction
        Coulomb's coefficient.
    gravity
        (3,) [m/s2].
    filtered
        contact as the plastic impact law needs it; False for the literal HHT (Stepper's impact
        "none").
    order
        of the body's elements.
    foot_height
        how far above z = 0 the foot may reach [m].
    damping_ratio
        of the lowest elastic modes, 30 at most.
    restitution
        of an impact.
    """

    material: Material
    base_material: Material | None
    friction: float
    gravity: Sequence[float] | np.ndarray
    filtered: bool
    order: int
    foot_height: float
    damping_ratio: float
    restitution: float


_BLOCK = BlockSettings(
    material=Material(youngs_modulus_pa=STEEL, poissons_ratio=0.3, density_kg_m3=7850.0),
    base_material=None,
    friction=0.3,
    gravity=(0.0, 0.0, -GRAVITY),
    filtered=True,
    order=1,
    foot_height=0.0,
    damping_ratio=0.0,
    restitution=0.0,
)


def block_system(
    engine: str,
    mesh: BrickMesh,
    base: BrickMesh,
    hht: HHT,
    **settings: Unpack[BlockSettings],
) -> System:
    """A body of bricks over a base of bricks.

    Parameters
    ----------
    engine
        of ELEMENTS.
    mesh
        the body; its faces with all corners between z = 0 and `foot_height` [m] and facing down are
        the foot.
    base
        tensor-product grid with its top at z = 0, held at its bottom.
    settings
        what is not as in _BLOCK.
    """
    comm, given = MPI.COMM_SELF, BlockSettings(**{**_BLOCK, **settings})
    body, middle = Body(comm, mesh, given["material"], given["order"]), given["foot_height"] / 2
    quads = boundary_faces(mesh, LOWER, middle, middle + 1e-9 * np.ptp(mesh.points[:, 2]))
    points, position = np.unique(quads, return_inverse=True)
    areas = nodal_areas(mesh.points[quads], position.reshape(quads.shape), len(points), 1)

    def held(plate: Body) -> tuple[dict, np.ndarray]:
        bottom = plate.all_X[:, 2].min()
        return {}, np.flatnonzero(plate.all_X[:, 2] < bottom + 1e-9 * np.ptp(plate.all_X[:, 2]))

    plate = BasePlate(Body(comm, base, given["base_material"] or given["material"], 1, held))
    nodes = body.find_nodes(mesh.points[points])
    foot = level_foot(body.all_X[nodes] - body.center, areas)
    top = body.all_X[highest_nodes(body)].mean(axis=0)
    model = on_ground(
        bare_model(body, nodes, {"foot": foot}, top),
        plate,
        given["friction"],
        given["damping_ratio"],
        restitution=given["restitution"],
    )
    return structure_system(
        model,
        [body],
        hht,
        given["gravity"],
        given["filtered"],
        [nodes],
        kinematics=kinematics_of(engine),
    )
