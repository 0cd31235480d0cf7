"""The reduced engine: a reduced structure, its motion and its ledger, advanced by steps."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.case.sections import SUBSTEPS
from fecolumn.contact.arrays import arrays_of
from fecolumn.contact.ball import from_center
from fecolumn.contact.joints import left_faces
from fecolumn.contact.overturning import STANDS, steepest_to_come
from fecolumn.contact.points import FLAT_GROUND, GROUND
from fecolumn.contact.pose import SLAVE, grounds_at, poses_of
from fecolumn.contact.problem import (
    CONTACT_FAILED,
    ENDED,
    FAR_BASE,
    IMPACT_FAILED,
    ITERATIONS_SPENT,
    N_COUNTS,
    N_CUTS,
    N_IMPACTS,
    N_ITERATIONS,
    N_PARTS,
    NO_ROOM,
    OFF_BASE,
    OFF_PATCH,
    OK,
    ROLLS_FAST,
)
from fecolumn.contact.projection import grounds_for_steps
from fecolumn.engines.dynamics.cuts import Halving, StepFailed, Stop, in_halves
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.links import span
from fecolumn.engines.dynamics.record import Record
from fecolumn.engines.reduced import motion as motions
from fecolumn.engines.reduced.equilibrium import work_of
from fecolumn.engines.reduced.found_of_model import NoRoom
from fecolumn.engines.reduced.ledger import N_PLACES
from fecolumn.engines.reduced.model import scheme
from fecolumn.engines.reduced.observe import ENERGY, ITERATIONS_MADE, outcome_of_row
from fecolumn.engines.reduced.run import LENGTHS, StepBatch, StepState, advance
from fecolumn.foundation._compiled import compile_for, interpreted
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.reduced.model import Scheme, Structure
    from fecolumn.engines.reduced.motion import MotionState
    from fecolumn.engines.reduced.observe import View
    from fecolumn.structures.model import StructureModel

# for the halves of a failed step: the point of no return and rest are looked for at its end only
_NO_END, _NO_REST, _NO_STEPS = np.array([np.inf]), (0.0, -np.inf), np.empty(0)
# Calls of which the quickest tells what one takes
_TIMED_CALLS = 50
# Counts of what the steps are made of, which those that are put back have no part in
_OF_STEPS = [N_CUTS, N_IMPACTS, N_PARTS]
_STOPS = {
    CONTACT_FAILED: Stop.CONTACT,
    IMPACT_FAILED: Stop.CONTACT,
    ITERATIONS_SPENT: Stop.MOTION,
    OFF_BASE: Stop.OFF_BASE,
    OFF_PATCH: Stop.OFF_PATCH,
}


class Engine:
    """Reduced bodies on their base, their motion and their ledger.

    Parameters
    ----------
    build
        function of an HHT that returns Structure and points, see `structure.structure_of`; where
        contact is found, of the number of pairs for which there is room as well.
    bases
        of each ground a BasePlate, or another holder of its compliance with `grid`, `slot`,
        `compliance` and `need`.
    view
        View.
    hht
        HHT.
    start
        function of the engine that returns the first MotionState; see `reduced.start`.
    model
        what `start` needs of the bodies.
    substeps
        of `case.sections.SUBSTEPS`, for what a step is made in parts.
    """

    def __init__(
        self,
        build: Callable[..., Any],
        bases: Sequence[Any],
        view: View,
        hht: HHT,
        start: Callable[..., Any],
        max_cuts: int = 4,
        model: StructureModel | None = None,
        substeps: str = "rolling",
    ) -> None:
        self.model: Any = model
        self.bases, self.view, self.hht, self.max_cuts, self.substeps = (
            tuple(bases),
            view,
            hht,
            max_cuts,
            SUBSTEPS.index(substeps),
        )
        self._build = build
        self.structure, self.points = build(hht)
        self.work, self.spare, self.kept = (
            work_of(self.structure, self.points),
            self.motion_at_rest(),
            self.motion_at_rest(),
        )
        self._schemes: dict[tuple[HHT, bool], tuple[Any, ...]] = {}
        self.spent_s = 0.0  # processor time of compiled steps [s]
        self.made = np.empty((0, self.view.width))
        self.counts, self.ledger = np.zeros(N_COUNTS, np.int64), np.zeros(N_PLACES)
        upright = np.tile(np.eye(3), (len(view.center), 1, 1))
        self._need_below(view.center, upright, self.spare.grounds, 0)
        self.surface = grounds_for_steps(self.bases)
        compile_for(advance, self._arguments(self._schemes_of(hht), self.spare, self.spare))
        self.motion = self.motion_at_rest()
        self.motion = start(self)
        self.ledger[0] = self.mechanical()

    def motion_at_rest(self) -> motions.MotionState:
        """A MotionState with zeros."""
        structure = self.structure
        return motions.at_rest(
            len(self.points),
            structure.squares.shape[1],
            len(structure.squares),
            len(structure.interfaces),
            len(structure.links),
            self.view.levels,
            len(structure.interfaces) - structure.found.interface,
        )

    def _need_below(self, centers: Array, rotations: Array, grounds: Array, rows: int) -> None:
        """Make the compliance of the grounds known below the nodes that may touch them, of bodies
        with centres of mass (nb, 3) turned by (nb, 3, 3), and so many rows of nodes around.
        """
        standing = self.points[self.points["master"] == GROUND]
        standing = standing[standing["facet"] != FLAT_GROUND]
        for number, (base, ground) in enumerate(zip(self.bases, grounds)):
            points = standing[standing["ground"] == number]
            if len(points):
                arms, slaves = self.structure.bodies.arms[points["node"]], points["slave"]
                places = centers[slaves] + np.einsum("pab,pb->pa", rotations[slaves], arms)
                base.need(base.grid.around(places - ground["place"], rows))

    def places(self, centers: Array, rotations: Array) -> Array:
        """Places (P, 3) [m] of the points in the frames of their interfaces, of bodies with centres
        of mass (nb, 3) turned by (nb, 3, 3).
        """
        points, interfaces = self.points, self.structure.interfaces
        each = poses_of(interfaces, centers, rotations, grounds_at(self.view.levels))
        offsets = np.zeros((len(interfaces), 3))
        for interface, pose, offset in zip(interfaces, each, offsets):
            interpreted(from_center)(interface, pose["turned"][SLAVE, 2], offset)
        poses, arms = (
            each[points["interface"]],
            self.structure.bodies.arms[points["node"]] + offsets[points["interface"]],
        )
        table = centers[points["slave"]] + np.einsum("pab,pb->pa", rotations[points["slave"]], arms)
        return np.einsum("pba,pb->pa", poses["frame"], table - poses["origin"])

    def link_lengths(
        self, motion: motions.MotionState, structure: Structure | None = None
    ) -> Array:
        """Lengths (nl,) [m] of the links of a motion; structure: as of `settle`."""
        structure = self.structure if structure is None else structure
        return np.array(
            [
                interpreted(span)(structure, n, motion, np.empty(3))
                for n in range(len(structure.links))
            ]
        )

    def settle(
        self, structure: Structure, scheme: Scheme, motion: MotionState, end: MotionState
    ) -> int:
        """One proximal step of `scheme` towards gravity equilibrium, from `motion` to `end`: a way
        to end; structure: this one's, with masses for the search.
        """
        arguments = self._arguments((scheme,) * LENGTHS, motion, end)
        return advance(structure, *arguments[1:])[1]

    def _arguments(
        self,
        schemes: tuple[Scheme, ...],
        motion: MotionState,
        spare: MotionState,
        grounds: Array | None = None,
        steepest: Array = _NO_STEPS,
        rest: tuple[float, float] = _NO_REST,
        rows: Array | None = None,
    ) -> tuple:
        rows = np.empty((0, self.view.width)) if rows is None else rows
        grounds = np.empty((0, 3 * len(self.bases))) if grounds is None else grounds
        course = StepState(motion, spare, self.kept, self.ledger, self.counts)
        chunk = StepBatch(grounds, steepest, rest, self.substeps, rows)
        return self.structure, self.surface, schemes, self.work, self.view, course, chunk

    @property
    def record(self) -> Record:
        """Counts as the full-order engine gives them."""
        return Record(*self.counts[:6].tolist())

    def row(self) -> Array:
        """The present row (view.width,) of the history."""
        row = np.empty((1, self.view.width))
        advance(*self._arguments(self._schemes_of(self.hht), self.motion, self.spare, rows=row))
        return row[0]

    def call_s(self) -> float:
        """Processor time [s] of a call of compiled code beside its steps: least of several."""
        arguments = self._arguments(
            self._schemes_of(self.hht),
            self.motion,
            self.spare,
            rows=np.empty((1, self.view.width)),
        )
        times = []
        for _ in range(_TIMED_CALLS):
            began = time.process_time()
            advance(*arguments)
            times.append(time.process_time() - began)
        return min(times)

    def mechanical(self) -> float:
        """Kinetic, strain and gravity energy now [J]."""
        return float(self.row()[ENERGY : ENERGY + 3].sum())

    def potential(self) -> float:
        """Strain and gravity energy now [J]."""
        return float(self.row()[ENERGY + 1 : ENERGY + 3].sum())

    def fallen(self, steepest: float) -> int:
        """As `overturning.fallen`, now; steepest: tangent of the steepest inclination of apparent
        gravity to come.
        """
        return interpreted(outcome_of_row)(self.view, self.motion, self.row(), steepest)

    def advance(
        self,
        grounds: Array,
        steepest: Array | None = None,
        rest: tuple[float, float] = _NO_REST,
    ) -> tuple[Array, bool]:
        """Step under ground accelerations (k, 3) [m/s2] at the ends of the steps: rows (k',
        view.width) and whether the column is lost or at rest.

        Parameters
        ----------
        grounds
            (k, 3) of all grounds, or (k, 3 G) of each.
        steepest
            (k,) as of `overturning.steepest_to_come`; of these grounds alone unless given.
        rest
            mechanical energy in gravity equilibrium, and what may be left above it of a column at
            rest, which ends the steps [J]; never more than that is kinetic, for what has come to
            stand lower has less potential energy. -inf not to ask.

        Raises
        ------
        StepFailed
            no convergence after max_cuts halvings, or the column left the base; the motion is that
            before the step, the rows of the steps made are in `made`. So they are where anything
            else stops the steps, a base that cannot be extended for example.
        """
        grounds, done = np.array(grounds, float), 0
        if not np.isfinite(grounds).all():
            raise ValueError("a ground acceleration is not a finite number")
        if grounds.shape[1] == 3:
            grounds = np.tile(grounds, len(self.bases))
        steepest = (
            steepest_to_come(self.structure.gravity, np.ascontiguousarray(grounds[:, :3]))
            if steepest is None
            else np.asarray(steepest, float)
        )
        rows = np.empty((len(grounds), self.view.width))
        # iterations of attempts at a step that came to nothing are counted in its row
        self.made, counted = rows[:0], self.counts[N_ITERATIONS]
        while done < len(grounds):
            tried = self.counts[N_ITERATIONS] - counted
            made, answer = self._steps(self.hht, grounds[done:], rows[done:], steepest[done:], rest)
            if made:
                rows[done, ITERATIONS_MADE] += tried
                counted += rows[done : done + made, ITERATIONS_MADE].sum()
            done += made
            self.made = rows[:done]
            if answer == ENDED:
                return rows[:done], True
            if answer == FAR_BASE:
                self.extend_base(self.spare)
            elif answer == NO_ROOM or answer != OK and not self._cut(grounds[done], answer):
                self.make_room(2 * len(self.motion.meetings.rows))
            elif answer != OK:
                rows[done] = self.row()
                rows[done, ITERATIONS_MADE] = self.counts[N_ITERATIONS] - counted
                counted = self.counts[N_ITERATIONS]
                done += 1
                self.made = rows[:done]
                kinetic, strain, gravity = rows[done - 1, ENERGY : ENERGY + 3]
                if (
                    self.fallen(steepest[done - 1]) != STANDS
                    or max(kinetic, kinetic + strain + gravity - rest[0]) <= rest[1]
                ):
                    return rows[:done], True
        return rows, False

    def _steps(
        self,
        hht: HHT,
        grounds: Array,
        rows: Array,
        steepest: Array,
        rest: tuple[float, float],
        rolls: bool = True,
    ) -> tuple[int, int]:
        arguments = self._arguments(
            self._schemes_of(hht, rolls), self.motion, self.spare, grounds, steepest, rest, rows
        )
        began = time.process_time()
        made, answer = advance(*arguments)
        self.spent_s += time.process_time() - began
        if answer == ROLLS_FAST:
            parts = (self._scheme(HHT(hht.dt / 2**k, hht.alpha), rolls) for k in range(1, LENGTHS))
            self._schemes[hht, rolls] = (*self._schemes[hht, rolls][:1], *parts)
            left = grounds[made:], rows[made:], steepest[made:]
            more, answer = self._steps(hht, *left, rest, rolls)
            made += more
        return made, answer

    def make_room(self, meetings: int) -> None:
        """Let so many pairs of bodies whose contact is found be near each other."""
        self.structure, self.points = self._build(self.hht, meetings)
        self.work, self._schemes = work_of(self.structure, self.points), {}
        self.spare, self.kept = self.motion_at_rest(), self.motion_at_rest()
        before, self.motion = arrays_of(self.motion), self.motion_at_rest()
        for name, values in arrays_of(self.motion).items():
            if name != "meetings.buckets":
                values[: len(before[name])] = before[name]

    def _cut(self, ground: Array, answer: int) -> bool:
        """Make a failed step again in two halves, and a half that fails in halves, too.

        Parameters
        ----------
        ground
            (3 G,) accelerations of the grounds at the end of the step [m/s2].
        answer
            why the step failed, of the answers of `contact.problem`.

        Returns
        -------
        True where the step was made. False where the bodies that are near each other are more
        pairs than there is room for: `make_room` helps. Motion and ledger are then as before.

        Raises
        ------
        StepFailed
            a half failed after `max_cuts` halvings, also with rims that do not roll; motion and
            ledger are as before.
        """
        saved, booked, counted, row = (
            self.motion_at_rest(),
            self.ledger.copy(),
            self.counts[_OF_STEPS],
            np.empty((1, self.view.width)),
        )
        motions.copy(self.motion, saved)

        shortest = 1.01 * self.hht.dt / 2**self.max_cuts

        def answer_of(target: Array, hht: HHT, rolls: bool) -> int:
            one = target[None], row, _NO_END, _NO_REST, rolls
            while (answer := self._steps(hht, *one)[1]) == FAR_BASE:
                self.extend_base(self.spare)
            return answer

        def take(_: None, target: Array, hht: HHT) -> None:
            answer = answer_of(target, hht, rolls=True)
            if answer in (CONTACT_FAILED, ITERATIONS_SPENT) and hht.dt < shortest:
                # the last way: in so short a step a rim rolls by little
                answer = answer_of(target, hht, rolls=False)
            if answer == NO_ROOM:
                raise NoRoom
            if answer not in (OK, ENDED):
                raise self._failure(answer)

        failure = self._failure(answer)
        try:
            halving = Halving(take, self.max_cuts, self._count_cut)
            in_halves(halving, None, self._accelerations(), ground, self.hht, failure)
        except BaseException as error:
            motions.copy(saved, self.motion)
            self.ledger[:] = booked
            self.counts[_OF_STEPS] = counted
            if isinstance(error, NoRoom):
                return False
            if isinstance(error, StepFailed):
                told = f"t = {self.motion.time:.6g} s: {error}"
                raise StepFailed(error.stop, told, error.joints) from None
            raise
        return True

    def _accelerations(self) -> Array:
        """Accelerations (3 G,) of the grounds now [m/s2]."""
        found = self.motion.grounds["acceleration"].ravel().copy()
        found[:3] = self.motion.whole["ground"][0]
        return found

    def begin_shaking(self, accelerations: Array) -> None:
        """Let the grounds begin with accelerations (3 G,) [m/s2]."""
        self.motion.whole["ground"] = accelerations[:3]
        self.motion.grounds["acceleration"] = accelerations.reshape(-1, 3)

    def _failure(self, answer: int) -> StepFailed:
        """The failure of a step, with the interfaces that a body has left, after OFF_PATCH."""
        stop = _STOPS[answer]
        if answer != OFF_PATCH:
            return StepFailed(stop, stop.value)
        left = left_faces([joint.name for joint in self.model.joints], self.work.points)
        return StepFailed(stop, f"{stop.value}: {', '.join(left)}", left)

    def _count_cut(self) -> None:
        self.counts[N_CUTS] += 1

    def _schemes_of(self, hht: HHT, rolls: bool = True) -> tuple:
        """Schemes of steps and of their parts, which are made when they are needed."""
        if (hht, rolls) not in self._schemes:
            self._schemes[hht, rolls] = (self._scheme(hht, rolls),) * LENGTHS
        return self._schemes[hht, rolls]

    def _scheme(self, hht: HHT, rolls: bool) -> Scheme:
        return scheme(self.structure, self.points, hht)._replace(rolls=rolls)

    def extend_base(self, motion: MotionState) -> None:
        """Make the grounds' compliance known under the feet and two rows of its nodes around."""
        self._need_below(motion.frames["center"], motion.rotation, motion.grounds, 2)
        self.surface = grounds_for_steps(self.bases)

    def know_base(self, nodes: Array) -> None:
        """Make the grounds' compliance known at top nodes (k,) of all of them, one after
        another.
        """
        first = 0
        for base in self.bases:
            last = first + len(base.grid.points)
            base.need(nodes[(nodes >= first) & (nodes < last)] - first)
            first = last
        self.surface = grounds_for_steps(self.bases)
