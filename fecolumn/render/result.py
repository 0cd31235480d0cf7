"""A finished analysis, read from its folder for pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.case import Case, finished
from fecolumn.dynamics.history import read_history
from fecolumn.files import Unreadable, is_file, read_json
from fecolumn.reduced.states import NAME as STATES
from fecolumn.render.field_frames import FieldFrames, FrameSeries
from fecolumn.render.pose import Poses, poses
from fecolumn.render.solid import Solid, solid_of
from fecolumn.render.state_frames import StateFrames
from fecolumn.schema import InputError
from fecolumn.simulation import read_folder_case
from fecolumn.summary import NAME, read_summary

_NEEDED = ("time", "u_top", "slide", "tilt", "twist", "ground", "energy/kinetic", "energy/gravity", "energy/strain")


@dataclass(frozen=True, slots=True)
class Result:
    """What a result folder holds.

    Attributes:
        folder: of the analysis. case: finished. summary: of `fecolumn.summary`.
        history: columns of n rows by name; poses: Poses at these rows. solid: Solid.
        fields: FieldFrames, without frames where none were written. states: StateFrames; None where none were kept.
    """

    folder: Path
    case: Case
    summary: dict
    history: dict[str, np.ndarray]
    poses: Poses
    solid: Solid
    fields: FieldFrames
    states: StateFrames | None

    @property
    def frames(self) -> FrameSeries:
        """Fields as often as they are known: as they were written, or made from states where these are closer to one another."""
        return self.states if self.states and self.states.interval < 0.99 * self.fields.interval else self.fields


def read_result(folder) -> Result:
    """The analysis in a folder of `fecolumn run`.

    Raises:
        InputError: no such folder, one of a study, an analysis that has not ended, or files that are damaged.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(folder, "", None, "no such folder; a result folder of fecolumn run is needed")
    if is_file(folder / "study.json"):
        raise InputError(folder, "", None, f"is the folder of a study; give that of one of its analyses, {folder / 'analyses'}/CASE_ID")
    case, _ = read_folder_case(folder)
    if hasattr(case, "table"):
        raise InputError(folder, case.table, None, "is a rocking model of rigid bodies: nothing is meshed that could be drawn; its history has figures")
    case = finished(case, folder / "case.json")
    if not is_file(folder / NAME):
        raise InputError(folder, "", None, f"the analysis has not ended (no {NAME}); fecolumn resume {folder} goes on with it")
    try:
        summary = read_summary(folder, read_json(folder / "case.json").get("id"))
    except Unreadable as error:
        raise InputError(folder / NAME, "", None, str(error)) from None
    history = _history(folder / "history.h5")
    solid = solid_of(case)
    fields = FieldFrames(folder / "fields")
    if len(fields.time) and not fields.fits(solid):
        raise InputError(folder / "fields", "", None, "is of another mesh than that of the case made now; render with the version that made it, or remove this folder")
    states = StateFrames(folder / STATES, case) if is_file(folder / STATES) else None
    return Result(folder, case, summary, history, poses(history, solid.foot, solid.top), solid, fields, states)


def _history(file: Path) -> dict[str, np.ndarray]:
    try:
        history = read_history(file)
    except (OSError, KeyError) as error:
        raise InputError(file, "", None, f"not a history of an analysis ({error})") from None
    missing = [name for name in _NEEDED if name not in history]
    if missing:
        raise InputError(file, "", None, f"not a history of an analysis (no {missing[0]})")
    if len(history["time"]) < 3:
        raise InputError(file, "", None, "has fewer than three rows: nothing moves")
    return history
