"""Small systems to verify: the specimen on a coarse mesh, and blocks of bricks on blocks of
bricks.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict, Unpack

import numpy as np
from mpi4py import MPI

from fecolumn.case.sections import Material
from fecolumn.case.short_form import short_form
from fecolumn.contact.base_plate import BasePlate
from fecolumn.contact.footprint import Footprint
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.system import System
from fecolumn.fem.body import Body
from fecolumn.fem.corotated import Corotated
from fecolumn.fem.total_lagrangian import TotalLagrangian
from fecolumn.foundation.toml_file import merge
from fecolumn.mesh.bricks import LOWER, BrickMesh, boundary_faces
from fecolumn.mesh.gmsh_section import swept_grid
from fecolumn.mesh.surface import nodal_areas
from fecolumn.verification import REDUCED
from fecolumn.verification.one_column import build_system, one_column

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

# Modes of a block that are damped
DAMPED = 30
# Of `shaking`: amplitudes of x, y, z [m/s2], and sign and angular frequencies [rad/s] of its two
# tones
AMPLITUDES = np.array([8.0, 6.0, 0.0])
TONES = ((1, np.array([30.0, 31.0, 1.0])), (-1, np.array([75.0, 73.0, 1.0])))


def column_case(engine: str, **tables):
    """Case of the coarse specimen; `tables`, such as contact={"friction_coefficient": 0.8}, are
    merged over it.
    """
    plan = {"engine": engine} if engine in REDUCED else {"engine": "full", "kinematics": engine}
    return short_form(merge(merge(COARSE, tables), {"integration": plan}), "verification")


def column_system(engine: str, **tables) -> System:
    """The coarse specimen as a system of its own on this process; that of a reduced engine is
    reduced by its trial.
    """
    return build_system(column_case(engine, **tables), MPI.COMM_SELF)


def shaking(times) -> np.ndarray:
    """Two-tone ground acceleration (n, 3) [m/s2] that slides the coarse specimen, rocks it over
    twice and lands it six times in 0.2 s.

    It starts from zero and its velocity has no mean, so that the column tilts to both sides; almost
    in one direction, else it would roll around and not land.
    """
    times = np.asarray(times, float)[:, None]
    return sum(sign * AMPLITUDES * np.cos(tone * times) for sign, tone in TONES)


def box(x, y, z) -> BrickMesh:
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
        of the DAMPED lowest elastic modes.
    restitution
        of an impact.
    """

    material: Material
    base_material: Material | None
    friction: float
    gravity: Sequence[float]
    filtered: bool
    order: int
    foot_height: float
    damping_ratio: float
    restitution: float


_BLOCK = BlockSettings(
    material=Material(youngs_modulus_pa=200e9, poissons_ratio=0.3, density_kg_m3=7850.0),
    base_material=None,
    friction=0.3,
    gravity=(0.0, 0.0, -9.80665),
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
    foot_height, damping_ratio = given["foot_height"], given["damping_ratio"]
    body = Body(comm, mesh, given["material"], given["order"])
    kinematics = TotalLagrangian if engine == "total_lagrangian" else Corotated
    quads = boundary_faces(
        mesh, LOWER, foot_height / 2, foot_height / 2 + 1e-9 * np.ptp(mesh.points[:, 2])
    )
    points, position = np.unique(quads, return_inverse=True)
    areas = nodal_areas(mesh.points[quads], position.reshape(quads.shape), len(points), 1)

    def held(plate):
        bottom = plate.all_X[:, 2].min()
        return {}, np.flatnonzero(plate.all_X[:, 2] < bottom + 1e-9 * np.ptp(plate.all_X[:, 2]))

    plate = BasePlate(Body(comm, base, given["base_material"] or given["material"], 1, held))
    return one_column(
        body,
        kinematics,
        plate,
        Footprint.of_all(body.find_nodes(mesh.points[points]), areas),
        hht,
        given["gravity"],
        filtered=given["filtered"],
        damping=(DAMPED, damping_ratio),
        friction=given["friction"],
        law=np.zeros((len(points), 3)),
        restitution=given["restitution"],
    )
