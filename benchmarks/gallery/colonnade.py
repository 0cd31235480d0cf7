"""Film of a colonnade that collapses, computed by the package's rigid engine."""

from __future__ import annotations

import shutil
from pathlib import Path

from fecolumn.case.case import case_from_tables
from fecolumn.foundation.toml_file import read_toml
from fecolumn.pictures.render.draw import render
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.simulation import run

# End of the film [s], pictures a second, its size in pixels
_LAST, _RATE, _SIZE = 6.0, 12, (800, 450)


def colonnade(folder: Path, file: Path, target: Path) -> str:
    """Draw the film; what is drawn, in words."""
    tables = read_toml(file)
    tables["motion"]["free_vibration_s"] = _LAST
    run(case_from_tables(tables, file), folder)
    options = RenderOptions(
        only="movie", gif=True, view="front", color="none", end=_LAST, fps=_RATE, size=_SIZE
    )
    shutil.copy(render(folder, options, quiet=True)[0], target)
    return f"meshes/{file.name}, its first {_LAST:g} s"
