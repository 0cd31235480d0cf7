"""The reduced engine: advances a reduced column by many steps at a time."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import compile_for, njit
from fecolumn.dynamics.hht import HHT
from fecolumn.dynamics.overturning import STANDS, steepest_to_come
from fecolumn.dynamics.stage import Stop
from fecolumn.dynamics.stepper import Record, StepFailed
from fecolumn.reduced import motion as motions
from fecolumn.reduced.bed import no_bed
from fecolumn.reduced.equilibrium import CONTACT, ENDED, FAR_BASE, IMPACT, ITERATIONS, N_CUTS, N_ITERATIONS, OFF_BASE, OK, equilibrate
from fecolumn.reduced.ledger import N_PLACES, kinetic, strain, weight_energy
from fecolumn.reduced.model import scheme, step_column
from fecolumn.reduced.motion import TIME, Sway
from fecolumn.reduced.observe import ENERGY, WIDTH, lost, observe
from fecolumn.reduced.plate import no_footing, plate_of
from fecolumn.reduced.points import node_points
from fecolumn.reduced.step import step

# of the halves of a step, whose end alone counts: nothing is past returning
_NO_END = np.array([np.inf])
_STOPS = {CONTACT: Stop.CONTACT, IMPACT: Stop.CONTACT, ITERATIONS: Stop.ITERATIONS, OFF_BASE: Stop.OFF_BASE}


@njit
def ended(eye, motion, row, steepest, rest):
    """Whether the column is lost or at rest after a step."""
    return lost(eye, motion, row, steepest) != STANDS or row[ENERGY] + row[ENERGY + 1] + row[ENERGY + 2] <= rest


@njit
def advance(column, plate, scheme, points, footing, bed, eye, motion, spare, sway, grounds, steepest, rest, rows, ledger, record):
    """Steps of one chunk: steps made and why it ended; `motion` is the state after them, rows (k, WIDTH) are filled.

    steepest: (k,) as of `overturning.fallen` after each step. rest: mechanical energy [J] at which the column is at rest; -inf not to ask.

    Without any step to make: one proximal step of `scheme` towards gravity equilibrium, from `motion` to `spare`; see `start.standing`.
    It is here because each function that Python calls is compiled with all it calls: the contact solver is wanted once.
    """
    if len(grounds) == 0:
        fall, still = motion.center + scheme.half * column.gravity, np.zeros(3)
        return 0, equilibrate(column, plate, scheme, points, footing, bed, motion, fall, motion.modal, still, spare, sway, record)
    booked, now, then, made, answer = ledger.copy(), motion, spare, 0, OK
    for k in range(len(grounds)):
        before = record[N_ITERATIONS]
        booked[:] = ledger
        answer = step(column, plate, scheme, points, footing, bed, now, grounds[k], then, sway, ledger, record)
        if answer != OK:
            ledger[:] = booked
            break
        observe(column, eye, then, ledger, record[N_ITERATIONS] - before, rows[made])
        now, then, made = then, now, made + 1
        if ended(eye, now, rows[made - 1], steepest[k], rest):
            answer = ENDED
            break
    if made % 2:
        # a step that failed for want of the base's compliance tells by its end in `spare` where it is wanted
        center, rotation = motion.center.copy(), motion.rotation.copy()
        motions.copy(spare, motion)
        spare.center[:] = center
        spare.rotation[:] = rotation
    return made, answer


class Engine:
    """A reduced column on its base, its motion and its ledger.

    Args:
        model: ColumnModel.
        base: BasePlate, or another holder of its compliance with `grid`, `slot`, `compliance` and `need`.
        eye: View.
        hht: HHT.
        gravity, friction, own, rim, damping_ratio, restitution, rolling, pad: as of `model.step_column`.
        start: function of the engine that returns the first Motion; see `reduced.start`.
    """

    def __init__(self, model, base, eye, hht: HHT, gravity, friction: float, own, rim, start, max_cuts: int = 4,
                 damping_ratio: float = 0.0, restitution: float = 0.0, rolling: float = 0.0, pad=None):
        self.model, self.base, self.eye, self.hht, self.max_cuts = model, base, eye, hht, max_cuts
        self.column = step_column(model, hht, gravity, friction, own, rim, damping_ratio, restitution, rolling, pad)
        n, m = len(model.arms), len(model.frequencies)
        self.points, self.footing, self.spare = node_points(model.arms), no_footing(n), motions.at_rest(n, m)
        self.sway = Sway(np.zeros(3), np.zeros(3), np.zeros(m), np.eye(3), np.zeros(3))
        self.bed, self._schemes = no_bed(n), {}
        self.counts = np.zeros(6, np.int64)
        self.base.need(np.unique(base.grid.project(model.reference)[0]))
        self.plate = plate_of(base)
        self.ledger = np.zeros(N_PLACES)
        compile_for(advance, self._arguments(self._scheme(hht), self.spare, self.spare))
        self.motion = start(self)
        self.ledger[0] = self.mechanical()

    def settle(self, scheme, motion, end) -> int:
        """One proximal step of `scheme` towards gravity equilibrium, from `motion` to `end`: a way to end."""
        return advance(*self._arguments(scheme, motion, end))[1]

    def _arguments(self, scheme, motion, spare, grounds=np.empty((0, 3)), steepest=np.empty(0), rest=-np.inf, rows=np.empty((0, WIDTH))) -> tuple:
        return (self.column, self.plate, scheme, self.points, self.footing, self.bed, self.eye, motion, spare, self.sway, grounds, steepest, rest,
                rows, self.ledger, self.counts)

    @property
    def record(self) -> Record:
        """Counts as the full-order engine gives them."""
        return Record(*self.counts[:4].tolist())

    def mechanical(self) -> float:
        """Kinetic, strain and gravity energy now [J]."""
        motion, column = self.motion, self.column
        return kinetic(column, motion) + strain(column, motion) + weight_energy(column, self.eye.center, motion)

    def row(self) -> np.ndarray:
        """The present row (WIDTH,) of the history."""
        row = np.empty(WIDTH)
        observe(self.column, self.eye, self.motion, self.ledger, 0, row)
        return row

    def advance(self, grounds: np.ndarray, steepest: np.ndarray | None = None, rest: float = -np.inf) -> tuple[np.ndarray, bool]:
        """Step under ground accelerations (k, 3) [m/s2] at the ends of the steps: rows (k', WIDTH) and whether the column is lost or at rest.

        Args:
            grounds: (k, 3).
            steepest: (k,) as of `overturning.steepest_to_come`; of these grounds alone unless given.
            rest: mechanical energy at which the column is at rest, and the steps end [J].

        Raises:
            StepFailed: no convergence after max_cuts halvings, or the column left the base; the motion is that before the step, the
                rows of the steps made are in `made`.
        """
        grounds, done = np.array(grounds, float), 0
        steepest = steepest_to_come(self.column.gravity, grounds) if steepest is None else np.asarray(steepest, float)
        rows = np.empty((len(grounds), WIDTH))
        self.made = rows[:0]
        while done < len(grounds):
            made, answer = self._steps(self.hht, grounds[done:], rows[done:], steepest[done:], rest)
            done += made
            if answer == ENDED:
                return rows[:done], True
            if answer != OK:
                saved, booked = self._save(), self.ledger.copy()
                try:
                    self._cut(grounds[done], self.hht, answer, 0)
                except StepFailed:
                    self.made = rows[:done]
                    motions.copy(saved, self.motion)
                    self.ledger[:] = booked
                    raise
                observe(self.column, self.eye, self.motion, self.ledger, 0, rows[done])
                done += 1
                if ended(self.eye, self.motion, rows[done - 1], steepest[done - 1], rest):
                    return rows[:done], True
        return rows, False

    def _steps(self, hht, grounds, rows, steepest, rest) -> tuple[int, int]:
        """Steps of `hht` until one fails for a reason other than a base not known yet."""
        done = 0
        while True:
            made, answer = advance(*self._arguments(self._scheme(hht), self.motion, self.spare, grounds[done:], steepest[done:], rest, rows[done:]))
            done += made
            if answer != FAR_BASE:
                return done, answer
            self.extend_base(self.spare)

    def _cut(self, ground, hht, answer, cuts) -> None:
        """The step that failed with `answer`, in two halves."""
        if cuts == self.max_cuts or answer == OFF_BASE:
            cut = f" (step cut {cuts} times to {hht.dt:.3g} s)" if cuts else ""
            raise StepFailed(_STOPS[answer], f"t = {self.motion.scalars[TIME]:.6g} s: {_STOPS[answer].value}{cut}")
        self.counts[N_CUTS] += 1
        half, row = HHT(hht.dt / 2, hht.alpha), np.empty((1, WIDTH))
        for target in ((self.motion.ground + ground) / 2, ground):
            _, answer = self._steps(half, target[None], row, _NO_END, -np.inf)
            if answer not in (OK, ENDED):
                self._cut(target, half, answer, cuts + 1)

    def _scheme(self, hht):
        if hht not in self._schemes:
            self._schemes[hht] = scheme(self.column, hht)
        return self._schemes[hht]

    def _save(self):
        saved = motions.at_rest(len(self.model.arms), len(self.model.frequencies))
        motions.copy(self.motion, saved)
        return saved

    def extend_base(self, motion) -> None:
        """Make the base's compliance known under the foot and two rows of its nodes around."""
        grid = self.base.grid
        places = motion.center + self.model.arms @ motion.rotation.T
        nodes, _ = grid.project(places, np.zeros(len(places), bool))
        where = np.empty((len(self.base.slot), 2), np.int64)
        where[grid.number.ravel()] = np.stack(np.unravel_index(np.arange(grid.number.size), grid.number.shape), axis=1)
        around = np.stack(np.meshgrid(np.arange(-2, 3), np.arange(-2, 3)), axis=-1).reshape(-1, 2)
        wanted = where[np.unique(nodes)][:, None] + around
        wanted = np.clip(wanted, 0, np.array(grid.number.shape) - 1).reshape(-1, 2)
        self.base.need(np.unique(grid.number[wanted[:, 0], wanted[:, 1]]))
        self.plate = plate_of(self.base)
