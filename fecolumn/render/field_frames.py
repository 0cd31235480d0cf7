"""Fields that an analysis wrote, frame by frame."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fecolumn.render.solid import Solid
from fecolumn.schema import InputError


@dataclass(frozen=True, slots=True)
class Fields:
    """Displacement (n_points, 3) [m], von Mises stress (n_cells,) [Pa] and contact pressure
    (n_points,) [Pa] of column and base, in the order of the mesh.
    """

    displacement: np.ndarray
    stress: np.ndarray
    pressure: np.ndarray


class FrameSeries:
    """Instants at which fields are known: read(k) gives the Fields of one.

    Attributes
    ----------
    time
        (n,) [s], rising.
    """

    def __init__(self, time: np.ndarray):
        self.time = time

    @property
    def interval(self) -> float:
        """Longest time between two frames [s]; inf of fewer than two."""
        return float(np.diff(self.time).max()) if len(self.time) > 1 else np.inf

    def nearest(self, times: np.ndarray) -> np.ndarray:
        """Number (k,) of the frame nearest to each of `times` [s]."""
        middle = (self.time[1:] + self.time[:-1]) / 2
        return np.searchsorted(middle, times)


class FieldFrames(FrameSeries):
    """The frames in a folder that `post.fields.FieldWriter` filled; one is in memory at a time.

    Attributes
    ----------
    files
        of the frames; time: (n,) [s] of each, rising. points: (n_points, 3) [m] of column and base.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        self.files = sorted(folder.glob("frame_*.h5"))
        super().__init__(np.array([int(file.stem.partition("_")[2]) / 1e6 for file in self.files]))
        self.points = _read(folder / "mesh.h5", "points")[0] if self.files else np.empty((0, 3))

    def fits(self, solid: Solid) -> bool:
        """Whether the fields are on the mesh of `solid`."""
        points = np.vstack([solid.mesh.body.points, solid.mesh.base.points])
        return points.shape == self.points.shape and np.allclose(
            points, self.points, rtol=0, atol=1e-6 * solid.height
        )

    def read(self, k: int) -> Fields:
        """Frame `k`.

        Raises
        ------
        InputError
            its file is damaged.
        """
        return Fields(*_read(self.files[k], "displacement", "von_mises", "pressure"))


def _read(file: Path, *names: str) -> list[np.ndarray]:
    import h5py

    try:
        with h5py.File(file) as content:
            return [content[name][()] for name in names]
    except (OSError, KeyError) as error:
        raise InputError(file, "", None, f"not a frame of an analysis' fields ({error})") from None
