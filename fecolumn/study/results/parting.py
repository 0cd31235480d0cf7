"""Two analyses side by side: their histories on common times, when they part, and what of their
cases differs.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.foundation.content import content
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.render.strips import LIFTED_UPLIFT

#: Difference at which two histories have parted, over the larger of their peaks [-]: a twentieth is
#: seen in a figure
TOLERANCE = 0.05
# How the quantities that are compared are called, their SI units and their symbols
QUANTITIES = {
    "top": ("top displacement", "m", "u"),
    "tilt": ("tilt", "rad", r"\theta"),
    "uplift": ("uplift", "m", "w"),
}


class Analysed(Protocol):
    """An analysis that has rows: its case, and arrays by name whose first axis is time."""

    @property
    def case(self) -> Case:
        """What was analysed."""

    @property
    def history(self) -> dict[str, NDArray[Any]]:
        """As of `history.h5`."""


@dataclass(frozen=True, slots=True)
class QuantityPair:
    """One quantity of both analyses on common times, those of the `Parting` that has it.

    Attributes
    ----------
    a, b
        (n, k) in SI units; k = 2 of the top's horizontal displacement along x and y, else 1.
    peak
        the larger of both largest magnitudes, in the same unit.
    difference
        (n,) magnitude of a - b, in the same unit.
    parted
        row, from 0, of the first time at which the difference exceeds the tolerance times the peak;
        None where none does, or where it is not judged.
    parted_s
        that time [s]; None as `parted`.
    judged
        whether the quantity is more than the elastic deformation of a column that stands.
    """

    a: NDArray[Any]
    b: NDArray[Any]
    peak: float
    difference: NDArray[Any]
    parted: int | None
    judged: bool = True
    parted_s: float | None = None

    @classmethod
    def of(
        cls,
        a: NDArray[Any],
        b: NDArray[Any],
        tolerance: float,
        judged: bool = True,
        time: NDArray[Any] | None = None,
    ) -> QuantityPair:
        """The pair of (n, k) arrays, or (n,) as such of one column, at times (n,) [s]."""
        a, b = (values.reshape(len(values), -1) for values in (a, b))
        peak = max(float(np.linalg.norm(values, axis=1).max()) for values in (a, b))
        difference = np.linalg.norm(a - b, axis=1)
        beyond = np.flatnonzero(difference > tolerance * peak)
        row = int(beyond[0]) if judged and len(beyond) else None
        at = None if row is None or time is None else float(time[row])
        return cls(a, b, peak, difference, row, judged, at)

    @property
    def peaks(self) -> tuple[float, float]:
        """Largest magnitude of a and of b."""
        a, b = (float(np.linalg.norm(values, axis=1).max()) for values in (self.a, self.b))
        return a, b


@dataclass(frozen=True, slots=True)
class Parting:
    """Two analyses compared.

    Attributes
    ----------
    time
        (n,) [s], rows of the analysis whose rows are further apart, within the time that both
        analysed; the other is taken between its rows along straight lines.
    tolerance
        difference over the peak [-] beyond which a QuantityPair has parted.
    quantities
        QuantityPair by name: "top" [m], "tilt" [rad], "uplift" [m].
    energy
        QuantityPair by the terms of the energy ledger [J], the names of `AnalysisResult.energy`.
    keys
        (key, value of A, value of B) of the case that differ; None of a section that is absent.
    """

    time: NDArray[Any]
    tolerance: float
    quantities: dict[str, QuantityPair]
    energy: dict[str, QuantityPair]
    keys: list[tuple[str, object, object]]

    @property
    def first(self) -> tuple[str, float] | None:
        """The quantity that parts first and the time [s]; None where none does."""
        found = [
            (pair.parted, name) for name, pair in self.quantities.items() if pair.parted is not None
        ]
        row, name = min(found, key=lambda one: one[0], default=(None, ""))
        return (name, float(self.time[row])) if found else None


def parting(a: Analysed, b: Analysed, tolerance: float = TOLERANCE) -> Parting:
    """Compare two analyses, finished or not.

    Raises
    ------
    InputError
        a history is missing, or they have no time in common.
    """
    histories = a.history, b.history
    start, end = (
        choose(history["time"][place] for history in histories)
        for choose, place in ((max, 0), (min, -1))
    )
    rows = [
        history["time"][(history["time"] >= start - 1e-9) & (history["time"] <= end + 1e-9)]
        for history in histories
    ]
    time = min(rows, key=len)
    if len(time) < 2:
        raise InputError(
            "fecolumn compare",
            "A, B",
            None,
            "have fewer than two rows in common: A ends at "
            f"{histories[0]['time'][-1]:g} s, B at {histories[1]['time'][-1]:g} s",
        )
    cases = [a.case, b.case]
    heights, lifted = zip(*map(_uplift, histories))
    lifts = any(lifted)

    def pair(values: Iterable[NDArray[Any]], judged: bool = True) -> QuantityPair:
        first, second = (_at(time, history["time"], one) for history, one in zip(histories, values))
        return QuantityPair.of(first, second, tolerance, judged, time)

    quantities = {
        "top": pair([history["u_top"][:, :2] for history in histories]),
        "tilt": pair([history["tilt"] for history in histories], lifts),
        "uplift": pair(heights, lifts),
    }
    energy = {
        term: pair(
            [history.get(f"energy/{term}", np.zeros(len(history["time"]))) for history in histories]
        )
        for term in TERMS
    }
    return Parting(time, tolerance, quantities, energy, differing_keys(*cases))


def _at(time: NDArray[Any], known: NDArray[Any], values: NDArray[Any]) -> NDArray[Any]:
    """Values (n, k) at `time` along straight lines between those at `known` times."""
    return np.column_stack(
        [np.interp(time, known, column) for column in values.reshape(len(values), -1).T]
    )


def _uplift(history: dict[str, NDArray[Any]]) -> tuple[NDArray[Any], bool]:
    """Uplift (n,) [m], and whether anything lifts off at all: of a structure the largest of its
    interfaces; 0 of a model whose history has none.
    """
    rises, tilts = (
        [
            values
            for name, values in history.items()
            if name.startswith("interface/") and name.endswith(f"/{what}")
        ]
        for what in ("rise", "tilt")
    )
    height = np.maximum(np.max(rises, axis=0), 0.0) if rises else np.zeros(len(history["time"]))
    # an edge that is lifted by a share of the width is a tilt of as much
    return height, bool(
        np.max(tilts) > LIFTED_UPLIFT if tilts else np.max(history["tilt"]) > LIFTED_UPLIFT
    )


def differing_keys(a: Case, b: Case) -> list[tuple[str, object, object]]:
    """Keys of two cases that differ, and their values; files of the same content are the same."""
    alike = a.short and b.short
    tables = [_flat(case.as_stated() if alike else case.tables()) for case in (a, b)]
    found: list[tuple[str, object, object]] = []
    for key in dict.fromkeys([*tables[0], *tables[1]]):
        values = [table.get(key) for table in tables]
        if (
            key != "title"
            and values[0] != values[1]
            and not (
                all(isinstance(value, str) for value in values)
                and content(str(values[0])) == content(str(values[1]))
            )
        ):
            found.append((key, values[0], values[1]))
    of_a, of_b = ({key.partition(".")[0] for key in table} for table in tables)
    defaults = {f"{name}.{key}" for name in of_a ^ of_b for key in _at_default(a, b, name)}
    return [row for row in found if row[0] not in defaults]


def _at_default(a: Case, b: Case, section: str) -> list[str]:
    """Keys at their default of a section that one of two cases lacks: they tell nothing."""
    there = getattr(a, section, None) or getattr(b, section, None)
    return (
        [
            field.name
            for field in dataclasses.fields(there)
            if getattr(there, field.name) == field.default
        ]
        if dataclasses.is_dataclass(there)
        else []
    )


def _flat(tables: dict[str, Any], before: str = "") -> dict[str, Any]:
    """Tables as one, by dotted key."""
    flat: dict[str, Any] = {}
    for key, value in tables.items():
        flat.update(
            _flat(value, f"{before}{key}.")
            if isinstance(value, dict)
            else {f"{before}{key}": value}
        )
    return flat


def quantity_of(name: str, pair: QuantityPair) -> Quantity:
    """How a quantity is written: its unit with a prefix that suits the peak."""
    words, unit, _ = QUANTITIES[name]
    return Quantity.of(words, unit, pair.peak)
