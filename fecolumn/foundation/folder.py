"""Folders that a user names for figures and tables: nothing that fecolumn did not write is removed
or written over.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path, PurePosixPath
from typing import Any

from fecolumn.foundation import lock
from fecolumn.foundation.atomic import UNFINISHED, write_json
from fecolumn.foundation.files import Unreadable, read_json
from fecolumn.foundation.schema import InputError

#: The mark of a folder: {"written": {work: [file, ...]}}, files relative to the folder
MARK_FILE = ".fecolumn.json"


@contextlib.contextmanager
def written(
    folder: Path | str, work: str, *, names: tuple[str, ...] = (), alone: bool = False
) -> Iterator[Path]:
    """A draft folder to write into; what is in it when the block ends takes its place in `folder`.

    What the same work wrote there before and does not write now is removed. Until the block ends
    the folder stays as it was.

    Parameters
    ----------
    folder
        made if missing.
    work
        what is written, such as "report"; a folder may hold several.
    names
        files known beforehand, so that long work is refused before it begins.
    alone
        whether the folder must be new, empty, or marked by fecolumn.

    Raises
    ------
    InputError
        it is no folder or cannot be written, is not empty where it should be, or a file that
        fecolumn did not write is in the way.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise InputError(
            "fecolumn " + work, "-o", str(folder), "is a file, or lies in one; a folder is needed"
        ) from None
    with _alone_with(folder):
        mark = _mark_of(folder, work, alone)
        _refuse_foreign(folder, work, names, mark)
        write_json(folder / MARK_FILE, {"written": mark})
    draft = Path(tempfile.mkdtemp(prefix=UNFINISHED, dir=folder))
    try:
        yield draft
        new = sorted(
            file.relative_to(draft).as_posix() for file in draft.rglob("*") if not file.is_dir()
        )
        with _alone_with(folder):
            _take_place(folder, work, draft, new)
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _alone_with(folder: Path) -> contextlib.AbstractContextManager[None]:
    """The right to read and to write the mark of a folder, which other commands may write into."""
    return lock.alone(folder / MARK_FILE)


def _take_place(folder: Path, work: str, draft: Path, new: list[str]) -> None:
    """Move files of a draft into a folder, and remove what the work wrote there before."""
    mark = _read_mark(folder) if os.path.lexists(folder / MARK_FILE) else {}
    _refuse_foreign(folder, work, new, mark)
    old = mark.get(work, [])
    # first claimed, then written: a process that is killed between leaves no file that looks like
    # the user's
    write_json(folder / MARK_FILE, {"written": {**mark, work: sorted({*old, *new})}})
    for name in new:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(draft / name, folder / name)
    others = {name for key, files in mark.items() if key != work for name in files}
    for name in {*old} - {*new} - others:
        _remove(folder, name)
    write_json(folder / MARK_FILE, {"written": {**mark, work: new}})


def _mark_of(folder: Path, work: str, alone: bool) -> dict[str, list[str]]:
    """Files that each work wrote; arguments as of `written`."""
    marked = os.path.lexists(folder / MARK_FILE)
    found = {entry.name for entry in folder.iterdir()} - {f".{MARK_FILE}.lock"}
    if alone and not marked and found:
        raise InputError(
            "fecolumn " + work,
            "-o",
            str(folder),
            f"is not empty and holds nothing that fecolumn wrote (no {MARK_FILE}); give a "
            "new or an empty folder",
        )
    return _read_mark(folder) if marked else {}


def _read_mark(folder: Path) -> dict[str, list[str]]:
    """Files that each work wrote."""
    try:
        mark = read_json(folder / MARK_FILE)
        written = mark["written"]
        for names in written.values():
            for name in names:
                if PurePosixPath(name).is_absolute() or ".." in PurePosixPath(name).parts:
                    raise Unreadable("is damaged: it names files outside the folder")
        return {str(work): [str(name) for name in names] for work, names in written.items()}
    except Unreadable as error:
        raise InputError(folder / MARK_FILE, "", None, f"{error}; give another folder") from None
    except (KeyError, TypeError, AttributeError):
        raise InputError(
            folder / MARK_FILE,
            "",
            None,
            "is damaged: it must state what fecolumn wrote here; give another folder",
        ) from None


def _refuse_foreign(folder: Path, work: str, names: Iterable[str], mark: dict[str, Any]) -> None:
    own = {name for files in mark.values() for name in files}
    for name in names:
        if name not in own and os.path.lexists(folder / name):
            raise InputError(
                "fecolumn " + work,
                "-o",
                str(folder),
                f"holds a file {name} that fecolumn did not write; move it away or give "
                "another folder",
            )


def _remove(folder: Path, name: str) -> None:
    """Remove a file that fecolumn wrote, and the folders within `folder` that are empty then."""
    with contextlib.suppress(OSError):
        os.unlink(folder / name)
        for parent in PurePosixPath(name).parents[:-1]:
            os.rmdir(folder / parent)
