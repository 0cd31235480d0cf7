"""Motions of an ensemble that one text names: ensemble.h5#*, lick:1-40."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from fecolumn.foundation.schema import InputError
from fecolumn.motions import lick
from fecolumn.motions.ensemble_file import ALL_MOTIONS, file_and_number, members
from fecolumn.motions.record import UnusableRecord

_SPAN = re.compile(r"([0-9]{1,6})-([0-9]{1,6})")  # of motions, both ends included


def chosen_motions(source: Any, key: str, file: Path | str) -> list[Any]:
    """Every motion of ensemble.h5#* or lick:*, those of lick:1-40 or ensemble.h5#1-40; any other
    value as it is.

    Parameters
    ----------
    source
        as in motion.source.
    key
        that it stands under, for messages.
    file
        that states it; relative paths are taken from its folder.

    Raises
    ------
    InputError
        no such ensemble or numbers.
    """
    if not isinstance(source, str):
        return [source]
    if source.startswith(lick.LICK_PREFIX):
        place, mark, wanted = "", lick.LICK_PREFIX, source.removeprefix(lick.LICK_PREFIX)
    else:
        place, wanted = file_and_number(source) or ("", "")
        mark = f"{place}#"
    span = _SPAN.fullmatch(wanted)
    if wanted != ALL_MOTIONS and not span:
        return [source]
    try:
        count = (
            len(members(str(Path(file).resolve().parent / f"{place}#{ALL_MOTIONS}")))
            if place
            else lick.COUNT
        )
    except UnusableRecord as error:
        raise InputError(file, key, source, str(error)) from None
    first, last = map(int, span.groups()) if span else (1, count)
    if not 1 <= first <= last <= count:
        raise InputError(file, key, source, f"must be two rising numbers from 1 to {count}")
    return [f"{mark}{number}" for number in range(first, last + 1)]
