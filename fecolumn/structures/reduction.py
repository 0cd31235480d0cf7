"""Bodies reduced to their contact points: those of finite elements, and those that only give where
they touch.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fecolumn.case.sections import Material
from fecolumn.mesh.mass import mass_properties
from fecolumn.structures.faces import Face
from fecolumn.structures.model import BodyModel
from fecolumn.structures.patches import Patch, face_weights
from fecolumn.structures.shapes import Shape


class _Meshing(NamedTuple):
    element_order: int


class _Column(NamedTuple):
    """What `dynamics.assembly.column_body` reads of a case."""

    material: Material
    mesh: _Meshing


def body_of(shape: Shape, material: Material, comm=None):
    """The `fem.body.Body` of a mesh with its ties, of this process alone unless `comm` says
    more.
    """
    from mpi4py import MPI

    from fecolumn.fem.tied_body import column_body
    from fecolumn.mesh.specimen import SpecimenMesh

    return column_body(
        _Column(material, _Meshing(shape.order)),
        SpecimenMesh(shape.mesh, None, shape.ties, np.zeros(0, int)),
        comm or MPI.COMM_SELF,
    )


def elastic_model(
    shape: Shape, faces: list[Face], patches: dict[str, Patch], material: Material, n_modes: int
) -> tuple[BodyModel, tuple[np.ndarray, np.ndarray]]:
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
    from fecolumn.fem.reduction import reduced_at

    body = body_of(shape, material)
    found = {name: body.find_nodes(patch.positions, patch.part) for name, patch in patches.items()}
    nodes = np.unique(np.concatenate(list(found.values())))
    reduced = reduced_at(body, nodes, n_modes)
    positions, shares = face_weights(top_face(faces), shape.order)
    top = body.find_nodes(positions, top_face(faces).part)
    shape_of_top = np.einsum("i,iam->am", shares, reduced.at(top))
    marks = {"top": (shares @ positions - body.center, shape_of_top)}
    model = BodyModel(
        mass=float(body.total_mass),
        inertia=reduced.inertia,
        center=body.center,
        frequencies=reduced.frequencies,
        shapes=reduced.at(nodes),
        flexibility=reduced.flexibility,
        arms=body.all_X[nodes] - body.center,
        dofs=3 * body.n_nodes,
        surfaces={
            name: patch.surface(np.searchsorted(nodes, found[name]), body.center)
            for name, patch in patches.items()
        },
        marks=marks,
    )
    return model, (body.all_X - body.center, reduced.fields)


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
    arms, flexibility, surfaces = local_points(patches, masses.centre, material, stiffness)
    top = top_face(faces)
    positions, shares = face_weights(top, 1)
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


def local_points(patches, center, material, stiffness) -> tuple[np.ndarray, np.ndarray, dict]:
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
    level = [face for face in faces if face.normal[2] > 1 - 1e-9] or faces
    return max(level, key=lambda face: face.corners[:, :, 2].max())
