"""What the figure of two analyses that part needs of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from numpy.typing import NDArray


class DrawnPair(Protocol):
    """One quantity of both analyses; `results.parting.QuantityPair` is one."""

    @property
    def a(self) -> NDArray[Any]:
        """(n, k) in SI units, of A."""

    @property
    def b(self) -> NDArray[Any]:
        """(n, k) in SI units, of B."""

    @property
    def peak(self) -> float:
        """The larger of both largest magnitudes."""

    @property
    def difference(self) -> NDArray[Any]:
        """(n,) magnitude of a - b."""

    @property
    def parted(self) -> int | None:
        """Row at which they part; None where they do not."""


class DrawnParting(Protocol):
    """Two analyses as the figure needs them; `results.parting.Parting` is one."""

    @property
    def time(self) -> NDArray[Any]:
        """(n,) [s]."""

    @property
    def tolerance(self) -> float:
        """Of a difference over the larger peak [-]."""

    @property
    def quantities(self) -> Mapping[str, DrawnPair]:
        """By name."""

    @property
    def energy(self) -> Mapping[str, DrawnPair]:
        """By the terms of the ledger [J]."""

    @property
    def first(self) -> tuple[str, float] | None:
        """The quantity that parts first and the time [s]; None where none does."""
