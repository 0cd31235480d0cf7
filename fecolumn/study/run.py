"""The driver of a study: hands the missing analyses to worker processes and keeps the ledger."""

from __future__ import annotations

import collections
import sys
from multiprocessing.connection import wait

from fecolumn.study.plan import Analysis, Plan
from fecolumn.study.progress import Progress
from fecolumn.study.store import FAILED, PLANNED, Store
from fecolumn.study.worker import BROKEN, ENDED, READY, Worker

ENTRY = "fecolumn.simulation:run"


class StudyError(RuntimeError):
    """The study as a whole cannot go on, for example because no worker can start."""


def run_study(plan: Plan, folder, *, workers: int = 1, entry: str = ENTRY, retry_failed: bool = False,
              stream=sys.stderr) -> list[dict]:
    """Do what is missing of a study, and return the ledger.

    An analysis that fails, or takes its worker down with it, is recorded with its reason and the rest goes on. Stopping
    by any means (Ctrl-C, kill -9, power) loses only the analyses in flight; the next call does what is missing.

    Args:
        plan: the study.
        folder: where its ledger and results are or will be.
        workers: number of analyses at a time, each in a process of its own with one thread.
        entry: "module:function" of the analysis, called as run(case, folder, comm=MPI.COMM_SELF, file=..., quiet=True);
            it writes folder/summary.json atomically.
        retry_failed: whether analyses that failed before are run again.
        stream: where the progress line goes.

    Returns:
        One dict an analysis in the order of the study file: id, axes, state, reason, wall_s, version, summary.

    Raises:
        InputError: the folder is not this study's, or another driver works in it.
        StudyError: workers cannot start.
        KeyboardInterrupt: Ctrl-C; the workers are stopped and the ledger is closed.
    """
    with Store(folder, plan, entry) as store:
        if retry_failed:
            store.plan_again(FAILED)
        states = store.states()
        missing = [a for a in plan.analyses if states[a.id] == PLANNED]
        queue = collections.deque(sorted(missing, key=lambda a: -a.effort))  # longest first: no straggler at the end
        progress = Progress(plan, store.rows(), stream)
        team = [Worker(entry) for _ in range(min(workers, len(queue)))]
        try:
            _work_off(plan, store, queue, team, entry, progress)
        finally:
            for worker in team:
                worker.stop()
            progress.end()
        return store.rows()


def check_motions(plan: Plan) -> None:
    """Load every ground motion once with every step it is run with, before anything runs.

    Raises:
        InputError: a motion that cannot be used, in the loader's words.
    """
    from fecolumn.motions.load import load_motion

    pairs = dict.fromkeys((a.case.motion, a.case.integration.dt_s) for a in plan.analyses if a.case.motion)
    for motion, dt_s in pairs:
        load_motion(motion, dt_s, plan.file)


def _work_off(plan: Plan, store: Store, queue: collections.deque[Analysis], team: list[Worker], entry: str, progress) -> None:
    while queue or any(worker.task for worker in team):
        for worker in team:
            if queue and worker.ready and not worker.task:
                analysis = queue.popleft()
                store.start(analysis.id)
                _give(worker, analysis, store, plan)
        progress.show()
        answered = wait([worker.connection for worker in team], timeout=1.0)
        for worker in [worker for worker in team if worker.connection in answered]:
            if not _answer(worker, store, progress):
                worker.stop()
                team.remove(worker)
                team.extend([Worker(entry)] if queue else [])


def _give(worker: Worker, analysis: Analysis, store: Store, plan: Plan) -> None:
    try:
        worker.send(analysis.id, analysis.case, store.result_folder(analysis.id), store.log_file(analysis.id), plan.file)
    except OSError:
        pass  # it died while idle; its connection is at its end, and the next wait says so


def _answer(worker: Worker, store: Store, progress) -> bool:
    """Take a worker's answer into the ledger; False where the worker is gone."""
    try:
        word, reason = worker.receive()
    except (EOFError, OSError):
        word, reason = None, worker.epitaph()
    if word == BROKEN or (word is None and not worker.ready):
        raise StudyError(f"a worker could not start: {reason}")
    if word == READY:
        worker.ready = True
        return True
    if worker.task:
        case_id, wall_s = worker.take()
        if word == ENDED:
            state = store.finish(case_id, wall_s)
        else:
            state = store.fail(case_id, reason, wall_s)
        progress.count(case_id, state, store.summary(case_id))
    return word is not None
