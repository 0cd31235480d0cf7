"""Ground motions of a study's analyses and their intensities, from the cases they were run with."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.sections import Motion
from fecolumn.foundation.schema import InputError, build
from fecolumn.motions.record import GroundMotion
from fecolumn.study.report.notation import count
from fecolumn.study.report.sweep import Setting, read_tables

SCALE = "motion.scale"
# What a reader of the motions may meet where they are not to be found any more, or never were
NOT_FOUND = (InputError, OSError, ValueError, KeyError, TypeError)


@dataclass(frozen=True, slots=True)
class Runs:
    """n runs and the intensity of their motions, which is above 0.

    Attributes
    ----------
    measures
        (n, 2) PGV [m/s] and PGA [m/s2].
    motion
        (n,) name of the motion, whatever its scale.
    record
        (n,) its file, whatever its scale and direction, see `plan.record_of`.
    reversed
        (n,) bool, whether its scale is below 0.
    u_max
        (n,) [m]; of no meaning where the column was lost.
    lost
        (n,) bool, overturned or slid off its base.
    overturned
        (n,) bool.
    """

    measures: NDArray[Any]
    motion: NDArray[Any]
    record: NDArray[Any]
    reversed: NDArray[Any]
    u_max: NDArray[Any]
    lost: NDArray[Any]
    overturned: NDArray[Any]


class Intensities:
    """Reader of motions and of their peak values, which it keeps.

    Parameters
    ----------
    folder
        of the study.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._known: dict[Motion, tuple[float, float]] = {}

    def motion(self, run: dict[str, Any]) -> GroundMotion:
        """Ground motion of an analysis as applied, at its own step.

        Raises
        ------
        One of NOT_FOUND: the motion is not to be found.
        """
        from fecolumn.motions.load import unsampled

        return unsampled(*self._table(run))

    def peaks(self, run: dict[str, Any]) -> tuple[float, float]:
        """PGV [m/s] and PGA [m/s2] of the motion of an analysis, RotD50.

        Raises
        ------
        One of NOT_FOUND: the motion is not to be found.
        """
        from fecolumn.motions.intensity import peak_values
        from fecolumn.motions.load import unsampled

        motion, folder = self._table(run)
        scale, unscaled = (
            abs(motion.scale),
            dataclasses.replace(motion, scale=1.0, free_vibration_s=0.0, delay_s=0.0),
        )
        if unscaled not in self._known:
            pga, pgv, _ = peak_values(unsampled(unscaled, folder))
            self._known[unscaled] = pgv, pga
        pgv, pga = self._known[unscaled]
        return scale * pgv, scale * pga

    def of_runs(self, settings: Sequence[Setting]) -> Runs:
        """All runs of settings whose motions have an intensity, which those at scale 0 have not.

        Raises
        ------
        One of NOT_FOUND: a motion is not to be found.
        """
        runs = [(name, run) for setting in settings for name, run in setting.runs.items()]
        u, lost = (
            np.concatenate(values) for values in zip(*(setting.peaks() for setting in settings))
        )
        measures = np.array([self.peaks(run) for _, run in runs])
        kept = (measures > 0).all(axis=1)
        return Runs(
            measures[kept],
            np.array([name for name, _ in runs])[kept],
            np.array([record for one in settings for record in one.records_of()])[kept],
            np.array([one.values.get(SCALE, 1.0) < 0 for one in settings for _ in one.runs])[kept],
            u[kept],
            lost[kept],
            np.concatenate([one.column("overturned").astype(bool) for one in settings])[kept],
        )

    def _table(self, run: dict[str, Any]) -> tuple[Motion, Path]:
        folder = self._folder / "analyses" / run["case_id"]
        return build(Motion, read_tables(folder)["motion"], folder), folder


def without_intensity(settings: Iterable[Setting], runs: Iterable[Runs]) -> str:
    """A sentence on the runs of settings that are left out of `runs`, as their motions have no
    intensity; "" of none.
    """
    left = sum(len(one.runs) for one in settings) - sum(one.motion.size for one in runs)
    if not left:
        return ""
    return f"{count(left, 'run')} of motions without intensity, at scale 0, are left out. "


def across_scales(settings: Iterable[Setting]) -> list[tuple[dict[str, Any], list[Setting]]]:
    """Settings that differ in the scale of their motions alone, with what they have in common."""
    groups: dict[str, tuple[dict[str, Any], list[Setting]]] = {}
    for setting in settings:
        values = {key: value for key, value in setting.values.items() if key != SCALE}
        groups.setdefault(repr(values), (values, []))[1].append(setting)
    return list(groups.values())
