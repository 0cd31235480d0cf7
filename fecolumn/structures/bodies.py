"""A body as drawn: its mesh or matrices, its plane faces, and how it is reduced."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.bodies import Block, Cylinder, Matrices, MeshBody, Storeys, Tube
from fecolumn.case.case import Case
from fecolumn.case.check_bodies import material_of
from fecolumn.case.sections import Material
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bricks import BrickMesh
from fecolumn.mesh.imported import own_mesh
from fecolumn.mesh.mass import mass_properties
from fecolumn.structures.faces import Face, plane_faces
from fecolumn.structures.feet import domed, lifted, with_balls
from fecolumn.structures.matrices import SystemMatrices, matrices_model, read_system
from fecolumn.structures.model import BodyModel
from fecolumn.structures.patches import Patch
from fecolumn.structures.reduction import elastic_model, rigid_model
from fecolumn.structures.shape import Meshable, Shape, Spot
from fecolumn.structures.shapes import shape_of
from fecolumn.structures.storeys import storeys_model
from fecolumn.structures.weighed import weighed_shares

# Density [kg/m3] of a body without mass: a millionth of the air's, far from where eigenvalues fail
_LIGHTEST = 1e-6


@dataclass(frozen=True, eq=False)
class Drawing:
    """A body in its own drawing, the middle of its foot at the origin; a prism as its outline has
    it, a mesh that stays as drawn as its file has it.

    key: such as "bodies.slab", for messages. body: its keys. shape: its mesh, and system: its
    matrices; one of them is None. faces: its plane faces. material: with the density that the body
    has; None of matrices.
    """

    key: str
    body: Meshable | Matrices
    shape: Shape | None
    system: SystemMatrices | None
    faces: list[Face]
    material: Material | None
    file: Path | str

    @property
    def is_rigid(self) -> bool:
        """Whether it gives at its contact points only."""
        return isinstance(self.body, Storeys) or not getattr(self.body, "deforms", True)

    @property
    def order(self) -> int:
        """Polynomial order of its elements, 1 where it has none."""
        return 1 if self.shape is None or self.is_rigid else self.shape.order

    @property
    def points(self) -> NDArray[Any]:
        """Points (n, 3) [m] that it consists of."""
        if self.shape is not None:
            return self.shape.mesh.points
        assert self.system is not None
        return self.system.coordinates

    def model(
        self, patches: dict[str, Patch], n_modes: int
    ) -> tuple[BodyModel, tuple[NDArray[Any], NDArray[Any]] | None]:
        """The body reduced to its patches; with its nodes (n_nodes, 3) [m] and the modes (m,
        n_nodes, 3) all over it where it is of finite elements.
        """
        model, fields = self._flat_model(patches, n_modes)
        return with_balls(model, self.body), fields

    def _flat_model(
        self, patches: dict[str, Patch], n_modes: int
    ) -> tuple[BodyModel, tuple[NDArray[Any], NDArray[Any]] | None]:
        body, shape, material = self.body, self.shape, self.material
        if isinstance(body, Matrices):
            file = body.stiffness_file

            def refuse(allowed: str) -> NoReturn:
                raise InputError(self.file, f"{self.key}.stiffness_file", file, allowed)

            assert self.system is not None
            return matrices_model(self.system, self.faces, patches, n_modes, refuse), None
        assert shape is not None and material is not None
        if isinstance(body, Storeys):
            mass = mass_properties(shape.mesh, material.density_kg_m3).mass
            return storeys_model(body, mass, patches, material), None
        if not body.deforms:
            return rigid_model(
                shape, self.faces, patches, material, body.contact_stiffness_n_m3
            ), None
        return self._elastic_model(shape, material, patches, n_modes)

    def _elastic_model(
        self, shape: Shape, material: Material, patches: dict[str, Patch], n_modes: int
    ) -> tuple[BodyModel, tuple[NDArray[Any], NDArray[Any]]]:
        from petsc4py import PETSc

        try:
            return elastic_model(shape, self.faces, patches, material, n_modes)
        except (PETSc.Error, RuntimeError, np.linalg.LinAlgError):
            thinnest, longest = _edges(shape.mesh)
            raise InputError(
                self.file,
                self.key,
                None,
                f"cannot be reduced: its elements measure {thinnest:.3g} m across and "
                f"{longest:.3g} m along, so that their stiffness is beyond rounding; make them "
                "smaller (element_size_m, coarse_size_m), what is thin thicker, or state "
                "rigid = true",
            ) from None


def drawing(case: Case, name: str, file: Path | str, spots: Sequence[Spot] = ()) -> Drawing:
    """Drawing of a body of a case; spots as of `shapes.shape_of`.

    Raises
    ------
    InputError
        a file that cannot be used.
    """
    body, key = case.bodies[name], f"bodies.{name}"
    if isinstance(body, Matrices):
        system = read_system(key, body, file)
        return Drawing(key, body, None, system, system.faces(), None, file)
    assert isinstance(body, Meshable)
    shape = shape_of(key, body, file, spots)
    material, weighed_as = material_of(body, case.materials), shape.mesh
    if isinstance(body, (Tube, Cylinder, Block)) and body.foot_radius_m:
        domed_points = lifted(body, shape.mesh.points)
        weighed_as = dataclasses.replace(shape.mesh, points=domed_points)
    if body.mass_kg is not None:
        volume = mass_properties(weighed_as, 1.0).mass
        try:
            material = dataclasses.replace(material, density_kg_m3=body.mass_kg / volume)
        except InputError as error:
            raise InputError(
                file,
                f"{key}.mass_kg",
                body.mass_kg,
                f"makes a density of {body.mass_kg / volume:.4g} kg/m3 in {volume:.4g} "
                f"m3: {error.allowed}",
            ) from None
    if material.density_kg_m3 < _LIGHTEST:
        stated = "density_kg_m3" if body.mass_kg is None else "mass_kg"
        raise InputError(
            file,
            f"{key}.{stated}",
            getattr(body, stated),
            f"makes a density of {material.density_kg_m3:.3g} kg/m3, must be at least "
            f"{_LIGHTEST:g} kg/m3: lighter bodies are none",
        )
    shares = weighed_shares(key, body, weighed_as, material.density_kg_m3, file)
    if shares is not None:
        shape = dataclasses.replace(
            shape, mesh=dataclasses.replace(shape.mesh, relative_density=shares)
        )
    if angle := getattr(body, "turned_deg", 0.0):
        shape = dataclasses.replace(
            shape,
            mesh=dataclasses.replace(shape.mesh, points=_turned(shape.mesh.points, angle)),
        )
    if isinstance(body, MeshBody) and body.as_drawn:
        moved = shape.mesh.points + own_mesh(body.drawn).drawn_at
        shape = dataclasses.replace(shape, mesh=dataclasses.replace(shape.mesh, points=moved))
    faces = plane_faces(shape.mesh)
    if isinstance(body, (Tube, Cylinder, Block)) and body.foot_radius_m:
        mesh, faces = domed(body, shape.mesh, faces)
        shape = dataclasses.replace(shape, mesh=mesh)
    return Drawing(key, body, shape, None, faces, material, file)


def _edges(mesh: BrickMesh) -> tuple[float, float]:
    """Shortest and longest distance [m] between corners of one element."""
    corners = mesh.points[mesh.cells]
    first, second = np.triu_indices(corners.shape[1], 1)
    lengths = np.linalg.norm(corners[:, first] - corners[:, second], axis=2)
    return float(lengths.min()), float(lengths.max())


def _turned(points: NDArray[Any], angle: float) -> NDArray[Any]:
    """Points (n, 3) [m] turned about the z axis by an angle [deg], those of quarters exactly."""
    cosine, sine = (
        round(value, 15) for value in (np.cos(np.radians(angle)), np.sin(np.radians(angle)))
    )
    turn = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    turned: NDArray[Any] = points @ turn
    return turned
