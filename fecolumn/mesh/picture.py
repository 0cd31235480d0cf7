"""Picture of the specimen's mesh, for papers and reports."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np

from fecolumn.mesh.bricks import BASE, CAP, FLANGE, LOWER, PART_NAMES, UPPER, BrickMesh, outer_faces
from fecolumn.mesh.specimen import SpecimenMesh

_COLOURS = {FLANGE: "#7f9a75", LOWER: "#c67b5c", UPPER: "#9fb2c1", CAP: "#d8c08a", BASE: "#cfd1cc"}
_EDGE = "#2f3437"
_AZIMUTH, _ELEVATION = np.radians(-62), np.radians(24)
_HEIGHT_MM, _WHOLE_MAX_MM, _ZOOM_MM, _GAP_MM = 120.0, 80.0, (92.0, 86.0), 9.0
_DPI = 300


def picture(specimen: SpecimenMesh, path) -> Path:
    """PNG of the whole mesh and a magnified foot, both in the same parallel projection.

    Rendered off-screen by VTK through EGL; needs no X server but Debian's libegl1, libegl-mesa0 and
    libgl1-mesa-dri.

    Parameters
    ----------
    specimen
        what is shown.
    path
        file to write; replaced at once when complete.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import ConnectionPatch, Rectangle

    path = Path(path)
    meshes = specimen.body, specimen.base
    right, up, toward = projection_axes()
    points = np.concatenate([mesh.points for mesh in meshes])
    plan, rise = points @ right, points @ up
    centre = np.array([(plan.min() + plan.max()) / 2, (rise.min() + rise.max()) / 2])
    half = np.array([np.ptp(plan), np.ptp(rise)]) / 2 * 1.02
    whole_mm = _HEIGHT_MM * half / half[1]
    whole_mm *= min(1.0, _WHOLE_MAX_MM / whole_mm[0])

    foot = specimen.body.points[specimen.foot_nodes]
    zoom_half = 0.72 * np.ptp(foot @ right) * np.array([1.0, _ZOOM_MM[1] / _ZOOM_MM[0]])
    # The foot sits in the lower half, so that the change from fine to coarse bricks shows above it.
    zoom_centre = np.array([foot.mean(axis=0) @ right, foot.mean(axis=0) @ up + 0.3 * zoom_half[1]])

    size_mm = np.array(
        [whole_mm[0] + _GAP_MM + _ZOOM_MM[0] + 1, max(whole_mm[1], _ZOOM_MM[1] + 30)]
    )
    figure = Figure(figsize=size_mm / 25.4, dpi=_DPI, facecolor="white")
    FigureCanvasAgg(figure)
    whole_axes = _panel(figure, size_mm, (0, 0), whole_mm, centre, half)
    zoom_axes = _panel(
        figure, size_mm, (whole_mm[0] + _GAP_MM, 0.5), np.array(_ZOOM_MM), zoom_centre, zoom_half
    )
    for axes, middle, extent, panel_mm, line in (
        (whole_axes, centre, half, whole_mm, 0.8),
        (zoom_axes, zoom_centre, zoom_half, np.array(_ZOOM_MM), 2.2),
    ):
        image = _rendered(
            meshes,
            right * middle[0] + up * middle[1],
            (right, up, toward),
            extent[1],
            panel_mm,
            line,
        )
        axes.imshow(
            image, extent=_extent(middle, extent), interpolation="antialiased", aspect="auto"
        )

    corner, frame = zoom_centre - zoom_half, dict(fill=False, edgecolor="#4a4f54", linewidth=0.8)
    whole_axes.add_patch(Rectangle(corner, *(2 * zoom_half), **frame))
    zoom_axes.add_patch(Rectangle(corner, *(2 * zoom_half), clip_on=False, **frame))
    for side in (-1, 1):
        ends = [zoom_centre + zoom_half * [across, side] for across in (1, -1)]
        figure.add_artist(
            ConnectionPatch(
                ends[0],
                ends[1],
                "data",
                "data",
                axesA=whole_axes,
                axesB=zoom_axes,
                color="#4a4f54",
                linewidth=0.5,
            )
        )
    _legend(figure, meshes, whole_mm[0] + _GAP_MM, size_mm)

    path.parent.mkdir(parents=True, exist_ok=True)
    handle, draft = tempfile.mkstemp(dir=path.parent, suffix=".png")
    os.close(handle)
    try:
        figure.savefig(draft, format="png")
        os.chmod(draft, 0o644)
        os.replace(draft, path)
    finally:
        Path(draft).unlink(missing_ok=True)
    return path


def projection_axes() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors of the projection: to the right, upwards, towards the viewer."""
    toward = np.array(
        [
            np.cos(_ELEVATION) * np.cos(_AZIMUTH),
            np.cos(_ELEVATION) * np.sin(_AZIMUTH),
            np.sin(_ELEVATION),
        ]
    )
    right = np.cross([0, 0, 1], toward)
    right /= np.linalg.norm(right)
    return right, np.cross(toward, right), toward


def _extent(centre, half):
    return (centre[0] - half[0], centre[0] + half[0], centre[1] - half[1], centre[1] + half[1])


def _panel(figure, size_mm, corner_mm, panel_mm, centre, half):
    axes = figure.add_axes([*(np.asarray(corner_mm) / size_mm), *(panel_mm / size_mm)])
    left, right, bottom, top = _extent(centre, half)
    axes.set(xlim=(left, right), ylim=(bottom, top))
    axes.set_axis_off()
    return axes


def _rendered(meshes: tuple[BrickMesh, ...], focus, view, half_height, panel_mm, line_width):
    """(height, width, 3) image of the mesh, at twice the figure's resolution."""

    def fill(plotter, pyvista):
        for mesh, part in (
            (mesh, part) for mesh in meshes for part in _COLOURS if mesh.has_part(part)
        ):
            surface = pyvista.PolyData.from_regular_faces(mesh.points, outer_faces(mesh, part))
            plotter.add_mesh(
                surface,
                color=_COLOURS[part],
                show_edges=True,
                edge_color=_EDGE,
                line_width=line_width,
                ambient=0.5,
                diffuse=0.55,
                specular=0.05,
                smooth_shading=False,
            )

    reach = 10 * np.linalg.norm(np.ptp(np.concatenate([mesh.points for mesh in meshes]), axis=0))
    return rendered(
        fill,
        [round(2 * _DPI * side / 25.4) for side in panel_mm],
        focus,
        view,
        half_height,
        reach,
        0.2,
    )


def rendered(
    fill, pixels, focus, view, half_height: float, reach: float, depth: float
) -> np.ndarray:
    """(height, width, 3) image in parallel projection, without a screen.

    Parameters
    ----------
    fill
        function of the plotter and of pyvista that puts the bodies in.
    pixels
        (2,) width and height, at least 2.
    focus
        (3,) middle of the picture [m].
    view
        right, up and toward, unit vectors (3,) as of `projection_axes`.
    half_height
        of the picture [m].
    reach
        how far the camera is from the focus [m]
    depth
        what is nearer or farther than the focus by this share of it is cut away.
    """
    plotter = off_screen_plotter([max(2, side) for side in pixels])
    import pyvista

    try:
        fill(plotter, pyvista)
        light_and_look(plotter, focus, view, half_height, reach, depth)
        return plotter.screenshot(None, return_img=True)
    finally:
        plotter.close()


def off_screen_plotter(pixels):
    """A pyvista.Plotter of so many pixels (width, height), white and dark, without a screen."""
    # VTK asks for an X server first and complains where there is none
    if not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=list(pixels), lighting="none")
    plotter.set_background("white")
    return plotter


def light_and_look(plotter, focus, view, half_height: float, reach: float, depth: float) -> None:
    """Two lights, and a camera in parallel projection; arguments as of `rendered`."""
    import pyvista

    right, up, toward = view
    for direction, strength in ((toward + 0.8 * up - 0.5 * right, 0.95), (toward + right, 0.25)):
        plotter.add_light(
            pyvista.Light(
                position=tuple(focus + reach * direction),
                focal_point=tuple(focus),
                intensity=strength,
                light_type="scene light",
            )
        )
    plotter.enable_parallel_projection()
    plotter.camera_position = [tuple(focus + reach * toward), tuple(focus), tuple(up)]
    plotter.camera.parallel_scale = half_height
    plotter.camera.clipping_range = ((1 - depth) * reach, (1 + depth) * reach)


def _legend(figure, meshes: tuple[BrickMesh, ...], left_mm, size_mm) -> None:
    """A swatch, the name and the number of elements of each part, above the magnified foot."""
    from matplotlib.patches import Rectangle

    top_mm = size_mm[1] - 4
    shown = (
        (mesh, part)
        for part in (CAP, UPPER, LOWER, FLANGE, BASE)
        for mesh in meshes
        if mesh.has_part(part)
    )
    for row, (mesh, part) in enumerate(shown):
        y = top_mm - 6 * row
        figure.add_artist(
            Rectangle(
                ((left_mm + 2) / size_mm[0], (y - 2) / size_mm[1]),
                5 / size_mm[0],
                4 / size_mm[1],
                facecolor=_COLOURS[part],
                edgecolor=_EDGE,
                linewidth=0.6,
            )
        )
        for x, text, align in (
            (10, PART_NAMES[part], "left"),
            (
                58,
                f"{np.sum(mesh.part == part):,} "
                f"{'tetrahedra' if mesh.is_tetrahedral else 'bricks'}".replace(",", " "),
                "right",
            ),
        ):
            figure.text(
                (left_mm + x) / size_mm[0],
                y / size_mm[1],
                text,
                fontsize=8.5,
                va="center",
                ha=align,
                color="#202326",
            )
