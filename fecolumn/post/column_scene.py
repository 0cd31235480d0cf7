"""The scene of a single column on its base."""

from __future__ import annotations

import numpy as np

from fecolumn.case import Case
from fecolumn.mesh.bricks import BrickMesh, boundary_faces, outer_faces
from fecolumn.mesh.quality import mass_properties
from fecolumn.mesh.specimen import specimen_mesh
from fecolumn.post.scene import GROUND, Contact, Piece, Scene, cells_of, joined
from fecolumn.post.state_fields import Continuum, Plate, Seat, StateFields

#: Name of the body
NAME = "column"
# Heights that are one [-]: of the body's, as where the mesh is tied
_FLAT = 1e-6


def column_scene(case: Case) -> Scene:
    """The column and the base of a finished case, meshed anew.

    Raises
    ------
    InputError
        the mesh file that the case names is gone, or does not fit it any more.
    """
    mesh = specimen_mesh(case)
    mass = mass_properties(mesh.body, case.material.density_kg_m3)
    pieces = [_piece(NAME, mesh.body, mass.centre, False)]
    if len(mesh.base.cells):
        pieces.append(_piece("base", mesh.base, np.zeros(3), True))
    # faces that look down have their corners the other way round seen from above
    foot = _level_faces(mesh.body, mesh.body.foot_part, 0.0)
    contact = Contact("foot", NAME, "foot", 0, GROUND, foot, np.zeros(3), np.diag([1.0, 1.0, -1.0]))
    parts = np.concatenate([mesh.body.part, mesh.base.part])
    return Scene(
        tuple(pieces), (contact,), {"part": parts}, lambda scene: _expanded(case, scene), mass=mass
    )


def _piece(name: str, mesh: BrickMesh, center: np.ndarray, held: bool) -> Piece:
    faces = joined([outer_faces(mesh, part) for part in sorted(set(mesh.part.tolist()))])
    cells = cells_of(mesh.cells, faces)
    return Piece(name, name, mesh.points, faces, mesh.cells, cells, np.zeros(3), center, held)


def _level_faces(mesh: BrickMesh, part: int, height: float) -> np.ndarray:
    return boundary_faces(mesh, part, height, _FLAT * np.ptp(mesh.points[:, 2]))


def ends_of(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Centres (3,) [m] of the foot and of the top's face, whose displacements the history has."""
    piece = scene.pieces[0]
    top = _top_faces(piece)
    return _centre(piece.points[scene.contacts[0].faces]), _centre(piece.points[top])


def _top_faces(piece: Piece) -> np.ndarray:
    """Outer faces in the plane of the highest point."""
    heights = piece.points[piece.faces, 2]
    return piece.faces[
        (np.abs(heights - piece.points[:, 2].max()) < _FLAT * np.ptp(piece.points[:, 2])).all(
            axis=1
        )
    ]


def _centre(faces: np.ndarray) -> np.ndarray:
    """Middle (3,) of the area of plane faces with corners (n_faces, k, 3)."""
    first, areas, middles = faces[:, :1], [], []
    for a in range(1, faces.shape[1] - 1):
        triangle = np.concatenate([first, faces[:, a : a + 2]], axis=1)
        areas.append(
            np.linalg.norm(
                np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0]), axis=1
            )
        )
        middles.append(triangle.mean(axis=1))
    return np.average(np.concatenate(middles), axis=0, weights=np.concatenate(areas))


def _expanded(case: Case, scene: Scene) -> StateFields:
    from scipy.spatial import cKDTree

    from fecolumn.dynamics.assembly import foot_of
    from fecolumn.reduced.cache import load_model, make_bodies

    model, _, folder = load_model(case)
    body, plate, specimen = make_bodies(case)
    nodes = foot_of(case, specimen, body).nodes
    shapes = np.load(folder / "fields.npy", mmap_mode="r")
    plan, points = model.reference[:, :2], scene.points[scene.contacts[0].points, :2]
    seat = Seat(np.arange(len(nodes)), model.areas, plan, cKDTree(plan).query(points)[1])
    return StateFields(
        scene,
        [(Continuum(body, model, nodes, shapes), [0])],
        [model],
        [seat],
        [Plate(plate)] if plate else [],
    )
