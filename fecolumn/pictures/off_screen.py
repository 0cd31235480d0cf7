"""Images of surfaces in parallel projection, by VTK without a screen.

It needs no X server but Debian's libegl1, libegl-mesa0 and libgl1-mesa-dri.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pyvista


_AZIMUTH, _ELEVATION = np.radians(-62), np.radians(24)


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


def rendered(
    fill: Callable[[pyvista.Plotter, ModuleType], None],
    pixels: Sequence[int],
    focus: np.ndarray,
    view: Sequence[np.ndarray],
    half_height: float,
    reach: float,
    depth: float,
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


def off_screen_plotter(pixels: Sequence[int]) -> pyvista.Plotter:
    """A pyvista.Plotter of so many pixels (width, height), white and dark, without a screen."""
    # VTK asks for an X server first and complains where there is none
    if not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=list(pixels), lighting="none")
    plotter.set_background("white")
    return plotter


def light_and_look(
    plotter: pyvista.Plotter,
    focus: np.ndarray,
    view: Sequence[np.ndarray],
    half_height: float,
    reach: float,
    depth: float,
) -> None:
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
