"""One look for every figure: sized for a journal's column or page, safe for colour-blind readers,
no global state.
"""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator, Sequence
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# a newer matplotlib in a venv over Debian's finds Debian's 3D toolkit; it is not used here
with warnings.catch_warnings():
    warnings.filterwarnings("ignore", "Unable to import Axes3D")
    from matplotlib.figure import Figure

COLUMN_WIDTH_IN, PAGE_WIDTH_IN = 3.5, 7.2
# Okabe & Ito (2008), without their yellow, which is too faint for a line
BLACK, ORANGE, SKY, GREEN, BLUE, VERMILION, PURPLE = (
    "#000000",
    "#E69F00",
    "#56B4E9",
    "#009E73",
    "#0072B2",
    "#D55E00",
    "#CC79A7",
)
GREY = "#9A9A9A"
_PRINT_DPI = 300  # of those parts of a PDF that are drawn as an image, for their many lines
# Told apart by colour and by dash, so that print in grey still reads
LINES: tuple[tuple[str, str | tuple[int, tuple[int, ...]]], ...] = tuple(
    zip(
        (BLUE, VERMILION, GREEN, PURPLE, ORANGE, BLACK, SKY),
        ("-", "--", "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1)), "-", "--"),
    )
)

STYLE = {
    "font.family": "serif",
    "font.serif": ["STIXGeneral", "DejaVu Serif"],
    "mathtext.fontset": "stix",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.fontsize": 7.5,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.1,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "axes.grid": True,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.4,
    "axes.axisbelow": True,
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "legend.borderpad": 0.3,
    "legend.handlelength": 2.2,
    "legend.labelspacing": 0.3,
    "figure.constrained_layout.use": True,
    "savefig.dpi": 200,
    "pdf.fonttype": 42,
    "svg.hashsalt": "fecolumn",
}


def styled() -> contextlib.AbstractContextManager[None]:
    """Context in which figures are made and saved."""
    context: contextlib.AbstractContextManager[None] = matplotlib.rc_context(STYLE)
    return context


def new_figure(width_in: float, height_in: float) -> Figure:
    """Figure that belongs to no window system, usable in workers and on clusters; call inside
    `styled()`.
    """
    return Figure(figsize=(width_in, height_in))


class SavedFigure(NamedTuple):
    """A figure that was saved, and whether its axes were fitted into it."""

    figure: Figure
    fitted: bool


# Figures that are saved while a script asks for them
_SAVED: ContextVar[list[SavedFigure] | None] = ContextVar("saved", default=None)


@contextlib.contextmanager
def figures_saved() -> Iterator[list[SavedFigure]]:
    """The figures that are saved inside, in their order."""
    figures: list[SavedFigure] = []
    token = _SAVED.set(figures)
    try:
        yield figures
    finally:
        _SAVED.reset(token)


def save(figure: Figure, path: Path | str, formats: Sequence[str] = ("png", "pdf")) -> list[Path]:
    """Write PNG (200 dpi) and PDF, or what `formats` says, beside each other; the same data gives
    the same bytes.
    """
    if (saved := _SAVED.get()) is not None:
        saved.append(SavedFigure(figure, figure.get_layout_engine() is not None))
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    files = [path.with_name(f"{path.name}.{suffix}") for suffix in formats]
    if engine := figure.get_layout_engine():
        engine.execute(figure)  # takes as long as to draw it: once for all files
    with matplotlib.rc_context({"figure.constrained_layout.use": False}):
        figure.set_layout_engine(None)
        for file in files:
            figure.savefig(
                file,
                dpi=_PRINT_DPI if file.suffix == ".pdf" else STYLE["savefig.dpi"],
                metadata={".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(file.suffix),
            )
    return files


def legend_beside(axes: Axes) -> None:
    """Legend to the right of the axes, where it hides nothing."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.005, 1.0), borderaxespad=0, framealpha=0)
