"""A script for ParaView that opens the fields of an analysis and sets up the view."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.progress import CountProgress
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.camera import camera
from fecolumn.pictures.render.field_frames import FieldFrames
from fecolumn.pictures.render.state_frames import write_fields

if TYPE_CHECKING:
    from fecolumn.pictures.render.result import Result


#: Name of the script
PARAVIEW_FILE = "view.py"
_TEMPLATE = Path(__file__).with_name("view.txt")


def write_view(result: Result, folder: Path, view: str = "lean", quiet: bool = True) -> None:
    """Write view.py into a folder, and where the analysis wrote no fields, those made from its
    states into fields/ beside it.

    The script finds the fields from its own place, so that the result folder may be moved.

    Raises
    ------
    InputError
        the analysis has neither fields nor states.
    """
    fields, place = result.fields, 'os.pardir, "fields"'
    if not len(fields.time):
        if not result.states:
            key = "fields_every_s" if result.case.integration.engine == "full" else "states_every_s"
            raise InputError(
                "fecolumn render",
                "--paraview",
                None,
                f"needs fields or states, and {result.folder} has none; run the case "
                f"into a new folder with output.{key} = 0.04",
            )
        progress = CountProgress(len(result.states.time), "frames", quiet)
        try:
            write_fields(result.states, folder / "fields", progress.show)
        finally:
            progress.end()
        fields, place = FieldFrames(folder / "fields"), '"fields"'
    seen = camera(result, view, result.time[:: max(1, len(result.time) // 500)], 16 / 9)
    position = seen.focus + 10 * (seen.half_height + result.height) * seen.toward
    values = dict(
        title=repr(result.case.title or "fecolumn"),
        fields=place,
        focus=_numbers(seen.focus),
        position=_numbers(position),
        up=_numbers(seen.up),
        half_height=f"{seen.half_height:.6g}",
        largest=f"{_largest_stress(fields):.6g}",
    )
    text = _TEMPLATE.read_text(encoding="utf-8")
    for name, value in values.items():
        text = text.replace(f"@{name}@", value)
    write_bytes(folder / PARAVIEW_FILE, text.encode())


def _numbers(values: np.ndarray) -> str:
    return "[" + ", ".join(f"{value:.6g}" for value in values) + "]"


def _largest_stress(fields: FieldFrames) -> float:
    """Of all but a few elements of some frames [Pa]."""
    frames = np.unique(np.linspace(0, len(fields.time) - 1, 12).astype(int))
    return max(max(float(np.percentile(fields.read(k).stress, 99.8)) for k in frames), 1e-6)
