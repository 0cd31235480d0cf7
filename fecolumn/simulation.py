"""One analysis from a case to its result folder: run it, or go on where it stopped."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fecolumn.case.case import Case, load_case
from fecolumn.case.check_case import check, check_duration
from fecolumn.case.sections import MODEL_ENGINES
from fecolumn.engines.analysis import Analysis, AnalysisFailed
from fecolumn.engines.result_folder import held, kept_choice
from fecolumn.engines.summary import SUMMARY_FILE, read_summary
from fecolumn.foundation.files import Unreadable, is_file, read_json
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.sources import code, code_text

if TYPE_CHECKING:
    from mpi4py import MPI

__all__ = ["AnalysisFailed", "read_folder_case", "run"]


def run(
    case: Case | str | Path,
    folder: str | Path,
    *,
    comm: MPI.Intracomm | None = None,
    file: str = "",
    quiet: bool = False,
    profile: bool = False,
    stop: Callable[[], bool] | None = None,
) -> dict[str, Any]:
    """Run a case, or go on where an earlier run into the same folder stopped; returns the summary.

    Parameters
    ----------
    case
        what to analyse, or its file.
    folder
        result folder; one case has one folder.
    comm
        MPI communicator, all of MPI.COMM_WORLD unless given.
    file
        the case's file, for messages where `case` is none.
    quiet
        no progress on stderr.
    profile
        write the time of each step, and what it did, into step_times.csv of the folder, whose
        columns the manual's page outputs tells. Steps are then made one at a time.
    stop
        asked after every step whether to save and raise KeyboardInterrupt; left out: never.

    Returns
    -------
    dict
        entries of summary.json by name, each with its unit there in its name or on the manual's
        page outputs.

    Raises
    ------
    InputError
        the case is none that can be analysed, the folder belongs to another case, or the motion
        cannot be used.
    TypeError
        `case` is neither a Case nor a path.
    AnalysisFailed
        a step did not converge after all cuts.
    """
    from mpi4py import MPI

    comm, stop = comm or MPI.COMM_WORLD, stop or (lambda: False)
    if isinstance(case, (str, Path)):
        case, file = load_case(case), str(case)
    if not isinstance(case, Case):
        raise TypeError(
            f"run takes a Case or the path of a case file, not {type(case).__name__}; "
            "fecolumn.case_from_tables makes a Case of tables of keys"
        )
    folder, file = Path(folder), file or "case"
    check(case, file)
    chosen = kept_choice(folder)
    if case.integration.step_is_chosen:
        if chosen and chosen.get("case_id") == case.id:
            case = case.replace({"integration.dt_s": chosen["dt_s"]})
        else:
            with held(folder, case, comm, file):
                case, chosen = chosen_step(case, file, comm, stop, _speaker(quiet))
    with held(folder, case, comm, file, chosen) as claim:
        earlier: tuple[dict[str, Any] | None, str] = comm.bcast(
            _earlier_summary(folder, case.id) if comm.rank == 0 else None
        )
        summary, damage = earlier
        if summary:
            found, present = (
                code_text(summary.get("version"), summary.get("sources")),
                code_text(**code()),
            )
            if found != present and comm.rank == 0:
                warnings.warn(
                    f"{folder} holds the result of other code, {found}, which is kept; "
                    f"this is {present}; a new folder starts afresh",
                    stacklevel=2,
                )
            return summary
        if damage and comm.rank == 0:
            warnings.warn(
                f"{folder / SUMMARY_FILE} {damage}; the analysis is made again", stacklevel=2
            )
        analysis = started_analysis(case, folder, comm, file, quiet)
        analysis.dt_chosen = chosen
        if profile:
            analysis.time_steps()
        claim()
        return analysis.run(stop)


def _speaker(quiet: bool) -> Callable[[str], None]:
    """Function that tells a line on stderr, or nothing where `quiet`."""
    return lambda words: None if quiet else print(words, file=sys.stderr, flush=True)


def started_analysis(
    case: Case, folder: Path, comm: MPI.Intracomm, file: str, quiet: bool
) -> Analysis:
    """The analysis of a case at its start, or where an earlier one in the same folder stopped.

    Raises
    ------
    InputError
        the case cannot be analysed.
    AnalysisFailed
        there is no gravity equilibrium to start from.
    """
    from fecolumn.engines.dynamics.gravity import NoEquilibrium
    from fecolumn.engines.no_rest import no_rest

    try:
        return _analysis_class(case, comm, file)(case, folder, comm, file, quiet)
    except NoEquilibrium as error:
        raise AnalysisFailed(f"{file}: {no_rest(case, error)}") from None


def chosen_step(
    case: Case,
    file: str,
    comm: MPI.Intracomm | None = None,
    stop: Callable[[], bool] = lambda: False,
    say: Callable[[str], None] = print,
) -> tuple[Case, dict[str, Any]]:
    """The case with the step that trials of its first impacts choose, in place of "auto"; and how
    it was chosen, of the summary.

    say: function that takes a line of words.

    Raises
    ------
    InputError, AnalysisFailed
        as of `started_analysis`.
    """
    from mpi4py import MPI

    from fecolumn.engines.step_choice import StepChoice

    comm = comm or MPI.COMM_WORLD
    _analysis_class(case, comm, file)  # which refuses what cannot be analysed
    choice = StepChoice(
        case, file, lambda one, folder: started_analysis(one, folder, comm, file, quiet=True), stop
    )
    chosen = choice.chosen(say)
    return case.replace({"integration.dt_s": chosen["dt_s"]}), chosen


def check_analysis(case: Case, file: Path | str) -> None:
    """Refuse a case that can be looked at and not analysed.

    Raises
    ------
    InputError
        it has neither motion nor duration, or its bodies are not those of the rocking model that
        it asks for.
    """
    if case.integration.engine in MODEL_ENGINES:
        from fecolumn.engines.rocking.of_bodies import model_of, start_of

        model_of(case, file)
        start_of(case, file)
    check_duration(case, file)


def _analysis_class(case: Case, comm: MPI.Intracomm, file: str) -> type[Analysis]:
    check_analysis(case, file)
    if case.integration.engine == "full":
        from fecolumn.engines.full_analysis import FullAnalysis

        return FullAnalysis
    if comm.size > 1:
        raise InputError(
            file,
            "integration.engine",
            case.integration.engine,
            "runs on one process: start it without mpirun",
        )
    if case.integration.engine in MODEL_ENGINES:
        from fecolumn.engines.rocking.analysis import ModelAnalysis

        return ModelAnalysis
    from fecolumn.engines.reduced_analysis import ReducedAnalysis

    return ReducedAnalysis


def _earlier_summary(folder: Path, case_id: str) -> tuple[dict[str, Any] | None, str]:
    """The summary of a run that has ended, or None and what is wrong with the file that is
    there.
    """
    if not is_file(folder / SUMMARY_FILE):
        return None, ""
    try:
        return read_summary(folder, case_id), ""
    except Unreadable as error:
        return None, str(error)


def read_folder_case(folder: Path | str) -> tuple[Case, str]:
    """The case of a result folder, and its file's name."""
    from fecolumn.case.case import case_from_tables

    path = Path(folder) / "case.json"
    if not os.path.lexists(path):
        raise InputError(folder, "", None, "not a result folder of fecolumn run (no case.json)")
    try:
        saved = read_json(path)
    except Unreadable as error:
        raise InputError(path, "", None, str(error)) from None
    if not isinstance(saved, dict) or not isinstance(saved.get("case"), dict):
        raise InputError(path, "", None, "is damaged: it must state the case")
    tables = {key: value for key, value in saved["case"].items() if value is not None}
    return case_from_tables(tables, path), str(saved.get("file", "case"))
