"""Motions as text files that other programs read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.atomic import write_bytes
from fecolumn.motions.record import GroundMotion


def write_text_files(motions: Sequence[GroundMotion], folder: Path | str, kind: str) -> list[Path]:
    """Write each motion into a folder: a CSV file [m/s2], or an AT2 file [g] for each component
    that is not zero.

    Parameters
    ----------
    motions
        sequence of GroundMotion; files are numbered in their order.
    folder
        made if missing.
    kind
        "csv" or "at2".
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    digits = max(4, len(str(len(motions))))  # sorted by name, the files keep the order
    for number, motion in enumerate(motions, 1):
        stem = f"{number:0{digits}d}_{re.sub(r'[^A-Za-z0-9]+', '_', motion.name).strip('_')}"
        contents = (
            {f"{stem}.csv": _csv(motion)}
            if kind == "csv"
            else {
                f"{stem}_{axis}.AT2": _at2(motion, column, axis)
                for axis, column in zip("xyz", motion.acceleration.T)
                if column.any()
            }
        )
        for name, text in contents.items():
            write_bytes(folder / name, text.encode())
            files.append(folder / name)
    return files


def _csv(motion: GroundMotion) -> str:
    head = f"# {motion.name}: {motion.source}".replace("\n", " ")
    rows = (
        f"{step * motion.dt:.10g},{x:.9g},{y:.9g},{z:.9g}"
        for step, (x, y, z) in enumerate(motion.acceleration)
    )
    return "\n".join([head, "time [s],ax [m/s2],ay [m/s2],az [m/s2]", *rows]) + "\n"


def _at2(motion: GroundMotion, column: NDArray[Any], axis: str) -> str:
    head = [
        motion.name,
        f"component {axis}; {motion.source}".replace("\n", " ")[:200],
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {len(column)}, DT= {motion.dt:.10g} SEC",
    ]
    words = [f"{value / GRAVITY:15.7E}" for value in column]
    return "\n".join(head + ["".join(words[i : i + 5]) for i in range(0, len(words), 5)]) + "\n"
