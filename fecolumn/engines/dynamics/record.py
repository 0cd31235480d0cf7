"""What the steps of an analysis cost."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class Record:
    """Iterations of positions and of contact problems, impacts, cuts of steps that fail, parts of
    steps in which the rim rolls fast, iterations of the problems of impacts.
    """

    iterations: int = 0
    contact_iterations: int = 0
    impacts: int = 0
    cuts: int = 0
    parts: int = 0
    impact_iterations: int = 0
