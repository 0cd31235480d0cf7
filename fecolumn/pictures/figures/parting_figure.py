"""Two analyses in one figure: their histories over one another, when they part, and their energies
side by side.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import LogLocator
from numpy.typing import NDArray

from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fecolumn.pictures.figures.drawn_parting import DrawnParting
    from fecolumn.pictures.figures.quantity import Quantity


# Terms of the ledger as a reader knows them
_TERMS = {
    "kinetic": "kinetic",
    "strain": "strain",
    "gravity": "gravity\npotential",
    "base_work": "work of\nthe base",
    "friction": "sliding\nfriction",
    "impact": "impacts",
    "contact": "contact",
    "algorithmic": "numerical\ndamping",
    "damping": "damping\nof modes",
    "rolling": "rolling\nresistance",
    "links": "links",
    "closure": "closure\nerror",
}
# Shares of the largest of its kind [-] below which a term has no bar, a component of the top no
# panel, and a difference is not told from rounding
_NIL, _STILL, _ROUNDING = 1e-3, 1e-2, 1e-10
# Points of a line: more are not told apart
_MOST_POINTS = 6000


def parting_figure(
    found: DrawnParting,
    quantities: Mapping[str, Quantity],
    symbols: Mapping[str, str],
    labels: tuple[str, str],
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
) -> list[Path]:
    """Write the figure.

    Left, the top's displacement, tilt and uplift of A and of B, and below them their differences
    over the larger peak with the tolerance; a dotted line where each quantity parts. Right, the
    terms of the energy ledger at the end of the time that both analysed.

    Parameters
    ----------
    quantities
        by name, of "energy", too.
    symbols
        of each, for mathtext.
    labels
        of A and of B.
    path
        file name without suffix.
    formats
        of the files.
    """
    panels = _panels(found, quantities, symbols)
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 1.15 * len(panels) + 2.0)
        figure.get_layout_engine().set(w_pad=0.06)
        grid = figure.add_gridspec(len(panels) + 1, 2, width_ratios=[2.5, 1])
        rows: list[Axes] = []
        every = max(1, len(found.time) // _MOST_POINTS)
        for k, (label, values, parted) in enumerate(panels):
            axes = figure.add_subplot(grid[k, 0], sharex=rows[0] if rows else None)
            for series, name, colour, dashes in zip(values, labels, (BLUE, VERMILION), ("-", "--")):
                axes.plot(
                    found.time[::every], series[::every], color=colour, linestyle=dashes, label=name
                )
            _mark(axes, found.time, parted)
            axes.set_ylabel(label)
            axes.tick_params(labelbottom=False)
            rows.append(axes)
        below = figure.add_subplot(grid[-1, 0], sharex=rows[0])
        _differences(below, found, symbols, every)
        rows[0].legend(loc="lower left", bbox_to_anchor=(0, 1.02), framealpha=0, borderaxespad=0)
        _energies(figure.add_subplot(grid[:, 1]), found, quantities["energy"])
        figure.align_ylabels([*rows, below])
        return save(figure, path, formats)


def _panels(
    found: DrawnParting, quantities: Mapping[str, Quantity], symbols: Mapping[str, str]
) -> list[tuple[str, tuple[NDArray[Any], NDArray[Any]], int | None]]:
    """(label, (values of A, of B) in its unit, row of the parting) of each panel: both components
    of the top, unless one hardly moves.
    """
    panels = []
    for name, pair in found.quantities.items():
        quantity = quantities[name]
        shown = [
            k
            for k in range(pair.a.shape[1])
            if max(np.abs(pair.a[:, k]).max(), np.abs(pair.b[:, k]).max()) > _STILL * pair.peak
        ] or [0]
        for k in shown:
            symbol = f"${symbols[name]}_{'xy'[k]}$" if pair.a.shape[1] > 1 else f"${symbols[name]}$"
            word = quantity.name.replace("top displacement", "top")
            panels.append(
                (
                    f"{word}\n{symbol} [{quantity.unit}]",
                    (pair.a[:, k] / quantity.scale, pair.b[:, k] / quantity.scale),
                    pair.parted,
                )
            )
    return panels


def _mark(axes: Axes, time: NDArray[Any], parted: int | None) -> None:
    if parted is not None:
        axes.axvline(time[parted], color=BLACK, linewidth=0.8, linestyle=":")


def _differences(axes: Axes, found: DrawnParting, symbols: Mapping[str, str], every: int) -> None:
    for (name, pair), colour, dashes in zip(
        found.quantities.items(), (BLACK, GREEN, VERMILION), ("-", "-.", ":")
    ):
        share = pair.difference / pair.peak if pair.peak else pair.difference
        # the largest of each stretch: a line through single rows would hide where they part
        rows = np.arange(0, len(share), every)
        largest = np.maximum.reduceat(share, rows)
        if largest.max() > _ROUNDING:
            axes.plot(
                found.time[rows],
                np.maximum(largest, _ROUNDING),
                color=colour,
                linestyle=dashes,
                linewidth=0.9,
                label=f"${symbols[name]}$",
            )
    axes.axhline(found.tolerance, color=GREY, linewidth=0.9, label=f"tolerance {found.tolerance:g}")
    if found.first:
        axes.axvline(
            found.first[1],
            color=BLACK,
            linewidth=0.8,
            linestyle=":",
            label=f"parted at {found.first[1]:.3f} s",
        )
    axes.set(
        yscale="log",
        ylim=(max(_ROUNDING, min(found.tolerance / 10, np.percentile(_positive(found), 2))), 3.0),
        xlabel="time [s]",
        ylabel="difference\nover peak [-]",
        xlim=(found.time[0], found.time[-1]),
    )
    axes.yaxis.set_major_locator(LogLocator(numticks=5))
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, -0.42),
        ncols=5,
        columnspacing=1.2,
        framealpha=0,
        borderaxespad=0,
    )


def _positive(found: DrawnParting) -> NDArray[Any]:
    shares = np.concatenate(
        [pair.difference / pair.peak for pair in found.quantities.values() if pair.peak]
        or [np.ones(1)]
    )
    return shares[shares > 0] if (shares > 0).any() else np.ones(1)


def _energies(axes: Axes, found: DrawnParting, quantity: Quantity) -> None:
    """Bars of the terms that are not nil, at the end of the common time."""
    ends = {
        name: max(abs(pair.a[-1, 0]), abs(pair.b[-1, 0])) for name, pair in found.energy.items()
    }
    names = [name for name, end in ends.items() if end > _NIL * max(ends.values())] or ["kinetic"]
    places = np.arange(len(names))[::-1]
    for shift, side, colour, hatch in ((0.2, "a", BLUE, ""), (-0.2, "b", VERMILION, "////")):
        values = [getattr(found.energy[name], side)[-1, 0] / quantity.scale for name in names]
        axes.barh(
            places + shift,
            values,
            0.36,
            facecolor=colour if not hatch else "white",
            edgecolor=colour,
            hatch=hatch,
            linewidth=0.8,
        )
    axes.axvline(0, color=BLACK, linewidth=0.6)
    axes.set_yticks(places, [_TERMS.get(name, name) for name in names])
    axes.set(xlabel=quantity.label, ylim=(-0.6, len(names) - 0.4))
    axes.set_title(f"ledger at {found.time[-1]:.4g} s", loc="left")
    axes.margins(x=0.12)
    axes.tick_params(axis="y", left=False, right=False, pad=2)
    axes.locator_params(axis="x", nbins=4)
    axes.grid(axis="y", visible=False)
