"""Names of earlier versions that are still read, each said once."""

from __future__ import annotations

import functools
import warnings

#: what each warning has, by which `fecolumn` shows it although Python hides its category
TOLD = "is an older name"


@functools.cache
def warn_of_older_name(where: str, older: str, newer: str) -> None:
    """Tell once in a process, by a DeprecationWarning, that a name is read until version 2.0 only,
    and which one to write.

    Parameters
    ----------
    where
        file or call in which it stands.
    older, newer
        the two names.
    """
    told = f"{where}: {older} {TOLD} of {newer}, read until 2.0; write {newer}"
    warnings.warn(told, DeprecationWarning, stacklevel=3)
