"""Peaks of the same motions in several settings, one against the other: a scatter matrix."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.post.style import BLUE, GREY, PAGE_WIDTH_IN, VERMILION, new_figure, save, styled
from fecolumn.statistics.correlation import correlation

_STRIP = 1.14  # the overturned lie beyond the limit, in a strip of their own


@dataclass(frozen=True, slots=True)
class Variable:
    """One setting: its name, and the peak [m] and end of each of the same motions."""

    name: str
    u_max_m: np.ndarray
    overturned: np.ndarray


def scatter_matrix(variables: list[Variable], limit_m: float, path, formats=("png", "pdf")) -> list[Path]:
    """Write the figure: scatter below the diagonal, correlation and flips above it, the share that overturned on it.

    An overturned run is drawn in the shaded strip beyond the limit; a motion that overturned in one of the two settings
    alone, a flip, is an open red circle. R takes overturned runs and larger displacements at the limit.

    Args:
        variables: two to six settings, the same motions in the same order in each.
        limit_m: overturn displacement [m].
        path: file name without suffix.
        formats: of the files.
    """
    count, limit = len(variables), 1e3 * limit_m
    with styled():
        cell = min(PAGE_WIDTH_IN / count, 1.9)
        figure = new_figure(max(cell * count, 4.0), cell * count + 0.15)
        figure.get_layout_engine().set(w_pad=0.02, h_pad=0.02, wspace=0, hspace=0)
        grid = figure.subplots(count, count, squeeze=False)
        for row, column in np.ndindex(count, count):
            axes, a, b = grid[row, column], variables[column], variables[row]
            axes.set(xlim=(0, _STRIP * limit), ylim=(0, _STRIP * limit), aspect="equal")
            axes.tick_params(labelleft=column == 0 and row > 0, labelbottom=row == count - 1 and column < count - 1)
            ticks = [0, 0.4 * limit, 0.8 * limit]
            axes.set_xticks(ticks), axes.set_yticks(ticks)
            if row > column:
                _scatter(axes, a, b, limit)
            else:
                axes.grid(False)
                axes.tick_params(bottom=False, left=False, top=False, right=False, labelleft=False, labelbottom=False)
                for spine in axes.spines.values():
                    spine.set(color="#CCCCCC")
                _name(axes, a, count) if row == column else _measures(axes, a, b, limit_m)
        figure.supxlabel(r"$u_{\max}$ [mm]", fontsize=9)
        figure.supylabel(r"$u_{\max}$ [mm]", fontsize=9)
        return save(figure, path, formats)


def _scatter(axes, a: Variable, b: Variable, limit: float) -> None:
    middle = (1 + _STRIP) / 2 * limit
    # where many overturn in both, points of one place would hide each other: spread along the strip, always the same way
    shift = 0.045 * limit * np.sin(2.4 * np.arange(a.u_max_m.size))
    x, y = (np.where(one.overturned, middle + sign * shift, np.minimum(1e3 * one.u_max_m, limit)) for one, sign in ((a, 1), (b, -1)))
    axes.axvspan(limit, _STRIP * limit, color="#EEEEEE", zorder=0)
    axes.axhspan(limit, _STRIP * limit, color="#EEEEEE", zorder=0)
    axes.plot([0, limit], [0, limit], color=GREY, linewidth=0.6, zorder=1)
    flip = a.overturned ^ b.overturned
    axes.scatter(x[~flip], y[~flip], s=7, color=BLUE, alpha=0.65, linewidths=0, zorder=2)
    axes.scatter(x[flip], y[flip], s=10, facecolors="none", edgecolors=VERMILION, linewidths=0.7, zorder=3)


def _name(axes, a: Variable, count: int) -> None:
    size = 8.5 if count < 5 else 7.5
    axes.text(0.5, 0.56, a.name.replace(", ", "\n"), transform=axes.transAxes, ha="center", va="center", fontsize=size + 1)
    axes.text(0.5, 0.2, f"{int(a.overturned.sum())} of {a.overturned.size}\noverturned", transform=axes.transAxes, ha="center", va="center",
              fontsize=size - 1)


def _measures(axes, a: Variable, b: Variable, limit_m: float) -> None:
    r = correlation(a.u_max_m, a.overturned, b.u_max_m, b.overturned, limit_m)
    flips = int((a.overturned ^ b.overturned).sum())
    text = rf"$R$ = {r:.2f}".replace("-", "\N{MINUS SIGN}") if np.isfinite(r) else "$R$ undefined"
    axes.text(0.5, 0.58, text, transform=axes.transAxes, ha="center", va="center", fontsize=9)
    axes.text(0.5, 0.36, f"{flips} flip{'' if flips == 1 else 's'}", transform=axes.transAxes, ha="center", va="center", fontsize=8,
              color=VERMILION if flips else GREY)
