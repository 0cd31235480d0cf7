"""Which values of keys of a case fit a measured free-rocking test."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import case_from_tables
from fecolumn.case.check_step import check_stated
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge, nested
from fecolumn.pictures.figures.axis_text import axis_unit
from fecolumn.statistics.profile import THRESHOLD, ProfiledFit, ProfiledParameter
from fecolumn.statistics.rocking_test import RockingTest

# Ranges that span so many times their lower end are searched in logarithm: of a stiffness it is the
# order of magnitude that is sought
_DECADE = 10.0
# A fit whose residuals are above this share of the tilt at the release is told to be none
_POOR = 0.1


class RockingCalibration:
    """A case, keys with ranges, and the test.

    Every run is an analysis in a folder of its own, named after its case: what is there is not
    computed again, so that a calibration that was stopped goes on.

    Parameters
    ----------
    tables
        of the case, paths absolute; its motion is left out, and it starts from the tilt of the
        test's first line unless it states its own.
    file
        of the case, for messages.
    ranges
        lowest and highest value by dotted key.
    test
        the measured tilt.
    folder
        of the runs.
    """

    def __init__(
        self,
        tables: dict[str, Any],
        file: str,
        ranges: dict[str, tuple[float, float]],
        test: RockingTest,
        folder: Path,
    ) -> None:
        self.file, self.ranges, self.test, self.folder = file, ranges, test, folder
        tables = {key: table for key, table in tables.items() if key != "motion"}
        end = float(test.time[-1])
        every_row = {"states_every_s": 0, "history_every_s": 0, "fields_every_s": 0}
        tables = merge(tables, {"integration": {"duration_s": end}, "output": every_row})
        self.tables = _start(tables, float(test.tilt[0]))
        #: Key of the tilt at the release where that is the test's first line and not fitted.
        self.taken = "" if tables.get("initial") else _tilt_key(tables)
        if self.taken in ranges:
            self.taken = ""
        self.runs = 0

    def values(self, u: NDArray[Any]) -> dict[str, float]:
        """Values of the keys at shares (d,) of their ranges, to six digits."""
        return {key: float(f"{self.at(key, share):.6g}") for share, key in zip(u, self.ranges)}

    def at(self, key: str, share: float) -> float:
        """Value of a key at a share of its range, in logarithm where that spans a decade."""
        low, high = self.ranges[key]
        if low > 0 and high >= _DECADE * low:
            return float(low * (high / low) ** share)
        return low + share * (high - low)

    def case(self, u: NDArray[Any]) -> Any:
        """The case at shares (d,) of the ranges."""
        tables = self.tables
        for key, value in self.values(u).items():
            tables = merge(tables, nested(key, value))
        return case_from_tables(tables, self.file)

    def check(self) -> None:
        """Refuse what could not be run at an end of a range, the others in the middle of theirs.

        Raises
        ------
        InputError
            names the key and its value.
        """
        middle = np.full(len(self.ranges), 0.5)
        check_stated(self.case(middle), self.file)
        for place in range(middle.size):
            for end in (0.0, 1.0):
                ends = middle.copy()
                ends[place] = end
                self.tilt(ends)
        self.tilt(middle)

    def tilt(self, u: NDArray[Any]) -> NDArray[Any]:
        """Computed tilt (n,) [rad] at the times of the test; of a run that fails infinite."""
        from mpi4py import MPI

        from fecolumn.engines.dynamics.history import read_history
        from fecolumn.simulation import AnalysisFailed, run

        case = self.case(u)
        folder = self.folder / case.id
        self.runs += 1
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # the same of every run
                run(case, folder, comm=MPI.COMM_SELF, file=self.file, quiet=True)
        except AnalysisFailed:
            return np.full(self.test.time.size, np.inf)
        rows = read_history(folder / "history.h5")
        return np.interp(self.test.time, rows["time"], np.abs(rows["tilt"]))

    def residuals(self, u: NDArray[Any]) -> NDArray[Any]:
        """Measured less computed tilt (n,) [rad]."""
        return np.asarray(self.test.tilt - self.tilt(u))

    def sentences(self, fit: ProfiledFit) -> list[str]:
        """One sentence a key, one of each two that trade, and one on the fit as a whole."""
        told = [self._told(key, one) for key, one in zip(self.ranges, fit.parameters, strict=True)]
        told += [self._traded(fit, a, b) for a, b in fit.trades()]
        share = fit.rms / self.test.tilt[0]
        whole = (
            f"The fit leaves {1e3 * fit.rms:.3g} mrad rms, {100 * share:.2g} % of the tilt at the "
            f"release ({fit.residuals.size} samples, which count as {fit.independent:.0f} "
            "independent ones)."
        )
        if share > _POOR:
            whole += (
                " It does not describe the test: intervals mean nothing; other keys, the case or "
                "the moment of release are wrong."
            )
        if not self.taken:
            return [*told, whole]
        tilt = self.test.tilt[0]
        start = (
            f"The case starts from the tilt of the test's first line, {tilt:.4g} rad, as if that "
            f"were exact; --fit {self.taken} {0.95 * tilt:.3g}:{1.05 * tilt:.3g} fits it, too."
        )
        return [*told, whole, start]

    def _traded(self, fit: ProfiledFit, place: int, other: int) -> str:
        """That two keys trade, by the ends of the first one's interval."""
        one = fit.parameters[place]
        a, b = (list(self.ranges)[k] for k in (place, other))
        inside = one.fitted[one.deviance <= THRESHOLD]
        ends = [
            f"{a} = {self.at(a, u[place]):.4g}{_unit(a)} with {b} = {self.at(b, u[other]):.4g}"
            f"{_unit(b)}"
            for u in (inside[0], inside[-1])
        ]
        told = f"{a} and {b} trade: {ends[0]} fits as well as {ends[1]}"
        if one.identified and fit.parameters[other].identified:
            return f"{told}; both intervals allow for it."
        return f"{told}; state one of them in the case to find the other."

    def _told(self, key: str, one: ProfiledParameter) -> str:
        low, high = self.ranges[key]
        unit = _unit(key)

        def at(share: float) -> str:
            return f"{self.at(key, share):.5g}"

        if one.free:
            return (
                f"{key} is not identified: every value of {low:g}:{high:g}{unit} fits as well as "
                "the best; this test says nothing of it."
            )
        pieces = ""
        if one.apart:
            near = ", ".join(f"{self.at(key, share):.4g}" for share in one.apart)
            pieces = (
                f" The interval has gaps: values near {near}{unit} fit as well, those between do "
                "not; a longer test, or a second one, tells them apart."
            )
        if one.low is not None and one.high is not None:
            interval = f"[{at(one.low)}, {at(one.high)}]{unit}, 95 %."
            return f"{key} = {at(one.best)}{unit} {interval}{pieces}"
        if one.low is None and one.high is None:
            return (
                f"{key} is not bounded within {low:g}:{high:g}{unit}; best {at(one.best)}{unit}."
                f"{pieces}"
            )
        side, end = ("below", one.high) if one.low is None else ("above", one.low)
        bound = f"{'most' if one.low is None else 'least'} {at(end or 0.0)}{unit}"
        return (
            f"{key} is at {bound} (95 %), but not bounded {side} within {low:g}:{high:g}{unit}; "
            f"best {at(one.best)}{unit}.{pieces}"
        )


def _unit(key: str) -> str:
    """Unit of a key behind its value, "" of a plain number."""
    unit = axis_unit(key)
    return "" if unit == "-" else f" {unit}"


def _start(tables: dict[str, Any], tilt: float) -> dict[str, Any]:
    """Tables with the tilt at the release, where they state none."""
    if tables.get("initial"):
        return tables
    return merge(tables, nested(_tilt_key(tables), tilt))


def _tilt_key(tables: dict[str, Any]) -> str:
    """Key of the tilt at the release, of several bodies that of the observed or the last one."""
    bodies = tables.get("bodies")
    if not isinstance(bodies, dict):
        return "initial.tilt_rad"
    name = str(tables.get("observed", "")).partition(".")[0] or next(reversed(bodies), "")
    return f"initial.{name}.tilt_rad"


def usual_ranges(tables: dict[str, Any], file: str) -> dict[str, tuple[float, float]]:
    """Keys that a free-rocking test is usually fitted by, with their ranges, of the case's kind.

    Raises
    ------
    InputError
        of this kind none are known.
    """
    if "block" in tables:
        return {"block.restitution": (0.5, 1.0)}
    if "bodies" not in tables and "column" not in tables:
        raise InputError(
            file,
            "--fit",
            None,
            "must be given for this kind of case, such as --fit frame.restitution 0.5:1",
        )
    found = {"contact.restitution": (0.0, 0.95), "contact.friction_coefficient": (0.1, 1.0)}
    springs = {"base": tables.get("base")}
    for table in ("grounds", "joints"):
        springs |= {f"{table}.{name}": one for name, one in (tables.get(table) or {}).items()}
    for name, one in springs.items():
        stiffness = one.get("stiffness_n_m3") if isinstance(one, dict) else None
        if isinstance(stiffness, (int, float)):
            found[f"{name}.stiffness_n_m3"] = (0.1 * stiffness, 10.0 * stiffness)
            found.pop("contact.restitution", None)  # a pad has dashpots, and no restitution
    for name, body in (tables.get("bodies") or {}).items():
        stiffness = body.get("contact_stiffness_n_m3") if isinstance(body, dict) else None
        if isinstance(stiffness, (int, float)):
            found[f"bodies.{name}.contact_stiffness_n_m3"] = (0.1 * stiffness, 10.0 * stiffness)
        radius = body.get("edge_radius_m") if isinstance(body, dict) else None
        if isinstance(radius, (int, float)) and radius > 0:
            found[f"bodies.{name}.edge_radius_m"] = (0.0, 3.0 * radius)
    return found
