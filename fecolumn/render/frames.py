"""Frames of a motion: where every point of the specimen is at an instant, and what colours it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.render.field_frames import Fields
from fecolumn.render.pose import nearest_rigid
from fecolumn.render.quantity import Quantity
from fecolumn.render.result import Result
from fecolumn.schema import InputError

COLOURS = ("stress", "displacement")
#: Largest elastic displacement as it is drawn under "auto", over the height of the column [-]
SEEN = 0.05
# Points of the pressure's path a frame, so that it is a curve where the column rolls
_FINER = 4
#: Share of the values [-] that colours range over: a single element under the edge on which the
#: column stands would take all colours
RANGE = 99.8
#: Decades of stress and of pressure that colours show: under the edge on which a column rocks they
#: are a hundred times those of standing
DECADES = 3


@dataclass(frozen=True)
class Frame:
    """An instant.

    Attributes
    ----------
    time
        [s].
    column, base
        (n, 3) [m] points of the surfaces of `Solid`, as drawn; base None where it has none.
    colour, base_colour
        of their faces (stress [Pa]), or of the column's points (displacement [m]) and None.
    foot
        (n_faces, k, 3) [m] corners of the foot's faces.
    pressure
        (n_faces,) [Pa] on them, None where it was not written.
    centre
        (2,) [m] of the contact pressure; nan in flight.
    """

    links = struts = None

    time: float
    column: np.ndarray
    base: np.ndarray | None
    colour: np.ndarray
    base_colour: np.ndarray | None
    foot: np.ndarray
    pressure: np.ndarray | None
    centre: np.ndarray


class Scaled:
    """Frames of an analysis on common scales: exaggeration, colour_quantity and pressure_quantity
    as of Frames.

    A subclass has `times`, `colour`, `frame`, `_largest_elastic` and `_pressure_quantity`.
    """

    def __len__(self) -> int:
        return len(self.times)

    def __iter__(self):
        return (self.frame(k) for k in range(len(self)))

    def _scale(self, exaggerate: float | str, height: float, like: Scaled | None) -> None:
        """Find the scales, or take those of `like`; exaggerate: as of Frames, height: of what moves
        [m].
        """
        if like:
            self.exaggeration, self.colour_quantity, self.pressure_quantity = (
                like.exaggeration,
                like.colour_quantity,
                like.pressure_quantity,
            )
            return
        self.exaggeration = 1.0 if exaggerate == "auto" else float(exaggerate)
        if exaggerate == "auto":
            self.exaggeration = round_down(
                SEEN * height / max(max(map(self._largest_elastic, range(len(self)))), 1e-12)
            )
        frames = list(self)
        if self.colour == "displacement":
            self.colour_quantity = Quantity.of(
                "displacement", "m", max(frame.colour.max() for frame in frames)
            )
        else:
            self.colour_quantity = Quantity.of(
                "von Mises stress",
                "Pa",
                max(np.nanpercentile(frame.colour, RANGE) for frame in frames),
                DECADES,
            )
        self.pressure_quantity = self._pressure_quantity(frames)


class Frames(Scaled):
    """Frames of an analysis, from its fields where they are known often enough, written or made
    from states, else from its history.

    Attributes
    ----------
    times
        (k,) [s] of the frames; at an instant of the fields where these are used.
    from_fields
        whether they are. exaggeration: factor on elastic displacements [-].
    colour
        one of COLOURS.
    centres
        (k, 2) [m] of the contact pressure, nan in flight.
    colour_quantity
        Quantity of Frame.colour, pressure_quantity: of Frame.pressure, None where there is none.
    """

    def __init__(
        self,
        result: Result,
        times: np.ndarray,
        interval: float,
        exaggerate: float | str = 1.0,
        colour: str = "",
        like: Frames | None = None,
    ):
        """Frames at `times` (k,) [s], each for `interval` [s]; exaggerate: elastic displacements by
        this factor, or "auto"; colour: of COLOURS, "" for what there is; like: others whose
        exaggeration and ranges of colours these have.

        Raises
        ------
        InputError
            elastic displacements or stress are asked for, and were not written.
        """
        self.result, fields = result, result.frames
        # what the history gives at once is not made from states
        wanted = fields is result.fields or colour != "displacement" or exaggerate != 1.0
        self.from_fields = (
            wanted and bool(len(fields.time)) and fields.interval <= 1.5 * interval + 1e-9
        )
        self.colour = colour or ("stress" if self.from_fields else "displacement")
        if not self.from_fields and (self.colour == "stress" or exaggerate != 1.0):
            asked, value = (
                ("--exaggerate", exaggerate) if exaggerate != 1.0 else ("--color", colour)
            )
            have = (
                f"these are every {fields.interval:.3g} s"
                if len(fields.time) > 1
                else "there are none"
            )
            key = "fields_every_s" if result.case.integration.engine == "full" else "states_every_s"
            raise InputError(
                "fecolumn render",
                asked,
                value,
                f"needs fields or states at least every {1.5 * interval:.3g} s, and {have}; "
                f"run the case into a new folder with output.{key} = {interval:.3g}",
            )
        self._kept: tuple = (None, None)
        if self.from_fields:
            self._number = np.unique(fields.nearest(times))
            times = fields.time[self._number]
        self.times = np.asarray(times, float)
        self._poses = result.poses.at(self.times)
        rows = float(np.median(np.diff(result.poses.time)))
        self._interval = max(
            interval / _FINER, 4 * rows
        )  # of momentum, for which velocities are wanted
        self.centres = self._pressure_centres(self.times)
        body = result.solid.mesh.body
        self._count, self._foot_points = len(body.points), np.unique(result.solid.foot_faces)
        self._scale(exaggerate, result.solid.height, like)

    @property
    def surface(self):
        """Surface of the column, whose points a Frame has."""
        return self.result.solid.column

    @property
    def base_surface(self):
        """Surface of the base; None where it has no bricks."""
        return self.result.solid.base

    def plan(self, figure):
        """What the movie shows of the foot."""
        from fecolumn.render.foot_plan import FootPlan

        return FootPlan(self, figure)

    def frame(self, k: int) -> Frame:
        """Frame `k`."""
        return self._from_fields(k) if self.from_fields else self._from_history(k)

    def _fields(self, k: int) -> Fields:
        """Of frame `k`, the last one kept: a frame is asked for twice, to be drawn and for its
        colours.
        """
        if self._kept[0] != self._number[k]:
            self._kept = self._number[k], self.result.frames.read(self._number[k])
        return self._kept[1]

    def _from_history(self, k: int) -> Frame:
        solid = self.result.solid
        column = self._poses.move(solid.column.points, k)
        foot = self._poses.move(solid.mesh.body.points[solid.foot_faces].reshape(-1, 3), k).reshape(
            *solid.foot_faces.shape, 3
        )
        base = solid.base.points if solid.base else None
        return Frame(
            self.times[k],
            column,
            base,
            np.linalg.norm(column - solid.column.points, axis=1),
            None,
            foot,
            None,
            self.centres[k],
        )

    def _from_fields(self, k: int) -> Frame:
        solid, body = self.result.solid, self.result.solid.mesh.body
        fields = self._fields(k)
        moved = body.points + fields.displacement[: self._count]
        drawn, base = moved, None
        if self.exaggeration != 1.0:
            rigid = self._rigid(moved)
            drawn = rigid + self.exaggeration * (moved - rigid)
        if solid.base:
            base = (
                solid.base.points
                + self.exaggeration * fields.displacement[self._count :][solid.base.nodes]
            )
        colour, base_colour = fields.stress[solid.column.cells], None
        if self.colour == "displacement":
            colour = np.linalg.norm(fields.displacement[: self._count], axis=1)[solid.column.nodes]
        elif solid.base:
            base_colour = fields.stress[len(body.cells) :][solid.base.cells]
        at_corners, foot = fields.pressure[: self._count][solid.foot_faces], moved[solid.foot_faces]
        pressure, force = at_corners.mean(axis=1), at_corners * _areas(foot)[:, None]
        centre = (
            np.einsum("fc,fca->a", force, foot[..., :2]) / force.sum()
            if force.sum() > 0
            else np.full(2, np.nan)
        )
        return Frame(
            self.times[k],
            drawn[solid.column.nodes],
            base,
            colour,
            base_colour,
            foot,
            pressure,
            centre,
        )

    def _rigid(self, moved: np.ndarray) -> np.ndarray:
        """The rigid motion of the column nearest to `moved`."""
        points = self.result.solid.mesh.body.points
        rotation, shift = nearest_rigid(points, moved)
        return points @ rotation.T + shift

    def _pressure_centres(self, times: np.ndarray) -> np.ndarray:
        from fecolumn.render.pressure_centre import pressure_centre

        return pressure_centre(
            self.result.poses,
            self.result.history["ground"],
            self.result.solid.mass,
            times,
            self._interval,
        )

    def pressure_path(self) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,) [s] from the first frame to the last, more than there are frames, and the
        centre of the pressure (n, 2) [m] at each.
        """
        times = np.linspace(self.times[0], self.times[-1], _FINER * len(self))
        return times, self._pressure_centres(times)

    def _largest_elastic(self, k: int) -> float:
        moved = self.result.solid.mesh.body.points + self._fields(k).displacement[: self._count]
        return float(np.linalg.norm(moved - self._rigid(moved), axis=1).max())

    def _pressure_quantity(self, frames: list[Frame]) -> Quantity | None:
        if not self.from_fields:
            return None
        return Quantity.of(
            "contact pressure",
            "Pa",
            max(np.percentile(frame.pressure, RANGE) for frame in frames),
            DECADES,
        )


def _areas(faces: np.ndarray) -> np.ndarray:
    """(n,) areas in plan of faces with corners (n, k, 3)."""
    x, y = faces[..., 0], faces[..., 1]
    return np.abs((x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1)) / 2


def round_down(factor: float) -> float:
    """The largest of ..., 1, 2, 5, 10, 20, ... that is not above `factor`, at least 1."""
    power = 10.0 ** np.floor(np.log10(max(factor, 1.0)))
    return float(max(step * power for step in (1, 2, 5) if step * power <= max(factor, 1.0)))
