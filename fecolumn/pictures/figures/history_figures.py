"""Figures of one analysis: the top's displacement under the ground motion, its path in plan, and
the energy ledger.
"""

from __future__ import annotations

from pathlib import Path

from fecolumn.engines.stored import stored_history
from fecolumn.pictures.figures.energy_figure import energy_figure
from fecolumn.pictures.figures.history_curves import HistoryCurves, read_ending
from fecolumn.pictures.figures.path_figure import path_figure
from fecolumn.pictures.figures.structure_figures import figure_names, structure_figures
from fecolumn.pictures.figures.top_figure import top_figure


def has_figures(folder: Path | str) -> bool:
    """Whether all figures of an analysis' folder are there and none is older than its history."""
    folder = Path(folder)
    try:
        names = ("u_top", "path", "energy", *figure_names(_names(folder / "history.h5")))
        drawn = [
            (folder / f"{name}.{kind}").stat().st_mtime_ns
            for name in names
            for kind in ("png", "pdf")
        ]
        return min(drawn) >= (folder / "history.h5").stat().st_mtime_ns
    except FileNotFoundError:
        return False


def history_figures(folder: Path | str) -> list[Path]:
    """Write u_top, path and energy of an analysis' folder, of a structure interfaces, storeys,
    links and bonds besides, each as PNG and PDF; needs history.h5 and summary.json.
    """
    folder = Path(folder)
    history, ending = HistoryCurves.read(folder / "history.h5"), read_ending(folder)
    files = [
        *top_figure(history, ending, folder / "u_top"),
        *path_figure(history, ending, folder / "path"),
        *energy_figure(history, folder / "energy"),
    ]
    of_structure = tuple(
        name
        for name in _names(folder / "history.h5")
        if name.startswith(("interface/", "storey/", "link/", "bond/"))
    )
    return files + (
        structure_figures(stored_history(folder / "history.h5", ("time", *of_structure)), folder)
        if of_structure
        else []
    )


def _names(file: Path) -> list[str]:
    """Columns of a history; none of a file that cannot be read."""
    import h5py

    names: list[str] = []
    try:
        with h5py.File(file) as content:
            content.visititems(
                lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None
            )
    except Exception:  # whatever a damaged file makes h5py raise
        return []
    return names
