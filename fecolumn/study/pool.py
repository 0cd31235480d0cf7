"""Workers on this machine: processes of their own, spawned and watched by the driver."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import queue
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Iterator
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from fecolumn.study.outcome import DONE, Task, TaskOutcome, outcomes_of_dead
from fecolumn.study.team import StudyError
from fecolumn.study.worker import ONE_THREAD, analysis_function, die_with_parent, in_words, work_off

READY, _BROKEN = "ready", "broken"

# Successes are told together, failures at once
_TELL_S = 0.1
# Workers in a row that may be killed before they are ready
_STILLBORN = 3


class LocalPool:
    """A `Team` of processes, started when there is something for them to do.

    Parameters
    ----------
    size
        number of workers.
    entry
        "module:function" of the analysis.
    file
        study file, for messages.
    """

    def __init__(self, size: int, entry: str, file: Path | str) -> None:
        self.size, self._entry, self._file = size, entry, str(file)
        self._workers: list[_Worker] = []
        self._stillborn = 0

    @property
    def at_work(self) -> bool:
        """Whether some task's outcome has not been collected yet."""
        return any(worker.tasks for worker in self._workers)

    def wants(self, depth: int) -> bool:
        """Whether another batch may be given when every worker may have `depth` of them."""
        return len(self._workers) < self.size or any(
            len(worker.batches) < depth for worker in self._workers
        )

    def give(self, batch: list[Task]) -> None:
        """Hand a batch to a new process up to `size` of them, then to the least busy one."""
        if len(self._workers) < self.size:
            self._workers.append(_Worker(self._entry, self._file))
            worker = self._workers[-1]
        else:
            worker = min(self._workers, key=lambda one: len(one.batches))
        worker.give(batch)

    def collect(self, timeout_s: float) -> list[TaskOutcome]:
        """Outcomes of the tasks that ended, after waiting at most `timeout_s` [s] for one."""
        outcomes = []
        answered = wait([worker.connection for worker in self._workers], timeout=timeout_s)
        for worker in [worker for worker in self._workers if worker.connection in answered]:
            try:
                outcomes += self._answer(worker, worker.connection.recv())
            except (EOFError, OSError):
                self._workers.remove(worker)
                outcomes += self._bury(worker)
        return outcomes

    def _answer(self, worker: _Worker, word: Any) -> list[TaskOutcome]:
        if word == READY:
            worker.ready, self._stillborn = True, 0
            return []
        if isinstance(word, tuple):
            raise StudyError(f"a worker could not start: {word[1]}")
        outcomes: list[TaskOutcome] = word
        for outcome in outcomes:
            worker.ended(outcome.id)
        return outcomes

    def _bury(self, worker: _Worker) -> list[TaskOutcome]:
        """Outcomes of what a dead worker had in hand."""
        reason = worker.epitaph()
        worker.connection.close()
        if not worker.ready:
            self._stillborn += 1
            if self._stillborn == _STILLBORN or not reason.startswith("worker killed"):
                raise StudyError(f"a worker could not start: {reason}")
        return list(outcomes_of_dead(worker.tasks.values(), reason, worker.ready))

    def stop(self) -> None:
        """Kill the processes; what they have in hand is lost."""
        for worker in self._workers:
            worker.stop()
        self._workers = []


class LastingPool(LocalPool):
    """A pool whose processes wait for more when a driver is done with them, until `end`: work that
    comes round by round does not start them anew.
    """

    def stop(self) -> None:
        """Kill the processes only where they have something in hand."""
        if self.at_work:
            super().stop()

    def end(self) -> None:
        """Kill the processes."""
        super().stop()


class _Worker:
    """Handle of a worker process.

    Attributes
    ----------
    tasks
        what it has in hand by id, in order.
    batches
        how many tasks of each batch are left.
    ready
        whether it has found its analysis function.
    """

    def __init__(self, entry: str, file: str) -> None:
        # a fork would copy the driver's MPI and threads
        context = multiprocessing.get_context("spawn")
        self.connection, far_end = context.Pipe()
        self.process = context.Process(target=_serve, args=(far_end, entry, file), daemon=True)
        self.tasks: dict[str, Task] = {}
        self.batches: deque[int] = deque()
        self.ready = False
        with _environment(ONE_THREAD), _interrupts_held(), _without_script():
            self.process.start()
        far_end.close()  # so that the end of the process is the end of the connection

    def give(self, batch: list[Task]) -> None:
        self.tasks |= {task.id: task for task in batch}
        self.batches.append(len(batch))
        try:
            self.connection.send(batch)
        except OSError:
            pass  # it is dead; its connection is at its end, and the next wait says so

    def ended(self, case_id: str) -> None:
        del self.tasks[case_id]
        self.batches[0] -= 1
        if not self.batches[0]:
            self.batches.popleft()

    def epitaph(self) -> str:
        """How the process ended, in words."""
        self.process.join()
        code = self.process.exitcode
        if code is None or code >= 0:
            return f"worker ended with exit code {code}"
        name = signal.Signals(-code).name
        return f"worker killed by {name}" + (" (out of memory?)" if name == "SIGKILL" else "")

    def stop(self) -> None:
        """End the process: an idle one is let go, so that MPI can tidy up; one at work is killed,
        which costs no result.
        """
        self.connection.close()
        if self.ready and not self.tasks:
            self.process.join(timeout=5.0)
        self.process.kill()
        self.process.join()


def _serve(connection: Connection, entry: str, file: str) -> None:
    die_with_parent()
    parent = multiprocessing.parent_process()
    if parent is None or parent.pid != os.getppid():
        os._exit(1)  # gone already
    try:
        import mpi4py.MPI  # noqa: F401  what an analysis needs in any case

        run = analysis_function(entry)
    except BaseException as error:
        connection.send((_BROKEN, f"{entry} cannot be used: {in_words(error)}"))
        return
    connection.send(READY)
    batches: queue.SimpleQueue[list[Task] | None] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(connection, batches), daemon=True).start()
    while (batch := batches.get()) is not None:
        told, unsaid = time.monotonic(), []
        for outcome in work_off(batch, run, file):
            unsaid.append(outcome)
            if outcome.word != DONE or time.monotonic() - told > _TELL_S:
                connection.send(unsaid)
                told, unsaid = time.monotonic(), []
        if unsaid:
            connection.send(unsaid)


def _listen(connection: Connection, batches: queue.SimpleQueue[list[Task] | None]) -> None:
    """Take batches at once: a driver that had to wait with one could not take outcomes
    meanwhile.
    """
    try:
        while True:
            batches.put(connection.recv())
    except (EOFError, OSError):
        batches.put(None)


@contextlib.contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    """Environment a child inherits; set before it imports anything."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


@contextlib.contextmanager
def _without_script() -> Iterator[None]:
    """Started processes do not run the caller's script anew, as multiprocessing would have them:
    they need nothing of it.
    """
    script, spec = sys.modules["__main__"], getattr(sys.modules["__main__"], "__spec__", None)
    file = script.__dict__.pop("__file__", None)
    script.__spec__ = None
    try:
        yield
    finally:
        script.__spec__ = spec
        if file is not None:
            script.__file__ = file


@contextlib.contextmanager
def _interrupts_held() -> Iterator[None]:
    """Children inherit a blocked Ctrl-C: the driver alone answers it, and stops them."""
    # multiprocessing starts it with the first process and unblocks Ctrl-C afterwards
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
