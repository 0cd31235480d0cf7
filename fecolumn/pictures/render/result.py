"""A finished analysis, read from its folder for pictures."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.case.case import Case
from fecolumn.engines.reduced.states import STATES_FILE as STATES
from fecolumn.engines.scene.scene import JointFace, Scene
from fecolumn.engines.stored import stored_history
from fecolumn.engines.summary import SUMMARY_FILE, read_summary
from fecolumn.foundation.files import Unreadable, is_file, read_json
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.field_frames import FieldFrames
from fecolumn.pictures.render.pose import Poses
from fecolumn.pictures.render.scene_history import SceneHistory, read_scene_history
from fecolumn.pictures.render.state_frames import StateFrames
from fecolumn.simulation import read_folder_case

# Base that is shown around a foot, and height that the view of the foot shows, over its width [-]
_AROUND_FOOT, _ABOVE_FOOT = 0.6, 0.9
# Plane ground that is shown around all bodies, over their width [-], and how many of its squares go
# into this width
_AROUND, _SQUARES = 0.08, 10
# Poses of which the reach of bodies is found
_POSES = 500
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
        of the folder.
    summary
        of `fecolumn.engines.summary`.
    history
        columns of n rows by name
    scene_history
        motion of the scene by these columns.
    fields
        FieldFrames, without frames where none were written.
    states
        StateFrames; None where none were kept.
    """

    folder: Path
    case: Case
    summary: dict
    history: dict[str, np.ndarray]
    scene_history: SceneHistory
    fields: FieldFrames
    states: StateFrames | None

    @property
    def scene(self) -> Scene:
        """What is drawn."""
        return self.scene_history.scene

    @property
    def poses(self) -> tuple[Poses, ...]:
        """Of each body, at the rows of the history."""
        return self.scene_history.poses

    @property
    def time(self) -> np.ndarray:
        """(n,) [s] of the rows of the history."""
        return self.history["time"]

    @property
    def u_top(self) -> np.ndarray:
        """Displacement (n, 3) [m] of the top that is followed."""
        return self.scene_history.u_top

    @property
    def path(self) -> np.ndarray:
        """Its positions (n, 3) [m]."""
        return self.u_top + self.scene_history.top

    @property
    def top_title(self) -> str:
        """Title of its plan view."""
        return self.scene_history.title

    @property
    def height(self) -> float:
        """Of all bodies [m]."""
        return self.scene.height

    @property
    def frames(self) -> FieldFrames | StateFrames:
        """Fields as often as they are known: as they were written, or made from states where these
        are closer to one another.
        """
        return (
            self.states
            if self.states and self.states.interval < 0.99 * self.fields.interval
            else self.fields
        )

    @property
    def grounds(self) -> list[tuple[np.ndarray, np.ndarray, float]]:
        """Of each ground that is a plane: lowest and highest corner (3,) [m] of the piece that is
        shown, and the size of its squares [m].
        """
        scene, times, found = self.scene, self.poses[0].time, []
        every = times[:: max(1, len(times) // _POSES)]
        margin, square = _AROUND * scene.width, scene.width / _SQUARES
        for place, level in scene.planes.items():
            own = {one.piece for one in scene.contacts if one.stands_on(place)}
            if not own:
                continue
            # the only ground is below all
            everything = range(len(scene.bodies)) if len(scene.planes) == 1 else own
            reach = self._reached(every, everything)[:, :2]
            low = np.floor((reach.min(axis=0) - margin) / square) * square
            high = np.ceil((reach.max(axis=0) + margin) / square) * square
            found.append((np.append(low, level), np.append(high, level), square))
        return found

    def _reached(self, times: np.ndarray, numbers: Iterable[int]) -> np.ndarray:
        """Corners (n, 3) [m] of the boxes around bodies of these numbers at `times` [s]."""
        found = []
        for number in numbers:
            piece, poses = self.scene.bodies[number], self.poses[number]
            low, high = piece.upright.min(axis=0), piece.upright.max(axis=0)
            box = np.array(np.meshgrid(*zip(low, high))).reshape(3, -1).T
            found.append(poses.at(times).move(box, slice(None)).reshape(-1, 3))
        return np.concatenate(found)

    def shown(self, view: str, times: np.ndarray) -> np.ndarray:
        """Points (n, 3) [m] that a picture of these times [s] must show."""
        if view == "foot":
            corners, size = self._around(self._foot(), times)
            return np.concatenate([corners, corners + [0, 0, _ABOVE_FOOT * size]])
        contacts = [one for one in self.scene.contacts if one.on_ground]
        plates = [one for one in contacts if one.ground not in self.scene.planes]
        around = [self._around(one, times)[0] for one in plates] + [
            np.array([[x, y, low[2]] for x in (low[0], high[0]) for y in (low[1], high[1])])
            for low, high, _ in self.grounds
        ]
        return np.concatenate([self._reached(times, range(len(self.poses))), *around])

    def _foot(self) -> JointFace:
        """The lowest face of the followed body, or where it has none of its own, of the body on the
        ground that tilts most.
        """
        contacts = [contact for contact in self.scene.contacts if contact.on_ground]
        own = [contact for contact in contacts if contact.piece == self.scene_history.body]
        return (own or sorted(contacts, key=self._largest_tilt))[-1]

    def _largest_tilt(self, contact: JointFace) -> float:
        return -float(self.poses[contact.piece].rotation[:, 2, 2].min())

    def _around(self, contact: JointFace, times: np.ndarray) -> tuple[np.ndarray, float]:
        """Corners (n, 3) [m] of what is shown of the ground around a foot, and its width [m]."""
        foot = self.scene.points[contact.points]
        size = float(np.ptp(foot[:, :2], axis=0).max())
        moved = self.poses[contact.piece].at(times).move(foot.mean(axis=0)[None], slice(None))
        side = (0.5 + _AROUND_FOOT) * size
        corners = np.array([[-side, -side, 0], [side, -side, 0], [-side, side, 0], [side, side, 0]])
        level = [0, 0, contact.origin[2]]
        return (moved * [1, 1, 0] + corners + level).reshape(-1, 3), size


def read_result(folder: Path | str, body: str = "") -> Result:
    """The analysis in a folder of `fecolumn run`.

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
    for table in case.own:
        raise InputError(
            folder,
            table,
            None,
            "is the table of a rocking model, which has no bodies to draw; figures of its history "
            "are in the folder; pictures need a case with [bodies] and the model's name as "
            "integration.engine",
        )
    if not is_file(folder / SUMMARY_FILE):
        raise InputError(
            folder,
            "",
            None,
            f"the analysis has not ended (no {SUMMARY_FILE}); fecolumn resume {folder} goes on "
            "with it",
        )
    try:
        summary = read_summary(folder, read_json(folder / "case.json").get("id"))
    except Unreadable as error:
        raise InputError(folder / SUMMARY_FILE, "", None, str(error)) from None
    history = read_rows(folder / "history.h5")
    known = read_scene_history(case, folder, history, body)
    fields = FieldFrames(folder / "fields")
    fields.check(known.scene)
    states = StateFrames(folder / STATES, known.scene) if is_file(folder / STATES) else None
    return Result(folder, case, summary, history, known, fields, states)


def read_rows(file: Path) -> dict[str, np.ndarray]:
    """Columns of a history of three rows at least.

    Raises
    ------
    InputError
        none, or one that says nothing of a motion.
    """
    history = stored_history(file)
    missing = [name for name in _NEEDED if name not in history]
    if missing:
        raise InputError(file, "", None, f"not a history of an analysis (no {missing[0]})")
    if len(history["time"]) < 3:
        raise InputError(file, "", None, "has fewer than three rows: nothing moves")
    return history
