"""From a case to the mechanical system."""

from __future__ import annotations

import numpy as np

from fecolumn.case import GRAVITY
from fecolumn.contact.base_plate import BasePlate
from fecolumn.contact.footprint import Footprint, footprint
from fecolumn.contact.law import interface_compliance
from fecolumn.contact.pad import pad_of
from fecolumn.contact.rim import Rim
from fecolumn.contact.unbounded_base import UnboundedBase, rigid_base, unbounded_base
from fecolumn.dynamics.hht import HHT
from fecolumn.dynamics.structure import kinematics_of
from fecolumn.dynamics.system import System, one_column
from fecolumn.fem.body import Body
from fecolumn.mesh.base_plate import levels
from fecolumn.mesh.bricks import boundary_faces, outline_edges
from fecolumn.mesh.specimen import SpecimenMesh, specimen_mesh
from fecolumn.mesh.surface import face_basis, face_points, nodal_areas
from fecolumn.mesh.tie import project_to_quads
from fecolumn.schema import InputError
from fecolumn.short_form import ShortForm
from fecolumn.sizes import foot_sides


def known_to_all(comm, make):
    """What `make` makes on rank 0, known on every rank; a refusal is raised on every rank."""
    result, refusal = None, None
    if comm.rank == 0:
        try:
            result = make()
        except InputError as error:
            refusal = error.file, error.key, error.value, error.allowed
    result, refusal = comm.bcast((result, refusal)) if comm.size > 1 else (result, refusal)
    if refusal:
        raise InputError(*refusal)
    return result


def share_specimen_mesh(case: ShortForm, comm) -> SpecimenMesh:
    """The specimen's mesh, made on rank 0 and known on every rank."""
    return known_to_all(comm, lambda: specimen_mesh(case))


def column_body(case: ShortForm, specimen: SpecimenMesh, comm) -> Body:
    """Column and cap as one body with their ties."""

    def ties(body):
        return {
            slave: link
            for one in specimen.ties
            for slave, link in _tie_links(body, specimen.body, one)
        }, ()

    return Body(comm, specimen.body, case.material, case.mesh.element_order, ties)


def _tie_links(body: Body, mesh, tie):
    """(slave node, (master nodes, weights)) of one tie, at the Lagrange nodes of the body's order."""
    slave_quads = boundary_faces(
        mesh,
        tie.slave_part,
        mesh.points[tie.slave_nodes, 2].mean(),
        1e-6 * np.ptp(mesh.points[:, 2]),
    )
    slaves = np.unique(
        body.find_nodes(
            face_points(mesh.points[slave_quads], body.order).reshape(-1, 3), tie.slave_part
        )
    )
    corners = mesh.points[tie.master_quads]
    masters = body.find_nodes(
        face_points(corners, body.order).reshape(-1, 3), tie.master_part
    ).reshape(len(corners), -1)
    quad, xi, _, _ = project_to_quads(body.all_X[slaves], corners)
    weights = face_basis(xi, body.order)
    for slave, nodes, row in zip(slaves, masters[quad], weights):
        kept = np.abs(row) > 1e-12
        yield int(slave), (nodes[kept], row[kept] / row[kept].sum())


def base_body(case: ShortForm, specimen: SpecimenMesh, comm) -> Body:
    """Base plate, held at its bottom."""

    def held(body):
        bottom = body.all_X[:, 2].min()
        return {}, np.flatnonzero(body.all_X[:, 2] < bottom + 1e-9 * case.base.thickness_m)

    return Body(comm, specimen.base, case.base, 1, held)


def base_of(case: ShortForm, reference: np.ndarray) -> UnboundedBase | None:
    """The base below a foot at (n, 3) [m] where it has no edges; None for a plate.

    A pad's own part is rigid: its springs are the Pad.

    Raises
    ------
    InputError
        a layer too thick for its bricks.
    """
    if case.base.kind == "pad":
        return rigid_base(reference)
    if case.base.kind == "unbounded":
        try:
            return unbounded_base(case.mesh.fine_size_m, levels(case), case.base, reference)
        except ValueError as error:
            raise InputError(
                "mesh", "base.thickness_m", case.base.thickness_m, str(error)
            ) from None
    return None


def foot_of(case: ShortForm, specimen: SpecimenMesh, column: Body) -> Footprint:
    """Contact points of the foot, in an order that does not depend on the partition."""
    mesh = specimen.body
    part = mesh.foot_part
    faces = boundary_faces(mesh, part, 0.0, 1e-6 * case.column.height_m)
    found = column.find_nodes(face_points(mesh.points[faces], column.order).reshape(-1, 3), part)
    foot, position = np.unique(found, return_inverse=True)
    order = np.lexsort(np.round(column.all_X[foot, :2].T / foot_sides(case)[0], 9))
    foot, position = foot[order], np.argsort(order)[position]
    areas = nodal_areas(
        mesh.points[faces], position.reshape(len(faces), -1), len(foot), column.order
    )
    ends = mesh.points[outline_edges(faces)]
    outline = np.concatenate(
        [ends[:, 0] + t * (ends[:, 1] - ends[:, 0]) for t in np.arange(column.order) / column.order]
    )
    on_outline = np.isin(foot, column.find_nodes(outline, part))
    return footprint(foot, column.all_X[foot], areas, on_outline, case.contact.interior_points)


def build_system(case: ShortForm, comm, specimen: SpecimenMesh | None = None) -> System:
    """Bodies, contact and loads of a case."""
    specimen = specimen or share_specimen_mesh(case, comm)
    column = column_body(case, specimen, comm)
    foot = foot_of(case, specimen, column)
    base = base_of(case, column.all_X[foot.nodes]) or BasePlate(base_body(case, specimen, comm))
    law = interface_compliance(
        case.contact, case.material.youngs_modulus_pa, case.mesh.fine_size_m, foot.areas
    )
    pad = pad_of(case, foot.areas, column.total_mass)
    return one_column(
        column,
        kinematics_of(case.integration.kinematics),
        base,
        foot,
        case.contact.friction_coefficient,
        law,
        [0.0, 0.0, -GRAVITY],
        HHT(case.integration.dt_s, case.integration.alpha_hht),
        filtered=case.contact.impact == "plastic",
        rim=None if pad else Rim.find(column.all_X[foot.nodes]),
        damping=(case.integration.n_modes, case.material.damping_ratio),
        restitution=case.contact.restitution,
        rolling=case.contact.rolling_resistance,
        pad=pad,
    )
