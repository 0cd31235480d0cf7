"""Displacement, stress and contact pressure of all bodies of a structure, from the states that its
analysis kept.
"""

from __future__ import annotations

import numpy as np

from fecolumn.mesh.bricks import BrickMesh
from fecolumn.reduced.states import State
from fecolumn.render.structure_solid import StructureSolid
from fecolumn.structures.feet import ball_of
from fecolumn.structures.keys import Matrices, Storeys


class StructureFields:
    """Expands states to fields on the points that are drawn.

    A body of finite elements deforms by its modes and by the static response to its contact forces
    beyond what has gone into the modes already, as `reduced.fields.StateFields` has it. The floors
    of a building move by its modes and the response in these; its slab, and a rigid body, only turn
    and shift.

    Parameters
    ----------
    solid
        StructureSolid.
    fields
        by part, function that reads the modes' shapes (m, n_nodes, 3) all over it.
    """

    def __init__(self, solid: StructureSolid, fields):
        from mpi4py import MPI

        self.solid, self.comm, self._bodies = solid, MPI.COMM_SELF, {}
        for k, (piece, part) in enumerate(zip(solid.pieces, solid.structure.parts)):
            one = self._bodies.get(id(piece))
            if one is None:
                one = self._bodies[id(piece)] = _moving(piece, part.model, fields(k))
            one.parts.append(k)

    @property
    def has_stress(self) -> bool:
        """Whether any body deforms as a continuum."""
        return any(isinstance(one, _Continuum) for one in self._bodies.values())

    def local(self, state: State, stress: bool = True) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Displacement (n_points, 3) [m] of all points in the frames of their bodies; what of it is
        deformation, of a building relative to its slab; and von Mises stress (n_cells,) [Pa], nan
        of bodies that have none or where not asked for.

        Without stress bodies of finite elements are left undeformed.
        """
        solid, loads = self.solid, state.at_nodes(self.solid.first_node[-1])
        moved, bent, found = (
            np.zeros((solid.first[-1], 3)),
            np.zeros((solid.first[-1], 3)),
            np.full(solid.first_cell[-1], np.nan),
        )
        for one in self._bodies.values():
            if isinstance(one, _Continuum) and not stress:
                continue
            own = [
                loads[solid.first_node[k] : solid.first_node[k + 1]] @ state.rotation[k]
                for k in one.parts
            ]
            for k, (displacement, deformation, values) in zip(
                one.parts, one.deformed(state.modal[one.parts], np.array(own))
            ):
                (
                    moved[solid.first[k] : solid.first[k + 1]],
                    bent[solid.first[k] : solid.first[k + 1]],
                ) = displacement, deformation
                found[solid.first_cell[k] : solid.first_cell[k] + len(values)] = values
        return moved, bent, found

    def pressures(self, state: State) -> tuple[list[np.ndarray], np.ndarray]:
        """Pressure (k,) [Pa] at the nodes of each joint's face, and its centre (n_joints, 2) [m] in
        the plan of the face, nan of one that is open.
        """
        solid, found, centres = self.solid, [], np.full((len(self.solid.contacts), 2), np.nan)
        for number, contact in enumerate(solid.contacts):
            own = state.interface == number
            push = -state.force[own] @ (state.rotation[contact.part] @ contact.normal)
            at_nodes = np.zeros(solid.first_node[-1])
            np.add.at(at_nodes, state.carriers[own], state.weights[own] * push[:, None])
            force = np.maximum(at_nodes[contact.nodes], 0.0)
            found.append(force / contact.areas)
            if force.sum() > 0:
                centres[number] = force @ contact.plan / force.sum()
        return found, centres

    @property
    def meshes(self) -> list:
        """Mesh of each part as of `post.fields.FieldWriter`, with the floors of buildings and
        triangles of matrices.
        """
        solid = self.solid
        return [
            BrickMesh(solid.points[a:b], piece.elements, np.zeros(len(piece.elements), np.int8))
            for piece, a, b in zip(solid.pieces, solid.first, solid.first[1:])
        ]

    @property
    def of_cells(self) -> dict[str, np.ndarray]:
        """Number of each element's body, from 1."""
        return {
            "body": np.repeat(
                np.arange(1, len(self.solid.pieces) + 1),
                [len(piece.elements) for piece in self.solid.pieces],
            )
        }

    def values(self, state: State) -> dict[str, np.ndarray]:
        """Fields by the names of `post.fields.SpecimenFields.values`; bodies without stress have
        none.
        """
        local, _, stress = self.local(state)
        pressure = np.zeros(self.solid.first[-1])
        for contact, values in zip(self.solid.contacts, self.pressures(state)[0]):
            pressure[contact.points] = values[contact.nearest]
        return {
            "displacement": self.solid.positions(state.center, state.rotation, local)
            - self.solid.points,
            "von_mises": np.nan_to_num(stress),
            "pressure": pressure,
        }


def _moving(piece, model, fields):
    """How the points of a piece move in the frame of its body."""
    if isinstance(piece.drawing.body, Storeys):
        return _Building(piece, model)
    # the contact points of a foot that is not flat are no nodes of its mesh
    if (
        isinstance(piece.drawing.body, Matrices)
        or piece.drawing.is_rigid
        or ball_of(piece.drawing.body)
    ):
        return _Rigid(piece)
    return _Continuum(piece, model, fields)


class _Rigid:
    """A body that only turns and shifts. parts: of the copies."""

    def __init__(self, piece):
        self.parts, self._points = [], len(piece.points)

    def deformed(self, modal: np.ndarray, loads: np.ndarray):
        """Of each copy: displacement (n_points, 3) [m] in its frame, what of it is deformation, and
        stress [Pa] of its elements, none where they have none.

        Parameters
        ----------
        modal
            (copies, m) coordinates less their static part.
        loads
            (copies, n_nodes, 3) [N] on its contact nodes in its frame.
        """
        return [(np.zeros((self._points, 3)), np.zeros((self._points, 3)), np.empty(0))] * len(
            modal
        )


class _Continuum:
    """A body of finite elements."""

    def __init__(self, piece, model, fields):
        from fecolumn.fem.free_body import FreeBody
        from fecolumn.post.fields import StressField, vertex_nodes
        from fecolumn.structures.reduction import body_of

        self.parts, self._model = [], model
        self._body = body_of(piece.drawing.shape, piece.drawing.material)
        self._free, self._stress = FreeBody(self._body), StressField(self._body)
        self._nodes, self._vertices = (
            self._body.find_nodes(model.reference),
            vertex_nodes(self._body),
        )
        self._shapes = fields()[: len(model.frequencies)]
        if not np.allclose(self._shapes[:, self._nodes].transpose(1, 2, 0), model.shapes):
            raise RuntimeError(
                f"the reduced model of {piece.drawing.key} is kept with another mesh "
                "than the one made now: empty the cache (fecolumn doctor tells where "
                "it is)"
            )

    def deformed(self, modal, loads):
        """As of `_Rigid`."""
        spread = np.stack(
            [self._body.spread(self._nodes, load).reshape(-1) for load in loads], axis=1
        )
        response = self._free.response(spread).T.reshape(len(modal), -1, 3)
        moved = response + np.tensordot(modal[:, : len(self._shapes)], self._shapes, 1)
        return [
            (one[self._vertices], one[self._vertices], self._stress.values(one)) for one in moved
        ]


class _Building:
    """A building: its floors shift by its modes, and turn with its slab."""

    def __init__(self, piece, model):
        self.parts, self._model, self._points, count = (
            [],
            model,
            piece.points - model.center,
            piece.floors,
        )
        self._marks = np.array(
            [model.marks[f"floor {number}"][1] for number in range(1, count + 1)]
        )
        self._arms = np.array([model.marks[f"floor {number}"][0] for number in range(1, count + 1)])
        # the slab's motion is what its contact nodes say of it
        self._motion = np.linalg.pinv(
            np.concatenate([np.tile(np.eye(3), (len(model.arms), 1)), _turning(model.arms)], axis=1)
        )

    def deformed(self, modal, loads):
        """As of `_Rigid`."""
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


def _turning(arms: np.ndarray) -> np.ndarray:
    """Displacements (3 n, 3) of points with arms (n, 3) by small turns about x, y and z."""
    return np.stack([np.cross(axis, arms).ravel() for axis in np.eye(3)], axis=1)
