"""One analysis from a case to its result folder: run, checkpoint, resume, stop at overturn."""

from __future__ import annotations

import dataclasses
import os
import time
import warnings
from pathlib import Path

import numpy as np

from fecolumn.atomic import write_json
from fecolumn.case import GRAVITY, REST, Case, check_duration, finished, read_case
from fecolumn.ending import AT_REST, EDGE, OVERTURNED, REST_SHARE, SLID_OFF, STILL_ROCKING, Ending
from fecolumn.files import Unreadable, is_file, read_json
from fecolumn.result_folder import held
from fecolumn.schema import InputError
from fecolumn.summary import NAME, read_summary

# Steps in a period of the column's vertical vibration on a pad: needed, and for 3 % in frequency (period error (w dt)^2 / 12)
FEWEST_STEPS, FEW_STEPS = 4, 10
CHECKPOINT = "checkpoint.npz"


class AnalysisFailed(RuntimeError):
    """The analysis could not go on; its state is saved in the result folder."""


def run(case: Case | str | Path, folder, *, comm=None, file: str = "", quiet: bool = False, stop=lambda: False) -> dict:
    """Run a case, or go on where an earlier run into the same folder stopped; returns the summary.

    Args:
        case: what to analyse, or its file.
        folder: result folder; one case has one folder.
        comm: MPI communicator, all of MPI.COMM_WORLD unless given.
        file: the case's file, for messages where `case` is none.
        quiet: no progress on stderr.
        stop: asked after every step whether to save and raise KeyboardInterrupt; see `fecolumn.interrupt`.

    Raises:
        InputError: the case is none that can be analysed, the folder belongs to another case, or the motion cannot be used.
        TypeError: `case` is neither a Case nor a path.
        AnalysisFailed: a step did not converge after all cuts.
    """
    from mpi4py import MPI

    comm = comm or MPI.COMM_WORLD
    if isinstance(case, (str, Path)):
        case, file = read_case(case), str(case)
    if not isinstance(case, Case):
        raise TypeError(f"run takes a Case or the path of a case file, not {type(case).__name__}; see fecolumn.read_case")
    folder, file = Path(folder), file or "case"
    case = finished(case, file)
    with held(folder, case, comm, file) as claim:
        summary, damage = comm.bcast(_earlier_summary(folder, case.id) if comm.rank == 0 else None)
        if summary:
            return summary
        if damage and comm.rank == 0:
            warnings.warn(f"{folder / NAME} {damage}; the analysis is made again", stacklevel=2)
        analysis = _analysis_class(case, comm, file)(case, folder, comm, file, quiet)
        claim()
        return analysis.run(stop)


def _analysis_class(case, comm, file):
    check_duration(case, file)
    if case.integration.engine == "full":
        return _FullAnalysis
    if comm.size > 1:
        raise InputError(file, "integration.engine", case.integration.engine, "runs on one process: start it without mpirun")
    from fecolumn.reduced.analysis import ReducedAnalysis

    return ReducedAnalysis


def _earlier_summary(folder: Path, case_id: str) -> tuple[dict | None, str]:
    """The summary of a run that has ended, or None and what is wrong with the file that is there."""
    if not is_file(folder / NAME):
        return None, ""
    try:
        return read_summary(folder, case_id), ""
    except Unreadable as error:
        return None, str(error)


def read_folder_case(folder) -> tuple[Case, str]:
    """The case of a result folder, and its file's name."""
    from fecolumn.case import case_from_tables

    path = Path(folder) / "case.json"
    if not os.path.lexists(path):
        raise InputError(folder, "", None, "not a result folder of fecolumn run (no case.json)")
    try:
        saved = read_json(path)
    except Unreadable as error:
        raise InputError(path, "", None, str(error)) from None
    if not isinstance(saved, dict) or not isinstance(saved.get("case"), dict):
        raise InputError(path, "", None, "is damaged: it must state the case")
    tables = {key: value for key, value in saved["case"].items() if value is not None}
    return case_from_tables(tables, path), str(saved.get("file", "case"))


class Analysis:
    """What an analysis is, whatever its engine: motion, result files, summary.

    Attributes:
        case, folder, comm, quiet: as of `run`. motion: None for a base at rest. steps: to be made at most; step: the last one made.
        motion_steps: until the motion is over. until_rest: whether the analysis ends when the column is at rest.
        history: rows so far. stepping_s, earlier_s: wall time of steps, and of earlier runs [s].
        stance, top_arm: of `dynamics.overturning`; standing_j: mechanical energy in gravity equilibrium [J]; the engine sets these three.
    """

    def __init__(self, case, folder, comm, file, quiet):
        from fecolumn.dynamics.history import History
        from fecolumn.dynamics.overturning import steepest_to_come
        from fecolumn.mesh.estimate import estimate

        self.case, self.folder, self.comm, self.quiet = case, folder, comm, quiet
        self.began = time.perf_counter()
        self.motion = self._load_motion(file)
        self.steps = int(round(self._duration() / case.integration.dt_s))
        self.motion_steps = len(self.motion.acceleration) if self.motion else 0
        self.until_rest = bool(self.motion) and case.motion.free_vibration_s == REST and not case.integration.duration_s
        self.cut_at_s = self._cut(file)
        if not (folder / CHECKPOINT).is_file():
            self.say(str(estimate(case)))
        self.history, self.step = History(), 0
        self.stepping_s = self.earlier_s = 0.0
        self.stance, self.top_arm, self.standing_j = None, None, 0.0
        grounds = self.motion.acceleration[:self.steps + 1] if self.motion else np.zeros((0, 3))
        self._steepest = steepest_to_come(np.array([0.0, 0.0, -GRAVITY]), grounds)

    def _load_motion(self, file):
        if self.case.motion is None:
            return None
        from fecolumn.motions.load import load_motion

        return load_motion(self.case.motion, self.case.integration.dt_s, file)

    def _duration(self) -> float:
        if self.case.integration.duration_s:
            return self.case.integration.duration_s
        return len(self.motion.acceleration) * self.motion.dt + self.case.motion.longest_free_vibration_s

    def _cut(self, file) -> float | None:
        """Where the analysis cuts the motion short [s], which is told; None where it does not."""
        if self.steps >= self.motion_steps - 1:
            return None
        dt = self.case.integration.dt_s
        warnings.warn(cut_text(file, self.steps * dt, (self.motion_steps - 1) * dt), stacklevel=2)
        return self.steps * dt

    def ground(self, step: int) -> np.ndarray:
        """Ground acceleration (3,) [m/s2] at a step."""
        if self.motion is None or step >= len(self.motion.acceleration):
            return np.zeros(3)
        return self.motion.acceleration[step]

    def steepest(self, step: int) -> float:
        """Tangent of the steepest inclination of apparent gravity from a step on; see `dynamics.overturning`."""
        return float(self._steepest[step]) if step < len(self._steepest) else 0.0

    @property
    def rest_j(self) -> float:
        """Mechanical energy at which the analysis ends as the column is at rest [J]; -inf where it goes on."""
        from fecolumn.dynamics.overturning import barrier

        asked = self.until_rest and self.step >= self.motion_steps
        return self.standing_j + REST_SHARE * barrier(self.stance) if asked else -np.inf

    @property
    def field_steps(self) -> int:
        """Steps between frames of the fields; 0 for no fields."""
        every = self.case.output.fields_every_s
        return max(1, round(every / self.case.integration.dt_s)) if every else 0

    def warn_of_base(self, frequency: float, pad, file) -> None:
        """Tell of a step that resolves the base plate's vibration, of lowest `frequency` [Hz], or not that of the column on its Pad.

        Raises:
            InputError: a pad so stiff that its vibration is less than a few steps.
        """
        dt = self.case.integration.dt_s
        if pad is not None:
            steps, stiffness = 1 / (pad.frequency * dt), self.case.base.stiffness_n_m3
            told = f"the column's vertical vibration on its pad, of {pad.frequency:.3g} Hz, takes {steps:.2g} steps"
            if steps < FEWEST_STEPS:
                raise InputError(file, "base.stiffness_n_m3", stiffness, f"{told}; at least {FEWEST_STEPS} are needed: integration.dt_s at most "
                                 f"{1 / (FEWEST_STEPS * pad.frequency):.2g} s, or base.kind = 'unbounded' for a ground that stiff")
            if steps < FEW_STEPS:
                warnings.warn(f"{file}: {told}; with fewer than {FEW_STEPS} its frequency is off by more than 3 %", stacklevel=2)
        if dt < 1 / frequency:
            warnings.warn(f"{file}: integration.dt_s = {dt:g} s resolves the base plate's own vibration (period {1 / frequency:.2g} s), "
                          "which is left out: the base responds statically", stacklevel=2)

    def went_on(self, take) -> bool:
        """Whether the analysis goes on from its checkpoint; from one that cannot be used it does not, and says so.

        Args:
            take: takes over the arrays of a checkpoint; it raises, and has changed nothing but what the start sets, where they do not fit.
        """
        from fecolumn.dynamics.checkpoint import read_arrays
        from fecolumn.dynamics.history import History

        path, problem = self.folder / CHECKPOINT, ""
        if not self.comm.bcast(is_file(path) if self.comm.rank == 0 else None):
            return False
        try:
            take(read_arrays(path))
        except Exception as error:  # damaged archives lead to errors of a dozen kinds
            problem = f"{type(error).__name__}: {error}".split("\n")[0]
        problem = next(filter(None, self.comm.allgather(problem)), "")
        if problem:
            if self.comm.rank == 0:
                warnings.warn(f"{path} cannot be used ({problem}); the analysis starts afresh", stacklevel=2)
            self.history, self.step, self.stepping_s, self.earlier_s = History(), 0, 0.0, 0.0
        return not problem

    def resumed(self, extra: dict) -> None:
        """Take over what an earlier run had, from the `extra` arrays of its checkpoint.

        Raises:
            ValueError: they are of another case, or not whole.
        """
        from fecolumn.dynamics.history import History

        rows = {name[5:]: values for name, values in extra.items() if name.startswith("rows.")}
        step, stepping_s, earlier_s, standing_j = int(extra["step"]), *(float(extra[name]) for name in ("stepping_s", "wall_s", "standing_j"))
        if str(extra["case_id"]) != self.case.id:
            raise ValueError(f"of another case, {extra['case_id']}")
        if not 0 <= step <= self.steps or {len(values) for values in rows.values()} != {step + 1} or min(stepping_s, earlier_s) < 0:
            raise ValueError("its history is not whole")
        self.history, self.step, self.stepping_s, self.earlier_s, self.standing_j = History(rows), step, stepping_s, earlier_s, standing_j

    def to_resume(self) -> dict:
        """The `extra` arrays of a checkpoint that `resumed` takes."""
        extra = {f"rows.{name}": values for name, values in self.history.arrays().items()}
        return extra | dict(case_id=self.case.id, step=self.step, stepping_s=self.stepping_s, standing_j=self.standing_j,
                            wall_s=self.earlier_s + time.perf_counter() - self.began)

    def write_history(self) -> None:
        """Write history.h5 on rank 0, its rows as far apart as the case says."""
        from fecolumn import __version__

        every = max(1, round(self.case.output.history_every_s / self.case.integration.dt_s))

        if self.comm.rank == 0:
            attributes = {"case_id": self.case.id, "version": __version__, "title": self.case.title}
            self.history.write(self.folder / "history.h5", attributes, every)

    def energy_left(self) -> float:
        """Mechanical energy above that of gravity equilibrium now [J]."""
        rows = self.history.last()
        return max(0.0, float(sum(rows[f"energy/{term}"] for term in ("kinetic", "strain", "gravity"))) - self.standing_j)

    def ending(self, fallen: int, rotation: np.ndarray) -> Ending:
        """How the analysis ends, from the answer of `overturning.fallen` and the last rotation (3, 3)."""
        from fecolumn.dynamics.overturning import CAPPED, NO_RETURN, barrier, critical_tilt_along

        last, dt = self.history.last(), self.case.integration.dt_s
        if fallen == CAPPED:
            return Ending(OVERTURNED, f"top displacement reached overturn.displacement_m = {self.stance.cap:g} m, at {last['time']:.3f} s")
        if fallen == NO_RETURN:
            critical = critical_tilt_along(self.stance, rotation)
            return Ending(OVERTURNED, f"point of no return: tilt {last['tilt']:.3g} rad, critical {critical:.3g} rad, at {last['time']:.3f} s")
        outcome = AT_REST if self.energy_left() <= REST_SHARE * barrier(self.stance) else STILL_ROCKING
        if not self.until_rest:
            return Ending(outcome, f"end of the analysed time, {last['time']:.3f} s")
        if outcome == AT_REST:
            return Ending(outcome, f"at rest {last['time'] - self.motion_steps * dt:.3f} s after the motion's end, at {last['time']:.3f} s")
        return Ending(outcome, f"motion.rest_ceiling_s = {self.case.motion.rest_ceiling_s:g} s after the motion's end, at {last['time']:.3f} s")

    def slid_off(self, failure, base, foot: np.ndarray) -> Ending | None:
        """The ending of a column whose step failed because its foot, at (n, 3) [m] before, met the edge of the base; None for another failure."""
        from fecolumn.dynamics.stage import Stop

        if failure.stop is not Stop.OFF_BASE or not base.grid.at_edge(foot, EDGE * np.ptp(foot, axis=0)[:2].max()):
            return None
        return Ending(SLID_OFF, f"{Stop.OFF_BASE.value}, at {self.history.last()['time']:.3f} s")

    def finish(self, ending: Ending, dofs: int, record, factorizations: int) -> dict:
        """Write the last history and the summary, which is returned; the checkpoint goes."""
        from fecolumn import __version__
        from fecolumn.dynamics.energy import TERMS
        from fecolumn.dynamics.overturning import barrier, critical_displacement

        rows, plan, overturned = self.history.arrays(), self.case.integration, ending.outcome == OVERTURNED
        slid_off, slide = ending.outcome == SLID_OFF, rows["slide"][-1]
        top = np.hypot(rows["u_top"][:, 0], rows["u_top"][:, 1])
        fall, end = rows["u_top"][-1], float(rows["time"][-1])
        summary = dict(
            case_id=self.case.id, title=self.case.title, version=__version__, engine=plan.engine, kinematics=plan.kinematics,
            dofs=dofs, steps=self.step, dt=plan.dt_s, alpha_hht=plan.alpha_hht,
            motion=self.motion.name if self.motion else "", duration_s=end, motion_cut_at_s=self.cut_at_s,
            outcome=ending.outcome, ended_by=ending.ended_by,
            # what overturns or slides off goes further than the analysis: its largest displacement is where that stopped, and no peak
            u_max_m=float(top.max()), u_max_censored=overturned or slid_off,
            overturned=overturned, overturn_time_s=end if overturned else None,
            overturn_direction_deg=float(np.degrees(np.arctan2(fall[1], fall[0]))) if overturned else None,
            slid_off=slid_off, slid_off_time_s=end if slid_off else None,
            slid_off_direction_deg=float(np.degrees(np.arctan2(slide[1], slide[0]))) if slid_off else None,
            critical_tilt_rad=self.stance.critical, u_critical_m=critical_displacement(self.stance, self.top_arm),
            energy_left_j=None if overturned else self.energy_left(), energy_to_overturn_j=float(barrier(self.stance)),
            tilt_max_rad=float(rows["tilt"].max()), residual_slide_m=float(np.hypot(*rows["slide"][-1])),
            penetration_max_m=float(rows["penetration"].max()), ranks=self.comm.size,
            wall_s=self.earlier_s + time.perf_counter() - self.began, s_per_step=self.stepping_s / max(self.step, 1),
            iterations=record.iterations, contact_iterations=record.contact_iterations, impacts=record.impacts,
            cuts=record.cuts, factorizations=factorizations, energy_closure_rel=energy_closure(rows),
            energy_j={name: float(rows[f"energy/{name}"][-1]) for name in TERMS})
        self.write_history()
        if self.comm.rank == 0:
            write_json(self.folder / NAME, summary)
            (self.folder / CHECKPOINT).unlink(missing_ok=True)
        self.comm.barrier()
        return summary

    def say(self, text: str) -> None:
        """Tell the user, unless quiet."""
        if not self.quiet and self.comm.rank == 0:
            import sys

            print(text, file=sys.stderr, flush=True)


class _FullAnalysis(Analysis):
    """A running analysis of the full-order engine."""

    def __init__(self, case, folder, comm, file, quiet):
        from fecolumn.contact.friction import prepare_solver
        from fecolumn.dynamics import gravity
        from fecolumn.dynamics.assembly import build_system, share_specimen_mesh
        from fecolumn.dynamics.energy import Ledger
        from fecolumn.dynamics.observer import Observer
        from fecolumn.dynamics.stepper import Stepper

        super().__init__(case, folder, comm, file, quiet)
        prepare_solver(self.say)
        self.began = time.perf_counter()
        plan = case.integration
        specimen = share_specimen_mesh(case, comm)
        self.system = build_system(case, comm, specimen)
        self.warn_of_base(self.system.base.frequency, self.system.interface.pad, file)
        self.ledger = Ledger(self.system)
        self.stepper = Stepper(self.system, self.ledger, case.contact.impact, plan.tolerance,
                               plan.max_iterations, plan.max_cuts)
        self.observer = Observer(self.system, specimen, case.overturn.displacement_m)
        self.stance, self.top_arm = self.observer.stance, self.observer.top_arm
        self.fields, self.free = self._fields(specimen) if self.field_steps else None, None
        if self.went_on(self._take):
            self.say(f"resuming at t = {self.state.time:.4f} s")
        else:
            self.state, start = self._standing(), case.initial
            if start.tilt_rad or start.moves:
                self.state = gravity.begin(self.system, start)
            self.state.ground = self.ground(0)
            self.ledger.open(self.state)
            self._note(0)
            if self.fields:
                self._write_fields()

    def _standing(self):
        """Gravity equilibrium, its energy noted; None of a column released with a tilt that cannot stand."""
        from fecolumn.dynamics import gravity

        try:
            state = gravity.standing(self.system)
        except RuntimeError:
            if not self.case.initial.tilt_rad:
                raise
            return None
        self.standing_j = sum(self.ledger.state_terms(state).values())
        return state

    def _take(self, arrays: dict) -> None:
        from fecolumn.dynamics.checkpoint import read_state
        from fecolumn.dynamics.energy import TERMS
        from fecolumn.dynamics.stepper import Record

        state, extra = read_state(arrays, self.system)
        start = float(extra["start"])
        work, record = dict(zip(TERMS[3:-1], extra["work"].tolist(), strict=True)), Record(*extra["record"].tolist())
        self.resumed(extra)
        self.state, self.ledger.start, self.ledger.work, self.stepper.record = state, start, work, record

    def _fields(self, specimen):
        from fecolumn.post.fields import FieldWriter

        system = self.system
        plate = system.base if len(specimen.base.cells) else None
        return FieldWriter(self.folder / "fields", system.column, plate, system.footprint, specimen)

    def _write_fields(self) -> None:
        from fecolumn.dynamics.free_body import FreeBody

        system, state = self.system, self.state
        interface, column, R = system.interface, system.column, state.rotation
        at_nodes, local = interface.at_nodes(state.forces), system.kinematics.local_displacement(state.x)
        rest = np.zeros_like(local)
        if interface.foot.filtered:
            # what the filter keeps from the body it bears statically: the part of the stress that a step does not resolve
            self.free = self.free or FreeBody(column)
            forces = at_nodes @ R
            unresolved = column.spread(system.foot_nodes, forces) - interface.foot.load(forces)
            rest = self.free.response(unresolved.reshape(-1, 1)).reshape(-1, 3)
        self.fields.write(state.time, state.x + rest @ R.T, local + rest, interface.dynamic_position(state.x, R), state.forces, at_nodes)

    def run(self, stop) -> dict:
        from fecolumn.dynamics.overturning import STANDS
        from fecolumn.dynamics.stepper import StepFailed
        from fecolumn.progress import Progress

        cadence = self.case.output
        progress = Progress(self.steps, self.case.integration.dt_s, quiet=self.quiet or self.comm.rank > 0,
                            until_rest_from=self.motion_steps if self.until_rest else None)
        saved, fallen, over, off = time.perf_counter(), STANDS, False, None
        try:
            while self.step < self.steps and not over:
                began, before = time.perf_counter(), self.stepper.record.iterations
                state = self.stepper.step(self.state, self.ground(self.step + 1))
                self.state, self.step = state, self.step + 1
                self.stepping_s += time.perf_counter() - began
                measures = self._note(self.stepper.record.iterations - before)
                fallen = self.observer.fallen(self.state, measures, self.steepest(self.step))
                over = fallen != STANDS or self.energy_left() + self.standing_j <= self.rest_j
                progress.show(self.step, measures, self.stepper.record)
                if self.fields and self.step % self.field_steps == 0:
                    self._write_fields()
                due, ended = self._agree(time.perf_counter() - saved > cadence.checkpoint_every_s, stop())
                if due or ended:
                    self._save()
                    saved = time.perf_counter()
                if ended and self.step < self.steps and not over:
                    raise KeyboardInterrupt
        except StepFailed as failure:
            column = self.system.column
            off = self.slid_off(failure, self.system.base, column.gather(self.system.foot_nodes, self.state.x))
            if off is None:
                self._save()
                raise AnalysisFailed(f"{failure}; state saved in {self.folder / CHECKPOINT}") from None
        finally:
            progress.end()
        dofs = 3 * self.system.column.n_nodes + self.system.base.dofs
        return self.finish(off or self.ending(fallen, self.state.rotation), dofs, self.stepper.record, self.system.factorizations)

    def _agree(self, due: bool, ended: bool) -> tuple[bool, bool]:
        """Checkpoint due, stop asked for: so for all ranks where it is so for one."""
        if self.comm.size == 1:
            return due, ended
        votes = self.comm.allreduce(np.array([due, ended], int))
        return bool(votes[0]), bool(votes[1])

    def _note(self, iterations: int) -> dict:
        measures = self.observer.measure(self.state)
        self.history.add(measures, self.ledger.row(self.state), iterations)
        return measures

    def _save(self) -> None:
        from fecolumn.dynamics.checkpoint import write_checkpoint

        extra = self.to_resume() | dict(start=self.ledger.start, work=list(self.ledger.work.values()),
                                        record=dataclasses.astuple(self.stepper.record))
        write_checkpoint(self.folder / CHECKPOINT, self.system, self.state, extra)
        self.write_history()
        self.comm.barrier()


def cut_text(file, end_s: float, motion_s: float) -> str:
    """Warning of a motion that is not analysed to its end."""
    return (f"{file}: integration.duration_s = {end_s:g} s cuts the motion short, which lasts {motion_s:g} s; without integration.duration_s "
            "the whole motion is analysed")


def energy_closure(rows: dict) -> float:
    """Largest closure error relative to the largest mechanical energy that moved [-].

    Reference is the largest of kinetic energy, swing of the gravity energy, and work of the base motion.
    """
    moved = max(rows["energy/kinetic"].max(), np.ptp(rows["energy/gravity"]), np.abs(rows["energy/base_work"]).max())
    return float(np.abs(rows["energy/closure"]).max() / moved) if moved > 0 else 0.0
