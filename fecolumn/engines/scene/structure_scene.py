"""The scene of a structure of many bodies."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import Block, Cylinder, Matrices, Storeys, Tube, rise
from fecolumn.case.case import Case
from fecolumn.case.ground import Ground
from fecolumn.engines.scene.scene import JointFace, Piece, Scene, cells_of, same_corners
from fecolumn.engines.scene.state_fields import (
    Continuum,
    Rigid,
    StateFields,
    SunkPlate,
    SwayingFloors,
    seats_of,
)
from fecolumn.mesh.bricks import BASE, FACES, outer_faces
from fecolumn.mesh.mass import MassProperties
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.feet import ball_of
from fecolumn.structures.model import BodyModel, JointModel, Part, StructureModel
from fecolumn.structures.storeys import building_of

if TYPE_CHECKING:
    from fecolumn.structures.ground import Sized

# Of faces in the plane of a contact surface, over the body's size and as a sine
_SAME = 1e-5


def scene_of(case: Case, structure: StructureModel, file: Path | str) -> Scene:
    """The scene of a case, meshed anew.

    Parameters
    ----------
    structure
        of the case at its start.
    file
        of the case, for messages.

    Raises
    ------
    InputError
        files that the case names are gone.
    """
    from fecolumn.engines.reduced_engine import upright
    from fecolumn.structures.layout import layout_of

    return structure_scene(case, upright(case, structure), layout_of(case, file).drawings, file)


def structure_scene(
    case: Case, structure: StructureModel, drawings: dict[str, Drawing], file: Path | str
) -> Scene:
    """The scene of the bodies of a case.

    Parameters
    ----------
    structure
        upright.
    drawings
        by body.
    file
        of the case, for messages.
    """
    kinds = [name for name, _ in case.copies]
    shown = {name: _Shown(drawing) for name, drawing in drawings.items()}
    bodies = [
        shown[kind].piece(kind, part) for kind, part in zip(kinds, structure.parts, strict=True)
    ]
    plates = _plates(case, structure, file)
    held = [_ground_piece(case, ground, *plates[ground]) for ground in plates]
    pieces = (*bodies, *held)
    first = np.cumsum([0] + [len(piece.points) for piece in pieces])
    contacts = tuple(
        _contact(joint, shown[kinds[joint.slave]], structure.parts[joint.slave], first)
        for joint in structure.joints
    )
    parts = structure.parts
    alone = parts[0].model if len(parts) == 1 else None
    return Scene(
        pieces,
        contacts,
        {
            "part": np.concatenate(
                [shown[kind].part for kind in kinds]
                + [np.full(len(piece.elements), BASE) for piece in held]
            ),
            "body": np.repeat(
                [*range(1, len(bodies) + 1), *[0] * len(held)],
                [len(piece.elements) for piece in pieces],
            ),
        },
        lambda scene: _expanded(case, structure, kinds, shown, scene, file),
        lambda: [(_plate(*plates[place]), place) for place in plates],
        structure.links,
        MassProperties(np.nan, alone.mass, parts[0].center, alone.inertia) if alone else None,
        frozenset(k for k, joint in enumerate(structure.joints) if joint.pair >= 0),
        {k: level for k, level in enumerate(structure.levels) if k not in plates},
    )


def _plates(
    case: Case, structure: StructureModel, file: Path | str
) -> dict[int, tuple[Sized, Ground]]:
    """(Sized, keys) of each elastic plate on which something stands, by the ground's number."""
    from fecolumn.structures.ground import feet_on, sized_ground

    found = {}
    for place, (name, ground) in enumerate(case.grounds.items()):
        feet = feet_on(structure.parts, structure.joints, place)
        if ground.kind == "plate" and feet:
            found[place] = sized_ground(name, ground, feet, file), ground
    return found


def _ground_piece(case: Case, place: int, sized: Sized, ground: Ground) -> Piece:
    from fecolumn.structures.ground import plate_mesh

    mesh, name = plate_mesh(sized), list(case.grounds)[place]
    faces = outer_faces(mesh, BASE)
    level = np.array([0.0, 0.0, ground.level_m])
    cells = cells_of(mesh.cells, faces)
    return Piece(name, name, mesh.points, faces, mesh.cells, cells, level, level, held=True)


class _Shown:
    """The outside of a body, and its elements, the floors of a building and the triangles of
    matrices among them.
    """

    def __init__(self, drawing: Drawing) -> None:
        self.drawing, self.floors, self.points = drawing, 0, drawing.points
        if drawing.shape is None:
            assert drawing.system
            self.kinds = [drawing.system.triangles]
            self.elements = drawing.system.triangles
            self.cells = np.full(len(self.elements), -1)
            self.part = np.zeros(len(self.elements), np.int8)
            return
        mesh = drawing.shape.mesh
        self.elements = mesh.cells
        self.kinds = [outer_faces(mesh, part) for part in sorted(set(mesh.part.tolist()))]
        if isinstance(drawing.body, Storeys):
            floors = floor_boxes(drawing.body)
            self.floors = len(floors)
            boxes = np.arange(8 * len(floors)).reshape(-1, 8) + len(mesh.points)
            self.points = np.concatenate([mesh.points, floors.reshape(-1, 3)])
            self.elements = np.concatenate([mesh.cells, boxes])
            self.kinds.append(boxes[:, FACES].reshape(-1, 4))
        self.cells = cells_of(self.elements, np.concatenate(self.kinds))
        self.part = np.pad(mesh.part, (0, self.floors))

    def piece(self, kind: str, part: Part) -> Piece:
        """The piece of a copy."""
        body = self.drawing.body
        soft = not (
            isinstance(body, (Matrices, Storeys))
            or self.drawing.is_rigid
            # the contact points of a foot that is not flat are no nodes of its mesh
            or ball_of(body)
        )
        return Piece(
            part.name,
            kind,
            self.points,
            same_corners(self.kinds),
            self.elements,
            self.cells,
            part.center - part.model.center,
            part.center,
            stressed=soft,
            carried=8 * self.floors,
            struts=self._struts(),
        )

    def _struts(self) -> NDArray[Any]:
        """(n, 2) corners of a floor, or of the slab, and of the floor above."""
        from scipy.spatial import cKDTree

        if not self.floors:
            return np.zeros((0, 2), np.int64)
        slab = len(self.points) - 8 * self.floors
        boxes = slab + np.arange(8 * self.floors).reshape(-1, 8)
        top = self.points[boxes[0, :4]] * [1, 1, 0] + [0, 0, self.points[:slab, 2].max()]
        below = np.vstack([cKDTree(self.points[:slab]).query(top)[1], boxes[:-1, 4:]])
        return np.stack([below.ravel(), boxes[:, :4].ravel()], axis=1)

    def face(self, model: BodyModel, name: str) -> NDArray[Any]:
        """Faces (n, 3 or 4) in the plane of a surface of the body, those of one kind; of a dome
        those that look down.
        """
        surface, body = model.surfaces[name], self.drawing.body
        size, found = np.ptp(self.points, axis=0).max(), []
        near = _SAME * size
        if name == "foot" and isinstance(body, (Tube, Cylinder, Block)) and body.foot_radius_m:
            near += rise(body)
        level = np.abs(surface.plane(self.points - model.center)[:, 2]) < near
        for faces in self.kinds:
            chosen = faces[level[faces].all(axis=1)]
            corners = self.points[chosen]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0])
            found.append(chosen[normals @ surface.normal > _SAME * np.linalg.norm(normals, axis=1)])
        return max(found, key=len)


def floor_boxes(body: Storeys) -> NDArray[Any]:
    """Corners (n, 8, 3) [m] of the floors of a building in the order of a VTK hexahedron, drawn a
    tenth of their storey thick.
    """
    top = building_of(body).heights
    thick = np.diff(top, prepend=body.thickness_m) / 10
    plan = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * [body.length_m / 2, body.width_m / 2]
    return np.array(
        [
            [[*corner, level] for level in (high - depth, high) for corner in plan]
            for high, depth in zip(top, thick)
        ]
    )


def _contact(joint: JointModel, shown: _Shown, part: Part, first: NDArray[Any]) -> JointFace:
    surface = part.model.surfaces[joint.slave_surface]
    # the second tangent of a face that looks down is -y
    axes = surface.axes * [1.0, -1.0 if surface.normal[2] < 0 else 1.0, 1.0]
    faces = shown.face(part.model, joint.slave_surface) + first[joint.slave]
    name = joint.name.partition(":")[0]
    origin = part.center + surface.origin
    domed = joint.on_dome
    return JointFace(
        name,
        part.name,
        joint.slave,
        joint.master,
        faces,
        origin,
        axes,
        domed,
        joint.ground,
        joint.name,
        joint.pair,
    )


def _expanded(
    case: Case,
    structure: StructureModel,
    kinds: list[str],
    shown: dict[str, _Shown],
    scene: Scene,
    file: Path | str,
) -> StateFields:
    from fecolumn.structures.made_layout import kept_keys
    from fecolumn.structures.store import body_folder

    keys = kept_keys(case, file)
    copies: dict[str, list[int]] = {}
    for number, kind in enumerate(kinds):
        copies.setdefault(kind, []).append(number)
    movers = []
    for kind, numbers in copies.items():
        model, one = structure.parts[numbers[0]].model, shown[kind]
        movers.append(
            (_mover(scene.pieces[numbers[0]], model, one, body_folder(keys[kind])), numbers)
        )
    models = [part.model for part in structure.parts]
    return StateFields(scene, movers, models, seats_of(structure, scene), scene.plates())


def _plate(sized: Sized, ground: Ground) -> SunkPlate:
    from fecolumn.structures.ground import plate_of

    return SunkPlate(plate_of(sized, ground))


def _mover(
    piece: Piece, model: BodyModel, one: _Shown, folder: Path
) -> Rigid | Continuum | SwayingFloors:
    """How the points of a piece move in the frame of its body."""
    from fecolumn.structures.reduction import body_of

    if one.floors:
        return SwayingFloors(piece.points - model.center, model, one.floors)
    if not piece.stressed:
        return Rigid(len(piece.points))
    shape, material = one.drawing.shape, one.drawing.material
    assert shape and material
    body = body_of(shape, material)
    shapes = np.load(folder / "fields.npy", mmap_mode="r")
    return Continuum(body, model, body.find_nodes(model.reference), shapes)
