"""A body of a case as one rigid body on its foot: what closed-form models take from it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.case.bodies import Block, Cylinder, MeshBody, Plate, Storeys, Tube
from fecolumn.case.case import Case
from fecolumn.case.check_bodies import material_of
from fecolumn.foundation.schema import InputError

# Kinds of bodies whose mass, inertia and foot are known here, as of rigid bodies
_KNOWN_FEET = ("tube", "cylinder", "block", "plate", "slab", "storeys", "mesh")
_CLASSES = (Tube, Cylinder, Block, Plate, Storeys, MeshBody)


@dataclass(frozen=True, slots=True)
class RigidColumn:
    """Column with flange and cap, standing on its foot.

    Attributes
    ----------
    mass
        [kg].
    height
        of the centre of mass [m].
    inertia
        about axes along x, y and z through it (3,) [kg m2].
    offset
        of the centre of mass from the middle of the foot along x and y (2,) [m].
    half_foot
        half the foot's extent along x and y (2,) [m].
    top
        height of the top's centre [m].
    round
        whether the foot is round.
    """

    mass: float
    height: float
    inertia: tuple[float, float, float]
    offset: tuple[float, float]
    half_foot: tuple[float, float]
    top: float
    round: bool


def rigid_body(case: Case, name: str, file: Path | str) -> RigidColumn:
    """A body of a Case as one rigid body on its foot, from closed forms; of a mesh, by its
    volume.

    Raises
    ------
    InputError
        a body of matrices, whose shape is not known, a prism, a cone, or any kind that is none of
        _KNOWN_FEET.
    """
    from fecolumn.mesh.imported import own_mesh
    from fecolumn.mesh.mass import mass_properties
    from fecolumn.mesh.quality import box_properties, ring_properties
    from fecolumn.structures.weighed import weighed

    body, is_round = case.bodies[name], False
    if body.kind not in _KNOWN_FEET or not isinstance(body, _CLASSES):
        raise InputError(
            file,
            f"bodies.{name}.kind",
            body.kind,
            f"is no body of a model; integration.engine = {case.integration.engine!r} needs one of "
            "another kind, whose foot is known",
        )
    density = material_of(body, case.materials).density_kg_m3
    flange, cap = getattr(body, "flange", None), getattr(body, "cap", None)
    seat = flange.thickness_m if flange else 0.0
    if isinstance(body, MeshBody):
        own = own_mesh(body.drawn)
        if not own.has_foot:
            raise InputError(
                file, f"bodies.{name}.mesh_file", body.mesh_file, "has no flat foot to rock on"
            )
        found, extent, top = mass_properties(own.mesh, density), own.foot, own.height
    elif isinstance(body, (Tube, Cylinder)):
        is_round, outer = True, body.outer_diameter_m / 2
        inner = outer - body.wall_m if isinstance(body, Tube) else 0.0
        found, top = (
            ring_properties(outer, inner, body.height_m, seat, density),
            seat + body.height_m,
        )
        extent = (2 * outer,) * 2
    else:
        extent = body.length_m, body.width_m
        height = body.height_m if isinstance(body, Block) else body.thickness_m
        found, top = box_properties(*extent, height, seat, density), seat + height
    if flange:
        wide, bore = flange.outer_diameter_m, flange.inner_diameter_m
        found, extent = found + ring_properties(wide / 2, bore / 2, seat, 0.0, density), (wide,) * 2
        is_round = True
    if cap:
        found = found + box_properties(cap.length_m, cap.width_m, cap.thickness_m, top, density)
        top += cap.thickness_m
    found = weighed(body, found)
    return RigidColumn(
        float(found.mass),
        float(found.centre[2]),
        tuple(np.diag(found.inertia).tolist()),
        tuple(found.centre[:2].tolist()),
        tuple((np.array(extent) / 2).tolist()),
        float(top),
        is_round,
    )
