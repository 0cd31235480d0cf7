"""Contact of full-order bodies with the base and with one another: what `contact` is given of them,
and what it gives back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn._compiled import compile_for, compiled, interpreted
from fecolumn.contact.bodies import Bodies, joined, node_matrix, one_body
from fecolumn.contact.compliance import assemble
from fecolumn.contact.impact import find_impact
from fecolumn.contact.joints import Joints, left_faces
from fecolumn.contact.outline import mark_sunk, was_beyond
from fecolumn.contact.pad import begin_yielding, find_yielding, springs_of
from fecolumn.contact.points import BASE, CONTACT, OVER, SUNK, UNPREPARED
from fecolumn.contact.pose import MASTER, POSE, SLAVE, find_poses, frames_at, grounds_at
from fecolumn.contact.problem import (
    CONTACT_FAILED,
    FAR_BASE,
    ITERATIONS_SPENT,
    N_CONTACT,
    N_COUNTS,
    OFF_BASE,
    list_present,
    near_points,
    room,
    solve_linear,
    stored_energy,
)
from fecolumn.contact.projection import grounds_for_steps, place_on_masters, project
from fecolumn.contact.rolling import plan_roll, roll_points, stay
from fecolumn.contact.tolerances import CLOSE, ITERATIONS
from fecolumn.contact.two_sided import mark_unused, place_overlaps
from fecolumn.dynamics.cuts import StepFailed, Stop
from fecolumn.dynamics.stay import Stay
from fecolumn.fem.rotation import into_frames, out_of_frames

_STOPS = {CONTACT_FAILED: Stop.CONTACT, ITERATIONS_SPENT: Stop.CONTACT, OFF_BASE: Stop.OFF_BASE}


@dataclass(slots=True)
class Nodal:
    """Compliance of the surface nodes [m/N] in the frames of their bodies within a stage, as of
    `contact.bodies.Bodies`: `elastic` that of the factored matrix, `dynamic` with the static part.
    """

    elastic: np.ndarray
    dynamic: np.ndarray


class Interface:
    """Contact points of bodies on the top of the base, in the table frame, and on one another, in
    the frames of their interfaces.

    The points are surface nodes, but for those of a round rim, which may have turned along it.

    Parameters
    ----------
    composite
        Composite of the bodies.
    foot
        CompositeFoot: what the time integration shows of their surface nodes.
    bases
        each ground: BasePlate, or what answers as it does.
    joints
        points, interfaces, rims and facets.
    levels
        heights of the grounds [m].
    """

    def __init__(self, composite, foot, bases, joints: Joints, levels=(0.0,)):
        self.composite, self.foot, self.bases, self.joints = composite, foot, tuple(bases), joints
        # (G,) of GROUND at start and end of the step
        self._started = self._grounds = grounds_at(levels)
        #: (P,) of POINT; interfaces (ni,) of INTERFACE.
        self.points, self.interfaces = joints.points.copy(), joints.interfaces.copy()
        #: Number of points; whether any stands on a body.
        self.size, self.moving = len(self.points), bool((self.points["master"] != BASE).any())
        #: Reference positions (N, 3) of the surface nodes, each body as it is drawn [m].
        self.reference = np.concatenate(
            [part.all_X[own] for part, own in zip(composite.parts, foot.nodes)]
        )
        mobility = foot.mobility if foot.filtered else [np.zeros_like(one) for one in foot.static]
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
        self.surface, self.counts = grounds_for_steps(self.bases), np.zeros(N_COUNTS, np.int64)
        self._problem, self.overlaps = room(self.points), joints.overlaps
        #: Of bodies on one another; the problem of feet on the base is small.
        self.stay = Stay(self.interfaces, self.size if self.moving else 0)
        #: Nodes and shares of the masters below the points at the start of the step.
        self._below, self._shares = self.points["below"].copy(), self.points["shares"].copy()
        #: Arms (N, 3) of the surface nodes from the centres of mass, in the frames of their bodies,
        #: where they were found last.
        self._arms_now = self.arms.copy()
        # Length of the step, and what the points give alone in it
        self._springs = np.nan, None
        # Positions, and velocities, and the rotation that were filtered last, and what came of it
        self._filtered = self._filtered_velocity = None, None, None

    def prepare(self, say=lambda text: None) -> None:
        """Have compiled what the steps call, so that the first landing costs what all cost; `say`
        is told why it takes long, if it does.
        """
        if not (compiled(solve_linear) and compiled(find_impact)):
            say("compiling the contact of the full-order engine, once on this machine: a minute")
        before, values, mask = (
            np.zeros(self.size, CONTACT),
            np.zeros((self.size, 3)),
            np.zeros(self.size, bool),
        )
        static, springs, poses = self.bodies.static, self.springs(1.0), np.zeros(1, POSE)
        compile_for(
            solve_linear,
            (
                self._problem,
                self.bodies,
                self.surface,
                self.points,
                self.interfaces,
                springs,
                static,
                static,
                self.stay.stick,
                self.stay.rims,
                poses,
                values,
                ITERATIONS,
                before,
                before,
                self.counts,
            ),
        )
        compile_for(
            find_impact,
            (
                self.bodies,
                self.surface,
                self.points,
                self.interfaces,
                springs,
                self.near,
                values,
                poses,
                before,
                before,
                values,
                values,
                mask,
                mask,
                1.0,
                1.0,
                1.0,
                self.counts,
            ),
        )
        compile_for(
            find_poses,
            (self.interfaces, self._grounds, frames_at(np.zeros((1, 3))), np.eye(3)[None], poses),
        )
        if self.moving:
            compile_for(
                place_on_masters,
                (self.bodies, self.interfaces, self.points, poses, values, True, values),
            )

    @property
    def width(self) -> float:
        """Least width [m] of the feet with a round rim, of all where none has one."""
        rolls = self.interfaces["rim_count"] > 0
        return float(self.interfaces["width"][rolls if rolls.any() else slice(None)].min())

    def take_grounds(self, start: np.ndarray, end: np.ndarray) -> None:
        """Let the grounds be where they are at start and end of a step, (G,) of GROUND each."""
        self._started, self._grounds = start, end

    def springs(self, dt: float):
        """What the points give alone in a step dt [s]: of `contact.pad.springs_of`; within a step
        it knows which pads yield.
        """
        if self._springs[0] != dt:
            self._springs = dt, springs_of(self.points, self.interfaces, dt)
        return self._springs[1]

    def at_points(self, values: np.ndarray) -> np.ndarray:
        """Values (P, ...) at the points from those at the nodes (N, ...) of their slaves."""
        return np.einsum("pq,pqa->pa", self.points["weights"], values[self.points["carriers"]])

    def at_nodes(
        self, forces: np.ndarray, rotation: np.ndarray, within: bool = False
    ) -> np.ndarray:
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
        shared, loaded = np.zeros_like(self.reference), np.flatnonzero(forces.any(axis=1))
        pushes = forces[loaded]
        if self.moving:
            pushes = np.einsum(
                "pab,pb->pa", self._frames(rotation)[self.points["interface"][loaded]], pushes
            )
        np.add.at(
            shared,
            self.points["carriers"][loaded],
            self.points["weights"][loaded, :, None] * pushes[:, None],
        )
        if self.moving:
            under = self.points["master"][loaded] != BASE
            rows, pushes, ends = (
                loaded[under],
                pushes[under],
                [(self.points["below"], self.points["shares"])],
            )
            if within:
                ends.append((self._below, self._shares))
            for below, shares in ends:
                np.add.at(shared, below[rows], -shares[rows, :, None] * pushes[:, None] / len(ends))
        return shared

    def _frames(self, rotation: np.ndarray) -> np.ndarray:
        """Axes (ni, 3, 3) of the interfaces in the table frame."""
        frames, masters = (
            np.tile(np.eye(3), (len(self.interfaces), 1, 1)),
            self.interfaces["master"],
        )
        frames[masters != BASE] = (
            rotation[masters[masters != BASE]] @ self.interfaces["axes"][masters != BASE]
        )
        return frames

    def poses(self, x: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """(ni,) of POSE of bodies at positions x (n_owned, 3) turned by `rotation`."""
        poses = np.zeros(len(self.interfaces), POSE)
        find_poses(
            self.interfaces, self._grounds, frames_at(self.composite.centers(x)), rotation, poses
        )
        return poses

    def node_positions(self, x: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Positions (N, 3) of the surface nodes from the bodies' positions x (n_owned, 3), without
        the static part.
        """
        return self._out_of_frames(self.reference + self._displacement(x, rotation), rotation)

    def _displacement(self, x, rotation) -> np.ndarray:
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

    def _into_frames(self, values, rotation):
        return into_frames(values, rotation, self.rows)

    def _out_of_frames(self, values, rotation):
        return out_of_frames(values, rotation, self.rows)

    def start_positions(self, x: np.ndarray, rotation: np.ndarray, poses: np.ndarray) -> np.ndarray:
        """`positions` at the start of a step, to which the nodes below the points are kept."""
        positions = self.positions(x, rotation, poses, True)
        self._below, self._shares = self.points["below"].copy(), self.points["shares"].copy()
        return positions

    def positions(
        self, x: np.ndarray, rotation: np.ndarray, poses: np.ndarray, starts: bool = False
    ) -> np.ndarray:
        """Positions (P, 3) of the points, without the static part: in the frame of the ground on
        which they stand, or relative to the surface of the moving master in that of the interface.

        starts: at the start of a step, for all of which it decides what points are beyond an
        outline.
        """
        moved = self._displacement(x, rotation)
        centers = self._into_frames(
            np.repeat(self.composite.centers(x), self.bodies.body["count"], axis=0), rotation
        )
        positions, self._arms_now = (
            self.at_points(self._out_of_frames(self.reference + moved, rotation)),
            self.reference + moved - centers,
        )
        on = np.flatnonzero(self.points["master"] == BASE)
        positions[on] -= poses["origin"][self.points["interface"][on]]
        if self.moving:
            # of the centre of mass, which the frames of the interfaces follow
            drawn = centers - (self.reference - self.arms)
            place_on_masters(
                self.bodies, self.interfaces, self.points, poses, moved - drawn, starts, positions
            )
        positions[:, 2] += self.points["lift"]
        return positions

    def levers(self) -> np.ndarray:
        """Arms (P, 2, 3) [m] of the points from the centres of mass of slave and moving master, in
        their frames, where `positions` has found them last.
        """
        return np.stack([self.at_points(self._arms_now), self.points["seat"]], axis=1)

    def moments(self, forces: np.ndarray, rotation: np.ndarray, levers: np.ndarray) -> np.ndarray:
        """Moments (nb, 3) [N m] of forces (P, 3) at the points' `levers` about the centres of mass
        of bodies turned by `rotation`, in their frames.
        """
        loaded = np.flatnonzero(forces.any(axis=1))
        moments, pushes = (
            np.zeros((len(rotation), 3)),
            np.einsum(
                "pab,pb->pa",
                self._frames(rotation)[self.points["interface"][loaded]],
                forces[loaded],
            ),
        )
        for side, name, sign in ((SLAVE, "slave", 1.0), (MASTER, "master", -1.0)):
            of = np.flatnonzero(self.points[name][loaded] != BASE)
            bodies = self.points[name][loaded][of]
            np.add.at(
                moments,
                bodies,
                sign
                * np.cross(
                    levers[loaded[of], side], np.einsum("pa,pab->pb", pushes[of], rotation[bodies])
                ),
            )
        return moments

    def velocities(
        self, v: np.ndarray, rotation: np.ndarray, poses: np.ndarray, starts: bool = False
    ) -> np.ndarray:
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
        on = np.flatnonzero(self.points["master"] == BASE)
        values[on] -= (self._started if starts else self._grounds)["velocity"][
            self.points["ground"][on]
        ]
        return values

    def carried(self, forces: np.ndarray) -> float:
        """Work [J] that grounds which move do by forces (P, 3) on the points in the step."""
        ways = (self._grounds["place"] - self._started["place"])[self.points["ground"]]
        return float(np.vdot(forces, ways * (self.points["master"] == BASE)[:, None]))

    def brought(self, impulses: np.ndarray) -> float:
        """Work [J] that grounds which move do by impulses (P, 3) at the end of the step."""
        speeds = self._grounds["velocity"][self.points["ground"]]
        return float(np.vdot(impulses, speeds * (self.points["master"] == BASE)[:, None]))

    def _relative(self, nodes, poses, below, shares) -> np.ndarray:
        """Values (P, 3) at the points, relative to the nodes `below` in the frame of the interface,
        from those at the nodes (N, 3).
        """
        values = self.at_points(nodes)
        if self.moving:
            under = np.flatnonzero(self.points["master"] != BASE)
            relative = values[under] - np.einsum("pq,pqa->pa", shares[under], nodes[below[under]])
            values[under] = np.einsum(
                "pba,pb->pa", poses["frame"][self.points["interface"][under]], relative
            )
        return values

    def load(self, forces: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Nodal forces (n_owned, 3) of contact forces (P, 3) in a step on bodies turned by
        `rotation`.
        """
        return self.answer(self.surface_forces(forces, rotation), rotation)[0]

    def surface_forces(
        self, forces: np.ndarray, rotation: np.ndarray, within: bool = True
    ) -> np.ndarray:
        """Forces (N, 3) [N] on the surface nodes, in the frames of their bodies turned by
        `rotation`, of contact forces (P, 3); within: as of `at_nodes`.
        """
        return self._into_frames(self.at_nodes(forces, rotation, within), rotation)

    def answer(
        self, surface_forces: np.ndarray, rotation: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray | None]:
        """Nodal forces (n_owned, 3) [N] of `surface_forces` and their acceleration (n_owned, 3)
        [m/s2], of which they are the mass times; None where the foot has no filter.
        """
        if self.foot.filtered:
            acceleration = out_of_frames(
                self.foot.acceleration(surface_forces), rotation, self.composite.rows
            )
            return self.composite.momentum(acceleration), acceleration
        return out_of_frames(self.foot.load(surface_forces), rotation, self.composite.rows), None

    def acceleration(
        self, forces: np.ndarray, rotation: np.ndarray, within: bool = True
    ) -> np.ndarray:
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
        response,
        scale: float,
        surface_forces: np.ndarray,
        rotation: np.ndarray,
        frame: np.ndarray,
    ) -> np.ndarray:
        """Displacement (n_owned, 3) [m] of `scale` times `surface_forces` on bodies turned by
        `rotation`; response: CompositeResponse, found with the bodies turned by `frame`.
        """
        along = rotation @ frame.swapaxes(-1, -2)
        return out_of_frames(
            scale * response.displacement(self._out_of_frames(surface_forces, frame)),
            along,
            self.composite.rows,
        )

    def shifts(
        self, nodal: Nodal, surface_forces: np.ndarray, rotation: np.ndarray, poses: np.ndarray
    ) -> np.ndarray:
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

    def nodal(self, compliance, scale: float, frame: np.ndarray) -> Nodal:
        """Compliance of a stage from those of its response, (n, n, 3, 3) of each body, found with
        the bodies turned by `frame`.
        """
        elastic = np.zeros_like(self.bodies.static)
        for one, R, rows in zip(compliance, frame, self.rows):
            elastic[3 * rows.start : 3 * rows.stop, : 3 * len(one)] = _turned(one, scale, R)
        return Nodal(elastic, elastic + self.bodies.static)

    def begin_step(
        self, state, halfway: np.ndarray, rolls: bool
    ) -> tuple[np.ndarray, np.ndarray, bool]:
        """Place the points of a step: what the State brings to them (P,) of CONTACT, its rims (ni,)
        of RIM, whether any rolled.

        Parameters
        ----------
        halfway
            (nb, 3, 3) rotations in the middle of the step.
        rolls
            False: the points stay in any case.
        """
        before, rims, rolled = state.contact.copy(), state.rims.copy(), False
        self.take_grounds(state.grounds, state.grounds)
        if self._springs[1] is not None:
            begin_yielding(self.points, self._springs[1])
        now, then = self.poses(state.x, state.rotation), self.poses(state.x, halfway)
        self._mark_unused(state.x, now, rims)
        for interface, rim, pose, turned in zip(self.interfaces, rims, now, then):
            if interface["rim_count"] and not rim["unused"]:
                rolled |= self._roll(
                    interface, rim, pose, turned["turned"][SLAVE], state, before, rolls
                )
        self._lay_points(state, now, before, rims)
        if self.moving:
            self.stay.note(now, rims)
        self.points["beyond"] = OVER
        positions = self.start_positions(state.x, state.rotation, now)
        taking = ~self.points["idle"]
        if (self.points["beyond"][taking] == UNPREPARED).any():
            raise StepFailed(
                Stop.OFF_PATCH,
                f"{Stop.OFF_PATCH.value}: {left_faces(self.joints.names, self.points)}",
            )
        self._find_sunk(before, positions, now, state.rims, rims)
        before["beyond"] = self.points["beyond"] != OVER
        # one that was found by nothing but its place, or beyond an outline
        elsewhere = ~before["located"] | (self.points["master"] != BASE) & (
            before["relative"][:, 2] > CLOSE * self.interfaces["width"][self.points["interface"]]
        )
        before["relative"][elsewhere] = positions[elsewhere]
        before["anchor"][elsewhere], before["located"] = before["relative"][elsewhere, :2], taking
        return before, rims, rolled

    def lay(self, state) -> tuple[np.ndarray, np.ndarray]:
        """What a State brings to its points, (P,) of CONTACT, and its rims, once the points of
        joints with two sides are laid; once they are, they stay.
        """
        before, rims = state.contact.copy(), state.rims.copy()
        self.take_grounds(state.grounds, state.grounds)
        if not rims["placed"][self.overlaps.joints["forward"]].all():
            poses = self.poses(state.x, state.rotation)
            self._mark_unused(state.x, poses, rims)
            self._lay_points(state, poses, before, rims)
        return before, rims

    def _mark_unused(self, x, poses, rims) -> None:
        if len(self.overlaps.joints):
            mark_unused(
                self.overlaps, self.interfaces, frames_at(self.composite.centers(x)), poses, rims
            )

    def _lay_points(self, state, poses, before, rims) -> None:
        """Lay the points of joints with two sides."""
        if len(self.overlaps.joints) and place_overlaps(
            self.overlaps,
            self.interfaces,
            self.joints.rim,
            self.arms,
            frames_at(self.composite.centers(state.x)),
            poses,
            state.contact,
            rims,
            self.points,
            before,
        ):
            self.list_present()
            # the operator is that of other points
            self.stay.stick.key[1] = 0.0

    def list_present(self) -> None:
        """List the points that take part, after these have changed."""
        interpreted(list_present)(self._problem, self.points)

    def _find_sunk(self, before, positions, poses, rims_before, rims) -> None:
        """As `reduced.equilibrium.find_sunk`; sunk points are put high above the surface."""
        k = self.points["interface"]
        below = np.flatnonzero(
            before["beyond"] & (self.points["beyond"] == OVER) & (positions[:, 2] < 0)
        )
        back = [
            i for i in below if interpreted(was_beyond)(before[i], rims_before[k[i]], rims[k[i]])
        ]
        if not back:
            return
        loaded = np.flatnonzero(before["force"][:, 2] > 0)
        interpreted(mark_sunk)(
            self.bodies,
            self.surface,
            self.points,
            self.interfaces,
            poses,
            before,
            np.concatenate([loaded, back]),
            len(loaded),
            positions,
            np.zeros((self.size, 3)),
        )
        sunk = self.points["beyond"] == SUNK
        positions[sunk, 2] = self.interfaces["width"][k[sunk]]

    def _roll(self, interface, rim, pose, halfway, state, before, rolls) -> bool:
        """Place the points of a rim; whether they rolled."""
        points = self.joints.rim[
            interface["rim_first"] : interface["rim_first"] + interface["rim_count"]
        ]
        rolled, tilt, roll = plan_roll(
            interface, points, rim, state.contact, pose["turned"][SLAVE], halfway, rolls
        )
        if not rolled:
            stay(roll, points, rim, tilt, self.arms, self.points)
            return False
        places = (self.node_positions(state.x, state.rotation) - pose["origin"]) @ pose["frame"]
        roll_points(roll, points, rim, self.arms, places, state.contact, self.points, before)
        return True

    def ways_down(self, poses: np.ndarray) -> np.ndarray:
        """Ways down (k, 2) to the master's surface along the slave's axes x and y, of those with a
        round rim.
        """
        return -poses["turned"][self.interfaces["rim_count"] > 0, SLAVE, 2, :2]

    def static_compliance(self, listed: np.ndarray) -> np.ndarray:
        """Compliance (3 k, 3 k) [m/N] of some points on the base that follows their forces at once,
        where the bodies are drawn.
        """
        everyone, own, W = (
            np.arange(self.size),
            np.zeros((self.size, 3)),
            np.empty((3 * len(listed), 3 * len(listed))),
        )
        places = self.reference[self.points["node"]]
        self._extend_base(places, everyone)
        interpreted(project)(self.surface, places, everyone, self.points)
        interpreted(assemble)(
            self.bodies,
            self.surface,
            self.points,
            self.points["arm"],
            listed,
            self.poses(self.composite.placed, self.composite.unturned),
            0.0,
            self.bodies.static,
            1.0,
            own,
            W,
        )
        return W

    def solve(
        self, nodal: Nodal, poses, positions, dt: float, before, after, times: int = ITERATIONS
    ) -> tuple[Stop, float]:
        """Find forces in `after` that obey the laws at points that move from `positions` (P, 3)
        along with them: why it ended, violation over what is allowed.

        times: 0 only looks how well they do, in or near the places where they were found last.
        """
        springs = self.springs(dt)
        if times:
            self.stay.begin(self._problem, nodal)
        while True:
            answer, residual = solve_linear(
                self._problem,
                self.bodies,
                self.surface,
                self.points,
                self.interfaces,
                springs,
                nodal.dynamic,
                nodal.elastic,
                self.stay.stick,
                self.stay.rims,
                poses,
                positions,
                times,
                before,
                after,
                self.counts,
            )
            self.stay.end(self._problem, nodal)
            if answer == FAR_BASE:
                self._extend_base(positions, self.near)
            elif answer in _STOPS or not (
                times and find_yielding(self.points, springs, self.near, after)
            ):
                return _STOPS.get(answer, Stop.CONVERGED), residual
            else:
                # the operator of feet that stick is that of pads that do not yield
                self._problem.flags[:] = False

    def _extend_base(self, positions, listed) -> None:
        """Make the grounds' compliance known under the listed points (k,) at positions (n, 3) and
        one row of nodes around.
        """
        on = listed[self.points["master"][listed] == BASE]
        for number, base in enumerate(self.bases):
            own = on[self.points["ground"][on] == number]
            if len(own):
                base.need(base.grid.around(positions[own], 1))
        self.surface = grounds_for_steps(self.bases)

    def stored(self, dt: float, before, after) -> float:
        """Strain energy [J] of base, foot's static rest, contact law and pad, whose indentation is
        found, after `solve`.
        """
        return stored_energy(
            self._problem,
            self.points,
            self.interfaces,
            self.springs(dt),
            before,
            after,
        )

    @property
    def near(self) -> np.ndarray:
        """Points (k,) that may carry at the end of the stage."""
        return near_points(self._problem)

    def spent(self) -> int:
        """Iterations of contact problems since the last call."""
        count, self.counts[N_CONTACT] = int(self.counts[N_CONTACT]), 0
        return count


def _turned(compliance, scale, frame) -> np.ndarray:
    """Node blocks (n, n, 3, 3) found in a frame (3, 3), in the body's, as a matrix (3 n, 3 n)."""
    return node_matrix(scale * np.einsum("ab,ijac,cd->ijbd", frame, compliance, frame))
