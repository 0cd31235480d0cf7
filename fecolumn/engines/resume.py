"""How an analysis goes on from its checkpoint, whatever its engine."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.foundation.files import is_file
from fecolumn.foundation.sources import code, code_text

if TYPE_CHECKING:
    from mpi4py import MPI

    from fecolumn.engines.dynamics.history import History

CHECKPOINT = "checkpoint.npz"


class Resumable:
    """An analysis that can go on from its checkpoint.

    Attributes
    ----------
    case, folder, comm
        as of `run`. steps: to be made at most; step: the last one made.
    history
        rows so far. stepping_s, earlier_s: wall time of steps, and of earlier runs [s]; began:
        that of `time.perf_counter` at its begin.
    standing_j
        mechanical energy in gravity equilibrium, where nothing moves [J].
    code
        version and sources that the result is of; of an analysis that went on from other code's
        checkpoint, both sources.
    """

    case: Case
    folder: Path
    comm: MPI.Intracomm
    steps: int
    step: int
    history: History
    stepping_s: float
    earlier_s: float
    began: float
    standing_j: float
    code: dict[str, str]

    def went_on(self, take: Callable[[dict[str, NDArray[Any]]], None]) -> bool:
        """Whether the analysis goes on from its checkpoint; from one that cannot be used it does
        not, and says so.

        Parameters
        ----------
        take
            takes over the arrays of a checkpoint; it raises, and has changed nothing but what the
            start sets, where they do not fit.
        """
        from fecolumn.engines.dynamics.checkpoint import read_arrays
        from fecolumn.engines.dynamics.history import History

        path, problem, comm = self.folder / CHECKPOINT, "", self.comm
        if not comm.bcast(is_file(path) if comm.rank == 0 else None):
            return False
        arrays = None
        try:  # by one rank, so that all take the same
            arrays = read_arrays(path) if comm.rank == 0 else None
        except Exception as error:  # damaged archives lead to errors of a dozen kinds
            problem = _in_line(error)
        if comm.size > 1:
            arrays, problem = comm.bcast((arrays, problem))
        try:
            if arrays is not None:
                take(arrays)
        except Exception as error:
            problem = _in_line(error)
        problem = next(filter(None, comm.allgather(problem)), "")
        if problem:
            if comm.rank == 0:
                warnings.warn(
                    f"{path} cannot be used ({problem}); the analysis starts afresh", stacklevel=2
                )
            self.history, self.step, self.code = History(), 0, code()
            self.stepping_s = self.earlier_s = 0.0
        return not problem

    def resumed(self, extra: dict[str, Any]) -> None:
        """Take over what an earlier run had, from the `extra` arrays of its checkpoint.

        Raises
        ------
        ValueError
            they are of another case, or not whole.
        """
        from fecolumn.engines.dynamics.history import History

        rows = {name[5:]: values for name, values in extra.items() if name.startswith("rows.")}
        step, stepping_s, earlier_s, standing_j = (
            int(extra["step"]),
            *(float(extra[name]) for name in ("stepping_s", "wall_s", "standing_j")),
        )
        if str(extra["case_id"]) != self.case.id:
            raise ValueError(f"of another case, {extra['case_id']}")
        if (
            not 0 <= step <= self.steps
            or {len(values) for values in rows.values()} != {step + 1}
            or min(stepping_s, earlier_s) < 0
        ):
            raise ValueError("its history is not whole")
        self.history, self.step, self.standing_j = History(rows), step, standing_j
        self.stepping_s, self.earlier_s = stepping_s, earlier_s
        self._note_code(*(str(extra.get(name, "")) for name in ("version", "sources")))

    def _note_code(self, version: str, sources: str) -> None:
        """Note the code that wrote a checkpoint, which is told where it is another than this."""
        own = self.code
        if sources.split("+")[-1] == own["sources"]:
            own["sources"] = sources
            return
        if self.comm.rank == 0:
            warnings.warn(
                f"{self.folder / CHECKPOINT} is of other code, "
                f"{code_text(version, sources)}; this is {code_text(**own)}: "
                "the result will be of both, a new folder starts afresh",
                stacklevel=2,
            )
        own["sources"] = f"{sources or 'not recorded'}+{own['sources']}"

    def to_resume(self) -> dict[str, Any]:
        """The `extra` arrays of a checkpoint that `resumed` takes."""
        extra = {f"rows.{name}": values for name, values in self.history.arrays().items()}
        return (
            extra
            | self.code
            | dict(
                case_id=self.case.id,
                step=self.step,
                stepping_s=self.stepping_s,
                standing_j=self.standing_j,
                wall_s=self.earlier_s + time.perf_counter() - self.began,
            )
        )


def _in_line(error: Exception) -> str:
    return f"{type(error).__name__}: {error}".split("\n")[0]
