"""A study from a script or a notebook."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fecolumn.case.case import Case
from fecolumn.study.results.study import StudyResult


def run_study(
    file: Case | str | Path,
    folder: str | Path,
    jobs: int = 1,
    *,
    quiet: bool = False,
    axes: Mapping[str, Sequence[Any]] | None = None,
    workers: int | None = None,
) -> StudyResult:
    """Do what is missing of a study, as `fecolumn study` does, with its tables and its figure in
    the folder.

    Analyses are made by processes of their own, which do not run the script anew: it needs no `if
    __name__ == "__main__":`.

        fecolumn.run_study(case, "drum", axes={"motion.source": ["lick:1-10"]})

    Parameters
    ----------
    file
        TOML file of the study; or a Case, or its file, with `axes`. Then the study is written
        beside the folder, as NAME-study.toml and NAME-case.toml.
    folder
        of its results.
    jobs
        analyses at a time, each in a process of its own.
    quiet
        no progress on stderr.
    axes
        values by dotted key, each with each, such as {"contact.friction_coefficient": [0.3, 0.6]}.
    workers
        older name of `jobs`, read until 2.0.

    Returns
    -------
    StudyResult
        what the folder holds, as `fecolumn.load` gives it.

    Raises
    ------
    InputError
        the study cannot be run as it is written, or the folder is another's.
    StudyError
        workers cannot start, or the disk is full.
    KeyboardInterrupt
        Ctrl-C; what is done is kept.
    """
    import io

    from fecolumn.foundation.deprecated import warn_of_older_name
    from fecolumn.study.plan import read_plan
    from fecolumn.study.run import complete_study as work_off
    from fecolumn.study.table import write_figure, write_tables

    if workers is not None:
        warn_of_older_name("script", "workers of run_study", "jobs")
        jobs = workers
    plan = read_plan(_study_file(file, folder, axes))
    rows = work_off(plan, folder, workers=jobs, stream=io.StringIO() if quiet else sys.stderr)
    write_tables(plan, rows, folder)
    write_figure(plan, rows, folder)
    return StudyResult(folder)


def _study_file(
    file: Case | str | Path, folder: str | Path, axes: Mapping[str, Sequence[Any]] | None
) -> str | Path:
    """The file of a study, written where a case and axes are given."""
    import tomli_w

    from fecolumn.foundation.atomic import write_bytes
    from fecolumn.foundation.paths import taken_over
    from fecolumn.foundation.schema import InputError

    if axes is None:
        if isinstance(file, Case):
            told = 'missing; what varies, such as axes={"motion.source": ["lick:1-10"]}'
            raise InputError("run_study", "axes", None, told)
        return file
    if not isinstance(axes, Mapping):
        told = 'must be lists by key, such as {"motion.source": ["lick:1-10"]}'
        raise InputError("run_study", "axes", axes, told)
    case = Path(case_file(file, folder)).resolve()
    path = Path(folder).with_name(f"{Path(folder).name}-study.toml")
    plain = {key: _plain(values) for key, values in axes.items()}
    title = file.title if isinstance(file, Case) else ""
    # files by their absolute paths: a script means the current folder
    tables = taken_over({"title": title or path.stem, "case": str(case), "axes": plain}, "case")
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bytes(path, tomli_w.dumps(tables).encode())
    return path


def _plain(values: Any) -> Any:
    """Numbers of Python in the place of NumPy's, lists in that of arrays."""
    if hasattr(values, "tolist"):
        return values.tolist()
    if isinstance(values, (list, tuple, range)):
        return [_plain(one) for one in values]
    return values


def case_file(case: Case | str | Path, folder: str | Path) -> str:
    """The file of a case; that of a Case is written beside the folder, as NAME-case.toml."""
    from fecolumn.foundation.atomic import write_bytes

    if not isinstance(case, Case):
        return str(case)
    folder = Path(folder)
    path = folder.with_name(f"{folder.name}-case.toml")
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bytes(path, case.to_toml().encode())
    return str(path)
