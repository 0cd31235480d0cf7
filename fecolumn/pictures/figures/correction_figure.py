"""A record before and after its correction."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.motions.processing import integrate
from fecolumn.motions.record import GroundMotion
from fecolumn.pictures.figures.style import (
    BLUE,
    PAGE_WIDTH_IN,
    VERMILION,
    new_figure,
    save,
    styled,
)

_ROWS = (("$a$ [g]", 1 / GRAVITY), ("$v$ [cm/s]", 100.0), ("$d$ [cm]", 100.0))


def correction_figure(before: GroundMotion, after: GroundMotion, folder: Path | str) -> list[Path]:
    """Write acceleration, velocity and displacement of both, a component a column, and the Fourier
    amplitudes below, as correction.png and .pdf.
    """
    axes = [axis for axis in range(3) if before.acceleration[:, axis].any()] or [0]
    # what the filter's padding put before the record
    led = max(0, (len(after.acceleration) - len(before.acceleration)) // 2) * after.dt
    with styled():
        figure = new_figure(PAGE_WIDTH_IN, 5.6)
        grid = figure.subplots(4, len(axes), squeeze=False)
        for motion, label, color, shift in (
            (before, "before", VERMILION, 0.0),
            (after, "after", BLUE, led),
        ):
            histories = (motion.acceleration, *integrate(motion))
            time = motion.dt * np.arange(len(motion.acceleration)) - shift
            frequency = np.fft.rfftfreq(len(time), motion.dt)[1:]
            for column, axis in enumerate(axes):
                for row, ((unit, factor), history) in enumerate(zip(_ROWS, histories)):
                    grid[row, column].plot(
                        time, factor * history[:, axis], color=color, label=label, linewidth=0.7
                    )
                    if not column:
                        grid[row, column].set_ylabel(unit)
                amplitude = np.abs(np.fft.rfft(motion.acceleration[:, axis]))[1:] * motion.dt
                grid[3, column].loglog(
                    frequency, np.maximum(amplitude, 1e-12), color=color, linewidth=0.7
                )
                grid[0, column].set_title(f"along {'xyz'[axis]}")
                grid[2, column].set_xlabel("time [s]")
                grid[3, column].set_xlabel("frequency [Hz]")
                grid[3, column].set_ylim(
                    bottom=max(1e-6 * amplitude.max(), 1e-12) if amplitude.any() else None
                )
        grid[3, 0].set_ylabel("Fourier amplitude [m/s]")
        grid[0, 0].legend()
        return save(figure, Path(folder) / "correction")
