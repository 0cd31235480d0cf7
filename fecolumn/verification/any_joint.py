"""Joints of any inclination, and bodies that do not touch yet, beside closed forms and limit
analysis.

The modules any_joint_slopes, any_joint_wedges, any_joint_arches, any_joint_gaps, any_joint_walls
and any_joint_drops hold the rows, and say which of them are those of rigid bodies alone, and why.
"""

from __future__ import annotations

from fecolumn.verification.any_joint_arches import arch_rows, draw_arches
from fecolumn.verification.any_joint_drops import drop_rows
from fecolumn.verification.any_joint_falls import fall_rows
from fecolumn.verification.any_joint_gaps import gap_rows
from fecolumn.verification.any_joint_slopes import slope_rows
from fecolumn.verification.any_joint_walls import wall_rows
from fecolumn.verification.any_joint_wedges import wedge_rows
from fecolumn.verification.result import CaseRows


def run(engine: str, long: bool = False) -> CaseRows:
    """Rows of one engine."""
    rows = [
        *slope_rows(engine),
        *wedge_rows(engine),
        *drop_rows(engine),
        *fall_rows(engine),
        *arch_rows(engine, long),
        *gap_rows(engine),
        *wall_rows(engine),
    ]
    return CaseRows(rows, draw_arches, (7.2, 3.2))
