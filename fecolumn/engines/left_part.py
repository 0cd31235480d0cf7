"""What a user is told where a body left the part of a face that was prepared for contact."""

from __future__ import annotations

import numpy as np

from fecolumn.case.case import Case
from fecolumn.structures.model import JointModel, StructureModel

#: What is said of a body that passed an edge that its joint has no contact points for
OVER_EDGE = "a body slid over an edge of the face it lies on, which was not prepared for contact"
# Range of the key [m]
_LEAST, _MOST = 0, 1000


def way_out(case: Case, structure: StructureModel, names: tuple[str, ...]) -> str:
    """Which key prepares more of the faces of the joints with these names, its value and range."""
    joints = {joint.name: joint for joint in structure.joints}
    found = {}
    for name in names:
        # "joint, edge: lower on upper" has the keys of joints.joint
        key = name.partition(":")[0].removesuffix(", edge")
        found[key] = f"joints.{key}.allowance_m {_told(case, structure, key, joints[name])}"
    return (
        f"{', '.join(found.values())} must be larger than the slide, {_LEAST} to {_MOST} m: more "
        "of the face is then prepared"
    )


def _told(case: Case, structure: StructureModel, key: str, joint: JointModel) -> str:
    """The allowance of a joint, or what it is where left out: see `meetings.allowance_of`."""
    stated = case.joints[key].allowance_m
    if stated is not None:
        return f"= {stated:g}"
    if joint.pair >= 0:  # of a face's edge: as far as its joint is prepared
        joint = structure.joints[joint.pair]
    model = structure.parts[joint.slave].model
    surface = model.surfaces[joint.slave_surface]
    sides = np.ptp(surface.plane(model.arms[surface.nodes])[:, :2], axis=0)
    return f"(left out: {sides.max() if joint.gap else sides.min() / 4:.3g} m)"
