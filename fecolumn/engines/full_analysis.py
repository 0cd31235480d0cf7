"""One analysis with the full-order engine, from a case to its result files."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fecolumn.case.case import Case
from fecolumn.engines.ending import Ending
from fecolumn.engines.pace import Pace
from fecolumn.engines.reduced_engine import begins_unstrained
from fecolumn.engines.resume import CHECKPOINT
from fecolumn.engines.step_times import StepTimes
from fecolumn.engines.structure_analysis import OfStructure
from fecolumn.fem.rotation import out_of_frames
from fecolumn.structures.model import BodyModel, JointModel
from fecolumn.structures.pads import warn_of_grounds

if TYPE_CHECKING:
    from mpi4py import MPI

    from fecolumn.engines.dynamics.cuts import StepFailed
    from fecolumn.engines.dynamics.static_rest import StaticRest
    from fecolumn.engines.dynamics.system import State, System
    from fecolumn.engines.observer import Observer
    from fecolumn.engines.scene.fields import FieldWriter
    from fecolumn.engines.scene.full_fields import StructureFields


# Steps after which bodies are looked at that may come through each other, at most
_LOOK = 100


class FullAnalysis(OfStructure):
    """A running analysis of bodies with all their degrees of freedom.

    Attributes beside those of Analysis: structure: StructureModel at its start, standing: the same
    upright, meshed: `elements.MeshedBody` of each part. system, state, ledger, stepper: of
    `dynamics`. observer: measures states and says when all is lost.
    """

    state: State
    fields: FieldWriter[StructureFields] | None
    rest: StaticRest | None

    def __init__(
        self, case: Case, folder: Path, comm: MPI.Intracomm, file: str, quiet: bool
    ) -> None:
        from fecolumn.engines.dynamics.energy import Ledger
        from fecolumn.engines.dynamics.stepper import Stepper

        super().__init__(case, folder, comm, file, quiet)
        plan = case.integration
        self.system, self.observer = self.built(file)
        began = time.perf_counter()
        self.system.interface.prepare(self.say)
        self.began += time.perf_counter() - began  # what is compiled is so for all analyses
        warn_of_grounds(case, self.structure, file)
        self.ledger = Ledger(self.system)
        stops = plan.tolerance, plan.max_iterations, plan.max_cuts, plan.substeps
        self.stepper = Stepper(self.system, self.ledger, case.contact.impact, *stops)
        self.stance, self.top_arm = self.observer.stance, self.observer.top_arm
        self.fields, self.rest = None, None
        went_on = self.went_on(self._take)
        if not went_on:
            self.state = self._released(self._standing())
        if self.field_steps:  # whose folder is made where there is a start
            self.fields = self._fields()
        if went_on:
            self.say(f"resuming at t = {self.state.time:.4f} s")
        else:
            self.state.ground = self.grounds_at(0)
            self.state.grounds["acceleration"] = self.state.ground.reshape(-1, 3)
            self.ledger.open(self.state)
            self._note(0)
            if self.fields:
                self._write_fields()

    def built(self, file: str) -> tuple[System, Observer]:
        """The System of the case, and what observes it."""
        from fecolumn.engines.full_system import full_system
        from fecolumn.engines.observer import Observer
        from fecolumn.structures.lost import limits_of
        from fecolumn.structures.structure import standing_of

        case = self.case
        system, self.structure, self.meshed = full_system(case, self.comm, file)
        #: The structure before any body leans or moves: gravity energy and displacements are
        #: measured from there.
        self.standing = system.model
        limits = limits_of(self.standing, standing_of(case, self.standing))
        cap = case.overturn.displacement_m
        return system, Observer(system, self.meshed, self.standing, limits, cap)

    @property
    def unstrained(self) -> bool:
        """Whether the start is not from gravity equilibrium, which may not exist then."""
        return begins_unstrained(self.case, self.structure)

    def _released(self, standing: State | None) -> State:
        """The State that the case begins with, from that of gravity equilibrium."""
        from fecolumn.engines.dynamics.structure import released

        return released(self.system, self.structure.parts, None if self.unstrained else standing)

    def drawn(self) -> StructureFields:
        """What of the bodies is drawn in fields, as `engines.scene.fields.FieldWriter` takes it."""
        from fecolumn.engines.scene.full_fields import StructureFields
        from fecolumn.engines.scene.structure_scene import scene_of

        scene = scene_of(self.case, self.standing, self.folder / "case.json")
        points = self.system.interface.points
        return StructureFields(scene, self.system.bodies, self.standing, points)

    def off_base(self, failure: StepFailed) -> Ending | None:
        """The Ending of a step that failed because a foot met the edge of its ground, or None."""
        return self.off_ground(failure, self.system.bases, self.state.grounds, self._foot)

    def _foot(
        self, joint: JointModel, _: BodyModel, rows: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any]]:
        """As `off_ground` takes it."""
        bodies, nodes = self.system.bodies, self.meshed[joint.slave].nodes[rows]
        part, own = bodies.parts[joint.slave], bodies.rows[joint.slave]
        return part.gather(nodes, self.state.x[own]), part.gather(nodes, self.state.v[own])

    def _standing(self) -> State | None:
        """Gravity equilibrium, its energy noted; None of what leans and cannot stand."""
        from fecolumn.engines.dynamics import gravity

        try:
            state = gravity.standing(self.system)
        except gravity.NoEquilibrium:
            if not self.unstrained:
                raise
            return None
        terms = self.ledger.state_terms(state)
        self.standing_j = sum(terms.values()) - self.energy_to_fall()
        return state

    def _take(self, arrays: dict[str, Any]) -> None:
        from fecolumn.engines.dynamics.checkpoint import read_state
        from fecolumn.engines.dynamics.energy import TERMS
        from fecolumn.engines.dynamics.record import Record

        state, extra = read_state(arrays, self.system)
        start = float(extra["start"])
        work = dict(zip(TERMS[3:-1], extra["work"].tolist(), strict=True))
        record = Record(*extra["record"].tolist())
        points, kept = self.system.interface.points, extra["points"]
        if kept.shape != points.shape or not np.can_cast(kept.dtype, points.dtype, "equiv"):
            raise ValueError("points do not fit")
        self.resumed(extra)
        self.system.interface.stay.take(extra)
        points[...] = kept
        self.system.interface.list_present()
        self.state, self.stepper.record = state, record
        self.ledger.start, self.ledger.work = start, work

    def _fields(self) -> FieldWriter[StructureFields]:
        from fecolumn.engines.scene.fields import FieldWriter

        return FieldWriter(self.folder / "fields", self.drawn(), self.dt_s)

    def _write_fields(self) -> None:
        from fecolumn.engines.dynamics.static_rest import StaticRest

        assert self.fields
        system, state = self.system, self.state
        interface, R, rows = system.interface, state.rotation, system.bodies.rows
        self.rest = self.rest or StaticRest(system)
        at_nodes = interface.at_nodes(state.forces, R)
        local = system.kinematics.local_displacement(state.x)
        rest = self.rest.displacement(at_nodes, R)
        drawn = self.fields.fields
        positions = (
            interface.positions(state.x, R, interface.poses(state.x, R)) if drawn.grounds else None
        )
        moved = state.x + out_of_frames(rest, R, rows)
        self.fields.add(state.time, drawn.values(moved, local + rest, positions, state.forces))

    def run(self, stop: Callable[[], bool]) -> dict[str, Any]:
        """Step to the end, to the overturning, to rest or until `stop` says so; the summary."""
        from fecolumn.contact.overturning import STANDS
        from fecolumn.engines.dynamics.cuts import StepFailed
        from fecolumn.engines.passing import Passing

        cadence = self.case.output
        progress = self.progress()
        pace = Pace(self, progress.say, self.stepper.record)
        saved, fallen, over, off = time.perf_counter(), STANDS, False, None
        passing, next_look = Passing(self.structure), self.step + 1
        try:
            while self.step < self.steps and not over:
                began, before = time.perf_counter(), self.stepper.record.iterations
                state = self.stepper.step(self.state, self.grounds_at(self.step + 1))
                self.state, self.step = state, self.step + 1
                self.stepping_s += time.perf_counter() - began
                measures = self._note(self.stepper.record.iterations - before)
                fallen = self.observer.fallen(self.state, measures, self.steepest_at(self.step))
                over = fallen != STANDS or self.rest_j > -np.inf and self.is_still()
                if self.step >= next_look or over or self.step == self.steps:
                    motion = self.observer.motion(state)
                    self.check_passing(passing, motion)
                    next_look = self.step + passing.steps(motion, self.dt_s, _LOOK)
                progress.show(self.step, measures, self.stepper.record)
                pace.look(self.stepper.record)
                if self.fields and self.step % self.field_steps == 0:
                    self._write_fields()
                due, ended = self._agree(
                    time.perf_counter() - saved > cadence.checkpoint_every_s, stop()
                )
                if (due or ended) and not over:  # what is over is no state to go on from
                    self._save()
                    saved = time.perf_counter()
                if ended and self.step < self.steps and not over:
                    raise KeyboardInterrupt
        except StepFailed as failure:
            off = self.off_or_failed(failure)
        finally:
            progress.end()
            pace.end()
        dofs = 3 * self.system.bodies.n_nodes + sum(base.dofs for base in self.system.bases)
        return self.finish(
            off or self.ending(fallen, self.state.rotation[self.observer.body]),
            dofs,
            self.stepper.record,
            self.system.factorizations,
        )

    def time_steps(self) -> None:
        """Note how long each step takes."""
        self.step_times = StepTimes(self.stepper.record)

    def _agree(self, due: bool, ended: bool) -> tuple[bool, bool]:
        """Checkpoint due, stop asked for: so for all ranks where it is so for one."""
        if self.comm.size == 1:
            return due, ended
        votes = self.comm.allreduce(np.array([due, ended], int))
        return bool(votes[0]), bool(votes[1])

    def _note(self, iterations: int) -> dict[str, Any]:
        measures: dict[str, Any] = self.observer.measure(self.state)
        self.history.add(measures, self.ledger.row(self.state), iterations)
        return measures

    def _save(self) -> None:
        from fecolumn.engines.dynamics.checkpoint import write_checkpoint

        extra = self.to_resume() | dict(
            start=self.ledger.start,
            work=list(self.ledger.work.values()),
            record=dataclasses.astuple(self.stepper.record),
            points=self.system.interface.points,
        )
        extra |= self.system.interface.stay.to_keep(self.system.of_step().nodal)
        write_checkpoint(self.folder / CHECKPOINT, self.system, self.state, extra)
        self.write_history()
        self.comm.barrier()
