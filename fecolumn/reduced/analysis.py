"""One analysis with the reduced engine, from a case to the result files of any analysis."""

from __future__ import annotations

import io
import time

import numpy as np

from fecolumn._compiled import compiled
from fecolumn.atomic import write_bytes
from fecolumn.case import GRAVITY
from fecolumn.contact.law import interface_compliance
from fecolumn.contact.rim import Rim
from fecolumn.dynamics.hht import HHT
from fecolumn.dynamics.stepper import StepFailed
from fecolumn.progress import Progress
from fecolumn.reduced import motion as motions
from fecolumn.reduced import start
from fecolumn.reduced.cache import load_model, model_folder
from fecolumn.reduced.observe import COLUMNS, view
from fecolumn.reduced.run import Engine, advance
from fecolumn.simulation import CHECKPOINT, Analysis, AnalysisFailed

# Steps between looks at the clock, Ctrl-C and the progress line: well below a second
CHUNK = 500


def engine_of(case, model, base) -> Engine:
    """The reduced engine of a case at its start."""
    own = interface_compliance(case.contact, case.material.youngs_modulus_pa, case.mesh.fine_size_m, model.areas)
    plan, initial = case.integration, case.initial

    def begin(engine):
        if initial.tilt_rad:
            return start.tilted(engine, initial.tilt_rad, np.radians(initial.direction_deg))
        return start.standing(engine)

    return Engine(model, base, view(model, case.overturn.displacement_m), HHT(plan.dt_s, plan.alpha_hht), [0.0, 0.0, -GRAVITY],
                  case.contact.friction_coefficient, own, Rim.find(model.reference), begin, plan.max_cuts)


class ReducedAnalysis(Analysis):
    """A running analysis of the reduced engine."""

    def __init__(self, case, folder, comm, file, quiet):
        super().__init__(case, folder, comm, file, quiet)
        ready = compiled(advance)
        known = ready and model_folder(case).is_dir()
        self.model, self.base, self.model_folder = load_model(case, self.say)
        self.warn_of_base(self.base.frequency, file)
        if not ready:
            self.say("compiling the reduced engine, once on this machine: a minute or two")
        self.engine = engine_of(case, self.model, self.base)
        if not known:  # what is made once is no cost of this analysis
            self.began = time.perf_counter()
        self.fields = self._fields() if self.field_steps else None
        if (folder / CHECKPOINT).is_file():
            self._resume()
            self.say(f"resuming at t = {self.engine.motion.scalars[motions.TIME]:.4f} s")
        else:
            self.engine.motion.ground[:] = self.ground(0)
            self._note(self.engine.row()[None])
            if self.fields:
                self.fields.write(self.engine)

    def _fields(self):
        from fecolumn.reduced.fields import ReducedFields

        return ReducedFields(self.folder / "fields", self.case, self.model, self.model_folder)

    def run(self, stop) -> dict:
        """Step to the end, to the overturning or until `stop` says so; the summary."""
        cadence, engine = self.case.output, self.engine
        progress = Progress(self.steps, self.case.integration.dt_s, quiet=self.quiet)
        saved, overturned = time.perf_counter(), False
        try:
            while self.step < self.steps and not overturned:
                began, made_s, count = time.perf_counter(), self.base.made_s, min(CHUNK, self.steps - self.step)
                if self.fields:
                    count = min(count, self.field_steps - self.step % self.field_steps)
                grounds = np.array([self.ground(self.step + k) for k in range(1, count + 1)])
                rows, overturned = engine.advance(grounds)
                self.step += len(rows)
                made_s = self.base.made_s - made_s
                self.began += made_s
                self.stepping_s += time.perf_counter() - began - made_s
                self._note(rows)
                last = rows[-1]
                progress.show(self.step, dict(time=last[0], tilt=last[4], active_nodes=int(last[11])), engine.record)
                if self.fields and self.step % self.field_steps == 0:
                    self.fields.write(engine)
                ended = stop()
                if ended or time.perf_counter() - saved > cadence.checkpoint_every_s:
                    self._save()
                    saved = time.perf_counter()
                if ended and self.step < self.steps and not overturned:
                    raise KeyboardInterrupt
        except StepFailed as failure:
            self._note(engine.made)
            self.step += len(engine.made)
            self._save()
            raise AnalysisFailed(f"{failure}; state saved in {self.folder / CHECKPOINT}") from None
        finally:
            progress.end()
        return self.finish(overturned, self.model.dofs + self.base.dofs, engine.record, 0)

    def _note(self, rows: np.ndarray) -> None:
        columns, place = {}, 0
        for name, width in COLUMNS:
            values = rows[:, place] if width == 1 else rows[:, place:place + width]
            columns[name] = values.astype(int) if name in ("active_nodes", "iterations") else values.copy()
            place += width
        self.history.extend(columns)

    def _save(self) -> None:
        engine = self.engine
        arrays = {f"motion.{name}": values for name, values in engine.motion._asdict().items()}
        # with its bed, so that an analysis that was interrupted goes on to the last digit as if it had not been
        arrays |= {f"bed.{name}": values for name, values in engine.bed._asdict().items()}
        arrays |= dict(ledger=engine.ledger, counts=engine.counts, last_tilt=engine.last_tilt)
        content = io.BytesIO()
        np.savez(content, **arrays, **self.to_resume())
        write_bytes(self.folder / CHECKPOINT, content.getvalue())
        self.write_history()

    def _resume(self) -> None:
        engine = self.engine
        with np.load(self.folder / CHECKPOINT) as file:
            saved = {name: file[name] for name in file.files}
        for prefix, target in (("motion", engine.motion), ("bed", engine.bed)):
            for name, values in target._asdict().items():
                values[...] = saved[f"{prefix}.{name}"]
        engine.ledger[:], engine.counts[:], engine.last_tilt[:] = saved["ledger"], saved["counts"], saved["last_tilt"]
        self.resumed(saved)
