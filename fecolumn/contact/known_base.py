"""The compliance of a plate's top on disk: found once as far as feet reach, opened in milliseconds
by every analysis on the same plate.

    base.npz          top of the plate
    known-R.npy       (k,) nodes of the top within reach R of the feet
    compliance-R.npy  (k, 3, k, 3) of these nodes, read through the operating system's page cache,
        which all workers share
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.contact.base_top import BaseTop
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.atomic import write_file
from fecolumn.foundation.lock import alone

if TYPE_CHECKING:
    from fecolumn.contact.base_plate import BasePlate

#: Least reach of the first compliance around a foot, over the foot's width.
LEAST_REACH = 0.1


class KnownBase:
    """The base plate as far as its compliance is known: under the foot and the slide allowance,
    twice as far around, four times ...

    How far it is known depends on where the column went, its numbers do not: each reach is found
    once as a whole, and kept on disk.

    Attributes as of `contact.base_plate.BasePlate`: grid, slot, compliance (blocks), frequency.
    dofs: of its mesh. made_s, made_cpu_s: wall and processor time spent on reaches that no analysis
    had needed before [s].
    """

    def __init__(self, folder: Path, make: Callable[..., Any]) -> None:
        self._folder, self._make, self.made_s, self.made_cpu_s = folder, make, 0.0, 0.0
        with np.load(folder / "base.npz") as file:
            self.grid, self.frequency, self.dofs = (
                BaseTop(file["points"]),
                float(file["frequency"]),
                int(file["dofs"]),
            )
            self._allowance = float(file["allowance"])
            # of several feet the first place of each
            self._feet = np.split(
                file["foot"], file["firsts"][1:] if "firsts" in file.files else []
            )
        self._open(0)

    def need(self, wanted: Array) -> None:
        """Make sure that the compliance holds the top nodes `wanted`; a reach that no analysis
        needed before takes seconds.
        """
        while (self.slot[wanted] < 0).any():
            reach = self._reach + 1
            if not self._file("known", reach).is_file():
                began, cpu_began = time.perf_counter(), time.process_time()
                with alone(self._folder):
                    if not self._file("known", reach).is_file():
                        self._extend(reach)
                self.made_s += time.perf_counter() - began
                self.made_cpu_s += time.process_time() - cpu_began
            self._open(reach)

    def _file(self, name: str, reach: int) -> Path:
        return self._folder / f"{name}-{reach}.npy"

    def _open(self, reach: int) -> None:
        known = np.load(self._file("known", reach))
        # copy on write: compiled code wants arrays that may be written to
        self.compliance = (
            np.load(self._file("compliance", reach), mmap_mode="c")
            .view(np.ndarray)
            .transpose(0, 2, 1, 3)
        )
        self.slot = np.full(len(self.grid.points), -1, np.int64)
        self.slot[known] = np.arange(len(known))
        self._known, self._reach = known, reach

    def _extend(self, reach: int) -> None:
        plate = self._make()
        if not np.allclose(plate.grid.points, self.grid.points):
            raise RuntimeError(
                f"{self._folder}: the base has other nodes than the mesh made now; "
                "delete this folder"
            )
        plate.adopt(self._known, self.compliance)
        plate.need(under(self.grid.points, self._feet, self._allowance * 2**reach))
        keep_base(plate, lambda name: self._file(name, reach))


def keep_base(plate: BasePlate, file: Callable[..., Any]) -> None:
    """Write what is known of a plate; `known` comes last and says that all is there."""
    for name, values in (
        ("compliance", np.ascontiguousarray(plate.compliance.transpose(0, 2, 1, 3))),
        ("known", plate.known),
    ):
        write_file(file(name), functools.partial(np.save, arr=values))


def under(points: Array, feet: list[Array], allowance: float) -> Array:
    """Top nodes (k,) that feet, each at (n, 3) [m], may press when they slide by `allowance` [m] to
    any side.
    """
    found = np.zeros(len(points), bool)
    for foot in feet:
        middle = (foot[:, :2].min(axis=0) + foot[:, :2].max(axis=0)) / 2
        place, own = points[:, :2] - middle, foot[:, :2] - middle
        cell = max(
            np.diff(lines[np.abs(lines) <= np.abs(own).max() + allowance]).max()
            for lines in (np.unique(np.round(place[:, axis], 12)) for axis in (0, 1))
        )
        radius = np.linalg.norm(own, axis=1)
        distance, reach = np.linalg.norm(place, axis=1), allowance + 1.5 * cell
        found |= (distance <= radius.max() + reach) & (distance >= radius.min() - reach)
    return np.flatnonzero(found)
