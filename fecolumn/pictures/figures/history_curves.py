"""What figures of an analysis are drawn from: its history, and how it ended."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.engines.stored import stored_history
from fecolumn.engines.summary import summary_of_folder
from fecolumn.foundation.files import Unreadable, read_json
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.figures.specimen_outline import Outline, specimen_outline


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

    time: NDArray[Any]
    u_top: NDArray[Any]
    tilt: NDArray[Any]
    ground: NDArray[Any]
    energy: dict[str, NDArray[Any]]

    @classmethod
    def read(cls, file: Path) -> HistoryCurves:
        """History of an HDF5 file.

        Raises
        ------
        InputError
            missing file, or one without the datasets of a history.
        """
        columns = stored_history(file)
        try:
            energy = {
                name.removeprefix("energy/"): values
                for name, values in columns.items()
                if name.startswith("energy/")
            }
            ground = columns.get("ground", np.zeros_like(columns["u_top"]))
            return cls(columns["time"], columns["u_top"], columns["tilt"], ground, energy)
        except KeyError as error:
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
    u_max_m
        largest displacement of the top over all steps [m], of which the history may have fewer;
        None where the summary does not tell.
    several
        whether there are several bodies, one of which has the top.
    """

    words: str
    lost: bool
    u_critical_m: float | None
    outline: Outline | None
    u_max_m: float | None = None
    several: bool = False


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
        words,
        overturned or words == "slid off",
        summary.get("u_critical_m"),
        outline,
        summary.get("u_max_m"),
        len(summary.get("bodies", {})) > 1,
    )
