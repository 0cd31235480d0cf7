"""Records in HDF5 files of other programs: arrays of accelerations and times at the top."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.files import Unreadable
from fecolumn.foundation.sealed import open_whole
from fecolumn.motions.ensemble_file import FORMAT
from fecolumn.motions.record import MOST_SAMPLES, Recording, UnusableRecord
from fecolumn.motions.text import ACCELERATIONS, acceleration_unit, uniform_step

_ACCELERATIONS, _TIMES = ("acc", "acceleration"), ("time", "t", "time_s")
_STEPS, _UNITS = ("dt", "dt_s"), ("units", "unit")
_NEEDED = (
    "an array acc or acceleration, (n,) or (n, 3) along x, y, z, with time or dt [s] beside it; "
    "or write it as columns of text"
)


def read_hdf5_record(path: Path | str, dt_s: float) -> Recording:
    """Recording of the arrays acc (or acceleration) and time at the top of an HDF5 file.

    The step may also be an array or attribute dt, the unit an attribute units or unit, of the file
    or of the array.

    Parameters
    ----------
    path
        the file.
    dt_s
        sampling step stated by the case [s], 0 if none.

    Raises
    ------
    UnusableRecord
        no HDF5 file, an ensemble, no such array, another shape, unknown unit, times that are not
        even, values that are not finite.
    """
    try:
        with open_whole(path) as file:
            if file.attrs.get("format") == FORMAT:
                raise UnusableRecord(f"is an ensemble: name a motion of it, as in {path}#1")
            stored = next((file[name] for name in _ACCELERATIONS if name in file), None)
            if stored is None:
                there = ", ".join(list(file)[:8]) or "nothing"
                raise UnusableRecord(f"holds {there} at its top; needs {_NEEDED}")
            values = _numbers(stored, "its acceleration")
            unit = _stated(file, stored, _UNITS, "")
            if isinstance(unit, bytes):
                unit = unit.decode(errors="replace")
            time = next((_numbers(file[one], one) for one in _TIMES if one in file), None)
            dt = _stated(file, stored, _STEPS, None)
    except Unreadable as error:
        raise UnusableRecord(str(error)) from None
    if values.ndim == 1:
        values = values[:, None]
    if values.ndim != 2 or not 1 <= values.shape[1] <= 3 or not 2 <= len(values) <= MOST_SAMPLES:
        raise UnusableRecord(f"holds an acceleration of shape {values.shape}; needs {_NEEDED}")
    known, factor = acceleration_unit(str(unit))
    if str(unit) and not known:
        raise UnusableRecord(f"unit {str(unit)!r} is not known; must be {ACCELERATIONS}")
    if time is not None:
        if time.shape != (len(values),):
            raise UnusableRecord(f"has {time.size} times for {len(values)} samples")
        dt = uniform_step(time, list(range(1, len(time) + 1)), dt_s, "sample")
    elif dt is not None:
        dt = _one_step(dt)
    axes = ("",) if values.shape[1] == 1 else ("x", "y", "z")[: values.shape[1]]
    name = Path(path).name
    return Recording(factor * values, axes, dt, known, name, name, "arrays of HDF5")


def _numbers(stored: Any, what: str) -> NDArray[Any]:
    """Finite numbers of an array."""
    try:
        values = np.asarray(stored[()], float)
    except (AttributeError, TypeError, ValueError):
        raise UnusableRecord(f"{what} is no array of numbers; needs {_NEEDED}") from None
    if not np.isfinite(values).all():
        raise UnusableRecord(f"{what}: every value must be finite")
    return values


def _stated(file: Any, stored: Any, names: tuple[str, ...], default: Any) -> Any:
    """What an attribute of the array or the file, or an array beside it, of one of these names
    states.
    """
    for name in names:
        for attributes in (stored.attrs, file.attrs):
            if name in attributes:
                return attributes[name]
        if name in file and hasattr(file[name], "shape"):
            return file[name][()]
    return default


def _one_step(stated: Any) -> float:
    """The step [s] of a number, or an array of one."""
    try:
        (value,) = np.asarray(stated, float).ravel().tolist()
    except (TypeError, ValueError):
        value = np.nan
    if not 0 < value < np.inf:
        raise UnusableRecord(f"its dt is {stated!r}; must be one number above 0 [s]")
    return float(value)
