"""Workers on many machines: those of a running scheduler of dask.distributed, `fecolumn study ...
--scheduler ADDRESS`.
"""

from __future__ import annotations

import contextlib
import logging
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fecolumn.foundation.schema import InputError
from fecolumn.foundation.sources import code, code_text
from fecolumn.study.lock import hold_as_worker
from fecolumn.study.outcome import Task, TaskOutcome, outcomes_of_dead
from fecolumn.study.team import StudyError
from fecolumn.study.worker import ONE_THREAD, analysis_function, in_words, streams_kept, work_off

# For an answer of the scheduler
_REACH_S = 10.0
# Without any worker, at the start or in the midst of a study: on a busy machine one takes half a
# minute to start
_ALONE_S = 60.0
# Between looks at how many workers there are
_LOOK_S = 1.0


@contextlib.contextmanager
def connected(address: str) -> Iterator[Any]:
    """A client of the scheduler at `address`, such as "tcp://node7:8786", whose workers can do
    analyses.

    Raises
    ------
    InputError
        dask.distributed is not installed, the scheduler is out of reach, it has no workers, or one
        that cannot do analyses.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise _refused(
            address, f"needs dask.distributed ({in_words(error)}); pip install distributed"
        ) from None
    for name in ("distributed", "distributed.client"):  # what goes wrong is said here, in a line
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    try:
        client = Client(address, timeout=_REACH_S)
    except (OSError, ValueError) as error:
        reason = "no answer" if isinstance(error, OSError) else in_words(error)
        raise _refused(
            address, f"no scheduler is found there ({reason}); one is started by: dask scheduler"
        ) from None
    with client:
        try:
            client.wait_for_workers(1, timeout=_ALONE_S)
        except TimeoutError:
            raise _refused(
                address,
                "the scheduler has no workers; some are started by: dask worker "
                f"{address} --nworkers N --nthreads 1",
            ) from None
        for worker, answer in client.run(_problem, code(), on_error="return").items():
            if isinstance(answer, Exception):
                answer = (
                    f"has no fecolumn that could work for {code_text(**code())} "
                    f"({in_words(answer)})"
                )
            if answer:
                raise _refused(address, f"the worker {worker} {answer}")
        yield client


def _refused(address: str, why: str) -> InputError:
    return InputError("fecolumn study", "--scheduler", address, why)


class DaskTeam:
    """A `Team` of the workers of a scheduler; those that join later take part.

    What a worker that dies had in hand is done elsewhere.

    An analysis fails when as many workers have died of it as the scheduler allows
    (distributed.scheduler.allowed-failures).

    Parameters
    ----------
    client
        as `connected` gives it.
    entry
        "module:function" of the analysis.
    folder, share
        of the study; the folder must be on a file system that driver and workers share.
    file
        study file, for messages.
    """

    def __init__(
        self,
        client: Any,
        entry: str,
        folder: Path | str,
        share: tuple[int, int] | None,
        file: Path | str,
    ) -> None:
        self._client, self._told = client, (code(), entry, Path(folder).resolve(), share, str(file))
        #: future and batch by the future's key
        self._in_hand: dict[str, tuple[Any, list[Task]]] = {}
        self._looked = self._seen = -float("inf")
        self._look()

    @property
    def at_work(self) -> bool:
        """Whether some task's outcome has not been collected yet."""
        return bool(self._in_hand)

    def wants(self, depth: int) -> bool:
        """Whether another batch may be given when every worker may have `depth` of them."""
        return len(self._in_hand) < depth * self.size

    def give(self, batch: list[Task]) -> None:
        """Submit a batch to the scheduler, with absolute paths: workers run in other folders."""
        # workers have folders of their own
        batch = [
            task._replace(folder=task.folder.resolve(), log=task.log.resolve()) for task in batch
        ]
        future = self._client.submit(_serve, batch, *self._told, pure=False)
        self._in_hand[future.key] = future, batch

    def collect(self, timeout_s: float) -> list[TaskOutcome]:
        """Outcomes of the tasks that ended, after waiting at most `timeout_s` [s] for one."""
        from distributed import CancelledError, wait

        self._look()
        try:
            ended = wait(
                [future for future, _ in self._in_hand.values()],
                timeout=timeout_s,
                return_when="FIRST_COMPLETED",
            ).done
        except TimeoutError:
            return []
        except CancelledError:
            raise self._lost() from None
        return [
            outcome
            for future in ended
            for outcome in self._outcomes(*self._in_hand.pop(future.key))
        ]

    def _outcomes(self, future: Any, batch: list[Task]) -> list[TaskOutcome]:
        from distributed import CancelledError
        from distributed.comm import CommClosedError
        from distributed.scheduler import KilledWorker

        try:
            found: list[TaskOutcome] = future.result()
            return found
        except (CancelledError, CommClosedError):
            raise self._lost() from None
        except KilledWorker as error:
            return list(
                outcomes_of_dead(
                    batch, f"{error.allowed_failures + 1} workers died of it (out of memory?)"
                )
            )
        except Exception as error:
            raise StudyError(
                "a worker could not start: "
                f"{error if isinstance(error, _Broken) else in_words(error)}"
            ) from None

    def _look(self) -> None:
        """Count the workers now and then."""
        now = time.monotonic()
        if now - self._looked < _LOOK_S:
            return
        try:
            count = len(self._client.nthreads())
        except OSError:
            raise self._lost() from None
        self._looked, self.size = now, max(1, count)
        self._seen = now if count else self._seen
        if now - self._seen > _ALONE_S:
            raise StudyError(
                f"the scheduler {self._client.scheduler.address} has had no workers for "
                f"{_ALONE_S:g} s"
            )

    def _lost(self) -> StudyError:
        return StudyError(f"the scheduler {self._client.scheduler.address} is out of reach")

    def stop(self) -> None:
        """Cancel all batches that have not ended."""
        with contextlib.suppress(Exception):  # a scheduler that is gone has nothing to cancel
            self._client.cancel([future for future, _ in self._in_hand.values()], force=True)
        self._in_hand = {}


class _Broken(RuntimeError):
    """The worker cannot do analyses."""


def _problem(expected: dict[str, str], dask_worker: Any) -> str:
    """What keeps a worker from doing analyses of a driver whose code is `expected`, in words; empty
    where nothing does.
    """
    if (own := code()) != expected:
        return (
            f"has {code_text(**own)}, the driver {code_text(**expected)}: install the same "
            "on both, and start the worker again"
        )
    if dask_worker.state.nthreads > 1:
        return (
            f"has {dask_worker.state.nthreads} threads, but an analysis needs a process "
            "of its own: start it with "
            "--nworkers N --nthreads 1"
        )
    return ""


def _serve(
    batch: list[Task],
    expected: dict[str, str],
    entry: str,
    folder: Path,
    share: tuple[int, int] | None,
    file: str,
) -> list[TaskOutcome]:
    from distributed import get_worker

    worker = get_worker()
    if problem := _problem(expected, worker):  # of one that came after the others had been asked
        raise _Broken(f"{worker.address} {problem}")
    if not (folder / "study.json").is_file():
        raise _Broken(
            f"{worker.address} does not see the folder {folder}, which must be on a "
            "file system that all machines share"
        )
    os.environ.update(ONE_THREAD)
    try:
        run = analysis_function(entry)
    except BaseException as error:
        raise _Broken(f"{worker.address}: {entry} cannot be used: {in_words(error)}") from None
    with hold_as_worker(folder, share), streams_kept():  # the worker goes on to live for others
        return list(work_off(batch, run, file))
