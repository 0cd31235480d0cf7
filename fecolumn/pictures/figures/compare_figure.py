"""Two ensembles in one figure: their distributions, and motion against motion."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from fecolumn.pictures.figures.cdf_figure import axis_end
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREY,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)
from fecolumn.statistics.bands import dkw, dkw_distance
from fecolumn.statistics.ecdf import censored, ecdf
from fecolumn.statistics.records import Records

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from fecolumn.statistics.ecdf import Ecdf


_STRIP = 0.09  # beyond the axes' ends, where overturned runs are drawn; as a share of the axis


def compare_figure(
    a: tuple[NDArray[Any], NDArray[Any]],
    b: tuple[NDArray[Any], NDArray[Any]],
    labels: tuple[str, str],
    *,
    paired: bool,
    correlation: float | None,
    path: Path | str,
    slides: bool = False,
    records: tuple[Records, Records] = (None, None),
) -> list[Path]:
    """Write the figure as PNG and PDF.

    Left, both CDFs with the pointwise 95 % band of Greenwood of each (shaded) and the simultaneous
    one of b, the reference (dotted). Right, of the same motions in both, u_max of a over that of b;
    overturned runs lie in the strips beyond the axes' ends.

    Parameters
    ----------
    a, b
        u_max [m] and whether overturned or slid off, (n,) each; with the same motion at the same
        place where paired.
    labels
        of a and b.
    paired
        whether the right panel is drawn.
    correlation
        R, written into the right panel; None or nan writes none.
    path
        file name without suffix.
    slides
        whether some slid off their base, so that the figure says "lost" for "overturned".
    records
        of the runs of a and of b, None where each run has its own.
    """
    limit_mm = 1e3 * axis_end(peak for sample in (a, b) for peak in ecdf(*sample).x)
    with styled():
        figure = new_figure(PAGE_WIDTH_IN if paired else PAGE_WIDTH_IN / 2, 3.75)
        figure.get_layout_engine().set(w_pad=0.06)
        grid = figure.subplots(1, 2 if paired else 1, squeeze=False)[0]
        curves = (ecdf(*a, records=records[0]), ecdf(*b, records=records[1]))
        _distributions(grid[0], curves, labels, limit_mm, "lost" if slides else "overturned")
        if paired:
            _pairs(grid[1], censored(*a), censored(*b), labels, limit_mm, correlation, slides)
        return save(figure, path)


def _distributions(
    axes: Axes,
    curves: tuple[Ecdf, Ecdf],
    labels: tuple[str, str],
    limit_mm: float,
    word: str,
) -> None:
    for curve, label, colour, dashes in (
        (curves[1], labels[1], VERMILION, "--"),
        (curves[0], labels[0], BLUE, "-"),
    ):
        low, high = curve.lost_interval
        x = np.concatenate([[0.0], 1e3 * curve.x, [limit_mm]])
        axes.fill_between(
            x,
            _whole(curve.lower),
            _whole(curve.upper),
            step="post",
            color=colour,
            alpha=0.18,
            linewidth=0,
            zorder=1,
        )
        axes.step(
            x,
            _whole(curve.cdf),
            where="post",
            color=colour,
            linestyle=dashes,
            zorder=3,
            label=f"{label}: $n$ = {curve.n}, {word} {100 * curve.lost / curve.n:.1f} % "
            f"[{100 * low:.1f}, {100 * high:.1f}]",
        )
        if curve is curves[1] and curve.x.size:
            lower, upper = dkw(curve.cdf, curve.records)
            for edge, first, note in (
                (lower, 0.0, "simultaneous 95 % band of the reference"),
                (upper, dkw_distance(curve.records), None),
            ):
                axes.step(
                    x,
                    _whole(edge, first),
                    where="post",
                    color=colour,
                    linestyle=":",
                    linewidth=0.8,
                    zorder=2,
                    label=note,
                )
    axes.set(
        xlim=(0, limit_mm),
        ylim=(0, 1.02),
        xlabel=r"top displacement $u$ [mm]",
        ylabel=r"$P\,(u_{\max} \leq u)$",
    )
    *of_b, of_a = axes.get_legend_handles_labels()[0]
    shade = Patch(facecolor=GREY, alpha=0.4, linewidth=0, label="pointwise 95 % band")
    axes.legend(
        handles=[of_a, of_b[0], shade, *of_b[1:]],
        loc="upper center",
        bbox_to_anchor=(0.5, -0.17),
        framealpha=0,
        borderaxespad=0,
    )


def _whole(edge: NDArray[Any], first: float = 0.0) -> NDArray[Any]:
    """A step function from its `first` value at u = 0 on to the end of the axis."""
    return np.concatenate([[first], edge, edge[-1:] if edge.size else [first]])


def _pairs(
    axes: Axes,
    a: NDArray[Any],
    b: NDArray[Any],
    labels: tuple[str, str],
    limit_mm: float,
    correlation: float | None,
    slides: bool,
) -> None:
    end, fallen = limit_mm * (1 + _STRIP), limit_mm * (1 + _STRIP / 2)
    x, y = (
        np.where(np.isinf(u), fallen, np.minimum(1e3 * np.where(np.isinf(u), 0, u), limit_mm))
        for u in (b, a)
    )
    both, one = np.isinf(a) & np.isinf(b), np.isinf(a) ^ np.isinf(b)
    axes.axvspan(limit_mm, end, color="#F2F2F2", linewidth=0, zorder=0)
    axes.axhspan(limit_mm, end, color="#F2F2F2", linewidth=0, zorder=0)
    axes.plot([0, limit_mm], [0, limit_mm], color=GREY, linewidth=0.8, zorder=1)
    stood = ~both & ~one
    axes.plot(
        x[stood],
        y[stood],
        "o",
        color=BLUE,
        markersize=3.2,
        markeredgewidth=0,
        alpha=0.75,
        zorder=3,
        clip_on=False,
        label=f"stands in both: {stood.sum()}",
    )
    axes.plot(
        x[one],
        y[one],
        "D",
        color=VERMILION,
        markersize=3.4,
        markerfacecolor="none",
        markeredgewidth=0.8,
        zorder=3,
        label=f"{'lost' if slides else 'overturns'} in one: {one.sum()}",
    )
    axes.plot(
        x[both][:1],
        y[both][:1],
        "s",
        color=BLACK,
        markersize=4.5,
        zorder=3,
        label=f"{'lost' if slides else 'overturns'} in both: {both.sum()}",
    )
    ticks = [
        tick for tick in MaxNLocator(5).tick_values(0, limit_mm) if 0 <= tick < 0.97 * limit_mm
    ]
    if not (both | one).any():  # no strip for what is not there
        end = limit_mm
    marks = [*ticks, fallen] if (both | one).any() else ticks
    names = [f"{tick:g}" for tick in ticks] + (
        ["lost" if slides else "over-\nturned"] if len(marks) > len(ticks) else []
    )
    axes.set(
        xlim=(0, end),
        ylim=(0, end),
        aspect="equal",
        xlabel=rf"$u_{{\max}}$ [mm], {labels[1]}",
        ylabel=rf"$u_{{\max}}$ [mm], {labels[0]}",
    )
    axes.set_xticks(marks, names)
    axes.set_yticks(marks, names)
    axes.grid(False)
    if correlation is not None and np.isfinite(correlation):
        axes.text(
            0.04,
            0.86,
            f"$R$ = {correlation:.2f}".replace("-", "\N{MINUS SIGN}"),
            transform=axes.transAxes,
            verticalalignment="top",
        )
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), framealpha=0, borderaxespad=0)
