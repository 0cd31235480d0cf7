"""How the contact points of a round rim roll in a step, for the manual's algorithm."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.contact.interface import interface_of, rims_at_rest
from fecolumn.contact.points import CONTACT, node_points
from fecolumn.contact.rim import Rim, on_circle
from fecolumn.contact.rolling import REACH, plan_roll, roll_points
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation._compiled import interpreted
from fecolumn.pictures.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)


def rolling(target: Path) -> None:
    """How the contact points of a round rim roll in a step: their carriers, their heights and
    lifts, and a leap; all of it from `contact.rolling`.
    """
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 5.9)
        axes = figure.subplots(2, 2)
        _draw_carriers(axes[0, 0])
        _draw_heights(axes[0, 1], axes[1, 0])
        _draw_leap(axes[1, 1])
        save(figure, target.with_suffix(""), formats=("png",))


def _ring(n: int) -> np.ndarray:
    """Nodes (n, 3) of a rim of radius 1, the first at angle 0."""
    angles = 2 * np.pi * np.arange(n) / n
    return np.column_stack([np.cos(angles), np.sin(angles), np.zeros(n)])


def _plan(axes, title: str, n: int = 0) -> None:
    """Plan view of the rim: its circle and the polygon of its nodes, where there are some."""
    circle = _ring(360)
    axes.plot(*circle[np.r_[:360, 0], :2].T, color=GREY, linewidth=0.8)
    if n:
        axes.plot(
            *_ring(n)[np.r_[:n, 0], :2].T,
            color=BLACK,
            linewidth=0.6,
            marker="s",
            markersize=4,
            markerfacecolor="white",
            label="nodes of the mesh",
        )
    axes.set_title(title, loc="left")
    axes.set(xlim=(-1.75, 1.75), ylim=(-1.3, 1.3), aspect="equal")
    axes.axis("off")


def _draw_carriers(axes) -> None:
    n, angle = 12, 0.42 * 2 * np.pi / 12
    offsets, weights, nodes = np.empty(4, np.int64), np.empty(4), _ring(n)
    index, _ = interpreted(on_circle)(angle, 0.0, 2 * np.pi / n, n, offsets, weights)
    _plan(axes, "(a) a point of the circle and the nodes that carry it", n)
    point, names = weights @ nodes[(index + offsets) % n], ("near", "beside", "far", "far")
    for name, node, weight in zip(names, nodes[(index + offsets) % n], weights):
        axes.plot(*zip(point[:2], node[:2]), color=BLUE, linewidth=0.6, linestyle=":")
        axes.annotate(
            f"{name}\n{weight:.3f}", 1.28 * node[:2], ha="center", va="center", fontsize=7.5
        )
    axes.plot(*point[:2], color=BLUE, marker="o", linestyle="none", markersize=5, label="point")
    axes.legend(loc="center", bbox_to_anchor=(0.5, 0.71), framealpha=0)


def _draw_heights(axes, below) -> None:
    """Heights before and after a step of steady rolling, and what becomes of them; the unit is the
    height of a point one sector from the lowest.
    """
    n, tilt, step, start = 48, 0.02, 0.9, 6.0
    nodes, sector, places = _ring(n), 2 * np.pi / n, np.arange(-REACH, REACH + 1)
    unit = np.sin(tilt) * (1 - np.cos(sector))

    def turned(past):
        """Rotation whose lowest point is so many sectors past the start's."""
        lean = (start + past) * sector
        return rotation_matrix(tilt * np.array([-np.sin(lean), np.cos(lean), 0.0]))

    def heights(past, points):
        return ((nodes @ turned(past).T)[points["carriers"], 2] * points["weights"]).sum(
            axis=1
        ) + np.sin(tilt)

    rim, points, contact, rims = (
        Rim.find(nodes),
        node_points(nodes, 0.5),
        np.zeros(n, CONTACT),
        rims_at_rest(),
    )
    ring = np.asarray(rim.nodes)
    (
        contact["located"],
        contact["force"][ring[(int(start) - int(np.rint(rim.first / sector))) % n], 2],
    ) = True, 1.0
    rims["angle"] = (start - step / 2) * sector
    rims["lift"][0, REACH] = -np.sin(tilt) * (1 - np.cos(step / 2 * sector))
    interface, before = interface_of(nodes, rim)[0], contact.copy()
    rolls, _, roll = interpreted(plan_roll)(
        interface, ring, rims[0], contact, turned(0), turned(step / 2), True
    )
    assert rolls and not roll.leaps
    interpreted(roll_points)(
        roll,
        ring,
        rims[0],
        nodes,
        nodes @ turned(0).T + [0, 0, np.sin(tilt)],
        contact,
        points,
        before,
    )
    near = ring[(roll.index[2] + places) % n]
    first, last, lift = (
        heights(0, points)[near] / unit,
        heights(step, points)[near] / unit,
        points["lift"][near] / unit,
    )

    x, at = np.linspace(-2.4, 3.2, 200), places + step / 2
    for centre, style, colour, label in (
        (0, "-", GREY, "circle at the start"),
        (step, "--", GREY, "circle at the end"),
        (step / 2, ":", VERMILION, "gaps carried through the step"),
    ):
        axes.plot(x, (x - centre) ** 2, linestyle=style, color=colour, linewidth=0.9, label=label)
    axes.plot(
        places - step / 2,
        (places - step / 2.0) ** 2,
        marker="o",
        markerfacecolor="white",
        color=ORANGE,
        linestyle="none",
        markersize=5,
        label="old points",
    )
    axes.plot(
        places,
        places**2.0,
        marker="x",
        color=BLACK,
        linestyle="none",
        markersize=5,
        label="like points",
    )
    axes.plot(at, first, marker="o", color=BLUE, linestyle="none", markersize=4, label="new points")
    axes.plot(at, last + lift, marker="_", color=VERMILION, linestyle="none", markersize=9)
    for where, low, up in zip(at, last, lift):
        axes.annotate(
            "",
            (where, low + up),
            (where, low),
            arrowprops=dict(arrowstyle="-|>", color=GREEN, shrinkA=0, shrinkB=0, mutation_scale=7),
        )
    axes.set_title("(b) heights in a step of 0.9 sectors; arrows: lift", loc="left")
    axes.set(
        xlabel="place along the rim [sectors past the start's lowest point]",
        ylabel="height [of a point one sector away]",
        xlim=(-2.6, 3.3),
        ylim=(-0.5, 9.4),
    )
    axes.legend(loc="upper center", ncols=2)

    below.bar(
        places - 0.2, last - first, 0.36, color=BLUE, label="way down (< 0) or up in the step"
    )
    below.bar(places + 0.2, lift, 0.36, color=GREEN, label="lift $h$")
    below.axhline(0, color=BLACK, linewidth=0.6)
    below.set_title("(c) before and behind the lowest point the work is opposite", loc="left")
    below.set(
        xlabel="place $o$ from the lowest point halfway [sectors]",
        ylabel="height [of a point one sector away]",
        xticks=places,
        ylim=(-4.2, 6.4),
    )
    below.legend(loc="upper right")


def _draw_leap(axes) -> None:
    n, first, last = 24, np.radians(197.0), np.radians(-8.0)
    _plan(axes, "(d) a leap: the column rocks over")
    spread = 2 * np.pi / n * np.arange(-REACH, REACH + 1)
    for angle, colour, label in (
        (first, ORANGE, "old points: they stay while they alone carry"),
        (last, BLUE, "new points: once none carries, or one here does"),
    ):
        axes.plot(
            np.cos(angle + spread),
            np.sin(angle + spread),
            marker="o",
            linestyle="none",
            color=colour,
            markersize=4.5,
            label=label,
        )
    way = np.linspace(first, last + 2 * np.pi, 60)
    axes.plot(0.72 * np.cos(way), 0.72 * np.sin(way), color=BLACK, linewidth=0.8)
    axes.annotate(
        "",
        0.72 * np.array([np.cos(way[-1]), np.sin(way[-1])]),
        0.72 * np.array([np.cos(way[-3]), np.sin(way[-3])]),
        arrowprops=dict(arrowstyle="-|>", color=BLACK, shrinkA=0, shrinkB=0),
    )
    axes.text(
        0,
        0.0,
        "lowest point:\nmore than 0.8 rad\nin a step",
        ha="center",
        va="center",
        fontsize=7.5,
    )
    axes.legend(loc="center", bbox_to_anchor=(0.5, 0.90), framealpha=0)
    axes.set_ylim(-1.15, 1.85)
