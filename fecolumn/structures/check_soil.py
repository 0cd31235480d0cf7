"""Whether what begins at rest on soil or pads can stand there."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.foundation.schema import InputError
from fecolumn.structures.barrier import feet_on_springs
from fecolumn.structures.model import StructureModel
from fecolumn.structures.pads import pad_keys
from fecolumn.structures.standing import Standing


def check_soil(
    case: Case,
    structure: StructureModel,
    standing: list[Standing],
    extents: Sequence[NDArray[Any]],
    file: Path | str,
) -> None:
    """Refuse soil and pads on which what begins at rest cannot stand upright, or sinks by more than
    it is high.

    standing: as of `place`; extents: (n, 3) [m] places of each part from its centre of mass, among
    which its lowest and its highest are.
    """
    if case.integration.start == "drawn":
        return
    if any(start.tilt_rad or start.moves for start in case.initial.values()):
        return
    held = {place for link in structure.links for place in (link.a, link.b)}
    for place, foot in feet_on_springs(structure, standing).items():
        keys, where = next(
            pad_keys(case, joint.name.partition(":")[0])
            for joint in structure.joints
            if joint.slave == place and joint.pad is not None
        )
        assert keys is not None and keys.stiffness_n_m3
        name, high = standing[place].name, np.ptp(extents[place][:, 2])
        told = ""
        if foot.sinks > high:
            told = (
                f'"{name}" with what stands on it would sink by {foot.sinks:.3g} m, more than its '
                f"height of {high:.3g} m"
            )
        elif foot.holds <= 1 and not held and not foot.radius:
            least = keys.stiffness_n_m3 / foot.holds
            told = (
                f'"{name}" with what stands on it would tip over: it must be more than '
                f"{least:.3g} N/m3"
            )
        if told:
            raise InputError(file, f"{where}.stiffness_n_m3", keys.stiffness_n_m3, told)
