"""Figure of `benchmarks.impact`."""

from __future__ import annotations

import numpy as np

from benchmarks.impact.formula import STIFF, fit, stiff_cells
from benchmarks.impact.measured import MEASURED
from benchmarks.impact.sections import SHAPES
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PAGE_WIDTH_IN,
    SKY,
    VERMILION,
    new_figure,
    save,
    styled,
)

ENGINES = {
    "full": ("full order, bricks of 5 mm", BLACK, "s"),
    "bricks-2.5": ("full order, 2.5 mm", ORANGE, "D"),
    "reduced": ("reduced, 100 modes", BLUE, "o"),
    "modes-300": ("reduced, 300 modes", SKY, "d"),
    "modes-30": ("reduced, 30 modes", GREEN, "v"),
    "rigid": ("rigid body, elastic foot", VERMILION, "^"),
}
TILTS = {
    "share-0.05": ("0.05", VERMILION, "^"),
    "share-0.1": ("0.1", ORANGE, "v"),
    "reduced": ("0.3", BLUE, "o"),
    "share-0.6": ("0.6", GREEN, "s"),
}


def draw(rows, path) -> None:
    """Loss of rocking over Housner's against the time step: by engine, and by the tilt of
    release.
    """
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 2.6)
        left, right = figure.subplots(1, 2)
        for axes, series in ((left, ENGINES), (right, TILTS)):
            for name, (label, colour, marker) in series.items():
                found = [
                    (float(row["dt"]), float(row["rocking"]))
                    for row in rows
                    if row["series"] == name
                ]
                if not found:
                    continue
                steps = np.array(sorted({dt for dt, _ in found}))
                values = [np.array([loss for dt, loss in found if dt == step]) for step in steps]
                middle = np.array([value.mean() for value in values])
                apart = np.array(
                    [[value.mean() - value.min(), value.max() - value.mean()] for value in values]
                ).T
                axes.errorbar(
                    steps,
                    middle,
                    apart,
                    color=colour,
                    marker=marker,
                    markersize=3,
                    capsize=2,
                    label=label,
                )
            axes.axhline(1.0, color=GREY, linewidth=0.8, label="rigid (Housner 1963)")
            axes.set(
                xscale="log",
                xlabel="time step at the impact [s]",
                ylim=(0, 1.45 * axes.get_ylim()[1]),
            )
            axes.tick_params(which="minor", top=False)
            axes.set(ylabel="rocking energy lost / Housner's [-]")
        left.set_title("(a) released from 0.3 of the critical tilt")
        right.set_title("(b) reduced, 100 modes")
        left.legend(loc="upper left", ncol=2, title="bars: least and most of the releases")
        right.legend(loc="upper left", ncol=2, title="release tilt over critical tilt")
        save(figure, path)


def draw_map(cells, path):
    """Loss over Housner's of the cells with friction enough to stick over E B / (rho g H^2), a
    panel a section, with the formula of stiff bodies where there are cells enough; and what others
    measured, over H/B. PNG and PDF.
    """
    colours = (BLACK, BLUE, GREEN, ORANGE, VERMILION)
    try:
        formula = fit(cells)
    except ValueError:
        formula = None
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 5.0)
        shapes = [shape for shape in SHAPES if any(one["shape"] == shape for one in cells)]
        panels = figure.subplots(2, 2).ravel()
        friction = max(one["friction"] for one in cells)
        for letter, axes, shape in zip("abc", panels, shapes):
            own = [one for one in cells if (one["shape"], one["friction"]) == (shape, friction)]
            ratios = sorted({one["ratio"] for one in own})
            for place, (ratio, colour) in enumerate(zip(ratios, colours)):
                row = [one for one in own if one["ratio"] == ratio and one["releases"]]
                group = np.array([one["group"] for one in row])
                axes.errorbar(
                    group * 1.15 ** (place - len(ratios) // 2),  # beside one another
                    [one["loss"] for one in row],
                    [one["half_width"] for one in row],
                    fmt="o",
                    color=colour,
                    markersize=3,
                    capsize=2,
                    label=f"$H/B$ = {ratio:g}",
                )
                if formula and shape in formula.base:
                    lost = formula.loss(shape, ratio)
                    axes.plot([STIFF, group.max()], [lost, lost], color=colour, linewidth=0.8)
            axes.axhline(1.0, color=GREY, linewidth=0.8)
            axes.set(
                xscale="log",
                title=f"({letter}) {shape}, friction {friction:g}",
                ylim=(-0.5, 3.0),
                xlabel=r"$EB/(\rho g H^2)$ [-]",
            )
        panels[0].legend(ncol=2)
        _draw_measured(panels[-1], stiff_cells(cells))
        for axes in panels:
            axes.set_ylabel("energy lost / Housner's [-]")
        for axes in panels[len(shapes) : -1]:
            axes.set_axis_off()
        return save(figure, path)


def _draw_measured(axes, stiff) -> None:
    """Losses that others measured, as ranges, with those of the stiff cells, all over H/B."""
    axes.plot(
        [one["ratio"] for one in stiff],
        [one["loss"] for one in stiff],
        linestyle="none",
        marker=".",
        markersize=3,
        color=GREY,
        label=rf"computed, $EB/(\rho g H^2) \geq 10^{{{np.log10(STIFF):.0f}}}$",
    )
    sources = list(dict.fromkeys(one.source.split(",")[0] for one in MEASURED))
    for source, colour, marker in zip(sources, (BLUE, GREEN, VERMILION), "os^"):
        tests = [one for one in MEASURED if one.source.startswith(source)]
        low, high = np.array([one.losses for one in tests]).T
        middle = np.sqrt(low * high)  # of the logarithms
        axes.errorbar(
            [one.ratio for one in tests],
            middle,
            [middle - low, high - middle],
            fmt=marker,
            color=colour,
            markersize=3,
            capsize=2,
            label=source,
        )
    axes.axhline(1.0, color=GREY, linewidth=0.8)
    axes.set(yscale="log", ylim=(0.1, 60), xlabel="$H/B$ [-]", title="(d) measured, rectangular")
    axes.legend()
