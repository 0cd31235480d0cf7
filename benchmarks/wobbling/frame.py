"""The frame of the tests, and its response to the bins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.case.model_sections import WobblingFrameModel
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.wobbling_frame import WobblingFrame

#: Four columns of 2R = 1.463 m, alpha = 0.1359 and 1.22 kN, slab 94.35 kN, 1720 kN/m a tendon with
#: its springs (Reggiani Manzo and Vassiliou)
SPECIMEN = dict(
    columns=4,
    slenderness_rad=0.1359,
    half_diagonal_m=1.463 / 2,
    column_mass_kg=1220 / GRAVITY,
    slab_mass_kg=94350 / GRAVITY,
    tendon_n_m=1.72e6,
)
#: p and e50 of each bin, as printed (their Table 2)
PRINTED = {
    ("NFP", "low"): (0.06, 0.29),
    ("NFP", "high"): (0.86, 0.02),
    ("NF", "low"): (0.65, 0.09),
    ("NF", "high"): (0.59, 0.20),
    ("FF", "low"): (0.26, 0.09),
    ("FF", "high"): (0.15, 0.47),
}


def specimen(**changes) -> WobblingFrame:
    """The frame, or one with other keys of WobblingFrameModel."""
    return WobblingFrame.of_section(WobblingFrameModel(**SPECIMEN | changes), "specimen")


@dataclass(frozen=True, slots=True)
class Sample:
    """Peak displacement of the slab [m] in each motion of a bin, and whether the frame overturned,
    (n,) each.
    """

    u_max: np.ndarray
    overturned: np.ndarray


def respond(frame: WobblingFrame, motions) -> Sample:
    """Of a frame in the motions of a bin, a second of free motion after each."""
    found = [frame.respond(motion, free_s=1.0) for motion in motions]
    return Sample(
        np.array([one.u_max for one in found]), np.array([one.overturned for one in found])
    )
