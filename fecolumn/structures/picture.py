"""Picture of a structure: its bodies in colours with their names, its interfaces and links."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.foundation.atomic import write_bytes
from fecolumn.mesh.picture import projection_axes, rendered
from fecolumn.structures.model import GROUND

_COLOURS = ("#c67b5c", "#9fb2c1", "#d8c08a", "#7f9a75", "#b58fa8", "#8c8fb5", "#c9a27e", "#86aeb0")
_GROUND, _EDGE, _LINK, _JOINT = "#dcded9", "#2f3437", "#1f4e79", "#a02020"
_WIDTH_MM, _HEIGHT_MM, _LABELS_MM, _DPI = 120.0, 120.0, 62.0, 200
# Over the structure's width: margin of the ground around it, and half of the middle part, from
# which a label may go to either side
_MARGIN, _MIDDLE = 0.15, 0.1
# Height of a line of labels
_LINE_MM = 3.6
# Where on a link its name points, from its first end [-]
_ON_LINK = 0.3


def structure_picture(scene, structure, path) -> Path:
    """PNG of a structure at its start, in parallel projection; the bodies' names, and those of
    interfaces and links, stand beside it.

    Parameters
    ----------
    scene
        upright.
    structure
        StructureModel at its start.
    """
    import io

    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    right, up, toward = projection_axes()
    solids = [_solid(piece, part) for piece, part in zip(scene.bodies, structure.parts)]
    low, high = _ground(solids)
    points = np.concatenate(
        [
            *(points for points, _ in solids),
            np.array([[x, y, 0.0] for x in (low[0], high[0]) for y in (low[1], high[1])]),
        ]
    )
    plan, rise = points @ right, points @ up
    centre = np.array([(plan.min() + plan.max()) / 2, (rise.min() + rise.max()) / 2])
    half = np.array([np.ptp(plan), np.ptp(rise)]) / 2 * 1.03
    millimetres = half * min(_WIDTH_MM / half[0], _HEIGHT_MM / half[1])
    size = np.array([millimetres[0] + 2 * _LABELS_MM, max(millimetres[1], 60.0)])
    figure = Figure(figsize=size / 25.4, dpi=_DPI, facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.add_axes(
        [_LABELS_MM / size[0], 0.0, millimetres[0] / size[0], millimetres[1] / size[1]]
    )
    axes.set(
        xlim=centre[0] + half[0] * np.array([-1, 1]), ylim=centre[1] + half[1] * np.array([-1, 1])
    )
    axes.set_axis_off()
    names = list(dict.fromkeys(piece.kind for piece in scene.bodies))
    colours = [_COLOURS[names.index(piece.kind) % len(_COLOURS)] for piece in scene.bodies]
    image = _rendered(
        solids,
        colours,
        structure,
        (right, up, toward),
        right * centre[0] + up * centre[1],
        half[1],
        millimetres,
    )
    axes.imshow(
        image,
        extent=(
            *(centre[0] + half[0] * np.array([-1, 1])),
            *(centre[1] + half[1] * np.array([-1, 1])),
        ),
        interpolation="antialiased",
        aspect="auto",
    )
    labels, numbers = _fitted(
        _labels(structure, right, centre[0], half[0]), int(millimetres[1] / _LINE_MM) - 1
    )
    for number, point in numbers:
        axes.text(
            point @ right,
            point @ up,
            number,
            fontsize=5.5,
            ha="center",
            va="center",
            zorder=5,
            bbox=dict(facecolor="white", edgecolor="none", pad=0.6, alpha=0.75),
        )
    for side in ("left", "right"):
        _write(
            axes,
            [label for label in labels if label[3] == side],
            (right, up),
            centre,
            half,
            millimetres,
            side,
        )
    content = io.BytesIO()
    figure.savefig(content, format="png")
    write_bytes(Path(path), content.getvalue())
    return Path(path)


def _ground(solids) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest corner (2,) [m] of the piece of ground that is drawn."""
    points = np.concatenate([points for points, _ in solids])[:, :2]
    low, high = points.min(axis=0), points.max(axis=0)
    margin = _MARGIN * (high - low).max()
    return low - margin, high + margin


def _solid(piece, part) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) [m] of a part where it is, and its outer faces."""
    return (piece.points - part.model.center) @ part.rotation.T + part.center, piece.faces


def link_ends(link, parts) -> np.ndarray:
    """Both ends (2, 3) [m] of a link where its parts are."""

    def at(place, arm):
        return arm if place == GROUND else parts[place].center + parts[place].rotation @ arm

    return np.array([at(link.a, link.arm_a), at(link.b, link.arm_b)])


def _labels(structure, along: np.ndarray, middle: float, width: float) -> list:
    """(text, point (3,), colour, side) of every body, link and interface; the side is that to which
    it is nearer, so that no line crosses the structure.

    What stands one above the other in the middle has bodies and links to the left, interfaces to
    the right. along: (3,) direction to the right.
    """

    def side(point, otherwise):
        return (
            otherwise
            if abs(point @ along - middle) < _MIDDLE * width
            else "left"
            if point @ along < middle
            else "right"
        )

    labels = [
        (part.name, part.center, _EDGE, side(part.center, "left")) for part in structure.parts
    ]
    for link in structure.links:
        a, b = link_ends(link, structure.parts)
        named = a + _ON_LINK * (b - a)  # off the middle of the column in which it may run
        labels.append((link.name, named, _LINK, side(named, "left")))
    return labels + [
        (joint.name, point, _JOINT, side(point, "right"))
        for joint in structure.joints
        if joint.pair < 0  # the other side of a joint is where this is
        for point in [_meeting_point(structure, joint)]
    ]


def _fitted(labels: list, most: int) -> tuple[list, list]:
    """Labels, and numbers (text, point) to stand on bodies: where there are more than `most` labels
    on a side, one is for all bodies or interfaces of a name, with their count.
    """
    sides = [side for _, _, _, side in labels]
    if max(sides.count("left"), sides.count("right")) <= most:
        return labels, []
    named: dict[tuple, list] = {}
    numbers = []
    for text, point, colour, side in labels:
        name, _, number = text.rpartition(" ")
        if colour == _EDGE and number.isdigit():
            numbers.append((number, point))
            text = name
        elif colour == _JOINT:
            text = text.partition(":")[0]
        named.setdefault((text, colour), []).append((point, side))
    return [
        (f"{text} ({len(own)})" if len(own) > 1 else text, own[0][0], colour, own[0][1])
        for (text, colour), own in named.items()
    ], numbers


def _meeting_point(structure, joint) -> np.ndarray:
    """Middle (3,) [m] of a joint's slave surface."""
    part = structure.parts[joint.slave]
    surface = part.model.surfaces[joint.slave_surface]
    middle = part.model.arms[surface.nodes].mean(axis=0)
    return part.center + part.rotation @ (
        middle + (joint.ball.radius * surface.normal if joint.ball else 0.0)
    )


def _write(axes, labels, view_axes, centre, half, millimetres, side) -> None:
    """Labels one below the other beside the picture, each with a line to what it names."""
    if not labels:
        return
    right, up = view_axes
    where = np.array([[point @ right, point @ up] for _, point, _, _ in labels])
    order = np.argsort(-where[:, 1])
    line = _LINE_MM * 2 * half[1] / millimetres[1]
    heights = where[order, 1].copy()
    for k in range(1, len(heights)):
        heights[k] = min(heights[k], heights[k - 1] - line)
    heights += max(0.0, centre[1] - half[1] + line - heights[-1])
    for k in range(len(heights) - 2, -1, -1):
        heights[k] = max(heights[k], heights[k + 1] + line)
    sign = -1 if side == "left" else 1
    for height, place in zip(heights, order):
        text, _, colour, _ = labels[place]
        axes.annotate(
            text,
            where[place],
            (centre[0] + sign * half[0] * 1.02, height),
            fontsize=6.5,
            color=_EDGE,
            va="center",
            annotation_clip=False,
            ha="right" if side == "left" else "left",
            arrowprops=dict(
                arrowstyle="-",
                color=colour,
                linewidth=0.7,
                shrinkA=1,
                shrinkB=0,
                relpos=(1 if side == "left" else 0, 0.5),
            ),
        )
        axes.plot(*where[place], "o", markersize=2.2, color=colour, clip_on=False)


def _rendered(solids, colours, structure, axes, focus, half_height, millimetres):
    """(height, width, 3) image of the structure at twice the figure's resolution."""
    low, high = _ground(solids)

    def fill(plotter, pyvista):
        plotter.add_mesh(
            pyvista.Plane(
                center=(*(low + high) / 2, -1e-3 * half_height),
                i_size=high[0] - low[0],
                j_size=high[1] - low[1],
                i_resolution=1,
                j_resolution=1,
            ),
            color=_GROUND,
            ambient=0.7,
            diffuse=0.3,
        )
        for (nodes, faces), colour in zip(solids, colours):
            plotter.add_mesh(
                pyvista.PolyData.from_regular_faces(nodes, faces),
                color=colour,
                show_edges=True,
                edge_color=_EDGE,
                line_width=1.0,
                ambient=0.5,
                diffuse=0.55,
                specular=0.05,
                smooth_shading=False,
                opacity=0.85 if structure.links else 1.0,
            )
        for link in structure.links:
            plotter.add_mesh(
                pyvista.Line(*link_ends(link, structure.parts)), color=_LINK, line_width=5.0
            )

    return rendered(
        fill,
        [round(2 * _DPI * side / 25.4) for side in millimetres],
        focus,
        axes,
        half_height,
        10 * (np.linalg.norm(high - low) + half_height),
        0.5,
    )
