"""Files that a user names, read whatever they turn out to be: devices, pipes, folders, files
without end, names that cannot be.
"""

from __future__ import annotations

import codecs
import json
import os
import re
import stat
from pathlib import Path
from typing import Any, NoReturn

# More than any motion of a day at 1 kHz, or any table, has; what is larger was named by mistake
_MOST_BYTES = 500_000_000


class Unreadable(ValueError):
    """A file cannot be read; the message says why, without its name."""


def is_file(path: Path | str) -> bool:
    """Whether there is a file of that name; a name that no file system takes is none."""
    try:
        return Path(path).is_file()
    except (OSError, ValueError):
        return False


def read_bytes(path: Path | str, most: int = _MOST_BYTES) -> bytes:
    """Content of a regular file of at most `most` bytes; neither a device nor a pipe can hold the
    reader up.

    Raises
    ------
    Unreadable
        no such file, a folder, a device, a pipe, too large, or not to be read by this user.
    """
    try:
        with open(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb") as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise Unreadable("is a device or a pipe; a file is needed")
            if status.st_size > most:
                raise Unreadable(
                    f"is too large ({status.st_size / 1e6:.0f} MB, at most {most / 1e6:g} MB)"
                )
            return file.read()
    except (FileNotFoundError, NotADirectoryError):
        raise Unreadable("no such file") from None
    except IsADirectoryError:
        raise Unreadable("is a directory; a file is needed") from None
    except PermissionError:
        raise Unreadable("may not be read (permission denied)") from None
    except OSError as error:
        raise Unreadable(f"cannot be read ({error.strerror})") from None
    except UnicodeEncodeError:
        raise Unreadable("cannot be read (a name that this locale cannot write)") from None
    except Unreadable:
        raise
    except ValueError:
        raise Unreadable("no such file (its name holds a null character)") from None


def read_json(path: Path | str, most: int = _MOST_BYTES) -> Any:
    """What a JSON file holds; numbers that are none (NaN, Infinity) are refused.

    Raises
    ------
    Unreadable
        as `read_bytes`, or not valid JSON.
    """
    content = read_bytes(path, most)
    try:
        return json.loads(content, parse_constant=_no_number)
    except RecursionError:
        raise Unreadable("is damaged: nested too deeply") from None
    except ValueError as error:
        raise Unreadable(f"is damaged: not valid JSON ({error})") from None


def _no_number(word: str) -> NoReturn:
    raise ValueError(f"{word} is no number")


def read_any_text(path: Path | str) -> str:
    """Text of a file in UTF-8 or, with its mark, UTF-16, as programs for tables write them, else in
    Latin-1, as in older headers; without byte order mark.

    Raises
    ------
    Unreadable
        as of `read_bytes`, or not text: it holds control characters.
    """
    data = read_bytes(path).rstrip(b"\x1a")  # DOS marked the end of a text so
    wide = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    for encoding in ("utf-16",) if wide else ("utf-8-sig", "latin-1"):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if not re.search(r"[\x00-\x08\x0e-\x1f\x7f]", text):
            return text
        break
    raise Unreadable("is not a text file (it holds control characters)")
