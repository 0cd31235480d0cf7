"""One analysis of a structure, from its case to the result files of any analysis."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.overturning import FELL, critical_displacement, critical_tilt_along
from fecolumn.contact.points import GROUND
from fecolumn.engines.analysis import CHECKPOINT, Analysis, AnalysisFailed
from fecolumn.engines.dynamics.bonds import bonded
from fecolumn.engines.ending import AT_REST, OVERTURNED, REST_SHARE, SLID_OFF, STILL_ROCKING, Ending
from fecolumn.engines.fallen_bodies import FallenBodies
from fecolumn.engines.left_part import way_out
from fecolumn.engines.peak_acceleration import peak_acceleration
from fecolumn.engines.reduced.observe import (
    COLUMNS,
    OF_BODY,
    OF_BOND,
    OF_INTERFACE,
    OF_LINK,
    OF_MARK,
)
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation.progress import Progress
from fecolumn.structures.barrier import feet_on_springs, least_barrier, stances
from fecolumn.structures.lost import limits_of
from fecolumn.structures.model import BodyModel, Joint, Link, StructureModel
from fecolumn.structures.shaking import accelerations, motions_of
from fecolumn.structures.structure import standing_of

if TYPE_CHECKING:
    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.contact.known_base import KnownBase
    from fecolumn.contact.unbounded_base import UnboundedBase
    from fecolumn.engines.dynamics.cuts import StepFailed
    from fecolumn.engines.scene.scene import Scene
    from fecolumn.motions.record import GroundMotion

_WHOLE = (
    "active_nodes",
    "iterations",
    "broken",
)  # columns of whole numbers, by the last word of their names

# Rounding of the sum of areas that have failed, over all
_ALL = 1e-9
# Height by which a body is lifted that stands nowhere by itself, over its size (root of the sum of
# its principal inertias over its mass): what lifts a block five times as high as wide onto its edge
_LIFTED = 0.02
# Share of its yield force at which a link is said to yield that comes to it along a curve
_YIELDED = 0.9


class OfStructure(Analysis):
    """What an Analysis of a structure is, whatever its engine. structure: StructureModel at its
    start.
    """

    structure: StructureModel
    _barrier_j: float | None = None
    _still_j: float | None = None
    _off: str | None = None
    _collapse: FallenBodies | None = None

    def expected(self) -> str:
        """What is analysed, in words."""
        from fecolumn.structures.size import expected

        return str(expected(self.case, self.file))

    def scene(self) -> Scene:
        """`post.scene.Scene` of the case."""
        from fecolumn.engines.scene.structure_scene import scene_of

        return scene_of(self.case, self.structure, self.folder / "case.json")

    @property
    def barrier_j(self) -> float:
        """As `barrier.least_barrier`: below a share of it the structure is at rest."""
        if self._barrier_j is None:
            self._barrier_j = least_barrier(self.structure, standing_of(self.case, self.structure))
        return self._barrier_j

    @property
    def collapse(self) -> FallenBodies | None:
        """What may fall, where contact is found."""
        if self._collapse is None and self.structure.found:
            self._collapse = FallenBodies(self.structure)
        return self._collapse

    @property
    def still_j(self) -> float:
        """Largest `energy_left` [J] at which the structure counts as at rest.

        Where contact is found during the motion it is a bound of kinetic energy alone, as fallen
        bodies come to rest anywhere; see `FallenBodies`. Else it is a share of the least energy
        that overturns a body, or that lifts one which stands nowhere by itself, as a voussoir or
        what hangs or falls, by a share of its size.
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

    def grounds(self, steps: range) -> NDArray[Any]:
        """Accelerations (k, 3 G) of all grounds at k successive steps [m/s2]."""
        return accelerations(self.motions, steps)

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
        foot: Callable[[Joint, BodyModel, NDArray[Any]], tuple[NDArray[Any], NDArray[Any]]],
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
            found["slid_off_direction_deg"] = float(np.degrees(np.arctan2(way[1], way[0])))
        return found


def columns_of(rows: NDArray[Any], structure: StructureModel) -> dict[str, NDArray[Any]]:
    """Rows (k, width) of the engine as columns by name: those of any analysis, and of the
    structure's parts.

    "body/NAME/displacement" of the centre of mass [m], "body/NAME/tilt" [rad] and
    "body/NAME/rotation", the rotation vector [rad] from where the body stood upright;
    "interface/NAME/tilt" of the slave from the master [rad], "rise" of the middle of its foot [m],
    "slide" along two tangents [m], normal "force" [N], "resultant" of the forces on the slave [N]
    and "center" of pressure [m] in the table frame, 0 where nothing carries;
    "mark/NAME.MARK/displacement" [m]; "link/NAME/tension" [N], "elongation" from its unstressed
    length and the part of it that has "yielded" [m], "work" that it has taken [J], whether it is
    "broken"; "bond/NAME/stress" and "shear_stress" [Pa], the largest of the points of a glued
    joint, the share of its area that has "failed" and "work" that it has taken [J];
    "storey/NAME N/drift" [m] along x and y of the table, "shear" [N], its elastic part.
    """
    names = [(name, count) for name, count in COLUMNS]
    names += [
        (f"body/{part.name}/{name}", count) for part in structure.parts for name, count in OF_BODY
    ]
    names += [
        (f"interface/{joint.name}/{name}", count)
        for joint in structure.joints
        for name, count in OF_INTERFACE
    ]
    names += [
        (f"mark/{part.name}.{mark}/{name}", count)
        for part in structure.parts
        for mark in part.model.marks
        for name, count in OF_MARK
    ]
    names += [
        (f"link/{link.name}/{name}", count) for link in structure.links for name, count in OF_LINK
    ]
    names += [
        (f"bond/{one}/{name}", count) for one in glued_names(structure) for name, count in OF_BOND
    ]
    columns, place = {}, 0
    for name, count in names:
        values = rows[:, place] if count == 1 else rows[:, place : place + count]
        columns[name] = values.astype(int) if name.rpartition("/")[2] in _WHOLE else values.copy()
        place += count
    columns = of_both_sides(columns, structure)
    for part in structure.parts:
        if part.model.storeys is None:
            continue
        for number, stiffness in enumerate(part.model.storeys.stiffness, 1):
            drift = (
                columns.pop(f"mark/{part.name}.storey {number}/displacement")
                - columns[f"body/{part.name}/displacement"]
            )[:, :2]
            columns |= {
                f"storey/{part.name} {number}/drift": drift,
                f"storey/{part.name} {number}/shear": stiffness * drift,
            }
    return columns


def glued_names(structure: StructureModel) -> list[str]:
    """Names of the glued joints; one with two sides has that of its first."""
    return [
        structure.joints[joint.pair].name if joint.pair >= 0 else joint.name
        for joint in bonded(structure)
    ]


def of_both_sides(columns: dict[str, Any], structure: StructureModel) -> dict[str, Any]:
    """Columns by name with one interface for each joint with two sides: its force is that of
    both, and so are its resultant and its centre of pressure.
    """
    for joint in structure.joints:
        if joint.pair >= 0:
            own = f"interface/{structure.joints[joint.pair].name}/"
            other = f"interface/{joint.name}/"
            forces = [np.asarray(columns[f"{one}force"]) for one in (own, other)]
            total = forces[0] + forces[1]
            weighed = sum(
                force[..., None] * columns[f"{one}center"]
                for force, one in zip(forces, (own, other))
            )
            columns[f"{own}force"] = total if total.ndim else float(total)
            columns[f"{own}resultant"] = columns[f"{own}resultant"] - columns[f"{other}resultant"]
            columns[f"{own}center"] = weighed / np.where(total > 0, total, 1.0)[..., None]
            for name, _ in OF_INTERFACE:
                del columns[f"interface/{joint.name}/{name}"]
    return columns


def peaks(rows: dict[str, NDArray[Any]], structure: StructureModel) -> dict[str, Any]:
    """Of the summary: largest values of bodies, interfaces, storeys, links and glued joints by
    name, from the columns of a history.
    """

    def largest(name: str) -> float:
        values = rows[name]
        return float(
            np.abs(values).max() if values.ndim == 1 else np.linalg.norm(values, axis=1).max()
        )

    bodies = {
        part.name: dict(
            tilt_max_rad=largest(f"body/{part.name}/tilt"),
            acceleration_max_m_s2=peak_acceleration(
                rows["time"], rows[f"body/{part.name}/displacement"], rows["ground"]
            ),
        )
        for part in structure.parts
    }
    interfaces = {
        joint.name: dict(
            tilt_max_rad=largest(f"interface/{joint.name}/tilt"),
            rise_max_m=largest(f"interface/{joint.name}/rise"),
            slide_max_m=largest(f"interface/{joint.name}/slide"),
            residual_slide_m=float(np.hypot(*rows[f"interface/{joint.name}/slide"][-1])),
            force_max_n=largest(f"interface/{joint.name}/force"),
        )
        for joint in structure.joints
        if joint.pair < 0
    }
    storeys = {
        name[7:-6]: dict(drift_max_m=largest(name), shear_max_n=largest(f"{name[:-5]}shear"))
        for name in rows
        if name.startswith("storey/") and name.endswith("/drift")
    }
    links = {
        link.name: _peaks_of_link(
            rows["time"], {name: rows[f"link/{link.name}/{name}"] for name, _ in OF_LINK}, link
        )
        for link in structure.links
    }
    bonds = {
        name: _peaks_of_bond(rows["time"], {one: rows[f"bond/{name}/{one}"] for one, _ in OF_BOND})
        for name in glued_names(structure)
    }
    return dict(bodies=bodies, interfaces=interfaces, storeys=storeys, links=links) | (
        dict(bonds=bonds) if bonds else {}
    )


def _peaks_of_bond(time: NDArray[Any], rows: dict[str, NDArray[Any]]) -> dict[str, Any]:
    """Largest stresses of a glued joint, the share of its area that has failed, when the first and
    the last of it did, and what it has taken; from its columns.
    """
    begun, done = rows["failed"] > 0, rows["failed"] > 1 - _ALL
    return dict(
        tension_max_pa=float(rows["stress"].max()),
        shear_max_pa=float(rows["shear_stress"].max()),
        failed_share=float(rows["failed"][-1]) if not done[-1] else 1.0,
        work_j=float(rows["work"][-1]),
        first_failed_at_s=float(time[np.argmax(begun)]) if begun.any() else None,
        all_failed_at_s=float(time[np.argmax(done)]) if done.any() else None,
    )


def _peaks_of_link(time: NDArray[Any], rows: dict[str, NDArray[Any]], link: Link) -> dict[str, Any]:
    """Extremes of a Link's tension and of its elongation until it breaks, what it has taken, and
    when it first yielded, broke, and was slack after it had been tight; from its columns.
    """

    def first(mask: NDArray[Any]) -> float | None:
        return float(time[np.argmax(mask)]) if mask.any() else None

    tension, broken, over = (
        rows["tension"],
        rows["broken"] > 0,
        rows["elongation"] - rows["yielded"],
    )
    yielded = rows["yielded"] != 0
    if link.bends < np.inf:
        # along a curve some of it yields from the start
        stretch = np.sign(over) * np.maximum(np.abs(over) - link.slack, 0.0)
        stretch = np.where(over > 0, stretch * link.pulls, stretch * link.pushes)
        hardens = link.hardening / (1 - link.hardening) * rows["yielded"]
        yielded &= link.stiffness * np.abs(stretch - hardens) >= _YIELDED * link.yield_n
    whole = rows["elongation"][: max(1, int((~broken).sum()))]
    tight = (link.pulls & (over > link.slack)) | (link.pushes & (over < -link.slack))
    slackens = (
        ~tight
        & ~broken
        & np.logical_or.accumulate(tight)
        & (link.slack > 0 or not (link.pulls and link.pushes))
    )
    return dict(
        tension_max_n=float(tension.max()),
        tension_min_n=float(tension.min()),
        compression_max_n=max(0.0, -float(tension.min())),
        elongation_max_m=float(whole.max()),
        elongation_min_m=float(whole.min()),
        shortening_max_m=max(0.0, -float(whole.min())),
        yielded_m=float(rows["yielded"][-1]),
        work_j=float(rows["work"][-1]),
        yielded_at_s=first(yielded),
        broke_at_s=first(broken),
        slack_at_s=first(slackens),
    )
