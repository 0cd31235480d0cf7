"""integration.dt_s = "auto": the longest step at which what rocking loses at the case's own first
impacts hardly changes when the step is halved.

A single impact of an elastic body scatters with where in the step it lands (theory, section 4), so
that each step is judged by the mean of a few starts, shifted by parts of a step against each other.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.case.case import Case
from fecolumn.case.sections import TRIAL_STEPS
from fecolumn.engines.analysis import Analysis, AnalysisFailed
from fecolumn.engines.ending import OVERTURNED, SLID_OFF
from fecolumn.engines.first_impacts import (
    FIRST_S,
    OTHERS_S,
    SAME_STEP,
    STARTS,
    Changes,
    TrialResult,
    Window,
    change,
    know_share,
    window_of,
)
from fecolumn.engines.trial_run import trial
from fecolumn.foundation.progress import clock
from fecolumn.foundation.schema import InputError

#: Step [s] where nothing lands in that time: the default of integration.dt_s, nothing being known.
UNTRIED = 1e-3


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
    ) -> None:
        self._file, self._begin, self._stop = file, begin, stop
        self._case, self._id = case, case.id
        self._steps = 0

    def chosen(self, say: Callable[[str], None]) -> dict[str, Any]:
        """How the step is chosen, of the summary; `say` takes lines of words."""
        began, allowed = time.perf_counter(), self._allowed()
        first, allowed = self._first(allowed)
        found = window_of(first.history.arrays(), first.barrier_j)
        results: list[TrialResult] = []
        half: Changes | None = None
        limit: Changes | None = None
        dt = min(UNTRIED, allowed[0])
        if found:
            most = sum(round(STARTS * found.ends / dt) for dt in allowed)
            about = clock(most * first.stepping_s / max(first.step, 1))
            say(
                f"choosing integration.dt_s: trials of {found.ends:.3g} s, {most:,} steps at most, "
                f"about {about}"
            )
            results, half = self._compared(allowed, found)
            dt = results[-1].dt
        if found and half and max(half) < SAME_STEP:
            dt, place = results[-2].dt, len(results) - 2
            if results[-1].dt > allowed[-1]:
                results.append(self._result(allowed[-1], found))
            limit = change(results[place], results[-1])
        shares = know_share(results)
        told = dict(
            case_id=self._id,
            dt_s=dt,
            agrees_at_half=limit is not None if half else None,
            converged=limit is not None and max(limit) < SAME_STEP if half else None,
            loss_is="rigid_loss_share" if shares else "energy_j",
            impacts=found.impacts if found else 0,
            until_s=found.ends if found else float(first.history.last()["time"]),
            **_changes_told(half),
            loss_change_shortest=_changes_told(limit)["loss_change"],
            same=SAME_STEP,
            starts=STARTS,
            trials=[one.told(shares) for one in results],
            steps=self._steps,
            wall_s=time.perf_counter() - began,
        )
        said = _sentence(told, half, allowed[-1])
        say(said)
        return told | {"said": said}

    def _compared(
        self, allowed: list[float], window: Window
    ) -> tuple[list[TrialResult], Changes | None]:
        """Results of steps, each half of the one before, until two are the same; and the last
        change, None of one step alone.
        """
        results = [self._result(allowed[0], window)]
        changes = None
        for dt in allowed[1:]:
            results.append(self._result(dt, window))
            changes = change(*results[-2:])
            if max(changes) < SAME_STEP:
                break
        return results, changes

    def _allowed(self) -> list[float]:
        """Steps that the case's motions take, the longest first."""
        from fecolumn.motions.load import load_motion

        motions = [self._case.motion, *(one.motion for one in self._case.grounds.values())]
        found, refused = [], None
        for dt in TRIAL_STEPS:
            try:
                for motion in filter(None, motions):
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")  # the analysis tells what counts
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
        if shift and case.motions:
            if case.motion:
                keys["motion.delay_s"] = case.motion.delay_s + shift * dt
            for name, ground in case.grounds.items():
                if ground.motion:
                    later = ground.motion.delay_s + shift * dt
                    keys[f"grounds.{name}.motion.delay_s"] = later
        elif shift:
            keys["integration.dt_s"] = dt / (1 + shift * dt / lands)
        return case.replace(keys)

    def _trial(
        self, dt: float, shift: float, until_s: float, lands: float = 0.0
    ) -> tuple[Analysis, str] | None:
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
        """A trial at the longest step that the case takes, a pad for example, and at which it
        converges; and the steps from there on.
        """
        refused = None
        for place, dt in enumerate(allowed):
            try:
                if made := self._trial(dt, 0.0, FIRST_S + OTHERS_S):
                    return made[0], allowed[place:]
            except InputError as error:
                refused = error
        if refused:
            raise refused
        raise AnalysisFailed(
            f"{self._file}: integration.dt_s = 'auto': no trial converges, at steps from "
            f"{allowed[0]:g} to {allowed[-1]:g} s; state a shorter step"
        )

    def _result(self, dt: float, window: Window) -> TrialResult:
        """All starts of a step."""
        found, lost = [], 0
        for k in range(STARTS):
            made = self._trial(dt, k / STARTS, window.ends, window.lands)
            if made is None or made[1] in (OVERTURNED, SLID_OFF):
                lost += 1
                continue
            rows, known = made[0].history.arrays(), made[0].rigid_loss_share()
            taken = -float(rows["energy/impact"][-1] + rows["energy/friction"][-1])
            tilts = [
                rows[name] for name in rows if name.startswith("body/") and name[-5:] == "/tilt"
            ]
            tilted = np.max([rows["tilt"], *tilts], axis=0)
            late = rows["time"] >= min(window.begins, rows["time"][-1])
            found.append(
                (np.nan if known is None else known, taken, tilted[late].max(), tilted.max())
            )
        share, energy, after, tilt = np.array(found).reshape(-1, 4).T
        return TrialResult(dt, share, energy, after, tilt, lost)


def _changes_told(changes: Changes | None) -> dict[str, float | None]:
    """The last changes of the summary, None where they are no numbers."""
    names = ("loss_change", "tilt_change", "loss_change_error")
    values = changes or (np.inf, np.inf, np.inf)
    return {key: one if np.isfinite(one) else None for key, one in zip(names, values, strict=True)}


def _sentence(told: dict[str, Any], last: Changes | None, shortest: float) -> str:
    """Why this step, in words; last: of `change`, shortest: step that could be tried [s]."""
    step = f"dt_s = auto: {told['dt_s']:g} s"
    if not told["impacts"]:
        why = "the default" if told["dt_s"] == UNTRIED else "the longest that the case takes"
        tried = min(FIRST_S, told["until_s"])
        return f"{step}, {why}: nothing lands in the first {tried:.3g} s, so that none was compared"
    impacts = f"the first {told['impacts']} impacts" if told["impacts"] > 1 else "the first impact"
    if last is None:
        return f"{step}, the only one of those tried that the case takes: none was compared"
    if not np.isfinite(last[0]):
        return f"{step}, the shortest tried: NOT converged, trials of {impacts} end differently"
    changed = f"the loss at {impacts} changes by {100 * last[0]:.2g} %"
    after = f"the tilt after by {100 * last[1]:.2g} %"
    if told["agrees_at_half"]:
        said = f"{step}, as {changed} at half of it, {after}"
        if told["converged"]:
            return said
        by = told["loss_change_shortest"]
        much = "trials end differently" if by is None else f"the loss changes by {100 * by:.2g} %"
        return f"{said}; NOT the limit of short steps: at {shortest:g} s {much}"
    return (
        f"{step}, the shortest tried: NOT converged, {changed} from twice that step, {after} "
        f"(means of {STARTS} starts, standard error {100 * last[2]:.2g} %); compare many motions, "
        "not one"
    )
