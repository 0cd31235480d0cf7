"""What an analysis is, whatever its engine: motion, result files, ending, summary."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.case.sections import GRAVITY, MODEL_ENGINES
from fecolumn.engines.ending import (
    AT_REST,
    EDGE_SHARE,
    OVERTURNED,
    REST_SHARE,
    SLID_OFF,
    STILL_ROCKING,
    Ending,
    cut_text,
)
from fecolumn.engines.followed import ends_at_rest, followed_s
from fecolumn.engines.resume import CHECKPOINT, Resumable
from fecolumn.engines.step_times import StepTimes
from fecolumn.engines.summary import write_sealed
from fecolumn.engines.summary_entries import energy_closure, entries_of, unclosed_text
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.sources import code
from fecolumn.motions.record import GroundMotion

if TYPE_CHECKING:
    from mpi4py import MPI

    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.contact.known_base import KnownBase
    from fecolumn.contact.overturning import Stance
    from fecolumn.contact.unbounded_base import UnboundedBase
    from fecolumn.engines.dynamics.cuts import StepFailed
    from fecolumn.engines.dynamics.record import Record


class AnalysisFailed(RuntimeError):
    """The analysis could not go on; its state is saved in the result folder."""


class Analysis(Resumable):
    """What an analysis is, whatever its engine: motion, result files, summary.

    Attributes
    ----------
    case, folder, comm, file, quiet
        as of `run`. motion: None for a base at rest.
    motion_steps
        until the motion is over. until_rest: whether the analysis ends when the column is at rest.
    dt_chosen
        how the time step was chosen; None where the case states it.
    stance, top_arm
        of `contact.overturning`; the engine sets them, and standing_j.
    """

    stance: Stance
    top_arm: NDArray[Any]

    def __init__(
        self, case: Case, folder: Path, comm: MPI.Intracomm, file: str, quiet: bool
    ) -> None:
        from fecolumn.contact.overturning import steepest_to_come
        from fecolumn.engines.dynamics.history import History

        self.case, self.folder, self.comm, self.quiet = case, folder, comm, quiet
        self.file = file
        self.began, self.cpu_began, self.code = time.perf_counter(), time.process_time(), code()
        self.motion = self._load_motion(file)
        stated_s = case.integration.duration_s
        self.steps = int(round(followed_s(self.motion, case.motion, stated_s) / self.dt_s))
        self.motion_steps = len(self.motion.acceleration) if self.motion else 0
        self.until_rest = ends_at_rest(case.motion, stated_s)
        self.cut_at_s = self._cut(file)
        if case.integration.engine not in MODEL_ENGINES and not (folder / CHECKPOINT).is_file():
            self.say(self.expected())
        self.history, self.step = History(), 0
        self.stepping_s = self.earlier_s = 0.0
        self.standing_j = 0.0
        self.dt_chosen: dict[str, Any] | None = None
        self.step_times: StepTimes | None = None
        self._steepest = np.zeros(self.steps + 1)
        for motion in self.moving_grounds():
            to_come = motion.acceleration[: self.steps + 1]
            steepest = steepest_to_come(np.array([0.0, 0.0, -GRAVITY]), to_come)
            own = self._steepest[: len(steepest)]
            np.maximum(own, steepest, out=own)

    def moving_grounds(self) -> list[GroundMotion]:
        """The motion of each ground that moves."""
        return [self.motion] if self.motion else []

    def run(self, stop: Callable[[], bool]) -> dict[str, Any]:
        """Step to the end, or until `stop` says so; the summary."""
        raise NotImplementedError

    def time_steps(self) -> None:
        """Note how long each step from now on takes, for which steps are made one at a time.

        Raises
        ------
        InputError
            the engine has no steps of contact.
        """
        engine = self.case.integration.engine
        raise InputError(
            "--profile",
            "integration.engine",
            engine,
            "is a rocking model, whose steps have no contact to solve: the reduced, the rigid and "
            "the full engine can be profiled",
        )

    def made_in_s(self) -> float:
        """Time [s] of the steps so far, by which they are profiled."""
        return self.stepping_s

    def expected(self) -> str:
        """What meshes and analysis will take, in words."""
        raise NotImplementedError

    def _load_motion(self, file: str) -> GroundMotion | None:
        if self.case.motion is None:
            return None
        from fecolumn.motions.load import load_motion

        return load_motion(self.case.motion, self.dt_s, file)

    @property
    def dt_s(self) -> float:
        """Step [s], which is a number by now."""
        return float(self.case.integration.dt_s)

    def _cut(self, file: str) -> float | None:
        """Where the analysis cuts the motion short [s], which is told; None where it does not."""
        if self.steps >= self.motion_steps - 1:
            return None
        dt = self.dt_s
        warnings.warn(cut_text(file, self.steps * dt, (self.motion_steps - 1) * dt), stacklevel=2)
        return self.steps * dt

    def steepest(self, steps: range) -> NDArray[Any]:
        """Tangents (k,) of the steepest inclination of apparent gravity from each of k successive
        steps on; see `contact.overturning`.
        """
        found = np.zeros(len(steps))
        known = self._steepest[steps.start : steps.stop]
        found[: len(known)] = known
        return found

    @property
    def barrier_told_j(self) -> float | None:
        """`barrier_j` as the summary has it."""
        return self.barrier_j

    @property
    def barrier_j(self) -> float:
        """Energy to overturn [J]."""
        from fecolumn.contact.overturning import barrier

        return float(barrier(self.stance))

    @property
    def still_j(self) -> float:
        """Largest `energy_left` [J] at which the structure counts as at rest.

        It is REST_SHARE of the energy that overturns the structure.
        """
        return REST_SHARE * self.barrier_j

    @property
    def rest_j(self) -> float:
        """Energy left at which the analysis ends as the column is at rest [J]; -inf where it goes
        on.
        """
        goes_on = not self.until_rest or self.step < self.motion_steps
        return -np.inf if goes_on else self.still_j

    @property
    def cpu_s(self) -> float | None:
        """Processor time of this process since the analysis began [s]; None where it went on from
        an earlier process.
        """
        return None if self.earlier_s else time.process_time() - self.cpu_began

    @property
    def field_steps(self) -> int:
        """Steps between frames of the fields; 0 for no fields."""
        every = self.case.output.fields_every_s
        return max(1, round(every / self.dt_s)) if every else 0

    def write_history(self) -> None:
        """Write history.h5 on rank 0, its rows as far apart as the case says."""
        every = max(1, round(self.case.output.row_interval_s / self.dt_s))

        if self.comm.rank == 0:
            attributes = {"case_id": self.case.id, **self.code, "title": self.case.title}
            self.history.write(self.folder / "history.h5", attributes, every)

    def is_still(self) -> bool:
        """Whether the structure is at rest now."""
        return self.energy_left() <= self.still_j

    def energy_left(self) -> float:
        """Mechanical energy above that of gravity equilibrium now [J]; of what has come lower than
        that, its kinetic energy.
        """
        rows = self.history.last()
        kinetic, strain, gravity = (
            float(rows[f"energy/{term}"]) for term in ("kinetic", "strain", "gravity")
        )
        return max(0.0, kinetic, kinetic + strain + gravity - self.standing_j)

    def ending(self, fallen: int, rotation: NDArray[Any]) -> Ending:
        """How the analysis ends, from the answer of `overturning.fallen` and the last rotation (3,
        3).
        """
        from fecolumn.contact.overturning import CAPPED, NO_RETURN

        last = self.history.last()
        if fallen == CAPPED:
            return Ending(
                OVERTURNED,
                "top displacement reached overturn.displacement_m = "
                f"{self.stance.cap:g} m, at {last['time']:.3f} s",
            )
        if fallen == NO_RETURN:
            return Ending(
                OVERTURNED,
                f"point of no return: {self.no_return(last, rotation)}, at {last['time']:.3f} s",
            )
        return self.ending_in_time(self.is_still(), float(last["time"]))

    def ending_in_time(self, still: bool, end_s: float) -> Ending:
        """How an analysis ends that nothing was lost in, at a time [s]; still: whether it is at
        rest then.
        """
        outcome = AT_REST if still else STILL_ROCKING
        if not self.until_rest:
            return Ending(outcome, f"end of the analysed time, {end_s:.3f} s")
        if still:
            return Ending(
                outcome,
                f"at rest {end_s - self.motion_steps * self.dt_s:.3f} s after the "
                f"motion's end, at {end_s:.3f} s",
            )
        assert self.case.motion  # after which there is free vibration until rest
        return Ending(
            outcome,
            f"motion.rest_ceiling_s = {self.case.motion.rest_ceiling_s:g} s after the "
            f"motion's end, at {end_s:.3f} s",
        )

    def rigid_loss_share(self) -> float | None:
        """Of the summary: energy that impacts took over what rigid-body theory says; None where
        that is not known.
        """
        return None

    def results(self, ending: Ending) -> dict[str, Any]:
        """What the summary has beside what that of any analysis has."""
        return {}

    def no_return(self, last: dict[str, Any], rotation: NDArray[Any]) -> str:
        """What the point of no return was, from the last row of the history and the last rotation
        (3, 3).
        """
        from fecolumn.contact.overturning import critical_tilt_along

        return (
            f"tilt {last['tilt']:.3g} rad, critical "
            f"{critical_tilt_along(self.stance, rotation):.3g} rad"
        )

    def limits(self) -> dict[str, Any]:
        """Of the summary: tilt and displacement beyond which the column falls."""
        from fecolumn.contact.overturning import critical_displacement

        return dict(
            critical_tilt_rad=self.stance.critical,
            u_critical_m=critical_displacement(self.stance, self.top_arm),
        )

    def slid_off(
        self,
        failure: StepFailed,
        base: BasePlate | KnownBase | UnboundedBase,
        foot: NDArray[Any],
        velocity: NDArray[Any],
    ) -> Ending | None:
        """The ending of a column whose step failed because its foot, at (n, 3) [m] with velocities
        (n, 3) [m/s] before, met the edge of the base; None for another failure.
        """
        from fecolumn.engines.dynamics.cuts import Stop

        if failure.stop is not Stop.OFF_BASE:
            return None
        way = self.dt_s * np.hypot(velocity[:, 0], velocity[:, 1]).max()
        if not base.grid.at_edge(foot, way + EDGE_SHARE * np.ptp(foot, axis=0)[:2].max()):
            return None
        return Ending(SLID_OFF, f"{Stop.OFF_BASE.value}, at {self.history.last()['time']:.3f} s")

    def finish(
        self, ending: Ending, dofs: int, record: Record, factorizations: int
    ) -> dict[str, Any]:
        """Write the last history and the summary, which is returned; the checkpoint goes."""
        plan = self.case.integration
        of_steps = dict(
            kinematics=plan.kinematics,
            dt_chosen=self.dt_chosen,
            alpha_hht=plan.alpha_hht,
            iterations=record.iterations,
            contact_iterations=record.contact_iterations,
            impact_iterations=record.impact_iterations,
            impacts=record.impacts,
            rigid_loss_share=self.rigid_loss_share(),
            step_doubt=self._step_doubt(),
            cuts=record.cuts,
            parts=record.parts,
            factorizations=factorizations,
        )
        return self.write_results(ending, dofs, of_steps | self.results(ending))

    def _step_doubt(self) -> str | None:
        """Of the summary: what is doubtful of a step, in words; of one that was chosen by trials
        what these do not see.
        """
        from fecolumn.engines.joined_landings import joined_landings
        from fecolumn.engines.step_doubt import step_doubt

        rows = self.history.arrays()
        joined = joined_landings(rows, self.dt_s)
        if self.dt_chosen:
            return joined
        doubt = step_doubt(
            rows,
            self.dt_s,
            self.rigid_loss_share(),
            self.barrier_j,
            self.limits()["critical_tilt_rad"],
            len(self.case.bodies) <= 1,
            self.case.integration.engine == "rigid",
        )
        return "; ".join(said for said in (doubt, joined) if said) or None

    def write_results(self, ending: Ending, dofs: int, more: dict[str, Any]) -> dict[str, Any]:
        """Write the last history and the summary of any engine, with `more` entries of this one;
        the summary is returned.
        """
        rows = self.history.arrays()
        closure = energy_closure(rows)
        if self.comm.rank == 0 and (told := unclosed_text(closure)):
            warnings.warn(f"{self.file}: {told}", stacklevel=2)
        summary = (
            dict(
                case_id=self.case.id,
                title=self.case.title,
                **self.code,
                engine=self.case.integration.engine,
                dofs=dofs,
                steps=self.step,
                dt_s=self.dt_s,
                motion=self.motion.name if self.motion else "",
                motion_cut_at_s=self.cut_at_s,
            )
            | entries_of(rows, ending)
            | self.limits()
            | dict(
                energy_left_j=None if ending.outcome == OVERTURNED else self.energy_left(),
                energy_to_overturn_j=self.barrier_told_j,
                energy_closure_rel=closure,
                ranks=self.comm.size,
                wall_s=self.earlier_s + time.perf_counter() - self.began,
                cpu_s=self.cpu_s,
                s_per_step=self.stepping_s / max(self.step, 1),
            )
            | more
        )
        self.write_history()
        if self.comm.rank == 0:
            summary = write_sealed(self.folder, summary)
            (self.folder / CHECKPOINT).unlink(missing_ok=True)
        shared: dict[str, Any] = self.comm.bcast(summary)
        return shared

    def say(self, text: str) -> None:
        """Tell the user, unless quiet."""
        if not self.quiet and self.comm.rank == 0:
            import sys

            print(text, file=sys.stderr, flush=True)
