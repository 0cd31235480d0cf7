"""Figures of one analysis: the top's displacement under the ground motion, its path in plan, and
the energy ledger.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.engines.dynamics.history import read_history
from fecolumn.engines.summary import check_owner, summary_of_folder
from fecolumn.foundation.files import Unreadable, read_json
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.figures.energy_figure import energy_figure
from fecolumn.pictures.figures.path_figure import path_figure
from fecolumn.pictures.figures.specimen_outline import Outline, specimen_outline
from fecolumn.pictures.figures.structure_figures import figure_names, structure_figures
from fecolumn.pictures.figures.top_figure import top_figure


@dataclass(frozen=True, slots=True)
class HistoryCurves:
    """What an analysis recorded at its n steps.

    Attributes
    ----------
    time
        (n,) [s].
    u_top
        (n, 3) [m] displacement of the top relative to the base.
    tilt
        (n,) [rad] angle of the axis to the vertical.
    ground
        (n, 3) [m/s2] acceleration of the base; zeros where it was not recorded.
    energy
        (n,) [J] by term: kinetic, strain, gravity, base_work, friction, impact, contact,
        algorithmic, damping, rolling, links, closure.
    """

    time: np.ndarray
    u_top: np.ndarray
    tilt: np.ndarray
    ground: np.ndarray
    energy: dict[str, np.ndarray]

    @classmethod
    def read(cls, file) -> HistoryCurves:
        """History of an HDF5 file.

        Raises
        ------
        InputError
            missing file, or one without the datasets of a history.
        """
        check_owner(file)
        try:
            columns = read_history(file)
            energy = {
                name.removeprefix("energy/"): values
                for name, values in columns.items()
                if name.startswith("energy/")
            }
            ground = columns.get("ground", np.zeros_like(columns["u_top"]))
            return cls(columns["time"], columns["u_top"], columns["tilt"], ground, energy)
        except (OSError, KeyError) as error:
            raise InputError(file, "", None, f"not a history of an analysis ({error})") from None


@dataclass(frozen=True, slots=True)
class EndingMark:
    """How an analysis ended, for its figures.

    Attributes
    ----------
    words
        "at rest", "still rocking", "overturned", "slid off"; "end" where the summary does not tell.
    lost
        whether the column was lost, so that its last displacement is no peak.
    u_critical_m
        displacement of the top at which the column stands over its rim [m]; None where the summary
        does not tell.
    outline
        of the specimen; None where the case does not tell.
    """

    words: str
    lost: bool
    u_critical_m: float | None
    outline: Outline | None


def read_ending(folder: Path) -> EndingMark:
    """The end of the analysis in a result folder.

    Raises
    ------
    InputError
        no summary that can be read.
    """
    summary = summary_of_folder(folder)
    overturned = summary["overturned"]
    try:
        outline = specimen_outline(read_json(folder / "case.json")["case"])
    except (Unreadable, KeyError, TypeError, ValueError, AttributeError):
        outline = None
    words = summary.get("outcome") or ("overturned" if overturned else "end")
    return EndingMark(
        words, overturned or words == "slid off", summary.get("u_critical_m"), outline
    )


def has_figures(folder) -> bool:
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


def history_figures(folder) -> list[Path]:
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
        structure_figures(read_history(folder / "history.h5", ("time", *of_structure)), folder)
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
    except OSError:
        return []
    return names
