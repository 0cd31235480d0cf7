"""The foot of a full-order column on its base: what `contact` is given of it, and what it gives back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn._compiled import compile_for, compiled, interpreted
from fecolumn.contact.projection import base_for_steps, project
from fecolumn.contact.bodies import node_matrix, one_body
from fecolumn.contact.compliance import assemble
from fecolumn.contact.impact import find_impact
from fecolumn.contact.interface import interface_of, rims_at_rest
from fecolumn.contact.pad import springs_of
from fecolumn.contact.points import CONTACT, node_points
from fecolumn.contact.problem import CONTACT_FAILED, FAR_BASE, ITERATIONS_SPENT, N_CONTACT, N_COUNTS, OFF_BASE, begin_problem, near_points, room, solve_linear, stored_energy
from fecolumn.contact.pose import poses_on_base
from fecolumn.contact.rim import Rim
from fecolumn.contact.rolling import plan_roll, roll_points, stay
from fecolumn.contact.stick import no_stick
from fecolumn.contact.tolerances import ITERATIONS
from fecolumn.dynamics.cuts import Stop

_STOPS = {CONTACT_FAILED: Stop.CONTACT, ITERATIONS_SPENT: Stop.CONTACT, OFF_BASE: Stop.OFF_BASE}


@dataclass(slots=True)
class Nodal:
    """Compliance of the foot's nodes (3 n, 3 n) [m/N] in the column's frame within a stage: `elastic` that of the factored matrix, `dynamic` with the static part."""

    elastic: np.ndarray
    dynamic: np.ndarray


class Interface:
    """Contact points of the column's foot on the top of the base, in the table frame.

    The points are the foot's nodes, but for those of a round rim, which may have turned along it.

    Args:
        foot: FilteredFoot or PlainFoot: what the time integration shows of the column.
        reference: (n, 3) reference positions of its nodes [m].
        base: BasePlate, or what answers as it does.
        friction: Coulomb coefficient.
        law: (n, 3) compliance of the contact law [m/N].
        rim: the foot's round rim, None to take it as the polygon of its nodes.
        restitution, rolling: coefficients, see `contact.restitution` and `contact.rolling`.
        pad: Pad below its points, None for a base without.
    """

    def __init__(self, foot, reference, base, friction: float, law: np.ndarray, rim: Rim | None = None, restitution: float = 0.0,
                 rolling: float = 0.0, pad=None):
        self.foot, self.reference, self.base, self.rim, self.pad = foot, reference, base, rim, pad
        #: As of `reduced.model.structure_of`.
        self.laws = dict(friction=friction, law=law, rim=rim, restitution=restitution, rolling=rolling, pad=pad)
        self.size = len(reference)
        #: (1,) of INTERFACE, and it alone; points (n,) of POINT.
        self.interfaces = interface_of(reference, rim, restitution, rolling, pad)
        self.record = self.interfaces[0]
        self.points = node_points(reference, friction, law, pad.stiffness if pad else None)
        self.width = float(self.record["width"])
        mobility = node_matrix(foot.mobility) if foot.filtered else np.zeros((3 * self.size, 3 * self.size))
        #: The column as `contact.bodies` has it: its rigid motion is part of the nodal mobility.
        self.bodies = one_body(reference, node_matrix(foot.static), mobility)
        self.surface, self.counts = base_for_steps(base), np.zeros(N_COUNTS, np.int64)
        self._problem, self._stick = room(self.size), no_stick(0)

    def prepare(self, say=lambda text: None) -> None:
        """Have compiled what the steps call, so that the first landing costs what all cost; `say` is told why it takes long, if it does."""
        if not (compiled(solve_linear) and compiled(find_impact)):
            say("compiling the contact of the full-order engine, once on this machine: a minute")
        before, values, mask = np.zeros(self.size, CONTACT), np.zeros((self.size, 3)), np.zeros(self.size, bool)
        static, springs = self.bodies.static, springs_of(self.points, self.record, 1.0)
        compile_for(solve_linear, (self._problem, self.bodies, self.surface, self.points, self.interfaces, springs, static, static, self._stick, rims_at_rest(),
                                   poses_on_base(np.eye(3)[None]), values, ITERATIONS, before, before, self.counts))
        compile_for(find_impact, (self.bodies, self.surface, self.points, self.interfaces, springs, self.near, values, poses_on_base(np.eye(3)[None]), before, before, values, values,
                                  mask, mask, True, 1.0, 1.0, self.counts))

    def at_points(self, values: np.ndarray) -> np.ndarray:
        """Values (n, ...) at the points from those at the nodes."""
        return np.einsum("pq,pqa->pa", self.points["weights"], values[self.points["carriers"]])

    def at_nodes(self, forces: np.ndarray) -> np.ndarray:
        """Forces (n, 3) on the nodes from those on the points."""
        shared = np.zeros_like(forces)
        loaded = np.flatnonzero(forces.any(axis=1))
        np.add.at(shared, self.points["carriers"][loaded], self.points["weights"][loaded, :, None] * forces[loaded, None])
        return shared

    def node_positions(self, x: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Positions (n, 3) of the foot's nodes from the column's positions x (n_owned, 3), without the static part."""
        return (self.reference + self.foot.position(x @ rotation - self.foot.body.X)) @ rotation.T

    def positions(self, x: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Positions (n, 3) of the points from the column's positions x (n_owned, 3), without the static part."""
        positions = self.at_points(self.node_positions(x, rotation))
        positions[:, 2] += self.points["lift"]
        return positions

    def velocities(self, v: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Velocities (n, 3) of the points from the column's velocities."""
        return self.at_points(self.foot.position(v @ rotation) @ rotation.T)

    def load(self, forces: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Nodal forces (n_owned, 3) of contact forces (n, 3) on the column turned by `rotation`."""
        return self.foot.load(self.at_nodes(forces) @ rotation) @ rotation.T

    def acceleration(self, forces: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Accelerations (n_owned, 3) of contact forces, or velocity jumps of contact impulses (n, 3)."""
        return self.foot.acceleration(self.at_nodes(forces) @ rotation) @ rotation.T

    def nodal(self, compliance: np.ndarray, scale: float, frame: np.ndarray) -> Nodal:
        """Compliance of a stage from that of its response (n, n, 3, 3), found with the column turned by `frame`."""
        elastic = node_matrix(scale * np.einsum("ab,ijac,cd->ijbd", frame, compliance, frame))
        return Nodal(elastic, elastic + self.bodies.static)

    def begin_step(self, state, halfway: np.ndarray, rolls: bool) -> tuple[np.ndarray, np.ndarray, bool]:
        """Place the points of a step: what the State brings to them (n,) of CONTACT, its rim (1,) of RIM, whether it rolled.

        Args:
            halfway: (3, 3) rotation in the middle of the step. rolls: False: the points stay in any case.
        """
        before, rims, rolled = state.contact.copy(), state.rims.copy(), False
        if self.rim is None:
            return before, rims, rolled
        arms, nodes = self.reference, np.asarray(self.rim.nodes, np.int64)
        rolled, tilt, roll = plan_roll(self.record, nodes, rims[0], state.contact, state.rotation, halfway, rolls)
        if not rolled:
            stay(roll, nodes, rims[0], tilt, arms, self.points)
            return before, rims, rolled
        roll_points(roll, nodes, rims[0], arms, self.node_positions(state.x, state.rotation), state.contact, self.points, before)
        elsewhere = ~before["located"]
        before["relative"][elsewhere] = self.positions(state.x, state.rotation)[elsewhere]
        before["anchor"][elsewhere], before["located"] = before["relative"][elsewhere, :2], True
        return before, rims, rolled

    def take_rim_as_polygon(self) -> None:
        """Let the foot roll from node to node."""
        self.rim = self.laws["rim"] = None
        self.record["rim_count"] = 0

    def static_compliance(self, listed: np.ndarray) -> np.ndarray:
        """Compliance (3 k, 3 k) [m/N] of some points that follows their forces at once, in the reference configuration."""
        everyone, own, W = np.arange(self.size), np.zeros((self.size, 3)), np.empty((3 * len(listed), 3 * len(listed)))
        self._extend_base(self.reference)
        interpreted(project)(self.surface, self.reference, everyone, self.points)
        interpreted(assemble)(self.bodies, self.surface, self.points, self.reference, listed, poses_on_base(np.eye(3)[None]), 0.0, self.bodies.static, 1.0, own, W)
        return W

    def solve(self, nodal: Nodal, rotation, positions, dt: float, before, after, times: int = ITERATIONS) -> tuple[Stop, float]:
        """Find forces in `after` that obey the laws at points that move from `positions` (n, 3) along with them: why it ended, violation over
        what is allowed.

        times: 0 only looks how well they do.
        """
        springs = springs_of(self.points, self.record, dt)
        # the column's compliance has changed with its place
        begin_problem(self._problem, False, False)
        while True:
            answer, residual = solve_linear(self._problem, self.bodies, self.surface, self.points, self.interfaces, springs, nodal.dynamic, nodal.elastic,
                                            self._stick, rims_at_rest(), poses_on_base(rotation[None]), positions, times, before, after, self.counts)
            if answer != FAR_BASE:
                return _STOPS.get(answer, Stop.CONVERGED), residual
            self._extend_base(positions[self.near])

    def _extend_base(self, positions) -> None:
        """Make the base's compliance known under positions (k, 3) and one row of its nodes around."""
        self.base.need(self.base.grid.around(positions, 1))
        self.surface = base_for_steps(self.base)

    def stored(self, dt: float, before, after) -> float:
        """Strain energy [J] of base, foot's static rest, contact law and pad, whose indentation is found, after `solve`."""
        return stored_energy(self._problem, self.points, self.interfaces, springs_of(self.points, self.record, dt), before, after)

    @property
    def near(self) -> np.ndarray:
        """Points (k,) that may carry at the end of the stage."""
        return near_points(self._problem)

    def spent(self) -> int:
        """Iterations of contact problems since the last call."""
        count, self.counts[N_CONTACT] = int(self.counts[N_CONTACT]), 0
        return count
