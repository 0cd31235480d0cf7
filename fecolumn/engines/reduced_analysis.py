"""One analysis with the reduced or the rigid engine, from a case to its result files."""

from __future__ import annotations

import contextlib
import io
import math
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.case.case import Case
from fecolumn.contact.arrays import arrays_of
from fecolumn.contact.gathered import base_to_resume, gather_again
from fecolumn.contact.known_base import KnownBase
from fecolumn.contact.overturning import STANDS
from fecolumn.contact.problem import list_present
from fecolumn.contact.unbounded_base import UnboundedBase
from fecolumn.engines.analysis import AnalysisFailed
from fecolumn.engines.dynamics.cuts import StepFailed
from fecolumn.engines.dynamics.gravity import NoEquilibrium
from fecolumn.engines.ending import Ending
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.pace import LOOK_S, Pace
from fecolumn.engines.passing import Passing
from fecolumn.engines.reduced.observe import ENERGY, column_index
from fecolumn.engines.reduced.rigid_loss import loss_share
from fecolumn.engines.reduced.run import advance
from fecolumn.engines.reduced.states import States, state_of
from fecolumn.engines.reduced_engine import TooManyPoints, begins_unstrained, engine_of, upright
from fecolumn.engines.resume import CHECKPOINT
from fecolumn.engines.step_times import StepTimes
from fecolumn.engines.structure_analysis import OfStructure
from fecolumn.foundation._compiled import compiled, interpreted
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.atomic import write_bytes
from fecolumn.structures.check_rest import unheld
from fecolumn.structures.model import BodyModel, JointModel
from fecolumn.structures.pads import warn_of_grounds
from fecolumn.structures.structure import standing_of, structure_model

if TYPE_CHECKING:
    from mpi4py import MPI

    from fecolumn.engines.scene.fields import FieldWriter
    from fecolumn.engines.scene.scene import SceneFields

# Most steps between looks at the clock, Ctrl-C and the progress line; fewer where they are slow
CHUNK = 500


class ReducedAnalysis(OfStructure):
    """A running analysis of the reduced or the rigid engine."""

    def __init__(
        self, case: Case, folder: Path, comm: MPI.Intracomm, file: str, quiet: bool
    ) -> None:
        super().__init__(case, folder, comm, file, quiet)
        self._file = file
        self.structure = structure_model(case, file, self.say)
        self.states = self._states()
        self.bases = self.structure.bases
        warn_of_grounds(case, self.structure, file)
        if not compiled(advance):
            self.say(
                "compiling the reduced engine, once on this machine: two to six minutes; "
                "other processes wait for it"
            )
        self.engine = engine_of(case, self.structure, file)
        self.began, self.cpu_began = (
            time.perf_counter(),
            time.process_time(),
        )  # what was made and compiled so far was so for all analyses
        self.stance, self.top_arm = self.engine.view.stance, self.engine.view.top_arm
        # their folder is made where there is a start
        self.fields = self._fields() if self.field_steps else None
        if self.went_on(self._take):
            self.say(f"resuming at t = {self.engine.motion.time:.4f} s")
        else:
            self.standing_j = self._standing_energy(file) - self.energy_to_fall()
            self.engine.begin_shaking(self.grounds_at(0))
            self._note(self.engine.row()[None])
            self._keep()

    def _standing_energy(self, file: str) -> float:
        """Mechanical energy [J] in gravity equilibrium; 0, that of the unstrained structure, where
        there is none.
        """
        if not begins_unstrained(self.case, self.structure):
            return self.engine.potential()
        made = self.structure
        # forces alone do not say where links hold that are slack, or what is found or dropped rests
        straight = not (
            made.found
            or any(part.airborne for part in made.parts)
            or any(link.slack for link in made.links)
            or any(joint.on_dome for joint in made.joints)
        )
        if straight and unheld(self.structure, standing_of(self.case, self.structure)):
            return 0.0
        try:
            standing = upright(self.case, self.structure)
            return engine_of(self.case, standing, file, stands=True).mechanical()
        except NoEquilibrium:
            return 0.0

    def _fields(self) -> tuple[FieldWriter[SceneFields], SceneFields]:
        """Writer of the fields, and what expands a state to them."""
        from fecolumn.engines.scene.fields import FieldWriter

        fields = self.scene().fields()
        return FieldWriter(self.folder / "fields", fields, self.dt_s), fields

    def _states(self) -> States | None:
        every = self.case.output.state_interval_s
        return States(max(1, round(every / self.dt_s)), *self._bodies()) if every else None

    def _bodies(self) -> tuple[list[BodyModel], list[str]]:
        return [part.model for part in self.structure.parts], [
            part.name for part in self.structure.parts
        ]

    def _keep(self) -> None:
        """Keep the state of this step, and write its fields, where they are due."""
        if self.states and self.step % self.states.every == 0:
            self.states.add(self.engine)
        if self.fields and self.step % self.field_steps == 0:
            writer, fields = self.fields
            writer.add(self.engine.motion.time, fields.values(state_of(self.engine)))

    def run(self, stop: Callable[[], bool]) -> dict[str, Any]:
        """Step to the end, to the overturning, to rest or until `stop` says so; the summary."""
        cadence, engine = self.case.output, self.engine
        progress, passing = self.progress(), Passing(self.structure)
        pace = Pace(self, progress.say, engine.record)
        saved, over, off = time.perf_counter(), False, None
        try:
            while self.step < self.steps and not over:
                count = min(CHUNK, self.steps - self.step)
                if self.step < self.motion_steps:
                    count = min(count, self.motion_steps - self.step)
                count = passing.steps(engine.motion, self.dt_s, count)
                for every in (self.field_steps, self.states.every if self.states else 0):
                    if every:
                        count = min(count, every - self.step % every)
                over = self._advance_while_quick(count, pace) and self._stays()
                self.check_passing(passing, engine.motion)
                last = engine.made[-1]
                progress.show(
                    self.step,
                    {
                        "time": last[column_index("time")],
                        "tilt": last[column_index("tilt")],
                        "active_nodes": int(last[column_index("active_nodes")]),
                    },
                    engine.record,
                )
                self._keep()
                ended = stop()
                # what is over is no state to go on from
                due = ended or time.perf_counter() - saved > cadence.checkpoint_every_s
                if due and not over:
                    self._save()
                    saved = time.perf_counter()
                if ended and self.step < self.steps and not over:
                    raise KeyboardInterrupt
        except StepFailed as failure:
            off = self.off_or_failed(failure)
        except TooManyPoints as error:
            self._save()
            raise AnalysisFailed(f"t = {self.step * self.dt_s:.4g} s: {error}") from None
        finally:
            progress.end()
            pace.end()
        fallen = engine.fallen(self.steepest_at(self.step)) if over else STANDS
        if self.states:
            self.states.add(engine, last=True)
            self.states.write(self.folder, {"case_id": self.case.id, **self.code})
        return self.finish(
            off or self.ending(fallen, engine.motion.rotation[0]),
            self._dofs(),
            engine.record,
            0,
        )

    def time_steps(self) -> None:
        """Note how long each step takes."""
        self.step_times = StepTimes(self.engine.record, self.engine.call_s())

    def made_in_s(self) -> float:
        """Processor time [s] of the compiled steps so far."""
        return self.engine.spent_s

    def off_base(self, failure: StepFailed) -> Ending | None:
        """The Ending of a step that failed because a foot met the edge of its ground, or None."""
        motion = self.engine.motion

        def foot(joint: JointModel, model: BodyModel, nodes: Array) -> tuple[Array, Array]:
            frame, arms = motion.frames[joint.slave], model.arms[nodes]
            turn = motion.rotation[joint.slave].T
            return (
                frame["center"] + arms @ turn,
                frame["velocity"] + np.cross(frame["spin"], arms) @ turn,
            )

        return self.off_ground(failure, self.bases, motion.grounds, foot)

    def _dofs(self) -> int:
        """Degrees of freedom of all different meshes."""
        different = {id(part.model): part.model.dofs for part in self.structure.parts}
        return sum(different.values()) + sum(base.dofs for base in self.bases)

    def rigid_loss_share(self) -> float | None:
        """Energy that impacts took over what rigid-body theory says; None where any foot stands on
        a pad, whose dashpots take energy between impacts.
        """
        interfaces = self.engine.structure.interfaces
        return None if interfaces["on_pad"].any() else loss_share(self.engine.ledger, interfaces)

    def _stays(self) -> bool:
        """Whether what is lost or at rest stays so: what may rest anywhere is at rest once it has
        been still for a while.
        """
        if not self.rests_anywhere or self.engine.fallen(self.steepest_at(self.step)) != STANDS:
            return True
        steps = math.ceil(self.still_s() / self.dt_s)
        if self._advance(min(steps, self.steps - self.step), goes_on=True):
            return True
        return bool(self.engine.made[:, ENERGY].max(initial=0.0) <= self.still_j)

    def _advance_while_quick(self, count: int, pace: Pace) -> bool:
        """So many steps, fewer where they are slow; whether the column is lost or at rest."""
        end, began = self.step + count, time.perf_counter()
        while True:
            over = self._advance(min(pace.chunk(count), end - self.step))
            pace.look(self.engine.record)
            if over or self.step >= end or time.perf_counter() - began >= LOOK_S:
                return over

    def _advance(self, count: int, goes_on: bool = False) -> bool:
        """So many steps at most, also of what is at rest where it `goes_on`; whether the column is
        lost or at rest.

        Whatever error stops them, those made are noted.

        Raises
        ------
        StepFailed
            as `Engine.advance`. Any other error, of a full disk for example, once a checkpoint is
            written if the disk still takes it.
        """
        engine, steps, began, (made_s, made_cpu_s) = (
            self.engine,
            range(self.step + 1, self.step + count + 1),
            time.perf_counter(),
            self._made(),
        )
        grounds, steepest = self.grounds(steps), self.steepest(steps)
        failure, over = None, False
        try:
            standing = np.inf if self.rests_anywhere else self.standing_j
            rest = standing, -np.inf if goes_on else self.rest_j
            over = engine.advance(grounds, steepest, rest)[1]
        except Exception as error:  # of the disk, of memory, of the steps
            failure = error
        self._note(engine.made)
        self.step += len(engine.made)
        made_s, made_cpu_s = np.subtract(self._made(), (made_s, made_cpu_s)).tolist()
        self.began += made_s
        self.cpu_began += made_cpu_s
        self.stepping_s += time.perf_counter() - began - made_s
        if failure is None:
            return over
        # where compiled steps were broken off, the motion is of none of the rows
        if (
            not isinstance(failure, StepFailed)
            and engine.motion.time == self.history.last()["time"]
        ):
            with contextlib.suppress(OSError):
                self._save()
        raise failure

    def _made(self) -> tuple[float, float]:
        """Wall and processor time spent on what grounds keep for later analyses [s]."""
        kept = [base for base in self.bases if isinstance(base, (KnownBase, UnboundedBase))]
        return (
            float(sum(base.made_s for base in kept)),
            float(sum(base.made_cpu_s for base in kept)),
        )

    def _note(self, rows: Array) -> None:
        self.history.extend(columns_of(rows, self.structure))

    def _save(self) -> None:
        arrays = self._arrays(self.engine.work.stick.key[1] != 0.0)
        content = io.BytesIO()
        np.savez(
            content,
            **arrays,
            **base_to_resume(self.engine.surface),
            **self.to_resume(),
            **(self.states.to_resume() if self.states else {}),
        )
        write_bytes(self.folder / CHECKPOINT, content.getvalue())
        self.write_history()

    def _arrays(self, sticks: bool) -> dict[str, Array]:
        """What a checkpoint keeps: with the points, the stick operator where there is one, and what
        is learnt of it, so that an analysis that was interrupted goes on to the last digit as if it
        had not been.
        """
        engine = self.engine
        parts: dict[str, Any] = {"motion": engine.motion, "secant": engine.work.secant}
        if sticks:
            parts["stick"] = engine.work.stick
        arrays = {
            f"{part}.{name}": values
            for part, target in parts.items()
            for name, values in arrays_of(target).items()
        }
        return arrays | dict(points=engine.work.points, ledger=engine.ledger, counts=engine.counts)

    def _take(self, saved: dict[str, Any]) -> None:
        pairs = len(saved["motion.meetings.rows"])
        if pairs > len(self.engine.motion.meetings.rows):
            self.engine.make_room(pairs)
        targets = self._arrays("stick.key" in saved)
        for name, values in targets.items():
            if saved[name].shape != values.shape or not np.can_cast(
                saved[name].dtype, values.dtype, "equiv"
            ):
                raise ValueError(f"{name} does not fit")
        known, gathered = saved["base.known"], saved["base.gathered"]
        self.resumed(saved)
        if self.states:
            self.states.resumed(saved)
        for name, values in targets.items():
            values[...] = saved[name]
        self.engine.know_base(known)
        gather_again(self.engine.surface, gathered)
        interpreted(list_present)(self.engine.work.problem, self.engine.work.points)
