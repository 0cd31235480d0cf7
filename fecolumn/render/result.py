"""A finished analysis, read from its folder for pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.case import read_case as Case
from fecolumn.dynamics.history import read_history
from fecolumn.files import Unreadable, is_file, read_json
from fecolumn.reduced.states import NAME as STATES
from fecolumn.render.field_frames import FieldFrames, FrameSeries
from fecolumn.render.pose import Poses, poses
from fecolumn.render.solid import Solid, solid_of
from fecolumn.render.state_frames import StateFrames
from fecolumn.schema import InputError
from fecolumn.simulation import read_folder_case
from fecolumn.structures.case import StructureCase
from fecolumn.summary import NAME, read_summary

# Base that is shown around the foot, size of its squares where it has no bricks, and height that
# the view of the foot shows, over the foot's width [-]
_AROUND, _SQUARE, _FOOT_HEIGHT = 0.6, 0.25, 0.9
_NEEDED = (
    "time",
    "u_top",
    "slide",
    "tilt",
    "twist",
    "ground",
    "energy/kinetic",
    "energy/gravity",
    "energy/strain",
)


@dataclass(frozen=True, slots=True)
class Result:
    """What a result folder holds.

    Attributes
    ----------
    folder
        of the analysis.
    case
        finished.
    summary
        of `fecolumn.summary`.
    history
        columns of n rows by name
    poses
        Poses at these rows.
    solid
        Solid.
    fields
        FieldFrames, without frames where none were written.
    states
        StateFrames; None where none were kept.
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
    def time(self) -> np.ndarray:
        """(n,) [s] of the rows of the history."""
        return self.history["time"]

    @property
    def way(self) -> np.ndarray:
        """Displacement (n, 3) [m] of the top."""
        return self.history["u_top"]

    @property
    def path(self) -> np.ndarray:
        """Positions (n, 3) [m] of the top's centre."""
        return self.way + self.solid.top

    #: Title of its plan view.
    top_title = "top in plan"

    @property
    def height(self) -> float:
        """[m]"""
        return self.solid.height

    @property
    def outlines(self) -> np.ndarray:
        """Edges (n, 2, 3) [m] of the foot where it stood at first."""
        from fecolumn.mesh.bricks import outline_edges

        return self.solid.mesh.body.points[outline_edges(self.solid.foot_faces)]

    @property
    def ground(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Lowest and highest corner (2,) [m] of the piece of ground that is shown where the base
        has no bricks, and the size of its squares [m].
        """
        width, foot = self.solid.foot_width, self.poses.foot[:, :2]
        return foot.min(axis=0) - 1.5 * width, foot.max(axis=0) + 1.5 * width, _SQUARE * width

    def shown(self, view: str, times: np.ndarray) -> np.ndarray:
        """Points (n, 3) [m] that a picture of these times [s] must show."""
        poses, solid = self.poses.at(times), self.solid
        body = solid.mesh.body.points
        low, high = body.min(axis=0), body.max(axis=0)
        margin = _AROUND * solid.foot_width
        around = poses.foot[:, None, :] * [1, 1, 0] + np.array(
            [[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]]
        ) * (solid.foot_width / 2 + margin)
        if view == "foot":
            return np.concatenate(
                [
                    around.reshape(-1, 3),
                    around.reshape(-1, 3) + [0, 0, _FOOT_HEIGHT * solid.foot_width],
                ]
            )
        corners = np.array(np.meshgrid(*zip(low, high))).reshape(3, -1).T
        return np.concatenate(
            [poses.move(corners, slice(None)).reshape(-1, 3), around.reshape(-1, 3)]
        )

    def strips(self, times: np.ndarray) -> list:
        """Strip of each quantity that is drawn over time."""
        from fecolumn.render.strips import strips_of

        return strips_of(self, times)

    def frames_at(
        self, times: np.ndarray, interval: float, exaggerate: float | str, colour: str, like=None
    ):
        """Frames, as of `render.frames.Frames`."""
        from fecolumn.render.frames import Frames

        return Frames(self, times, interval, exaggerate, colour, like)

    @property
    def frames(self) -> FrameSeries:
        """Fields as often as they are known: as they were written, or made from states where these
        are closer to one another.
        """
        return (
            self.states
            if self.states and self.states.interval < 0.99 * self.fields.interval
            else self.fields
        )


def read_result(folder, body: str = ""):
    """The analysis in a folder of `fecolumn run`: a Result, of a structure a StructureResult.

    Parameters
    ----------
    body
        of a structure, whose top is followed; the observed one unless given.

    Raises
    ------
    InputError
        no such folder, one of a study, an analysis that has not ended, files that are damaged, or
        no such body.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(
            folder, "", None, "no such folder; a result folder of fecolumn run is needed"
        )
    if is_file(folder / "study.json"):
        raise InputError(
            folder,
            "",
            None,
            "is the folder of a study; give that of one of its analyses, "
            f"{folder / 'analyses'}/CASE_ID",
        )
    case, _ = read_folder_case(folder)
    if hasattr(case, "table"):
        raise InputError(
            folder,
            case.table,
            None,
            "is a rocking model of rigid bodies: nothing is meshed that could be "
            "drawn; its history has figures",
        )
    if not is_file(folder / NAME):
        raise InputError(
            folder,
            "",
            None,
            f"the analysis has not ended (no {NAME}); fecolumn resume {folder} goes on with it",
        )
    try:
        summary = read_summary(folder, read_json(folder / "case.json").get("id"))
    except Unreadable as error:
        raise InputError(folder / NAME, "", None, str(error)) from None
    history = read_rows(folder / "history.h5")
    if isinstance(case, StructureCase):
        from fecolumn.render.structure_result import structure_result

        return structure_result(folder, case, summary, history, body)
    if body:
        raise InputError(
            "fecolumn render",
            "--body",
            body,
            f"is for structures of [bodies]; {folder} holds a single column",
        )
    case = finished(case, folder / "case.json")
    solid = solid_of(case)
    fields = FieldFrames(folder / "fields")
    if len(fields.time) and not fields.fits(solid):
        raise InputError(
            folder / "fields",
            "",
            None,
            "is of another mesh than that of the case made now; render with the "
            "version that made it, or remove this folder",
        )
    states = StateFrames(folder / STATES, case) if is_file(folder / STATES) else None
    return Result(
        folder, case, summary, history, poses(history, solid.foot, solid.top), solid, fields, states
    )


def read_rows(file: Path) -> dict[str, np.ndarray]:
    """Columns of a history of three rows at least.

    Raises
    ------
    InputError
        none, or one that says nothing of a motion.
    """
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
