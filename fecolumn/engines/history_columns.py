"""Columns of the history by name, of the rows of an engine."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.dynamics.bonds import bonded
from fecolumn.engines.reduced.observe import (
    COLUMNS,
    OF_BODY,
    OF_BOND,
    OF_INTERFACE,
    OF_LINK,
    OF_MARK,
)
from fecolumn.structures.model import StructureModel

_WHOLE = (
    "active_nodes",
    "iterations",
    "broken",
)  # columns of whole numbers, by the last word of their names


def columns_of(rows: NDArray[Any], structure: StructureModel) -> dict[str, NDArray[Any]]:
    """Rows (k, width) of the engine as columns by name: those of any analysis, and of the
    structure's parts.

    "body/NAME/displacement" of the centre of mass [m], "body/NAME/tilt" [rad] and
    "body/NAME/rotation", the rotation vector [rad] from where the body stood upright;
    "interface/NAME/tilt" of the slave from the master [rad], "rise" of the middle of its foot [m],
    "slide" along two tangents [m], normal "force" [N], "resultant" of the forces on the slave [N]
    and "center" of pressure [m] in the table frame, 0 where nothing carries;
    "mark/NAME.MARK/displacement" [m]; "link/NAME/tension" [N], "elongation" from its unstressed
    length and the part of it that has "yielded" [m], "work" that it has taken [J], whether it is
    "broken"; "bond/NAME/stress" and "shear_stress" [Pa], the largest of the points of a glued
    joint, the share of its area that has "failed" and "work" that it has taken [J];
    "storey/NAME N/drift" [m] along x and y of the table, "shear" [N], its elastic part.
    """
    names = [(name, count) for name, count in COLUMNS]
    names += [
        (f"body/{part.name}/{name}", count) for part in structure.parts for name, count in OF_BODY
    ]
    names += [
        (f"interface/{joint.name}/{name}", count)
        for joint in structure.joints
        for name, count in OF_INTERFACE
    ]
    names += [
        (f"mark/{part.name}.{mark}/{name}", count)
        for part in structure.parts
        for mark in part.model.marks
        for name, count in OF_MARK
    ]
    names += [
        (f"link/{link.name}/{name}", count) for link in structure.links for name, count in OF_LINK
    ]
    names += [
        (f"bond/{one}/{name}", count) for one in glued_names(structure) for name, count in OF_BOND
    ]
    columns, place = {}, 0
    for name, count in names:
        values = rows[:, place] if count == 1 else rows[:, place : place + count]
        columns[name] = values.astype(int) if name.rpartition("/")[2] in _WHOLE else values.copy()
        place += count
    columns = of_both_sides(columns, structure)
    for part in structure.parts:
        if part.model.storeys is None:
            continue
        for number, stiffness in enumerate(part.model.storeys.stiffness, 1):
            drift = (
                columns.pop(f"mark/{part.name}.storey {number}/displacement")
                - columns[f"body/{part.name}/displacement"]
            )[:, :2]
            columns |= {
                f"storey/{part.name} {number}/drift": drift,
                f"storey/{part.name} {number}/shear": stiffness * drift,
            }
    return columns


def glued_names(structure: StructureModel) -> list[str]:
    """Names of the glued joints; one with two sides has that of its first."""
    return [
        structure.joints[joint.pair].name if joint.pair >= 0 else joint.name
        for joint in bonded(structure)
    ]


def of_both_sides(columns: dict[str, Any], structure: StructureModel) -> dict[str, Any]:
    """Columns by name with one interface for each joint with two sides: its force is that of
    both, and so are its resultant and its centre of pressure.
    """
    for joint in structure.joints:
        if joint.pair >= 0:
            own = f"interface/{structure.joints[joint.pair].name}/"
            other = f"interface/{joint.name}/"
            forces = [np.asarray(columns[f"{one}force"]) for one in (own, other)]
            total = forces[0] + forces[1]
            weighed = sum(
                force[..., None] * columns[f"{one}center"]
                for force, one in zip(forces, (own, other))
            )
            columns[f"{own}force"] = total if total.ndim else float(total)
            columns[f"{own}resultant"] = columns[f"{own}resultant"] - columns[f"{other}resultant"]
            columns[f"{own}center"] = weighed / np.where(total > 0, total, 1.0)[..., None]
            for name, _ in OF_INTERFACE:
                del columns[f"interface/{joint.name}/{name}"]
    return columns
