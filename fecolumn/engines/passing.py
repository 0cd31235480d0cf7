"""Bodies that came through each other, looked for while an analysis runs: pairs without a joint,
and those of which a joint with two sides does not hold them apart.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.convex import hulls_of
from fecolumn.contact.nearby import pair_keys
from fecolumn.contact.points import GROUND
from fecolumn.contact.through import ThroughCheck, find_depths
from fecolumn.engines.reduced.motion import MotionState
from fecolumn.engines.unprepared_edges import UnpreparedEdges
from fecolumn.structures.hulls import hulls_of_parts
from fecolumn.structures.model import StructureModel

# Way of a body between two looks, over the thickness of the thinnest one: none is passed unseen
_WAY = 0.2
# Way of a body in a step, over its thickness, from which on found contact may sink seen: bars a
# hundred times as long as thick, at 100 rad/s in steps of 1e-3 s, go by ten times that
_FAST = 1.0
# Depth over the thickness of the thinner body from which on contact that is found has failed: its
# middle is in the other one
_FAILED = 0.5
# The same, over that at the start, from which on a joint with two sides has not held bodies apart:
# far above what a face gives, far below what can be overlooked
_SANK = 1e-2


class RigidMotion(NamedTuple):
    """Rigid motion of bodies.

    Attributes
    ----------
    time
        [s].
    frames
        center (nb, 3) of mass [m], velocity (nb, 3) [m/s], spin (nb, 3) in the frames of the bodies
        [rad/s].
    rotation
        (nb, 3, 3).
    """

    time: float
    frames: Mapping[str, NDArray[Any]]
    rotation: NDArray[Any]


class Passing:
    """Looks for pairs of bodies without a joint that are in each other, and for those whose contact
    is found, or which have a joint with two sides, and that came through each other all the same.

    Bodies that are not convex, or have no elements, are in no pair.
    """

    def __init__(self, structure: StructureModel) -> None:
        parts = structure.parts
        self._names = [part.name for part in parts]
        self._held = np.array([part.held >= 0 for part in parts])
        hulls = hulls_of_parts(structure.outlines or [None] * len(parts))
        together = [(joint.slave, joint.master) for joint in structure.joints]
        together = [pair for pair in together if pair[1] != GROUND]
        fixed = np.flatnonzero(self._held)
        together += [(a, b) for a in fixed for b in fixed if a < b]
        self._meet = set(structure.found.parts) if structure.found else set()
        self._check = ThroughCheck(hulls_of(hulls), pair_keys(together, len(parts)))
        thick = self._check.hulls.thickness
        self._thinnest = thick[thick > 0].min(initial=np.inf)
        radii = np.abs(self._check.hulls.middle) + self._check.hulls.half
        self._radii = np.linalg.norm(radii, axis=1)
        self._looks, self._told = int((thick > 0).sum()) > 1, False
        self._joined = np.array(
            [
                (joint.slave, joint.master)
                for joint in structure.joints
                if joint.pair >= 0 and joint.pad is None
                if min(thick[joint.slave], thick[joint.master]) > 0
            ],
            np.int64,
        ).reshape(-1, 2)
        upright = [np.array([getattr(part, of) for part in parts]) for of in ("center", "rotation")]
        self._depth_before = self._depths(*upright)
        self._edges = UnpreparedEdges(structure)

    def steps(self, motion: MotionState | RigidMotion, dt: float, most: int) -> int:
        """Steps [of dt s] after which to look again, `most` at most."""
        speeds = self._speeds(motion)
        time = self._edges.time(motion.frames["center"], motion.rotation, speeds, most * dt)
        if self._looks:
            fastest = float(speeds.max()) + GRAVITY * most * dt
            time = min(time, _WAY * self._thinnest / fastest)
        return max(1, min(most, int(time / dt * (1 + 1e-9))))

    def look(self, motion: MotionState | RigidMotion, dt: float) -> tuple[list[str], str]:
        """What makes the motion doubtful, in words, each told once; and which pair came through
        each other, in words, "" where none did. dt: step [s].
        """
        doubts = [told for told in (self.fast(motion, dt), self.overlaps(motion)) if told]
        return doubts, self.told(motion)

    def over_edges(self, motion: MotionState | RigidMotion) -> tuple[str, ...]:
        """As `UnpreparedEdges.passed`."""
        return self._edges.passed(motion.frames["center"], motion.rotation)

    def fast(self, motion: MotionState | RigidMotion, dt: float) -> str:
        """Which body whose contact is found goes by more than its thickness in a step of dt s, in
        words; "" where none does, or one has been told.
        """
        if self._told or not self._meet:
            return ""
        ways = dt * self._speeds(motion) / np.maximum(self._check.hulls.thickness, 1e-300)
        ways[[b for b in range(len(ways)) if b not in self._meet]] = 0.0
        b = int(np.argmax(ways))
        self._told = bool(ways[b] > _FAST)
        return self._told * (
            f't = {motion.time:.4g} s: "{self._names[b]}" goes {ways[b]:.2g} times its thickness '
            f"in a step: on the way it may sink into what it meets; integration.dt_s = {dt:g}: "
            f"{_rounded(dt * _FAST / ways[b]):g} s goes no further than that thickness"
        )

    def overlaps(self, motion: MotionState | RigidMotion) -> str:
        """Which two bodies a joint with two sides has let sink into each other, in words; "" where
        none has, or all have been told.
        """
        if not len(self._joined):
            return ""
        sank = self._depths(motion.frames["center"], motion.rotation) - self._depth_before
        share = sank / self._check.hulls.thickness[self._joined].min(axis=1)
        k = int(np.argmax(share))
        if share[k] <= _SANK:
            return ""
        # each pair is told once
        self._depth_before[k] = np.inf
        first, second = (self._names[b] for b in self._joined[k])
        return (
            f't = {motion.time:.4g} s: "{first}" and "{second}" are in each other by {sank[k]:.3g} '
            f"m, {share[k]:.2g} times the thickness of the thinner one: the joint between their "
            f"faces has not held them apart, as where one meets the side of the other; the motion "
            f"after that is not to be used; a shorter integration.dt_s may hold them apart"
        )

    def _depths(self, centers: NDArray[Any], rotations: NDArray[Any]) -> NDArray[Any]:
        """How far [m] bodies of each joint with two sides are in each other, below 0 apart."""
        depths = np.zeros(len(self._joined))
        places = np.ascontiguousarray(centers, float), np.ascontiguousarray(rotations, float)
        find_depths(self._check.hulls, *places, self._joined, self._check.relation, depths)
        return np.maximum(depths, 0.0)

    def _speeds(self, motion: MotionState | RigidMotion) -> NDArray[Any]:
        """Largest velocities (nb,) [m/s] that points of bodies may have."""
        velocity, spin = (
            np.linalg.norm(motion.frames[key], axis=1) for key in ("velocity", "spin")
        )
        speeds: NDArray[Any] = velocity + spin * self._radii
        return speeds

    def told(self, motion: MotionState | RigidMotion) -> str:
        """Which pair is in each other now, in words; "" where none is."""
        if not self._looks:
            return ""
        centers = np.ascontiguousarray(motion.frames["center"])
        found = self._check.deepest(centers, np.ascontiguousarray(motion.rotation))
        thick = self._check.hulls.thickness
        for one, other, depth in found:
            first, second = self._names[one], self._names[other]
            told = (
                f't = {motion.time:.4g} s: "{first}" and "{second}" came through each other, by '
                f"{depth:.3g} m; "
            )
            if not {one, other} <= self._meet:
                return (
                    f"{told}a joint between them, [joints.NAME] between = "
                    f'["{first}", "{second}"], lets them meet'
                )
            if depth > _FAILED * min(thick[one], thick[other]):
                return f"{told}a shorter integration.dt_s lets them meet"
        return ""


def _rounded(step: float) -> float:
    """The largest step [s] of 1, 2 or 5 times a power of ten that is not longer."""
    power = 10.0 ** np.floor(np.log10(step) + 1e-9)
    return float(max(factor * power for factor in (1, 2, 5) if factor * power <= step * (1 + 1e-9)))
