"""The history of an analysis: one row a step in memory, written atomically as HDF5 with units."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.atomic import write_hdf5
from fecolumn.foundation.deprecated import by_name
from fecolumn.foundation.refused import UnknownName, UnreadableFile
from fecolumn.foundation.schema import InputError, meant

UNITS = {
    "time": "s",
    "u_top": "m",
    "tilt": "rad",
    "twist": "rad",
    "slide": "m",
    "contact_force": "N",
    "active_nodes": "-",
    "penetration": "m",
    "ground": "m/s2",
    "iterations": "-",
    # of rocking models
    "model/theta_x": "rad",
    "model/theta_y": "rad",
    "model/theta": "rad",
    "model/phi": "rad",
    "model/beam": "m",
    "model/base_shear": "N",
}
#: Of columns of a structure's bodies, interfaces, marks, storeys, links and glued joints, by the
#: last word of their names.
UNITS_OF_PARTS = {
    "displacement": "m",
    "tilt": "rad",
    "rise": "m",
    "slide": "m",
    "force": "N",
    "resultant": "N",
    "center": "m",
    "drift": "m",
    "shear": "N",
    "tension": "N",
    "elongation": "m",
    "yielded": "m",
    "work": "J",
    "rotation": "rad",
    "broken": "-",
    "stress": "Pa",
    "shear_stress": "Pa",
    "failed": "-",
}
MEANING = {
    "u_top": "displacement of the top's centre relative to the base",
    "slide": "horizontal displacement of the foot's centre",
    "tilt": "angle of the column's axis to the vertical",
    "twist": "rotation about the vertical",
    "contact_force": "force of the base on the column",
    "active_nodes": "foot nodes in contact",
    "penetration": "largest depth of a contact point",
    "ground": "acceleration of the base",
    "iterations": "position iterations of the step",
    "model/theta_x": "tilt in the plane of x, positive towards +x",
    "model/theta_y": "tilt in the plane of y, positive towards +y",
    "model/theta": "tilt of the columns",
    "model/phi": "azimuth of the place of the rim on which it stands",
    "model/beam": "displacement of the beam along x",
    "model/base_shear": "base shear of the building, damping included",
}


def unit_of(name: str) -> str:
    """Unit of a column of the history.

    Raises
    ------
    KeyError
        none is known.
    """
    first, _, word = name.rpartition("/")
    if first == "energy":
        return "J"
    if unit := UNITS.get(name) or (first and UNITS_OF_PARTS.get(word)):
        return unit
    raise KeyError(f"no unit is known of the column {name!r} of the history")


class History:
    """Rows of measures and energy terms, kept by column in the pieces in which they came."""

    def __init__(self, rows: dict[str, Array] | None = None) -> None:
        self._pieces: dict[str, list[Array]] = {}
        self.extend(rows or {})

    def __len__(self) -> int:
        return sum(len(piece) for piece in self._pieces.get("time", ()))

    def add(self, measures: dict, energy: Array, iterations: int) -> None:
        """Append a row; `energy` in the order of energy.TERMS [J]."""
        row = dict(
            measures,
            iterations=iterations,
            **{f"energy/{name}": value for name, value in zip(TERMS, energy)},
        )
        self.extend({name: np.asarray(value)[None] for name, value in row.items()})

    def extend(self, columns: dict[str, Array]) -> None:
        """Append many rows, by column; the arrays are kept, not copied."""
        for name, values in columns.items():
            if len(values):
                self._pieces.setdefault(name, []).append(np.asarray(values))

    def arrays(self) -> dict[str, Array]:
        """Columns by name, first axis time."""
        for pieces in self._pieces.values():
            if len(pieces) > 1:
                pieces[:] = [np.concatenate(pieces)]
        return {name: pieces[0] for name, pieces in self._pieces.items()}

    def last(self) -> dict:
        """The last row by column."""
        return {name: pieces[-1][-1] for name, pieces in self._pieces.items()}

    def stayed_below(self, name: str, bound: float, since: float) -> bool:
        """Whether a column has been `bound` at most in all rows from a time [s] on."""
        for times, values in zip(self._pieces["time"][::-1], self._pieces[name][::-1]):
            if (values[times >= since] > bound).any():
                return False
            if times[0] < since:
                break
        return True

    def write(self, path: Path, attributes: dict, every: int = 1) -> None:
        """Write one row in `every`, and the last; a reader sees the old file or the new one, never
        a part.
        """

        def fill(file: Any) -> None:
            file.attrs.update(attributes)
            for name, values in self.arrays().items():
                rows = (
                    np.unique(np.append(np.arange(0, len(values), every), len(values) - 1))
                    if every > 1
                    else slice(None)
                )
                values = values[rows]
                packed = {"compression": "gzip", "shuffle": True} if values.size > 1000 else {}
                dataset = file.create_dataset(name, data=values, **packed)
                dataset.attrs["unit"] = unit_of(name)
                if name in MEANING:
                    dataset.attrs["meaning"] = MEANING[name]

        write_hdf5(path, fill)


@by_name("names")
def read_history(path: Path | str, *, names: Sequence[str] = ()) -> dict[str, Array]:
    """Columns of a history file.

    Parameters
    ----------
    path
        of history.h5.
    names
        columns to read; left out, all. Energy terms are "energy/<term>".

    Returns
    -------
    dict
        arrays (n,) or (n, k) by name, one row a kept step, in SI units: time [s], displacements
        [m], tilts [rad], energies [J]; the manual's page outputs has all.

    Raises
    ------
    InputError
        no such file, or none of HDF5 (which is an OSError, too); one named is not in it (a
        KeyError, too).
    """
    if not isinstance(path, (str, os.PathLike)):
        raise InputError("read_history", "path", path, "must be the path of a history.h5")
    try:
        return history_columns(Path(path), names)
    except OSError as error:
        is_there = Path(path).is_file()
        told = f"not a file of HDF5 ({error})" if is_there else "no such file"
        raise UnreadableFile(path, "", None, " ".join(told.split())) from None


def history_columns(path: Path, names: Sequence[str] = ()) -> dict[str, Array]:
    """As `read_history`, whose file is HDF5.

    Raises
    ------
    OSError
        no such file, or none of HDF5.
    InputError
        one named is not in it.
    """
    import h5py

    with h5py.File(path) as file:
        missing = [name for name in names if not isinstance(file.get(name), h5py.Dataset)]
        if names and not missing:
            return {name: file[name][()] for name in names}
        found: list[str] = []
        file.visititems(
            lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) else None
        )
        for name in missing:
            told = f"is no column of it{meant(name, found)}; it has {', '.join(found)}"
            raise UnknownName(path, name, None, told)
        return {name: file[name][()] for name in found}
