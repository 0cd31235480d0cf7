"""Movies: H.264 in MP4, and GIF, written frame by frame."""

from __future__ import annotations

import os
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np

if TYPE_CHECKING:
    import PIL.Image
    from av.container import OutputContainer
    from av.video.stream import VideoStream

# Constant quality of x264: 18 is taken for lossless by the eye, 23 is its default
_QUALITY = "20"
# Colours of a GIF: one is kept for what its encoder leaves as it was
_COLOURS = 255
# A GIF has no more pictures a second, and is no wider [pixels]: these files grow with every picture
GIF_RATE, GIF_WIDTH = 12.5, 800


class _PictureFile:
    """A file of pictures, complete once its `with` block ends."""

    file: Path
    _container: OutputContainer
    _stream: VideoStream

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            if kind is None:
                for packet in self._stream.encode():
                    self._container.mux(packet)
        finally:
            self._container.close()
        if kind is None:
            _settle(self.file)


class Movie(_PictureFile):
    """An MP4 file that takes pictures one by one; complete once the `with` block ends.

    Parameters
    ----------
    file
        to write.
    size
        (width, height) [pixels], both even.
    fps
        pictures a second.

    Raises
    ------
    OSError
        the disk is full, or the file cannot be written.
    """

    def __init__(self, file: Path, size: tuple[int, int], fps: float) -> None:
        import av

        self.file, self._av = file, av
        self._container = av.open(str(file), "w", format="mp4", options={"movflags": "faststart"})
        self._stream = self._container.add_stream(
            "libx264",
            rate=Fraction(fps).limit_denominator(1000),
            options={"crf": _QUALITY, "preset": "veryfast"},
        )
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = "yuv420p"  # what every player takes

    def add(self, picture: np.ndarray) -> None:
        """Append a picture (height, width, 3), uint8."""
        for packet in self._stream.encode(
            self._av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="rgb24")
        ):
            self._container.mux(packet)


class Gif(_PictureFile):
    """A GIF as `Movie` is an MP4; pictures are reduced to GIF_WIDTH and to one palette.

    Parameters
    ----------
    file, size, fps
        as of `Movie`; fps at most GIF_RATE.
    samples
        pictures that have the colours of all.
    """

    def __init__(
        self, file: Path, size: tuple[int, int], fps: float, samples: list[np.ndarray]
    ) -> None:
        import av

        self.file, self._av = file, av
        width = min(GIF_WIDTH, size[0])
        self._size = width, round(width * size[1] / size[0])
        self._palette = self._image(
            np.concatenate(samples), (width, self._size[1] * len(samples))
        ).quantize(_COLOURS)
        colours = np.zeros((256, 4), np.uint8)
        given = np.asarray(self._palette.getpalette(), np.uint8).reshape(-1, 3)[:256]
        colours[: len(given), 1:], colours[:, 0] = given, 255
        self._colours = colours
        self._container = av.open(str(file), "w", format="gif", options={"loop": "0"})
        self._stream = self._container.add_stream("gif", rate=Fraction(fps).limit_denominator(1000))
        self._stream.width, self._stream.height = self._size
        self._stream.pix_fmt = "pal8"

    @staticmethod
    def _image(picture: np.ndarray, size: tuple[int, int]) -> PIL.Image.Image:
        from PIL import Image

        return Image.fromarray(picture).resize(size, Image.Resampling.BOX)

    def add(self, picture: np.ndarray) -> None:
        """Append a picture (height, width, 3), uint8."""
        from PIL import Image

        numbers = np.asarray(
            self._image(picture, self._size).quantize(
                palette=self._palette, dither=Image.Dither.NONE
            )
        )
        frame = self._av.VideoFrame.from_ndarray(
            (numbers, self._colours),  # type: ignore[arg-type]  # as pal8 takes them
            format="pal8",
        )
        for packet in self._stream.encode(frame):
            self._container.mux(packet)


def _settle(file: Path) -> None:
    """Wait until a file is on the disk, so that it is whole before it takes its name."""
    with open(file, "rb") as content:
        os.fsync(content.fileno())
