"""A finished analysis of a structure, read from its folder for pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.files import is_file
from fecolumn.reduced.states import NAME as STATES
from fecolumn.render.field_frames import FieldFrames
from fecolumn.render.pose import Poses
from fecolumn.render.structure_field_frames import StructureFieldFrames
from fecolumn.render.structure_solid import StructureSolid, structure_solid
from fecolumn.render.structure_states import StructureStates
from fecolumn.schema import InputError, meant
from fecolumn.structures.case import StructureCase
from fecolumn.structures.model import GROUND

# Ground that is shown around a structure, over its width [-], and how many of its squares go into
# this width
_AROUND, _SQUARES = 0.08, 10
# Of the view of a foot: what is shown around it and above it, over its width [-]
_AROUND_FOOT, _ABOVE_FOOT = 0.6, 0.9


@dataclass(frozen=True, slots=True)
class StructureResult:
    """What a result folder holds.

    Attributes
    ----------
    folder
        of the analysis.
    case
        StructureCase.
    summary
        of `fecolumn.summary`.
    history
        columns of n rows by name.
    solid
        StructureSolid.
    states
        StructureStates, of the full engine StructureFieldFrames
    poses
        Poses of each body at these.
    fields
        FieldFrames that were written.
    body
        place of the body whose top is followed.
    """

    folder: Path
    case: StructureCase
    summary: dict
    history: dict[str, np.ndarray]
    solid: StructureSolid
    states: StructureStates | StructureFieldFrames
    poses: tuple[Poses, ...]
    fields: FieldFrames
    body: int

    @property
    def frames(self) -> StructureStates | StructureFieldFrames:
        """Instants at which deformation and stress are known."""
        return self.states

    @property
    def time(self) -> np.ndarray:
        """(n,) [s] of the rows of the history."""
        return self.history["time"]

    @property
    def way(self) -> np.ndarray:
        """Displacement (n, 3) [m] of the top that is followed."""
        return self.history[f"mark/{self._name}.{self._mark}/displacement"]

    @property
    def path(self) -> np.ndarray:
        """Its positions (n, 3) [m]."""
        part = self.solid.structure.parts[self.body]
        return self.way + part.center + part.model.marks[self._mark][0]

    @property
    def top_title(self) -> str:
        """Title of its plan view."""
        return f"{'top' if self._mark == 'top' else self._mark} of {self._name}"

    @property
    def _name(self) -> str:
        return self.solid.structure.parts[self.body].name

    @property
    def _mark(self) -> str:
        body, mark = self.solid.structure.observed
        return mark if body == self.body else "top"

    @property
    def height(self) -> float:
        """[m]"""
        return self.solid.height

    @property
    def outlines(self) -> np.ndarray:
        """Edges (n, 2, 3) [m] of the feet on the ground where they stood at first."""
        return self.solid.outlines

    @property
    def ground(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Lowest and highest corner (2,) [m] of the piece of ground that is shown, and the size of
        its squares [m].
        """
        reach = self._reached(slice(None))[:, :2]
        margin, square = _AROUND * self.solid.width, self.solid.width / _SQUARES
        low, high = (
            np.floor((reach.min(axis=0) - margin) / square) * square,
            np.ceil((reach.max(axis=0) + margin) / square) * square,
        )
        return low, high, square

    @property
    def grounds(self) -> list[tuple[np.ndarray, np.ndarray, float, float]]:
        """Of each piece of ground that is shown corners and squares as of `ground`, and its height
        [m]; of several each is seen around the feet on it.
        """
        low, high, square = self.ground
        structure = self.solid.structure
        if len(structure.levels) == 1:
            return [(low, high, square, structure.levels[0])]
        found = []
        for place, level in enumerate(structure.levels):
            feet = [
                (structure.parts[one.slave], one.slave_surface)
                for one in structure.joints
                if one.master == GROUND and one.ground == place
            ]
            if feet:
                places = np.concatenate(
                    [
                        part.center + part.model.arms[part.model.surfaces[name].nodes]
                        for part, name in feet
                    ]
                )[:, :2]
                margin = np.ptp(places, axis=0).max() / 2
                own = places.min(axis=0) - margin, places.max(axis=0) + margin
                found.append((np.maximum(own[0], low), np.minimum(own[1], high), square, level))
        return found

    def _reached(self, rows) -> np.ndarray:
        """Corners (n, 3) [m] of the boxes around all bodies at the states `rows`."""
        found = []
        for piece, part, poses in zip(self.solid.pieces, self.solid.structure.parts, self.poses):
            box = (
                np.array(np.meshgrid(*zip(piece.points.min(axis=0), piece.points.max(axis=0))))
                .reshape(3, -1)
                .T
                - part.model.center
                + part.center
            )
            found.append(poses.move(box, rows).reshape(-1, 3))
        return np.concatenate(found)

    def shown(self, view: str, times: np.ndarray) -> np.ndarray:
        """Points (n, 3) [m] that a picture of these times [s] must show."""
        rows = np.unique(
            np.concatenate(
                [
                    self.states.nearest(times),
                    np.flatnonzero(
                        (self.states.time >= times[0]) & (self.states.time <= times[-1])
                    ),
                ]
            )
        )
        if view == "foot":
            return self._around_foot(rows)
        low, high, _ = self.ground
        return np.concatenate(
            [
                self._reached(rows),
                [
                    [x, y, level]
                    for level in self.solid.structure.levels
                    for x in (low[0], high[0])
                    for y in (low[1], high[1])
                ],
            ]
        )

    def _around_foot(self, rows) -> np.ndarray:
        """What is around the lowest face of the followed body, or where it has none of its own, of
        the body below that tilts most.
        """
        contacts = [contact for contact in self.solid.contacts if contact.on_ground]
        own = [contact for contact in contacts if contact.part == self.body]
        contact = (
            own[0]
            if own
            else max(contacts, key=lambda one: self.history[f"body/{one.slave}/tilt"].max())
        )
        foot = self.solid.points[contact.points]
        size = float(np.ptp(foot[:, :2], axis=0).max())
        moved = self.poses[contact.part].move(foot.mean(axis=0)[None], rows).reshape(-1, 3) * [
            1,
            1,
            0,
        ]
        side = (0.5 + _AROUND_FOOT) * size
        around = (
            moved[:, None]
            + np.array([[-side, -side, 0], [side, -side, 0], [-side, side, 0], [side, side, 0]])
        ).reshape(-1, 3)
        return np.concatenate([around, around + [0, 0, _ABOVE_FOOT * size]])

    def strips(self, times: np.ndarray) -> list:
        """Strip of each quantity that is drawn over time."""
        from fecolumn.render.structure_strips import structure_strips

        return structure_strips(self, times)

    def frames_at(
        self, times: np.ndarray, interval: float, exaggerate: float | str, colour: str, like=None
    ):
        """StructureFrames at times [s]."""
        from fecolumn.render.structure_frames import StructureFrames

        return StructureFrames(self, times, exaggerate, colour, like)


def structure_result(
    folder: Path, case: StructureCase, summary: dict, history: dict, body: str
) -> StructureResult:
    """The analysis of a structure in a folder.

    Raises
    ------
    InputError
        it kept no states or damaged ones, its files are gone, or it has no such body.
    """
    from fecolumn.structures.engine import upright
    from fecolumn.structures.layout import layout_of
    from fecolumn.structures.structure import structure_model

    file = folder / "case.json"
    written = any((folder / "fields").glob("frame_*.h5"))
    if not written and not is_file(folder / STATES):
        kept, key = (
            ("wrote no fields", "fields_every_s")
            if case.integration.engine == "full"
            else (f"kept no states ({STATES})", "states_every_s")
        )
        raise InputError(
            folder,
            "",
            None,
            f"{kept}, which alone tell how its bodies turn: run the case into a new "
            f"folder with output.{key} = 0.04",
        )
    structure = upright(case, structure_model(case, file))
    copies = [(name, number) for name in case.bodies for number in range(len(case.names_of(name)))]
    place = _place(structure, body)
    solid = structure_solid(layout_of(case, file).drawings, structure, copies)
    _check_columns(folder / "history.h5", history, structure)
    states = (
        StructureStates(folder / STATES, solid, _shapes_of(case, copies, file))
        if is_file(folder / STATES)
        else StructureFieldFrames(folder / "fields", solid)
    )
    poses = tuple(
        Poses(states.time, states.rotation[:, k], states.center[:, k], part.center)
        for k, part in enumerate(structure.parts)
    )
    return StructureResult(
        folder, case, summary, history, solid, states, poses, FieldFrames(folder / "fields"), place
    )


def _place(structure, body: str) -> int:
    if not body:
        return structure.observed[0]
    names = [part.name for part in structure.parts]
    if body not in names:
        raise InputError(
            "fecolumn render",
            "--body",
            body,
            f"no such body{meant(body, names)}; there are {', '.join(names)}",
        )
    return names.index(body)


def _check_columns(file: Path, history: dict, structure) -> None:
    missing = [
        name
        for part in structure.parts
        for name in (f"body/{part.name}/tilt", f"mark/{part.name}.top/displacement")
        if name not in history
    ]
    missing += [
        name
        for joint in structure.joints
        for name in (f"interface/{joint.name}/rise",)
        if joint.pair < 0 and name not in history
    ]
    if missing:
        raise InputError(
            file,
            "",
            None,
            f'has no column "{missing[0]}": it is of another structure than that of case.json',
        )


def _shapes_of(case, copies, file):
    """As of `structure_fields.StructureFields`: what reads the shapes of a part's modes all over
    it.
    """
    from fecolumn.structures.store import body_folder
    from fecolumn.structures.structure import kept_keys

    keys = kept_keys(case, file)

    def of_part(place):
        return lambda: np.load(body_folder(keys[copies[place][0]]) / "fields.npy", mmap_mode="r")

    return of_part
