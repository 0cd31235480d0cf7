"""Fields that an analysis wrote, frame by frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.engines.scene.frame_files import time_of_frame
from fecolumn.engines.scene.scene import Scene
from fecolumn.engines.stored import stored
from fecolumn.foundation.schema import InputError
from fecolumn.pictures.render.frame import Fields


class FrameSeries:
    """Instants at which fields are known: read(k) gives the Fields of one.

    Attributes
    ----------
    time
        (n,) [s], rising.
    """

    def __init__(self, time: np.ndarray) -> None:
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
    """The frames in a folder that `scene.fields.FieldWriter` filled; one is in memory at a time.

    Attributes
    ----------
    files
        of the frames; time: (n,) [s] of each, rising. points: (n_points, 3) [m] of all pieces.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.files = sorted(folder.glob("frame_*.h5"))
        super().__init__(np.array([time_of_frame(file) for file in self.files]))
        self.points = _read(folder / "mesh.h5", "points")[0] if self.files else np.empty((0, 3))

    def check(self, scene: Scene) -> None:
        """Raises:
        InputError: there are fields, and they are on another mesh than that of the scene.
        """
        if self.files and not (
            scene.points.shape == self.points.shape
            and np.allclose(scene.points, self.points, rtol=0, atol=1e-6 * scene.height)
        ):
            raise InputError(
                self.folder,
                "",
                None,
                "is of another mesh than that of the case made now; render with the "
                "version that made it, or remove this folder",
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

    def read() -> list[np.ndarray]:
        with h5py.File(file) as content:
            return [content[name][()] for name in names]

    return stored(file, "a frame of an analysis' fields", read)
