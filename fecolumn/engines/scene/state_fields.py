"""Displacement, stress and contact pressure of all pieces of a scene, from the states that a
reduced or rigid analysis keeps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.contact.projection import nodes_under
from fecolumn.contact.tolerances import SAME_PLACE
from fecolumn.engines.reduced.states import Snapshot
from fecolumn.engines.scene.scene import ElasticGround, JointFace, Scene

if TYPE_CHECKING:
    from scipy.sparse import csr_array

    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.fem.body import Body
    from fecolumn.structures.model import BodyModel, StructureModel

#: Of each copy: displacement (n_points, 3) [m] in its frame, what of it is deformation, and stress
#: [Pa] of its elements, none where they have none.
Deformed = list[tuple[NDArray[Any], NDArray[Any], NDArray[Any]]]


@dataclass(frozen=True, eq=False)
class Seat:
    """The contact points of a joint's slave.

    Attributes
    ----------
    nodes
        (k,) rows among the contact nodes of all bodies.
    areas
        (k,) [m2].
    plan
        (k, 2) [m] places in the plane of the face.
    shares
        (m, k) shares of these nodes in what each of the m points of the face shows: that of the
        nearest node, or the mean of all that are equally near; on the other side of a joint, whose
        nodes are on outlines alone, only of a node that is there.
    drawn
        (m,) [m2] of the drawn elements, tributary to these points; none on the other side of a
        joint.
    domed
        whether it is a dome, which touches at one point.
    """

    nodes: NDArray[Any]
    areas: NDArray[Any]
    plan: NDArray[Any]
    shares: csr_array
    drawn: NDArray[Any]
    domed: bool = False

    def shown(self, pressure: NDArray[Any]) -> NDArray[Any]:
        """Pressure (m,) [Pa] at the points of the face by that (k,) at the nodes. Its integral over
        the drawn elements is the force: those of a round face are a polygon, and few nodes stand
        for many points.
        """
        at_points: NDArray[Any] = self.shares @ pressure
        if self.domed:
            # what presses at one point has no pressure that could be shown
            return np.zeros_like(at_points)
        if self.drawn.any() and (integral := at_points @ self.drawn) > 0:
            at_points *= (pressure @ self.areas) / integral
        return at_points


def seats_of(structure: StructureModel, scene: Scene) -> list[Seat]:
    """The Seat of each joint of a structure that stands upright as the scene does."""
    first = np.cumsum([0] + [len(part.model.arms) for part in structure.parts])
    seats = []
    for joint, contact in zip(structure.joints, scene.contacts):
        part = structure.parts[joint.slave]
        surface = part.model.surfaces[joint.slave_surface]
        plan = contact.plan(part.center + part.model.arms[surface.nodes])
        # of the other side of a joint only places on outlines carry: they do not stand for others
        around, points = contact.pair < 0, contact.plan(scene.points[contact.points])
        shares = _shares_of_nearest(plan, points, around)
        drawn = _tributary(contact, scene) if around else np.zeros(len(points))
        nodes = first[joint.slave] + surface.nodes
        seats.append(Seat(nodes, surface.areas, plan, shares, drawn, contact.domed))
    return seats


def _tributary(contact: JointFace, scene: Scene) -> NDArray[Any]:
    """Weights (m,) [m2] by which the pressures at a contact's points add up to their integral over
    the drawn faces: flat on triangles, bilinear on quadrilaterals.
    """
    corners = contact.plan(scene.points[contact.faces])
    count = corners.shape[1]
    if count == 3:
        sides = corners[:, 1:] - corners[:, :1]
        whole = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / 2
        weights = np.repeat(whole[:, None] / 3, 3, axis=1)
    else:
        weights = np.zeros((len(corners), 4))
        signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        for place in signs / np.sqrt(3):  # Gauss' points
            own = (1 + signs * place) / 2
            slopes = signs / 2 * own[:, ::-1]
            ways = np.einsum("qa,fqb->fab", slopes, corners)
            weights += np.abs(np.linalg.det(ways))[:, None] * own.prod(axis=1)
    of_all = np.bincount(contact.faces.ravel(), weights.ravel(), len(scene.points))
    tributary: NDArray[Any] = of_all[contact.points]
    return tributary


def _shares_of_nearest(nodes: NDArray[Any], points: NDArray[Any], around: bool) -> csr_array:
    """Shares (m, k) of the nodes (k, 2) nearest to the points (m, 2): equal ones of those equally
    near, so that no order of the nodes tells which is shown. A point that is not at a node has
    none unless the nodes stand for what is `around` them.
    """
    from scipy.sparse import csr_array
    from scipy.spatial import cKDTree

    tree, at = cKDTree(nodes), SAME_PLACE * np.ptp(points, axis=0).max(initial=0.0)
    near = tree.query_ball_point(points, at + (tree.query(points)[0] if around else 0.0))
    counts = np.array([len(own) for own in near])
    return csr_array(
        (
            np.repeat(1 / np.maximum(counts, 1), counts),
            np.array([node for own in near for node in own], int),
            np.cumsum([0, *counts]),
        ),
        shape=(len(points), len(nodes)),
    )


def node_forces(
    seat: Seat, carriers: NDArray[Any], weights: NDArray[Any], push: NDArray[Any]
) -> NDArray[Any]:
    """Forces (k,) [N] that press the nodes of a Seat, by those `push` (m,) of the points of its
    joint on the nodes carriers (m, 4), at shares weights (m, 4): points between nodes, as those at
    corners of where two faces meet, push several.
    """
    at_nodes = np.zeros(max(carriers.max(initial=0), seat.nodes.max(initial=0)) + 1)
    np.add.at(at_nodes, carriers, weights * push[:, None])
    forces: NDArray[Any] = np.maximum(at_nodes[seat.nodes], 0.0)
    return forces


class StateFields:
    """Expands states to fields on the points of a scene, as `scene.fields.FieldWriter` takes them.

    A body of finite elements deforms by its modes and by the static response to its contact forces
    beyond what has gone into the modes already: with f the modal forces of the contact, sum phi (q
    - F f / w^2) + K^+ B^T r. The floors of a building move by its modes and the response in these;
    its slab, and a rigid body, only turn and shift.

    Parameters
    ----------
    movers
        (mover, numbers of the bodies that are its copies) of every different body.
    models
        of the bodies, with the modes that move.
    seats
        of each contact.
    grounds
        (SunkPlate, number of the ground) of each piece that belongs to one.
    """

    def __init__(
        self,
        scene: Scene,
        movers: list[tuple[Rigid | Continuum | SwayingFloors, list[int]]],
        models: list[BodyModel],
        seats: list[Seat],
        grounds: Sequence[tuple[ElasticGround, int]] = (),
    ) -> None:
        from mpi4py import MPI

        self.scene, self.comm, self.of_cells = scene, MPI.COMM_SELF, scene.of_cells
        self.meshes, self.models = scene.meshes, list(models)
        self._movers, self.seats, self._grounds = movers, seats, grounds
        #: First contact node of each body, one more at the end.
        self.first_node = np.cumsum([0] + [len(model.arms) for model in self.models])

    def local(
        self, state: Snapshot, stress: bool = True
    ) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Displacement (n_points, 3) [m] of all points of bodies in their frames; what of it is
        deformation, of a building relative to its slab; and von Mises stress (n_cells,) [Pa], nan
        of bodies that have none or where not asked for.

        Without stress bodies of finite elements are left undeformed.
        """
        scene, loads = self.scene, state.at_nodes(self.first_node[-1])
        moved, bent = np.zeros((2, *scene.points.shape))
        found = np.full(scene.first_cell[-1], np.nan)
        for mover, copies in self._movers:
            if mover.has_stress and not stress:
                continue
            own = [
                loads[self.first_node[k] : self.first_node[k + 1]] @ state.rotation[k]
                for k in copies
            ]
            for k, (displacement, deformation, values) in zip(
                copies, mover.deformed(state.modal[copies], np.array(own))
            ):
                moved[scene.own(k)], bent[scene.own(k)] = displacement, deformation
                found[scene.first_cell[k] : scene.first_cell[k] + len(values)] = values
        return moved, bent, found

    def positions(self, state: Snapshot, local: NDArray[Any]) -> NDArray[Any]:
        """Positions (n, 3) [m] of all points, those of bodies displaced by `local` (n, 3) [m] in
        their frames.
        """
        placed = self.scene.points.copy()
        for k, (piece, model) in enumerate(zip(self.scene.bodies, self.models)):
            own = self.scene.own(k)
            arms = piece.points - model.center + local[own]
            placed[own] = state.center[k] + arms @ state.rotation[k].T
        return placed

    def pressures(self, state: Snapshot) -> tuple[list[NDArray[Any]], NDArray[Any]]:
        """Pressure (k,) [Pa] at the nodes of each joint's face, and its centre (n_joints, 2) [m] in
        the plan of the face, nan of one that is open.
        """
        found, centres = [], np.full((len(self.seats), 2), np.nan)
        for number, (contact, seat) in enumerate(zip(self.scene.contacts, self.seats)):
            own = state.interface == number
            push = -state.force[own] @ (state.rotation[contact.piece] @ contact.axes[:, 2])
            force = node_forces(seat, state.carriers[own], state.weights[own], push)
            found.append(force / seat.areas)
            if force.sum() > 0:
                centres[number] = force @ seat.plan / force.sum()
        return found, centres

    def values(self, state: Snapshot) -> dict[str, NDArray[Any]]:
        """Displacement (n_points, 3) [m], von Mises stress (n_cells,) [Pa], 0 of bodies without
        any, and contact pressure (n_points,) [Pa] by their names in files.
        """
        scene = self.scene
        local, _, stress = self.local(state)
        displacement = self.positions(state, local) - scene.points
        for k, (plate, ground) in enumerate(self._grounds, len(scene.bodies)):
            on = [number for number, one in enumerate(scene.contacts) if one.stands_on(ground)]
            own = np.isin(state.interface, on)
            displacement[scene.own(k)], stress[scene.first_cell[k] : scene.first_cell[k + 1]] = (
                plate.sunk(state.position[own], state.force[own])
            )
        pressure = np.zeros(len(scene.points))
        for contact, seat, values in zip(scene.contacts, self.seats, self.pressures(state)[0]):
            pressure[contact.points] = seat.shown(values)
        return {
            "displacement": displacement,
            "von_mises": np.nan_to_num(stress),
            "pressure": pressure,
        }


class Rigid:
    """A body of so many points that only turns and shifts."""

    has_stress = False

    def __init__(self, points: int) -> None:
        self._points = points

    def deformed(self, modal: NDArray[Any], loads: NDArray[Any]) -> Deformed:
        """How copies deform under their loads.

        Parameters
        ----------
        modal
            (copies, m) coordinates less their static part.
        loads
            (copies, n_nodes, 3) [N] on its contact nodes in its frame.
        """
        still = np.zeros((self._points, 3))
        return [(still, still, np.empty(0))] * len(modal)


class Continuum:
    """A body of finite elements.

    Parameters
    ----------
    body
        `fem.body.Body`.
    model
        its model, with the modes that move.
    nodes
        (n,) of the body that are the model's rows.
    shapes
        (m, n_nodes, 3) of the modes all over it.

    Raises
    ------
    RuntimeError
        the model is of another mesh than the body.
    """

    has_stress = True

    def __init__(
        self, body: Body, model: BodyModel, nodes: NDArray[Any], shapes: NDArray[Any]
    ) -> None:
        from fecolumn.engines.scene.fields import StressField, vertex_nodes
        from fecolumn.fem.free_body import FreeBody

        self._body, self._nodes, self._shapes = body, nodes, shapes[: len(model.frequencies)]
        self._free, self._stress = FreeBody(body), StressField(body)
        self._vertices = vertex_nodes(body)
        if not (
            np.allclose(body.all_X[nodes], model.reference)
            and np.allclose(self._shapes[:, nodes].transpose(1, 2, 0), model.shapes)
        ):
            raise RuntimeError(
                "a reduced model is kept with another mesh than the one made now: empty the cache "
                "(fecolumn doctor tells where it is)"
            )

    def deformed(self, modal: NDArray[Any], loads: NDArray[Any]) -> Deformed:
        """As of `Rigid`."""
        spread = np.stack(
            [self._body.spread(self._nodes, load).reshape(-1) for load in loads], axis=1
        )
        response = self._free.response(spread).T.reshape(len(modal), -1, 3)
        moved = response + np.tensordot(modal[:, : len(self._shapes)], self._shapes, 1)
        found = []
        for one in moved:
            stress = self._stress.values(one)
            assert stress is not None  # of one process
            found.append((one[self._vertices], one[self._vertices], stress))
        return found


class SwayingFloors:
    """A building: its floors shift by its modes, and turn with its slab.

    Parameters
    ----------
    arms
        (n_points, 3) [m] of its points from the centre of mass, those of the floors last.
    """

    has_stress = False

    def __init__(self, arms: NDArray[Any], model: BodyModel, floors: int) -> None:
        self._model, self._points = model, arms
        marks = [model.marks[f"floor {number}"] for number in range(1, floors + 1)]
        self._arms, self._marks = (np.array(each) for each in zip(*marks))
        # the slab's motion is what its contact nodes say of it
        self._motion = np.linalg.pinv(
            np.concatenate([np.tile(np.eye(3), (len(model.arms), 1)), _turning(model.arms)], axis=1)
        )

    def deformed(self, modal: NDArray[Any], loads: NDArray[Any]) -> Deformed:
        """As of `Rigid`."""
        found, model = [], self._model
        for coordinates, load in zip(modal[:, : len(model.frequencies)], loads):
            whole = coordinates + np.einsum("iam,ia->m", model.shapes, load) / model.frequencies**2
            shift, turn = np.split(self._motion @ (model.shapes @ whole).ravel(), 2)
            carried = shift + np.cross(turn, self._points)
            drift = self._marks @ whole - (shift + np.cross(turn, self._arms))
            deformation = np.concatenate(
                [np.zeros((len(carried) - 8 * len(drift), 3)), np.repeat(drift, 8, axis=0)]
            )
            found.append((carried + deformation, deformation, np.empty(0)))
        return found


def _turning(arms: NDArray[Any]) -> NDArray[Any]:
    """Displacements (3 n, 3) of points with arms (n, 3) by small turns about x, y and z."""
    return np.stack([np.cross(axis, arms).ravel() for axis in np.eye(3)], axis=1)


class SunkPlate:
    """An elastic base plate (`contact.base_plate.BasePlate`)."""

    def __init__(self, plate: BasePlate) -> None:
        from fecolumn.engines.scene.fields import StressField, vertex_nodes

        self._plate, self._stress = plate, StressField(plate.body)
        self._vertices = vertex_nodes(plate.body)

    def sunk(
        self, positions: NDArray[Any], forces: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any]]:
        """Displacement (n_points, 3) [m] and stress (n_cells,) [Pa] under forces (k, 3) [N] on what
        stands at (k, 3) [m].
        """
        nodes = nodes_under(self._plate.grid, positions, forces[:, 2] > 0)
        displacement = self._plate.displacement(*nodes, -forces)
        stress = self._stress.values(displacement)
        assert stress is not None  # of one process
        return displacement[self._vertices], stress
