"""summary.json of a result folder, believed only where it is whole and of the right analysis."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from fecolumn.foundation.atomic import write_json
from fecolumn.foundation.digests import digest_of_json
from fecolumn.foundation.files import Unreadable, read_json
from fecolumn.foundation.schema import InputError

SUMMARY_FILE = "summary.json"
# What tables, figures and statistics take from every summary, whichever function wrote it: numbers
# of at least 0
_NUMBERS = ("u_max_m", "residual_slide_m", "steps", "wall_s", "s_per_step", "energy_closure_rel")
# The same of summaries that have them
_OPTIONAL = (
    "tilt_max_rad",
    "duration_s",
    "overturned_at_s",
    "overturn_time_s",
    "slid_off_at_s",
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
    "dt_s",
    "motion_cut_at_s",
)
_MOST_BYTES = 10_000_000


def write_sealed(folder: Path, summary: dict[str, Any]) -> dict[str, Any]:
    """Write the summary of an analysis with the digest of what it says; returns it with that."""
    said = {key: value for key, value in summary.items() if key != "digest"}
    whole = said | {"digest": digest_of_json(said)}
    write_json(Path(folder) / SUMMARY_FILE, whole)
    return whole


def summary_of_folder(folder: Path) -> dict[str, Any]:
    """The summary in a result folder, of the case of its case.json.

    Raises
    ------
    InputError
        there is none, it is damaged, edited, or of another case.
    """
    folder = Path(folder)
    try:
        return read_summary(folder, str(_id_of(folder)))
    except Unreadable as error:
        raise InputError(
            folder / SUMMARY_FILE,
            "",
            None,
            f"{error}; remove it and run the case into this folder again",
        ) from None


def check_owner(file: Path) -> None:
    """Refuse a file of results that another case has written than that of its folder.

    Raises
    ------
    InputError
        it is of another case; what cannot be read is left to who reads it.
    """
    import h5py

    try:
        own = _id_of(Path(file).parent)
        with h5py.File(file) as content:
            found = content.attrs.get("case_id", own)
    except Exception:  # whatever a damaged file makes h5py raise
        return
    if own is not None and str(found) != str(own):
        raise InputError(
            file,
            "case_id",
            str(found),
            f"is of another case: must be {own}, as case.json beside it says; put the file back "
            "that belongs here, or run the case into a new folder",
        )


def _id_of(folder: Path) -> Any:
    """Id of the case of a result folder; None where it does not say."""
    try:
        saved = read_json(folder / "case.json")
    except Unreadable:
        return None
    return saved.get("id") if isinstance(saved, dict) else None


def read_summary(folder: Path, case_id: str) -> dict[str, Any]:
    """The summary in a result folder.

    Raises
    ------
    Unreadable
        there is none, it is damaged, or it is of another case.
    """
    summary: dict[str, Any] = read_json(Path(folder) / SUMMARY_FILE, _MOST_BYTES)
    if fault := fault_of(summary, case_id):
        raise Unreadable(f"is damaged: {fault}")
    return summary


def fault_of(summary: object, case_id: str) -> str:
    """What keeps `summary` from being the summary of a case, in words; empty where nothing does."""
    if not isinstance(summary, dict):
        return "not a table of keys"
    if summary.get("case_id") != case_id:
        return f"case_id must be {case_id}"
    said = {key: value for key, value in summary.items() if key != "digest"}
    if "digest" in summary and summary["digest"] != digest_of_json(said):
        return "it is not what its digest says, but has been changed since the analysis wrote it"
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
