"""The column of a finite-element case as one rigid body: what closed-form models take from it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.short_form import ShortForm


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


def rigid_column(case: ShortForm) -> RigidColumn:
    """Column of a case from closed forms; of its own mesh, by that mesh's volume.

    Raises
    ------
    InputError
        a mesh that cannot be used.
    """
    from fecolumn.mesh.imported import imported_column, own_mesh
    from fecolumn.mesh.quality import exact_cap, exact_column, exact_flange, mass_properties

    if case.column.mesh_file:
        own = own_mesh(case.column.mesh_file)
        body, extent, top, is_round = (
            mass_properties(imported_column(case), case.material.density_kg_m3),
            np.array(own.foot),
            own.height,
            False,
        )
        if case.cap:
            body, top = body + exact_cap(case), case.top_m
    else:
        body, top = exact_column(case), case.top_m
        for part, exact in ((case.flange, exact_flange), (case.cap, exact_cap)):
            if part:
                body = body + exact(case)
        column = case.column
        is_round = column.shape != "block"
        wide = case.flange.outer_diameter_m if case.flange else column.outer_diameter_m
        extent = np.array([wide, wide]) if is_round else np.array([column.length_m, column.width_m])
    return RigidColumn(
        float(body.mass),
        float(body.centre[2]),
        tuple(np.diag(body.inertia).tolist()),
        tuple(body.centre[:2].tolist()),
        tuple((extent / 2).tolist()),
        float(top),
        is_round,
    )
