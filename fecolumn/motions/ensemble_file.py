"""Ensembles on disk: one HDF5 file with everything, and a table of what its motions are."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.atomic import write_csv, write_hdf5
from fecolumn.foundation.files import Unreadable
from fecolumn.foundation.sealed import open_whole
from fecolumn.motions.ensemble import Ensemble
from fecolumn.motions.intensity import intensity_measures
from fecolumn.motions.record import MOST_SAMPLES, GroundMotion, UnusableRecord, sound

# Endings of the names of HDF5 files
_HDF5_SUFFIXES = (".h5", ".hdf5")
FORMAT = "fecolumn ensemble 1"
_MEMBER = re.compile(r"(?P<file>.+\.(?:h5|hdf5))#(?P<number>[^#]*)", re.IGNORECASE)
ALL_MOTIONS = "*"
#: How the table beside an ensemble begins: now, and in earlier versions
TABLE_HEADS = ("name,number,dt_s,duration_s,", "name,number,dt_s,length_s,")


def is_hdf5_name(path: Path | str) -> bool:
    """Whether a file is one of HDF5 by the ending of its name."""
    return Path(path).suffix.lower() in _HDF5_SUFFIXES


def file_and_number(source: str) -> tuple[str, str] | None:
    """File and number of a source such as ensemble.h5#12, or None for any other source."""
    found = _MEMBER.fullmatch(source)
    return (found["file"], found["number"]) if found else None


def write_ensemble(ensemble: Ensemble, path: Path | str) -> None:
    """Write the ensemble: /motions/0001 ...

    (n_steps, 3) [m/s2] with dt_s, name and source, /parameters, provenance as JSON.
    """

    def fill(file: Any) -> None:
        file.attrs["format"] = FORMAT
        file.attrs["name"] = ensemble.name
        file.attrs["provenance"] = json.dumps(ensemble.provenance, sort_keys=True)
        for number, motion in enumerate(ensemble.motions, 1):
            stored = file.create_dataset(
                f"motions/{number:04d}",
                data=motion.acceleration,
                chunks=(len(motion.acceleration), 1),
                compression="gzip",
                shuffle=True,
            )
            stored.attrs.update(
                {
                    "dt_s": motion.dt,
                    "units": "m/s2",
                    "axes": "x y z",
                    "name": motion.name,
                    "source": motion.source,
                }
            )
        parameters = file.create_group("parameters")
        for name, values in ensemble.parameters.items():
            parameters.create_dataset(name, data=np.asarray(values, dtype=np.float64))

    write_hdf5(Path(path), fill)


def read_ensemble(path: Path | str) -> Ensemble:
    """Ensemble of a file.

    Raises
    ------
    UnusableRecord
        there is no such file, it is no ensemble, or it is damaged.
    """
    with _open(path) as file:
        # by number: by name, 10000 would come before 9999
        motions = tuple(_motion(file["motions"][name]) for name in sorted(file["motions"], key=int))
        parameters = {name: stored[()] for name, stored in file["parameters"].items()}
        return Ensemble(
            str(file.attrs["name"]), motions, parameters, json.loads(file.attrs["provenance"])
        )


def read_member(source: str) -> GroundMotion:
    """Motion of a source such as ensemble.h5#12, counted from 1.

    Raises
    ------
    UnusableRecord
        as read_ensemble; a number that the ensemble does not have.
    """
    named = file_and_number(source)
    if named is None:
        raise UnusableRecord("must name a motion of an ensemble, as in ensemble.h5#12")
    path, number = named
    with _open(path) as file:
        n = len(file["motions"])
        if not re.fullmatch("[0-9]{1,6}", number) or not 1 <= int(number) <= n:
            raise UnusableRecord(
                f"motion {number!r} of the ensemble: must be a whole number from 1 to {n}"
            )
        return _motion(file["motions"][f"{int(number):04d}"])


def members(source: str) -> list[str]:
    """Sources of the single motions of ensemble.h5#*; any other source as it is.

    Raises
    ------
    UnusableRecord
        as read_ensemble.
    """
    found = file_and_number(source)
    if not found or found[1] != ALL_MOTIONS:
        return [source]
    with _open(found[0]) as file:
        return [f"{found[0]}#{number}" for number in range(1, len(file["motions"]) + 1)]


def summary(ensemble: Ensemble) -> dict[str, NDArray[Any]]:
    """Columns of numbers, (n,) each: number, dt_s, duration_s, horizontal_components,
    intensity measures, parameters.

    Where horizontal_components is 1, the measures are of that component, not RotD50 or a mean over
    x and y.

    Motions whose time was scaled have a column time_scale; their parameters are those before.
    """
    components = np.array([len(motion.horizontal_axes) for motion in ensemble.motions])
    measures = [intensity_measures(motion) for motion in ensemble.motions]
    columns = {
        "number": np.arange(1, len(measures) + 1),
        "dt_s": np.array([motion.dt for motion in ensemble.motions]),
        "duration_s": np.array([motion.duration for motion in ensemble.motions]),
        "horizontal_components": components,
    }
    columns |= {name: np.array([measure[name] for measure in measures]) for name in measures[0]}
    factor = ensemble.provenance.get("arguments", {}).get("time_scale", 1.0)
    if factor != 1:
        columns["time_scale"] = np.full(len(measures), factor)
    return columns | {
        f"parameter_{name}": np.asarray(values) for name, values in ensemble.parameters.items()
    }


def write_summary(ensemble: Ensemble, columns: dict[str, NDArray[Any]], path: Path | str) -> None:
    """Write the columns of `summary` and the motions' names as CSV, one motion a row."""
    write_csv(
        Path(path),
        [
            ["name", *columns],
            *(
                [motion.name, *(f"{values[row]:.6g}" for values in columns.values())]
                for row, motion in enumerate(ensemble.motions)
            ),
        ],
    )


def is_ensemble(path: Path | str) -> bool:
    """Whether a file is an ensemble of motions."""
    try:
        with _open(path):
            return True
    except UnusableRecord:
        return False


def is_foreign_hdf5(path: Path | str) -> bool:
    """Whether a file is whole HDF5 of another format."""
    try:
        with open_whole(path) as file:
            return bool(file.attrs.get("format") != FORMAT)
    except Unreadable:
        return False


@contextlib.contextmanager
def _open(path: Path | str) -> Iterator[Any]:
    """The ensemble's HDF5 file; whatever is not as it should be is found out while it is open.

    Raises
    ------
    UnusableRecord
        no such file, no ensemble, or damaged.
    """
    try:
        with open_whole(path) as file:
            if file.attrs.get("format") != FORMAT:
                raise UnusableRecord(
                    f"is no ensemble of motions (its format is not {FORMAT!r}); see "
                    "fecolumn motions make"
                )
            yield file
    except Unreadable as error:
        raise UnusableRecord(str(error)) from None
    except UnusableRecord:
        raise
    except (
        OSError,
        KeyError,
        ValueError,
        TypeError,
        AttributeError,
        RuntimeError,
        MemoryError,
    ) as error:
        raise UnusableRecord(f"is damaged ({' '.join(str(error).split())})") from None


def _motion(stored: Any) -> GroundMotion:
    shape = stored.shape
    if len(shape) != 2 or shape[1] != 3 or not 2 <= shape[0] <= MOST_SAMPLES:
        raise UnusableRecord(
            f"is damaged: a motion of shape {shape} where (n, 3) with n in [2, "
            f"{MOST_SAMPLES:.0e}] is needed"
        )
    return sound(
        GroundMotion(
            stored[()],
            float(stored.attrs["dt_s"]),
            str(stored.attrs["name"]),
            str(stored.attrs["source"]),
        )
    )
