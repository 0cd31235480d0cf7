"""Draws an analysis: the files that the options of the user ask for."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fecolumn.foundation.folder import written
from fecolumn.foundation.progress import CountProgress
from fecolumn.pictures.render.camera import camera
from fecolumn.pictures.render.instants import chosen_instants
from fecolumn.pictures.render.render_options import RenderOptions, check_option
from fecolumn.pictures.render.result import read_result
from fecolumn.pictures.render.thrust import arrow_length

if TYPE_CHECKING:
    from fecolumn.pictures.render.camera import Camera
    from fecolumn.pictures.render.canvas import Canvas
    from fecolumn.pictures.render.frames import Frames
    from fecolumn.pictures.render.result import Result


# A picture's resolution, that of figures.style, twice as fine for what VTK draws
_DPI = 400
# Frames that are looked at for the range of colours, and for the exaggeration "auto"
_SAMPLES = 24
# A longer movie was asked for by mistake
_MOST_PICTURES = 100_000
_ALL = RenderOptions()


def render(folder: Path | str, options: RenderOptions = _ALL, quiet: bool = False) -> list[Path]:
    """Write what the options ask for into `folder`/render; returns the files.

    Raises
    ------
    InputError
        no finished analysis in the folder, times outside of it, or colours, exaggeration and
        forces that need what was not written.
    """
    result = read_result(folder, options.body)
    target = result.folder / "render"
    if options.html:
        return [_page(result, options, target)]
    if options.paraview:
        from fecolumn.pictures.render.paraview import PARAVIEW_FILE, write_view

        with written(target, "render paraview", names=(PARAVIEW_FILE,)) as draft:
            write_view(result, draft, options.view, quiet)
        return [target / PARAVIEW_FILE]
    start, end = _window(result, options)
    check_option(
        not (options.gif and options.only == "pictures"),
        "--gif",
        None,
        "is a movie; leave out --only pictures",
    )
    files = []
    if options.only != "movie":
        files += _pictures(result, options, start, end, target)
    if options.only != "pictures":
        files += _movie(result, options, start, end, target, quiet)
    return files


def _page(result: Result, options: RenderOptions, target: Path) -> Path:
    from fecolumn.pictures.render.page.document import PAGE_FILE, page_of

    page = page_of(result, _window(result, options), options.view, options.speed)
    with written(target, "render html", names=(PAGE_FILE,)) as draft:
        (draft / PAGE_FILE).write_text(page, encoding="utf-8")
    return target / PAGE_FILE


def _window(result: Result, options: RenderOptions) -> tuple[float, float]:
    time = result.time
    first, last = float(time[0]), float(time[-1])
    start, end = (
        first if options.start is None else options.start,
        last if options.end is None else options.end,
    )
    for option, value in (
        ("--start", start),
        ("--end", end),
        *(("--instants", value) for value in options.instants),
    ):
        check_option(
            first - 1e-9 <= value <= last + 1e-9,
            option,
            value,
            f"must lie between {first:g} and {last:g} s, the time that was analysed",
        )
    check_option(start < end, "--end", end, f"must be later than the begin, {start:g} s")
    return start, end


def _frames(
    result: Result,
    options: RenderOptions,
    start: float,
    end: float,
    times: np.ndarray,
    interval: float,
) -> Frames:
    """Frames at `times` that range over the same colours, whichever they are of those from start to
    end [s].
    """
    from fecolumn.pictures.render.frames import Frames

    samples = np.linspace(start, end, _SAMPLES)
    whole = Frames(
        result, samples, interval, options.exaggerate, options.color, forces=options.forces
    )
    return Frames(result, times, interval, options.exaggerate, options.color, whole, options.forces)


def _camera(
    result: Result, options: RenderOptions, times: np.ndarray, aspect: float = 1.0
) -> Camera:
    below = arrow_length(result.scene) if options.forces else 0.0
    return camera(result, options.view, times, aspect, below)


def _pictures(
    result: Result, options: RenderOptions, start: float, end: float, target: Path
) -> list[Path]:
    """Stills, and the sequence figure of them."""
    from fecolumn.pictures.render.canvas import Canvas
    from fecolumn.pictures.render.frames import Frames
    from fecolumn.pictures.render.sequence import beside, picture_size, sequence_figure
    from fecolumn.pictures.render.still import still_figure, still_size

    instants = (
        np.unique(options.instants) if options.instants else chosen_instants(result, start, end)
    )
    interval = max(
        1 / options.fps * options.speed,
        result.frames.interval if len(result.frames.time) > 1 else 0.0,
    )
    frames = _frames(result, options, start, end, instants, interval)
    if len(once := np.unique(frames.times)) < len(frames):  # with the scales of the same motion
        frames = Frames(
            result, once, interval, options.exaggerate, options.color, frames, options.forces
        )
    drawn = list(frames)

    def scene(size: tuple[int, int]) -> Canvas:
        return Canvas(frames, _camera(result, options, frames.times, size[0] / size[1]), size)

    with written(target, "render pictures", names=("sequence.png", "sequence.pdf")) as draft:
        natural = _camera(result, options, frames.times).natural
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
        digits = digits_of([frame.time for frame in drawn])
        size = still_size(natural, _DPI, frames.coloured)
        with scene(size) as still:
            for frame in drawn:
                still_figure(
                    frames,
                    frame,
                    still.image(frame),
                    _DPI,
                    draft / f"still_{frame.time:.{digits}f}s",
                    legend=still.legend,
                )
        names = sorted(file.name for file in draft.iterdir())
    return [target / name for name in names]


def digits_of(times: list[float]) -> int:
    """Digits after the point that tell times [s] apart, three at least."""
    apart = {float(time) for time in times}
    told = (n for n in range(3, 16) if len({f"{time:.{n}f}" for time in apart}) == len(apart))
    return next(told, 16)


def _movie(
    result: Result, options: RenderOptions, start: float, end: float, target: Path, quiet: bool
) -> list[Path]:
    from fecolumn.pictures.render.canvas import Canvas
    from fecolumn.pictures.render.movie import GIF_RATE, Gif, Movie
    from fecolumn.pictures.render.panel import Panel

    fps = min(options.fps, GIF_RATE) if options.gif else options.fps
    interval, name = options.speed / fps, "motion.gif" if options.gif else "motion.mp4"
    count = int((end - start) / interval + 1e-6) + 1
    check_option(
        count <= _MOST_PICTURES,
        "--fps, --speed",
        f"{options.fps:g}, {options.speed:g}",
        f"make {count} pictures, more than {_MOST_PICTURES}; give --start and --end",
    )
    frames = _frames(result, options, start, end, start + interval * np.arange(count), interval)
    panel, progress = (
        Panel(frames, options.size, options.speed),
        CountProgress(len(frames), "pictures", quiet),
    )
    size = panel.scene_size
    with written(target, f"render {name}", names=(name,)) as draft:
        view = _camera(result, options, frames.times, size[0] / size[1])
        with Canvas(frames, view, size, quick=True) as scene:
            panel.place_legend(scene.legend)

            def picture(k: int) -> np.ndarray:
                frame = frames.frame(k)
                return panel.picture(frame, scene.image(frame))

            movie: Gif | Movie
            if options.gif:
                movie = Gif(
                    draft / name,
                    options.size,
                    fps,
                    [picture(k) for k in np.unique(np.linspace(0, len(frames) - 1, 6).astype(int))],
                )
            else:
                movie = Movie(draft / name, options.size, fps)
            with movie:
                for k in range(len(frames)):
                    movie.add(picture(k))
                    progress.show(k + 1)
        progress.end()
    return [target / name]
