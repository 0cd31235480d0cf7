"""The questions of the command line from a script or a notebook: the same names, the same folders,
the answer as an object.
"""

from __future__ import annotations

import argparse
import contextlib
import html
import io
import numbers
import signal
import threading
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from fecolumn.case.case import Case
from fecolumn.foundation.schema import InputError
from fecolumn.study.results.script import case_file
from fecolumn.study.run import StudyError


class Answer:
    """What a question was answered.

    Attributes
    ----------
    folder
        Path of its tables, figures and runs.
    text
        the sentences of the answer.
    """

    def __init__(self, folder: Path, table: str, figure: str, text: str) -> None:
        self.folder, self.text = folder, text
        self._table, self._figure = table, figure

    @property
    def table(self) -> Any:
        """DataFrame of the command's main table."""
        import pandas

        return pandas.read_csv(self.folder / self._table)

    def _repr_png_(self) -> bytes | None:
        file = self.folder / self._figure
        return file.read_bytes() if file.exists() else None

    def __repr__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        import base64

        png = self._repr_png_()
        image = f"data:image/png;base64,{base64.b64encode(png).decode()}" if png else ""
        picture = f'<img style="max-width:100%" src="{image}">' if image else ""
        text = f'<pre style="white-space:pre-wrap">{html.escape(self.text)}</pre>'
        return f"{text}{self.table.to_html(index=False)}{picture}"


def design(
    case: Case | str | Path,
    folder: str | Path,
    *,
    vary: tuple[str, float, float],
    motions: str | Sequence[str],
    limit: str,
    steps: int = 64,
    jobs: int = 1,
) -> Answer:
    """The least or largest value of a key for which a limit state holds, as `fecolumn design`.

    Parameters
    ----------
    case
        or its file; its own motion is left out.
    folder
        of the runs and the answer; an unfinished one is gone on with.
    vary
        (key, low, high) in the key's own unit, such as ("bodies.cabinet.length_m", 0.3, 0.8).
    motions
        that every value gets, such as "lick:1-40", or several files.
    limit
        such as "P(overturn) < 0.1" or "P(top > 50 mm) < 0.1".
    steps
        of the range between which the answer lies.
    jobs
        analyses at a time.

    Returns
    -------
    Answer
        text of the command, its figure, and a table of each value looked at, in the key's unit,
        with n, k, P and the 95 % interval of P.

    Raises
    ------
    InputError
        case, key, range, motions, limit or folder cannot be used.
    StudyError
        analyses failed.
    """
    from fecolumn.study.questions import design_command

    if not isinstance(vary, (tuple, list)) or len(vary) != 3:
        told = 'must be key, low and high, such as ("bodies.cabinet.length_m", 0.3, 0.8)'
        raise InputError("fecolumn design", "vary", vary, told)
    words = [case_file(case, folder), "--vary", str(vary[0]), _range(vary[1:]), "--limit", limit]
    words += ["--motions", *_several(motions), "--steps", str(steps), "-j", str(jobs)]
    return _asked(design_command, words, folder, "design.csv", "design.png")


def risk(
    source: str | Path,
    folder: str | Path,
    *,
    hazard: str | Path,
    limit: str = "overturn",
    years: float = 50.0,
    site: int = 1,
) -> Answer:
    """How often a limit state is reached at a site, as `fecolumn risk`.

    Parameters
    ----------
    source
        folder of a study or of a design, a table of runs, or fragility.csv.
    folder
        for tables and figures.
    hazard
        CSV file of intensity, in the unit of the fragility's, and annual frequency of exceedance
        [1/year], or OpenQuake's export.
    limit
        of a study: "overturn", "lost", "top > 50 mm" ...
    years
        time of exposure [years].
    site
        line of OpenQuake's file.

    Returns
    -------
    Answer
        text of the command, its figure, and a table of mean annual frequency [1/year] and
        probability in `years`, with their intervals.

    Raises
    ------
    InputError
        hazard, runs or fragility cannot be used.
    """
    from fecolumn.study.questions import risk_command

    words = [str(source), "--hazard", str(hazard), "--limit", limit]
    words += ["--years", repr(float(years)), "--site", str(site)]
    return _asked(risk_command, words, folder, "risk.csv", "risk.png")


def screen(
    objects: Any,
    folder: str | Path,
    *,
    motions: str | Sequence[str],
    limit: str | Sequence[str] = (),
    scale: float = 1.0,
    engine: str = "rigid",
    jobs: int = 1,
) -> Answer:
    """A list of objects ranked by how likely they overturn or slide, as `fecolumn screen`.

    Parameters
    ----------
    objects
        CSV file, or DataFrame, of name, width, depth, height (in _m, _cm or _mm), mass (_kg),
        friction.
    folder
        of the runs and the answer.
    motions
        that every object gets.
    limit
        events of which the first ranks, such as ["overturn", "slide > 20 mm"].
    scale
        factor on the motions.
    engine
        "rigid" or "housner".
    jobs
        analyses at a time.

    Returns
    -------
    Answer
        text of the command, its figure, and a table of the objects, likeliest to be lost first,
        with the probability of each event.

    Raises
    ------
    InputError
        list, motions, limits or folder cannot be used.
    StudyError
        analyses failed.
    """
    from fecolumn.study.questions import screen_command

    if hasattr(objects, "to_csv"):
        path = _beside(folder, "-list.csv")
        objects.to_csv(path, index=False)
        objects = path
    words = [str(objects), "--motions", *_several(motions), f"--scale={scale:.17g}"]
    words += ["--engine", engine, "-j", str(jobs)]
    for one in _several(limit):
        words += ["--limit", one]
    return _asked(screen_command, words, folder, "screen.csv", "figures/ranking.png")


def calibrate(
    case: Case | str | Path,
    folder: str | Path,
    *,
    test: str | Path,
    fit: Mapping[str, tuple[float, float]] | None = None,
) -> Answer:
    """Which values of keys fit a measured free-rocking test, as `fecolumn calibrate`.

    Parameters
    ----------
    case
        or its file; its motion is left out.
    folder
        of the runs and the answer.
    test
        CSV file of time_s and tilt_rad (or tilt_deg) from the release on.
    fit
        ranges by key, such as {"block.restitution": (0.85, 1)}; left out: as of the command.

    Raises
    ------
    InputError
        case, test, keys or folder cannot be used.
    """
    from fecolumn.study.questions import calibrate_command

    words = [case_file(case, folder), "--test", str(test)]
    for key, ends in (fit or {}).items():
        words += ["--fit", key, _range(ends)]
    return _asked(calibrate_command, words, folder, "calibrate.csv", "calibrate.png")


class _Words(argparse.ArgumentParser):
    """Arguments of a command; what is wrong with them is an InputError."""

    def error(self, message: str) -> NoReturn:
        raise InputError(self.prog, "", None, message)


def _range(ends: Any) -> str:
    """LO:HI of the command line."""
    if isinstance(ends, (tuple, list)) and len(ends) == 2:
        return ":".join(repr(float(one)) if _is_number(one) else str(one) for one in ends)
    return str(ends)


def _is_number(value: Any) -> bool:
    return isinstance(value, numbers.Real)


def _several(texts: str | Sequence[str]) -> list[str]:
    return [texts] if isinstance(texts, str) else [str(one) for one in texts]


def _beside(folder: str | Path, ending: str) -> Path:
    """A file beside the folder, named after it."""
    folder = Path(folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    return folder.with_name(folder.name + ending)


def _asked(command: Any, words: list[str], folder: str | Path, table: str, figure: str) -> Answer:
    """Run a command with these words and read its answer."""
    parser = _Words(prog=f"fecolumn {command.__name__.rpartition('.')[2].removesuffix('_command')}")
    command.add_arguments(parser)
    arguments = parser.parse_args([*words, "-o", str(folder)])
    said = io.StringIO()
    with _own_signals(), contextlib.redirect_stdout(said):
        code = command.main(arguments)
    if code == 130:
        raise KeyboardInterrupt
    if code:
        raise StudyError(f"analyses failed; see {Path(folder) / 'logs'}")
    lines = [line for line in said.getvalue().splitlines() if not line.startswith("wrote ")]
    return Answer(Path(folder), table, figure, "\n".join(lines))


@contextlib.contextmanager
def _own_signals() -> Iterator[None]:
    """The caller's way to end by SIGTERM, after the command had its own."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.getsignal(signal.SIGTERM)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
