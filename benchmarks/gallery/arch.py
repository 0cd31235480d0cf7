"""An arch at rest with its thrust line, and how it falls under a push that slowly rises, computed
by the package's rigid engine.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.history import read_history
from fecolumn.foundation.toml_file import read_toml
from fecolumn.pictures.render.draw import render
from fecolumn.pictures.render.render_options import RenderOptions
from fecolumn.simulation import run

# Acceleration [g] at which the arch of meshes/arch.toml becomes a mechanism, by limit analysis; the
# push rises to a little more within [s], and stays
_MECHANISM, _MORE, _RISE, _LAST = 0.159858, 1.03, 3.0, 8.0
# Largest turn between neighbours [rad] at the instants that are drawn beside that of rest
_DRAWN = (0.05, 0.35)


def falling_arch(folder: Path, file: Path) -> Path:
    """Folder of the analysis of the arch in `file`."""
    folder.mkdir(parents=True, exist_ok=True)
    time = np.arange(0.0, _LAST, 0.01)
    rise = (1 - np.cos(np.pi * np.minimum(time / _RISE, 1.0))) / 2
    push = np.column_stack([time, _MORE * _MECHANISM * GRAVITY * rise])
    np.savetxt(folder / "push.csv", push, "%.6f", ",", header="time [s],ax [m/s2]", comments="")
    tables = read_toml(file)
    tables["title"] = "Arch under a push that slowly rises"
    tables["motion"] = {"source": str((folder / "push.csv").resolve())}
    tables["integration"] = {"engine": "rigid", "start": "rest", "duration_s": _LAST}
    run(case_from_tables(tables, file), folder / "run")
    return folder / "run"


def arch(folder: Path, file: Path, target: Path) -> str:
    """Draw the arch at rest and while it falls; what is drawn, in words."""
    done = falling_arch(folder, file)
    history = read_history(done / "history.h5")
    largest = np.max(
        [
            values
            for name, values in history.items()
            if name.startswith("interface/") and name.endswith("/tilt")
        ],
        axis=0,
    )
    times = [0.0, *(float(history["time"][int(np.argmax(largest > turn))]) for turn in _DRAWN)]
    options = RenderOptions(only="pictures", instants=tuple(times), view="front", forces=True)
    files = render(done, options, quiet=True)
    shutil.copy(next(path for path in files if path.name == "sequence.png"), target)
    return (
        f"meshes/{file.name} under {_MORE:g} times the push that makes it a mechanism, at "
        + ", ".join(f"{time:.2f}" for time in times)
        + " s"
    )
