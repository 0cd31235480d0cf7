"""One analysis from a case to its result folder: run, checkpoint, resume, stop at overturn."""

from __future__ import annotations

import contextlib
import dataclasses
import fcntl
import json
import time
import warnings
from pathlib import Path

import numpy as np

from fecolumn.atomic import write_json
from fecolumn.case import Case
from fecolumn.schema import InputError

CHECKPOINT = "checkpoint.npz"


class AnalysisFailed(RuntimeError):
    """The analysis could not go on; its state is saved in the result folder."""


def run(case: Case, folder, *, comm=None, file: str = "case", quiet: bool = False, stop=lambda: False) -> dict:
    """Run a case, or go on where an earlier run into the same folder stopped; returns the summary.

    Args:
        case: what to analyse.
        folder: result folder; one case has one folder.
        comm: MPI communicator, all of MPI.COMM_WORLD unless given.
        file: the case's file, for messages.
        quiet: no progress on stderr.
        stop: asked after every step whether to save and raise KeyboardInterrupt; see `fecolumn.interrupt`.

    Raises:
        InputError: the folder belongs to another case, or the motion cannot be used.
        AnalysisFailed: a step did not converge after all cuts, or the column left the base plate.
    """
    from mpi4py import MPI

    comm = comm or MPI.COMM_WORLD
    folder = Path(folder)
    with _claimed(folder, case, comm, file):
        summary = folder / "summary.json"
        if summary.is_file():
            return json.loads(summary.read_text())
        if case.integration.engine == "full":
            return _FullAnalysis(case, folder, comm, file, quiet).run(stop)
        if comm.size > 1:
            raise InputError(file, "integration.engine", case.integration.engine, "runs on one process: start it without mpirun")
        from fecolumn.reduced.analysis import ReducedAnalysis

        return ReducedAnalysis(case, folder, comm, file, quiet).run(stop)


def read_folder_case(folder) -> tuple[Case, str]:
    """The case of a result folder, and its file's name."""
    from fecolumn.case import case_from_tables

    path = Path(folder) / "case.json"
    try:
        saved = json.loads(path.read_text())
    except FileNotFoundError:
        raise InputError(folder, "", None, "not a result folder of fecolumn run (no case.json)") from None
    except (json.JSONDecodeError, UnicodeDecodeError):
        raise InputError(path, "", None, "damaged: not valid JSON") from None
    tables = {key: value for key, value in saved["case"].items() if value is not None}
    return case_from_tables(tables, path), saved["file"]


@contextlib.contextmanager
def _claimed(folder: Path, case: Case, comm, file):
    """Hold the folder for this case alone; nothing is written where it is another's."""
    refusal, lock = None, None
    if comm.rank == 0:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            known = folder / "case.json"
            if known.is_file():
                other = json.loads(known.read_text())["id"]
                if other != case.id:
                    refusal = "-o", str(folder), f"holds the results of another case ({other}, this one is {case.id}); give a new folder"
            elif any(folder.iterdir()) and not (folder / ".lock").exists():
                refusal = "-o", str(folder), "must be a new or empty folder, or one of this case"
            if refusal is None:
                lock = open(folder / ".lock", "w")
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                if not known.is_file():
                    write_json(known, {"id": case.id, "file": str(file), "case": dataclasses.asdict(case)})
        except BlockingIOError:
            refusal = "-o", str(folder), "another run is writing into this folder"
        except (NotADirectoryError, FileExistsError):
            refusal = "-o", str(folder), "is a file; a folder is needed"
        except PermissionError:
            refusal = "-o", str(folder), "may not be written (permission denied)"
        except (json.JSONDecodeError, KeyError):
            refusal = "-o", str(folder), "its case.json is damaged; give a new folder"
    refusal = comm.bcast(refusal)
    if refusal:
        raise InputError(file, *refusal)
    try:
        yield
    finally:
        if lock:
            lock.close()


class Analysis:
    """What an analysis is, whatever its engine: motion, result files, summary.

    Attributes:
        case, folder, comm, quiet: as of `run`. motion: None for a base at rest. steps: to be made; step: the last one made.
        history: rows so far. stepping_s, earlier_s: wall time of steps, and of earlier runs [s].
    """

    def __init__(self, case, folder, comm, file, quiet):
        from fecolumn.dynamics.history import History
        from fecolumn.mesh.estimate import estimate

        self.case, self.folder, self.comm, self.quiet = case, folder, comm, quiet
        self.began = time.perf_counter()
        self.motion = self._load_motion(file)
        self.steps = int(round(self._duration() / case.integration.dt_s))
        if not (folder / CHECKPOINT).is_file():
            self.say(str(estimate(case)))
        self.history, self.step = History(), 0
        self.stepping_s = self.earlier_s = 0.0

    def _load_motion(self, file):
        if self.case.motion is None:
            return None
        from fecolumn.motions.load import load_motion

        return load_motion(self.case.motion, self.case.integration.dt_s, file)

    def _duration(self) -> float:
        if self.case.integration.duration_s:
            return self.case.integration.duration_s
        return len(self.motion.acceleration) * self.motion.dt + self.case.motion.free_vibration_s

    def ground(self, step: int) -> np.ndarray:
        """Ground acceleration (3,) [m/s2] at a step."""
        if self.motion is None or step >= len(self.motion.acceleration):
            return np.zeros(3)
        return self.motion.acceleration[step]

    @property
    def field_steps(self) -> int:
        """Steps between frames of the fields; 0 for no fields."""
        every = self.case.output.fields_every_s
        return max(1, round(every / self.case.integration.dt_s)) if every else 0

    def warn_of_base(self, frequency: float, file) -> None:
        """Tell of a step that resolves the base plate's vibration, of lowest `frequency` [Hz]."""
        dt = self.case.integration.dt_s
        if dt < 1 / frequency:
            warnings.warn(f"{file}: integration.dt_s = {dt:g} s resolves the base plate's own vibration (period {1 / frequency:.2g} s), "
                          "which is left out: the base responds statically", stacklevel=2)

    def resumed(self, extra: dict) -> None:
        """Take over what an earlier run had, from the `extra` arrays of its checkpoint."""
        from fecolumn.dynamics.history import History

        self.history = History({name[5:]: values for name, values in extra.items() if name.startswith("rows.")})
        self.step, self.stepping_s, self.earlier_s = int(extra["step"]), float(extra["stepping_s"]), float(extra["wall_s"])

    def to_resume(self) -> dict:
        """The `extra` arrays of a checkpoint that `resumed` takes."""
        extra = {f"rows.{name}": values for name, values in self.history.arrays().items()}
        return extra | dict(step=self.step, stepping_s=self.stepping_s, wall_s=self.earlier_s + time.perf_counter() - self.began)

    def write_history(self) -> None:
        """Write history.h5 on rank 0, its rows as far apart as the case says."""
        from fecolumn import __version__

        every = max(1, round(self.case.output.history_every_s / self.case.integration.dt_s))

        if self.comm.rank == 0:
            attributes = {"case_id": self.case.id, "version": __version__, "title": self.case.title}
            self.history.write(self.folder / "history.h5", attributes, every)

    def finish(self, overturned: bool, dofs: int, record, factorizations: int) -> dict:
        """Write the last history and the summary, which is returned; the checkpoint goes."""
        from fecolumn import __version__
        from fecolumn.dynamics.energy import TERMS

        rows, plan = self.history.arrays(), self.case.integration
        top = np.hypot(rows["u_top"][:, 0], rows["u_top"][:, 1])
        fall, end = rows["u_top"][-1], float(rows["time"][-1])
        summary = dict(
            case_id=self.case.id, title=self.case.title, version=__version__, engine=plan.engine, kinematics=plan.kinematics,
            dofs=dofs, steps=self.step, dt=plan.dt_s, alpha_hht=plan.alpha_hht,
            motion=self.motion.name if self.motion else "", duration_s=end, u_max_m=float(top.max()),
            overturned=overturned, overturn_time_s=end if overturned else None,
            overturn_direction_deg=float(np.degrees(np.arctan2(fall[1], fall[0]))) if overturned else None,
            tilt_max_rad=float(rows["tilt"].max()), residual_slide_m=float(np.hypot(*rows["slide"][-1])),
            penetration_max_m=float(rows["penetration"].max()), ranks=self.comm.size,
            wall_s=self.earlier_s + time.perf_counter() - self.began, s_per_step=self.stepping_s / max(self.step, 1),
            iterations=record.iterations, contact_iterations=record.contact_iterations, impacts=record.impacts,
            cuts=record.cuts, factorizations=factorizations, energy_closure_rel=energy_closure(rows),
            energy_j={name: float(rows[f"energy/{name}"][-1]) for name in TERMS})
        self.write_history()
        if self.comm.rank == 0:
            write_json(self.folder / "summary.json", summary)
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
        from fecolumn.dynamics import gravity
        from fecolumn.dynamics.assembly import build_system, share_specimen_mesh
        from fecolumn.dynamics.checkpoint import read_checkpoint
        from fecolumn.dynamics.energy import TERMS, Ledger
        from fecolumn.dynamics.observer import Observer
        from fecolumn.dynamics.stepper import Record, Stepper

        super().__init__(case, folder, comm, file, quiet)
        plan = case.integration
        specimen = share_specimen_mesh(case, comm)
        self.system = build_system(case, comm, specimen)
        self.warn_of_base(self.system.base.frequency, file)
        self.ledger = Ledger(self.system)
        self.stepper = Stepper(self.system, self.ledger, case.contact.impact, plan.tolerance,
                               plan.max_iterations, plan.max_cuts)
        self.observer = Observer(self.system, specimen, case.overturn.displacement_m)
        self.fields, self.free = self._fields(specimen) if self.field_steps else None, None
        if (folder / CHECKPOINT).is_file():
            self.state, extra = read_checkpoint(folder / CHECKPOINT, self.system)
            self.resumed(extra)
            self.ledger.start = float(extra["start"])
            self.ledger.work = dict(zip(TERMS[3:-1], extra["work"].tolist()))
            self.stepper.record = Record(*extra["record"].tolist())
            self.observer.last_tilt = float(extra["last_tilt"])
            self.say(f"resuming at t = {self.state.time:.4f} s")
        else:
            start = case.initial
            self.state = gravity.tilted(self.system, start.tilt_rad, np.radians(start.direction_deg)) if start.tilt_rad \
                else gravity.standing(self.system)
            self.state.ground = self.ground(0)
            self.ledger.open(self.state)
            self._note(0)
            if self.fields:
                self._write_fields()

    def _fields(self, specimen):
        from fecolumn.post.fields import FieldWriter

        system = self.system
        return FieldWriter(self.folder / "fields", system.column, system.base, system.footprint, specimen)

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
        from fecolumn.dynamics.stepper import StepFailed
        from fecolumn.progress import Progress

        cadence = self.case.output
        progress = Progress(self.steps, self.case.integration.dt_s, quiet=self.quiet or self.comm.rank > 0)
        saved = time.perf_counter()
        measures = self.observer.measure(self.state)
        overturned = False
        try:
            while self.step < self.steps and not overturned:
                began, before = time.perf_counter(), self.stepper.record.iterations
                state = self.stepper.step(self.state, self.ground(self.step + 1))
                self.state, self.step = state, self.step + 1
                self.stepping_s += time.perf_counter() - began
                measures = self._note(self.stepper.record.iterations - before)
                overturned = self.observer.overturned(measures)
                progress.show(self.step, measures, self.stepper.record)
                if self.fields and self.step % self.field_steps == 0:
                    self._write_fields()
                due, ended = self._agree(time.perf_counter() - saved > cadence.checkpoint_every_s, stop())
                if due or ended:
                    self._save()
                    saved = time.perf_counter()
                if ended and self.step < self.steps and not overturned:
                    raise KeyboardInterrupt
        except StepFailed as failure:
            self._save()
            raise AnalysisFailed(f"{failure}; state saved in {self.folder / CHECKPOINT}") from None
        finally:
            progress.end()
        dofs = 3 * (self.system.column.n_nodes + self.system.base.body.n_nodes)
        return self.finish(overturned, dofs, self.stepper.record, self.system.factorizations)

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
                                        record=dataclasses.astuple(self.stepper.record), last_tilt=self.observer.last_tilt)
        write_checkpoint(self.folder / CHECKPOINT, self.system, self.state, extra)
        self.write_history()
        self.comm.barrier()


def energy_closure(rows: dict) -> float:
    """Largest closure error relative to the largest mechanical energy that moved [-].

    Reference is the largest of kinetic energy, swing of the gravity energy, and work of the base motion.
    """
    moved = max(rows["energy/kinetic"].max(), np.ptp(rows["energy/gravity"]), np.abs(rows["energy/base_work"]).max())
    return float(np.abs(rows["energy/closure"]).max() / moved) if moved > 0 else 0.0
