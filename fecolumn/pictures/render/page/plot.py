"""What K3D-jupyter draws of the page, each thing so that the page can move it as a whole."""

from __future__ import annotations

import base64
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.pictures.render.page.arrows import Arrows
from fecolumn.pictures.render.page.flexure import Deformation, PressedFace
from fecolumn.pictures.render.page.parts import RigidPart
from fecolumn.pictures.render.page.rods import Rod
from fecolumn.pictures.render.result import Result
from fecolumn.pictures.render.thrust import scene_size

_EDGE, _GROUND, _ARROW, _COLUMN, _LINES = 0x3C4146, 0xD9DBD6, 0x111111, 0x4A4F54, 0x9A9A9A
# Half the width over the size of the scene [-] of links, of columns of buildings and of arrows
_LINK, _STRUT, _SHAFT = 0.005, 0.0045, 0.0055
# Head of an arrow whose length is 1: length, and half the width over that of its shaft
_HEAD, _WIDE = 0.28, 2.6
# Corners of a round rod
_SIDES = 12
# Thickness of a ground over the size of the scene, the lift of lines on it, most squares a side
_THICK, _LIFT, _SQUARES = 0.012, 0.0015, 60
# Largest whole number of 16 bits
_WHOLE = 32767
# How dark every other body is: neighbours are told apart
_DARKER = 0.88
_BOX: tuple[tuple[int, int, int], ...] = ((0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7))
_BOX += tuple((k, (k + 1) % 4, 4 + (k + 1) % 4) for k in range(4))
_BOX += tuple((k, 4 + (k + 1) % 4, 4 + k) for k in range(4))


def base64_of(values: ArrayLike) -> str:
    """Numbers in single precision, as base64."""
    return base64.b64encode(np.ascontiguousarray(values, "<f4").tobytes()).decode()


def bytes_of(values: ArrayLike) -> str:
    """Whole numbers from 0 to 255, as base64."""
    return base64.b64encode(np.ascontiguousarray(values, np.uint8).tobytes()).decode()


def deformation_told(part: RigidPart, deformation: Deformation | None) -> dict | None:
    """A part's deformation for the page: its shapes as whole numbers of 16 bits, and their unit;
    and of its lines the points at their ends.
    """
    if deformation is None:
        return None
    unit = float(np.abs(deformation.shapes).max()) / _WHOLE
    whole = np.rint(deformation.shapes / unit).astype("<i2")
    return {
        "shapes": base64.b64encode(whole.tobytes()).decode(),
        "unit": unit,
        "shares": base64_of(deformation.shares),
        "count": len(deformation.shapes),
        "ends": [
            base64.b64encode(ends.astype("<u4").tobytes()).decode()
            for ends in (part.edges, part.lines)
            if len(ends)
        ],
    }


class MotionPlot:
    """A plot of K3D; what is added is told by its number, for the page to move it.

    Attributes
    ----------
    size
        of the scene [m], to which rods and arrows fit.
    """

    def __init__(self, result: Result, times: np.ndarray, field_of_view: float) -> None:
        """The empty plot of a motion at `times` (t,) [s]; field_of_view: vertical angle [deg]."""
        import k3d

        self._result, self._k3d = result, k3d
        self.size = scene_size(result.scene)
        shown = result.shown("iso", times)
        self._plot = k3d.plot(
            camera_auto_fit=False,
            grid_auto_fit=False,
            grid_visible=False,
            # K3D takes its range of depths from it
            grid=[*map(float, shown.min(axis=0)), *map(float, shown.max(axis=0))],
            menu_visibility=False,
            axes_helper=0,
            camera_fov=field_of_view,
            camera_mode="orbit",
            lighting=2.0,
            # with it edges could not be drawn before the faces on which they lie
            logarithmic_depth_buffer=False,
            background_color=0xFFFFFF,
        )

    def html(self, script: str) -> str:
        """The page, which runs a script when all is loaded."""
        return self._plot.get_snapshot(compression_level=9, additional_js_code=script)

    def _surface(self, points: ArrayLike, triangles: ArrayLike, colour: int, name: str) -> int:
        drawn = self._k3d.mesh(
            np.asarray(points, np.float32),
            np.asarray(triangles, np.uint32),
            color=colour,
            side="double",
            roughness=0.8,
            name=name,
        )
        self._plot += drawn
        return drawn.id

    def _segments(self, ends: np.ndarray, colour: int, opacity: float) -> int:
        """Straight lines with ends (n, 2, 3) [m], a pixel wide."""
        drawn = self._k3d.lines(
            np.asarray(ends, np.float32).reshape(-1, 3),
            np.arange(2 * len(ends), dtype=np.uint32).reshape(-1, 2),
            indices_type="segment",
            shader="simple",
            color=colour,
            opacity=opacity,
            name="lines",
        )
        self._plot += drawn
        return drawn.id

    def add_part(self, part: RigidPart, colour: int) -> dict:
        """A body, around its place."""
        ids = [self._surface(part.points, part.triangles, _shade(colour, part.body), part.name)]
        for ends, opacity in ((part.edges, 1.0), (part.lines, 0.22)):
            if len(ends):
                ids.append(self._segments(part.points[ends], _EDGE, opacity))
        return {
            "ids": ids,
            "rest": part.rest.tolist(),
            "place": base64_of(part.place),
            "turn": base64_of(part.turn),
        }

    def add_face(self, face: PressedFace) -> dict:
        """A face under pressure, each of its elements with corners of its own."""
        count, corners = face.corners.shape[:2]
        first = corners * np.arange(count)[:, None]
        fans = [first + [0, k, k + 1] for k in range(1, corners - 1)]
        drawn = self._surface(
            face.corners.reshape(-1, 3), np.concatenate(fans), 0xFFFFFF, "pressure"
        )
        return {"id": drawn, "corners": corners, "levels": bytes_of(face.levels)}

    def add_ground(self) -> list[int]:
        """Grounds, and where the feet stand at rest on them."""
        found, lift = [], np.array([0, 0, _LIFT * self.size])
        for low, high, square in self._result.grounds:
            x, y = (low[0], high[0]), (low[1], high[1])
            plan = [(x[i], y[j]) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
            levels = low[2] - _THICK * self.size, low[2]
            corners = [(*corner, level) for level in levels for corner in plan]
            found.append(self._surface(corners, _BOX, _GROUND, "ground"))
            ends = _squares(low, high, max(square, float(np.max(high - low)) / _SQUARES))
            found.append(self._segments(ends + lift, _LINES, 0.6))
        outside = self._result.scene.base
        if outside is not None:
            faces, points = outside.faces, self._result.scene.points[outside.nodes]
            triangles = [faces[:, :3]] + ([faces[:, [0, 2, 3]]] if faces.shape[1] == 4 else [])
            found.append(self._surface(points, np.concatenate(triangles), _GROUND, "ground"))
        outlines = self._result.scene.outlines
        if len(outlines):
            found.append(self._segments(outlines + 2 * lift, 0x000000, 0.8))
        return found

    def add_rod(self, rod: Rod) -> dict:
        """A rod from 0 to 1 along z, which the page puts between its ends."""
        link = rod.tension is not None
        radius, colour = (_LINK, 0xFFFFFF) if link else (_STRUT, _COLUMN)
        radius *= self.size
        rings = [(0.0, 0.0), (radius, 0.0), (radius, 1.0), (0.0, 1.0)]
        return {
            "id": self._surface(*_round(rings), colour, rod.name),
            "parts": rod.parts,
            "arms": rod.arms.tolist(),
            "tension": None if rod.tension is None else base64_of(rod.tension),
        }

    def add_arrows(self, arrows: Arrows) -> dict:
        """Arrows of length 1 along z with their tips at 0."""
        thin, wide = _SHAFT * self.size, _WIDE * _SHAFT * self.size
        rings = [(0.0, -1.0), (thin, -1.0), (thin, -_HEAD), (wide, -_HEAD), (0.0, 0.0)]
        shape = _round(rings)
        return {
            "ids": [self._surface(*shape, _ARROW, "contact force") for _ in arrows.bodies],
            "tips": base64_of(arrows.tips),
            "forces": base64_of(arrows.forces * arrows.scale),
        }


def _shade(colour: int, number: int) -> int:
    """A colour, darker of every other body."""
    factor, places = _DARKER if number % 2 else 1.0, (16, 8, 0)
    return sum(round((colour >> place & 255) * factor) << place for place in places)


def _squares(low: np.ndarray, high: np.ndarray, square: float) -> np.ndarray:
    """Ends (n, 2, 3) [m] of the lines between the squares of a level ground."""
    found = []
    for axis in (0, 1):
        for at in np.arange(low[axis], high[axis] + 1e-9 * square, square):
            pair = np.array([low, high], float)
            pair[:, axis], pair[:, 2] = at, low[2]
            found.append(pair)
    return np.array(found)


def _round(rings: Sequence[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of a round body along z, given by its rings (radius, z)."""
    angle = 2 * np.pi * np.arange(_SIDES) / _SIDES
    points = np.concatenate(
        [np.stack([r * np.cos(angle), r * np.sin(angle), 0 * angle + z], axis=1) for r, z in rings]
    )
    own = np.arange(_SIDES)
    low = np.stack([own, (own + 1) % _SIDES, (own + 1) % _SIDES + _SIDES], axis=1)
    up = np.stack([own, (own + 1) % _SIDES + _SIDES, own + _SIDES], axis=1)
    rows = [np.concatenate([low, up]) + k * _SIDES for k in range(len(rings) - 1)]
    return points, np.concatenate(rows)
