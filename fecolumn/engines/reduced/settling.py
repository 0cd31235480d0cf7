"""Proximal steps of the reduced engine to gravity equilibrium."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation

from fecolumn.contact.problem import FAR_BASE, NO_ROOM, OK, near_points
from fecolumn.contact.tolerances import (
    BALANCE_HALVES,
    BALANCED,
    BALANCED_AT_LEAST,
    HASTEN_FROM,
    HASTEN_TRIES,
    HOLDS_FROM,
    LEAST_FIRM,
    REST_WAY,
    SLIDES_KEPT,
    STICKS,
    TOUCHES,
)
from fecolumn.contact.work import move_anchors
from fecolumn.engines.dynamics.gravity import NoEquilibrium
from fecolumn.engines.reduced import motion as motions
from fecolumn.engines.reduced.elastic import COORDINATE, END, START
from fecolumn.engines.reduced.firmness import with_masses
from fecolumn.engines.reduced.found_of_model import NoRoom
from fecolumn.engines.reduced.model import resting_scheme
from fecolumn.engines.reduced.tangent import coordinates_of, displacements_of, masses_of, tangent_of
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.reduced.engine import Engine
    from fecolumn.engines.reduced.motion import MotionState


class Diverged(NoEquilibrium):
    """A proximal step has no answer."""


class Settling:
    """The way of an engine's bodies to gravity equilibrium, from where they are drawn.

    Parameters
    ----------
    firmness
        (nb,) of `firmness.firmness_of`.
    """

    def __init__(self, engine: Engine, firmness: Array) -> None:
        self.engine, self._firmness = engine, float(firmness.max())
        shares = firmness / self._firmness
        self._roots = np.sqrt(shares)
        self.structure = with_masses(engine.structure, shares)
        self._scheme = resting_scheme(self.structure, engine.points, self._firmness)
        bodies, arms = engine.structure.bodies.body, engine.structure.bodies.arms
        self._masses = masses_of(self.structure)
        self._weight = bodies["mass"].sum() * np.linalg.norm(engine.structure.gravity)
        self._sizes = np.array(
            [
                np.linalg.norm(arms[first : first + count], axis=1).max(initial=0.0)
                for first, count in zip(bodies["first"], bodies["count"])
            ]
        )
        self._reach = np.array(
            [
                engine.structure.reach[first : first + count].max(initial=0.0)
                for first, count in zip(bodies["first"], bodies["count"])
            ]
        )
        centers = engine.view.center
        self.height = 2 * np.abs(centers[:, 2]).max()
        self._start, self._end = engine.motion_at_rest(), engine.motion_at_rest()
        self._kept = engine.motion_at_rest()
        self._start.frames["center"] = centers
        self._start.contact["anchor"] = engine.places(centers, self._start.rotation)[:, :2]
        self._start.ties["length"] = engine.link_lengths(self._start)
        self._change: Any = np.inf
        # (nl,) what yielded in the last step [m]
        self._flow = np.zeros(len(self._start.ties))
        self.steps = 0
        self.mover: int | None = None
        self.moved, self.unbalanced = np.inf, np.inf
        # what was not balanced when it was last halved while bodies hardly moved, and in which step
        self._yardstick, self._halved_at = np.inf, 0

    def step(self) -> float:
        """One proximal step: displacement of the body that moves most [m], or more where the forces
        that are not balanced then count more.

        Raises
        ------
        Diverged
            contact does not converge.
        NoRoom
            more pairs of bodies are near each other than there is room for.
        """
        if self.steps < HASTEN_FROM or not self._hastened():
            self._made()
        return self._done()

    def motion(self) -> motions.MotionState:
        """The motion at rest, of the structure's own masses."""
        # the operator of feet that stand is that of the masses for the search
        self.engine.work.stick.key[1] = 0.0
        self._start.modal[:, COORDINATE] /= self._roots[:, None]
        return self._start

    def _made(self, tangent: Array | None = None) -> bool:
        """Make a step; whether it serves, of one that was hastened by the stiffness `tangent`: what
        is not balanced then has less energy in that than before (Deuflhard 2011, natural
        monotonicity).
        """
        engine, start, end, work = self.engine, self._start, self._end, self.engine.work
        while (answer := engine.settle(self.structure, self._scheme, start, end)) == FAR_BASE:
            engine.extend_base(end)
        if answer == NO_ROOM:
            raise NoRoom
        ways, turns = end.frames["center"] - start.frames["center"], work.action.turn
        modal = end.modal[:, COORDINATE] - start.modal[:, COORDINATE]
        of_each = np.maximum(
            np.abs(ways).max(axis=1), np.abs(turns).max(axis=1, initial=0.0) * self._sizes
        )
        of_each = np.maximum(
            of_each,
            self._reach * np.sqrt((self.structure.squares * modal**2).sum(axis=1)),
        )
        if answer != OK:
            if tangent is not None:
                return False
            if np.isfinite(of_each).all():
                self.mover = int(np.argmax(of_each))
            raise Diverged(
                f"gravity equilibrium: contact does not converge in iteration {self.steps + 1}"
            )
        change = self._coordinates(end) - self._coordinates(start)
        if tangent is not None and (
            _energy(tangent, change) > _energy(tangent, self._change) or self._is_used_up()
        ):
            return False
        carrying = (work.before["force"][:, 2] > 0) | (end.contact["force"][:, 2] > 0)
        points = np.abs(work.elastic.point[END] - work.elastic.point[START])[carrying]
        self.mover, self._change = int(np.argmax(of_each)), change
        self._flow = end.ties["flowed"] - start.ties["flowed"]
        self.moved = float(max(of_each.max(), points.max(initial=0.0)))
        masses = self._masses
        forces = masses.mass * np.linalg.norm(ways, axis=1)
        moments = np.linalg.norm(np.einsum("bac,bc->ba", masses.inertia, turns), axis=1)
        bent = np.sqrt(masses.mass * (modal**2).sum(axis=1))
        largest = np.max([forces, moments / self._sizes, bent], where=masses.free, initial=0.0)
        self.unbalanced = self._firmness * largest / self._weight
        self.steps += 1
        if self.steps > SLIDES_KEPT:
            interpreted(move_anchors)(
                work.points,
                self.structure.interfaces,
                self._scheme.springs,
                near_points(work.problem),
                work.before,
                end.contact,
            )
        else:
            end.contact["anchor"] = work.before["anchor"]
        motions.copy(end, start)
        return True

    def _done(self) -> float:
        """What the last step returns."""
        rests = REST_WAY * self.height
        # bodies go to and fro between places that contact takes for the same, in any number of
        # steps: each may be off by what it allows, a step by twice as much
        missed = self.engine.work.problem.allowed.max(initial=0.0)
        if not self.moved < max(rests, 2 * missed):
            self._yardstick, self._halved_at = np.inf, self.steps
        if self.unbalanced < self._yardstick / 2:
            self._yardstick, self._halved_at = self.unbalanced, self.steps
        stalls = self.steps - self._halved_at >= BALANCE_HALVES
        if stalls and self.unbalanced < BALANCED_AT_LEAST:
            return min(self.moved, rests / 2)
        return max(self.moved, self.unbalanced / BALANCED * rests)

    def _hastened(self) -> bool:
        """Make the next step from where the last one leads; whether that serves.

        From x0 it went to x1, so that k M (x0 - x1) is not balanced at x1; K being the stiffness
        there, x1 + (K + k e M)^-1 k M (x1 - x0) would be at rest (Newton). Where contact changes
        too much on the way, a half of it, and so on. Not where anything slides that no link pulls
        at: nothing would hold it. Links are answered by small steps, in which faces that touch as
        they are drawn come to carry but slowly: where the points that carry lead nowhere, all that
        touch are taken to carry.
        """
        linked = len(self.structure.links) > 0
        if self._slides_freely():
            return False
        return self._leads(0.0) or linked and self._leads(TOUCHES * self.height)

    def _leads(self, touches: float) -> bool:
        """`_hastened` with the points that carry or are less than `touches` [m] apart."""
        start, engine, masses = self._start, self.engine, self._masses
        yielding = self._flow != 0.0
        tangent = tangent_of(
            self.structure, self._scheme.springs, engine.work, masses, start, yielding, touches
        )
        tangent[np.diag_indices_from(tangent)] += LEAST_FIRM * self._firmness
        place = self._coordinates(start)
        further = np.linalg.solve(tangent, self._firmness * self._change)
        if not np.isfinite(further).all():
            return False
        motions.copy(start, self._kept)
        for halved in range(HASTEN_TRIES):
            ways, turns, modal = displacements_of(masses, place + further / 2**halved)
            start.frames["center"] = engine.view.center + ways
            start.rotation[:] = [rotation_matrix(turn) for turn in turns]
            start.modal[:, COORDINATE] = modal
            start.ties["length"] = engine.link_lengths(start, self.structure)
            if self._made(tangent):
                return True
            motions.copy(self._kept, start)
        return False

    def _slides_freely(self) -> bool:
        """Whether any point that carries slides between bodies at which no link pulls."""
        force, points = self._start.contact["force"], self.engine.work.points
        shear = np.hypot(*force[:, :2].T)
        slides = (force[:, 2] > 0) & (shear >= STICKS * points["friction"] * force[:, 2])
        links, ties = self.structure.links, self._start.ties
        pulls = links[(ties["force"] != 0.0) & ~ties["broken"]]
        held = np.union1d(pulls["a"], pulls["b"])
        held = held[held >= 0]
        tied = np.isin(points["slave"], held) | np.isin(points["master"], held)
        loose = slides & ~tied
        if (self.structure.interfaces["edge"][:, 0] > 0).any() or self.steps > HOLDS_FROM:
            # a dome rolls to its place by Newton's steps alone, and others creep there for ever:
            # what sticks elsewhere in a joint holds points that slide as faces spread
            sticks = points["interface"][(force[:, 2] > 0) & ~slides]
            loose &= ~np.isin(points["interface"], sticks)
        return bool(loose.any())

    def _is_used_up(self) -> bool:
        """Whether the last step breaks or settles anything, which stays, or yields otherwise than
        the step before: a longer way in the same direction yields to the same place.
        """
        before, after = self._start, self._end
        flow = after.ties["flowed"] - before.ties["flowed"]
        return (
            bool(((flow != 0.0) & (np.sign(flow) != np.sign(self._flow))).any())
            or any((before.ties[name] != after.ties[name]).any() for name in ("damage", "broken"))
            or bool((before.contact["settled"] != after.contact["settled"]).any())
        )

    def _coordinates(self, motion: MotionState) -> Array:
        """Displacements of a motion, as of `tangent.coordinates_of`."""
        ways = motion.frames["center"] - self.engine.view.center
        turns = Rotation.from_matrix(motion.rotation).as_rotvec()
        return coordinates_of(self._masses, ways, turns, motion.modal[:, COORDINATE])


def _energy(tangent: Array, change: Array) -> float:
    """Twice the energy of forces (n,) in a stiffness (n, n)."""
    return float(change @ np.linalg.solve(tangent, change))
