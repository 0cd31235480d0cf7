"""The campaign's data as its repository holds them: outcomes, intensities, table motions."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.signal import butter, sosfiltfilt

from benchmarks.shake_table.workbook import first_sheet
from fecolumn.case.sections import GRAVITY

#: Sampling of the table's channels [Hz]; the files print times in whole 10 or 100 microseconds.
SAMPLING_HZ = 800.0
#: Band of the source's own filter [Hz], Butterworth of third order, forwards and backwards: with it
#: the peaks of column 2 are the stated PGAs.
BAND_HZ, ORDER = (0.1, 25.0), 3
#: Displacement in metres of a volt unit of the table: 5.9797e-4 inch.
METRES = 5.9797e-4 * 0.0254
_TIME, _ACCELERATION, _DISPLACEMENT = 0, 1, 5
_OUTCOMES, _INTENSITIES = "Results_Granite.xlsx", "PGVA-zchen.xlsx"
_MEASURED, _COMPUTED = "Experimental Results for response-Specimen", "Specimen {}-Numerical"


@dataclass(frozen=True)
class Test:
    """A test: pga [g] and pgv_pga [s] as stated; overturned: what the specimen did; computed: what
    models of others said, by their names.
    """

    number: int
    pga: float
    pgv_pga: float
    overturned: bool
    computed: dict[str, bool]


@dataclass(frozen=True)
class Campaign:
    """tests of one specimen by rising number; motions: folder of the table's files; scan: file of
    the specimen's surface.
    """

    tests: list[Test]
    motions: Path
    scan: Path

    def file(self, test: Test) -> Path:
        """File of the table's motion."""
        return self.motions / f"Test{test.number:03d}.txt"

    @property
    def missing(self) -> list[int]:
        """Numbers of the tests without a file of their motion."""
        return [test.number for test in self.tests if not self.file(test).is_file()]


def read_campaign(path, specimen: int = 1) -> Campaign:
    """The campaign in a copy of the repository at `path`.

    Raises
    ------
    FileNotFoundError, ValueError
        a file or a column is missing, or a cell is no number; names it.
    """
    root = Path(path)
    data = root / "data" if (root / "data").is_dir() else root
    motions, scan = (
        data / "Shake_Table_Response",
        data / f"SP{specimen}_PBRmodel" / f"SP{specimen}.obj",
    )
    for wanted in (motions, motions / _OUTCOMES, motions / _INTENSITIES, scan):
        if not wanted.exists():
            raise FileNotFoundError(
                f"{wanted}: missing; PATH must be a copy of "
                "ZhiangChen/virtual_shake_robot_pybullet with its folder data/"
            )
    heads, *rows = first_sheet(motions / _OUTCOMES)
    measured = next(
        (column for column, head in heads.items() if head == f"{_MEASURED} {specimen}"), None
    )
    if measured is None:
        raise ValueError(
            f"{motions / _OUTCOMES}: no column '{_MEASURED} {specimen}' in its first row"
        )
    prefix = _COMPUTED.format(specimen)
    models = {
        column: head.removeprefix(prefix).strip()
        for column, head in heads.items()
        if head.startswith(prefix)
    }
    stated = {
        int(number(row, "B", motions / _INTENSITIES)): row
        for row in first_sheet(motions / _INTENSITIES)[1:]
    }
    tests = []
    for row in rows:
        n = int(number(row, "A", motions / _OUTCOMES))
        if n not in stated:
            raise ValueError(f"{motions / _INTENSITIES}: no row of test {n}")
        pga, pgv_pga = (number(stated[n], column, motions / _INTENSITIES) for column in "CD")
        tests.append(
            Test(
                n,
                pga,
                pgv_pga,
                flag(row, measured, motions / _OUTCOMES),
                {name: flag(row, column, motions / _OUTCOMES) for column, name in models.items()},
            )
        )
    return Campaign(sorted(tests, key=lambda test: test.number), motions, scan)


def number(row: dict, column: str, file: Path) -> float:
    """Number in a cell, or a ValueError that names it."""
    try:
        return float(row[column])
    except (KeyError, ValueError):
        raise ValueError(
            f"{file}: column {column} of the row '{next(iter(row.values()))} ...' is "
            f"{row.get(column, 'empty')!r}, must be a number"
        ) from None


def flag(row: dict, column: str, file: Path) -> bool:
    """An outcome: 1 overturned, 0 not."""
    value = number(row, column, file)
    if value not in (0, 1):
        raise ValueError(
            f"{file}: column {column} of test {row['A']} is {value:g}, must be 0 "
            "(stood) or 1 (overturned)"
        )
    return bool(value)


def channels(file: Path) -> tuple[np.ndarray, np.ndarray]:
    """Acceleration [m/s2] and displacement [m] of the table as recorded, each (n,) at SAMPLING_HZ,
    unfiltered; either with its sensor's sign.

    Raises
    ------
    ValueError
        not the 8 columns of such a file, a sample that is not finite, another sampling, or too
        short for the filter.
    """
    try:
        table = np.loadtxt(file, skiprows=1, ndmin=2)
    except ValueError as error:
        raise ValueError(
            f"{file}: not a table of numbers below one line of names ({error})"
        ) from None
    if table.shape[1] != 8:
        raise ValueError(
            f"{file}: {table.shape[1]} columns, must be 8: time and amplitude of two "
            "accelerations [g] and two displacements"
        )
    if not np.isfinite(table).all():
        raise ValueError(f"{file}: a sample is not a finite number")
    interval = (table[-1, _TIME] - table[0, _TIME]) / max(len(table) - 1, 1)
    if abs(interval * SAMPLING_HZ - 1) > 1e-3:
        raise ValueError(f"{file}: {interval:.6g} s a sample, must be {1 / SAMPLING_HZ:g} s")
    if len(table) < SAMPLING_HZ:
        raise ValueError(f"{file}: {len(table)} samples, shorter than a second")
    return GRAVITY * table[:, _ACCELERATION], METRES * table[:, _DISPLACEMENT]


@dataclass(frozen=True)
class TableView:
    """How the table's motion is read from its two sensors: below crossover [Hz] from its
    displacement, above it from its accelerometer; nothing above upper [Hz]. A crossover at the
    lower end of BAND_HZ leaves the accelerometer alone.
    """

    crossover: float = BAND_HZ[0]
    upper: float = BAND_HZ[1]


#: As the source reads it.
SOURCES = TableView()


def filtered(samples: np.ndarray, upper: float = BAND_HZ[1]) -> np.ndarray:
    """Samples (n,) between the lower end of BAND_HZ and upper [Hz], without shift of phase and
    without mean.
    """
    return sosfiltfilt(
        butter(ORDER, (BAND_HZ[0], upper), btype="band", fs=SAMPLING_HZ, output="sos"), samples
    )


def table_motion(file: Path, view: TableView = SOURCES) -> np.ndarray:
    """Acceleration (n,) of the table [m/s2] at SAMPLING_HZ, positive where its displacement is.

    The sign of column 2 is turned: in every long-period test it runs against the second derivative
    of column 6.
    """
    acceleration, displacement = channels(file)
    motion = -filtered(acceleration, view.upper)
    if view.crossover <= BAND_HZ[0]:
        return motion
    slow = butter(ORDER, view.crossover, fs=SAMPLING_HZ, output="sos")
    below = sosfiltfilt(slow, filtered(displacement))
    second = np.gradient(np.gradient(below)) * SAMPLING_HZ**2
    return motion - sosfiltfilt(slow, motion) + second
