"""One analysis of a case with a rocking model: the result files of any analysis, from a response
instead of steps.
"""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.case.case import Case
from fecolumn.engines.analysis import Analysis
from fecolumn.engines.ending import OVERTURNED, Ending
from fecolumn.engines.followed import first_still, until
from fecolumn.engines.rocking.body_motion import body_motion
from fecolumn.engines.rocking.model import STATE_TERMS, ModelResponse
from fecolumn.engines.rocking.of_bodies import ALONG_X, model_of, start_of
from fecolumn.foundation.arrays import Array
from fecolumn.motions.record import GroundMotion

if TYPE_CHECKING:
    from mpi4py import MPI


class ModelAnalysis(Analysis):
    """An analysis whose engine is a rocking model, of a table of its own or of the case's column.

    It takes milliseconds, has no checkpoint and is made again where it was stopped.
    """

    def __init__(
        self, case: Case, folder: Path, comm: MPI.Intracomm, file: str, quiet: bool
    ) -> None:
        super().__init__(case, folder, comm, file, quiet)
        self.model, self.start = model_of(case, file), start_of(case, file)
        self.model.respond(
            GroundMotion(np.zeros((2, 3)), 1e-3, "", "")
        )  # compiles what is missing on this machine
        self.began, self.cpu_began = time.perf_counter(), time.process_time()

    @property
    def barrier_j(self) -> float:
        """As of Analysis, of the model."""
        return self.model.energy_to_overturn

    def energy_left(self) -> float:
        """Mechanical energy of the last sample [J]: kinetic, strain and gravity energy together.

        Gravity and strain energy of a rocking model count from the upright structure at rest, so
        that the sum is the energy above equilibrium. Rounding below 0 is told as 0.
        """
        last = self.history.last()
        return max(0.0, float(sum(last[f"energy/{name}"] for name in STATE_TERMS)))

    def limits(self) -> dict[str, float]:
        """As of Analysis, of the model."""
        return dict(
            critical_tilt_rad=self.model.critical_tilt,
            u_critical_m=self.model.critical_displacement,
        )

    def run(self, stop: Callable[[], bool]) -> dict[str, Any]:
        """The whole response; its summary. `stop` is not asked."""
        dt, initial = float(self.case.integration.dt_s), self.start
        motion, free_s = until(self.motion, self.steps, dt)
        samples = motion.acceleration
        response = self.model.respond(
            motion,
            free_s=free_s,
            tilt=initial.tilt_rad,
            direction=math.radians(initial.direction_deg),
        )
        notes = (*response.notes, *self._left_out(samples))
        for note in notes:
            warnings.warn(f"{self.file}: {note}", stacklevel=2)
        rows, ending = self._end(response)
        self.step = rows - 1
        ground = np.zeros((rows, 3))
        ground[: min(rows, len(samples))] = samples[:rows]
        columns = dict(
            time=response.time[:rows],
            u_top=response.u_top[:rows],
            tilt=response.tilt[:rows],
            twist=np.zeros(rows),
            slide=np.zeros((rows, 2)),
            ground=ground,
        )
        columns |= {f"model/{name}": values[:rows] for name, values in response.coordinates.items()}
        bodies = body_motion(self.case, response, self.file)
        columns |= {name: values[:rows] for name, values in bodies.items()}
        self.history.extend(
            columns
            | {
                f"energy/{name}": values[:rows]
                for name, values in self._energy(response, rows).items()
            }
        )
        self.stepping_s = time.perf_counter() - self.began
        times, end = response.impact_times, self.history.last()["time"]
        more = dict(impacts=int((times <= end).sum()), notes=list(notes), peaks=response.peaks)
        return self.write_results(ending, len(response.coordinates), more)

    def _left_out(self, samples: Array) -> list[str]:
        """Sentences on what of a motion (n, 3) [m/s2] does nothing to the model."""
        engine, across = self.case.integration.engine, float(np.abs(samples[:, 1]).max())
        if engine not in ALONG_X or self.case.own or not across:
            return []
        return [
            f"integration.engine = {engine!r} rocks along x alone: the motion along y, of up to "
            f"{across:.3g} m/s2, does nothing to it"
        ]

    def _energy(self, response: ModelResponse, rows: int) -> dict[str, Array]:
        """All terms of the ledger; those that a model has not are 0."""
        from fecolumn.engines.dynamics.energy import TERMS

        return {
            name: response.energy.get(name, np.zeros(len(response.time)))[:rows] for name in TERMS
        }

    def _end(self, response: ModelResponse) -> tuple[int, Ending]:
        """Rows of the response that are of the analysis, and how it ends."""
        cap, last = self.case.overturn.displacement_m, min(self.steps + 1, len(response.time))
        capped = (
            np.flatnonzero(np.hypot(response.u_top[:last, 0], response.u_top[:last, 1]) >= cap)
            if cap
            else np.array([], int)
        )
        if len(capped):
            return int(capped[0]) + 1, Ending(
                OVERTURNED,
                f"top displacement reached overturn.displacement_m = {cap:g} m, at "
                f"{response.time[capped[0]]:.3f} s",
            )
        if response.overturned:
            critical = self.model.critical_tilt
            back = np.flatnonzero(response.tilt <= critical)
            lost = min(int(back[-1]) + 1 if len(back) else 0, len(response.time) - 1)
            if lost < last:
                return lost + 1, Ending(
                    OVERTURNED,
                    f"point of no return: tilt {response.tilt[lost]:.3g} rad, critical "
                    f"{critical:.3g} rad, at {response.time[lost]:.3f} s",
                )
        kinetic, strain, gravity = (response.energy[name] for name in STATE_TERMS)
        energy = kinetic + strain + gravity
        if self.until_rest:
            still = first_still(energy[:last], self.still_j, self.motion_steps)
            if still is not None:
                return still + 1, self.ending_in_time(True, float(response.time[still]))
        is_still = bool(energy[last - 1] <= self.still_j)
        return last, self.ending_in_time(is_still, float(response.time[last - 1]))
