"""One analysis: its history as arrays with units, its summary, its figures."""

from __future__ import annotations

import functools
import html
import typing
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.foundation.deprecated import renamed
from fecolumn.foundation.files import is_file
from fecolumn.study.results.analysis_plots import AnalysisPlots, history_of
from fecolumn.study.results.parting import Parting, parting
from fecolumn.study.results.picture_options import PictureOptions, picture_signature, render_options

if TYPE_CHECKING:
    import pandas
    import xarray

# what a notebook shows of a summary: key, words, factor, unit
_SHOWN = (
    ("outcome", "outcome", None, ""),
    ("u_max_m", "largest displacement of the top", 1e3, "mm"),
    ("u_critical_m", "critical displacement", 1e3, "mm"),
    ("residual_slide_m", "slide at the end", 1e3, "mm"),
    ("duration_s", "analysed", 1.0, "s"),
    ("steps", "steps", None, ""),
    ("energy_closure_rel", "energy not accounted for, of what was moved", 1.0, ""),
)


class AnalysisResult:
    """What is in the folder of `fecolumn.run`.

    `result["u_top"]` is an array of the history, its first axis time; `result.units["u_top"]` its
    unit. Units are SI.

    Attributes
    ----------
    folder
        Path.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        self._summary: dict[str, Any] = {}

    @functools.cached_property
    def history(self) -> dict[str, NDArray[Any]]:
        """Arrays by name: time, u_top, tilt, ..., "energy/kinetic", ...

        Raises
        ------
        InputError
            the analysis has written none yet, or it is damaged or of another case.
        """
        return history_of(self.folder)

    @property
    def summary(self) -> dict[str, Any]:
        """What summary.json says; empty while the analysis has not ended, and looked for again
        then.

        Raises
        ------
        InputError
            it is damaged, edited, or of another case.
        """
        from fecolumn.engines.summary import SUMMARY_FILE, summary_of_folder

        if not self._summary and is_file(self.folder / SUMMARY_FILE):
            self._summary = summary_of_folder(self.folder)
        return self._summary

    @functools.cached_property
    def case(self) -> Case:
        """The Case that was analysed."""
        from fecolumn.simulation import read_folder_case

        return read_folder_case(self.folder)[0]

    def __getitem__(self, name: str) -> NDArray[Any]:
        try:
            return self.history[name]
        except KeyError:
            raise KeyError(
                f"{name!r} is not in the history; it has {', '.join(self.history)}"
            ) from None

    @property
    def time(self) -> NDArray[Any]:
        """Times (n,) [s] of the samples."""
        return self["time"]

    @property
    def units(self) -> dict[str, str]:
        """Unit of each array."""
        return {name: self._attributes[name]["unit"] for name in self.history}

    @functools.cached_property
    def _attributes(self) -> dict[str, dict[str, str]]:
        """Unit and, of many, meaning of each array by its name.

        Raises
        ------
        InputError
            as of `history`; or an array has no unit.
        """
        import h5py

        from fecolumn.engines.stored import stored

        path = self.folder / "history.h5"

        def read() -> dict[str, dict[str, str]]:
            found = {}
            with h5py.File(path) as file:
                for name in self.history:
                    found[name] = {"meaning": "", **file[name].attrs}
                    if "unit" not in found[name]:
                        raise ValueError(f"{name} has no unit")
            return found

        return stored(path, "a history of an analysis", read)

    @property
    def energy(self) -> dict[str, NDArray[Any]]:
        """Terms of the energy ledger (n,) [J] by name, those of the manual's page outputs; zero
        where an earlier version did not write one.
        """
        return {
            term: self.history.get(f"energy/{term}", np.zeros(len(self.time))) for term in TERMS
        }

    @property
    def finished(self) -> bool:
        """Whether the analysis has ended."""
        return bool(self.summary)

    @functools.cached_property
    def data(self) -> xarray.Dataset:
        """The history as an xarray.Dataset, as of `to_xarray`: `result.data["tilt"].plot()`."""
        return self.to_xarray()

    def columns(self) -> dict[str, NDArray[Any]]:
        """One array (n,) a component, named with its unit: "time [s]", "u_top_x [m]", ..."""
        named = {}
        for name, values in self.history.items():
            parts = [""] if values.ndim == 1 else [f"_{axis}" for axis in "xyz"[: values.shape[1]]]
            for part, column in zip(parts, values.reshape(len(values), -1).T):
                named[f"{name}{part} [{self.units[name]}]"] = column
        return named

    def to_pandas(self) -> pandas.DataFrame:
        """DataFrame of `columns`, time its index."""
        import pandas

        return pandas.DataFrame(self.columns()).set_index("time [s]")

    def to_xarray(self) -> xarray.Dataset:
        """Dataset with time as coordinate; unit and meaning are attributes, as xarray's plots show
        them.
        """
        import xarray

        arrays = {}
        for name, values in self.history.items():
            axes = (
                ("time",)
                if values.ndim == 1
                else ("time", "axis" if values.shape[1] == 3 else "horizontal")
            )
            arrays[name.replace("/", "_")] = (
                axes,
                values,
                {
                    "units": self.units[name],
                    "long_name": self._attributes[name]["meaning"] or name.replace("/", " "),
                },
            )
        coordinates = {"time": arrays.pop("time"), "axis": list("xyz"), "horizontal": list("xy")}
        return xarray.Dataset(
            arrays, coordinates, {"case": self.case.title, "case_id": self.case.id}
        )

    @property
    def plot(self) -> AnalysisPlots:
        """Figures: `plot.top()`, `plot.path()`, `plot.energy()`, of a structure
        `plot.joints()`, `plot.storeys()`, `plot.links()` and
        `plot.bonds()`.
        """
        return AnalysisPlots(self.folder)

    @renamed(color="colour")
    def render(self, *, quiet: bool = True, **options: typing.Unpack[PictureOptions]) -> list[Path]:
        """Draw the analysis as `fecolumn render` does, into the folder `render` of its own.

        Parameters
        ----------
        only
            "movie" or "pictures", which are stills and sequence; left out: both.
        view
            from where: "lean" sees the largest lean at full length, "front" looks along y, "side"
            along -x, or "iso", "foot", "plan"; left out: lean, of `html` iso.
        body
            of a structure: the body whose top is followed and at whose foot the view "foot" looks;
            left out: the observed one.
        instants
            times of stills and sequence [s], ten at most; left out: five, the peaks of the top's
            displacement.
        start, end
            of the movie or page [s]; left out: those of the analysis.
        speed
            seconds of motion in a second of the movie, 0.001 to 100.
        fps
            pictures a second, 1 to 60.
        size
            (width, height) of the movie [pixels], even numbers.
        colour
            "stress" (von Mises), "displacement" or "none"; left out: stress where there are
            states or fields, none with `forces`.
        exaggerate
            factor on elastic displacements, 1 to 1e6, or "auto".
        forces
            whether resultants, thrust line and hinges are drawn over the bodies.
        gif
            whether the movie is a GIF, not an MP4.
        html
            whether one page with the motion in three dimensions is written, and nothing else.
        paraview
            whether a script for ParaView is written, and nothing else.
        quiet
            no progress on stderr.

        Returns
        -------
        The files.

        Raises
        ------
        InputError
            no history yet, a value out of range, times outside of the analysis, or what needs
            fields or states that were not written; options are named as those of the command.
        TypeError
            an option that there is not.
        """
        from fecolumn.pictures.render.draw import render

        return render(self.folder, render_options(options), quiet=quiet)

    # help and type checkers see each option
    render.__signature__ = picture_signature()  # type: ignore[attr-defined]

    def compare(self, other: AnalysisResult, *, tolerance: float = 0.05) -> Parting:
        """Compare with another analysis as `fecolumn compare` does.

        Parameters
        ----------
        other
            the reference.
        tolerance
            difference over the larger peak [-] at which they have parted.

        Raises
        ------
        InputError
            a history is missing, or they have no time in common.
        """
        return parting(self, other, tolerance)

    def __repr__(self) -> str:
        return (
            f"AnalysisResult({str(self.folder)!r}: {self.summary.get('outcome', 'not finished')})"
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{words}</th>"
            f"<td>{_cell(self.summary[key], factor, unit)}</td></tr>"
            for key, words, factor, unit in _SHOWN
            if self.summary.get(key) is not None
        )
        title = html.escape(self.case.title or str(self.folder))
        return (
            f"<table><caption>{title}</caption>{rows or '<tr><td>not finished</td></tr>'}</table>"
        )


def _cell(value: Any, factor: float | None, unit: str) -> str:
    text = f"{factor * value:.4g} {unit}" if factor is not None else str(value)
    return html.escape(text.strip())
