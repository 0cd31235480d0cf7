"""Options of the pictures of an analysis, as arguments of `AnalysisResult.render`."""

from __future__ import annotations

import inspect
import typing
from collections.abc import Sequence

if typing.TYPE_CHECKING:
    from fecolumn.pictures.render.render_options import RenderOptions


class PictureOptions(typing.TypedDict, total=False):
    """Arguments of `AnalysisResult.render`, whose help has their meaning and units."""

    only: str
    view: str
    body: str
    instants: Sequence[float]
    start: float | None
    end: float | None
    speed: float
    fps: float
    size: tuple[int, int]
    colour: str
    exaggerate: float | str
    forces: bool
    gif: bool
    html: bool
    paraview: bool


_DEFAULTS = PictureOptions(
    only="",
    view="",
    body="",
    instants=(),
    start=None,
    end=None,
    speed=1.0,
    fps=25.0,
    size=(1280, 720),
    colour="",
    exaggerate=1.0,
    forces=False,
    gif=False,
    html=False,
    paraview=False,
)


def render_options(given: PictureOptions) -> RenderOptions:
    """The options of a picture, checked.

    Raises
    ------
    InputError
        a value out of range.
    TypeError
        an option that there is not.
    """
    from fecolumn.pictures.render.render_options import RenderOptions

    for name in given:
        if name not in _DEFAULTS:
            raise TypeError(
                f"AnalysisResult.render() got an unexpected keyword argument {name!r}; it takes "
                f"{', '.join(_DEFAULTS)}, quiet"
            )
    options: dict[str, typing.Any] = {**_DEFAULTS, **given}
    options["instants"] = tuple(options["instants"])
    return RenderOptions(color=options.pop("colour"), **options)


def picture_signature() -> inspect.Signature:
    """That of `AnalysisResult.render`, each option with its type and default."""
    kinds = PictureOptions.__annotations__
    options = [
        inspect.Parameter(
            name,
            inspect.Parameter.KEYWORD_ONLY,
            default=default,
            annotation=kinds[name].__forward_arg__,
        )
        for name, default in {**_DEFAULTS}.items()
    ]
    itself = inspect.Parameter("self", inspect.Parameter.POSITIONAL_OR_KEYWORD)
    quiet = inspect.Parameter(
        "quiet", inspect.Parameter.KEYWORD_ONLY, default=True, annotation="bool"
    )
    return inspect.Signature([itself, *options, quiet], return_annotation="list[Path]")
