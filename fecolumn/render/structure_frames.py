"""Frames of the motion of a structure: where every point of its bodies is at an instant, and what
colours it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.render.frames import DECADES, RANGE, Scaled
from fecolumn.render.quantity import Quantity
from fecolumn.schema import InputError
from fecolumn.structures.drawn import link_ends


@dataclass(frozen=True, slots=True)
class StructureFrame:
    """An instant.

    Attributes
    ----------
    time
        [s].
    column
        (n, 3) [m] points of all bodies as drawn.
    colour
        of their faces (stress [Pa], nan of bodies that have none) or of the points (displacement
        [m]).
    base, base_colour
        None: the ground is a plane.
    links
        (n, 2, 3) [m] their ends, both the same of a broken one
    struts
        (n, 2, 3) [m] from floor to floor at the corners of buildings; None where there are none.
    pressures
        of each joint (k,) [Pa] at its contact points
    centres
        (n_joints, 2) [m] of them in the plan of the face, nan of an open joint.
    """

    time: float
    column: np.ndarray
    colour: np.ndarray
    links: np.ndarray | None
    struts: np.ndarray | None
    pressures: list[np.ndarray]
    centres: np.ndarray
    base: None = None
    base_colour: None = None


class StructureFrames(Scaled):
    """Frames of an analysis from its states or fields: bodies turn steadily and move straight
    between two of them; deformation, stress and pressure are those of the nearest.

    Attributes as of `render.frames.Frames`: times, exaggeration, colour, colour_quantity,
    pressure_quantity, from_fields.
    """

    base_surface = None

    def __init__(
        self,
        result,
        times: np.ndarray,
        exaggerate: float | str = 1.0,
        colour: str = "",
        like: StructureFrames | None = None,
    ):
        """Frames of a StructureResult at `times` (k,) [s]; other arguments as of `Frames`.

        Raises
        ------
        InputError
            stress is asked for where no body has any.
        """
        self.result, self._states = result, result.states
        self.times = np.asarray(times, float)
        self._number = self._states.nearest(self.times)
        self._poses = [poses.at(self.times) for poses in result.poses]
        self.colour = colour or ("stress" if self._states.has_stress else "displacement")
        if self.colour == "stress" and not self._states.has_stress:
            raise InputError(
                "fecolumn render",
                "--color",
                colour,
                "no body of this structure deforms as a continuum: all are rigid, "
                "storeys or matrices",
            )
        self._deformed = self.colour == "stress" or exaggerate != 1.0
        self.from_fields, self._kept = self._deformed, (None, None)
        self._scale(exaggerate, result.height, like)

    @property
    def surface(self):
        """Surface of all bodies, whose points a frame has."""
        return self.result.solid.surface

    def plan(self, figure):
        """What the movie shows of the joints."""
        from fecolumn.render.joint_plans import JointPlans

        return JointPlans(self, figure)

    def frame(self, k: int) -> StructureFrame:
        """Frame `k`."""
        solid, (local, bent, stress), number = self.result.solid, self._expanded(k), self._number[k]
        center, rotation = (
            np.array([poses.foot[k] for poses in self._poses]),
            np.array([poses.rotation[k] for poses in self._poses]),
        )
        drawn = solid.positions(center, rotation, local + (self.exaggeration - 1) * bent)
        if self.colour == "displacement":
            moved = drawn if self.exaggeration == 1 else solid.positions(center, rotation, local)
            colour = np.linalg.norm(moved - solid.points, axis=1)
        else:
            cells = solid.surface.cells
            colour = np.where(cells < 0, np.nan, stress[cells])
        links, structure = None, solid.structure
        if structure.links:
            links = np.array(
                [link_ends(link, structure.parts, center, rotation) for link in structure.links]
            )
            broken = self._states.broken(number)
            links[broken, 1] = links[broken, 0]
        struts = drawn[solid.struts] if len(solid.struts) else None
        return StructureFrame(
            float(self.times[k]), drawn, colour, links, struts, *self._states.pressures(number)
        )

    def _largest_elastic(self, k: int) -> float:
        return float(np.linalg.norm(self._expanded(k)[1], axis=1).max())

    def _pressure_quantity(self, frames: list[StructureFrame]) -> Quantity:
        return Quantity.of(
            "contact pressure",
            "Pa",
            max(np.percentile(np.concatenate(frame.pressures), RANGE) for frame in frames),
            DECADES,
        )

    def _expanded(self, k: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """As of `StructureFields.local`; the last one is kept: a frame is asked for twice, and more
        than one may be of the same state.
        """
        if self._kept[0] != self._number[k]:
            self._kept = self._number[k], self._states.local(self._number[k], self._deformed)
        return self._kept[1]
