"""What the estimate of a case reads of its scene, which imports structures, and not they it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from numpy.typing import NDArray


class DrawnPiece(Protocol):
    """A body or an elastic ground, as of `engines.scene.scene.Piece`."""

    @property
    def kind(self) -> str:
        """Name of its body or ground."""

    @property
    def elements(self) -> NDArray[Any]:
        """(n, 8, 4 or 3) numbers of its points."""

    @property
    def points(self) -> NDArray[Any]:
        """(n, 3) [m]."""

    @property
    def carried(self) -> int:
        """How many of its last points are floors of a building."""

    @property
    def held(self) -> bool:
        """Whether it is part of the ground."""

    @property
    def stressed(self) -> bool:
        """Whether it deforms as a continuum."""


class DrawnContact(Protocol):
    """A joint, as of `engines.scene.scene.JointFace`."""

    @property
    def piece(self) -> int:
        """Number of the slave."""

    @property
    def on_ground(self) -> bool:
        """Whether it is with a ground."""


class DrawnScene(Protocol):
    """As of `engines.scene.scene.Scene`."""

    @property
    def pieces(self) -> Sequence[DrawnPiece]:
        """Bodies first."""

    @property
    def contacts(self) -> Sequence[DrawnContact]:
        """Of each joint."""
