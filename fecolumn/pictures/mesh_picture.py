"""Picture of the meshes of a case: bodies in colours with their names, joints and links; a body
alone in the colours of its parts, and its foot magnified.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.foundation.atomic import write_bytes
from fecolumn.mesh.bricks import BASE, CAP, FLANGE, LOWER, PART_NAMES, UPPER
from fecolumn.pictures.off_screen import projection_axes, rendered

if TYPE_CHECKING:
    import pyvista
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from fecolumn.engines.scene.scene import Scene
    from fecolumn.structures.model import JointModel, LinkModel, Part, StructureModel


_COLOURS = ("#c67b5c", "#9fb2c1", "#d8c08a", "#7f9a75", "#b58fa8", "#8c8fb5", "#c9a27e", "#86aeb0")
_OF_PARTS = {FLANGE: "#7f9a75", LOWER: "#c67b5c", UPPER: "#9fb2c1", CAP: "#d8c08a", BASE: "#cfd1cc"}
_GROUND, _EDGE, _LINK, _JOINT = "#dcded9", "#2f3437", "#1f4e79", "#a02020"
_WIDTH_MM, _HEIGHT_MM, _LABELS_MM, _DPI = 120.0, 120.0, 62.0, 200
# Of the magnified foot, and what is shown of it over its width
_FOOT_MM, _FOOT_SHARE = np.array([92.0, 86.0]), 0.72
# Over the structure's width: margin of the ground around it, and half of the middle part, from
# which a label may go to either side
_MARGIN, _MIDDLE = 0.15, 0.1
# Height of a line of labels
_LINE_MM = 3.6
# Where on a link its name points, from its first end [-]
_ON_LINK = 0.3


def mesh_picture(scene: Scene, structure: StructureModel, path: Path | str) -> Path:
    """PNG of a structure at its start, in parallel projection; names of bodies or of the parts of
    one body, of joints and of links stand beside it.

    Parameters
    ----------
    scene
        upright.
    structure
        StructureModel at its start.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    right, up, _ = projection_axes()
    surfaces = _surfaces(scene, structure)
    points = np.concatenate([points for points, _, _ in surfaces])
    if planes := scene.planes.values():
        low, high = _ground(points)
        corners = [[x, y, min(planes)] for x in (low[0], high[0]) for y in (low[1], high[1])]
        points = np.concatenate([points, corners])
    plan, rise = points @ right, points @ up
    centre = np.array([(plan.min() + plan.max()) / 2, (rise.min() + rise.max()) / 2])
    half = np.array([np.ptp(plan), np.ptp(rise)]) / 2 * 1.03
    millimetres = half * min(_WIDTH_MM / half[0], _HEIGHT_MM / half[1])
    foot = _foot(scene, structure)
    more = np.zeros(2) if foot is None else _FOOT_MM + 1.0
    size = np.array([millimetres[0] + 2 * _LABELS_MM + more[0], max(millimetres[1], more[1], 60.0)])
    figure = Figure(figsize=size / 25.4, dpi=_DPI, facecolor="white")
    FigureCanvasAgg(figure)
    draw = _Panels(figure, size, surfaces, structure, min(planes, default=None))
    axes = draw.panel(np.array([_LABELS_MM, 0.0]), millimetres, centre, half)
    labels, numbers = _fitted(
        _labels(structure, right, centre[0], half[0], _parts(scene, surfaces)),
        int(millimetres[1] / _LINE_MM) - 1,
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
    if foot is not None:
        _magnify(draw, axes, foot, size)
    content = io.BytesIO()
    figure.savefig(content, format="png")
    write_bytes(Path(path), content.getvalue())
    return Path(path)


def _surfaces(scene: Scene, structure: StructureModel) -> list[tuple[np.ndarray, np.ndarray, str]]:
    """Points (n, 3) [m], faces and colour of all that is drawn, where it stands at the start: of
    each body, of each part of a body alone, and of each elastic ground.
    """
    kinds = list(dict.fromkeys(piece.kind for piece in scene.bodies))
    found = []
    for k, piece in enumerate(scene.pieces):
        if piece.held:
            found.append((piece.upright, piece.faces, _OF_PARTS[BASE]))
            continue
        part = structure.parts[k]
        points = (piece.points - part.model.center) @ part.rotation.T + part.center
        own = _parts_of(scene, k)
        if len(scene.bodies) > 1 or own is None:
            colour = _COLOURS[kinds.index(piece.kind) % len(_COLOURS)]
            found.append((points, piece.faces, colour))
            continue
        found += [(points, piece.faces[own == one], _OF_PARTS[one]) for one in np.unique(own)]
    return found


def _parts_of(scene: Scene, number: int) -> np.ndarray | None:
    """Part of a column (n_faces,) to which each face of a piece belongs; None where some belong to
    none, such as floors.
    """
    cells = scene.pieces[number].cells
    parts = scene.of_cells["part"][scene.first_cell[number] + np.maximum(cells, 0)]
    return parts if cells.min() >= 0 and parts.all() else None


def _parts(
    scene: Scene, surfaces: Sequence[tuple[np.ndarray, np.ndarray, str]]
) -> list[tuple[str, np.ndarray]]:
    """Name with the number of elements, and a point (3,) [m], of each part of a body alone; none of
    several bodies.
    """
    own = _parts_of(scene, 0)
    if len(scene.bodies) > 1 or own is None:
        return []
    count = scene.of_cells["part"][: scene.first_cell[1]]
    kind = "tetrahedra" if scene.pieces[0].elements.shape[1] == 4 else "bricks"
    return [
        (
            f"{PART_NAMES[part]}: {np.sum(count == part):,} {kind}",
            points[np.unique(faces)].mean(axis=0),
        )
        for part, (points, faces, _) in zip(np.unique(own), surfaces)
    ]


def _foot(scene: Scene, structure: StructureModel) -> np.ndarray | None:
    """Points (n, 3) [m] of the only foot of a body alone, where it stands; else None."""
    feet = [contact for contact in scene.contacts if contact.on_ground]
    if len(scene.bodies) > 1 or len(feet) != 1:
        return None
    part = structure.parts[0]
    drawn = scene.points[feet[0].points] - scene.pieces[0].place
    return (drawn - part.model.center) @ part.rotation.T + part.center


class _Panels:
    """Pictures of the same surfaces in one figure."""

    def __init__(
        self,
        figure: Figure,
        size: np.ndarray,
        surfaces: Sequence[tuple[np.ndarray, np.ndarray, str]],
        structure: StructureModel,
        level: float | None,
    ) -> None:
        self.figure, self.size, self.surfaces = figure, size, surfaces
        self.structure, self.level = structure, level

    def panel(
        self, corner: np.ndarray, millimetres: np.ndarray, centre: np.ndarray, half: np.ndarray
    ) -> Axes:
        """Axes [m] of a picture `millimetres` large, around `centre` (2,) in the projection."""
        axes = self.figure.add_axes([*(corner / self.size), *(millimetres / self.size)])
        spans = [(centre[k] - half[k], centre[k] + half[k]) for k in range(2)]
        axes.set(xlim=spans[0], ylim=spans[1])
        axes.set_axis_off()
        image = self._image(centre, half[1], millimetres)
        axes.imshow(
            image, extent=(*spans[0], *spans[1]), interpolation="antialiased", aspect="auto"
        )
        return axes

    def _image(self, centre: np.ndarray, half_height: float, millimetres: np.ndarray) -> np.ndarray:
        """(height, width, 3) pixels at twice the figure's resolution."""
        points = np.concatenate([points for points, _, _ in self.surfaces])
        low, high = _ground(points)
        links = self.structure.links

        def fill(plotter: pyvista.Plotter, pyvista: ModuleType) -> None:
            if self.level is not None:
                plane = pyvista.Plane(
                    center=(*(low + high) / 2, self.level - 1e-3 * half_height),
                    i_size=high[0] - low[0],
                    j_size=high[1] - low[1],
                    i_resolution=1,
                    j_resolution=1,
                )
                plotter.add_mesh(plane, color=_GROUND, ambient=0.7, diffuse=0.3)
            for nodes, faces, colour in self.surfaces:
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
                    opacity=0.85 if links else 1.0,
                )
            for link in links:
                ends = link_ends(link, self.structure.parts)
                plotter.add_mesh(pyvista.Line(*ends), color=_LINK, line_width=5.0)

        view = projection_axes()
        return rendered(
            fill,
            [round(2 * _DPI * side / 25.4) for side in millimetres],
            view[0] * centre[0] + view[1] * centre[1],
            view,
            half_height,
            10 * (float(np.linalg.norm(np.ptp(points, axis=0))) + half_height),
            0.5,
        )


def _magnify(draw: _Panels, whole: Axes, foot: np.ndarray, size: np.ndarray) -> None:
    """The foot (n, 3) [m] beside the whole; in the lower half, so that the change from fine to
    coarse elements shows above it.
    """
    from matplotlib.patches import ConnectionPatch, Rectangle

    right, up, _ = projection_axes()
    half = _FOOT_SHARE * np.ptp(foot @ right) * np.array([1.0, _FOOT_MM[1] / _FOOT_MM[0]])
    centre = np.array([foot.mean(axis=0) @ right, foot.mean(axis=0) @ up + 0.3 * half[1]])
    axes = draw.panel(np.array([size[0] - _FOOT_MM[0] - 0.5, 0.5]), _FOOT_MM, centre, half)
    frame = dict(fill=False, edgecolor=_EDGE, linewidth=0.8, clip_on=False)
    for place in (whole, axes):
        place.add_patch(Rectangle(centre - half, *(2 * half), **frame))
    for side in (-1, 1):
        ends = [centre + half * [across, side] for across in (1, -1)]
        draw.figure.add_artist(
            ConnectionPatch(
                *ends, "data", "data", axesA=whole, axesB=axes, color=_EDGE, linewidth=0.5
            )
        )


def _ground(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest corner (2,) [m] of the piece of ground that is drawn around points."""
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    margin = _MARGIN * (high - low).max()
    return low - margin, high + margin


def link_ends(link: LinkModel, parts: Sequence[Part]) -> np.ndarray:
    """Both ends (2, 3) [m] of a link where its parts are."""

    def at(place: int, arm: np.ndarray) -> np.ndarray:
        return arm if place == GROUND else parts[place].center + parts[place].rotation @ arm

    return np.array([at(link.a, link.arm_a), at(link.b, link.arm_b)])


def _labels(
    structure: StructureModel,
    along: np.ndarray,
    middle: float,
    width: float,
    parts: Sequence[tuple[str, np.ndarray]] = (),
) -> list:
    """(text, point (3,), colour, side) of every body, link and interface; the side is that to which
    it is nearer, so that no line crosses the structure.

    What stands one above the other in the middle has bodies and links to the left, interfaces to
    the right. along: (3,) direction to the right; parts: names and points instead of the bodies'.
    """

    def side(point: np.ndarray, otherwise: str) -> str:
        return (
            otherwise
            if abs(point @ along - middle) < _MIDDLE * width
            else "left"
            if point @ along < middle
            else "right"
        )

    bodies = parts or [(part.name, part.center) for part in structure.parts]
    labels = [(name, point, _EDGE, side(point, "left")) for name, point in bodies]
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


def _meeting_point(structure: StructureModel, joint: JointModel) -> np.ndarray:
    """Middle (3,) [m] of a joint's slave surface."""
    part = structure.parts[joint.slave]
    surface = part.model.surfaces[joint.slave_surface]
    middle = part.model.arms[surface.nodes].mean(axis=0)
    return part.center + part.rotation @ (
        middle + (joint.ball.radius * surface.normal if joint.ball else 0.0)
    )


def _write(
    axes: Axes,
    labels: Sequence[tuple[str, np.ndarray, str, str]],
    view_axes: tuple[np.ndarray, np.ndarray],
    centre: np.ndarray,
    half: np.ndarray,
    millimetres: np.ndarray,
    side: str,
) -> None:
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
