"""Options of a picture, checked."""

from __future__ import annotations

import math
import re
from argparse import Namespace
from dataclasses import dataclass

from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.camera import VIEWS

COMMAND = "fecolumn render"
# A movie's sides [pixels]
_SIDES = 128, 4096
# Width over height of a movie: parts of the picture overlap in a narrower one
_ASPECT = 1.4, 3.0


@dataclass(frozen=True, slots=True)
class RenderOptions:
    """What is to be drawn; times in s.

    Attributes
    ----------
    only
        "movie", "pictures" or "" for both.
    gif, color, paraview
        as of the command's options.
    view
        of `camera.VIEWS`; "" for that from which this is seen best.
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
        whether a page with the motion is written, and nothing else.
    """

    only: str = ""
    gif: bool = False
    view: str = ""
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
    html: bool = False

    def __post_init__(self) -> None:
        if not self.view:
            object.__setattr__(self, "view", "iso" if self.html else "lean")
        if self.html:
            self._check_page()
        elif self.paraview:
            self._check_paraview()
        check_option(self.view in VIEWS, "--view", self.view, f"must be one of {', '.join(VIEWS)}")
        check_option(
            1 <= self.fps <= 60, "--fps", self.fps, "must lie between 1 and 60 pictures a second"
        )
        check_option(
            1e-3 <= self.speed <= 100, "--speed", self.speed, "must lie between 0.001 and 100"
        )
        check_option(
            len(self.instants) <= 10, "--instants", len(self.instants), "must be ten times at most"
        )
        factor = self.exaggerate
        check_option(
            factor == "auto" or (isinstance(factor, (int, float)) and 1 <= factor <= 1e6),
            "--exaggerate",
            factor,
            "must be auto, or lie between 1 and 1e6",
        )
        width, height = self.size
        check_option(
            _SIDES[0] <= min(self.size)
            and max(self.size) <= _SIDES[1]
            and not (width % 2 or height % 2),
            "--size",
            f"{width}x{height}",
            f"must be even numbers of {_SIDES[0]} to {_SIDES[1]} pixels",
        )
        check_option(
            _ASPECT[0] <= width / height <= _ASPECT[1],
            "--size",
            f"{width}x{height}",
            f"must be {_ASPECT[0]:g} to {_ASPECT[1]:g} times as wide as high",
        )

    def _of_pictures(self) -> dict[str, object]:
        """Options that are of pictures and movies alone, those that are given true."""
        return {
            "--only": self.only,
            "--gif": self.gif,
            "--instants": self.instants,
            "--exaggerate": self.exaggerate != 1.0,
            "--colour": self.color,
            "--fps": self.fps != 25.0,
            "--size": self.size != (1280, 720),
        }

    def _check_page(self) -> None:
        """Refuse what the page does not do."""
        for option, given in (("--paraview", self.paraview), *self._of_pictures().items()):
            check_option(
                not given,
                option,
                None,
                "is not for --html, which writes one page of all instants, with controls of its "
                "own; take --view, --body, --start, --end and --speed",
            )

    def _check_paraview(self) -> None:
        """Refuse what the script for ParaView does not do."""
        for option, given in {
            **self._of_pictures(),
            "--forces": self.forces,
            "--start": self.start is not None,
            "--end": self.end is not None,
            "--speed": self.speed != 1.0,
        }.items():
            check_option(
                not given,
                option,
                None,
                "is not for --paraview, which writes a script that shows all instants; take --view "
                "and --body",
            )

    @classmethod
    def of(cls, args: Namespace) -> RenderOptions:
        """The options of the command line."""
        size = re.fullmatch(r"(\d{1,5})x(\d{1,5})", args.size)
        if size is None:
            raise InputError(
                COMMAND, "--size", args.size, "must be two numbers of pixels such as 1280x720"
            )
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
            args.view or "",
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
    check_option(math.isfinite(value), option, word, allowed)
    return value


def check_option(holds: object, option: str, value: object, allowed: str) -> None:
    """Refuse the value of an option, in words that say what is `allowed`, unless it `holds`."""
    if not holds:
        raise InputError(COMMAND, option, value, allowed)
