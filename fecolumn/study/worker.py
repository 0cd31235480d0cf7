"""A worker: one analysis at a time on one core, with a communicator of its own."""

from __future__ import annotations

import contextlib
import ctypes
import errno
import faulthandler
import functools
import importlib
import os
import platform
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from typing import IO, Any

from fecolumn.foundation.atomic import disk_full
from fecolumn.foundation.files import is_file
from fecolumn.study.outcome import DISK_FULL, FAILED, Task, TaskOutcome, finished_outcome

# One thread a worker: BLAS threads of several workers on the same cores only disturb each other.
ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)
_PR_SET_PDEATHSIG = 1  # linux/prctl.h


#: Called as run(case, folder, comm=..., file=..., quiet=True)
AnalysisFunction = Callable[..., object]


def analysis_function(entry: str) -> AnalysisFunction:
    """The function an entry point "module:function" names."""
    module, _, function = entry.partition(":")
    found: AnalysisFunction = getattr(importlib.import_module(module), function)
    return found


def work_off(batch: list[Task], run: AnalysisFunction, file: str) -> Iterator[TaskOutcome]:
    """Do the tasks of a batch in order; stops at a full disk.

    Parameters
    ----------
    batch
        what to do.
    run
        analysis function, see `fecolumn.study.run.complete_study`.
    file
        study file, for messages.
    """
    from mpi4py import MPI

    where = machine()
    for task in batch:
        if there := finished_outcome(task.id, task.folder):  # by another driver, or before a crash
            yield there
            continue
        told: dict[str, Any] = dict(started=time.time(), machine=where)
        began = time.monotonic()
        try:
            problem, full = _analyse(task, run, MPI.COMM_SELF, file)
        except OSError as error:  # of folders and log
            problem, full = in_words(error), disk_full(error)
        told["wall_s"] = time.monotonic() - began
        give_back_memory()
        if problem:
            yield TaskOutcome(task.id, DISK_FULL if full else FAILED, problem, **told)
            if full:
                return
        else:
            yield finished_outcome(task.id, task.folder, **told) or TaskOutcome(
                task.id, FAILED, "ended without a summary.json of its own", **told
            )


def _analyse(task: Task, run: AnalysisFunction, comm: Any, file: str) -> tuple[str, bool]:
    """Do one analysis, its words in its own log: why it failed, empty where it did not, and whether
    the disk is full.
    """
    task.folder.mkdir(parents=True, exist_ok=True)
    (task.folder / "summary.json").unlink(missing_ok=True)  # damaged, or of another case
    problem, full = "", False
    if os.path.lexists(task.log) and not is_file(task.log):
        raise FileExistsError(errno.EEXIST, "no file, but in the place of one", str(task.log))
    with open(task.log, "a") as log:
        _speak_into(log)
        try:
            run(task.case, task.folder, comm=comm, file=file, quiet=True)
        except Exception as error:
            problem, full = in_words(error), disk_full(error)
            _try(traceback.print_exc)
        for stream in (sys.stdout, sys.stderr):
            _try(stream.flush)
        silent = os.fstat(log.fileno()).st_size == 0
    if silent:
        task.log.unlink(missing_ok=True)
    return problem, full


def _try(speak: Callable[[], object]) -> None:
    """A log that cannot be written must not hide what it was to say."""
    try:
        speak()
    except OSError:
        pass


def _speak_into(log: IO[str]) -> None:
    """Send what Python, libraries and crashes say on standard output and error to the analysis' own
    log.
    """
    for stream, number in ((sys.stdout, 1), (sys.stderr, 2)):
        _try(stream.flush)
        os.dup2(log.fileno(), number)
    faulthandler.enable()


@contextlib.contextmanager
def streams_kept() -> Iterator[None]:
    """Give a process that goes on to live its standard output and error back, which `work_off`
    lends to the logs of analyses.
    """
    kept = [(number, os.dup(number)) for number in (1, 2)]
    try:
        yield
    finally:
        for number, copy in kept:
            os.dup2(copy, number)
            os.close(copy)


def give_back_memory() -> None:
    """Give free memory back to the machine: glibc keeps what lies between pieces in use, gigabytes
    once models of a dozen specimens were made.
    """
    if trim := getattr(ctypes.CDLL(None), "malloc_trim", None):
        trim(0)


def die_with_parent() -> None:
    """Have the kernel kill this process the moment its parent is gone, lest it works on into a
    folder a new driver has taken over.
    """
    ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))


@functools.cache
def machine() -> str:
    """Name and processor of this machine."""
    try:
        with open("/proc/cpuinfo") as file:
            model = next(
                (line.partition(":")[2].strip() for line in file if line.startswith("model name")),
                platform.machine(),
            )
    except OSError:
        model = platform.machine()
    return f"{platform.node()}, {model}"


def in_words(error: BaseException) -> str:
    """An error in one line."""
    return f"{type(error).__name__}: {error}".split("\n")[0]
