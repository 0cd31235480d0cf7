"""What is seen of the bodies and links of a structure."""

from __future__ import annotations

import numpy as np

from fecolumn.mesh.bricks import FACES, outer_faces
from fecolumn.structures.bodies import Drawing
from fecolumn.structures.keys import Storeys
from fecolumn.structures.model import GROUND, Link, Part
from fecolumn.structures.storeys import building_of


def outside(drawing: Drawing) -> tuple[np.ndarray, list[np.ndarray]]:
    """Points (n, 3) [m] of a body in its drawing, and its outer faces (n_faces, 4 or 3), those of
    each of its parts by themselves.

    The floors of a building come last, eight points each; of a body of matrices its contact nodes
    are seen.
    """
    if drawing.shape is None:
        return drawing.points, [drawing.system.triangles]
    mesh = drawing.shape.mesh
    faces = [outer_faces(mesh, part) for part in sorted(set(mesh.part.tolist()))]
    if not isinstance(drawing.body, Storeys):
        return mesh.points, faces
    floors = floor_boxes(drawing.body)
    return np.concatenate([mesh.points, floors.reshape(-1, 3)]), [
        *faces,
        np.concatenate([FACES + 8 * floor for floor in range(len(floors))]) + len(mesh.points),
    ]


def floor_boxes(body: Storeys) -> np.ndarray:
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


def link_ends(link: Link, parts: tuple[Part, ...], center=None, rotation=None) -> np.ndarray:
    """Both ends (2, 3) [m] of a link where its parts are, or where these have centres of mass (nb,
    3) [m] and are turned by (nb, 3, 3).
    """

    def at(place, arm):
        if place == GROUND:
            return arm
        here = (
            (parts[place].center, parts[place].rotation)
            if center is None
            else (center[place], rotation[place])
        )
        return here[0] + here[1] @ arm

    return np.array([at(link.a, link.arm_a), at(link.b, link.arm_b)])
