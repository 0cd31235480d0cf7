"""A worker process: one analysis at a time on one core, with a communicator of its own."""

from __future__ import annotations

import contextlib
import faulthandler
import importlib
import multiprocessing
import os
import signal
import sys
import threading
import time
import traceback
from multiprocessing import resource_tracker
from pathlib import Path

READY, BROKEN, ENDED, RAISED = "ready", "broken", "ended", "raised"

# One thread a worker: BLAS threads of several workers on the same cores only disturb each other.
_ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")}


class Worker:
    """Handle of a worker process, held by the driver.

    Attributes:
        task: id of the analysis in hand, None when idle.
        ready: whether the process has started and found its analysis function.
    """

    def __init__(self, entry: str):
        context = multiprocessing.get_context("spawn")  # a fork would copy the driver's MPI and threads
        self.connection, far_end = context.Pipe()
        self.process = context.Process(target=_serve, args=(far_end, entry), daemon=True)
        self.task, self.ready, self._started = None, False, 0.0
        with _environment(_ONE_THREAD), _interrupts_held():
            self.process.start()
        far_end.close()  # so that the end of the process is the end of the connection

    def send(self, case_id: str, case, folder: Path, log: Path, file: Path) -> None:
        """Give an idle worker an analysis: its case, its result folder, where its output goes, and the study file."""
        self.task, self._started = case_id, time.monotonic()
        self.connection.send((case, folder, log, str(file)))

    def receive(self) -> tuple[str, str]:
        """What happened and why; EOFError or OSError where the process is gone."""
        return self.connection.recv()

    def take(self) -> tuple[str, float]:
        """Id and wall time [s] of the task that has just ended; the worker is idle again."""
        case_id, self.task = self.task, None
        return case_id, time.monotonic() - self._started

    def epitaph(self) -> str:
        """How the process ended, in words."""
        self.process.join()
        code = self.process.exitcode
        if code >= 0:
            return f"worker ended with exit code {code}"
        name = signal.Signals(-code).name
        return f"worker killed by {name}" + (" (out of memory?)" if name == "SIGKILL" else "")

    def stop(self) -> None:
        """End the process: an idle one is let go, so that MPI can tidy up; one at work is killed, which costs no result."""
        self.connection.close()
        if self.ready and not self.task:
            self.process.join(timeout=5.0)
        self.process.kill()
        self.process.join()


def analysis_function(entry: str):
    """The function an entry point "module:function" names."""
    module, _, function = entry.partition(":")
    return getattr(importlib.import_module(module), function)


def _serve(connection, entry: str) -> None:
    threading.Thread(target=_die_with_parent, daemon=True).start()
    try:
        from mpi4py import MPI

        run = analysis_function(entry)
    except BaseException as error:
        connection.send((BROKEN, f"{entry} cannot be used: {_in_words(error)}"))
        return
    connection.send((READY, ""))
    while True:
        try:
            case, folder, log_file, file = connection.recv()
        except EOFError:
            return
        folder.mkdir(parents=True, exist_ok=True)
        log_file.parent.mkdir(parents=True, exist_ok=True)
        with open(log_file, "a") as log:
            _speak_into(log)
            try:
                run(case, folder, comm=MPI.COMM_SELF, file=file, quiet=True)
                answer = ENDED, ""
            except Exception as error:
                traceback.print_exc()
                answer = RAISED, _in_words(error)
            sys.stdout.flush()
            sys.stderr.flush()
        connection.send(answer)


def _speak_into(log) -> None:
    """Send what Python, libraries and crashes say on standard output and error to the analysis' own log."""
    for stream, number in ((sys.stdout, 1), (sys.stderr, 2)):
        stream.flush()
        os.dup2(log.fileno(), number)
    faulthandler.enable()


def _die_with_parent() -> None:
    """End this process when the driver has gone, lest it works on into a folder a new driver has taken over."""
    multiprocessing.parent_process().join()
    os._exit(1)


def _in_words(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}".split("\n")[0]


@contextlib.contextmanager
def _environment(values: dict):
    """Environment a child inherits; set before it imports anything."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


@contextlib.contextmanager
def _interrupts_held():
    """Children inherit a blocked Ctrl-C: the driver alone answers it, and stops them."""
    resource_tracker.ensure_running()  # multiprocessing starts it with the first process and unblocks Ctrl-C afterwards
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
