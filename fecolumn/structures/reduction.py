"""Bodies reduced to their contact points: those of finite elements, and those that only give where
they touch.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import Material
from fecolumn.mesh.mass import mass_properties
from fecolumn.structures.faces import Face
from fecolumn.structures.model import BodyModel, Surface
from fecolumn.structures.patches import Patch, face_weights
from fecolumn.structures.shape import Shape

if TYPE_CHECKING:
    from mpi4py.MPI import Intracomm

    from fecolumn.fem.body import Body


def body_of(shape: Shape, material: Material, comm: Intracomm | None = None) -> Body:
    """The `fem.body.Body` of a mesh with its ties, of this process alone unless `comm` says
    more.
    """
    from mpi4py import MPI

    from fecolumn.fem.tied_body import tied_body

    return tied_body(shape.mesh, shape.ties, material, shape.order, comm or MPI.COMM_SELF)


def elastic_model(
    shape: Shape, faces: list[Face], patches: dict[str, Patch], material: Material, n_modes: int
) -> tuple[BodyModel, tuple[NDArray[Any], NDArray[Any]]]:
    """Reduce a body of finite elements; also its nodes (n_nodes, 3) [m] from the centre of mass and
    the shapes (m, n_nodes, 3) of the modes there.

    At the nodes of all patches: rigid motion, elastic modes
    of the free body, and the exact flexibility by inertia relief. Marks: "top", the mean over the
    highest level face.

    Parameters
    ----------
    faces
        of the mesh.
    patches
        by the names of the surfaces.
    """
    body = body_of(shape, material)
    found = {name: body.find_nodes(patch.positions, patch.part) for name, patch in patches.items()}
    nodes = np.unique(np.concatenate(list(found.values())))
    positions, shares = face_weights(top_face(faces), shape.order)
    surfaces = {
        name: patch.surface(np.searchsorted(nodes, found[name]), body.center)
        for name, patch in patches.items()
    }
    top = body.find_nodes(positions, top_face(faces).part)
    bare = bare_model(body, nodes, surfaces, shares @ positions)
    model, fields = with_elasticity(bare, body, nodes, n_modes, (top, shares))
    return model, (body.all_X - body.center, fields)


def bare_model(
    body: Body, nodes: NDArray[Any], surfaces: dict[str, Surface], top: NDArray[Any]
) -> BodyModel:
    """BodyModel of a `fem.body.Body` with nodes (n,) of it, without modes and flexibility.

    Parameters
    ----------
    surfaces
        by name, with their rows among the nodes.
    top
        (3,) [m] place of the mark "top".
    """
    from fecolumn.fem.free_body import rigid_fields

    return BodyModel(
        mass=float(body.total_mass),
        inertia=rigid_fields(body)[2][3:, 3:],
        center=body.center,
        frequencies=np.zeros(0),
        shapes=np.zeros((len(nodes), 3, 0)),
        flexibility=np.zeros((0, 0, 3, 3)),
        arms=body.all_X[nodes] - body.center,
        dofs=3 * body.n_nodes,
        surfaces=surfaces,
        marks={"top": (top - body.center, np.zeros((3, 0)))},
    )


def with_elasticity(
    model: BodyModel,
    body: Body,
    nodes: NDArray[Any],
    n_modes: int,
    top: tuple[NDArray[Any], NDArray[Any]],
) -> tuple[BodyModel, NDArray[Any]]:
    """A bare model with elastic modes and flexibility; also the shapes (m, n_owned, 3)
    [1/sqrt(kg)] of the modes all over the body.

    Parameters
    ----------
    nodes
        (n,) of the body that are the rows of the model.
    n_modes
        elastic modes to keep, the lowest.
    top
        nodes (k,) whose mean is the mark "top", and their shares (k,) in it.
    """
    from fecolumn.fem.reduction import reduced_at

    found, (highest, shares) = reduced_at(body, nodes, n_modes), top
    shape_of_top = np.einsum("i,iam->am", shares, found.at(highest))
    made = replace(
        model,
        inertia=found.inertia,
        frequencies=found.frequencies,
        shapes=found.at(nodes),
        flexibility=found.flexibility,
        marks={"top": (model.marks["top"][0], shape_of_top)},
    )
    return made, found.fields


def rigid_model(
    shape: Shape,
    faces: list[Face],
    patches: dict[str, Patch],
    material: Material,
    stiffness: float | None,
) -> BodyModel:
    """A body that moves rigidly and gives only where it touches: each contact point by itself.

    Parameters
    ----------
    stiffness
        per area of its faces [N/m3]; None takes `punch_stiffness` of each patch.
    """
    masses = mass_properties(shape.mesh, material.density_kg_m3)
    top = top_face(faces)
    positions, shares = face_weights(top, 1)
    if patches:
        arms, flexibility, surfaces = local_points(patches, masses.centre, material, stiffness)
    else:  # a fixed body that nothing touches: the points of its top, which carry nothing
        arms, surfaces = positions - masses.centre, {}
        flexibility = np.zeros((len(arms), len(arms), 3, 3))
    return BodyModel(
        masses.mass,
        masses.inertia,
        masses.centre,
        np.zeros(0),
        np.zeros((len(arms), 3, 0)),
        flexibility,
        arms,
        0,
        surfaces,
        {"top": (shares @ positions - masses.centre, np.zeros((3, 0)))},
    )


def local_points(
    patches: dict[str, Patch], center: NDArray[Any], material: Material, stiffness: float | None
) -> tuple[NDArray[Any], NDArray[Any], dict[str, Surface]]:
    """Arms (n, 3) [m], flexibility (n, n, 3, 3) [m/N] and surfaces of the points of all patches,
    each of which gives alone, 1 / (k A).
    """
    arms = np.concatenate([patch.positions for patch in patches.values()]) - center
    flexibility, surfaces, first = np.zeros((len(arms), len(arms), 3, 3)), {}, 0
    for name, patch in patches.items():
        rows = np.arange(first, first + len(patch.positions))
        per_area = stiffness or punch_stiffness(patch.areas.sum(), material)
        flexibility[rows, rows] = np.eye(3) / (per_area * patch.areas)[:, None, None]
        surfaces[name] = patch.surface(rows, center)
        first += len(rows)
    return arms, flexibility, surfaces


def punch_stiffness(area: float, material: Material) -> float:
    """Stiffness per area [N/m3] of a half-space under a rigid round punch of an area [m2]: 2 E /
    ((1 - nu^2) sqrt(pi A)) (Boussinesq 1885).
    """
    return (
        2
        * material.youngs_modulus_pa
        / ((1 - material.poissons_ratio**2) * math.sqrt(math.pi * area))
    )


def top_face(faces: list[Face]) -> Face:
    """The highest level face of a body; its highest face where none is level."""
    level = [face for face in faces if face.is_level and face.normal[2] > 0] or faces
    return max(level, key=lambda face: face.corners[:, :, 2].max())
