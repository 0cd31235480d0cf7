"""One analysis: its history as arrays with units, its summary, its figures."""

from __future__ import annotations

import functools
import html
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.foundation.files import is_file
from fecolumn.foundation.schema import InputError, meant
from fecolumn.study.results.parting import Parting, parting
from fecolumn.study.results.picture import Picture

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

    @functools.cached_property
    def history(self) -> dict[str, NDArray[Any]]:
        """Arrays by name: time, u_top, tilt, ..., "energy/kinetic", ...

        Raises
        ------
        InputError
            the analysis has written none yet, or it is damaged or of another case.
        """
        from fecolumn.engines.stored import stored_history

        file = self.folder / "history.h5"
        if not is_file(file):
            raise InputError(file, "", None, "not written yet")
        return stored_history(file)

    @functools.cached_property
    def summary(self) -> dict[str, Any]:
        """What summary.json says; empty while the analysis has not ended.

        Raises
        ------
        InputError
            it is damaged, edited, or of another case.
        """
        from fecolumn.engines.summary import SUMMARY_FILE, summary_of_folder

        return summary_of_folder(self.folder) if is_file(self.folder / SUMMARY_FILE) else {}

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
        """Terms of the energy ledger (n,) [J] by name, as of `dynamics.energy.TERMS`; zero where an
        earlier version did not write one.
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
        `plot.interfaces()`, `plot.storeys()`, `plot.links()` and
        `plot.bonds()`.
        """
        return AnalysisPlots(self.folder)

    def render(self, **options: Any) -> list[Path]:
        """Movie, stills and sequence as of `fecolumn render`; the files.

        Parameters
        ----------
        options
            by the names of `pictures.render.render_options.RenderOptions`, such as view="front",
            only="pictures", instants=(0.5, 1.0) [s].
        """
        from fecolumn.pictures.render.draw import render
        from fecolumn.pictures.render.render_options import RenderOptions

        return render(self.folder, RenderOptions(**options), quiet=True)

    def compare(self, other: AnalysisResult, tolerance: float = 0.05) -> Parting:
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


class AnalysisPlots:
    """Figures of an analysis, each a Picture."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def top(self) -> Picture:
        """Displacement of the top against time, below the ground motion."""
        from fecolumn.pictures.figures.history_curves import HistoryCurves, read_ending
        from fecolumn.pictures.figures.top_figure import top_figure

        return Picture(
            lambda path: top_figure(
                HistoryCurves.read(self.folder / "history.h5"), read_ending(self.folder), path
            )
        )

    def path(self) -> Picture:
        """Path of the top in plan."""
        from fecolumn.pictures.figures.history_curves import HistoryCurves, read_ending
        from fecolumn.pictures.figures.path_figure import path_figure

        return Picture(
            lambda path: path_figure(
                HistoryCurves.read(self.folder / "history.h5"), read_ending(self.folder), path
            )
        )

    def interfaces(self, *names: str) -> Picture:
        """Of a structure: tilt, uplift, slide and normal force at interfaces, of all unless
        named.
        """
        from fecolumn.pictures.figures.structure_figures import interface_figure, interface_names

        columns = AnalysisResult(self.folder).history
        chosen = _chosen(names, interface_names(columns), "joint")
        return Picture(lambda path: interface_figure(columns, path, chosen))

    def storeys(self) -> Picture:
        """Of a structure with storeys: their drifts and shears."""
        from fecolumn.pictures.figures.structure_figures import storey_figure

        return Picture(lambda path: storey_figure(AnalysisResult(self.folder).history, path))

    def links(self, *names: str) -> Picture:
        """Of a structure with links: their tension over time and over their elongation, of all
        unless named; copies go by one name.
        """
        from fecolumn.pictures.figures.structure_figures import link_figure, link_names

        columns = AnalysisResult(self.folder).history
        chosen = _chosen(names, link_names(columns), "link")
        return Picture(lambda path: link_figure(columns, path, chosen))

    def bonds(self, *names: str) -> Picture:
        """Of a structure with glued joints: their stresses and how much of them has failed, of all
        unless named.
        """
        from fecolumn.pictures.figures.structure_figures import bond_figure, bond_names

        columns = AnalysisResult(self.folder).history
        return Picture(lambda path: bond_figure(columns, path, list(names) or bond_names(columns)))

    def energy(self) -> Picture:
        """The energy ledger against time."""
        from fecolumn.pictures.figures.energy_figure import energy_figure
        from fecolumn.pictures.figures.history_curves import HistoryCurves

        return Picture(
            lambda path: energy_figure(HistoryCurves.read(self.folder / "history.h5"), path)
        )


def _chosen(names: tuple[str, ...], known: list[str], what: str) -> list[str]:
    """The names that a figure is to show, all unless some are given.

    Raises
    ------
    KeyError
        none of this name, or none at all.
    """
    if not known:
        raise KeyError(f"this analysis has no {what}")
    for name in names:
        if name not in known:
            raise KeyError(f"no {what} {name!r}{meant(name, known)}; known: {', '.join(known)}")
    return list(names) or known


def _cell(value: Any, factor: float | None, unit: str) -> str:
    text = f"{factor * value:.4g} {unit}" if factor is not None else str(value)
    return html.escape(text.strip())
