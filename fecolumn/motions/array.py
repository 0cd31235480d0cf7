"""A ground motion from an array of a script."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.foundation.atomic import write_csv
from fecolumn.foundation.schema import InputError
from fecolumn.motions.record import STEPS_S, GroundMotion, UnusableRecord, sound


def motion_file(path: Path | str, acceleration: ArrayLike, dt_s: float) -> str:
    """Write an array of accelerations as a CSV file that `motion.source` takes; its path.

    Parameters
    ----------
    path
        of the file; an earlier one is overwritten.
    acceleration
        (n,) along x, or (n, 2) or (n, 3) along x, y, z [m/s2].
    dt_s
        sampling step [s].

    Raises
    ------
    InputError
        an array of another shape, with fewer than two samples, or with values or a step that are
        no ground motion's.
    """
    path = Path(path)
    try:
        values = np.array(acceleration, float)
    except (TypeError, ValueError):
        told = "must be numbers of shape (n,), (n, 2) or (n, 3): all rows of one length"
        raise InputError(path, "acceleration", None, told) from None
    values = values[:, None] if values.ndim == 1 else values
    if values.ndim != 2 or values.shape[1] not in (1, 2, 3) or len(values) < 2:
        raise InputError(
            path,
            "acceleration",
            None,
            f"has shape {np.shape(acceleration)}; must be (n,), (n, 2) or (n, 3) with n "
            "of at least 2",
        )
    if not STEPS_S[0] <= dt_s <= STEPS_S[1]:
        low, high = STEPS_S
        raise InputError(path, "dt_s", dt_s, f"must lie in [{low:g}, {high:g}] s")
    whole = np.zeros((len(values), 3))
    whole[:, : values.shape[1]] = values
    try:
        sound(GroundMotion(whole, float(dt_s), path.name, str(path)))
    except UnusableRecord as error:
        raise InputError(path, "acceleration", None, str(error)) from None
    header = ["time [s]", *(f"a{axis} [m/s2]" for axis in "xyz"[: values.shape[1]])]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_csv(
        path,
        [header, *([f"{k * dt_s:.12g}", *map(repr, row)] for k, row in enumerate(values.tolist()))],
    )
    return str(path.resolve())
