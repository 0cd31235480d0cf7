"""What tables and figures need of a study: its `study.plan.Plan` has it, and so has what is read
from the folder of a study alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol


class PlannedMember(Protocol):
    """An analysis of a study."""

    @property
    def id(self) -> str:
        """Of its case."""

    @property
    def combination(self) -> dict[str, Any]:
        """The values, by axis, that name the ensemble it belongs to."""


class PlannedStudy(Protocol):
    """A study."""

    @property
    def title(self) -> str:
        """Of its tables and figures."""

    @property
    def analyses(self) -> Sequence[PlannedMember]:
        """In the order of the study file."""
