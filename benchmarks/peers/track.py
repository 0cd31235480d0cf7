"""What every peer writes as it steps, and what is read from it, in the same way for all.

A track is a text file with a line a step, the first at release: time [s]; lean [rad], towards +x;
displacement along x of the rim's ends at +x and -x [m]; kinetic, strain and gravity energy above
standing [J], nan if the peer does not tell; CPU time of all steps so far [s]; iterations of the
step; 1 if it converged.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

# After an impact, until the elastic column has come to rest on its new toe; and steps before the
# next one that may belong to it
SETTLING_S, LEAVING_S = 0.010, 0.003


def write_rows(path: Path, rows) -> None:
    """Write a track line by line, so that what was done remains if the program is ended."""
    with open(path, "w", buffering=1) as track:
        for row in rows:
            track.write(",".join(f"{value:.12g}" for value in row) + "\n")


@dataclass(frozen=True, slots=True)
class Track:
    """Columns (n,) of a track, as the module says."""

    time: np.ndarray
    lean: np.ndarray
    right: np.ndarray
    left: np.ndarray
    energy: np.ndarray
    cpu: np.ndarray
    iterations: np.ndarray
    converged: np.ndarray

    @property
    def crossings(self) -> np.ndarray:
        """Last rows before the column passes its upright position."""
        return np.flatnonzero(self.lean[1:] * self.lean[:-1] < 0)

    @property
    def impacts(self) -> np.ndarray:
        """Times at which the column is upright [s], linear between steps."""
        k = self.crossings
        return self.time[k] + (self.time[k + 1] - self.time[k]) * self.lean[k] / (
            self.lean[k] - self.lean[k + 1]
        )

    @property
    def creep(self) -> float:
        """Farthest that the toe moves from where it stood, while the column turns about it and no
        slip is due [m]; nan if never seen.

        Without the first moments after release and impacts, in which it may slip or swing.
        """
        ends = [0.0, *self.impacts, self.time[-1] + LEAVING_S]
        worst = []
        for start, end in zip(ends[:-1], ends[1:]):
            inside = np.flatnonzero(
                (self.time >= start + SETTLING_S) & (self.time <= end - LEAVING_S)
            )
            if len(inside) > 1:
                toe = (self.right if self.lean[inside[0]] > 0 else self.left)[inside]
                worst.append(np.abs(toe - toe[0]).max())
        return max(worst, default=np.nan)

    @property
    def kept(self) -> float:
        """Energy after the first impact over that at release [-]: mean from 5 to 15 ms after it;
        nan if not seen.
        """
        if not len(self.impacts):
            return np.nan
        since = self.time - self.impacts[0]
        after = self.energy[(since > 0.005) & (since < 0.015)]
        return float(after.mean() / self.energy[0]) if len(after) and since[-1] > 0.015 else np.nan

    @property
    def steps(self) -> int:
        """Steps between the first and the last line."""
        return len(self.time) - 1

    @property
    def cpu_per_step(self) -> float:
        """[s]; nan without steps."""
        return float((self.cpu[-1] - self.cpu[0]) / self.steps) if self.steps > 0 else np.nan


def read_track(path: Path) -> Track | None:
    """Track of a file; None where there is none or nothing in it.

    A line that was being written is left out.
    """
    if not path.is_file():
        return None
    rows = [line.split(",") for line in path.read_text().split("\n")[:-1]]
    rows = np.array([row for row in rows if len(row) == 8], float)
    return Track(*rows.T) if len(rows) else None
