"""A script for ParaView that opens the fields of an analysis and sets up the view."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.atomic import write_bytes
from fecolumn.render.camera import camera
from fecolumn.render.result import Result
from fecolumn.schema import InputError

_TEMPLATE = Path(__file__).with_name("view.txt")


def write_view(result: Result, file: Path, view: str = "lean") -> None:
    """Write the script; it finds the fields beside its own folder, so that the result folder may be moved.

    Raises:
        InputError: the analysis wrote no fields.
    """
    if not len(result.fields.time):
        raise InputError("fecolumn render", "--paraview", None, f"needs fields, and {result.folder} has none; run the case into a new folder with output.fields_every_s = 0.04")
    seen = camera(result, view, result.poses.time[:: max(1, len(result.poses.time) // 500)], 16 / 9)
    position = seen.focus + 10 * (seen.half_height + result.solid.height) * seen.toward
    values = dict(title=result.case.title or "fecolumn", focus=_numbers(seen.focus), position=_numbers(position), up=_numbers(seen.up), half_height=f"{seen.half_height:.6g}",
                  largest=f"{_largest_stress(result):.6g}")
    text = _TEMPLATE.read_text(encoding="utf-8")
    for name, value in values.items():
        text = text.replace(f"@{name}@", value if name != "title" else repr(value))
    write_bytes(file, text.encode())


def _numbers(values: np.ndarray) -> str:
    return "[" + ", ".join(f"{value:.6g}" for value in values) + "]"


def _largest_stress(result: Result) -> float:
    """Of all but a few elements of some frames [Pa]."""
    frames = np.unique(np.linspace(0, len(result.fields.time) - 1, 12).astype(int))
    return max(max(float(np.percentile(result.fields.read(k).stress, 99.8)) for k in frames), 1e-6)
