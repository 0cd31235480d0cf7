"""One analysis of a structure, from its case to the result files of any analysis."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.overturning import FELL, critical_displacement, critical_tilt_along
from fecolumn.contact.points import GROUND
from fecolumn.engines.analysis import Analysis, AnalysisFailed
from fecolumn.engines.ending import AT_REST, OVERTURNED, REST_SHARE, SLID_OFF, STILL_ROCKING, Ending
from fecolumn.engines.fallen_bodies import FallenBodies
from fecolumn.engines.left_part import OVER_EDGE, way_out
from fecolumn.engines.peaks import peaks
from fecolumn.engines.resume import CHECKPOINT
from fecolumn.engines.summary_entries import direction_deg
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation.progress import Progress
from fecolumn.structures.barrier import feet_on_springs, least_barrier, stances
from fecolumn.structures.lost import limits_of
from fecolumn.structures.model import BodyModel, JointModel, StructureModel
from fecolumn.structures.shaking import accelerations, motions_of
from fecolumn.structures.structure import standing_of

if TYPE_CHECKING:
    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.contact.known_base import KnownBase
    from fecolumn.contact.unbounded_base import UnboundedBase
    from fecolumn.engines.dynamics.cuts import StepFailed
    from fecolumn.engines.passing import Passing, RigidMotion
    from fecolumn.engines.reduced.motion import MotionState
    from fecolumn.engines.scene.scene import Scene
    from fecolumn.motions.record import GroundMotion

# Height by which a body is lifted that stands nowhere by itself, over its size (root of the sum of
# its principal inertias over its mass): what lifts a block five times as high as wide onto its edge
_LIFTED = 0.02
# Time for which the kinetic energy must stay low where a structure may rest anywhere, over that in
# which a body falls by its size: what turns back is slow for a shorter time
_TURNS = 4.0
# Over its critical tilt: a body that leans farther may turn back there more slowly still
_LEANS = 0.9
# Over the usual time: how long it must be still there
_NEAR_EDGE = 10.0


class OfStructure(Analysis):
    """What an Analysis of a structure is, whatever its engine. structure: StructureModel at its
    start.
    """

    structure: StructureModel
    _barrier_j: float | None = None
    _still_j: float | None = None
    _off: str | None = None
    _fell: str | None = None
    _collapse: FallenBodies | None = None
    _anywhere: bool | None = None

    def expected(self) -> str:
        """What is analysed, in words."""
        from fecolumn.structures.size import expected

        return str(expected(self.case, self.file))

    def scene(self) -> Scene:
        """`engines.scene.scene.Scene` of the case."""
        from fecolumn.engines.scene.structure_scene import scene_of

        return scene_of(self.case, self.structure, self.folder / "case.json")

    @property
    def barrier_j(self) -> float:
        """As `barrier.least_barrier`: below a share of it the structure is at rest."""
        if self._barrier_j is None:
            self._barrier_j = least_barrier(self.structure, standing_of(self.case, self.structure))
        return self._barrier_j

    @property
    def barrier_told_j(self) -> float | None:
        """Energy [J] that overturns a part slowly; None where links hold bodies, whose energy it
        leaves out, and where no part stands by itself.
        """
        held = any(link.stiffness for link in self.structure.links)
        return None if held else self.barrier_j or None

    @property
    def collapse(self) -> FallenBodies | None:
        """What may fall, where contact is found."""
        if self._collapse is None and self.structure.found:
            self._collapse = FallenBodies(self.structure)
        return self._collapse

    @property
    def rests_anywhere(self) -> bool:
        """Whether the structure may come to rest with more or less potential energy than it has at
        its equilibrium: bodies fall, links hold force that friction locks in, or ground yields.
        """
        if self._anywhere is None:
            case, parts = self.case, self.structure.parts
            self._anywhere = (
                bool(self.structure.found or self.structure.links)
                or any(joint.bond is not None for joint in self.structure.joints)
                or any(part.airborne for part in parts)
                or any(ground.yield_pa is not None for ground in case.grounds.values())
                or any(joint.yield_pa is not None for joint in case.joints.values())
            )
        return self._anywhere

    @property
    def turn_s(self) -> float:
        """Time [s] for which the kinetic energy must stay low where the structure may rest
        anywhere.
        """
        if self.collapse:
            return self.collapse.turn_s
        sizes = [
            np.sqrt(np.trace(part.model.inertia) / part.model.mass)
            for part in self.structure.parts
            if part.held < 0
        ]
        return float(_TURNS * np.sqrt(max(sizes) / GRAVITY))

    def is_still(self) -> bool:
        """As of Analysis; where the structure may rest anywhere, by its kinetic energy alone, for
        `still_s`.
        """
        if not self.rests_anywhere:
            return super().is_still()
        now = float(self.history.last()["time"])

        def still(for_s: float) -> bool:
            return self.history.stayed_below("energy/kinetic", self.still_j, now - for_s)

        return still(self.turn_s) and still(self.still_s())

    def still_s(self) -> float:
        """`turn_s`, longer where a body leans to near its critical tilt."""
        return self.turn_s * (_NEAR_EDGE if self._leans_far() else 1.0)

    def _leans_far(self) -> bool:
        """Whether a body leans to near its critical tilt, where what turns back is slow for long;
        not of bodies that may fall and lie.
        """
        if self.collapse:
            return False
        last, parts = self.history.last(), self.structure.parts
        alone = stances(self.structure, standing_of(self.case, self.structure))
        return any(
            float(last[f"body/{parts[place].name}/tilt"]) > _LEANS * stance.critical
            for place, stance in alone.items()
        )

    @property
    def still_j(self) -> float:
        """Largest `energy_left` [J] at which the structure counts as at rest; of kinetic energy
        where it may rest anywhere.

        Where contact is found during the motion see `FallenBodies`. Else it is a share of the
        least energy that overturns a body, or that lifts one which stands nowhere by itself, as a
        voussoir or what hangs or falls, by a share of its size.
        """
        if self.collapse:
            return self.collapse.still_j
        if self._still_j is None:
            alone = stances(self.structure, standing_of(self.case, self.structure))
            bounds = [
                _LIFTED * np.sqrt(np.trace(part.model.inertia) * part.model.mass) * GRAVITY
                for place, part in enumerate(self.structure.parts)
                if part.held < 0 and place not in alone
            ]
            bounds += [self.barrier_j] if self.barrier_j > 0 else []
            self._still_j = REST_SHARE * min(bounds, default=0.0)
        return self._still_j

    def energy_left(self) -> float:
        """As of Analysis; kinetic energy alone [J] where contact is found, as bodies may come to
        rest anywhere.
        """
        if self.collapse:
            return float(self.history.last()["energy/kinetic"])
        return super().energy_left()

    def energy_to_fall(self) -> float:
        """Energy [J] that bodies which nothing carries at the start have over what they fall on."""
        gaps: dict[int, float] = {}
        for joint in self.structure.joints:
            normal = self.structure.parts[joint.slave].model.surfaces[joint.slave_surface].normal
            upper = joint.slave if normal[2] < 0 else joint.master
            if joint.gap and abs(normal[2]) > np.sqrt(0.5):
                gaps[upper] = min(gaps.get(upper, np.inf), joint.gap)
        return sum(
            part.model.mass * GRAVITY * gaps.get(place, 0.0)
            for place, part in enumerate(self.structure.parts)
            if part.airborne
        )

    def check_passing(self, passing: Passing, motion: MotionState | RigidMotion) -> None:
        """Warn of bodies whose contact is doubtful.

        Raises
        ------
        AnalysisFailed
            bodies came through each other, or one lies across an edge that its joint has no contact
            points for; the state is saved.
        """
        doubts, through = passing.look(motion, self.dt_s)
        for told in doubts if self.comm.rank == 0 else ():
            warnings.warn(f"{self.file}: {told}", stacklevel=2)
        if not through and (names := passing.over_edges(motion)):
            through = (
                f"t = {motion.time:.4g} s: {OVER_EDGE}: {', '.join(names)}; "
                f"{way_out(self.case, self.structure, names)}; contact.between lets bodies meet "
                "wherever they touch"
            )
        if through:
            self._save()
            raise AnalysisFailed(f"{through}; state saved in {self.folder / CHECKPOINT}")

    def off_base(self, failure: StepFailed) -> Ending | None:
        """The Ending of a step that failed because a foot met the edge of its ground, or None."""
        raise NotImplementedError

    def _save(self) -> None:
        """Write checkpoint and history."""
        raise NotImplementedError

    def _load_motion(self, file: str) -> GroundMotion | None:
        #: Motion of each ground, None of one at rest; that which lasts longest is told.
        self.motions: list[GroundMotion | None] = motions_of(
            self.case, super()._load_motion(file), file
        )
        return max(filter(None, self.motions), key=lambda one: len(one.acceleration), default=None)

    def moving_grounds(self) -> list[GroundMotion]:
        """The motion of each ground that moves."""
        return [motion for motion in self.motions if motion is not None]

    def grounds(self, steps: range) -> NDArray[Any]:
        """Accelerations (k, 3 G) of all grounds at k successive steps [m/s2]."""
        return accelerations(self.motions, steps)

    def grounds_at(self, step: int) -> NDArray[Any]:
        """As `grounds`, (3 G,) of one step."""
        found: NDArray[Any] = self.grounds(range(step, step + 1))[0]
        return found

    def steepest_at(self, step: int) -> float:
        """As `steepest`, of one step."""
        return float(self.steepest(range(step, step + 1))[0])

    def progress(self) -> Progress:
        """The line that shows how far the analysis is, of one rank alone."""
        return Progress(
            self.steps,
            self.dt_s,
            quiet=self.quiet or self.comm.rank > 0,
            until_rest_from=self.motion_steps if self.until_rest else None,
        )

    def off_or_failed(self, failure: StepFailed) -> Ending:
        """The Ending of a step that failed because a foot met the edge of its ground.

        Raises
        ------
        AnalysisFailed
            it failed otherwise; the state before it is saved.
        """
        off = self.off_base(failure)
        if off is None:
            self._save()
            told = [str(failure), f"state saved in {self.folder / CHECKPOINT}"]
            if failure.joints:
                told.insert(1, way_out(self.case, self.structure, failure.joints))
            raise AnalysisFailed("; ".join(told)) from None
        return off

    def off_ground(
        self,
        failure: StepFailed,
        bases: Sequence[BasePlate | KnownBase | UnboundedBase],
        grounds: NDArray[Any],
        foot: Callable[[JointModel, BodyModel, NDArray[Any]], tuple[NDArray[Any], NDArray[Any]]],
    ) -> Ending | None:
        """The ending of a structure whose step failed because a foot met the edge of its ground,
        one of `bases` and of `grounds` (G,) of GROUND_STATE; None for another failure.

        Parameters
        ----------
        foot
            function of a joint, the model of its slave and rows (k,) of that: places (k, 3) [m] and
            velocities (k, 3) [m/s].
        """
        for joint in self.structure.joints:
            if joint.master != GROUND:
                continue
            part, ground = self.structure.parts[joint.slave], grounds[joint.ground]
            nodes = part.model.surfaces[joint.slave_surface].nodes
            places, velocities = foot(joint, part.model, nodes)
            ending = self.slid_off(
                failure,
                bases[joint.ground],
                places - ground["place"],
                velocities - ground["velocity"],
            )
            if ending is not None:
                self._off = part.name
                return replace(ending, ended_by=f'"{part.name}": {ending.ended_by}')
        return None

    def limits(self) -> dict[str, Any]:
        """Of the summary: the least tilt of a body at which it would overturn by itself, None where
        none stands so, and of one body alone the displacement of its top there [m]; of many no
        displacement is known beyond which they fall.
        """
        structure = self.structure
        standing = standing_of(self.case, structure)
        found = stances(structure, standing)
        for place, foot in feet_on_springs(structure, standing).items():
            if place in found:
                found[place] = found[place]._replace(critical=foot.critical)
        displacement = None
        if len(structure.parts) == 1 and found:
            place, mark = structure.observed
            arm, _ = structure.parts[place].model.marks[mark]
            displacement = critical_displacement(found[place], arm)
        return dict(
            critical_tilt_rad=min((foot.critical for foot in found.values()), default=None),
            u_critical_m=displacement,
        )

    def no_return(self, last: dict[str, Any], rotation: NDArray[Any]) -> str:
        """Which body has passed its point of no return, in words."""
        parts, standing = self.structure.parts, standing_of(self.case, self.structure)
        tilts = np.array([float(last[f"body/{part.name}/tilt"]) for part in parts])
        limits = limits_of(self.structure, standing)
        far, critical = tilts > limits.tilts, limits.standing["critical"]
        b = int(np.argmax(np.where(far, tilts, 0.0) if far.any() else tilts - critical))
        self._fell = parts[b].name
        told = f"limit {limits.tilts[b]:.3g} rad"
        if not far.any():
            turn = rotation_matrix(np.asarray(last[f"body/{parts[b].name}/rotation"], float))
            along = critical_tilt_along(stances(self.structure, standing)[b], turn)
            told = f"critical {along:.3g} rad in that direction"
        return f'"{parts[b].name}" has tilted by {tilts[b]:.3g} rad, {told}'

    def ending(self, fallen: int, rotation: NDArray[Any]) -> Ending:
        """How the analysis ends, from the answer of `reduced.observe.outcome_of_row`."""
        if fallen != FELL:
            found = super().ending(fallen, rotation)
            collapse = self.collapse
            lie = collapse.fallen(self.history.arrays()) if collapse else {}
            if not collapse or not lie or found.outcome == OVERTURNED:
                return found
            self._fell = next(iter(lie))
            told = f"{collapse.told(lie)}; {self._how_it_lies(found)}"
            return Ending(OVERTURNED, told, next(iter(lie.values())))
        return Ending(
            SLID_OFF,
            f'"{self._lowest()}" has fallen past the ground, z = '
            f"{min(self.structure.levels):g}, at "
            f"{self.history.last()['time']:.3f} s",
        )

    @staticmethod
    def _how_it_lies(found: Ending) -> str:
        """Whether all lies still at the end, in words."""
        if found.outcome == STILL_ROCKING:
            return f"some still move, {found.ended_by}"
        return found.ended_by if AT_REST in found.ended_by else f"all lie still, {found.ended_by}"

    def _lowest(self) -> str:
        """Name of the body whose centre of mass is lowest now."""
        last = self.history.last()
        heights = {
            part.name: part.center[2] + float(last[f"body/{part.name}/displacement"][2])
            for part in standing_of(self.case, self.structure)
        }
        return min(heights, key=lambda name: heights[name])

    def results(self, ending: Ending) -> dict[str, Any]:
        """Of the summary: what bodies, interfaces, storeys and links have reached."""
        found = peaks(self.history.arrays(), self.structure)
        if ending.outcome == SLID_OFF:
            way = self.history.last()[f"body/{self._off or self._lowest()}/displacement"]
            found["slid_off_direction_deg"] = direction_deg(way)
        if ending.outcome == OVERTURNED and self._fell and len(self.structure.parts) > 1:
            # the observed body may stand yet: the axis of that which fell
            turn = self.history.last()[f"body/{self._fell}/rotation"]
            axis = rotation_matrix(np.asarray(turn, float))[:, 2]
            found["overturn_direction_deg"] = direction_deg(axis)
        return found
