"""A study from a script or a notebook."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fecolumn.case.case import Case
from fecolumn.foundation.cores import usable_cores
from fecolumn.foundation.deprecated import by_name, renamed
from fecolumn.study.results.study import StudyResult


@renamed(file="study", workers="jobs")
@by_name("jobs")
def run_study(
    study: Case | str | Path,
    folder: str | Path,
    *,
    jobs: int | None = None,
    quiet: bool = False,
    axes: Mapping[str, Sequence[Any]] | None = None,
    retry_failed: bool = False,
) -> StudyResult:
    """Do what is missing of a study, as `fecolumn study` does, with its tables and its figure in
    the folder.

    Analyses are made by processes of their own, which do not run the script anew: it needs no `if
    __name__ == "__main__":`.

        fecolumn.run_study(case, "drum", axes={"motion.source": ["lick:1-10"]})

    Parameters
    ----------
    study
        TOML file of the study; or a Case, or its file, with `axes`. Then the study is written
        beside the folder, as NAME-study.toml and NAME-case.toml.
    folder
        of its results.
    jobs
        analyses at a time, each in a process of its own; left out: one a core.
    quiet
        no progress on stderr.
    axes
        values by dotted key, each with each, such as {"contact.friction_coefficient": [0.3, 0.6]}.
    retry_failed
        whether analyses that failed before are run again.

    Returns
    -------
    StudyResult
        what the folder holds, as `fecolumn.load` gives it; its `failed` counts the analyses that
        ended with an error, whose reasons its `rows` have.

    Raises
    ------
    InputError
        the study cannot be run as it is written, the folder is another's, or jobs is below 1.
    StudyError
        workers cannot start, or the disk is full.
    KeyboardInterrupt
        Ctrl-C; what is done is kept.
    """
    from fecolumn.study.plan import read_plan
    from fecolumn.study.run import check_motions
    from fecolumn.study.run import complete_study as work_off
    from fecolumn.study.table import write_figure, write_tables

    plan = read_plan(_study_file(study, folder, axes))
    check_motions(plan)
    rows = work_off(
        plan,
        folder,
        workers=_processes(jobs),
        retry_failed=retry_failed,
        stream=None if quiet else sys.stderr,
    )
    write_tables(plan, rows, folder)
    write_figure(plan, rows, folder)
    return StudyResult(folder)


def _processes(jobs: int | None) -> int:
    """Analyses at a time, one a core where that is left open."""
    from fecolumn.foundation.schema import InputError

    if jobs is None:
        return usable_cores()
    if not isinstance(jobs, int) or jobs < 1:
        told = "must be a whole number of at least 1; left out: one a core"
        raise InputError("run_study", "jobs", jobs, told)
    return jobs


def _study_file(
    study: Case | str | Path, folder: str | Path, axes: Mapping[str, Sequence[Any]] | None
) -> str | Path:
    """The file of a study, written where a case and axes are given."""
    import tomli_w

    from fecolumn.foundation.atomic import write_bytes
    from fecolumn.foundation.paths import taken_over
    from fecolumn.foundation.schema import InputError

    if axes is None:
        if isinstance(study, Case):
            told = 'missing; what varies, such as axes={"motion.source": ["lick:1-10"]}'
            raise InputError("run_study", "axes", None, told)
        return as_path(study, "run_study", "study")
    if not isinstance(axes, Mapping):
        told = 'must be lists by key, such as {"motion.source": ["lick:1-10"]}'
        raise InputError("run_study", "axes", axes, told)
    case = Path(case_file(study, folder, "run_study", "study")).resolve()
    path = path_beside(folder, "-study.toml")
    plain = {key: _plain(values) for key, values in axes.items()}
    title = study.title if isinstance(study, Case) else ""
    # files by their absolute paths: a script means the current folder
    tables = taken_over({"title": title or path.stem, "case": str(case), "axes": plain}, "case")
    write_bytes(path, tomli_w.dumps(tables).encode())
    return path


def _plain(values: Any) -> Any:
    """Numbers of Python in the place of NumPy's, lists in that of arrays."""
    if hasattr(values, "tolist"):
        return values.tolist()
    if isinstance(values, (list, tuple, range)):
        return [_plain(one) for one in values]
    return values


def as_path(file: object, where: str, name: str) -> str:
    """The path of a file that a function takes in the place of a Case.

    Raises
    ------
    InputError
        it is neither; function and argument are named.
    """
    from fecolumn.foundation.schema import InputError

    if not isinstance(file, (str, os.PathLike)):
        told = "must be a Case or the path of a file; case_from_tables makes a Case of tables"
        raise InputError(where, name, file, told)
    return os.fspath(file)


def path_beside(folder: str | Path, ending: str) -> Path:
    """A file beside a folder, NAME and the `ending`; what it is to be in is made.

    Raises
    ------
    InputError
        nothing can be beside it.
    """
    from fecolumn.foundation.schema import InputError

    path = Path(folder)
    if path.name in ("", ".."):
        path = Path(os.path.abspath(path))
    if not path.name:
        raise InputError(folder, "", None, "is no folder of results: give it a name")
    path.parent.mkdir(parents=True, exist_ok=True)
    return path.with_name(path.name + ending)


def case_file(case: object, folder: str | Path, where: str, name: str = "case") -> str:
    """The file of a case; that of a Case is written beside the folder, as NAME-case.toml.

    Raises
    ------
    InputError
        as of `as_path`.
    """
    from fecolumn.foundation.atomic import write_bytes

    if not isinstance(case, Case):
        return as_path(case, where, name)
    path = path_beside(folder, "-case.toml")
    write_bytes(path, case.to_toml().encode())
    return str(path)
