"""HDF5 files of an analysis, read whole or refused in one line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from fecolumn.engines.dynamics.history import history_columns
from fecolumn.engines.reduced.states import read_states
from fecolumn.engines.summary import check_owner
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.sealed import seal_fault

_Read = TypeVar("_Read")
_AGAIN = "run the analysis again, into a new folder"


def stored_history(file: Path, names: tuple[str, ...] = ()) -> dict[str, Array]:
    """Columns of the history.h5 of an analysis, as of `history_columns`.

    Raises
    ------
    InputError
        there is none, it is damaged or without one of the columns, or it is of another case.
    """
    return stored(file, "a history of an analysis", lambda: history_columns(file, names))


def stored_states(file: Path) -> dict[str, Array]:
    """Arrays of the states.h5 of an analysis, as of `read_states`.

    Raises
    ------
    InputError
        as of `stored_history`.
    """
    said = "the states of an analysis"
    return stored(
        file,
        said,
        lambda: read_states(file),
        f"{_AGAIN}, or remove it to draw what the history alone gives",
    )


def stored(file: Path, what: str, read: Callable[[], _Read], way_out: str = _AGAIN) -> _Read:
    """What `read()` returns of an HDF5 file of results.

    Raises
    ------
    InputError
        as of `stored_history`; `what`: what the file should be; `way_out`: what to do.
    """
    said = seal_fault(file)
    if not said:
        check_owner(file)
        try:
            return read()
        except Exception as error:  # whatever a damaged file makes h5py raise
            said = " ".join(str(error).split()) or type(error).__name__
    raise InputError(file, "", None, f"not {what} ({said}): {way_out}")
