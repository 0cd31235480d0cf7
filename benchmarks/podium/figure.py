"""Distributions of tilt and base shear of all buildings under both laws, with the 95 % band of CRV."""

from __future__ import annotations

import numpy as np

from benchmarks.podium.ensemble import STOREYS
from fecolumn.post.style import BLUE, PAGE_WIDTH_IN, VERMILION, new_figure, save, styled
from fecolumn.rocking.podium_impact import CAV, CRV
from fecolumn.rocking.storeys import PROFILES
from fecolumn.statistics.bands import greenwood


def draw(found, path, name: str, label: str, limit: float):
    """One figure of a response, `name` tilt or shear; motions that overturn under a law lie beyond the axis, of the shear they are left out."""
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 0.8 * PAGE_WIDTH_IN)
        grid = figure.subplots(len(PROFILES), len(STOREYS), sharex=True, sharey=True)
        for row, profile in zip(grid, PROFILES):
            for axes, n in zip(row, STOREYS):
                if (profile, n, CRV) not in found:
                    axes.set_axis_off()
                    continue
                stood = np.isfinite(found[profile, n, CRV]["tilt"]) & np.isfinite(found[profile, n, CAV]["tilt"])
                for law, colour, dashes in ((CRV, BLUE, "-"), (CAV, VERMILION, "--")):
                    values = found[profile, n, law][name]
                    values = np.sort(values[stood] if name == "shear" else values)
                    x = np.concatenate([[0.0], values[values <= limit], [limit]])
                    cdf = np.searchsorted(values, x, side="right") / len(values)
                    if law == CRV:
                        axes.fill_between(x, *greenwood(cdf, len(values), 0.95), step="post", color=colour, alpha=0.2, linewidth=0, label="95 % band of CRV")
                    axes.step(x, cdf, where="post", color=colour, linestyle=dashes, label=law)
                axes.set(xlim=(0, limit), ylim=(0, 1.02), title=f"{profile}, {n} storeys")
        for axes in grid[:, 0]:
            axes.set_ylabel("share of motions up to")
        for axes in grid[-1]:
            axes.set_xlabel(label)
        grid[0, 0].legend(loc="lower right")
        return save(figure, path)
