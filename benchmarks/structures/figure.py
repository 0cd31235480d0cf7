"""Finite elements beside the models, from the tables that the benchmark wrote."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)

# Height of a legend of two rows, over that of the lines [-]
_ROOM = 0.3


def read(file: Path) -> dict[str, np.ndarray]:
    """Columns of a table by name, numbers where they are."""
    with open(file, newline="") as text:
        rows = list(csv.DictReader(text))
    return {name: np.array([_value(row[name]) for row in rows]) for name in rows[0]}


def _value(text: str):
    try:
        return float(text)
    except ValueError:
        return text


def draw(folder: Path) -> list[Path]:
    """Force against displacement, ways of the slab, velocity kept at impacts, free rocking of
    podia; a panel of what is missing stays empty. Nothing of nothing.
    """
    if not any((folder / f"{name}.csv").exists() for name in PANELS):
        return []
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 0.75 * PAGE_WIDTH_IN)
        for axes, (name, panel) in zip(figure.subplots(2, 2).ravel(), PANELS.items()):
            if (folder / f"{name}.csv").exists():
                panel(axes, read(folder / f"{name}.csv"))
            else:
                axes.set_axis_off()
        return save(figure, folder / "structures")


def _forces(axes, table) -> None:
    for held, colour, dashes, words in (
        ("True", BLUE, "-", "with tendons"),
        ("False", VERMILION, "--", "without"),
    ):
        of = table["tendons"] == held
        axes.plot(
            table["slab_m"][of],
            table["virtual_work_n"][of] / 1e3,
            dashes,
            color=colour,
            label=f"virtual work, {words}",
        )
        axes.plot(
            table["slab_m"][of],
            table["elements_n"][of] / 1e3,
            "o",
            color=colour,
            markersize=4,
            markerfacecolor="none",
            label=f"finite elements, {words}",
        )
    axes.set(
        xlabel="displacement of the slab [m]",
        ylabel="restoring force [kN]",
        title="restrained frame, held still",
        xlim=(0, None),
        ylim=(0, None),
    )
    axes.legend()


def _planar(axes, table) -> None:
    axes.plot(
        table["time_s"],
        1e3 * table["model_x_m"],
        "--",
        color=BLACK,
        linewidth=0.8,
        label="wobbling model: no loss",
    )
    axes.plot(table["time_s"], 1e3 * table["x_m"], color=BLUE, label="finite elements")
    axes.set(
        xlabel="time [s]",
        ylabel="slab along x [mm]",
        title="restrained frame, let go in a plane",
        xlim=(0, table["time_s"][-1]),
    )
    _legend_below(axes, columns=1)


def _impacts(axes, table) -> None:
    for kind, colour, mark in (("rigid", BLUE, "o"), ("concrete", VERMILION, "s")):
        of = table["kind"] == kind
        axes.semilogx(
            table["period_s"][of],
            table["root_of_energy_kept"][of],
            mark,
            color=colour,
            markersize=4,
            markerfacecolor="none",
            label=f"{kind}: root of energy at the next top",
        )
        if kind == "rigid":
            axes.semilogx(
                table["period_s"][of],
                table["rate_kept"][of],
                "x",
                color=BLACK,
                markersize=4,
                label="rigid: velocity just after",
            )
    for name, dashes in (("crv", "-"), ("cav", "--")):
        axes.axhline(
            table[name][0], color=GREEN, linestyle=dashes, linewidth=0.8, label=name.upper()
        )
    axes.set(
        xlabel="period of the building on a fixed slab [s]",
        ylabel="after / before",
        title="podium with 3 storeys, one impact",
    )
    axes.legend()


def _podium(axes, table) -> None:
    for name, colour, dashes, words in (
        ("concrete", VERMILION, "-", "finite elements"),
        ("rigid", BLUE, "-", "rigid columns"),
        ("crv", BLACK, "--", "CRV"),
        ("cav", GREEN, ":", "CAV"),
    ):
        axes.plot(
            table["time_s"],
            table[f"{name}_rad"] / np.arctan(0.15),
            dashes,
            color=colour,
            label=words,
        )
    axes.set(
        xlabel="time [s]",
        ylabel=r"$\theta/\alpha$",
        title=r"podium with 3 storeys, let go at 0.9 $\alpha$",
        xlim=(0, 4),
    )
    _legend_below(axes, columns=2)


def _legend_below(axes, columns: int) -> None:
    """A legend of two rows below lines that leave it no room: the axis reaches lower."""
    low, high = axes.get_ylim()
    axes.set_ylim(low - _ROOM * (high - low), high)
    axes.legend(loc="lower center", ncol=columns)


PANELS = dict(forces=_forces, planar=_planar, impacts=_impacts, podium_3=_podium)
