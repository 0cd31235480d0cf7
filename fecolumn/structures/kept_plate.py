"""An elastic plate on disk: each of its files is checked by its digest before it is used, and what
does not fit is made anew.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.contact.known_base import KnownBase, keep_base
from fecolumn.foundation.digests import intact, note
from fecolumn.foundation.lock import alone

if TYPE_CHECKING:
    from fecolumn.contact.base_plate import BasePlate


class KeptPlate(KnownBase):
    """`contact.known_base.KnownBase` whose files are checked."""

    def _open(self, reach: int) -> None:
        if not intact(self._folder, *_names(reach)):
            with alone(self._folder):
                if not intact(self._folder, *_names(reach)):
                    damaged = self._folder / _names(reach)[1]
                    warnings.warn(f"{damaged} is damaged, and made anew", stacklevel=2)
                    self._extend(reach)
        super()._open(reach)

    def _extend(self, reach: int) -> None:
        super()._extend(reach)
        note(self._folder, *_names(reach))


def _names(reach: int) -> tuple[str, str]:
    """Files of what is known of a plate as far as a reach."""
    return f"known-{reach}.npy", f"compliance-{reach}.npy"


def plate_is_kept(folder: Path) -> bool:
    """Whether a plate is on disk as it was written, as far as its first reach."""
    return intact(folder, "base.npz", *_names(0))


def keep_plate(folder: Path, base: dict[str, ArrayLike], plate: BasePlate) -> None:
    """Write a plate and what is known of it, all at once.

    Parameters
    ----------
    base
        arrays and numbers of base.npz by name.
    plate
        `contact.base_plate.BasePlate`.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    partial = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    partial.chmod(0o755)
    try:
        with open(partial / "base.npz", "wb") as file:
            np.savez(file, **base)
        keep_base(plate, lambda name: partial / f"{name}-0.npy")
        note(partial, "base.npz", *_names(0))
        os.replace(partial, folder)
    finally:
        shutil.rmtree(partial, ignore_errors=True)
