"""Figures of a structure of many bodies: what its interfaces do over time, drifts and shears of its
storeys, tension and elongation of its links, stress and failure of its glued joints.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.figures.style import (
    GREY,
    LINES,
    PAGE_WIDTH_IN,
    legend_beside,
    new_figure,
    save,
    styled,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# Quantities of an interface: column of the history, words, symbol, SI unit
_OF_INTERFACE = (
    ("tilt", "tilt", r"$\theta$", "rad"),
    ("rise", "uplift of the\nfoot's middle", "$w$", "m"),
    ("slide", "slide", "$s$", "m"),
    ("force", "normal force", "$N$", "N"),
)
# Interfaces side by side in a figure, or links below one another; joints or copies of one that are
# told apart by colour and dash
_ABREAST, _APART = 3, len(LINES)


def structure_figures(
    columns: dict[str, NDArray[Any]], folder: Path, formats: Sequence[str] = ("png", "pdf")
) -> list[Path]:
    """Write interfaces.png, more of them where there are more interfaces than go side by side,
    storeys.png of a structure with storeys and likewise links.png of one with links and bonds.png
    of one with glued joints; each as PDF, too.

    Parameters
    ----------
    columns
        of `dynamics.history`, of a structure.
    """
    files = []
    for stem, figure, names in (
        ("interfaces", interface_figure, interface_names(columns)),
        ("links", link_figure, link_names(columns)),
        ("bonds", bond_figure, bond_names(columns)),
    ):
        for place, file in enumerate(_numbered(stem, len(names))):
            files += figure(
                columns, folder / file, names[_ABREAST * place : _ABREAST * (place + 1)], formats
            )
    return files + (
        storey_figure(columns, folder / "storeys", formats) if storey_names(columns) else []
    )


def _numbered(stem: str, count: int) -> list[str]:
    """Names of the files of so many interfaces, links or glued joints."""
    return [
        f"{stem}{f'_{number}' if number > 1 else ''}"
        for number in range(1, -(-count // _ABREAST) + 1)
    ]


def figure_names(columns: Iterable[str]) -> list[str]:
    """Names of the files of `structure_figures` without their suffix, from the names of a history's
    columns.
    """
    return (
        _numbered("interfaces", len(interface_names(columns)))
        + _numbered("links", len(link_names(columns)))
        + _numbered("bonds", len(bond_names(columns)))
        + (["storeys"] if storey_names(columns) else [])
    )


def interface_names(columns: Iterable[str]) -> list[str]:
    """Interfaces of which a history has columns, in their order."""
    return list(
        dict.fromkeys(
            name.split("/")[1].partition(":")[0]
            for name in columns
            if name.startswith("interface/")
        )
    )


def link_names(columns: Iterable[str]) -> list[str]:
    """Links of which a history has columns, in their order; copies such as "tendon 1" and "tendon
    2" go by one name.
    """
    return list(
        dict.fromkeys(_copied(name.split("/")[1]) for name in columns if name.startswith("link/"))
    )


def bond_names(columns: Iterable[str]) -> list[str]:
    """Glued joints of which a history has columns, in their order."""
    return list(dict.fromkeys(name.split("/")[1] for name in columns if name.startswith("bond/")))


def _copied(name: str) -> str:
    """Name of a link without the number of its copy."""
    first, _, number = name.rpartition(" ")
    return first if number.isdigit() and first else name


def storey_names(columns: Iterable[str]) -> list[str]:
    """Storeys such as "building 1" of which a history has columns, from below."""
    found = [
        name.split("/")[1]
        for name in columns
        if name.startswith("storey/") and name.endswith("/drift")
    ]
    return sorted(found, key=lambda name: (name.rpartition(" ")[0], int(name.rpartition(" ")[2])))


def _in_unit(values: list[NDArray[Any]], unit: str) -> tuple[list[NDArray[Any]], str]:
    """Values [SI] in a unit that fits their peak, and its name."""
    quantity = Quantity.of("", unit, max(float(np.abs(each).max()) for each in values))
    return [each / quantity.scale for each in values], quantity.unit


def _drawn(
    axes: Axes,
    places: list[NDArray[Any]],
    values: list[NDArray[Any]],
    names: list[str],
    kind: str = "joints",
) -> None:
    """Lines told apart by colour and dash; where there are too many all are grey and the one with
    the largest peak is drawn on them.
    """
    if len(values) <= _APART:
        for place, each, name, (colour, dashes) in zip(places, values, names, LINES):
            axes.plot(place, each, color=colour, linestyle=dashes, linewidth=0.9, label=name)
        return
    peak = int(np.argmax([np.abs(each).max() for each in values]))
    for place, each in zip(places, values):
        axes.plot(place, each, color=GREY, linewidth=0.4)
    axes.plot([], [], color=GREY, linewidth=0.8, label=f"{len(values)} {kind}")
    axes.plot(places[peak], values[peak], color=LINES[0][0], linewidth=0.9, label=names[peak])


def interface_figure(
    columns: Mapping[str, NDArray[Any]],
    path: Path | str,
    interfaces: list[str],
    formats: Sequence[str] = ("png", "pdf"),
) -> list[Path]:
    """Tilt of the slave from the master, rise of the middle of its foot, slide and normal force at
    the joints of some interfaces; a column of panels each.

    Parameters
    ----------
    path
        file name without suffix.
    """
    time = columns["time"]
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 6.0)
        grid = figure.subplots(len(_OF_INTERFACE), len(interfaces), sharex=True, squeeze=False)
        for (what, words, symbol, unit), row in zip(_OF_INTERFACE, grid):
            found = [
                [
                    (name.split("/")[1].partition(": ")[2], columns[name])
                    for name in columns
                    if name.startswith(f"interface/{interface}:") and name.endswith(f"/{what}")
                ]
                for interface in interfaces
            ]
            lines = [
                values if values.ndim == 1 else np.hypot(*values.T)
                for joints in found
                for _, values in joints
            ]
            lines, unit = _in_unit(lines, unit)
            low, high = min(each.min() for each in lines), max(each.max() for each in lines)
            margin = 0.05 * (high - low) or 0.05 * max(abs(high), 1.0)
            for axes, joints in zip(row, found):
                _drawn(
                    axes, [time] * len(joints), lines[: len(joints)], [name for name, _ in joints]
                )
                lines = lines[len(joints) :]
                # one scale a row, so that interfaces can be compared
                axes.set_ylim(low - margin, high + margin)
                axes.tick_params(labelleft=axes is row[0])
            row[0].set_ylabel(f"{words}\n{symbol} [{unit}]")
        for axes, interface in zip(grid[0], interfaces):
            axes.set_title(interface)
        for axes in grid[-1]:
            axes.set(xlabel="time [s]", xlim=(time[0], time[-1]))
            axes.legend(
                loc="upper center",
                bbox_to_anchor=(0.5, -0.42),
                framealpha=0,
                borderaxespad=0,
                ncol=1 if len(interfaces) > 1 else 3,
            )
        figure.align_ylabels(grid[:, 0])
        return save(figure, path, formats)


def storey_figure(
    columns: Mapping[str, NDArray[Any]], path: Path | str, formats: Sequence[str] = ("png", "pdf")
) -> list[Path]:
    """Drift and shear of each storey over time, along the axes along which any storey moves; beside
    them the largest ones over the storeys' numbers.

    Parameters
    ----------
    path
        file name without suffix.
    """
    time, names = columns["time"], storey_names(columns)
    buildings = {name.rpartition(" ")[0] for name in names}
    words_of_storeys = [
        f"storey {number}" if len(buildings) == 1 else f"{building}, storey {number}"
        for building, _, number in (name.rpartition(" ") for name in names)
    ]
    drifts, shears = (
        [columns[f"storey/{name}/{what}"] for name in names] for what in ("drift", "shear")
    )
    most = [max(np.abs(drift[:, axis]).max() for drift in drifts) for axis in range(2)]
    axes_moved = [axis for axis in range(2) if most[axis] > 1e-3 * max(most)] or [0]
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 2.1 * len(axes_moved) * 2)
        grid = figure.subplots(
            2 * len(axes_moved), 2, squeeze=False, gridspec_kw={"width_ratios": [3.2, 1]}
        )
        rows = [
            (values, words, symbol, unit, axis)
            for values, words, symbol, unit in (
                (drifts, "drift", r"$\delta", "m"),
                (shears, "shear", "$V", "N"),
            )
            for axis in axes_moved
        ]
        for (values, words, symbol, unit, axis), (over_time, peaks) in zip(rows, grid):
            lines, unit = _in_unit([each[:, axis] for each in values], unit)
            _drawn(over_time, [time] * len(lines), lines, words_of_storeys)
            over_time.set(
                xlim=(time[0], time[-1]),
                ylabel=f"{words} along {'xy'[axis]}\n{symbol}_{'xy'[axis]}$ [{unit}]",
            )
            over_time.tick_params(labelbottom=over_time is grid[-1, 0])
            largest = 0.0
            for building, (colour, dashes) in zip(sorted(buildings), LINES):
                own = [
                    (int(name.rpartition(" ")[2]), np.abs(each).max())
                    for name, each in zip(names, lines)
                    if name.rpartition(" ")[0] == building
                ]
                peaks.plot(
                    *zip(*((peak, number) for number, peak in own)),
                    marker="o",
                    color=colour,
                    linestyle=dashes,
                    markersize=3.5,
                )
                largest = max(largest, *(peak for _, peak in own))
            peaks.set(
                xlabel=f"largest {symbol}_{'xy'[axis]}$ [{unit}]",
                ylabel="storey",
                xlim=(0, 1.08 * largest or 1.0),
                ylim=(0.5, max(int(name.rpartition(" ")[2]) for name in names) + 0.5),
            )
            peaks.locator_params(axis="y", integer=True, nbins=6)
        grid[-1, 0].set_xlabel("time [s]")
        grid[0, 0].legend(
            loc="lower left", bbox_to_anchor=(0, 1.0), ncol=4, framealpha=0, borderaxespad=0.2
        )
        figure.align_ylabels(grid[:, 0])
        return save(figure, path, formats)


def link_figure(
    columns: Mapping[str, NDArray[Any]],
    path: Path | str,
    links: list[str],
    formats: Sequence[str] = ("png", "pdf"),
) -> list[Path]:
    """Tension of some links over time, and beside it over their elongation until they break, there
    a cross: the area of a loop is the energy taken, which is told. A row for each, a line for each
    copy.

    Parameters
    ----------
    path
        file name without suffix.
    """
    time = columns["time"]
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 0.5 + 1.9 * len(links))
        grid = figure.subplots(len(links), 2, squeeze=False, gridspec_kw={"width_ratios": [1.7, 1]})
        for link, (over_time, loops) in zip(links, grid):
            copies = [
                name
                for name in dict.fromkeys(
                    name.split("/")[1] for name in columns if name.startswith("link/")
                )
                if _copied(name) == link
            ]
            tensions, force = _in_unit([columns[f"link/{name}/tension"] for name in copies], "N")
            whole = [
                slice(max(1, np.count_nonzero(columns[f"link/{name}/broken"] == 0)))
                for name in copies
            ]
            ways, length = _in_unit(
                [columns[f"link/{name}/elongation"][rows] for name, rows in zip(copies, whole)], "m"
            )
            _drawn(over_time, [time] * len(copies), tensions, copies, "links")
            _drawn(
                loops, ways, [each[rows] for each, rows in zip(tensions, whole)], copies, "links"
            )
            broke = [
                (way[-1], tension[rows][-1])
                for name, way, tension, rows in zip(copies, ways, tensions, whole)
                if columns[f"link/{name}/broken"][-1]
            ]
            if broke:
                loops.scatter(*zip(*broke), marker="x", s=30, color=GREY, zorder=3)
            taken, energy = _in_unit(
                [np.sum([columns[f"link/{name}/work"] for name in copies], axis=0)], "J"
            )
            energy_taken = f"; {taken[0][-1]:.3g} {energy} taken" if taken[0][-1] else ""
            over_time.set(xlim=(time[0], time[-1]), ylabel=f"{link}\ntension $T$ [{force}]")
            over_time.tick_params(labelbottom=over_time is grid[-1, 0])
            loops.set(xlabel=f"elongation $e$ [{length}]{energy_taken}", ylim=over_time.get_ylim())
            loops.tick_params(labelleft=False)
            if len(copies) > 1:
                legend_beside(loops)
        grid[-1, 0].set_xlabel("time [s]")
        figure.align_ylabels(grid[:, 0])
        return save(figure, path, formats)


def bond_figure(
    columns: Mapping[str, NDArray[Any]],
    path: Path | str,
    joints: list[str],
    formats: Sequence[str] = ("png", "pdf"),
) -> list[Path]:
    """Largest tension and shear of some glued joints over time, and below them the share of the
    area that has failed, a column of two for each.

    Parameters
    ----------
    path
        file name without suffix.
    """
    time = columns["time"]
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 3.4)
        grid = figure.subplots(2, len(joints), squeeze=False, sharex=True, height_ratios=[2, 1])
        names = ("stress", "shear_stress")
        lines = [columns[f"bond/{joint}/{name}"] for joint in joints for name in names]
        lines, unit = _in_unit(lines, "Pa")
        top = 1.06 * max(float(each.max()) for each in lines) or 1.0
        for joint, place, stresses, failed in zip(joints, range(len(joints)), *grid):
            own = lines[2 * place : 2 * place + 2]
            _drawn(stresses, [time] * 2, own, ["tension", "shear"])
            stresses.set(title=joint.partition(":")[0], ylim=(0, top))
            failed.plot(time, 100 * columns[f"bond/{joint}/failed"], color=LINES[0][0])
            failed.set(xlim=(time[0], time[-1]), ylim=(-4, 104), xlabel="time [s]")
            for axes in (stresses, failed):
                axes.tick_params(labelleft=place == 0)
        grid[0, 0].set_ylabel(f"largest stress [{unit}]")
        grid[1, 0].set_ylabel("failed [%]")
        legend_beside(grid[0, -1])
        figure.align_ylabels(grid[:, 0])
        return save(figure, path, formats)
