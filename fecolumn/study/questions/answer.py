"""The answer to a question that was asked by the words of its command."""

from __future__ import annotations

import argparse
import contextlib
import html
import io
import sys
from pathlib import Path
from typing import Any, NoReturn

from fecolumn.foundation.schema import InputError
from fecolumn.study.results.study import StudyResult
from fecolumn.study.run import StudyError


class Answer:
    """What a question was answered.

    Attributes
    ----------
    folder
        Path of its tables, figures and runs.
    text
        the sentences of the answer.
    failed
        number of analyses that ended with an error: intervals and what is said to be decided allow
        for anything that they might have been; 0 of a question that is not of a study.
        `fecolumn.load(folder).rows` of the study has their reasons.
    """

    def __init__(
        self, folder: Path, table: str, figure: str, text: str, *, failed: int = 0
    ) -> None:
        self.folder, self.text, self.failed = folder, text, failed
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


class _Words(argparse.ArgumentParser):
    """Arguments of a command; what is wrong with them is an InputError."""

    def error(self, message: str) -> NoReturn:
        raise InputError(self.prog, "", None, message)


class _Heard:
    """A stream that keeps the end of what is written to it."""

    def __init__(self, stream: Any) -> None:
        self._stream, self._end = stream, ""

    def write(self, text: str) -> int:
        """As of the stream."""
        self._end = (self._end + text)[-10_000:]
        self._stream.write(text)
        return len(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    @property
    def last(self) -> str:
        """The last line, without progress that it has overwritten."""
        lines = [line.rpartition("\r")[2].strip() for line in self._end.splitlines()]
        return next(filter(None, reversed(lines)), "no answer")


def asked(
    command: Any,
    words: list[str],
    folder: str | Path,
    files: tuple[str, str],
    study: str | Path | None = None,
) -> Answer:
    """Run a command with these words and read its answer; files: its table and its figure; study:
    folder of the analyses, left out where it is that of the answer.

    Raises
    ------
    StudyError
        it has written no answer.
    """
    parser = _Words(prog=f"fecolumn {command.__name__.rpartition('.')[2].removesuffix('_command')}")
    command.add_arguments(parser)
    arguments = parser.parse_args([*words, "-o", str(folder)])
    said, heard = io.StringIO(), _Heard(sys.stderr)
    with (
        contextlib.redirect_stdout(said),
        contextlib.redirect_stderr(heard),
    ):
        code = command.main(arguments)
    if code == 130:
        raise KeyboardInterrupt
    lines = said.getvalue().splitlines()
    sentences = [line for line in lines if not line.startswith("wrote ")]
    if code and sentences == lines:
        raise StudyError(f"{heard.last}; see {Path(folder) / 'logs'}")
    text = "\n".join(sentences)
    failed = StudyResult(study or folder).failed if code else 0
    return Answer(Path(folder), *files, text, failed=failed)
