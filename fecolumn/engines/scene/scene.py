"""What is drawn of a case: pieces, and the faces on which they meet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from fecolumn.contact.points import GROUND
from fecolumn.mesh.bricks import FACES, TETRAHEDRON_FACES, BrickMesh, outline_edges
from fecolumn.mesh.mass import MassProperties

if TYPE_CHECKING:
    from mpi4py import MPI

    from fecolumn.engines.reduced.states import Snapshot
    from fecolumn.structures.model import BodyModel, LinkModel


class ElasticGround(Protocol):
    """`state_fields.SunkPlate`."""

    def sunk(
        self, positions: NDArray[Any], forces: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any]]:
        """Displacement and stress under forces at positions."""


class SceneFields(Protocol):
    """`state_fields.StateFields`, which tells what each of these is."""

    comm: MPI.Intracomm
    of_cells: dict[str, NDArray[Any]]
    meshes: list[BrickMesh]
    models: list[BodyModel]

    def local(
        self, state: Snapshot, stress: bool = True
    ) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Displacement, deformation and stress of bodies in their frames."""

    def positions(self, state: Snapshot, local: NDArray[Any]) -> NDArray[Any]:
        """Positions of all points."""

    def pressures(self, state: Snapshot) -> tuple[list[NDArray[Any]], NDArray[Any]]:
        """Pressures on the joints' faces, and their centres."""

    def values(self, state: Snapshot) -> dict[str, NDArray[Any]]:
        """Displacement, stress and pressure by their names in files."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A body, or a part of the ground, in its own drawing.

    Attributes
    ----------
    name
        of the body, such as "column 2".
    kind
        what it is a copy of, such as "column".
    points
        (n, 3) [m]
    faces
        (n_faces, 4 or 3) outer faces, counter-clockwise seen from outside.
    elements
        (n_cells, 8, 4 or 3) of these points.
    cells
        (n_faces,) element of each face, -1 of one without.
    place
        (3,) [m] from the drawing to where the piece stands upright.
    center
        (3,) [m] of mass there.
    held
        whether it is part of the ground: it gives, but never moves away.
    stressed
        whether it deforms as a continuum.
    carried
        how many of the last points are floors, which shift relative to the other points.
    struts
        (k, 2) points between which a building has its columns.
    """

    name: str
    kind: str
    points: NDArray[Any]
    faces: NDArray[Any]
    elements: NDArray[Any]
    cells: NDArray[Any]
    place: NDArray[Any]
    center: NDArray[Any]
    held: bool = False
    stressed: bool = True
    carried: int = 0
    struts: NDArray[Any] = field(default_factory=lambda: np.zeros((0, 2), np.int64))

    @property
    def upright(self) -> NDArray[Any]:
        """Points (n, 3) [m] where the piece stands at first."""
        points: NDArray[Any] = self.points + self.place
        return points


@dataclass(frozen=True, eq=False)
class JointFace:
    """The slave's face of a joint.

    Attributes
    ----------
    interface, slave
        names of the interface and of the slave.
    piece, master
        numbers of the slave and of what it stands on, GROUND of the ground.
    faces
        (n, 4 or 3) numbers of the scene's points.
    ground
        number of the ground, of a contact with one.
    domed
        whether it touches at one point of a dome.
    origin, axes
        (3,) [m] and (3, 3): a point of the face, two tangents and the normal out of the slave, in
        columns, as it stands upright; of a level face the tangents are x and y.
    joint
        its name in the history.
    pair
        number of the contact whose other side this is, -1 of none.
    """

    interface: str
    slave: str
    piece: int
    master: int
    faces: NDArray[Any]
    origin: NDArray[Any]
    axes: NDArray[Any]
    domed: bool = False
    ground: int = 0
    joint: str = ""
    pair: int = -1

    @property
    def on_ground(self) -> bool:
        """Whether the slave of this joint stands on a ground, not on another body."""
        return self.master == GROUND

    def stands_on(self, ground: int) -> bool:
        """Whether the slave stands on the ground with this number, its place in the case."""
        return self.on_ground and self.ground == ground

    @cached_property
    def points(self) -> NDArray[Any]:
        """Numbers (k,) of the points of the face, rising."""
        points: NDArray[Any] = np.unique(self.faces)
        return points

    @cached_property
    def outline(self) -> NDArray[Any]:
        """(n, 2) numbers of the points at the ends of its edges."""
        return outline_edges(self.faces)

    def plan(self, places: NDArray[Any]) -> NDArray[Any]:
        """Coordinates (..., 2) [m] of places (..., 3) [m] along the tangents."""
        plan: NDArray[Any] = (places - self.origin) @ self.axes[:, :2]
        return plan


@dataclass(frozen=True, eq=False)
class Outside:
    """The outside of some pieces.

    Attributes
    ----------
    nodes
        (n,) numbers of the scene's points that are seen.
    faces
        (n_faces, 4 or 3) of these.
    cells
        (n_faces,) the element that each belongs to, -1 of none.
    part
        (n_faces,) the piece.
    """

    nodes: NDArray[Any]
    faces: NDArray[Any]
    cells: NDArray[Any]
    part: NDArray[Any]


@dataclass(frozen=True, eq=False)
class Scene:
    """What is drawn of a case, upright where it stands at first.

    Attributes
    ----------
    pieces
        bodies first, then what belongs to the ground.
    contacts
        of each joint.
    of_cells
        numbers of the elements of all pieces by name, for ParaView.
    expand
        makes the `engines.scene.state_fields.StateFields` of the scene.
    give
        makes what its `plates` are.
    links
        of `structures.model.LinkModel`.
    mass
        MassProperties of a body that stands alone, where it stands upright; else None.
    other_sides
        numbers of the contacts that are the other side of a joint.
    planes
        height [m] by number of the grounds that are drawn as a plane.
    """

    pieces: tuple[Piece, ...]
    contacts: tuple[JointFace, ...]
    of_cells: dict[str, NDArray[Any]]
    expand: Callable[[Scene], SceneFields]
    give: Callable[[], list[tuple[ElasticGround, int]]]
    links: tuple[LinkModel, ...] = ()
    mass: MassProperties | None = None
    other_sides: frozenset[int] = frozenset()
    planes: dict[int, float] = field(default_factory=dict)

    def fields(self) -> SceneFields:
        """`engines.scene.state_fields.StateFields` of the scene; made anew, which takes time."""
        return self.expand(self)

    def plates(self) -> list[tuple[ElasticGround, int]]:
        """`engines.scene.state_fields.SunkPlate` and number of the ground of each elastic plate."""
        return self.give()

    @cached_property
    def bodies(self) -> tuple[Piece, ...]:
        """Pieces that move."""
        return tuple(piece for piece in self.pieces if not piece.held)

    @cached_property
    def first(self) -> NDArray[Any]:
        """Of each piece among all points, one more at the end."""
        return np.cumsum([0] + [len(piece.points) for piece in self.pieces])

    @cached_property
    def first_cell(self) -> NDArray[Any]:
        """Of each piece among all elements, one more at the end."""
        return np.cumsum([0] + [len(piece.elements) for piece in self.pieces])

    @cached_property
    def points(self) -> NDArray[Any]:
        """(n, 3) [m] of all pieces at rest."""
        return np.concatenate([piece.upright for piece in self.pieces])

    @cached_property
    def height(self) -> float:
        """Of all bodies [m]."""
        return float(np.ptp(self._of_bodies[:, 2]))

    @cached_property
    def width(self) -> float:
        """Larger side in plan of all bodies [m]."""
        return float(np.ptp(self._of_bodies[:, :2], axis=0).max())

    @property
    def _of_bodies(self) -> NDArray[Any]:
        return self.points[: self.first[len(self.bodies)]]

    @cached_property
    def surface(self) -> Outside:
        """The outside of all bodies."""
        return self._surface(range(len(self.bodies)))

    @cached_property
    def base(self) -> Outside | None:
        """The outside of the ground; None where it is a plane."""
        held = range(len(self.bodies), len(self.pieces))
        return self._surface(held) if held else None

    def _surface(self, numbers: range) -> Outside:
        own = [self.pieces[k] for k in numbers]
        faces = same_corners([piece.faces + self.first[k] for k, piece in zip(numbers, own)])
        cells = [
            np.where(piece.cells < 0, -1, piece.cells + self.first_cell[k])
            for k, piece in zip(numbers, own)
        ]
        nodes, corners = np.unique(faces, return_inverse=True)
        part = np.repeat(np.array(numbers), [len(piece.faces) for piece in own])
        return Outside(nodes, corners.reshape(faces.shape), np.concatenate(cells), part)

    @cached_property
    def struts(self) -> NDArray[Any]:
        """(n, 2) points between which buildings have columns."""
        return np.concatenate(
            [piece.struts + start for piece, start in zip(self.pieces, self.first)]
        )

    @cached_property
    def shown(self) -> list[int]:
        """Numbers of the contacts that are shown, one of each joint."""
        return [k for k in range(len(self.contacts)) if k not in self.other_sides]

    @cached_property
    def outlines(self) -> NDArray[Any]:
        """Edges (n, 2, 3) [m] of the feet on the ground."""
        return np.concatenate(
            [self.points[one.outline] for one in self.contacts if one.on_ground]
            or [np.empty((0, 2, 3))]
        )

    @property
    def meshes(self) -> list[BrickMesh]:
        """Mesh of each piece where it stands at first, as `scene.fields.FieldWriter` takes it."""
        parts = np.split(self.of_cells["part"], self.first_cell[1:-1])
        return [
            BrickMesh(piece.upright, piece.elements, part)
            for piece, part in zip(self.pieces, parts)
        ]

    @cached_property
    def has_stress(self) -> bool:
        """Whether any body deforms as a continuum."""
        return any(piece.stressed for piece in self.bodies)

    def own(self, k: int) -> slice:
        """The points of piece k among all."""
        return slice(self.first[k], self.first[k + 1])


def same_corners(faces: list[NDArray[Any]]) -> NDArray[Any]:
    """Faces of three and four corners as one array; a triangle among quadrilaterals names its last
    corner twice.
    """
    width = max(one.shape[1] for one in faces)
    return np.concatenate(
        [one if one.shape[1] == width else np.column_stack([one, one[:, -1]]) for one in faces]
    )


def cells_of(elements: NDArray[Any], faces: NDArray[Any]) -> NDArray[Any]:
    """Element (n_faces,) to which each outer face belongs."""
    of_cell = TETRAHEDRON_FACES if elements.shape[1] == 4 else FACES
    every = np.sort(elements[:, of_cell].reshape(-1, of_cell.shape[1]), axis=1)
    _, number = np.unique(
        np.concatenate([every, np.sort(faces, axis=1)]), axis=0, return_inverse=True
    )
    owner = np.empty(number.max() + 1, np.int64)
    owner[number.ravel()[: len(every)]] = np.arange(len(every)) // len(of_cell)
    cells: NDArray[Any] = owner[number.ravel()[len(every) :]]
    return cells
