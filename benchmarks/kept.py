"""Results kept one a file: a command that was stopped goes on, one with more to do makes what is
missing.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from fecolumn.foundation.atomic import write_json
from fecolumn.foundation.progress import CountProgress
from fecolumn.foundation.sources import PHYSICS


def complete(function: Callable, jobs: dict[Path, tuple], workers: int, what: str) -> None:
    """Write what `function(*arguments)` returns, as JSON, into each file that is not there, in an
    order drawn by chance: at any time what is done is a fair sample.

    Parameters
    ----------
    function
        that a new process can import, where workers is more than 1.
    jobs
        arguments of each file.
    workers
        processes; 1: this one.
    what
        the files are called on the line of progress.

    Raises
    ------
    SystemExit
        a folder holds results of older physics.
    """
    try:
        for folder in sorted({file.parent for file in jobs}):
            keep_settings(folder, {})
    except ValueError as error:
        raise SystemExit(str(error)) from None
    todo = [file for file in jobs if not file.exists()]
    todo = [todo[i] for i in np.random.default_rng(0).permutation(len(todo))]
    progress = CountProgress(len(todo), what)
    if workers == 1:
        for done, file in enumerate(todo, 1):
            write_json(file, function(*jobs[file]))
            progress.show(done)
    else:
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            futures = {pool.submit(function, *jobs[file]): file for file in todo}
            for done, future in enumerate(as_completed(futures), 1):
                write_json(futures[future], future.result())
                progress.show(done)
    progress.end()


def found(jobs) -> list:
    """What the files of jobs that are there hold, in their order."""
    return [json.loads(file.read_text()) for file in jobs if file.exists()]


def keep_settings(folder: Path, settings: dict) -> None:
    """Note in the folder what its results were made with, the number of the physics among it.

    Raises
    ------
    ValueError
        it holds results of other settings, or of older physics.
    """
    settings = settings | {"physics": PHYSICS}
    file = folder / "settings.json"
    if file.exists():
        before = json.loads(file.read_text())
        if other := [
            f"{name} {before.get(name)}"
            for name, value in settings.items()
            if before.get(name) != value
        ]:
            raise ValueError(
                f"{folder} holds results with {', '.join(other)}: choose another folder by -o"
            )
        return
    folder.mkdir(parents=True, exist_ok=True)
    write_json(file, settings)
