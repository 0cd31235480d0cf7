"""The driver of a study: hands the missing analyses to workers and keeps the ledger."""

from __future__ import annotations

import collections
import dataclasses
import sqlite3
import sys
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TextIO

from fecolumn.case.sections import UNTIL_REST, Motion
from fecolumn.engines.pace import PACE_FILE as PACE
from fecolumn.foundation.atomic import disk_full
from fecolumn.foundation.files import Unreadable, read_json
from fecolumn.study.mixture import other_code
from fecolumn.study.outcome import DISK_FULL, RETURNED, TaskOutcome
from fecolumn.study.plan import Plan, PlannedAnalysis
from fecolumn.study.pool import LocalPool
from fecolumn.study.preparation import preparation
from fecolumn.study.progress import StudyProgress, analysis_s
from fecolumn.study.store import FAILED, PLANNED, RUNNING, Store
from fecolumn.study.team import StudyError, Team

__all__ = ["ENTRY", "StudyError", "check_motions", "complete_study", "stop_code"]

ENTRY = "fecolumn.simulation:run"

# Work handed out at a time: less would keep driver and workers busy with messages, more would leave
# some idle at the end
_BATCH_S, _BATCH_MOST = 0.5, 200
# Free vibration that is reckoned with where it goes on until the column is at rest: a column of a
# metre or two takes seconds
_TO_REST_S = 10.0
_DISK_FULL = "the disk is full; free room"
# Warnings of motions that are told one by one: as many as can be read at a glance
_TOLD = 3


def complete_study(
    plan: Plan,
    folder: Path | str,
    *,
    workers: int | Team = 1,
    entry: str = ENTRY,
    retry_failed: bool | set[str] = False,
    stream: TextIO | None = sys.stderr,
    share: tuple[int, int] | None = None,
    only: set[str] | None = None,
) -> list[dict[str, Any]]:
    """Do what is missing of a study, and return the ledger.

    An analysis that fails, or takes its worker down with it, is recorded with its reason and the
    rest goes on. Stopping by any means (Ctrl-C, kill -9, power) loses only the analyses in flight;
    the next call does what is missing.

    Parameters
    ----------
    plan
        the study.
    folder
        where its ledger and results are or will be.
    workers
        number of analyses at a time, each in a process of its own with one thread; or a team that
        does the work instead, such as the ranks of MPI.
    entry
        "module:function" of the analysis, called as run(case, folder, comm=MPI.COMM_SELF, file=...,
        quiet=True); it writes folder/summary.json atomically.
    retry_failed
        whether analyses that failed before are run again; a set of ids: those of them alone.
    stream
        where the progress line goes; None for no progress, and warnings on stderr.
    share
        (index, size) of a task of a job array; it does every size-th analysis only. Tasks may work
        in one folder at once.
    only
        ids of the analyses to do; the others stay planned.

    Returns
    -------
    One dict an analysis in the order of the study file, see `store.Study.rows`; with `share`
        only its own.

    Raises
    ------
    InputError
        the folder is not this study's, or another driver works in it.
    StudyError
        workers cannot start, the disk is full, or the ledger cannot be written.
    KeyboardInterrupt
        Ctrl-C; the workers are stopped and the ledger is closed.
    """
    try:
        with Store(folder, plan, entry, share) as store:
            if retry_failed:
                chosen = only if retry_failed is True else retry_failed
                failed = store.ledger.in_state(FAILED)
                store.ledger.plan_again(*(one for one in failed if chosen is None or one in chosen))
            if entry == ENTRY and (told := other_code(store.rows())):
                print(told, file=stream or sys.stderr, flush=True)
            if isinstance(workers, int):
                workers = LocalPool(workers, entry, plan.file)
            drive(store, workers, stream, only)
            done: list[dict[str, Any]] = store.rows()
            return done
    except sqlite3.DatabaseError as error:
        raise StudyError(_ledger_fault(error, folder)) from None
    except OSError as error:
        if disk_full(error):
            raise StudyError(_DISK_FULL) from None
        raise


def _ledger_fault(error: sqlite3.DatabaseError, folder: Path | str) -> str:
    """What keeps SQLite from writing a study's ledger, and what helps.

    A quota and a limit on the size of files are a fault of writing to it, and no full disk.
    """
    if "full" in str(error):
        return _DISK_FULL
    if getattr(error, "sqlite_errorname", "") == "SQLITE_IOERR_WRITE":
        told = "the disk is full, a quota or a limit on the size of files is reached, or the disk"
        return f"{told} is at fault (the ledger of {folder}: {error}); free room"
    return f"the ledger of {folder} cannot be written ({error})"


def drive(
    store: Store, team: Team, stream: TextIO | None, only: set[str] | None = None
) -> StudyProgress:
    """Have a team do what is missing in a study's folder, or of the ids `only`; the counts, of
    which `stream` is told.
    """
    queue = collections.deque(
        analysis for analysis in store.missing(team.size) if only is None or analysis.id in only
    )
    counts = store.ledger.counts()
    if only is not None:  # what nobody asks for yet is not counted
        counts[PLANNED] = len(queue)
    progress = StudyProgress(
        counts, sum(a.effort for a in queue), min(team.size, len(queue)), stream
    )
    try:
        _work_off(store, queue, team, progress)
    finally:
        team.stop()
        progress.end()
        store.ledger.plan_again(*store.ledger.in_state(RUNNING))  # what a stop has left
        store.ledger.commit()
    return progress


def stop_code(error: KeyboardInterrupt | StudyError) -> int:
    """Tell the user what ended the work before its end; the exit code."""
    by_hand = isinstance(error, KeyboardInterrupt)
    said = "stopped; what is done is kept" if by_hand else f"{error}; nothing done is lost"
    print(f"{said}, the same command does the rest", file=sys.stderr, flush=True)
    return 130 if by_hand else 1


def check_motions(plan: Plan) -> None:
    """Load every ground motion once, before anything runs, and note how long its analyses are.

    Raises
    ------
    InputError
        a motion that cannot be used, in the loader's words.
    """
    from fecolumn.engines.ending import cut_text
    from fecolumn.motions.load import load_motion

    # the direction changes neither length nor whether it can be used; the largest factor and the
    # longest step are the most demanding
    longest_step: dict[Motion, float] = {}
    largest: dict[Motion, float] = {}
    users: dict[Motion, list[PlannedAnalysis]] = {}
    for analysis in plan.analyses:
        for motion in analysis.case.motions:
            key = dataclasses.replace(motion, scale=float(motion.scale != 0), rotation_deg=0.0)
            largest[key] = max(largest.get(key, 0.0), motion.scale, key=abs)
            longest_step[key] = max(
                longest_step.get(key, 0.0), float(analysis.case.integration.dt_s)
            )
            users.setdefault(key, []).append(analysis)
    told: dict[str, warnings.WarningMessage] = {}
    # by analysis: how long the longest of its motions lasts, and the step by which it is read [s]
    lasts: dict[str, tuple[float, float]] = {}
    for motion, dt_s in longest_step.items():
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            scaled = dataclasses.replace(motion, scale=largest[motion])
            ground = load_motion(scaled, dt_s, plan.file)
        told |= {str(warning.message): warning for warning in said}
        for analysis in users[motion]:
            lasts[analysis.id] = max(lasts.get(analysis.id, (0.0, 0.0)), (ground.duration, dt_s))
    cut = []
    for analysis in plan.analyses:
        if analysis.id not in lasts:
            continue
        given, (length, dt_s) = analysis.case.integration.duration_s, lasts[analysis.id]
        analysis.duration_s = given or length + _free_vibration(analysis.case.motion)
        if given and given < length - dt_s:
            cut.append((length, given))
    _tell(list(told.values()), plan.file)
    if cut:
        length, given = max(cut)
        warnings.warn(
            f"{cut_text(plan.file, given, length)} ({len(cut)} of {len(plan.analyses)} "
            "analyses are cut)",
            stacklevel=2,
        )


def _free_vibration(motion: Motion | None) -> float:
    """How long an analysis is taken to go on after its motion [s]."""
    if motion is None:
        return 0.0
    free = motion.longest_free_vibration_s
    return min(_TO_REST_S, free) if motion.free_vibration_s == UNTIL_REST else free


def _tell(told: list[warnings.WarningMessage], file: Path) -> None:
    """Tell the first warnings of many motions, and how many more there are."""
    for warning in told[:_TOLD]:
        warnings.warn(warning.message, warning.category, stacklevel=3)
    if len(told) > _TOLD:
        warnings.warn(
            f"{file}: further warnings of its motions that are left out here: {len(told) - _TOLD}; "
            "fecolumn motions info tells those of one motion",
            stacklevel=3,
        )


def _work_off(
    store: Store, queue: collections.deque[PlannedAnalysis], team: Team, progress: StudyProgress
) -> None:
    pace = _Pace()
    given: dict[str, PlannedAnalysis] = {}
    while queue or team.at_work:
        while queue and team.wants(2 if pace.seconds(queue[0]) < _BATCH_S else 1):
            batch = pace.batch(queue, team.size)
            given |= {analysis.id: analysis for analysis in batch}
            store.ledger.begin(analysis.id for analysis in batch)
            store.ledger.commit_now_and_then()
            team.give([store.task(analysis) for analysis in batch])
        for outcome in team.collect(timeout_s=0.5):
            analysis = given.pop(outcome.id)
            if outcome.word == DISK_FULL:
                raise StudyError(f"{_DISK_FULL} ({outcome.reason})")
            if outcome.word == RETURNED:
                queue.appendleft(analysis)
                store.ledger.plan_again(outcome.id)
                continue
            store.end(outcome)
            progress.count(outcome, analysis.effort)
            pace.note(outcome, analysis)
        store.ledger.commit_now_and_then()
        if not progress.ended:
            _foresee(store, given.values(), progress)
        progress.show("" if progress.ended or store.entry != ENTRY else preparation(given.values()))


def _foresee(store: Store, given: Iterable[PlannedAnalysis], progress: StudyProgress) -> None:
    """Tell how long the analyses at work will take, as far as one of them knows its pace."""
    for analysis in given:
        try:
            found = read_json(store.result_folder(analysis.id) / PACE)
            whole_s, cheaper = float(found["whole_s"]), str(found["cheaper"])
        except (OSError, Unreadable, KeyError, TypeError, ValueError):
            continue
        progress.foresee(whole_s, analysis.effort, cheaper)
        return


class _Pace:
    """How long analyses take, learnt from those that have ended; none is known before the first."""

    def __init__(self) -> None:
        self._s_per_effort: float | None = None

    def note(self, outcome: TaskOutcome, analysis: PlannedAnalysis) -> None:
        if outcome.started is not None:
            s = analysis_s(outcome) / analysis.effort
            self._s_per_effort = (
                s if self._s_per_effort is None else 0.8 * self._s_per_effort + 0.2 * s
            )

    def seconds(self, analysis: PlannedAnalysis) -> float:
        """Expected wall time [s]."""
        return float("inf") if self._s_per_effort is None else self._s_per_effort * analysis.effort

    def batch(
        self, queue: collections.deque[PlannedAnalysis], workers: int
    ) -> list[PlannedAnalysis]:
        """The next analyses of the queue, at least one, worth half a second, but no more than a
        fair share of what is left.
        """
        most = min(_BATCH_MOST, max(1, len(queue) // (2 * workers)))
        batch = [queue.popleft()]
        expected = self.seconds(batch[0])
        while (
            queue
            and len(batch) < most
            and (expected := expected + self.seconds(queue[0])) < _BATCH_S
        ):
            batch.append(queue.popleft())
        return batch
