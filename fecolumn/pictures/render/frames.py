"""Frames of a motion: where every point is at an instant, and what colours it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.engines.scene.scene import JointFace
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.render.frame import Fields, Frame
from fecolumn.pictures.render.joints import gaps, moved_from_master
from fecolumn.pictures.render.pose import nearest_rigid
from fecolumn.pictures.render.thrust import JointForces

if TYPE_CHECKING:
    from fecolumn.engines.scene.scene import Outside, Scene
    from fecolumn.pictures.render.result import Result

_COLOURS = ("stress", "displacement", "none")
#: Largest elastic displacement as it is drawn under "auto", over the height of what moves [-]
SEEN = 0.05
# Points of the pressure's path a frame, so that it is a curve where a body rolls
_FINER = 4
#: Share of the values [-] that colours range over: a single element under the edge on which a body
#: stands would take all colours
RANGE = 99.8
#: Decades of stress and of pressure that colours show: under the edge on which a body rocks they
#: are a hundred times those of standing
DECADES = 3


class Frames:
    """Frames of an analysis, from its fields where they are known often enough, written or made
    from states, else from its history, which has bodies rigid.

    Attributes
    ----------
    times
        (k,) [s] of the frames; at instants of the fields where these are used, some twice where
        they are rarer.
    from_fields
        whether they are.
    exaggeration
        factor on elastic displacements [-].
    colour
        one of _COLOURS.
    centres
        (k, 2) [m] of the contact pressure on a body alone by its motion, nan in flight; None of
        several bodies.
    colour_quantity
        Quantity of Frame.colour.
    pressure_quantity
        of Frame.pressures, None where there is none.
    forces
        JointForces; None where they are not drawn.
    """

    exaggeration: float
    colour_quantity: Quantity
    pressure_quantity: Quantity | None
    forces: JointForces | None

    def __init__(
        self,
        result: Result,
        times: np.ndarray,
        interval: float,
        exaggerate: float | str = 1.0,
        colour: str = "",
        like: Frames | None = None,
        forces: bool = False,
    ) -> None:
        """Frames at `times` (k,) [s], each for `interval` [s]; exaggerate: elastic displacements by
        this factor, or "auto"; colour: of _COLOURS, "" for what there is; like: others whose
        exaggeration, forces and ranges of colours these have; forces: of the joints are drawn.

        Raises
        ------
        InputError
            elastic displacements, stress or forces are asked for, and were not written, or no body
            has any stress.
        """
        self.result, self.scene, fields = result, result.scene, result.frames
        if colour == "stress" and not self.scene.has_stress:
            raise InputError(
                "fecolumn render",
                "--colour",
                colour,
                "no body of this structure deforms as a continuum: all are rigid, "
                "storeys or matrices",
            )
        # what the history gives at once is not made from states
        colour = colour or ("none" if forces else "")
        rigid = colour in ("displacement", "none") and exaggerate == 1.0
        wanted = fields is result.fields or not rigid
        self.from_fields = (
            wanted and bool(len(fields.time)) and fields.interval <= 1.5 * interval + 1e-9
        )
        stressed = self.from_fields and self.scene.has_stress
        self.colour = colour or ("stress" if stressed else "displacement")
        if not self.from_fields and (self.colour == "stress" or exaggerate != 1.0):
            asked, value = (
                ("--exaggerate", exaggerate) if exaggerate != 1.0 else ("--colour", colour)
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
            self._number = fields.nearest(times)
            times = fields.time[self._number]
        self.times = np.asarray(times, float)
        self._poses = tuple(poses.at(self.times) for poses in result.poses)
        rows = float(np.median(np.diff(result.poses[0].time)))
        self._interval = max(
            interval / _FINER, 4 * rows
        )  # of momentum, for which velocities are wanted
        self.forces = like.forces if like else None
        if forces and not self.forces:
            self.forces = JointForces(result, self._interval)
        self.centres = self._pressure_centres(self.times)
        # what presses at one point has no pressure that could be drawn
        at_point = self.centres is not None and self.scene.contacts[0].domed
        self._pressed = self.from_fields and not at_point
        self._scale(exaggerate, like)

    def _scale(self, exaggerate: float | str, like: Frames | None) -> None:
        """Find the scales, or take those of `like`."""
        if like:
            self.exaggeration, self.colour_quantity, self.pressure_quantity = (
                like.exaggeration,
                like.colour_quantity,
                like.pressure_quantity,
            )
            return
        self.exaggeration = 1.0 if exaggerate == "auto" else float(exaggerate)
        if exaggerate == "auto":
            largest = max(map(self._largest_elastic, range(len(self))))
            self.exaggeration = round_down(SEEN * self.scene.height / max(largest, 1e-12))
        frames = list(self)
        if self.colour != "stress":
            largest = max(frame.colour.max() for frame in frames)
            self.colour_quantity = Quantity.of("displacement", "m", largest)
        else:
            largest = max(np.nanpercentile(frame.colour, RANGE) for frame in frames)
            self.colour_quantity = Quantity.of("von Mises stress", "Pa", largest, DECADES)
        self.pressure_quantity = None
        if self._pressed:
            largest = max(np.percentile(np.concatenate(one.pressures), RANGE) for one in frames)
            self.pressure_quantity = Quantity.of("contact pressure", "Pa", largest, DECADES)

    @property
    def coloured(self) -> bool:
        """Whether bodies have a colour that says something."""
        return self.colour != "none"

    def __len__(self) -> int:
        return len(self.times)

    def __iter__(self) -> Iterator[Frame]:
        return (self.frame(k) for k in range(len(self)))

    def frame(self, k: int) -> Frame:
        """Frame `k`."""
        scene = self.scene
        colour, base_colour = None, None
        if self.from_fields:
            fields = self._fields(k)
            true = scene.points + fields.displacement
            if self.colour == "stress":
                colour = _of_faces(scene, scene.surface, fields.stress)
                if scene.base is not None:
                    base_colour = _of_faces(scene, scene.base, fields.stress)
        else:
            true = self._rigid(k)
        if colour is None:
            nodes = scene.surface.nodes
            colour = np.linalg.norm(true[nodes] - scene.points[nodes], axis=1)
        drawn = true if self.exaggeration == 1.0 else self._exaggerated(true)
        faces = [true[contact.faces] for contact in scene.contacts]
        if self._pressed:
            corners = [fields.pressure[contact.faces] for contact in scene.contacts]
            pressures = [values.mean(axis=1) for values in corners]
            if self.centres is None and fields.centres is not None:
                centres = fields.centres
            else:
                centres = np.array(
                    [self._centre(*one) for one in zip(scene.contacts, faces, corners)]
                )
        else:
            pressures = [self._gaps(contact, true, k) for contact in scene.contacts]
            centres = np.full((len(scene.contacts), 2), np.nan)
            if self.centres is not None:
                centres[0] = self.centres[k]
        return Frame(
            float(self.times[k]),
            drawn,
            colour,
            base_colour,
            self._links(k) if scene.links else None,
            drawn[scene.struts] if len(scene.struts) else None,
            faces,
            pressures,
            centres,
            self.forces.at(float(self.times[k]), self._poses, k) if self.forces else None,
        )

    def _fields(self, k: int) -> Fields:
        """Of frame `k`, the last one kept: a frame is asked for twice, to be drawn and for its
        colours.
        """
        if self._kept[0] != self._number[k]:
            self._kept = self._number[k], self.result.frames.read(self._number[k])
        return self._kept[1]

    def _rigid(self, k: int) -> np.ndarray:
        """Positions (n, 3) [m] of all points at frame `k` by the history."""
        placed = self.scene.points.copy()
        for number, (piece, poses) in enumerate(zip(self.scene.bodies, self._poses)):
            own = self.scene.own(number)
            placed[own] = poses.move(placed[own], k)
            shifts = self.result.scene_history.floors.get(number)
            if shifts is None:
                continue
            time = self.result.time
            row = min(int(np.searchsorted(time, self.times[k] - 1e-9)), len(time) - 1)
            slab, *floors = shifts[row]
            placed[own][: -piece.carried] += slab
            placed[own][-piece.carried :] += np.repeat(floors, 8, axis=0)
        return placed

    def _exaggerated(self, true: np.ndarray) -> np.ndarray:
        """Points (n, 3) [m] as drawn: of each body what it moves by beyond the rigid motion nearest
        to it, or of a building to its slab, is enlarged.
        """
        drawn = self.scene.points + self.exaggeration * (true - self.scene.points)
        for number in range(len(self.scene.bodies)):
            own = self.scene.own(number)
            rigid = self._nearest(number, true[own])
            drawn[own] = rigid + self.exaggeration * (true[own] - rigid)
            if carried := self.scene.pieces[number].carried:
                drawn[own][:-carried] = true[own][:-carried]  # a slab is rigid
        return drawn

    def _nearest(self, number: int, moved: np.ndarray) -> np.ndarray:
        """Points (n, 3) [m] of a body in the rigid motion nearest to its points `moved`."""
        piece, points = self.scene.pieces[number], self.scene.points[self.scene.own(number)]
        firm = slice(len(points) - piece.carried)
        rotation, shift = nearest_rigid(points[firm], moved[firm])
        return points @ rotation.T + shift

    def _largest_elastic(self, k: int) -> float:
        moved = self.scene.points + self._fields(k).displacement
        return max(
            float(np.linalg.norm(moved[own] - self._nearest(number, moved[own]), axis=1).max())
            for number in range(len(self.scene.bodies))
            for own in [self.scene.own(number)]
        )

    def _links(self, k: int) -> np.ndarray:
        """Ends (n, 2, 3) [m] of the links at frame `k`."""

        def at(body: int, arm: np.ndarray) -> np.ndarray:
            poses = self._poses[body]
            return arm if body == GROUND else poses.foot[k] + poses.rotation[k] @ arm

        links, history = self.scene.links, self.result.history
        ends = np.array([[at(one.a, one.arm_a), at(one.b, one.arm_b)] for one in links])
        row = min(
            int(np.searchsorted(self.result.time, self.times[k] - 1e-9)), len(self.result.time) - 1
        )
        broken = [bool(history[f"link/{one.name}/broken"][row]) for one in links]
        ends[broken, 1] = ends[broken, 0]
        return ends

    def _gaps(self, contact: JointFace, true: np.ndarray, k: int) -> np.ndarray:
        """Mean gap (n_faces,) [m] below the faces of a contact."""
        rest = self.scene.points[contact.points]
        moved = moved_from_master(contact, true[contact.points], rest, self._poses, k)
        at_points = np.zeros(len(true))
        at_points[contact.points] = gaps(contact, moved, rest)
        return at_points[contact.faces].mean(axis=1)

    def _centre(self, contact: JointFace, faces: np.ndarray, pressure: np.ndarray) -> np.ndarray:
        """Centre (2,) [m] of the pressure (n_faces, k) [Pa] at corners (n_faces, k, 3) [m]."""
        plan = self.plan(contact, faces)
        x, y = plan[..., 0], plan[..., 1]
        areas = np.abs((x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1)) / 2
        force = pressure * areas[:, None]
        return (
            np.einsum("fc,fca->a", force, plan) / force.sum()
            if force.sum() > 0
            else np.full(2, np.nan)
        )

    def plan(self, contact: JointFace, faces: np.ndarray) -> np.ndarray:
        """Faces (n_faces, k, 2) [m] in the plan in which a contact is drawn: of a body alone where
        they are on the ground, else where they are on the body.
        """
        if self.centres is not None:
            return faces[..., :2]
        return contact.plan(self.scene.points[contact.faces])

    def _pressure_centres(self, times: np.ndarray) -> np.ndarray | None:
        from fecolumn.pictures.render.pressure_centre import pressure_centre

        poses, mass, contacts = self.result.poses[0], self.scene.mass, self.scene.contacts
        if mass is None or [one.on_ground for one in contacts] != [True]:
            return None
        if len(poses.time) != len(self.result.time):
            return np.full((len(times), 2), np.nan)
        ground = self.result.history["ground"]
        level = float(contacts[0].origin[2])
        return pressure_centre(poses, ground, mass, times, self._interval, level)

    def pressure_path(self) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,) [s] from the first frame to the last, more than there are frames, and the
        centre of the pressure (n, 2) [m] at each.
        """
        times = np.linspace(self.times[0], self.times[-1], _FINER * len(self))
        centres = self._pressure_centres(times)
        assert centres is not None  # of a body alone
        return times, centres


def _of_faces(scene: Scene, surface: Outside, stress: np.ndarray) -> np.ndarray:
    """Stress (n_faces,) [Pa] of the faces of a surface, nan of pieces that have none."""
    stressed = np.array([piece.stressed for piece in scene.pieces])
    return np.where(stressed[surface.part], stress[surface.cells], np.nan)


def round_down(factor: float) -> float:
    """The largest of ..., 1, 2, 5, 10, 20, ... that is not above `factor`, at least 1."""
    power = 10.0 ** np.floor(np.log10(max(factor, 1.0)))
    return float(max(step * power for step in (1, 2, 5) if step * power <= max(factor, 1.0)))
