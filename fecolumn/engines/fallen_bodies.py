"""Structures whose bodies may fall onto anything: when they lie still, and which of them fell."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.overturning import FAR
from fecolumn.structures.hulls import hulls_of_parts
from fecolumn.structures.model import StructureModel

# Kinetic energy of bodies that lie still, over the weight of the lightest one and the thickness of
# the thinnest: a velocity of a few millimetres a second
_STILL = 1e-6
# Fall of a body's centre of mass from which on it has fallen, over its thickness
_DROP = 0.5


class FallenBodies:
    """Which bodies of a structure whose contact is found are at rest, and which have fallen.

    still_j: largest kinetic energy [J] at which all bodies count as lying still. turn_s: how long
    it must stay that low [s], so that a body about to fall back is not taken for one at rest.
    """

    def __init__(self, structure: StructureModel) -> None:
        assert structure.found
        hulls, parts = hulls_of_parts(structure.outlines), structure.parts
        self._found = [b for b in structure.found.parts if parts[b].held < 0]
        self._parts = parts
        self._thickness = np.array([hull.thickness[0] for hull in hulls])
        thickness = self._thickness[self._found]
        lightest = min(parts[b].model.mass for b in self._found) * GRAVITY
        self.still_j = _STILL * lightest * float(thickness.min())
        self.turn_s = float(np.sqrt(thickness.max() / GRAVITY))

    def fallen(self, rows: dict[str, NDArray[Any]]) -> dict[str, float]:
        """Bodies that have fallen at the end of a history, by name, and when they began to lie
        farther from their places than they stand [s], the first one first.
        """
        found = {}
        for b in self._found:
            name = self._parts[b].name
            drop = -rows[f"body/{name}/displacement"][:, 2]
            gone = (rows[f"body/{name}/tilt"] > FAR) | (drop > _DROP * self._thickness[b])
            if gone[-1]:
                back = np.flatnonzero(~gone)
                found[name] = float(rows["time"][back[-1] + 1 if len(back) else 0])
        return dict(sorted(found.items(), key=lambda one: one[1]))

    def told(self, fallen: dict[str, float]) -> str:
        """Which bodies have fallen, in words."""
        names = list(fallen)
        said = ", ".join(f'"{name}"' for name in names[:3])
        more = f" and {len(names) - 3} more" if len(names) > 3 else ""
        first = fallen[names[0]]
        return (
            f"{len(names)} of {len(self._found)} bodies fell: {said}{more}, from {first:.3f} s on"
        )
