"""Keys of [motion] that only together are wrong."""

from __future__ import annotations

from fecolumn.case.checked import Refuse
from fecolumn.case.sections import Motion


def check_strong_part(motion: Motion, key: str, refuse: Refuse) -> None:
    """Refuse a part of a motion that does not begin before it ends; key: of the motion's table."""
    part = motion.strong_part
    if len(part) != 2 or not part[0] < part[1]:
        refuse(f"{key}.strong_part", list(part), "must be two rising fractions in [0, 1]")
