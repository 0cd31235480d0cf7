"""Records: rows of arrays with named fields, read alike by compiled code and by plain Python."""

from __future__ import annotations

import numpy as np


def record(*fields: tuple[int | str | tuple[int, ...], ...]) -> np.dtype:
    """Data type of rows whose fields (name, type[, shape]) are attributes: of an array of it,
    `rows[i].name`.

    A compiled function takes such an array as one argument, where as many arrays as fields would
    make its compilation several times as long.
    """
    return np.dtype((np.record, np.dtype(list(fields), align=True)))
