"""Bodies that were weighed: mass, centre and inertia that their case states."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import MeshBody
from fecolumn.case.body_keys import Solid, WithMaterial
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import BrickMesh
from fecolumn.mesh.imported import own_mesh
from fecolumn.mesh.mass import MassProperties, mass_properties
from fecolumn.mesh.weighing import NoSuchDensity, relative_densities


def weighed(body: WithMaterial, found: MassProperties) -> MassProperties:
    """The mass properties `found` of a body in its own drawing, before it is turned, with what its
    case states in their place.
    """
    mass = found.mass if body.mass_kg is None else body.mass_kg
    inertia = found.inertia * (mass / found.mass)
    centre = found.centre
    if isinstance(body, Solid):
        if body.centre_m:
            centre = np.array(body.centre_m)
            if isinstance(body, MeshBody) and body.as_drawn:
                centre = centre - np.array(own_mesh(body.drawn).drawn_at)
        if body.inertia_kg_m2:
            inertia = tensor(body.inertia_kg_m2)
    return dataclasses.replace(found, mass=mass, centre=centre, inertia=inertia)


def tensor(values: tuple[float, ...]) -> NDArray[Any]:
    """Inertia (3, 3) of xx, yy, zz and, if there are six, xy, xz, yz."""
    xx, yy, zz, xy, xz, yz = (*values, 0.0, 0.0, 0.0)[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def weighed_shares(
    key: str, body: WithMaterial, mesh: BrickMesh, density: float, file: Path | str
) -> NDArray[Any] | None:
    """Densities (n_cells,) over the material's with which a mesh that is not turned yet has the
    centre and inertia stated; None where none are.

    Raises
    ------
    InputError
        no body within its outline has them.
    """
    stated = [name for name in ("centre_m", "inertia_kg_m2") if getattr(body, name, ())]
    if not stated:
        return None
    wanted = weighed(body, mass_properties(mesh, density))
    inertia = wanted.inertia / density if "inertia_kg_m2" in stated else None
    try:
        return relative_densities(mesh, wanted.mass / density, wanted.centre, inertia)
    except NoSuchDensity as error:
        raise InputError(
            file, f"{key}.{stated[-1]}", list(getattr(body, stated[-1])), str(error)
        ) from None
