"""Bodies that came through each other: pairs without a joint, looked for while an analysis runs."""

from __future__ import annotations

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.convex import hulls_of
from fecolumn.contact.nearby import pair_keys
from fecolumn.contact.through import ThroughCheck
from fecolumn.structures.hulls import hulls_of_parts
from fecolumn.structures.model import GROUND, StructureModel

# Way of a body between two looks, over the thickness of the thinnest one: none is passed unseen
_WAY = 0.2
# Depth over the thickness of the thinner body from which on contact that is found has failed: its
# middle is in the other one
_FAILED = 0.5


class Passing:
    """Looks for pairs of bodies without a joint that are in each other, and for those whose contact
    is found and that came through each other all the same.

    Bodies that are not convex, or have no elements, are in no pair.
    """

    def __init__(self, structure: StructureModel):
        parts = structure.parts
        self._names = [part.name for part in parts]
        self._held = np.array([part.held >= 0 for part in parts])
        hulls = hulls_of_parts(structure.outlines or [None] * len(parts))
        together = [(joint.slave, joint.master) for joint in structure.joints]
        together = [pair for pair in together if pair[1] != GROUND]
        fixed = np.flatnonzero(self._held)
        together += [(a, b) for a in fixed for b in fixed if a < b]
        self._meet = set(structure.found.parts) if structure.found else set()
        self._check = ThroughCheck(hulls_of(hulls), pair_keys(together, len(parts)))
        thick = self._check.hulls.thickness
        self._thinnest = thick[thick > 0].min(initial=np.inf)
        radii = np.abs(self._check.hulls.middle) + self._check.hulls.half
        self._radii = np.linalg.norm(radii, axis=1)
        self._looks = int((thick > 0).sum()) > 1

    def steps(self, motion, dt: float, most: int) -> int:
        """Steps [of dt s] after which to look again, `most` at most."""
        if not self._looks:
            return most
        velocity, spin = (
            np.linalg.norm(motion.frames[key], axis=1) for key in ("velocity", "spin")
        )
        fastest = float((velocity + spin * self._radii).max()) + GRAVITY * most * dt
        return max(1, min(most, int(_WAY * self._thinnest / (fastest * dt))))

    def told(self, motion) -> str:
        """Which pair is in each other now, in words; "" where none is."""
        if not self._looks:
            return ""
        centers = np.ascontiguousarray(motion.frames["center"])
        found = self._check.deepest(centers, np.ascontiguousarray(motion.rotation))
        thick = self._check.hulls.thickness
        for one, other, depth in found:
            first, second = self._names[one], self._names[other]
            told = (
                f't = {motion.time:.4g} s: "{first}" and "{second}" came through each other, by '
                f"{depth:.3g} m; "
            )
            if not {one, other} <= self._meet:
                return (
                    f"{told}a joint between them, [joints.NAME] between = "
                    f'["{first}", "{second}"], lets them meet'
                )
            if depth > _FAILED * min(thick[one], thick[other]):
                return f"{told}a shorter integration.dt_s lets them meet"
        return ""
