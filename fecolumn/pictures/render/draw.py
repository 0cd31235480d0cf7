"""Draws an analysis: what the user wishes, checked, and the files of it."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.foundation.folder import written
from fecolumn.foundation.progress import CountProgress
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.camera import VIEWS, camera
from fecolumn.pictures.render.instants import chosen_instants
from fecolumn.pictures.render.result import read_result
from fecolumn.pictures.render.thrust import arrow_length

COMMAND = "fecolumn render"
# A movie's sides [pixels]; a picture's resolution, that of post.style, twice as fine for what VTK
# draws
_SIDES, _DPI = (128, 4096), 400
# Width over height of a movie: parts of the picture overlap in a narrower one
_ASPECT = 1.4, 3.0
# Frames that are looked at for the range of colours, and for the exaggeration "auto"
_SAMPLES = 24
# A longer movie was asked for by mistake
_MOST_PICTURES = 100_000


@dataclass(frozen=True, slots=True)
class Wish:
    """What is to be drawn; times in s.

    Attributes
    ----------
    only
        "movie", "pictures" or "" for both.
    gif, view, color, paraview
        as of the command's options.
    instants
        of stills and sequence, empty to choose.
    exaggerate
        factor on elastic displacements, or "auto".
    start, end
        of the movie; None for those of the analysis.
    fps
        pictures a second.
    speed
        seconds of motion in one of the movie.
    size
        (width, height) of the movie [pixels].
    body
        of a structure, whose top is followed and at whose foot the view "foot" looks.
    forces
        whether resultants, thrust line and hinges are drawn over the bodies.
    html
        file of the page, "" for none.
    """

    only: str = ""
    gif: bool = False
    view: str = "lean"
    instants: tuple[float, ...] = ()
    exaggerate: float | str = 1.0
    color: str = ""
    start: float | None = None
    end: float | None = None
    fps: float = 25.0
    speed: float = 1.0
    size: tuple[int, int] = (1280, 720)
    paraview: bool = False
    body: str = ""
    forces: bool = False
    html: str = ""

    def __post_init__(self):
        if self.html:
            self._check_page()
        _check(self.view in VIEWS, "--view", self.view, f"must be one of {', '.join(VIEWS)}")
        _check(
            1 <= self.fps <= 60, "--fps", self.fps, "must lie between 1 and 60 pictures a second"
        )
        _check(1e-3 <= self.speed <= 100, "--speed", self.speed, "must lie between 0.001 and 100")
        _check(
            len(self.instants) <= 10, "--instants", len(self.instants), "must be ten times at most"
        )
        factor = self.exaggerate
        _check(
            factor == "auto" or (isinstance(factor, (int, float)) and 1 <= factor <= 1e6),
            "--exaggerate",
            factor,
            "must be auto, or lie between 1 and 1e6",
        )
        width, height = self.size
        _check(
            _SIDES[0] <= min(self.size)
            and max(self.size) <= _SIDES[1]
            and not (width % 2 or height % 2),
            "--size",
            f"{width}x{height}",
            f"must be even numbers of {_SIDES[0]} to {_SIDES[1]} pixels",
        )
        _check(
            _ASPECT[0] <= width / height <= _ASPECT[1],
            "--size",
            f"{width}x{height}",
            f"must be {_ASPECT[0]:g} to {_ASPECT[1]:g} times as wide as high",
        )

    def _check_page(self) -> None:
        """Refuse what the page does not do."""
        for option, given in (
            ("--only", self.only),
            ("--gif", self.gif),
            ("--paraview", self.paraview),
            ("--instants", self.instants),
            ("--exaggerate", self.exaggerate != 1.0),
            ("--color", self.color),
        ):
            _check(
                not given,
                option,
                None,
                "is not for --html: its page has bodies rigid, all instants, and keys of its own "
                "for speed and for the factor on displacements",
            )

    @classmethod
    def of(cls, args) -> Wish:
        """The options of the command line."""
        size = re.fullmatch(r"(\d{1,5})x(\d{1,5})", args.size)
        _check(size, "--size", args.size, "must be two numbers of pixels such as 1280x720")
        instants = (
            tuple(
                _number("--instants", word, "must be times [s] such as 0.5,1.2")
                for word in args.instants.split(",")
            )
            if args.instants
            else ()
        )
        exaggerate = (
            "auto"
            if args.exaggerate == "auto"
            else _number("--exaggerate", args.exaggerate, "must be a number or auto")
        )
        return cls(
            args.only or "",
            args.gif,
            args.view or ("iso" if args.html else "lean"),
            instants,
            exaggerate,
            args.color,
            args.start,
            args.end,
            args.fps,
            args.speed,
            (int(size[1]), int(size[2])),
            args.paraview,
            args.body,
            args.forces,
            args.html,
        )


def _number(option: str, word: str, allowed: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    _check(math.isfinite(value), option, word, allowed)
    return value


def _check(holds, option: str, value, allowed: str) -> None:
    if not holds:
        raise InputError(COMMAND, option, value, allowed)


def render(folder, wish: Wish = Wish(), quiet: bool = False) -> list[Path]:
    """Write what is wished into `folder`/render; returns the files.

    Raises
    ------
    InputError
        no finished analysis in the folder, times outside of it, or colours, exaggeration and
        forces that need what was not written.
    """
    if wish.html:
        return [_page(folder, wish)]
    result = read_result(folder, wish.body)
    target = result.folder / "render"
    if wish.paraview:
        from fecolumn.pictures.render.paraview import NAME, write_view

        with written(target, "render paraview", names=(NAME,)) as draft:
            write_view(result, draft, wish.view, quiet)
        return [target / NAME]
    start, end = _window(result, wish)
    files = []
    if wish.only != "movie":
        files += _pictures(result, wish, start, end, target)
    if wish.only != "pictures":
        files += _movie(result, wish, start, end, target, quiet)
    return files


def _page(folder, wish: Wish) -> Path:
    from fecolumn.pictures.render.page.document import check_file, write_page

    check_file(wish.html)
    result = read_result(folder, wish.body)
    return write_page(result, wish.html, _window(result, wish), wish.view, wish.speed)


def _window(result, wish: Wish) -> tuple[float, float]:
    time = result.time
    first, last = float(time[0]), float(time[-1])
    start, end = first if wish.start is None else wish.start, last if wish.end is None else wish.end
    for option, value in (
        ("--start", start),
        ("--end", end),
        *(("--instants", value) for value in wish.instants),
    ):
        _check(
            first - 1e-9 <= value <= last + 1e-9,
            option,
            value,
            f"must lie between {first:g} and {last:g} s, the time that was analysed",
        )
    _check(start < end, "--end", end, f"must be later than the begin, {start:g} s")
    return start, end


def _frames(result, wish: Wish, start: float, end: float, times: np.ndarray, interval: float):
    """Frames at `times` that range over the same colours, whichever they are of those from start to
    end [s].
    """
    from fecolumn.pictures.render.frames import Frames

    samples = np.linspace(start, end, _SAMPLES)
    whole = Frames(result, samples, interval, wish.exaggerate, wish.color, forces=wish.forces)
    return Frames(result, times, interval, wish.exaggerate, wish.color, whole, wish.forces)


def _camera(result, wish: Wish, times: np.ndarray, aspect: float = 1.0):
    below = arrow_length(result.scene) if wish.forces else 0.0
    return camera(result, wish.view, times, aspect, below)


def _pictures(result, wish: Wish, start: float, end: float, target: Path) -> list[Path]:
    """Stills, and the sequence figure of them."""
    from fecolumn.pictures.render.canvas import Canvas
    from fecolumn.pictures.render.sequence import beside, picture_size, sequence_figure
    from fecolumn.pictures.render.still import still_figure, still_size

    instants = np.unique(wish.instants) if wish.instants else chosen_instants(result, start, end)
    interval = max(
        1 / wish.fps * wish.speed, result.frames.interval if len(result.frames.time) > 1 else 0.0
    )
    frames = _frames(result, wish, start, end, instants, interval)
    drawn = list(frames)

    def scene(size):
        return Canvas(frames, _camera(result, wish, frames.times, size[0] / size[1]), size)

    with written(target, "render pictures", names=("sequence.png", "sequence.pdf")) as draft:
        natural = _camera(result, wish, frames.times).natural
        size = picture_size(len(drawn), natural, _DPI, beside(frames))
        with scene(size) as sequence:
            sequence_figure(
                frames,
                [sequence.image(frame) for frame in drawn],
                _DPI,
                np.array([start, end]),
                draft / "sequence",
                legend=sequence.legend,
            )
        size = still_size(natural, _DPI, frames.coloured)
        with scene(size) as still:
            for frame in drawn:
                still_figure(
                    frames,
                    frame,
                    still.image(frame),
                    _DPI,
                    draft / f"still_{frame.time:.3f}s",
                    legend=still.legend,
                )
        names = sorted(file.name for file in draft.iterdir())
    return [target / name for name in names]


def _movie(result, wish: Wish, start: float, end: float, target: Path, quiet: bool) -> list[Path]:
    from fecolumn.pictures.render.canvas import Canvas
    from fecolumn.pictures.render.movie import GIF_RATE, Gif, Movie
    from fecolumn.pictures.render.panel import Panel

    fps = min(wish.fps, GIF_RATE) if wish.gif else wish.fps
    interval, name = wish.speed / fps, "motion.gif" if wish.gif else "motion.mp4"
    count = int((end - start) / interval + 1e-6) + 1
    _check(
        count <= _MOST_PICTURES,
        "--fps, --speed",
        f"{wish.fps:g}, {wish.speed:g}",
        f"make {count} pictures, more than {_MOST_PICTURES}; give --start and --end",
    )
    frames = _frames(result, wish, start, end, start + interval * np.arange(count), interval)
    panel, progress = (
        Panel(frames, wish.size, wish.speed),
        CountProgress(len(frames), "pictures", quiet),
    )
    size = panel.scene_size
    with written(target, f"render {name}", names=(name,)) as draft:
        view = _camera(result, wish, frames.times, size[0] / size[1])
        with Canvas(frames, view, size, quick=True) as scene:
            panel.place_legend(scene.legend)

            def picture(k):
                frame = frames.frame(k)
                return panel.picture(frame, scene.image(frame))

            if wish.gif:
                movie = Gif(
                    draft / name,
                    wish.size,
                    fps,
                    [picture(k) for k in np.unique(np.linspace(0, len(frames) - 1, 6).astype(int))],
                )
            else:
                movie = Movie(draft / name, wish.size, fps)
            with movie:
                for k in range(len(frames)):
                    movie.add(picture(k))
                    progress.show(k + 1)
        progress.end()
    return [target / name]
