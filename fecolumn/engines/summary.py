"""summary.json of a result folder, believed only where it is whole and of the right analysis."""

from __future__ import annotations

import math
from pathlib import Path

from fecolumn.foundation.files import Unreadable, read_json

NAME = "summary.json"
# What tables, figures and statistics take from every summary, whichever function wrote it: numbers
# of at least 0
_NUMBERS = ("u_max_m", "residual_slide_m", "steps", "wall_s", "s_per_step", "energy_closure_rel")
# The same of summaries that have them
_OPTIONAL = (
    "tilt_max_rad",
    "duration_s",
    "overturn_time_s",
    "cpu_s",
    "dofs",
    "iterations",
    "contact_iterations",
    "impact_iterations",
    "impacts",
    "cuts",
    "parts",
    "factorizations",
    "ranks",
    "dt",
    "motion_cut_at_s",
)
_MOST_BYTES = 10_000_000


def read_summary(folder: Path, case_id: str) -> dict:
    """The summary in a result folder.

    Raises
    ------
    Unreadable
        there is none, it is damaged, or it is of another case.
    """
    summary = read_json(Path(folder) / NAME, _MOST_BYTES)
    if fault := fault_of(summary, case_id):
        raise Unreadable(f"is damaged: {fault}")
    return summary


def fault_of(summary, case_id: str) -> str:
    """What keeps `summary` from being the summary of a case, in words; empty where nothing does."""
    if not isinstance(summary, dict):
        return "not a table of keys"
    if summary.get("case_id") != case_id:
        return f"case_id must be {case_id}"
    if not isinstance(summary.get("overturned"), bool):
        return "overturned must be true or false"
    for name in (*_NUMBERS, *(name for name in _OPTIONAL if summary.get(name) is not None)):
        value = summary.get(name)
        if (
            not isinstance(value, (int, float))
            or isinstance(value, bool)
            or not 0 <= value < math.inf
        ):
            return f"{name} must be a number of at least 0"
        if isinstance(value, int) and value > 1e300:
            return f"{name} is too large"
    energy = summary.get("energy_j", {})
    if not isinstance(energy, dict) or not all(
        isinstance(value, (int, float)) and abs(value) < 1e300 for value in energy.values()
    ):
        return "energy_j must be a table of numbers"
    return ""
