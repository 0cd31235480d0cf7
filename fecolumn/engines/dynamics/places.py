"""Where contact points of full-order bodies are, how fast they move, and what forces on them are on
the surface nodes of the bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.contact.bodies import Bodies, joined, node_matrix, one_body
from fecolumn.contact.joints import Joints
from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import MASTER, POSE, SLAVE, find_poses, frames_at, grounds_at
from fecolumn.contact.projection import place_on_masters
from fecolumn.fem.rotation import into_frames, out_of_frames, vector_product
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.summed import summed_at

if TYPE_CHECKING:
    from fecolumn.fem.composite import Composite, CompositeFoot, CompositeResponse


@dataclass(slots=True)
class Nodal:
    """Compliance of the surface nodes [m/N] in the frames of their bodies within a stage, as of
    `contact.bodies.Bodies`: `elastic` that of the factored matrix, `dynamic` with the static part.
    """

    elastic: Array
    dynamic: Array


class Places:
    """Contact points of bodies in the frames of the grounds and, on one another, of their
    interfaces.

    The points are surface nodes, but for those of a round rim, which may have turned along it.

    Parameters
    ----------
    composite
        Composite of the bodies.
    foot
        CompositeFoot: what the time integration shows of their surface nodes.
    joints
        points, interfaces, rims and facets.
    levels
        heights of the grounds [m].
    """

    def __init__(
        self,
        composite: Composite,
        foot: CompositeFoot,
        joints: Joints,
        levels: tuple[float] = (0.0,),
    ) -> None:
        self.composite, self.foot, self.joints = composite, foot, joints
        # (G,) of GROUND_STATE at start and end of the step
        self._started = self._grounds = grounds_at(levels)
        #: (P,) of POINT; interfaces (ni,) of INTERFACE.
        self.points, self.interfaces = joints.points.copy(), joints.interfaces.copy()
        #: Number of points; whether any stands on a body.
        self.size, self.moving = len(self.points), bool((self.points["master"] != GROUND).any())
        #: Reference positions (N, 3) of the surface nodes, each body as it is drawn [m].
        self.reference = np.concatenate(
            [part.all_X[own] for part, own in zip(composite.parts, foot.nodes)]
        )
        mobility: Any = (
            foot.mobility if foot.filtered else [np.zeros_like(one) for one in foot.static]
        )
        centers = np.repeat(
            [part.center for part in composite.parts], [len(own) for own in foot.nodes], axis=0
        )
        #: Arms (N, 3) of the surface nodes from the centres of mass [m].
        self.arms = self.reference - centers
        #: Rows of each body's surface nodes.
        self.rows = foot.rows
        parts = [
            one_body(self.arms[rows], node_matrix(one), node_matrix(own))
            for rows, one, own in zip(self.rows, foot.static, mobility)
        ]
        #: As `contact.bodies` has them: their rigid motion is part of the nodal mobility.
        self.bodies = Bodies(*joined(parts)[:4], joints.facets)
        #: Nodes and shares of the masters below the points at the start of the step.
        self._below, self._shares = self.points["below"].copy(), self.points["shares"].copy()
        #: Arms (N, 3) of the surface nodes from the centres of mass, in the frames of their bodies,
        #: where they were found last.
        self._arms_now = self.arms.copy()
        # Positions, and velocities, and the rotation that were filtered last, and what came of it
        self._filtered: tuple[Any, Any, Any] = (None, None, None)
        self._filtered_velocity: tuple[Any, Any, Any] = (None, None, None)
        # Positions and their centres of mass
        self._centers: tuple[Any, Any] = (None, None)

    def take_grounds(self, start: Array, end: Array) -> None:
        """Let the grounds be where they are at start and end of a step, each (G,) of
        GROUND_STATE.
        """
        self._started, self._grounds = start, end

    def at_points(self, values: Array) -> Array:
        """Values (P, ...) at the points from those at the nodes (N, ...) of their slaves."""
        return np.einsum("pq,pqa->pa", self.points["weights"], values[self.points["carriers"]])

    def at_nodes(self, forces: Array, rotation: Array, within: bool = False) -> Array:
        """Forces (N, 3) on the nodes, in the table frame, from those (P, 3) on the points: on
        slaves, and the opposite on moving masters.

        Parameters
        ----------
        rotation
            of the bodies, with which the frames of the interfaces turn.
        within
            whether the forces act throughout a step, in which the points may move over the masters:
            they act where a point was at the start and where it is, half at each; else they act
            where it is.
        """
        loaded = np.flatnonzero(forces.any(axis=1))
        pushes = forces[loaded]
        if self.moving:
            pushes = np.einsum(
                "pab,pb->pa", self._frames(rotation)[self.points["interface"][loaded]], pushes
            )
        rows = [self.points["carriers"][loaded]]
        shares = [self.points["weights"][loaded, :, None] * pushes[:, None]]
        if self.moving:
            under = self.points["master"][loaded] != GROUND
            on, pushes, ends = (
                loaded[under],
                pushes[under],
                [(self.points["below"], self.points["shares"])],
            )
            if within:
                ends.append((self._below, self._shares))
            for below, parts in ends:
                rows.append(below[on])
                shares.append(-parts[on, :, None] * pushes[:, None] / len(ends))
        return summed_at(np.concatenate(rows), np.concatenate(shares), len(self.reference))

    def _frames(self, rotation: Array) -> Array:
        """Axes (ni, 3, 3) of the interfaces in the table frame."""
        frames, masters = (
            np.tile(np.eye(3), (len(self.interfaces), 1, 1)),
            self.interfaces["master"],
        )
        frames[masters != GROUND] = (
            rotation[masters[masters != GROUND]] @ self.interfaces["axes"][masters != GROUND]
        )
        return frames

    def poses(self, x: Array, rotation: Array) -> Array:
        """(ni,) of POSE of bodies at positions x (n_owned, 3) turned by `rotation`."""
        return self.poses_at(self.centers(x), rotation, self._grounds)

    def poses_at(self, centers: Array, rotation: Array, grounds: Array) -> Array:
        """As `contact.pose.poses_of` of the interfaces, compiled."""
        poses = np.zeros(len(self.interfaces), POSE)
        find_poses(self.interfaces, grounds, frames_at(centers), rotation, poses, None)
        return poses

    def centers(self, x: Array) -> Array:
        """Centres of mass (nb, 3) [m] of bodies at positions x (n_owned, 3), of the same x found
        once: all ranks sum them up.
        """
        if self._centers[0] is not x:
            self._centers = x, self.composite.centers(x)
        return self._centers[1]

    def node_positions(self, x: Array, rotation: Array) -> Array:
        """Positions (N, 3) of the surface nodes from the bodies' positions x (n_owned, 3), without
        the static part.
        """
        return self._out_of_frames(self.reference + self._displacement(x, rotation), rotation)

    def _displacement(self, x: Array, rotation: Array) -> Array:
        """Filtered displacement (N, 3) of the surface nodes in the frames of their bodies, from
        where these are drawn; of the same x once, as the filter of a large body is the most of what
        a step reads.
        """
        if self._filtered[0] is not x or self._filtered[1] is not rotation:
            self._filtered = (
                x,
                rotation,
                self.foot.position(
                    into_frames(x, rotation, self.composite.rows) - self.composite.X
                ),
            )
        return self._filtered[2]

    def deformation(self, x: Array, rotation: Array, forces: Array) -> Array:
        """Displacement (N, 3) [m] of the surface nodes from their bodies' rigid motion, in the
        frames of these, as contact sees it: that of positions x (n_owned, 3), filtered, and what
        follows the contact forces (P, 3) [N] at once.
        """
        counts, pushes = self.bodies.body["count"], self.surface_forces(forces, rotation, False)
        centers = self._into_frames(np.repeat(self.centers(x), counts, axis=0), rotation)
        moved: Array = self.reference + self._displacement(x, rotation) - centers - self.arms
        for rows, count in zip(self.rows, counts):
            static = self.bodies.static[3 * rows.start : 3 * rows.stop, : 3 * count]
            moved[rows] += (static @ pushes[rows].ravel()).reshape(-1, 3)
        return moved

    def _into_frames(self, values: Array, rotation: Array) -> Array:
        return into_frames(values, rotation, self.rows)

    def _out_of_frames(self, values: Array, rotation: Array) -> Array:
        return out_of_frames(values, rotation, self.rows)

    def start_positions(self, x: Array, rotation: Array, poses: Array) -> Array:
        """`positions` at the start of a step, to which the nodes below the points are kept."""
        positions = self.positions(x, rotation, poses, True)
        self._below, self._shares = self.points["below"].copy(), self.points["shares"].copy()
        return positions

    def positions(self, x: Array, rotation: Array, poses: Array, starts: bool = False) -> Array:
        """Positions (P, 3) of the points, without the static part: in the frame of the ground on
        which they stand, or relative to the surface of the moving master in that of the interface.

        starts: at the start of a step, for all of which it decides what points are beyond an
        outline.
        """
        moved = self._displacement(x, rotation)
        centers = self._into_frames(
            np.repeat(self.centers(x), self.bodies.body["count"], axis=0), rotation
        )
        positions = self.at_points(self._out_of_frames(self.reference + moved, rotation))
        self._arms_now = self.reference + moved - centers
        on = np.flatnonzero(self.points["master"] == GROUND)
        positions[on] -= poses["origin"][self.points["interface"][on]]
        if self.moving:
            # of the centre of mass, which the frames of the interfaces follow
            drawn = centers - (self.reference - self.arms)
            place_on_masters(
                self.bodies, self.interfaces, self.points, poses, moved - drawn, starts, positions
            )
        positions[:, 2] += self.points["lift"]
        return positions

    def levers(self) -> Array:
        """Arms (P, 2, 3) [m] of the points from the centres of mass of slave and moving master, in
        their frames, where `positions` has found them last.
        """
        return np.stack([self.at_points(self._arms_now), self.points["seat"]], axis=1)

    def moments(self, forces: Array, rotation: Array, levers: Array) -> Array:
        """Moments (nb, 3) [N m] of forces (P, 3) at the points' `levers` about the centres of mass
        of bodies turned by `rotation`, in their frames.
        """
        loaded = np.flatnonzero(forces.any(axis=1))
        pushes = np.einsum(
            "pab,pb->pa", self._frames(rotation)[self.points["interface"][loaded]], forces[loaded]
        )
        rows, each = [], []
        for side, name, sign in ((SLAVE, "slave", 1.0), (MASTER, "master", -1.0)):
            of = np.flatnonzero(self.points[name][loaded] != GROUND)
            bodies = self.points[name][loaded][of]
            rows.append(bodies)
            each.append(
                sign
                * vector_product(
                    levers[loaded[of], side], np.einsum("pa,pab->pb", pushes[of], rotation[bodies])
                )
            )
        return summed_at(np.concatenate(rows), np.concatenate(each), len(rotation))

    def velocities(self, v: Array, rotation: Array, poses: Array, starts: bool = False) -> Array:
        """Velocities (P, 3) of the points from the bodies' velocities, relative to the master in
        the frame of the interface; starts: with the nodes that were below them at the start of the
        step.
        """
        if self._filtered_velocity[0] is not v or self._filtered_velocity[1] is not rotation:
            # those at the end of a step are those at the start of the next
            self._filtered_velocity = (
                v,
                rotation,
                self._out_of_frames(
                    self.foot.position(into_frames(v, rotation, self.composite.rows)), rotation
                ),
            )
        values = self._relative(
            self._filtered_velocity[2],
            poses,
            *(
                (self._below, self._shares)
                if starts
                else (self.points["below"], self.points["shares"])
            ),
        )
        on = np.flatnonzero(self.points["master"] == GROUND)
        values[on] -= (self._started if starts else self._grounds)["velocity"][
            self.points["ground"][on]
        ]
        return values

    def carried(self, forces: Array) -> float:
        """Work [J] that grounds which move do by forces (P, 3) on the points in the step."""
        ways = (self._grounds["place"] - self._started["place"])[self.points["ground"]]
        return float(np.vdot(forces, ways * (self.points["master"] == GROUND)[:, None]))

    def brought(self, impulses: Array) -> float:
        """Work [J] that grounds which move do by impulses (P, 3) at the end of the step."""
        speeds = self._grounds["velocity"][self.points["ground"]]
        return float(np.vdot(impulses, speeds * (self.points["master"] == GROUND)[:, None]))

    def _relative(self, nodes: Array, poses: Array, below: Array, shares: Array) -> Array:
        """Values (P, 3) at the points, relative to the nodes `below` in the frame of the interface,
        from those at the nodes (N, 3).
        """
        values = self.at_points(nodes)
        if self.moving:
            under = np.flatnonzero(self.points["master"] != GROUND)
            relative = values[under] - np.einsum("pq,pqa->pa", shares[under], nodes[below[under]])
            values[under] = np.einsum(
                "pba,pb->pa", poses["frame"][self.points["interface"][under]], relative
            )
        return values

    def load(self, forces: Array, rotation: Array) -> Array:
        """Nodal forces (n_owned, 3) of contact forces (P, 3) in a step on bodies turned by
        `rotation`.
        """
        return self.answer(self.surface_forces(forces, rotation), rotation)[0]

    def surface_forces(self, forces: Array, rotation: Array, within: bool = True) -> Array:
        """Forces (N, 3) [N] on the surface nodes, in the frames of their bodies turned by
        `rotation`, of contact forces (P, 3); within: as of `at_nodes`.
        """
        return self._into_frames(self.at_nodes(forces, rotation, within), rotation)

    def answer(self, surface_forces: Array, rotation: Array) -> tuple[Array, Array | None]:
        """Nodal forces (n_owned, 3) [N] of `surface_forces` and their acceleration (n_owned, 3)
        [m/s2], of which they are the mass times; None where the foot has no filter.
        """
        if self.foot.filtered:
            acceleration = out_of_frames(
                self.foot.acceleration(surface_forces), rotation, self.composite.rows
            )
            return self.composite.momentum(acceleration), acceleration
        return out_of_frames(self.foot.load(surface_forces), rotation, self.composite.rows), None

    def acceleration(self, forces: Array, rotation: Array, within: bool = True) -> Array:
        """Accelerations (n_owned, 3) of contact forces in a step; within False: velocity jumps of
        contact impulses (P, 3) at its end.
        """
        return out_of_frames(
            self.foot.acceleration(self.surface_forces(forces, rotation, within)),
            rotation,
            self.composite.rows,
        )

    def displacement(
        self,
        response: CompositeResponse,
        scale: float,
        surface_forces: Array,
        rotation: Array,
        frame: Array,
    ) -> Array:
        """Displacement (n_owned, 3) [m] of `scale` times `surface_forces` on bodies turned by
        `rotation`; response: CompositeResponse, found with the bodies turned by `frame`.
        """
        along = rotation @ frame.swapaxes(-1, -2)
        return out_of_frames(
            scale * response.displacement(self._out_of_frames(surface_forces, frame)),
            along,
            self.composite.rows,
        )

    def shifts(self, nodal: Nodal, surface_forces: Array, rotation: Array, poses: Array) -> Array:
        """By how much `positions` (P, 3) [m] change where the bodies, turned by `rotation`, answer
        `surface_forces` in a stage.
        """
        moved = np.concatenate(
            [
                (
                    nodal.elastic[3 * rows.start : 3 * rows.stop, : 3 * (rows.stop - rows.start)]
                    @ surface_forces[rows].ravel()
                ).reshape(-1, 3)
                for rows in self.rows
            ]
        )
        return self._relative(
            self._out_of_frames(moved, rotation), poses, self.points["below"], self.points["shares"]
        )

    def nodal(self, compliance: list[Array], scale: float, frame: Array) -> Nodal:
        """Compliance of a stage from those of its response, (n, n, 3, 3) of each body, found with
        the bodies turned by `frame`.
        """
        elastic = np.zeros_like(self.bodies.static)
        for one, R, rows in zip(compliance, frame, self.rows):
            elastic[3 * rows.start : 3 * rows.stop, : 3 * len(one)] = _turned(one, scale, R)
        return Nodal(elastic, elastic + self.bodies.static)


def _turned(compliance: Array, scale: float, frame: Array) -> Array:
    """Node blocks (n, n, 3, 3) found in a frame (3, 3), in the body's, as a matrix (3 n, 3 n)."""
    return node_matrix(scale * np.einsum("ab,ijac,cd->ijbd", frame, compliance, frame))
