"""Hazard curves from CSV files: of one's own, or as OpenQuake exports them."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.foundation.files import read_any_text
from fecolumn.foundation.gravity import GRAVITY
from fecolumn.foundation.schema import InputError
from fecolumn.statistics.csv_table import check_row, number_of, read_csv
from fecolumn.statistics.hazard import HazardCurve

#: Units at the end of a measure's name: that of SI, and the factor to it.
_UNITS = {
    "_m_s2": ("_m_s2", 1.0),
    "_cm_s2": ("_m_s2", 1e-2),
    "_gal": ("_m_s2", 1e-2),
    "_g": ("_m_s2", GRAVITY),
    "_cm_s": ("_m_s", 1e-2),
    "_m_s": ("_m_s", 1.0),
    "_mm": ("_m", 1e-3),
    "_cm": ("_m", 1e-2),
    "_m": ("_m", 1.0),
    "_s": ("_s", 1.0),
}
_FREQUENCY, _PERIOD = "annual_frequency", "return_period_years"
_PROBABILITY = re.compile(r"probability_(\d+(?:\.\d+)?)_years")
_POE = re.compile(r"poe-(\S+)")
_OF_OPENQUAKE = {"PGA": ("pga_m_s2", GRAVITY), "PGV": ("pgv_m_s", 1e-2)}
# Bounds: of accelerations 100 g, as of records, and as far beyond what was recorded of the others.
# More often than 100 a year is no strong motion, but a return period in a column of frequencies;
# nobody knows what comes less often than once in 1e12 years
_MOST = {"_m_s2": 100 * GRAVITY, "_m_s": 100.0, "_m": 100.0, "_s": 1e4}
_LEAST_A_YEAR, _MOST_A_YEAR = 1e-12, 100.0
_NEEDED = (
    "a column of the intensity, its unit at the end of its name, such as pga_g, pga_m_s2 or "
    "pgv_m_s, and one of annual_frequency, return_period_years or probability_50_years"
)


def read_hazard(path: Path | str, site: int = 1) -> HazardCurve:
    """Hazard curve of a CSV file, in SI units.

    Of one's own: lines of rising intensities with annual frequencies of exceedance, return periods
    or probabilities in some years. Of OpenQuake: a line a site, of which `site` is taken, counted
    from 1.

    Raises
    ------
    InputError
        no such file, no such columns, a value that cannot be, such as an acceleration above 100 g
        or a frequency outside of 1e-12 to 100 a year, lines out of order.
    """
    path = Path(path)
    header, rows = read_csv(path, _NEEDED)
    for number, row in rows:
        check_row(path, header, number, row)
    if any(_POE.fullmatch(name) for name in header):
        return _of_openquake(path, header, rows, site)
    if site != 1:
        raise InputError(path, "--site", site, "is for a file of OpenQuake with a line a site")
    return _own(path, header, rows)


def _own(path: Path, header: list[str], rows: list[tuple[int, list[str]]]) -> HazardCurve:
    kinds = [
        place
        for place, name in enumerate(header)
        if name in (_FREQUENCY, _PERIOD) or _PROBABILITY.fullmatch(name)
    ]
    if len(kinds) != 1 or len(header) != 2:
        raise InputError(path, "header", ", ".join(header), f"must be {_NEEDED}")
    measure, kind = header[1 - kinds[0]], header[kinds[0]]
    unit = next((one for one in _UNITS if measure.endswith(one) and measure != one), None)
    if unit is None:
        raise InputError(
            path,
            "header",
            measure,
            "must end in its unit, one of "
            f"{', '.join(one[1:] for one in _UNITS)}, such as {measure.split('_')[0]}_m_s2",
        )
    found = []
    for number, row in rows:
        im = _number(path, number, measure, row[1 - kinds[0]])
        if im * _UNITS[unit][1] > (most := _MOST[_UNITS[unit][0]]):
            told = f"must be at most {most / _UNITS[unit][1]:.4g}: is its unit another?"
            raise InputError(path, f"line {number}, {measure}", row[1 - kinds[0]], told)
        found.append((number, im, _frequency(path, number, kind, row[kinds[0]])))
    for (_, im, frequency), (number, later, other) in zip(found, found[1:]):
        if later <= im:
            raise InputError(
                path,
                f"line {number}, {measure}",
                later,
                f"must be larger than {im:g} in the line before: sort the lines by the intensity",
            )
        if other > frequency:
            raise InputError(
                path,
                f"line {number}, {kind}",
                _text(rows, number, kinds[0]),
                "must not be exceeded more often than the weaker intensity in the line before",
            )
    name, factor = measure.removesuffix(unit) + _UNITS[unit][0], _UNITS[unit][1]
    return _curve(path, name, *np.array([one[1:] for one in found]).T * [[factor], [1.0]])


def _text(rows: list[tuple[int, list[str]]], number: int, place: int) -> str:
    """A cell of the line of this number, as the file has it."""
    return next(row[place] for one, row in rows if one == number)


def _of_openquake(
    path: Path, header: list[str], rows: list[tuple[int, list[str]]], site: int
) -> HazardCurve:
    first = re.split(r"[\r\n]", read_any_text(path), maxsplit=1)[0]
    stated = {
        key: found[1]
        for key, pattern in (
            ("imt", r"imt='([^']+)'"),
            ("investigation_time", r"investigation_time=([-\d.eE+]+)"),
        )
        if first.startswith("#") and (found := re.search(pattern, first))
    }
    for key in ("imt", "investigation_time"):
        if key not in stated:
            raise InputError(
                path, key, None, "missing in the first line, a comment, as OpenQuake writes it"
            )
    if stated["imt"] not in _OF_OPENQUAKE:
        raise InputError(
            path,
            "imt",
            stated["imt"],
            f"must be one of {', '.join(_OF_OPENQUAKE)}; give another measure as {_NEEDED}",
        )
    if not 1 <= site <= len(rows):
        raise InputError(path, "--site", site, f"must lie in [1, {len(rows)}], the file's sites")
    number, row = rows[site - 1]
    years = _number(path, 1, "investigation_time", stated["investigation_time"])
    name, factor = _OF_OPENQUAKE[stated["imt"]]
    most = _MOST[name.removeprefix(stated["imt"].lower())]
    ims, frequencies = [], []
    for column, text in zip(header, row):
        if not (found := _POE.fullmatch(column)):
            continue
        if factor * number_of(found[1]) > most:
            raise InputError(
                path,
                "header",
                column,
                f"must be at most {most / factor:.4g}: is its unit another?",
            )
        poe = _number(path, number, column, text, zero=True)
        if poe > 1:
            raise InputError(path, f"line {number}, {column}", text, "must be at most 1")
        # exceeded for sure or never: nothing is known but a bound
        if 0 < poe < 1 and (often := -math.log1p(-poe) / years) >= _LEAST_A_YEAR:
            ims.append(factor * _number(path, number, column, found[1]))
            frequencies.append(often)
    im, frequency = np.array(ims), np.array(frequencies)
    if im.size and ((np.diff(im) <= 0).any() or (np.diff(frequency) > 0).any()):
        raise InputError(
            path,
            f"line {number}",
            None,
            "its intensities must rise and their probabilities must not",
        )
    return _curve(path, name, im, frequency)


def _curve(path: Path, name: str, im: NDArray[Any], frequency: NDArray[Any]) -> HazardCurve:
    if im.size < 2:
        raise InputError(
            path, "", None, f"has {im.size} intensities that are exceeded; at least 2 are needed"
        )
    return HazardCurve(name, im, frequency)


def _number(path: Path, number: int, name: str, text: str, zero: bool = False) -> float:
    value = number_of(text)
    if not (0 <= value < math.inf and (zero or value > 0)):
        least = "of at least 0" if zero else "greater than 0"
        raise InputError(path, f"line {number}, {name}", text, f"must be a number {least}")
    return value


def _frequency(path: Path, number: int, kind: str, text: str) -> float:
    """Mean annual frequency [1/year] of a cell of a column of this kind."""
    value = _number(path, number, kind, text)
    low, high = _LEAST_A_YEAR, _MOST_A_YEAR
    if kind == _PERIOD:
        value, told = 1 / value, f"must lie in [{1 / high:g}, {1 / low:g}] years"
    elif kind == _FREQUENCY:
        told = f"must lie in [{low:g}, {high:g}] a year; a return period is return_period_years"
    else:
        if value >= 1:
            told = "must lie between 0 and 1: a share, not percent"
            raise InputError(path, f"line {number}, {kind}", text, told)
        found = _PROBABILITY.fullmatch(kind)
        years = float(found[1]) if found else math.nan
        if not years > 0:
            raise InputError(path, "header", kind, "must state a time of more than 0 years")
        value = -math.log1p(-value) / years
        told = f"is {value:.3g} a year, which must lie in [{low:g}, {high:g}]"
    if not low <= value <= high:
        raise InputError(path, f"line {number}, {kind}", text, told)
    return value
