"""Time stepping with contact: HHT-alpha, contact forces at the end of the step, plastic impact when
a contact closes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.case.sections import SUBSTEPS
from fecolumn.contact.pose import move_grounds
from fecolumn.contact.rolling import least_rim_width, part_of_step
from fecolumn.contact.tolerances import CREATED, PARTS
from fecolumn.contact.work import move_anchors
from fecolumn.engines.dynamics.booking import StepMade, book_step
from fecolumn.engines.dynamics.collision import collide
from fecolumn.engines.dynamics.cuts import (
    IMPACT_PARTS,
    ROLLING_PARTS,
    Halving,
    StepFailed,
    Stop,
    in_halves,
)
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.record import Record
from fecolumn.engines.dynamics.stage import Stage, carried, equilibrate
from fecolumn.engines.dynamics.system import State
from fecolumn.fem.rotation import into_frames, out_of_frames
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.energy import Ledger
    from fecolumn.engines.dynamics.system import System


class Stepper:
    """Advances a system by steps of HHT-alpha.

    impact = "plastic" (default). Contact forces act at the end of the step and are kept out of the
    accelerations that HHT blends (Kane, Repetto, Ortiz and Marsden 1999):

        x1 = x0 + dt v0 + dt^2 [(1/2 - beta) a0 + beta a1 + w1 / 2],   w = M^-1 U r
        v1 = v0 + dt [(1 - gamma) a0 + gamma a1 + w1],
        M a1 = (1+al) (F1 - f1) - al (F0 - f0)

    For alpha = 0 the contact's work is r1 (g1 - g0) <= 0 exactly, so that contact only takes
    energy. When a contact closes or slip ends in a step, the velocities are projected at its end:
    impulses of all touching points are replaced by those of a plastic impact with friction (Moreau
    1988), the state of least kinetic energy that non-adhesive impulses reach. This removes the
    rebound that the trapezoidal rule invents; in the rigid limit it is Housner's impact.

    impact = "none" is nearly the literal HHT scheme: contact forces at the end of the step are part
    of the accelerations, without filter or impact law; those of links act as above.

    Parameters
    ----------
    system
        bodies, contact, loads.
    ledger
        energy ledger to book into.
    impact
        "plastic" or "none".
    tolerance, max_iterations, max_cuts, substeps
        of the [integration] section of a case.
    """

    def __init__(
        self,
        system: System,
        ledger: Ledger,
        impact: str = "plastic",
        tolerance: float = 1e-7,
        max_iterations: int = 20,
        max_cuts: int = 4,
        substeps: str = "rolling",
    ) -> None:
        self.system, self.ledger, self.plastic = system, ledger, impact == "plastic"
        self.tolerance, self.max_iterations, self.max_cuts = tolerance, max_iterations, max_cuts
        self.substeps, self.record = SUBSTEPS.index(substeps), Record()

    def step(self, state: State, ground: Array) -> State:
        """State one dt later; ground: (3 G,) accelerations [m/s2] of all grounds at that time.

        Raises
        ------
        StepFailed
            no convergence after max_cuts halvings; `state` is unharmed.
        """
        hht, booked, start, part, done = self.system.hht, dict(self.ledger.work), state, 0, 0
        counted = self.record.impacts, self.record.parts, self.record.cuts
        try:
            while done < PARTS:
                part = part or self._to_make_at_once(state, done)
                end, held, struck = done + part, dict(self.ledger.work), self.record.impacts
                target = (
                    start.ground + end / PARTS * (np.asarray(ground, float) - start.ground)
                    if end < PARTS
                    else np.asarray(ground, float)
                )
                after = self._part(
                    state, target, hht if part == PARTS else HHT(hht.dt * part / PARTS, hht.alpha)
                )
                if self.substeps == IMPACT_PARTS and part > 1 and self.record.impacts > struck:
                    self.ledger.work.update(held)
                    self.record.impacts, part = struck, part // 2
                    continue
                self.record.parts += part < PARTS
                state, part, done = after, 0, end
        except StepFailed as last:
            self.ledger.work.update(booked)
            self.record.impacts, self.record.parts, self.record.cuts = counted
            told = f"t = {start.time:.6g} s: {last}"
            raise StepFailed(last.stop, told, last.joints) from None
        state.time = start.time + hht.dt
        return state

    def _to_make_at_once(self, state: State, done: int) -> int:
        """How much of the step to make next, in dt / PARTS.

        A rim that is followed limits it, see `rolling.part_of_step`. Without one it is the largest
        part that may begin after `done` parts.
        """
        interface, kinematics, dt = (
            self.system.interface,
            self.system.kinematics,
            self.system.hht.dt,
        )
        if (
            self.substeps != ROLLING_PARTS
            or not self.plastic
            or not interface.interfaces["rim_count"].any()
        ):
            return done & -done or PARTS
        half = dt / 2
        later = state.x + half * state.v
        downs = interface.lowest_directions(interface.poses(state.x, state.rotation))
        rates = (
            interface.lowest_directions(interface.poses(later, kinematics.rotation(later))) - downs
        ) / half
        return min(
            interpreted(part_of_step)(*down, *rate, dt, done) for down, rate in zip(downs, rates)
        )

    def _part(self, state: State, ground: Array, hht: HHT) -> State:
        """A step of `hht`, in halves where it fails."""
        try:
            return self._hht_step(state, ground, hht)
        except StepFailed as failure:
            halving = Halving(self._hht_step, self.max_cuts, self._count_cut)
            return in_halves(halving, state, state.ground, ground, hht, failure)

    def _count_cut(self) -> None:
        self.record.cuts += 1

    def _hht_step(self, start: State, ground: Array, hht: HHT, rolls: bool = True) -> State:
        system, bodies, interface, booked = (
            self.system,
            self.system.bodies,
            self.system.interface,
            dict(self.ledger.work),
        )
        dt, al, be, ga = hht.dt, hht.alpha, hht.beta, hht.gamma
        before, rims, rolled = interface.begin_step(
            start, system.kinematics.rotation(start.x + dt / 2 * start.v), rolls
        )
        grounds = start.grounds.copy()
        move_grounds(start.grounds, np.asarray(ground, float), dt, grounds)
        interface.take_grounds(start.grounds, grounds)
        F0, F1 = system.load(start.ground), system.load(ground)
        damping, resistance, links = system.damping, system.resistance, system.links
        damped = damping.force(start.v, start.rotation) if damping else 0.0
        turned: Any = resistance.acceleration(start, dt) if resistance else 0.0
        resisted = bodies.momentum(turned) if resistance else 0.0
        stage = Stage(
            target=start.x + dt * start.v,
            load=(1 + al) * F1 - al * F0 + resisted / (2 * be),
            start=system.kinematics.predicted(
                start.x, dt * start.v + dt**2 / 2 * (start.a + start.contact_a)
            ),
            scale=1 / (2 * be) if self.plastic else 1.0,
            beside=1 / (2 * be),
            before=before,
            dt=dt,
            rotation=start.rotation,
            velocity=start.v if damping else None,
            centers=bodies.centers(start.x) if links else None,
            grounds=(start.grounds, grounds),
            ties=start.ties,
            memory=start.a,
            shares=(dt**2 * (0.5 - be), dt * (1 - ga)),
            held=al * (start.internal + damped),
            turns=self.plastic,
            place=start.x,
            internal=start.internal,
            levers=interface.levers(),
            surface_a=start.surface_a,
            surface_forces=start.surface_forces,
        )
        operators = system.of_step(hht)
        outcome = equilibrate(system, operators, stage, self.tolerance, self.max_iterations)
        self.record.iterations += outcome.iterations
        self.record.contact_iterations += interface.spent()
        if outcome.stop is not Stop.CONVERGED:
            detail = (
                outcome.message
                or f"residual {outcome.residual:.2e} of the weight after "
                f"{outcome.iterations} iterations"
            )
            raise StepFailed(outcome.stop, f"{outcome.stop.value}: {detail}")

        R, springs = outcome.halfway, interface.springs(dt)
        move_anchors(
            interface.points, interface.interfaces, springs, interface.near, before, outcome.contact
        )
        after = State(
            time=start.time + dt,
            x=outcome.x,
            v=start.v,
            a=start.a,
            contact_a=start.contact_a,
            internal=outcome.internal,
            strain=outcome.strain,
            rotation=outcome.rotation,
            contact=outcome.contact,
            static=outcome.static,
            ground=np.array(ground, float),
            rims=rims,
            ties=start.ties.copy(),
            grounds=grounds,
        )
        untwists: Any
        push, (moment_correction, transport_correction), w, untwists = (
            outcome.push,
            outcome.twist_corrections,
            turned,
            0.0,
        )
        # work of forces that HHT's remembered accelerations leave out, and of those they contain
        within: Any
        beside, within = resisted, 0.0
        # what grounds that move do
        carried_by = outcome.contact["force"]
        if self.plastic:
            moved = outcome.surface_a + moment_correction + transport_correction
            w, untwists = w + moved, bodies.momentum(moment_correction)
            beside = beside + push + bodies.momentum(transport_correction)
            after.surface_a, after.surface_forces = (
                into_frames(moved, R, bodies.rows),
                outcome.surface_forces,
            )
        else:
            within = (1 - ga) * interface.load(before["force"], R) + ga * push
            carried_by = (1 - ga) * before["force"] + ga * carried_by
        done = interface.carried(carried_by)
        if links:
            pulls = links.pulls(stage, after.x, after.rotation)
            beside, w = beside + links.load(pulls, R), w + links.acceleration(pulls, R)
            done += links.carried(pulls, start.grounds, grounds)
        middle = stage.middle(bodies, R)
        first: Any
        first, last = middle.memory, hht.mass_factor * (after.x - middle.target) - w / (2 * be)
        onward = after.rotation @ R.swapaxes(-1, -2)
        after.contact_a = w + np.zeros_like(start.x)
        after.a = carried(bodies, last, onward) if self.plastic else last
        after.v = start.v + dt * ((1 - ga) * first + ga * last + w)
        ends, drags = [start.internal, after.internal], []
        if damping:
            # a part of the contact's impulse, 0 at alpha = 0, has not moved the column yet: the
            # damping acts on the velocity without it
            drags = [damped, damping.force(after.v - dt * al**2 / (4 * be) * w, after.rotation)]
        inner, drag = (self._halfway(forces, start, after, R) for forces in (ends, drags))
        made = StepMade(
            start=start,
            before=before,
            after=after,
            hht=hht,
            ends=(first, last),
            load_sum=F0 + F1 - inner,
            untwists=untwists,
            beside=beside,
            within=within,
            carried=done,
            damped=drag,
            resisted=resisted,
            springs=springs,
        )
        contact_work = self._book(made)
        width = interpreted(least_rim_width)(interface.interfaces)
        if self.plastic and rolled and contact_work > CREATED * system.weight * width:
            # several points of the rim carry while it rolls fast: they stay for this step
            self.ledger.work.update(booked)
            return self._hht_step(start, ground, hht, rolls=False)
        if self.plastic:
            try:
                collide(system, made, contact_work, booked, self.ledger, self.record)
            except StepFailed:
                self.ledger.work.update(booked)
                raise
        return after

    def _halfway(self, forces: list[Any], start: State, after: State, R: Array) -> Array | int:
        """Sum (n_owned, 3) of internal forces at start and end of a step, as they act in it; 0 of
        none.
        """
        if self.plastic:
            forces = [
                out_of_frames(force, R @ state.rotation.swapaxes(-1, -2), self.system.bodies.rows)
                for force, state in zip(forces, (start, after))
            ]
        return sum(forces)

    def _book(self, made: StepMade) -> float:
        """As `booking.book_step`."""
        return book_step(self.system, made, self.ledger)
