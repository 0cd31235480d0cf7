"""Workers on many machines: the ranks of `mpirun -n N fecolumn study ...`, of which rank 0
drives.
"""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from pathlib import Path
from typing import IO, Any

from fecolumn.foundation.schema import InputError
from fecolumn.study.lock import hold_as_worker
from fecolumn.study.outcome import Task, TaskOutcome
from fecolumn.study.team import StudyError
from fecolumn.study.worker import ONE_THREAD, analysis_function, die_with_parent, in_words, work_off

# What launchers of MPI tell their ranks
_RANKS = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS")


def under_mpirun() -> bool:
    """Whether this process is one of several ranks."""
    return any(int(os.environ.get(name) or 1) > 1 for name in _RANKS)


@contextlib.contextmanager
def executor() -> Iterator[Any]:
    """An executor of mpi4py.futures on rank 0; None on the others, after they have served it to the
    end.

    Raises
    ------
    InputError
        MPI does not know of the ranks the launcher has started.
    """
    os.environ.update(ONE_THREAD)
    import petsc4py
    from mpi4py import MPI

    if MPI.COMM_WORLD.size == 1:
        raise InputError(
            "fecolumn study",
            "",
            None,
            "was started in several copies that do not know of each other: use the "
            "mpirun of the MPI "
            "that mpi4py was built for, or --array-index and --array-size",
        )
    # importing dolfinx starts PETSc on all ranks together, which would wait for those that do not
    # import it
    petsc4py.init(comm=MPI.COMM_SELF)
    from mpi4py.futures import MPICommExecutor

    if MPI.COMM_WORLD.rank:
        die_with_parent()
        signal.signal(signal.SIGTERM, signal.SIG_DFL)  # the driver alone answers it
    with MPICommExecutor(MPI.COMM_WORLD, root=0) as one:
        yield one


def abort(code: int) -> None:
    """End all ranks at once."""
    from mpi4py import MPI

    MPI.COMM_WORLD.Abort(code)


class MpiTeam:
    """A `Team` of the other ranks.

    A rank that dies ends the whole job; the next call does the rest.

    Parameters
    ----------
    pool
        executor on rank 0.
    size
        number of workers.
    entry
        "module:function" of the analysis.
    folder, share
        of the study.
    file
        study file, for messages.
    """

    def __init__(
        self,
        pool: Any,
        size: int,
        entry: str,
        folder: Path | str,
        share: tuple[int, int] | None,
        file: Path | str,
    ) -> None:
        self.size, self._pool, self._told = size, pool, (entry, Path(folder), share, str(file))
        self._futures: set[Future[list[TaskOutcome]]] = set()

    @property
    def at_work(self) -> bool:
        """Whether some task's outcome has not been collected yet."""
        return bool(self._futures)

    def wants(self, depth: int) -> bool:
        """Whether another batch may be given when every worker may have `depth` of them."""
        return len(self._futures) < depth * self.size

    def give(self, batch: list[Task]) -> None:
        """Submit a batch to the ranks."""
        self._futures.add(self._pool.submit(_serve, batch, *self._told))

    def collect(self, timeout_s: float) -> list[TaskOutcome]:
        """Outcomes of the tasks that ended, after waiting at most `timeout_s` [s] for one."""
        ended, self._futures = wait(self._futures, timeout=timeout_s, return_when=FIRST_COMPLETED)
        outcomes = []
        for future in ended:
            try:
                outcomes += future.result()
            except _Broken as error:
                raise StudyError(f"a worker could not start: {error}") from None
        return outcomes

    def stop(self) -> None:
        """Cancel the batches that have not begun."""
        for future in self._futures:
            future.cancel()


class _Broken(RuntimeError):
    """The analysis function cannot be used."""


_held: dict[Path, IO[str]] = {}


def _serve(
    batch: list[Task], entry: str, folder: Path, share: tuple[int, int] | None, file: str
) -> list[TaskOutcome]:
    if folder not in _held:
        _held[folder] = hold_as_worker(folder, share)
    try:
        run = analysis_function(entry)
    except BaseException as error:
        raise _Broken(f"{entry} cannot be used: {in_words(error)}") from None
    return list(work_off(batch, run, file))
