"""The page: K3D-jupyter draws what stands in it, and `page.js` moves that."""

from __future__ import annotations

import base64
import importlib.util
import json
import re
from html import escape
from importlib.resources import files
from pathlib import Path

import numpy as np

from fecolumn import __version__
from fecolumn.foundation.atomic import write_bytes
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.render.camera import camera
from fecolumn.pictures.render.page.bars import Bar, links_of, struts_of
from fecolumn.pictures.render.page.arrows import Arrows, arrows_of
from fecolumn.pictures.render.page.ground import ground_of
from fecolumn.pictures.render.page.parts import Part, parts_of
from fecolumn.pictures.render.result import Result
from fecolumn.pictures.render.strips import strips_of

#: What has to be installed
INSTALL = "needs k3d, an optional extra: pip install 'fecolumn[html]'"
_GENERATOR = '<meta name="generator" content="fecolumn'
# Poses a second of motion, between which the page turns steadily; and of all parts together
_RATE, _MOST_POSES = 50.0, 90_000
# Colours of the kinds of bodies, light so that their edges show, in turn
_KINDS = (0xDCCFB8, 0xA9C1D0, 0xBFD0A6, 0xD9B3AC, 0xC6BADB, 0xE3CF9A)
_EDGE, _GROUND, _ARROW, _COLUMN, _REST = 0x3C4146, 0xD9DBD6, 0x111111, 0x4A4F54, 0x9A9A9A
# Half the width over the size of the scene [-] of links, of columns of buildings and of arrows
_LINK, _STRUT, _SHAFT = 0.0035, 0.0045, 0.0055
# Head of an arrow whose length is 1: length and half the width over that of its shaft
_HEAD, _WIDE = 0.28, 2.6
_SIDES = 12
# Points of a line of a strip
_STRIP_POINTS = 1500
# Thickness of a ground over the size of the scene, and the lift of lines on it
_THICK, _LIFT = 0.012, 0.0015


def check_installed(file) -> None:
    """Say how to install what draws, before anything is read.

    Raises
    ------
    InputError
        k3d is missing, or a file is in the way that is no such page.
    """
    if importlib.util.find_spec("k3d") is None:
        raise InputError("fecolumn render", "--html", str(file), INSTALL)
    file = Path(file)
    if file.is_dir() or not file.parent.is_dir():
        raise InputError(
            "fecolumn render", "--html", str(file), "must be a file FILE.html in a folder there is"
        )
    if file.exists() and _GENERATOR not in file.open(errors="replace").read(2000):
        raise InputError(
            "fecolumn render",
            "--html",
            str(file),
            "is a file that fecolumn render --html did not write; give another name",
        )


def write_page(result: Result, file, span: tuple[float, float], view: str, speed: float) -> Path:
    """Write the page of an analysis.

    Parameters
    ----------
    span
        begin and end of the motion [s].
    view
        of `camera.VIEWS`, from where it is seen at first.
    speed
        seconds of motion in a second, at first.
    """
    import k3d

    times = times_of(result, span, speed)
    parts, plot = parts_of(result, times), k3d.plot(
        camera_auto_fit=False,
        grid_auto_fit=False,
        grid_visible=False,
        menu_visibility=False,
        axes_helper=0,
        camera_fov=25.0,
        camera_mode="orbit",
        lighting=2.0,
        # with it the edges of bodies could not be drawn before their faces
        logarithmic_depth_buffer=False,
        background_color=0xFFFFFF,
    )
    told = _told(result, times, parts, view, speed)
    told["parts"] = [_add_part(plot, part, told["colours"][part.kind]) for part in parts]
    told["still"] = _add_ground(plot, result)
    size = _size(result)
    links, struts = links_of(result, parts, times), struts_of(result, parts)
    told["bars"] = [_add_bar(plot, bar, _LINK * size, 0xFFFFFF) for bar in links] + [
        _add_bar(plot, bar, _STRUT * size, _COLUMN) for bar in struts
    ]
    told["tension"] = _largest_tension(result, times)
    told["arrows"] = _add_arrows(plot, arrows_of(result, times), size)
    told["arrows"]["parts"] = [
        next(k for k, part in enumerate(parts) if part.body == body)
        for body in told["arrows"].pop("bodies", ())
    ]
    page = _page(plot.get_snapshot(compression_level=9, additional_js_code=_script(told)), told)
    file = Path(file)
    write_bytes(file, page.encode())
    return file


def times_of(result: Result, span: tuple[float, float], speed: float) -> np.ndarray:
    """Times (t,) [s] of poses, evenly over a span."""
    begin, end = span
    rate = _RATE / min(speed, 1.0)
    bodies = max(1, len(result.scene.bodies))
    count = min(int((end - begin) * rate) + 1, _MOST_POSES // bodies, 20 * len(result.time))
    return np.linspace(begin, end, max(2, count))


def _size(result: Result) -> float:
    return float(np.sqrt(result.scene.height * result.scene.width))


def _told(result: Result, times: np.ndarray, parts: list[Part], view: str, speed: float) -> dict:
    """What the page says, and from where it is seen."""
    ground, look = ground_of(result.history, times), camera(result, view, times)
    tall = look.half_height / max(1.0, look.natural)
    wide = look.half_height * min(1.0, look.natural)
    kinds = list(dict.fromkeys(part.kind for part in parts))
    shift = np.abs(ground.place @ np.stack([look.right, look.up], axis=1)).max(axis=0)
    return {
        "title": result.case.title or result.folder.resolve().name,
        "engine": result.case.integration.engine,
        "start": float(times[0]),
        "step": float(times[1] - times[0]),
        "count": len(times),
        "speed": speed,
        "ground": _packed(ground.place),
        "groundMoves": ground.largest > 0,
        "groundRests": ground.rests,
        "groundLargest": _written(ground.largest, "m"),
        "colours": {kind: _KINDS[k % len(_KINDS)] for k, kind in enumerate(kinds)},
        "focus": look.focus.tolist(),
        "toward": look.toward.tolist(),
        "up": look.up.tolist(),
        "half": [float(wide), float(tall)],
        "shift": (shift if ground.rests else 0 * shift).tolist(),
        "strips": [_strip(strip) for strip in strips_of(result, times)],
    }


def _strip(strip) -> dict:
    """A strip, its title and unit without the marks of mathematics."""
    every = max(1, -(-len(strip.time) // _STRIP_POINTS))
    unit = re.search(r"\[(.*)\]", strip.label)
    return {
        "title": strip.title,
        "unit": unit[1] if unit else "",
        "time": _packed(strip.time[::every]),
        "lines": [
            {"name": re.sub(r"[$\\]", "", name), "values": _packed(np.asarray(values)[::every])}
            for values, name in strip.lines
        ],
    }


def _packed(values) -> str:
    """Numbers in single precision, as base64."""
    return base64.b64encode(np.ascontiguousarray(values, "<f4").tobytes()).decode()


def _written(value: float, unit: str) -> str:
    quantity = Quantity.of("", unit, value)
    return f"{value / quantity.scale:.3g} {quantity.unit}"


def _largest_tension(result: Result, times: np.ndarray) -> dict:
    within = (result.time >= times[0]) & (result.time <= times[-1])
    tensions = [
        np.abs(result.history[f"link/{one.name}/tension"][within]).max()
        for one in result.scene.links
    ]
    largest = float(max(tensions, default=0.0))
    return {"largest": largest, "written": _written(largest, "N")}


def _add_part(plot, part: Part, colour: int) -> dict:
    import k3d

    points = np.asarray(part.points, np.float32)
    drawn = [
        k3d.mesh(points, part.triangles.astype(np.uint32), color=colour, side="double",
                 roughness=0.8, name=part.name)
    ]
    for ends, look in ((part.edges, dict(opacity=1.0)), (part.lines, dict(opacity=0.22))):
        if len(ends):
            used, numbers = np.unique(ends, return_inverse=True)
            drawn.append(
                k3d.lines(points[used], numbers.reshape(-1, 2).astype(np.uint32),
                          indices_type="segment", shader="simple", color=_EDGE, name="edges",
                          **look)
            )
    for one in drawn:
        plot += one
    return {
        "ids": [one.id for one in drawn],
        "rest": part.rest.tolist(),
        "place": _packed(part.place),
        "turn": _packed(part.turn),
    }


def _add_ground(plot, result: Result) -> list[int]:
    """Grounds and the feet's places at rest on them; the numbers of what moves with the ground."""
    import k3d

    size, found = _size(result), []
    for low, high, square in result.grounds:
        down = low - [0, 0, _THICK * size]
        corner = np.array([[(low, high)[i][0], (low, high)[j][1], z]
                           for z in (down[2], low[2]) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))])
        faces = [(4, 5, 6), (4, 6, 7), (0, 2, 1), (0, 3, 2)]
        for k in range(4):
            n = (k + 1) % 4
            faces += [(k, n, 4 + n), (k, 4 + n, 4 + k)]
        found.append(k3d.mesh(np.float32(corner), np.uint32(faces), color=_GROUND, roughness=1.0,
                              side="double", name="ground"))
        square = max(square, float((high - low)[:2].max()) / 60)
        lift, ends = low[2] + _LIFT * size, []
        for axis in (0, 1):
            for at in np.arange(low[axis], high[axis] + 1e-9 * square, square):
                pair = np.array([low, high], float)
                pair[:, axis], pair[:, 2] = at, lift
                ends.append(pair)
        found.append(_segments(k3d, np.array(ends), _REST, 0.6))
    if result.scene.base is not None:
        outside = result.scene.base
        faces = outside.faces
        triangles = np.concatenate([faces[:, :3], faces[:, [0, 2, 3]]]) if faces.shape[1] == 4 else faces
        found.append(k3d.mesh(np.float32(result.scene.points[outside.nodes]), np.uint32(triangles),
                              color=_GROUND, roughness=1.0, side="double", name="ground"))
    outlines = result.scene.outlines
    if len(outlines):
        found.append(_segments(k3d, outlines + [0, 0, 2 * _LIFT * size], 0x000000, 0.8))
    for one in found:
        plot += one
    return [one.id for one in found]


def _segments(k3d, ends: np.ndarray, colour: int, opacity: float):
    numbers = np.arange(2 * len(ends), dtype=np.uint32).reshape(-1, 2)
    return k3d.lines(np.float32(ends.reshape(-1, 3)), numbers, indices_type="segment",
                     shader="simple", color=colour, opacity=opacity, name="lines")


def _round(rings) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of a round body along z, given by its rings (radius, z)."""
    angle = 2 * np.pi * np.arange(_SIDES) / _SIDES
    points = np.concatenate(
        [np.stack([r * np.cos(angle), r * np.sin(angle), 0 * angle + z], axis=1) for r, z in rings]
    )
    triangles = []
    for k in range(len(rings) - 1):
        for a in range(_SIDES):
            b, low, high = (a + 1) % _SIDES, k * _SIDES, (k + 1) * _SIDES
            triangles += [(low + a, low + b, high + b), (low + a, high + b, high + a)]
    return np.float32(points), np.uint32(triangles)


def _add_bar(plot, bar: Bar, radius: float, colour: int) -> dict:
    """A bar from 0 to 1 along z, which the page puts between its ends."""
    import k3d

    drawn = k3d.mesh(
        *_round([(0.0, 0.0), (radius, 0.0), (radius, 1.0), (0.0, 1.0)]),
        color=colour,
        side="double",
        name=bar.name,
    )
    plot += drawn
    return {
        "id": drawn.id,
        "name": bar.name,
        "parts": bar.parts,
        "arms": bar.arms.tolist(),
        "tension": None if bar.tension is None else _packed(bar.tension),
    }


def _add_arrows(plot, arrows: Arrows | None, size: float) -> dict:
    """Arrows of length 1 with their tips at 0, along z."""
    import k3d

    if arrows is None:
        return {"ids": []}
    ids, radius = [], _SHAFT * size
    rings = [(0.0, -1.0), (radius, -1.0), (radius, -_HEAD), (_WIDE * radius, -_HEAD), (0.0, 0.0)]
    for _ in arrows.bodies:
        arrow = k3d.mesh(*_round(rings), color=_ARROW, side="double", name="contact force")
        plot += arrow
        ids.append(arrow.id)
    return {
        "ids": ids,
        "bodies": arrows.bodies,
        "tips": _packed(arrows.tips),
        "forces": _packed(arrows.forces * arrows.scale),
        "scale": f"{_written(arrows.largest, 'N')} in {_written(arrows.scale * arrows.largest, 'm')}",
    }


def _script(told: dict) -> str:
    """The program of the page with what it shows; nothing in it ends a script element."""
    own = files(__package__)
    text = json.dumps(told).replace("</", "<\\/")
    style = json.dumps((own / "page.css").read_text())
    return f"{(own / 'page.js').read_text()}\nshowMotion(K3DInstance, {text}, {style});\n"


def _page(html: str, told: dict) -> str:
    head = (
        '<head>\n<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'{_GENERATOR} {__version__}">'
    )
    html = html.replace("<html>", '<html lang="en">', 1).replace("<head>", head, 1)
    return re.sub("<title>.*?</title>", lambda _: f"<title>{escape(told['title'])}</title>", html, count=1)
