"""Proximal steps of the reduced engine to gravity equilibrium."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from fecolumn.contact.problem import FAR_BASE, NO_ROOM, OK, near_points
from fecolumn.contact.tolerances import (
    BALANCED,
    HASTEN_FROM,
    HASTEN_MEMORY,
    REST,
    REST_ROUNDING,
    SLIDES_KEPT,
)
from fecolumn.contact.work import move_anchors
from fecolumn.engines.dynamics.anderson import Anderson
from fecolumn.engines.dynamics.gravity import NoEquilibrium
from fecolumn.engines.reduced import motion as motions
from fecolumn.engines.reduced.elastic import COORDINATE, END, START
from fecolumn.engines.reduced.firmness import with_masses
from fecolumn.engines.reduced.found_of_model import NoRoom
from fecolumn.engines.reduced.model import resting_scheme
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation._compiled import interpreted


class Diverged(NoEquilibrium):
    """A proximal step has no answer."""


class Settling:
    """The way of an engine's bodies to gravity equilibrium, from where they are drawn.

    Parameters
    ----------
    firmness
        (nb,) of `firmness.firmness_of`.
    """

    def __init__(self, engine, firmness: np.ndarray):
        self.engine, self._firmness = engine, float(firmness.max())
        shares = firmness / self._firmness
        self._roots = np.sqrt(shares)
        self.structure = with_masses(engine.structure, shares)
        self._scheme = resting_scheme(self.structure, engine.points, self._firmness)
        bodies, arms = engine.structure.bodies.body, engine.structure.bodies.arms
        self._masses = bodies["mass"] * shares
        self._inertia = bodies["inertia"] * shares[:, None, None]
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
        self._haste, self._change = Anderson(HASTEN_MEMORY), np.inf
        self.steps, self.mover = 0, None
        self.moved, self.unbalanced = np.inf, np.inf

    def step(self) -> float:
        """One proximal step: displacement of the body that moves most [m], or more where the forces
        that are not balanced then count more.

        Raises
        ------
        Diverged
            contact does not converge. NoRoom: more pairs of bodies are near each other than there
            is room for.
        """
        if self._hasten():
            if self._made(hastened=True):
                return self._done()
            motions.copy(self._kept, self._start)
            self._haste.forget()
        self._made(hastened=False)
        return self._done()

    def motion(self) -> motions.MotionState:
        """The motion at rest, of the structure's own masses."""
        # the operator of feet that stand is that of the masses for the search
        self.engine.work.stick.key[1] = 0.0
        self._start.modal[:, COORDINATE] /= self._roots[:, None]
        return self._start

    def _made(self, hastened: bool) -> bool:
        """Make a step; whether it serves, of one that was hastened."""
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
            if hastened:
                return False
            if np.isfinite(of_each).all():
                self.mover = int(np.argmax(of_each))
            raise Diverged(
                f"gravity equilibrium: contact does not converge in iteration {self.steps + 1}"
            )
        change = self._coordinates(end) - self._coordinates(start)
        size = np.linalg.norm(change)
        if hastened and (size > self._change or self._is_used_up()):
            return False
        carrying = (work.before["force"][:, 2] > 0) | (end.contact["force"][:, 2] > 0)
        points = np.abs(work.elastic.point[END] - work.elastic.point[START])[carrying]
        self.mover, self._change = int(np.argmax(of_each)), size
        self.moved = float(max(of_each.max(), points.max(initial=0.0)))
        forces = self._masses * np.linalg.norm(ways, axis=1)
        moments = np.linalg.norm(np.einsum("bac,bc->ba", self._inertia, turns), axis=1)
        bent = np.sqrt(self._masses * (modal**2).sum(axis=1))
        largest = max(forces.max(), (moments / self._sizes).max(), bent.max())
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
        if self.steps == SLIDES_KEPT:
            self._haste.forget()
        self._haste.note(self._coordinates(end), change)
        motions.copy(end, start)
        return True

    def _done(self) -> float:
        """What the last step returns."""
        if self.moved < REST_ROUNDING * self.height:
            return self.moved
        return max(self.moved, self.unbalanced / BALANCED * REST * self.height)

    def _hasten(self) -> bool:
        """Take the start of the next step to where the last ones lead; whether it is there."""
        if self.steps < HASTEN_FROM or (place := self._haste.place()) is None:
            return False
        start = self._start
        motions.copy(start, self._kept)
        ways, turns, modal = self._parted(place)
        start.frames["center"] = self.engine.view.center + ways
        start.rotation[:] = [rotation_matrix(turn) for turn in turns]
        start.modal[:, COORDINATE] = modal
        start.ties["length"] = self.engine.link_lengths(start, self.structure)
        return True

    def _is_used_up(self) -> bool:
        """Whether the last step yields, breaks or settles anything, which stays."""
        before, after = self._start, self._end
        return any(
            (before.ties[name] != after.ties[name]).any() for name in ("flowed", "damage", "broken")
        ) or bool((before.contact["settled"] != after.contact["settled"]).any())

    def _coordinates(self, motion) -> np.ndarray:
        """Displacements (n,) of a motion, times the roots of the masses of the search."""
        ways = motion.frames["center"] - self.engine.view.center
        turns = Rotation.from_matrix(motion.rotation).as_rotvec()
        return np.concatenate(
            [
                (np.sqrt(self._masses)[:, None] * ways).ravel(),
                (self._radii()[:, None] * turns).ravel(),
                motion.modal[:, COORDINATE].ravel(),
            ]
        )

    def _parted(self, coordinates: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Ways (nb, 3) [m], turns (nb, 3) [rad] and modal coordinates (nb, m) of `_coordinates`;
        bodies that grounds hold stay.
        """
        count = 3 * len(self._masses)
        ways, turns = coordinates[:count].reshape(-1, 3), coordinates[count : 2 * count]
        masses, radii = np.sqrt(self._masses)[:, None], self._radii()[:, None]
        with np.errstate(invalid="ignore"):
            ways = np.where(masses > 0, ways / masses, 0.0)
            turns = np.where(radii > 0, turns.reshape(-1, 3) / radii, 0.0)
        return ways, turns, coordinates[2 * count :].reshape(len(self._masses), -1)

    def _radii(self) -> np.ndarray:
        """Roots (nb,) of the bodies' mean moments of inertia in the search."""
        return np.sqrt(np.trace(self._inertia, axis1=1, axis2=2) / 3)
