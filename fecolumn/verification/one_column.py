"""The specimen of a case in the short form, or a body of bricks, as a system of one column."""

from __future__ import annotations

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.case.short_form import ShortForm
from fecolumn.contact.base_plate import BasePlate
from fecolumn.contact.footprint import Footprint, footprint
from fecolumn.contact.law import interface_compliance
from fecolumn.contact.pad import pad_of
from fecolumn.contact.rim import Rim
from fecolumn.contact.unbounded_base import UnboundedBase, rigid_base, unbounded_base
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.structure import kinematics_of, structure_system
from fecolumn.engines.dynamics.system import System
from fecolumn.fem.body import Body
from fecolumn.fem.free_body import rigid_fields
from fecolumn.fem.tied_body import column_body, known_to_all
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.base_plate import levels
from fecolumn.mesh.bricks import boundary_faces, outline_edges
from fecolumn.mesh.outline import foot_sides
from fecolumn.mesh.specimen import SpecimenMesh, specimen_mesh
from fecolumn.mesh.surface import face_points, nodal_areas
from fecolumn.structures.model import BodyModel
from fecolumn.verification.one_foot import foot_surface, on_base


def build_system(case: ShortForm, comm, specimen: SpecimenMesh | None = None) -> System:
    """Bodies, contact and loads of a case."""
    specimen = specimen or share_specimen_mesh(case, comm)
    column = column_body(case, specimen, comm)
    foot = footprint_of(case, specimen, column)
    base = ground_below(case, column.all_X[foot.nodes])
    pad = pad_of(case, foot.areas, column.total_mass)
    laws = dict(
        friction=case.contact.friction_coefficient,
        law=interface_compliance(
            case.contact, case.material.youngs_modulus_pa, case.mesh.fine_size_m, foot.areas
        ),
        rim=None if pad else Rim.find(column.all_X[foot.nodes]),
        restitution=case.contact.restitution,
        rolling=case.contact.rolling_resistance,
        pad=pad,
    )
    return one_column(
        column,
        kinematics_of(case.integration.kinematics),
        base or BasePlate(base_body(case, specimen, comm)),
        foot,
        HHT(case.integration.dt_s, case.integration.alpha_hht),
        [0.0, 0.0, -GRAVITY],
        filtered=case.contact.impact == "plastic",
        damping=(case.integration.n_modes, case.material.damping_ratio),
        **laws,
    )


def one_column(
    body,
    kinematics,
    base,
    foot: Footprint,
    hht: HHT,
    gravity,
    filtered: bool = True,
    damping: tuple[int, float] = (0, 0.0),
    **laws,
) -> System:
    """System of a single column, where it is drawn: a structure of one part.

    Parameters
    ----------
    body
        Body of the column.
    kinematics
        Corotated or TotalLagrangian.
    foot
        the column nodes that may touch; the system keeps it as `footprint`.
    damping
        number of elastic modes that are damped, the lowest, and ratio of each.
    laws
        of the foot as `one_foot.on_base` takes them; the system keeps them as `laws`.
    """
    arms, (count, ratio) = body.all_X[foot.nodes] - body.center, damping
    height = body.all_X[:, 2]
    top = body.all_X[height > height.max() - 1e-9 * np.ptp(height)].mean(axis=0)
    model = BodyModel(
        mass=float(body.total_mass),
        inertia=rigid_fields(body)[2][3:, 3:],
        center=body.center,
        frequencies=np.zeros(0),
        shapes=np.zeros((len(arms), 3, 0)),
        flexibility=np.zeros((0, 0, 3, 3)),
        arms=arms,
        dofs=3 * body.n_nodes,
        surfaces={"foot": foot_surface(arms, foot.areas)},
        marks={"top": (top - body.center, np.zeros((3, 0)))},
    )
    structure = on_base(model, base, damping_ratio=ratio, **laws)
    system = structure_system(
        structure, [body], hht, gravity, filtered, [foot.nodes], [count], kinematics
    )
    system.footprint, system.laws = foot, dict(laws)
    return system


def roll_on_corners(system: System) -> None:
    """Let the foot of a column roll from node to node."""
    system.laws["rim"], system.interface.interfaces["rim_count"] = None, 0


def share_specimen_mesh(case: ShortForm, comm) -> SpecimenMesh:
    """The specimen's mesh, made on rank 0 and known on every rank."""
    return known_to_all(comm, lambda: specimen_mesh(case))


def base_body(case: ShortForm, specimen: SpecimenMesh, comm) -> Body:
    """Base plate, held at its bottom."""

    def held(body):
        bottom = body.all_X[:, 2].min()
        return {}, np.flatnonzero(body.all_X[:, 2] < bottom + 1e-9 * case.base.thickness_m)

    return Body(comm, specimen.base, case.base, 1, held)


def ground_below(case: ShortForm, reference: np.ndarray) -> UnboundedBase | None:
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


def footprint_of(case: ShortForm, specimen: SpecimenMesh, column: Body) -> Footprint:
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
    return footprint(foot, column.all_X[foot], areas, on_outline, case.contact.points_inside(1))
