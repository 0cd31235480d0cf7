"""The page as HTML: K3D-jupyter draws what stands in it, and `page.js` moves that."""

from __future__ import annotations

import json
import re
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.foundation.schema import InputError
from fecolumn.foundation.version import __version__
from fecolumn.pictures.figures.quantity import Quantity
from fecolumn.pictures.render.camera import camera
from fecolumn.pictures.render.frames import SEEN, round_down
from fecolumn.pictures.render.page.arrows import arrows_of
from fecolumn.pictures.render.page.flexure import flexure_of
from fecolumn.pictures.render.page.ground import ground_of
from fecolumn.pictures.render.page.parts import RigidPart, parts_of
from fecolumn.pictures.render.page.plot import MotionPlot, base64_of, deformation_told
from fecolumn.pictures.render.page.rods import Rod, rods_of_links, rods_of_storeys
from fecolumn.pictures.render.render_options import COMMAND
from fecolumn.pictures.render.result import Result
from fecolumn.pictures.render.strips import strips_of

if TYPE_CHECKING:
    from fecolumn.pictures.render.frame import Strip


#: The file
PAGE_FILE = "motion.html"
#: What has to be installed
_INSTALL = "needs k3d: pip install 'k3d>=2.18,<3'"
# The programs of the page, each needed by the next
_PROGRAMS = "turns.js", "strip.js", "flexure.js", "page.js"
_GENERATOR = '<meta name="generator" content="fecolumn'
# Instants a second of the page, between which bodies turn steadily; over the rows of the history
_RATE, _OF_ROWS = 50.0, 20
# Places of bodies, arrows and links at all instants: some 5 MB
_MOST_PLACES = 120_000
# Range of the forces of links over the largest, below which colours do not tell them apart
_HARDLY = 0.05
# Points of a line over time
_STRIP_POINTS = 3000
# Vertical angle of what is seen [deg]: narrow, so that what is upright looks upright
_VIEW = 25.0
# Colours of the kinds of bodies in turn, light so that their edges show
_KINDS = (0xDCCFB8, 0xA9C1D0, 0xBFD0A6, 0xD9B3AC, 0xC6BADB, 0xE3CF9A)


def page_of(result: Result, span: tuple[float, float], view: str, speed: float) -> str:
    """The page of an analysis.

    Parameters
    ----------
    span
        begin and end of the motion [s].
    view
        of `camera.VIEWS`, from where it is seen at first.
    speed
        seconds of motion in a second, at first.

    Raises
    ------
    InputError
        k3d is missing.
    """
    try:
        import k3d  # noqa: F401
    except ImportError as error:
        raise InputError(COMMAND, "--html", None, f"{_INSTALL} ({error})") from None
    times = times_of(result, span, speed)
    parts, plot = parts_of(result, times), MotionPlot(result, times, _VIEW)
    colours = {
        family: _KINDS[k % len(_KINDS)]
        for k, family in enumerate(dict.fromkeys(_family(part.kind) for part in parts))
    }
    links = rods_of_links(result, parts, times)
    content = {
        "title": result.case.title or result.folder.resolve().name,
        "engine": result.case.integration.engine,
        "start": float(times[0]),
        "step": float(times[1] - times[0]),
        "count": len(times),
        "speed": speed,
        "colours": colours,
        "parts": [plot.add_part(part, colours[_family(part.kind)]) for part in parts],
        "still": plot.add_ground(),
        "rods": [plot.add_rod(rod) for rod in (*links, *rods_of_storeys(result, parts))],
        "tension": _tension(links),
        "arrows": _arrows(result, parts, times, plot),
        "flexure": _flexure(result, parts, times, plot),
        "strips": [_strip(strip) for strip in strips_of(result, times, _STRIP_POINTS)],
    } | _seen(result, times, view)
    return _page(plot.html(_script(content)), str(content["title"]))


def times_of(result: Result, span: tuple[float, float], speed: float) -> np.ndarray:
    """Times (t,) [s] of instants, evenly over a span."""
    scene = result.scene
    begin, end = span
    wanted = int((end - begin) * _RATE / min(speed, 1.0)) + 1
    moving = len(scene.bodies) + len(scene.shown) + len(scene.links)
    most = _MOST_PLACES // moving, _OF_ROWS * len(result.time)
    return np.linspace(begin, end, max(2, min(wanted, *most)))


def _seen(result: Result, times: np.ndarray, view: str) -> dict:
    """From where it is seen, and how the ground moves."""
    ground, look = ground_of(result.history, times), camera(result, view, times)
    half = np.array([min(1.0, look.natural), 1 / max(1.0, look.natural)]) * look.half_height
    shift = np.abs(ground.place @ np.stack([look.right, look.up], axis=1)).max(axis=0)
    return {
        "ground": base64_of(ground.place),
        "groundMoves": ground.largest > 0,
        "groundRests": ground.rests,
        "groundLargest": _written(ground.largest, "m"),
        "focus": look.focus.tolist(),
        "toward": look.toward.tolist(),
        "up": look.up.tolist(),
        "slope": float(np.tan(np.radians(_VIEW / 2))),
        "half": half.tolist(),
        "shift": shift.tolist(),
    }


def _arrows(result: Result, parts: list[RigidPart], times: np.ndarray, plot: MotionPlot) -> dict:
    """The arrows, the parts that they move with, and how long they are; none of a history without
    resultants.
    """
    arrows = arrows_of(result, times)
    if arrows is None:
        return {"ids": []}
    bodies = [part.body for part in parts]
    length = _written(arrows.scale * arrows.largest, "m")
    return plot.add_arrows(arrows) | {
        "parts": [bodies.index(body) for body in arrows.bodies],
        "said": f"resultant of a joint, mean over {1e3 * arrows.mean:.3g} ms; {length} long: "
        f"{_written(arrows.largest, 'N')}",
    }


def _flexure(result: Result, parts: list[RigidPart], times: np.ndarray, plot: MotionPlot) -> dict:
    """Deformation and pressure, and how they are told; neither where nothing is known of them."""
    found = flexure_of(result, parts, times)
    if found is None:
        return {"times": "", "parts": [], "faces": []}
    bodies = [part.body for part in parts]
    # a magnification at which the largest is some 5 % of the height
    seen = round_down(SEEN * result.scene.height / found.largest) if found.largest > 0 else 1.0
    least, most = (_written(one, "Pa") for one in found.pressures)
    return {
        "times": base64_of(found.times),
        "parts": [deformation_told(*one) for one in zip(parts, found.deformations)],
        "seen": max(seen, 1.0),
        "largest": _written(found.largest, "m"),
        "faces": [plot.add_face(one) | {"part": bodies.index(one.body)} for one in found.faces],
        "pressure": f"contact pressure: {least} to {most}",
    }


def _tension(links: list[Rod]) -> dict:
    """Range of the forces [N] of links in magnitude, as numbers and as written; from 0 where they
    hardly change.
    """
    forces = np.abs([rod.tension for rod in links if rod.tension is not None])
    known = forces[np.isfinite(forces)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
    if high - low < _HARDLY * high:
        low = 0.0
    return {"low": low, "high": high, "written": f"{_written(low, 'N')} to {_written(high, 'N')}"}


def _family(kind: str) -> str:
    """Name of a kind without its number: the voussoirs of an arch are of one family."""
    return re.sub(r"[ _]?\d+$", "", kind) or kind


def _strip(strip: Strip) -> dict:
    """A strip, its title and unit without the marks of mathematics."""
    unit = re.search(r"\[(.*)\]", strip.label)
    return {
        "title": strip.title,
        "unit": unit[1] if unit else "",
        "time": base64_of(strip.time),
        "lines": [
            {"name": re.sub(r"[$\\]", "", name), "values": base64_of(np.asarray(values))}
            for values, name in strip.lines
        ],
    }


def _written(value: float, unit: str) -> str:
    quantity = Quantity.of("", unit, value)
    return f"{value / quantity.scale:.3g} {quantity.unit}"


def _script(content: dict) -> str:
    """The program of the page with what it shows; nothing in it ends a script element."""
    own = files(__package__)
    text = json.dumps(content).replace("</", "<\\/")
    style = json.dumps((own / "page.css").read_text())
    programs = "\n".join((own / name).read_text() for name in _PROGRAMS)
    return f"{programs}\nshowMotion(K3DInstance, {text}, {style});\n"


def _page(html: str, title: str) -> str:
    """What K3D wrote, with a head of our own."""
    head = (
        '<head>\n<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'{_GENERATOR} {__version__}">'
    )
    html = html.replace("<html>", '<html lang="en">', 1).replace("<head>", head, 1)
    return re.sub("<title>.*?</title>", lambda _: f"<title>{escape(title)}</title>", html, count=1)
