"""Starting mpirun from a process that has already started MPI."""

from __future__ import annotations

import os
import re


def launch_environment() -> dict[str, str]:
    """Environment of this process without the variables of its own MPI.

    With them mpirun would take itself for a child of this process.
    """
    return {
        key: value
        for key, value in os.environ.items()
        if not re.match("OMPI_(?!ALLOW)|ORTE|PMI|PRTE", key)
    }
