"""Distributions of a podium's response under both laws of impact, a panel a building, with the 95 %
band of CRV.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.model_sections import CAV, CRV
from fecolumn.pictures.figures.style import BLUE, PAGE_WIDTH_IN, VERMILION, new_figure, save, styled
from fecolumn.statistics.bands import greenwood

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_NARROW_IN = 5.0  # below this width panels stand one below the other


def podium_figure(
    found: Mapping[tuple[str, int, str], Mapping[str, NDArray[Any]]],
    name: str,
    label: str,
    limits: tuple[float, float],
    path: Path | str,
    formats: Sequence[str] = ("png", "pdf"),
    width_in: float = PAGE_WIDTH_IN,
) -> list[Path]:
    """One figure of a response.

    Parameters
    ----------
    found
        (motions,) of "tilt" over alpha and "shear" over V_st by (profile, storeys, law). Motions
        that overturn under a law lie beyond the axis, of the shear they are left out.
    name
        tilt or shear.
    label
        of the axis.
    limits
        its ends.
    path
        without suffix.
    """
    rows, columns = (
        list(dict.fromkeys(profile for profile, _, _ in found)),
        sorted({n for _, n, _ in found}),
    )
    grid = [[(profile, n) for n in columns] for profile in rows]
    if width_in < _NARROW_IN:
        grid = [[panel] for line in grid for panel in line]
    with styled():
        figure = new_figure(
            width_in, len(grid) * (0.8 * PAGE_WIDTH_IN / 3 if len(grid[0]) > 1 else 0.55 * width_in)
        )
        for line, panels in zip(
            grid, figure.subplots(len(grid), len(grid[0]), sharex=True, sharey=True, squeeze=False)
        ):
            for (profile, n), axes in zip(line, panels):
                if (profile, n, CRV) not in found:
                    axes.set_axis_off()
                    continue
                _panel(axes, found[profile, n, CRV], found[profile, n, CAV], name, limits)
                axes.set(xlim=limits, ylim=(0, 1.02), title=f"{profile}, {n} storeys")
        for axes in figure.axes:
            axes.label_outer()
        for axes in figure.axes[:: len(grid[0])]:
            axes.set_ylabel("share of motions up to")
        for axes in figure.axes[-len(grid[0]) :]:
            axes.set_xlabel(label)
        figure.axes[0].legend(loc="best")
        return save(figure, path, formats)


def _panel(
    axes: Axes,
    crv: Mapping[str, NDArray[Any]],
    cav: Mapping[str, NDArray[Any]],
    name: str,
    limits: tuple[float, float],
) -> None:
    stood = np.isfinite(crv["tilt"]) & np.isfinite(cav["tilt"])
    for law, one, colour, dashes in ((CRV, crv, BLUE, "-"), (CAV, cav, VERMILION, "--")):
        values = np.sort(one[name][stood] if name == "shear" else one[name])
        x = np.concatenate(
            [limits[:1], values[(values > limits[0]) & (values <= limits[1])], limits[1:]]
        )
        cdf = np.searchsorted(values, x, side="right") / max(len(values), 1)
        if law == CRV:
            axes.fill_between(
                x,
                *greenwood(cdf, len(values), 0.95),
                step="post",
                color=colour,
                alpha=0.2,
                linewidth=0,
                label="95 % band of CRV",
            )
        axes.step(x, cdf, where="post", color=colour, linestyle=dashes, label=law)
