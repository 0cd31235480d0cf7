"""Fields that the full-order analysis of a structure wrote, as its pictures want them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.render.field_frames import FieldFrames
from fecolumn.render.pose import nearest_rigid
from fecolumn.render.structure_solid import StructureSolid
from fecolumn.schema import InputError


class StructureFieldFrames(FieldFrames):
    """As `structure_states.StructureStates`, from the frames in a folder; the rigid motion of a
    body is that nearest to its displacements.

    Attributes
    ----------
    time
        (n,) [s]. center: (n, nb, 3) [m] of mass; rotation: (n, nb, 3, 3).

    Raises
    ------
    InputError
        the fields are of another mesh, or damaged.
    """

    has_stress = True

    def __init__(self, folder: Path, solid: StructureSolid):
        super().__init__(folder)
        self._solid = solid
        if self.points.shape != solid.points.shape or not np.allclose(
            self.points, solid.points, rtol=0, atol=1e-6 * solid.height
        ):
            raise InputError(
                folder,
                "",
                None,
                "is of another mesh than that of the case made now; run the case into a new folder",
            )
        frames = len(self.time), len(solid.structure.parts)
        self.center, self.rotation = np.empty((*frames, 3)), np.empty((*frames, 3, 3))
        for k in range(len(self.time)):
            moved = solid.points + self.read(k).displacement
            for number, (part, own) in enumerate(self._parts()):
                self.rotation[k, number], self.center[k, number] = nearest_rigid(
                    solid.points[own] - part.center, moved[own]
                )

    def _parts(self):
        """Each part and its points."""
        first = self._solid.first
        return [
            (part, slice(a, b)) for part, a, b in zip(self._solid.structure.parts, first, first[1:])
        ]

    def local(self, k: int, stress: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of frame k as of `StructureFields.local`."""
        fields, bent = self.read(k), np.empty_like(self.points)
        for number, (part, own) in enumerate(self._parts()):
            place = self._solid.points[own] + fields.displacement[own]
            bent[own] = (place - self.center[k, number]) @ self.rotation[k, number] - (
                self._solid.points[own] - part.center
            )
        return bent, bent, fields.stress

    def pressures(self, k: int) -> tuple[list[np.ndarray], np.ndarray]:
        """Of frame k as of `StructureFields.pressures`."""
        at_points, found, centres = self.read(k).pressure, [], []
        for contact in self._solid.contacts:
            count = np.bincount(contact.nearest, minlength=len(contact.nodes))
            pressure = np.bincount(
                contact.nearest, at_points[contact.points], minlength=len(contact.nodes)
            ) / np.maximum(count, 1)
            force = pressure * contact.areas
            found.append(pressure)
            centres.append(
                force @ contact.plan / force.sum() if force.sum() > 0 else [np.nan, np.nan]
            )
        return found, np.array(centres)

    def broken(self, k: int) -> np.ndarray:
        """Fields do not tell which links are broken: none."""
        return np.zeros(len(self._solid.structure.links), bool)
