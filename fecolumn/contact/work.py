"""What contact does in a step: where its points stick from then on, and the energy that it takes."""

from __future__ import annotations

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.pad import dashpot_work
from fecolumn.contact.tolerances import STUCK


@njit
def move_anchors(points, interfaces, springs, listed, before, after):
    """Where the listed points (k,) stick from now on: a slipping spring of contact law or pad keeps its elastic part."""
    for i in listed:
        x = after[i].relative[0] + springs.own[i, 0] * after[i].force[0] + springs.kept * before[i].indentation[0]
        y = after[i].relative[1] + springs.own[i, 1] * after[i].force[1] + springs.kept * before[i].indentation[1]
        stuck = after[i].force[2] > 0 and np.hypot(x - before[i].anchor[0], y - before[i].anchor[1]) <= STUCK * interfaces[points[i].interface].width
        after[i].anchor[0] = before[i].anchor[0] if stuck else x
        after[i].anchor[1] = before[i].anchor[1] if stuck else y


@njit
def losses(points, interfaces, springs, listed, before, after):
    """Energy [J] that friction and landings of the listed points (k,) add in a step, both below 0, and that the dashpots of a pad take."""
    friction, landed, on_pad = 0.0, 0.0, interfaces[0].on_pad
    for i in listed:
        if after[i].force[2] > 0:
            friction += after[i].force[0] * (after[i].anchor[0] - before[i].anchor[0]) + after[i].force[1] * (after[i].anchor[1] - before[i].anchor[1])
            if before[i].force[2] <= 0 and not on_pad:
                landed += after[i].force[2] * (after[i].relative[2] - before[i].relative[2])
    return friction, landed, dashpot_work(points, springs, before, after) if on_pad else 0.0
