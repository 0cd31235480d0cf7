"""The reduced engine: advances a reduced structure by many steps at a time."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import compile_for, interpreted, njit
from fecolumn.contact.arrays import put, put_matrix
from fecolumn.contact.projection import base_for_steps
from fecolumn.contact.problem import CONTACT_FAILED, ENDED, FAR_BASE, IMPACT_FAILED, ITERATIONS_SPENT, N_COUNTS, N_CUTS, N_ITERATIONS, OFF_BASE, OK
from fecolumn.dynamics.cuts import Stop, StepFailed, in_halves
from fecolumn.dynamics.hht import HHT
from fecolumn.dynamics.overturning import STANDS, fallen, steepest_to_come
from fecolumn.dynamics.record import Record
from fecolumn.reduced import motion as motions
from fecolumn.reduced.equilibrium import equilibrate, work_of
from fecolumn.reduced.ledger import N_PLACES
from fecolumn.reduced.model import scheme, structure_of
from fecolumn.reduced.elastic import COORDINATE, END, START
from fecolumn.reduced.observe import ENERGY, WIDTH, lost, observe
from fecolumn.reduced.step import step

# of the halves of a step, whose end alone counts: nothing is past returning
_NO_END = np.array([np.inf])
_STOPS = {CONTACT_FAILED: Stop.CONTACT, IMPACT_FAILED: Stop.CONTACT, ITERATIONS_SPENT: Stop.ITERATIONS, OFF_BASE: Stop.OFF_BASE}


@njit
def ended(eye, motion, row, steepest, rest):
    """Whether the column is lost or at rest after a step."""
    return lost(eye, motion, row, steepest) != STANDS or row[ENERGY] + row[ENERGY + 1] + row[ENERGY + 2] <= rest


@njit
def advance(structure, base, scheme, work, eye, motion, spare, grounds, steepest, rest, rows, ledger, counts):
    """Steps of one chunk: steps made and why it ended; `motion` is the state after them, rows (k, WIDTH) are filled.

    steepest: (k,) as of `overturning.fallen` after each step. rest: mechanical energy [J] at which the column is at rest; -inf not to ask.

    Without any step to make: the row of `motion` where there is one to fill, else one proximal step of `scheme` towards gravity equilibrium, from
    `motion` to `spare`; see `start.standing`. They are here because each function that Python calls is compiled with all it calls.
    """
    elastic, bodies = work.elastic, len(motion.frames)
    elastic.now[START] += 1
    if len(grounds) == 0:
        if len(rows):
            observe(structure, eye, motion, ledger, 0, rows[0])
            return 0, OK
        fall, still, bent = np.empty((bodies, 3)), np.zeros((bodies, 3)), np.empty((bodies, motion.modal.shape[2]))
        for b in range(bodies):
            put(motion.modal[b, COORDINATE], bent[b])
            for a in range(3):
                fall[b, a] = motion.frames[b].center[a] + scheme.half * structure.gravity[a]
        return 0, equilibrate(structure, base, scheme, work, motion, fall, bent, still, np.nan, spare, counts)
    booked, now, then, made, answer = ledger.copy(), motion, spare, 0, OK
    for k in range(len(grounds)):
        before = counts[N_ITERATIONS]
        put(ledger, booked)
        answer = step(structure, base, scheme, work, now, grounds[k], then, ledger, counts)
        if answer != OK:
            put(booked, ledger)
            break
        observe(structure, eye, then, ledger, counts[N_ITERATIONS] - before, rows[made])
        now, then, made = then, now, made + 1
        # what is known of the end is known of the next start
        elastic.now[START] += 1
        for i in range(elastic.node.shape[1]):
            if elastic.stamp[END, i] == elastic.now[END]:
                elastic.stamp[START, i] = elastic.now[START]
                for a in range(3):
                    elastic.node[START, i, a] = elastic.node[END, i, a]
        if ended(eye, now, rows[made - 1], steepest[k], rest):
            answer = ENDED
            break
    if made % 2:
        # a step that failed for want of the base's compliance tells by its end in `spare` where it is wanted
        for b in range(bodies):
            for a in range(3):
                work.action.push[b, a] = motion.frames[b].center[a]
            put_matrix(motion.rotation[b], work.action.halfway[b])
        motions.copy(spare, motion)
        for b in range(bodies):
            for a in range(3):
                spare.frames[b].center[a] = work.action.push[b, a]
            put_matrix(work.action.halfway[b], spare.rotation[b])
    return made, answer


class Engine:
    """A reduced column on its base, its motion and its ledger.

    Args:
        model: ColumnModel.
        base: BasePlate, or another holder of its compliance with `grid`, `slot`, `compliance` and `need`.
        eye: View.
        hht: HHT.
        start: function of the engine that returns the first Motion; see `reduced.start`.
        gravity, damping_ratio, laws: as of `model.structure_of`.
    """

    def __init__(self, model, base, eye, hht: HHT, start, gravity, max_cuts: int = 4, damping_ratio: float = 0.0, **laws):
        self.model, self.base, self.eye, self.hht, self.max_cuts = model, base, eye, hht, max_cuts
        self.structure, self.points = structure_of(model, hht, gravity, damping_ratio=damping_ratio, **laws)
        self.work, self.spare, self._schemes = work_of(self.structure, self.points), self.motion_at_rest(), {}
        self.counts, self.ledger = np.zeros(N_COUNTS, np.int64), np.zeros(N_PLACES)
        self.base.need(base.grid.around(model.reference, 0))
        self.surface = base_for_steps(base)
        compile_for(advance, self._arguments(self._scheme(hht), self.spare, self.spare))
        self.motion = start(self)
        self.ledger[0] = self.mechanical()

    def motion_at_rest(self) -> motions.Motion:
        """A Motion with zeros."""
        return motions.at_rest(len(self.points), self.structure.squares.shape[1])

    def settle(self, scheme, motion, end) -> int:
        """One proximal step of `scheme` towards gravity equilibrium, from `motion` to `end`: a way to end."""
        return advance(*self._arguments(scheme, motion, end))[1]

    def _arguments(self, scheme, motion, spare, grounds=np.empty((0, 3)), steepest=np.empty(0), rest=-np.inf, rows=np.empty((0, WIDTH))) -> tuple:
        return (self.structure, self.surface, scheme, self.work, self.eye, motion, spare, grounds, steepest, rest, rows, self.ledger, self.counts)

    @property
    def record(self) -> Record:
        """Counts as the full-order engine gives them."""
        return Record(*self.counts[:4].tolist())

    def row(self) -> np.ndarray:
        """The present row (WIDTH,) of the history."""
        row = np.empty((1, WIDTH))
        advance(*self._arguments(self._scheme(self.hht), self.motion, self.spare, rows=row))
        return row[0]

    def mechanical(self) -> float:
        """Kinetic, strain and gravity energy now [J]."""
        return float(self.row()[ENERGY:ENERGY + 3].sum())

    def fallen(self, steepest: float) -> int:
        """As `overturning.fallen`, now; steepest: tangent of the steepest inclination of apparent gravity to come."""
        row, motion = self.row(), self.motion
        return interpreted(fallen)(self.eye.stance, motion.rotation[0], motion.frames["spin"][0], row[8:11], float(np.hypot(row[1], row[2])), steepest)

    def advance(self, grounds: np.ndarray, steepest: np.ndarray | None = None, rest: float = -np.inf) -> tuple[np.ndarray, bool]:
        """Step under ground accelerations (k, 3) [m/s2] at the ends of the steps: rows (k', WIDTH) and whether the column is lost or at rest.

        Args:
            grounds: (k, 3).
            steepest: (k,) as of `overturning.steepest_to_come`; of these grounds alone unless given.
            rest: mechanical energy at which the column is at rest, and the steps end [J].

        Raises:
            StepFailed: no convergence after max_cuts halvings, or the column left the base; the motion is that before the step, the
                rows of the steps made are in `made`. So they are where anything else stops the steps, a base that cannot be extended for example.
        """
        grounds, done = np.array(grounds, float), 0
        if not np.isfinite(grounds).all():
            raise ValueError("a ground acceleration is not a finite number")
        steepest = steepest_to_come(self.structure.gravity, grounds) if steepest is None else np.asarray(steepest, float)
        rows = np.empty((len(grounds), WIDTH))
        self.made = rows[:0]
        while done < len(grounds):
            made, answer = self._steps(self.hht, grounds[done:], rows[done:], steepest[done:], rest)
            done += made
            self.made = rows[:done]
            if answer == ENDED:
                return rows[:done], True
            if answer == FAR_BASE:
                self.extend_base(self.spare)
            elif answer != OK:
                self._cut(grounds[done], answer)
                rows[done] = self.row()
                done += 1
                self.made = rows[:done]
                if self.fallen(steepest[done - 1]) != STANDS or rows[done - 1, ENERGY:ENERGY + 3].sum() <= rest:
                    return rows[:done], True
        return rows, False

    def _steps(self, hht, grounds, rows, steepest, rest) -> tuple[int, int]:
        return advance(*self._arguments(self._scheme(hht), self.motion, self.spare, grounds, steepest, rest, rows))

    def _cut(self, ground, answer) -> None:
        """The step that failed with `answer`, in two halves and these in halves as far as it needs; nothing has changed where it fails."""
        saved, booked, row = self.motion_at_rest(), self.ledger.copy(), np.empty((1, WIDTH))
        motions.copy(self.motion, saved)

        def take(_, target, hht):
            while (answer := self._steps(hht, target[None], row, _NO_END, -np.inf)[1]) == FAR_BASE:
                self.extend_base(self.spare)
            if answer not in (OK, ENDED):
                raise StepFailed(_STOPS[answer], _STOPS[answer].value)

        failure = StepFailed(_STOPS[answer], _STOPS[answer].value)
        try:
            in_halves(take, None, self.motion.whole["ground"][0].copy(), ground, self.hht, self.max_cuts, failure, self._count_cut)
        except BaseException as error:
            motions.copy(saved, self.motion)
            self.ledger[:] = booked
            if isinstance(error, StepFailed):
                raise StepFailed(error.stop, f"t = {self.motion.time:.6g} s: {error}") from None
            raise

    def _count_cut(self) -> None:
        self.counts[N_CUTS] += 1

    def _scheme(self, hht):
        if hht not in self._schemes:
            self._schemes[hht] = scheme(self.structure, self.points, hht)
        return self._schemes[hht]

    def extend_base(self, motion) -> None:
        """Make the base's compliance known under the foot and two rows of its nodes around."""
        self.base.need(self.base.grid.around(motion.frames["center"][0] + self.model.arms @ motion.rotation[0].T, 2))
        self.surface = base_for_steps(self.base)
