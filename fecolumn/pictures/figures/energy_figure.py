"""The energy ledger of one analysis against time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PAGE_WIDTH_IN,
    PURPLE,
    SKY,
    VERMILION,
    legend_beside,
    new_figure,
    save,
    styled,
)

if TYPE_CHECKING:
    from fecolumn.pictures.figures.history_curves import HistoryCurves


# Terms of the ledger as a reader knows them, with colour and dash, panel by panel. A strain of 1e-5
# stores thousandths of what moves.
_MOVED = {
    "kinetic": ("kinetic", VERMILION, "-"),
    "gravity": ("gravity potential", BLUE, "-"),
    "base_work": ("work of the base", BLACK, "-"),
}
_STRAIN = {"strain": ("strain", ORANGE, "-")}
_LOST = {
    "friction": ("sliding friction", GREEN, "-"),
    "impact": ("impacts", PURPLE, "-"),
    "algorithmic": ("numerical damping (HHT)", SKY, "-."),
    "contact": ("contact between impacts", ORANGE, "--"),
    "damping": ("damping: modes, pads", BLUE, ":"),
    "rolling": ("rolling resistance", VERMILION, ":"),
    "links": ("links and bonds", BLACK, "-."),
}
_CLOSURE = {"closure": ("closure error", BLACK, "-")}
_NIL = 1e-6  # share of the largest term of a panel below which a term is left out


def energy_figure(
    history: HistoryCurves, path: Path | str, formats: Sequence[str] = ("png", "pdf")
) -> list[Path]:
    """Energy stored and put in, strain energy, what each loss has taken so far, and the closure
    error; terms that stay nil are left out.

    Numerical damping and contact between impacts may give energy back; friction and impacts only
    take it.

    Parameters
    ----------
    history
        of `history_curves`.
    path
        file name without suffix.
    formats
        of the files.
    """
    energy = history.energy
    panels = [
        ("energy\n[J]", _MOVED, 1, 3),
        ("strain\n[J]", _STRAIN, 1, 1.2),
        ("taken so far by\n[J]", _LOST, -1, 2.2),
        ("closure\n[J]", _CLOSURE, 1, 1),
    ]
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 5.4)
        grid = figure.subplots(
            len(panels),
            1,
            sharex=True,
            gridspec_kw={"height_ratios": [height for *_, height in panels]},
        )
        for axes, (label, terms, sign, _) in zip(grid, panels):
            # earlier versions wrote fewer
            terms = {term: look for term, look in terms.items() if term in energy}
            largest = max(float(np.abs(energy[term]).max()) for term in terms)
            for term, (name, colour, dashes) in terms.items():
                if np.abs(energy[term]).max() > _NIL * largest:
                    axes.plot(
                        history.time,
                        sign * energy[term],
                        color=colour,
                        linestyle=dashes,
                        label=name,
                        linewidth=1.1 if len(terms) > 1 else 0.8,
                    )
            axes.set_ylabel(label)
            axes.ticklabel_format(axis="y", scilimits=(-2, 3), useMathText=True)
            if len(terms) > 1 and largest:
                legend_beside(axes)
        grid[-1].set(xlabel="time [s]", xlim=(history.time[0], history.time[-1]))
        figure.align_ylabels()
        return save(figure, path, formats)
