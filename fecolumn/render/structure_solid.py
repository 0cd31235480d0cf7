"""What is drawn of a structure of many bodies: the outside of each, and the faces on which they
stand.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.mesh.bricks import FACES, TETRAHEDRON_FACES, outline_edges
from fecolumn.render.solid import Surface
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.drawn import floor_boxes, outside
from fecolumn.structures.feet import rise
from fecolumn.structures.keys import Storeys
from fecolumn.structures.model import GROUND, StructureModel

# Of faces in the plane of a contact surface, over the body's size and as a sine
_SAME = 1e-5


@dataclass(frozen=True, slots=True)
class Piece:
    """A body as it is drawn, in its own drawing.

    Attributes
    ----------
    drawing
        Drawing.
    points
        (n, 3) [m]; the last 8 floors of them are those of a building's floors.
    faces
        (n_faces, 4 or 3) of these points, a block of each kind.
    cells
        (n_faces,) element of each face, -1 of one without.
    floors
        how many a building has.
    elements
        (n_cells, 8, 4 or 3) of its mesh, the floors of a building and the triangles of matrices
        included.
    """

    drawing: Drawing
    points: np.ndarray
    faces: tuple[np.ndarray, ...]
    cells: np.ndarray
    floors: int
    elements: np.ndarray

    @property
    def struts(self) -> np.ndarray:
        """(n, 2) points between which a building has its columns: corners of a floor, or of the
        slab, and of the floor above.
        """
        from scipy.spatial import cKDTree

        if not self.floors:
            return np.zeros((0, 2), np.int64)
        slab = len(self.points) - 8 * self.floors
        boxes = slab + np.arange(8 * self.floors).reshape(-1, 8)
        top = self.points[boxes[0, :4]] * [1, 1, 0] + [0, 0, self.points[:slab, 2].max()]
        below = np.vstack([cKDTree(self.points[:slab]).query(top)[1], boxes[:-1, 4:]])
        return np.stack([below.ravel(), boxes[:, :4].ravel()], axis=1)

    @classmethod
    def of(cls, drawing: Drawing) -> Piece:
        """The piece of a body's drawing."""
        points, faces = outside(drawing)
        if drawing.shape is None:
            return cls(
                drawing, points, tuple(faces), np.full(sum(map(len, faces)), -1), 0, faces[0]
            )
        floors = len(floor_boxes(drawing.body)) if isinstance(drawing.body, Storeys) else 0
        elements = drawing.shape.mesh.cells
        if floors:
            elements = np.concatenate(
                [elements, np.arange(8 * floors).reshape(-1, 8) + len(drawing.shape.mesh.points)]
            )
        return cls(
            drawing,
            points,
            tuple(faces),
            _cells_of(elements, np.concatenate(faces)),
            floors,
            elements,
        )


def _cells_of(elements: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Element (n_faces,) to which each outer face belongs."""
    of_cell = TETRAHEDRON_FACES if elements.shape[1] == 4 else FACES
    every = np.sort(elements[:, of_cell].reshape(-1, of_cell.shape[1]), axis=1)
    wanted = np.sort(faces, axis=1)
    _, number = np.unique(np.concatenate([every, wanted]), axis=0, return_inverse=True)
    owner = np.empty(number.max() + 1, np.int64)
    owner[number.ravel()[: len(every)]] = np.arange(len(every)) // len(of_cell)
    return owner[number.ravel()[len(every) :]]


@dataclass(frozen=True, slots=True)
class Contact:
    """The slave's face of a joint as it is drawn in plan.

    Attributes
    ----------
    interface, slave
        names.
    part
        place of the slave.
    nodes
        (k,) rows of the contact points' nodes among those of all bodies
    areas
        (k,) [m2].
    normal
        (3,) out of the slave.
    plan
        (k, 2) [m] places in the plane of the face, outline: (n, 2, 2) [m] its edges there; of a
        level face x and y, seen from above.
    points
        numbers of the drawn points in the face, and nearest: of the nodes above that each stands
        for.
    """

    interface: str
    slave: str
    part: int
    on_ground: bool
    nodes: np.ndarray
    areas: np.ndarray
    normal: np.ndarray
    plan: np.ndarray
    outline: np.ndarray
    points: np.ndarray
    nearest: np.ndarray


@dataclass(frozen=True, slots=True)
class StructureSolid:
    """A structure as it is drawn, upright where it stands at first.

    Attributes
    ----------
    structure
        StructureModel, upright.
    pieces
        of each part, copies the same object.
    surface
        the outside of all bodies.
    first, first_cell, first_node
        of each part among points, elements and contact nodes of all, one more at the end.
    contacts
        of each joint.
    struts
        (n, 2) points between which buildings have columns.
    outlines
        (n, 2, 3) [m] of the feet on the ground.
    """

    structure: StructureModel
    pieces: tuple[Piece, ...]
    surface: Surface
    first: np.ndarray
    first_cell: np.ndarray
    first_node: np.ndarray
    contacts: tuple[Contact, ...]
    struts: np.ndarray
    outlines: np.ndarray

    @property
    def points(self) -> np.ndarray:
        """(n, 3) [m] of all bodies at rest."""
        return self.surface.points

    @property
    def height(self) -> float:
        """[m]"""
        return float(np.ptp(self.points[:, 2]))

    @property
    def width(self) -> float:
        """Larger side in plan [m]."""
        return float(np.ptp(self.points[:, :2], axis=0).max())

    def positions(self, center: np.ndarray, rotation: np.ndarray, local: np.ndarray) -> np.ndarray:
        """Positions (n, 3) [m] of all points of bodies with centres of mass (nb, 3) [m], turned by
        (nb, 3, 3), displaced by `local` (n, 3) [m] in their frames.
        """
        placed = np.empty((self.first[-1], 3))
        for k, part in enumerate(self.structure.parts):
            rows = slice(self.first[k], self.first[k + 1])
            placed[rows] = (
                center[k] + (self.points[rows] - part.center + local[rows]) @ rotation[k].T
            )
        return placed


def structure_solid(
    drawings: dict[str, Drawing], structure: StructureModel, copies
) -> StructureSolid:
    """Args:
    drawings: by body. structure: upright. copies: (body, number) of each part.
    """
    pieces = {name: Piece.of(drawing) for name, drawing in drawings.items()}
    each = tuple(pieces[name] for name, _ in copies)
    first, first_cell = (
        np.cumsum([0] + [len(getattr(piece, what)) for piece in each])
        for what in ("points", "elements")
    )
    first_node = np.cumsum([0] + [len(part.model.arms) for part in structure.parts])
    points = np.concatenate(
        [
            piece.points - part.model.center + part.center
            for piece, part in zip(each, structure.parts)
        ]
    )
    faces = [faces + start for piece, start in zip(each, first) for faces in piece.faces]
    cells = np.concatenate(
        [
            np.where(piece.cells < 0, -1, piece.cells + start)
            for piece, start in zip(each, first_cell)
        ]
    )
    part = np.repeat(np.arange(len(each)), [len(piece.cells) for piece in each])
    surface = Surface(points, np.arange(len(points)), _joined(faces), cells, part)
    contacts = tuple(
        _contact(
            joint,
            each[joint.slave],
            structure.parts[joint.slave],
            first_node[joint.slave],
            first[joint.slave],
        )
        for joint in structure.joints
    )
    outlines = [
        _outline(each[joint.slave], structure.parts[joint.slave], joint.slave_surface)
        - structure.parts[joint.slave].model.center
        + structure.parts[joint.slave].center
        for joint in structure.joints
        if joint.master == GROUND
    ]
    return StructureSolid(
        structure,
        each,
        surface,
        first,
        first_cell,
        first_node,
        contacts,
        np.concatenate([piece.struts + start for piece, start in zip(each, first)]),
        np.concatenate(outlines),
    )


def _joined(faces: list[np.ndarray]) -> np.ndarray:
    """Faces of three and four corners as one array; a triangle among quadrilaterals names its last
    corner twice.
    """
    width = max(one.shape[1] for one in faces)
    return np.concatenate(
        [one if one.shape[1] == width else np.column_stack([one, one[:, -1]]) for one in faces]
    )


def _face(piece: Piece, part, name: str) -> np.ndarray:
    """Faces (n, 3 or 4) of a piece in the plane of a surface of its part, those of one kind; of a
    dome those that look down.
    """
    surface, body = part.model.surfaces[name], piece.drawing.body
    size, found = np.ptp(piece.points, axis=0).max(), []
    near = _SAME * size + (
        rise(body) if name == "foot" and getattr(body, "foot_radius_m", None) else 0.0
    )
    for faces in piece.faces:
        level = np.abs(surface.plane(piece.points - part.model.center)[:, 2]) < near
        chosen = faces[level[faces].all(axis=1)]
        corners = piece.points[chosen]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0])
        found.append(chosen[normals @ surface.normal > _SAME * np.linalg.norm(normals, axis=1)])
    return max(found, key=len)


def _outline(piece: Piece, part, name: str) -> np.ndarray:
    """Edges (n, 2, 3) [m] of a surface in the drawing."""
    return piece.points[outline_edges(_face(piece, part, name))]


def _contact(joint, piece: Piece, part, first_node: int, first: int) -> Contact:
    from scipy.spatial import cKDTree

    surface, model = part.model.surfaces[joint.slave_surface], part.model
    # the second tangent of a face that looks down is -y
    seen = np.array([1.0, -1.0 if surface.normal[2] < 0 else 1.0])

    def in_plan(arms):
        return surface.plane(arms)[..., :2] * seen

    plan, outline = (
        in_plan(model.arms[surface.nodes]),
        in_plan(_outline(piece, part, joint.slave_surface) - model.center),
    )
    points = np.unique(_face(piece, part, joint.slave_surface))
    nearest = cKDTree(plan).query(in_plan(piece.points[points] - model.center))[1]
    return Contact(
        joint.name.partition(":")[0],
        part.name,
        joint.slave,
        joint.master == GROUND,
        first_node + surface.nodes,
        surface.areas,
        surface.normal,
        plan,
        outline,
        first + points,
        nearest,
    )
