"""Figures of one analysis: the top's displacement, its path in plan, and the energy ledger."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.dynamics.history import read_history
from fecolumn.files import Unreadable, read_json
from fecolumn.post.style import (BLACK, BLUE, COLUMN_WIDTH_IN, GREEN, LINES, ORANGE, PAGE_WIDTH_IN, PURPLE, SKY, VERMILION,
                                 new_figure, save, styled)
from fecolumn.schema import InputError

# Terms of the ledger as a reader knows them, with colour and dash: what is stored and put in, and what is lost.
_MOVED = {"kinetic": ("kinetic", VERMILION, "-"), "strain": ("strain", ORANGE, "-"),
          "gravity": ("gravity potential", BLUE, "-"), "base_work": ("work of the base", BLACK, "-")}
_LOST = {"friction": ("friction", GREEN, "-"), "impact": ("impact", PURPLE, "-"),
         "contact": ("contact on release", ORANGE, "--"), "algorithmic": ("numerical (HHT)", SKY, "-."),
         "damping": ("damping of modes", BLUE, ":"), "rolling": ("rolling resistance", VERMILION, ":")}


@dataclass(frozen=True, slots=True)
class History:
    """What an analysis recorded at its n steps.

    Attributes:
        time: (n,) [s].
        u_top: (n, 3) [m] displacement of the top relative to the base.
        tilt: (n,) [rad] angle of the axis to the vertical.
        energy: (n,) [J] by term: kinetic, strain, gravity, base_work, friction, impact, contact, algorithmic, damping, rolling,
            closure.
    """

    time: np.ndarray
    u_top: np.ndarray
    tilt: np.ndarray
    energy: dict[str, np.ndarray]

    @classmethod
    def read(cls, file) -> History:
        """History of an HDF5 file.

        Raises:
            InputError: missing file, or one without the datasets of a history.
        """
        try:
            columns = read_history(file)
            energy = {name.removeprefix("energy/"): values for name, values in columns.items() if name.startswith("energy/")}
            return cls(columns["time"], columns["u_top"], columns["tilt"], energy)
        except (OSError, KeyError) as error:
            raise InputError(file, "", None, f"not a history of an analysis ({error})") from None


def history_figures(folder) -> list[Path]:
    """Write u_top, path and energy of an analysis' folder, each as PNG and PDF; needs history.h5 and summary.json."""
    folder = Path(folder)
    history = History.read(folder / "history.h5")
    try:
        summary = read_json(folder / "summary.json")
    except Unreadable as error:
        raise InputError(folder / "summary.json", "", None, str(error)) from None
    return [*displacement_figure(history, bool(summary["overturned"]), folder / "u_top"),
            *path_figure(history, bool(summary["overturned"]), folder / "path"),
            *energy_figure(history, folder / "energy")]


def displacement_figure(history: History, overturned: bool, path) -> list[Path]:
    """Horizontal displacement of the top against time, its magnitude and the tilt."""
    time, u = history.time, 1e3 * history.u_top[:, :2]
    magnitude = np.hypot(*u.T)
    peak = int(np.argmax(magnitude))
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 3.4)
        above, below = figure.subplots(2, 1, sharex=True)
        for component, label, (colour, dashes) in zip(u.T, ("$u_x$", "$u_y$"), LINES):
            above.plot(time, component, color=colour, linestyle=dashes, label=label)
        above.set_ylabel("top displacement [mm]")
        _legend_beside(above)
        below.plot(time, magnitude, color=BLACK, label=r"$|u| = \sqrt{u_x^2 + u_y^2}$")
        word = "overturned" if overturned else r"$u_{\max}$"
        below.plot(time[peak], magnitude[peak], "o", color=VERMILION, markersize=4, clip_on=False, linestyle="none",
                   label=f"{word}: {magnitude[peak]:.3g} mm\nat {time[peak]:.3g} s, tilt {np.degrees(history.tilt[peak]):.2g}°")
        below.set(xlabel="time [s]", ylabel="top displacement [mm]", xlim=(time[0], time[-1]), ylim=(0, None))
        _legend_beside(below)
        return save(figure, path)


def path_figure(history: History, overturned: bool, path) -> list[Path]:
    """Path of the top seen from above, coloured by time."""
    from matplotlib.collections import LineCollection

    u, time = 1e3 * history.u_top[:, :2], history.time
    half = 1.08 * max(float(np.abs(u).max()), 1e-6)
    with styled():
        figure = new_figure(COLUMN_WIDTH_IN, 3.0)
        axes = figure.subplots()
        lines = LineCollection(np.stack([u[:-1], u[1:]], axis=1), array=time[1:], cmap="viridis", linewidths=0.9, capstyle="round")
        lines.set_clim(time[0], time[-1])
        axes.add_collection(lines)
        axes.plot(*u[0], "o", color=BLACK, markersize=4, label="start")
        axes.plot(*u[-1], "X" if overturned else "s", color=VERMILION, markersize=5, label="overturned" if overturned else "end")
        axes.set(xlim=(-half, half), ylim=(-half, half), aspect="equal", xlabel="$u_x$ [mm]", ylabel="$u_y$ [mm]")
        axes.legend(loc="best")
        figure.colorbar(lines, ax=axes, label="time [s]", shrink=0.85)
        return save(figure, path)


def energy_figure(history: History, path) -> list[Path]:
    """The energy ledger: stored and supplied, lost, closure error; terms that stay nil are left out."""
    time, energy = history.time, history.energy
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 4.6)
        moved, lost, closure = figure.subplots(3, 1, sharex=True, gridspec_kw={"height_ratios": [3, 2, 1]})
        for axes, terms in ((moved, _MOVED), (lost, _LOST)):
            # results of earlier versions do not have every term
            terms = {term: style for term, style in terms.items() if term in energy}
            largest = max(float(np.abs(energy[term]).max()) for term in terms)
            for term, (label, colour, dashes) in terms.items():
                if np.abs(energy[term]).max() > 1e-6 * largest:
                    axes.plot(time, energy[term], color=colour, linestyle=dashes, label=label)
            if largest:
                _legend_beside(axes)
        moved.set_ylabel("energy [J]")
        lost.set_ylabel("loss < 0 [J]")
        lost.ticklabel_format(axis="y", scilimits=(-2, 3), useMathText=True)
        closure.plot(time, energy["closure"], color=BLACK, linewidth=0.8)
        closure.set(xlabel="time [s]", ylabel="closure [J]", xlim=(time[0], time[-1]))
        closure.ticklabel_format(axis="y", scilimits=(-2, 3), useMathText=True)
        figure.align_ylabels()
        return save(figure, path)


def _legend_beside(axes) -> None:
    axes.legend(loc="upper left", bbox_to_anchor=(1.005, 1.0), borderaxespad=0)
