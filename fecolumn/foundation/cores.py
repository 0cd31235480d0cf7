"""Cores of the processor that this process may use."""

from __future__ import annotations

import math
import os
from pathlib import Path

# Time of the processor that a container may take in a period [us], of control groups of Linux
_QUOTA = Path("/sys/fs/cgroup/cpu.max")


def usable_cores(quota: Path = _QUOTA) -> int:
    """Number of cores that this process may use, at least 1: those of its affinity, as batch
    systems set it, and no more than the quota of its container.
    """
    cores = len(os.sched_getaffinity(0))
    try:
        time, period = quota.read_text().split()
        return max(1, min(cores, math.ceil(int(time) / int(period))))
    except (OSError, ValueError):  # no control group, or "max": no quota
        return cores
