"""One analysis of a case with a rocking model: the result files of any analysis, from a response
instead of steps.
"""

from __future__ import annotations

import math
import time
import warnings

import numpy as np

from fecolumn.engines.analysis import CHECKPOINT, Analysis, energy_closure
from fecolumn.engines.ending import AT_REST, OVERTURNED, REST_SHARE, STILL_ROCKING, Ending
from fecolumn.engines.rocking.model import ModelResponse
from fecolumn.engines.rocking.of_bodies import model_of, start_of
from fecolumn.engines.summary import write_sealed
from fecolumn.motions.record import GroundMotion


class ModelAnalysis(Analysis):
    """An analysis whose engine is a rocking model, of a table of its own or of the case's column.

    It takes milliseconds, has no checkpoint and is made again where it was stopped.
    """

    def __init__(self, case, folder, comm, file, quiet):
        super().__init__(case, folder, comm, file, quiet)
        self.file = file
        self.model, self.start = model_of(case, file), start_of(case, file)
        self.model.respond(
            GroundMotion(np.zeros((2, 3)), 1e-3, "", "")
        )  # compiles what is missing on this machine
        self.began, self.cpu_began = time.perf_counter(), time.process_time()

    @property
    def rest_j(self) -> float:
        """As of Analysis, of the model's own barrier; upright its energy is 0."""
        return REST_SHARE * self.model.energy_to_overturn if self.until_rest else -math.inf

    def run(self, stop) -> dict:
        """The whole response; its summary. `stop` is not asked."""
        dt, initial = self.case.integration.dt_s, self.start
        samples = (
            np.zeros((2, 3)) if self.motion is None else self.motion.acceleration[: self.steps + 1]
        )
        motion = GroundMotion(samples, dt, self.motion.name if self.motion else "", "")
        response = self.model.respond(
            motion,
            free_s=max(0.0, self.steps * dt - motion.duration),
            tilt=initial.tilt_rad,
            direction=math.radians(initial.direction_deg),
        )
        for note in response.notes:
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
        columns |= {name: values[:rows] for name, values in response.coordinates.items()}
        self.history.extend(
            columns
            | {
                f"energy/{name}": values[:rows]
                for name, values in self._energy(response, rows).items()
            }
        )
        self.stepping_s = time.perf_counter() - self.began
        return self._summary(response, ending)

    def _energy(self, response: ModelResponse, rows: int) -> dict[str, np.ndarray]:
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
            else []
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
        energy = sum(response.energy[name] for name in ("kinetic", "strain", "gravity"))
        if self.until_rest:
            still = np.flatnonzero(
                (energy[:last] <= self.rest_j) & (np.arange(last) >= self.motion_steps)
            )
            if len(still):
                end = response.time[still[0]]
                return int(still[0]) + 1, Ending(
                    AT_REST,
                    "at rest "
                    f"{end - self.motion_steps * self.case.integration.dt_s:.3f} s "
                    f"after the motion's end, at {end:.3f} s",
                )
        outcome = (
            AT_REST
            if energy[last - 1] <= REST_SHARE * self.model.energy_to_overturn
            else STILL_ROCKING
        )
        return last, Ending(outcome, f"end of the analysed time, {response.time[last - 1]:.3f} s")

    def _summary(self, response: ModelResponse, ending: Ending) -> dict:
        rows, plan, overturned = (
            self.history.arrays(),
            self.case.integration,
            ending.outcome == OVERTURNED,
        )
        end, fall = float(rows["time"][-1]), rows["u_top"][-1]
        left = max(
            0.0, float(sum(rows[f"energy/{name}"][-1] for name in ("kinetic", "strain", "gravity")))
        )
        summary = dict(
            case_id=self.case.id,
            title=self.case.title,
            **self.code,
            engine=plan.engine,
            dofs=len(response.coordinates),
            steps=self.step,
            dt=plan.dt_s,
            motion=self.motion.name if self.motion else "",
            duration_s=end,
            motion_cut_at_s=self.cut_at_s,
            outcome=ending.outcome,
            ended_by=ending.ended_by,
            u_max_m=float(np.hypot(rows["u_top"][:, 0], rows["u_top"][:, 1]).max()),
            u_max_censored=overturned,
            overturned=overturned,
            overturn_time_s=end if overturned else None,
            overturn_direction_deg=float(np.degrees(np.arctan2(fall[1], fall[0])))
            if overturned
            else None,
            slid_off=False,
            slid_off_time_s=None,
            slid_off_direction_deg=None,
            critical_tilt_rad=self.model.critical_tilt,
            u_critical_m=self.model.critical_displacement,
            energy_left_j=None if overturned else left,
            energy_to_overturn_j=self.model.energy_to_overturn,
            tilt_max_rad=float(rows["tilt"].max()),
            residual_slide_m=0.0,
            ranks=self.comm.size,
            wall_s=time.perf_counter() - self.began,
            cpu_s=self.cpu_s,
            s_per_step=self.stepping_s / max(self.step, 1),
            impacts=int((response.impact_times <= end).sum()),
            energy_closure_rel=energy_closure(rows),
            energy_j={
                name.partition("/")[2]: float(values[-1])
                for name, values in rows.items()
                if name.startswith("energy/")
            },
            notes=list(response.notes),
            peaks=response.peaks,
        )
        self.write_history()
        if self.comm.rank == 0:
            summary = write_sealed(self.folder, summary)
            (self.folder / CHECKPOINT).unlink(missing_ok=True)
        return self.comm.bcast(summary)
