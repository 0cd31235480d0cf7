"""integration.dt_s = "auto": the longest step at which what rocking loses at the case's own first
impacts hardly changes when the step is halved.

A single impact of an elastic body scatters with where in the step it lands (theory, section 4), so
that each step is judged by the mean of a few starts, shifted by parts of a step against each other.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.case.case import Case
from fecolumn.case.sections import TRIAL_STEPS
from fecolumn.engines.analysis import Analysis, AnalysisFailed
from fecolumn.engines.ending import OVERTURNED, SLID_OFF
from fecolumn.engines.trial_run import trial
from fecolumn.foundation.schema import InputError

#: Change by half the step, over the value at half the step, of the mean loss at the first impacts
#: and of the largest tilt after them, below which a step is taken; and standard error of that
#: change above which it cannot be told. Chosen: the loss of a single impact of elastic bodies
#: scatters by as much with where in the step it lands.
SAME = 0.05
#: Starts of each step, shifted by so many parts of it. Chosen: four tell the mean to half the
#: scatter of one.
STARTS = 4
#: Impacts that are looked at, the time [s] within which the first must come, and the time [s] from
#: then on within which the others must: they bound what the trials cost.
IMPACTS, FIRST_S, OTHERS_S = 3, 10.0, 2.0
#: Step [s] where nothing lands in that time: the default of integration.dt_s, nothing being known.
UNTRIED = 1e-3
# Energy that impacts take in a step, over that to overturn, from which on something has landed:
# what a body loses that rocks at a thousandth of its critical tilt
_LANDS = 1e-6
# Time [s] without a landing after which the next is of another impact: ten of the longest steps
_APART_S = 0.02
# Part of the time between impacts that is left out at either end, where trials may still land
_LEFT_OUT = 0.25


@dataclass(frozen=True, slots=True)
class Window:
    """What trials look at: times [s] of the first landing, and between which the tilt after the
    impacts is taken, the latter the end; and the number of impacts.
    """

    lands: float
    begins: float
    ends: float
    impacts: int


@dataclass(frozen=True, slots=True)
class TrialResult:
    """A step [s] and what its starts gave, (starts,) each: loss at the impacts, over the rigid loss
    or in joules, and largest tilt after them [rad]; how many starts were lost or failed by then.
    """

    dt: float
    loss: np.ndarray
    tilt: np.ndarray
    lost: int

    def told(self) -> dict:
        """Of the summary."""
        scatter = self.loss.std(ddof=1) / self.loss.mean() if self.loss.size > 1 else 0.0
        return dict(
            dt_s=self.dt,
            loss=float(self.loss.mean()) if self.loss.size else None,
            loss_scatter=float(scatter) if np.isfinite(scatter) else None,
            tilt_after_rad=float(self.tilt.mean()) if self.tilt.size else None,
            lost=self.lost,
        )


def change(longer: TrialResult, shorter: TrialResult) -> tuple[float, float, float]:
    """Changes of mean loss and of mean tilt from a step to a shorter one, over the latter, and the
    standard error of the first; infinite where starts ended differently.
    """
    if longer.lost or shorter.lost:
        every = longer.lost == shorter.lost == STARTS
        return (0.0, 0.0, 0.0) if every else (np.inf, np.inf, np.inf)
    scale = shorter.loss.mean()
    error = np.sqrt((longer.loss.var(ddof=1) + shorter.loss.var(ddof=1)) / STARTS)
    if scale <= 0:
        return np.inf, np.inf, np.inf
    return (
        float(abs(longer.loss.mean() - scale) / scale),
        float(abs(longer.tilt.mean() / shorter.tilt.mean() - 1)),
        float(error / scale),
    )


def window_of(rows: dict[str, np.ndarray], barrier_j: float) -> Window | None:
    """The first impacts in the columns of a history; None where nothing lands in time.

    barrier_j: energy to overturn [J].
    """
    now = rows["time"]
    took = np.diff(-rows["energy/impact"], prepend=-rows["energy/impact"][0])
    landings = now[took > _LANDS * barrier_j]
    if not landings.size or landings[0] > FIRST_S:
        return None
    first = np.flatnonzero(np.diff(landings, prepend=-np.inf) > _APART_S)
    last = np.append(first[1:], landings.size) - 1
    begins, ends = landings[first], landings[last]
    first_s = float(begins[0])
    limit = min(float(now[-1]), first_s + OTHERS_S)
    number = int(np.count_nonzero(begins <= limit))
    if number > IMPACTS:
        limit, number = min(limit, float(begins[IMPACTS])), IMPACTS
    end = min(float(ends[number - 1]), limit)
    if end == limit:  # still landing: the tilt of the last part
        return Window(first_s, limit - _LEFT_OUT * (limit - first_s), limit, number)
    left_out = _LEFT_OUT * (limit - end)
    return Window(first_s, end + left_out, limit - left_out, number)


class StepChoice:
    """Trials of a case that choose its step.

    Parameters
    ----------
    case, file
        whose step is to be chosen, and its file, for messages.
    begin
        makes the analysis of a case in a folder.
    stop
        whether to raise KeyboardInterrupt.
    """

    def __init__(
        self,
        case: Case,
        file: str,
        begin: Callable[[Case, Path], Analysis],
        stop: Callable[[], bool],
    ):
        self._file, self._begin, self._stop = file, begin, stop
        self._case, self._id = case, case.id
        self._steps = 0

    def chosen(self, say: Callable[[str], None]) -> dict:
        """How the step is chosen, of the summary; `say` takes lines of words."""
        began, allowed = time.perf_counter(), self._allowed()
        first, allowed = self._first(allowed)
        found = window_of(first.history.arrays(), first.barrier_j)
        share = first.rigid_loss_share() is not None
        results: list[TrialResult] = []
        changes: list[tuple[float, float, float]] = []
        if found:
            most = sum(round(STARTS * found.ends / dt) for dt in allowed)
            say(f"choosing integration.dt_s: trials of {found.ends:.3g} s, {most:,} steps at most")
        for dt in allowed if found else ():
            results.append(self._result(dt, found, share))
            if len(results) > 1:
                changes.append(change(*results[-2:]))
                if max(changes[-1]) < SAME:
                    break
        converged = bool(changes) and max(changes[-1]) < SAME
        dt = results[-2 if converged else -1].dt if results else min(UNTRIED, allowed[0])
        told = dict(
            case_id=self._id,
            dt_s=dt,
            converged=converged,
            loss_is="rigid_loss_share" if share else "energy_j",
            impacts=found.impacts if found else 0,
            until_s=found.ends if found else None,
            loss_change=_number(changes, 0),
            tilt_change=_number(changes, 1),
            loss_change_error=_number(changes, 2),
            same=SAME,
            starts=STARTS,
            trials=[one.told() for one in results],
            steps=self._steps,
            wall_s=time.perf_counter() - began,
        )
        told["said"] = _sentence(told, changes[-1] if changes else None)
        say(told["said"])
        return told

    def _allowed(self) -> list[float]:
        """Steps that the case's motions take, the longest first."""
        from fecolumn.motions.load import load_motion

        motions = [self._case.motion, *(one.motion for one in self._case.grounds.values())]
        found, refused = [], None
        for dt in TRIAL_STEPS:
            try:
                for motion in filter(None, motions):
                    load_motion(motion, dt, self._file)
            except InputError as error:
                refused = error
            else:
                found.append(dt)
        if refused and not found:
            raise refused
        return found

    def _at(self, dt: float, shift: float, lands: float) -> Case:
        """The case at a step, begun a share of it earlier: its motion so much later, or, at rest,
        a step so little shorter that the first landing, at `lands` [s], comes so much later in it.
        """
        case = self._case
        keys = {
            "integration.dt_s": dt,
            "output.states_every_s": 0.0,
            "output.fields_every_s": 0.0,
        }
        if shift and case.motion:
            keys["motion.delay_s"] = case.motion.delay_s + shift * dt
        elif shift:
            keys["integration.dt_s"] = dt / (1 + shift * dt / lands)
        return case.replace(keys)

    def _trial(self, dt: float, shift: float, until_s: float, lands=0.0):
        """The first steps, and how they ended; None where one does not converge."""
        case = self._at(dt, shift, lands)
        try:
            made, outcome = trial(
                lambda folder: self._begin(case, folder), until_s=until_s, stop=self._stop
            )
        except AnalysisFailed:
            return None
        self._steps += made.step
        return made, outcome

    def _first(self, allowed: list[float]) -> tuple[Analysis, list[float]]:
        """A trial at the longest step that converges, and the steps from there on."""
        for place, dt in enumerate(allowed):
            if made := self._trial(dt, 0.0, FIRST_S + OTHERS_S):
                return made[0], allowed[place:]
        raise AnalysisFailed(
            f"{self._file}: integration.dt_s = 'auto': no trial converges, at steps from "
            f"{allowed[0]:g} to {allowed[-1]:g} s; state a shorter step"
        )

    def _result(self, dt: float, window: Window, share: bool) -> TrialResult:
        """All starts of a step; share: whether the loss is that over the rigid loss."""
        loss, tilt, lost = [], [], 0
        for k in range(STARTS):
            found = self._trial(dt, k / STARTS, window.ends, window.lands)
            if found is None or found[1] in (OVERTURNED, SLID_OFF):
                lost += 1
                continue
            rows = found[0].history.arrays()
            taken = -float(rows["energy/impact"][-1] + rows["energy/friction"][-1])
            loss.append((found[0].rigid_loss_share() or 0.0) if share else taken)
            late = rows["time"] >= min(window.begins, rows["time"][-1])
            tilt.append(rows["tilt"][late].max())
        return TrialResult(dt, np.array(loss), np.array(tilt), lost)


def _number(changes: list[tuple[float, float, float]], place: int) -> float | None:
    """Of the last change, where it is a number."""
    return changes[-1][place] if changes and np.isfinite(changes[-1][place]) else None


def _sentence(told: dict, last: tuple[float, float, float] | None) -> str:
    """Why this step, in words."""
    step = f"dt_s = auto: {told['dt_s']:g} s"
    if not told["impacts"]:
        return (
            f"{step}, the default: nothing lands in the first {FIRST_S:g} s, so that no step could "
            "be tried"
        )
    impacts = f"the first {told['impacts']} impacts" if told["impacts"] > 1 else "the first impact"
    if last is None:
        return f"{step}, the only one that the motion takes: nothing was compared"
    if not np.isfinite(last[0]):
        return f"{step}, the shortest tried: NOT converged, trials of {impacts} end differently"
    changed = f"the loss at {impacts} changes by {100 * last[0]:.2g} %"
    after = f"the tilt after by {100 * last[1]:.2g} %"
    if told["converged"]:
        return f"{step}, as {changed} at half of it, {after}"
    return (
        f"{step}, the shortest tried: NOT converged, {changed} from twice that step, {after} (means "
        f"of {STARTS} starts, standard error {100 * last[2]:.2g} %); compare many motions, not one"
    )
