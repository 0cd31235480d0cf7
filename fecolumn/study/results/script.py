"""A study from a script or a notebook."""

from __future__ import annotations

import sys

from fecolumn.study.results.study import StudyResult


def run_study(file, folder, workers: int = 1, quiet: bool = False) -> StudyResult:
    """Do what is missing of a study file, as `fecolumn study` does, with its tables and its figure
    in the folder.

    Analyses are made by processes of their own, which do not run the script anew: it needs no `if
    __name__ == "__main__":`.

    Parameters
    ----------
    file
        TOML file of the study.
    folder
        of its results.
    workers
        analyses at a time.
    quiet
        no progress on stderr.

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

    from fecolumn.study.plan import read_plan
    from fecolumn.study.run import complete_study as work_off
    from fecolumn.study.table import write_figure, write_tables

    plan = read_plan(file)
    rows = work_off(plan, folder, workers=workers, stream=io.StringIO() if quiet else sys.stderr)
    write_tables(plan, rows, folder)
    write_figure(plan, rows, folder)
    return StudyResult(folder)
