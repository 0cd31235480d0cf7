"""Contact of full-order bodies with the base and with one another: what `contact` is given of them,
and what it gives back.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.contact.compliance import assemble
from fecolumn.contact.forces import solve_linear, stored_energy
from fecolumn.contact.impact import Collision, TouchingBodies, find_impact
from fecolumn.contact.joints import Joints, left_faces
from fecolumn.contact.outline import lower_raised, raise_or_leave, was_beyond
from fecolumn.contact.pad import begin_yielding, find_yielding, springs_of
from fecolumn.contact.points import CONTACT, GROUND, OVER, SUNK, UNPREPARED
from fecolumn.contact.pose import POSE, SLAVE, find_poses, frames_at
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
)
from fecolumn.contact.projection import grounds_for_steps, place_on_masters, project
from fecolumn.contact.rolling import plan_roll, roll_points, stay
from fecolumn.contact.tolerances import CLOSE, ITERATIONS
from fecolumn.contact.two_sided import mark_unused, place_overlaps
from fecolumn.engines.dynamics.cuts import StepFailed, Stop
from fecolumn.engines.dynamics.places import Nodal, Places
from fecolumn.engines.dynamics.stay import StickOperatorCache
from fecolumn.foundation._compiled import compile_for, compiled, interpreted
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.contact.pad import Springs
    from fecolumn.contact.unbounded_base import UnboundedBase
    from fecolumn.fem.composite import Composite, CompositeFoot
    from fecolumn.structures.kept_plate import KeptPlate

_STOPS = {CONTACT_FAILED: Stop.CONTACT, ITERATIONS_SPENT: Stop.CONTACT, OFF_BASE: Stop.OFF_BASE}


class ContactInterface(Places):
    """Contact of bodies with the grounds and with one another, step by step.

    Parameters
    ----------
    bases
        each ground: BasePlate, or what answers as it does; the others as of Places.
    """

    def __init__(
        self,
        composite: Composite,
        foot: CompositeFoot,
        bases: tuple[BasePlate | KeptPlate | UnboundedBase, ...],
        joints: Joints,
        levels: tuple[float] = (0.0,),
    ) -> None:
        super().__init__(composite, foot, joints, levels)
        self.bases = tuple(bases)
        self.surface, self.counts = grounds_for_steps(self.bases), np.zeros(N_COUNTS, np.int64)
        self._problem, self.overlaps = room(self.points), joints.overlaps
        #: Of bodies on one another; the problem of feet on the base is small.
        self.stay = StickOperatorCache(self.interfaces, self.size if self.moving else 0)
        # Length of the step, and what the points give alone in it
        self._springs: tuple[float, Any] = (np.nan, None)

    def prepare(self, say: Callable[..., Any] = lambda text: None) -> None:
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
                TouchingBodies(self.bodies, self.surface, self.points, self.interfaces, springs),
                Collision(
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
                ),
                1.0,
                self.counts,
            ),
        )
        compile_for(
            find_poses,
            (
                self.interfaces,
                self._grounds,
                frames_at(np.zeros((1, 3))),
                np.eye(3)[None],
                poses,
                None,
            ),
        )
        if self.moving:
            compile_for(
                place_on_masters,
                (self.bodies, self.interfaces, self.points, poses, values, True, values),
            )

    def springs(self, dt: float) -> Springs:
        """What the points give alone in a step dt [s]: of `contact.pad.springs_of`; within a step
        it knows which pads yield.
        """
        if self._springs[0] != dt:
            self._springs = dt, springs_of(self.points, self.interfaces, dt)
        return self._springs[1]

    def begin_step(self, state: Any, halfway: Array, rolls: bool) -> tuple[Array, Array, bool]:
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
        # of rims and raised points it is found anew
        self.points["lift"] = 0.0
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
            left = left_faces(self.joints.names, self.points)
            raise StepFailed(Stop.OFF_PATCH, f"{Stop.OFF_PATCH.value}: {', '.join(left)}", left)
        self._find_sunk(before, positions, now, state.rims, rims)
        before["beyond"] = self.points["beyond"] != OVER
        # one that was found by nothing but its place, or beyond an outline
        elsewhere = ~before["located"] | (self.points["master"] != GROUND) & (
            before["relative"][:, 2] > CLOSE * self.interfaces["width"][self.points["interface"]]
        )
        before["relative"][elsewhere] = positions[elsewhere]
        before["anchor"][elsewhere], before["located"] = before["relative"][elsewhere, :2], taking
        return before, rims, rolled

    def lay(self, state: Any) -> tuple[Array, Array]:
        """What a State brings to its points, (P,) of CONTACT, and its rims, once the points of
        joints with two sides are laid; once they are, they stay.
        """
        before, rims = state.contact.copy(), state.rims.copy()
        self.take_grounds(state.grounds, state.grounds)
        if not rims["placed"][self.overlaps.joints["forward"]].all():
            poses = self.poses(state.x, state.rotation)
            self._mark_unused(state.x, poses, rims)
            self._lay_points(state, poses, before, rims)
            # half of a force acts on what was below its point at the start
            self.points["beyond"] = OVER
            positions = self.start_positions(state.x, state.rotation, poses)
            # a corner where two edges cross sticks where it is laid
            far = ~before["located"]
            before["relative"][far], before["anchor"][far] = positions[far], positions[far, :2]
        return before, rims

    def _mark_unused(self, x: Array, poses: Array, rims: Array) -> None:
        if len(self.overlaps.joints):
            mark_unused(self.overlaps, self.interfaces, frames_at(self.centers(x)), poses, rims)

    def _lay_points(self, state: Any, poses: Array, before: Array, rims: Array) -> None:
        """Lay the points of joints with two sides."""
        if len(self.overlaps.joints) and place_overlaps(
            self.overlaps,
            self.interfaces,
            self.joints.rim,
            self.arms,
            # a face may be as near as it likes: bodies of elements take longer than their points
            np.full((len(self.arms), 2), np.inf),
            frames_at(self.centers(state.x)),
            poses,
            state.contact,
            rims,
            self.points,
            before,
        ):
            self.list_present()
            # the operator is that of other points
            self.stay.stick.key[1] = 0.0

    def return_points(self) -> None:
        """Have the points where the bodies are drawn: one that steps carried along a rim, too."""
        for name in ("node", "count", "carriers", "weights", "arm", "lift", "rolls"):
            self.points[name] = self.joints.points[name]
        self.list_present()
        self.stay.stick.key[1] = 0.0

    def list_present(self) -> None:
        """List the points that take part, after these have changed."""
        interpreted(list_present)(self._problem, self.points)

    def _find_sunk(
        self, before: Array, positions: Array, poses: Array, rims_before: Array, rims: Array
    ) -> None:
        """As `reduced.equilibrium.find_sunk`; sunk points are put high above the surface."""
        k, comes = self.points["interface"], before["beyond"]
        for i in np.flatnonzero((before["raised"] > 0) & ~self.points["idle"] & ~comes):
            height, width = positions[i, 2], self.interfaces["width"][k[i]]
            interpreted(lower_raised)(self.points[i], before[i], height, width)
            positions[i, 2] += before["raised"][i]
        before["raised"][comes] = 0.0
        below = np.flatnonzero(comes & (self.points["beyond"] == OVER) & (positions[:, 2] < 0))
        back = [
            i for i in below if interpreted(was_beyond)(before[i], rims_before[k[i]], rims[k[i]])
        ]
        if not back:
            return
        loaded = np.flatnonzero(before["force"][:, 2] > 0)
        interpreted(raise_or_leave)(
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
        positions[back, 2] += self.points["lift"][back]
        sunk = self.points["beyond"] == SUNK
        positions[sunk, 2] = self.interfaces["width"][k[sunk]]

    def _roll(
        self,
        interface: Record,
        rim: Record,
        pose: Record,
        halfway: Array,
        state: Any,
        before: Array,
        rolls: bool,
    ) -> bool:
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

    def lowest_directions(self, poses: Array) -> Array:
        """Ways down (k, 2) to the master's surface along the slave's axes x and y, of those with a
        round rim.
        """
        return -poses["turned"][self.interfaces["rim_count"] > 0, SLAVE, 2, :2]

    def static_compliance(self, listed: Array) -> Array:
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
        self,
        nodal: Nodal,
        poses: Array,
        positions: Array,
        dt: float,
        before: Array,
        after: Array,
        times: int = ITERATIONS,
    ) -> tuple[Stop, float]:
        """Find forces in `after` that obey the laws at points that move from `positions` (P, 3)
        along with them: why it ended, violation over what is allowed.

        times: 0 only looks how well they do, in or near the places where they were found last.
        """
        springs = self.springs(dt)
        if times:
            self.stay.begin(self._problem, nodal)
        yielded = 0
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
            elif (yielded := yielded + 1) > ITERATIONS:
                return Stop.CONTACT, np.inf
            else:
                # the operator of feet that stick is that of pads that do not yield
                self._problem.flags[:] = False

    def _extend_base(self, positions: Array, listed: Array) -> None:
        """Make the grounds' compliance known under the listed points (k,) at positions (n, 3) and
        one row of nodes around.
        """
        on = listed[self.points["master"][listed] == GROUND]
        for number, base in enumerate(self.bases):
            own = on[self.points["ground"][on] == number]
            if len(own):
                base.need(base.grid.around(positions[own], 1))
        self.surface = grounds_for_steps(self.bases)

    def stored(self, dt: float, before: Array, after: Array) -> float:
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
    def near(self) -> Array:
        """Points (k,) that may carry at the end of the stage."""
        return near_points(self._problem)

    def spent(self, on: int = N_CONTACT) -> int:
        """Iterations of contact problems, or of N_IMPACT_CONTACT, since the last call."""
        count, self.counts[on] = int(self.counts[on]), 0
        return count
