"""Figures of a structure of many bodies: what its interfaces do over time, and drifts and shears of its storeys."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.post.style import GREY, LINES, PAGE_WIDTH_IN, new_figure, save, styled
from fecolumn.render.quantity import Quantity

# Quantities of an interface: column of the history, words, symbol, SI unit
_OF_INTERFACE = (("tilt", "tilt", r"$\theta$", "rad"), ("rise", "uplift of the\nfoot's middle", "$w$", "m"), ("slide", "slide", "$s$", "m"), ("force", "normal force", "$N$", "N"))
# Interfaces side by side in a figure; joints of one that are told apart by colour and dash
_ABREAST, _APART = 3, len(LINES)


def structure_figures(columns: dict[str, np.ndarray], folder: Path, formats=("png", "pdf")) -> list[Path]:
    """Write interfaces.png, more of them where there are more interfaces than go side by side, and storeys.png of a structure with storeys; each as PDF, too.

    Args:
        columns: of `dynamics.history`, of a structure.
    """
    files, names = [], interface_names(columns)
    for first in range(0, len(names), _ABREAST):
        number = f"_{first // _ABREAST + 1}" if first else ""
        files += interface_figure(columns, folder / f"interfaces{number}", names[first:first + _ABREAST], formats)
    return files + (storey_figure(columns, folder / "storeys", formats) if storey_names(columns) else [])


def figure_names(columns) -> list[str]:
    """Names of the files of `structure_figures` without their suffix, from the names of a history's columns."""
    count = -(-len(interface_names(columns)) // _ABREAST)
    return [f"interfaces{f'_{number}' if number > 1 else ''}" for number in range(1, count + 1)] + (["storeys"] if storey_names(columns) else [])


def interface_names(columns) -> list[str]:
    """Interfaces of which a history has columns, in their order."""
    return list(dict.fromkeys(name.split("/")[1].partition(":")[0] for name in columns if name.startswith("interface/")))


def storey_names(columns) -> list[str]:
    """Storeys such as "building 1" of which a history has columns, from below."""
    found = [name.split("/")[1] for name in columns if name.startswith("storey/") and name.endswith("/drift")]
    return sorted(found, key=lambda name: (name.rpartition(" ")[0], int(name.rpartition(" ")[2])))


def _in_unit(values: list[np.ndarray], unit: str) -> tuple[list[np.ndarray], str]:
    """Values [SI] in a unit that fits their peak, and its name."""
    quantity = Quantity.of("", unit, max(float(np.abs(each).max()) for each in values))
    return [each / quantity.scale for each in values], quantity.unit


def _drawn(axes, time, values: list[np.ndarray], names: list[str]) -> None:
    """Lines told apart by colour and dash; where there are too many all are grey and the one with the largest peak is drawn on them."""
    if len(values) <= _APART:
        for each, name, (colour, dashes) in zip(values, names, LINES):
            axes.plot(time, each, color=colour, linestyle=dashes, linewidth=0.9, label=name)
        return
    peak = int(np.argmax([np.abs(each).max() for each in values]))
    for each in values:
        axes.plot(time, each, color=GREY, linewidth=0.4)
    axes.plot([], [], color=GREY, linewidth=0.8, label=f"{len(values)} joints")
    axes.plot(time, values[peak], color=LINES[0][0], linewidth=0.9, label=names[peak])


def interface_figure(columns, path, interfaces: list[str], formats=("png", "pdf")) -> list[Path]:
    """Tilt of the slave from the master, rise of the middle of its foot, slide and normal force at the joints of some interfaces; a column of panels each.

    Args:
        path: file name without suffix.
    """
    time = columns["time"]
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 6.0)
        grid = figure.subplots(len(_OF_INTERFACE), len(interfaces), sharex=True, squeeze=False)
        for (what, words, symbol, unit), row in zip(_OF_INTERFACE, grid):
            found = [[(name.split("/")[1].partition(": ")[2], columns[name]) for name in columns
                      if name.startswith(f"interface/{interface}:") and name.endswith(f"/{what}")] for interface in interfaces]
            lines = [values if values.ndim == 1 else np.hypot(*values.T) for joints in found for _, values in joints]
            lines, unit = _in_unit(lines, unit)
            low, high = min(each.min() for each in lines), max(each.max() for each in lines)
            margin = 0.05 * (high - low) or 0.05 * max(abs(high), 1.0)
            for axes, joints in zip(row, found):
                _drawn(axes, time, lines[:len(joints)], [name for name, _ in joints])
                lines = lines[len(joints):]
                # one scale a row, so that interfaces can be compared
                axes.set_ylim(low - margin, high + margin)
                axes.tick_params(labelleft=axes is row[0])
            row[0].set_ylabel(f"{words}\n{symbol} [{unit}]")
        for axes, interface in zip(grid[0], interfaces):
            axes.set_title(interface)
        for axes in grid[-1]:
            axes.set(xlabel="time [s]", xlim=(time[0], time[-1]))
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.42), framealpha=0, borderaxespad=0, ncol=1 if len(interfaces) > 1 else 3)
        figure.align_ylabels(grid[:, 0])
        return save(figure, path, formats)


def storey_figure(columns, path, formats=("png", "pdf")) -> list[Path]:
    """Drift and shear of each storey over time, along the axes along which any storey moves; beside them the largest ones over the storeys' numbers.

    Args:
        path: file name without suffix.
    """
    time, names = columns["time"], storey_names(columns)
    buildings = {name.rpartition(" ")[0] for name in names}
    words_of_storeys = [f"storey {number}" if len(buildings) == 1 else f"{building}, storey {number}" for building, _, number in (name.rpartition(" ") for name in names)]
    drifts, shears = ([columns[f"storey/{name}/{what}"] for name in names] for what in ("drift", "shear"))
    most = [max(np.abs(drift[:, axis]).max() for drift in drifts) for axis in range(2)]
    axes_moved = [axis for axis in range(2) if most[axis] > 1e-3 * max(most)] or [0]
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 2.1 * len(axes_moved) * 2)
        grid = figure.subplots(2 * len(axes_moved), 2, squeeze=False, gridspec_kw={"width_ratios": [3.2, 1]})
        rows = [(values, words, symbol, unit, axis) for values, words, symbol, unit in ((drifts, "drift", r"$\delta", "m"), (shears, "shear", "$V", "N")) for axis in axes_moved]
        for (values, words, symbol, unit, axis), (over_time, peaks) in zip(rows, grid):
            lines, unit = _in_unit([each[:, axis] for each in values], unit)
            _drawn(over_time, time, lines, words_of_storeys)
            over_time.set(xlim=(time[0], time[-1]), ylabel=f"{words} along {'xy'[axis]}\n{symbol}_{'xy'[axis]}$ [{unit}]")
            over_time.tick_params(labelbottom=over_time is grid[-1, 0])
            largest = 0.0
            for building, (colour, dashes) in zip(sorted(buildings), LINES):
                own = [(int(name.rpartition(" ")[2]), np.abs(each).max()) for name, each in zip(names, lines) if name.rpartition(" ")[0] == building]
                peaks.plot(*zip(*((peak, number) for number, peak in own)), marker="o", color=colour, linestyle=dashes, markersize=3.5)
                largest = max(largest, *(peak for _, peak in own))
            peaks.set(xlabel=f"largest {symbol}_{'xy'[axis]}$ [{unit}]", ylabel="storey", xlim=(0, 1.08 * largest or 1.0), ylim=(0.5, max(int(name.rpartition(' ')[2]) for name in names) + 0.5))
            peaks.locator_params(axis="y", integer=True, nbins=6)
        grid[-1, 0].set_xlabel("time [s]")
        grid[0, 0].legend(loc="lower left", bbox_to_anchor=(0, 1.0), ncol=4, framealpha=0, borderaxespad=0.2)
        figure.align_ylabels(grid[:, 0])
        return save(figure, path, formats)
