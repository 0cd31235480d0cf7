"""A body's elements, and how large they are."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fecolumn.case.bodies import Block, Cone, Cylinder, MeshBody, Plate, Prism, Storeys, Tube
from fecolumn.case.polygon import signed_area
from fecolumn.mesh.bricks import BrickMesh
from fecolumn.mesh.tie import Tie

# Elements around a round body, and along the geometric mean of a block's sides
AROUND, _ALONG = 24, 8
# Length of linear elements along a bar over its depth d: a length l makes bending stiffer by (l /
# d)^2 / 2
_LONG = 0.2
# Elements along the longer side of a plate, away from what stands on it
ACROSS_A_PLATE = 8

#: Bodies with a round section, those whose elements are made here, and all that have elements.
Round = Tube | Cylinder | Cone
Gridded = Round | Block | Plate | Prism | Storeys
Meshable = Gridded | MeshBody
#: Low x, high x, low y, high y and size [m] in the drawing of a plate where another body meets it.
Spot = tuple[float, float, float, float, float]


@dataclass(frozen=True, slots=True)
class Shape:
    """A body's elements: mesh, ties between its parts, polynomial order of the elements, and
    element size at its foot [m].
    """

    mesh: BrickMesh
    ties: tuple[Tie, ...]
    order: int
    size: float


def element_size(body: Gridded) -> float:
    """Element size at feet and heads [m], as stated or as it follows from the body's dimensions."""
    if body.element_size_m is not None:
        return body.element_size_m
    if isinstance(body, (Plate, Storeys)):
        return max(body.length_m, body.width_m) / ACROSS_A_PLATE
    if isinstance(body, Block):
        return min(
            math.sqrt(body.length_m * body.width_m) / _ALONG, min(body.length_m, body.width_m) / 4
        )
    if isinstance(body, Prism):
        across = math.sqrt(abs(signed_area(body.outline_m)))
        return min(math.sqrt(across * body.width_m) / _ALONG, min(across, body.width_m) / 4)
    return (
        math.pi
        * (body.outer_diameter_m - (body.wall_m if isinstance(body, Tube) else 0.0))
        / AROUND
    )


def coarse_size(body: Round | Block, size: float) -> float:
    """Largest element size [m] away from the ends of a block, tube or cylinder."""
    return body.coarse_size_m or max(
        size,
        _LONG
        * (min(body.length_m, body.width_m) if isinstance(body, Block) else body.outer_diameter_m),
    )
