"""Time stepping with contact: HHT-alpha, contact forces at the end of the step, plastic impact when a contact closes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.contact.interface import ImpactUnsolved
from fecolumn.contact.restitution import returned_share
from fecolumn.dynamics.hht import HHT
from fecolumn.dynamics.rolling import rolled
from fecolumn.dynamics.stage import Stage, Stop, equilibrate
from fecolumn.dynamics.system import State

# Lengths over the foot's width, so that a larger specimen gives the same answer:
# a foot node farther than this above the base is open
OPEN = 1e-8
# a sticking node that moves less keeps its anchor to the last digit, so that stick does not creep
STUCK = 1e-10
# path of a point in a step above which it slides as part of the body; elastic slip of a standing foot is a tenth of it
SLIDE = 1e-7
# Work of contact over weight and foot's width above which a step is made again with the rim's points at rest
CREATED = 1e-6
# Share of the static compliance in the impact problem. A foot filtered to a long step moves almost rigidly and its many
# impulses would not be unique; the share leaves a closing velocity of about 1e-6 m/s.
YIELD = 1e-3


class StepFailed(RuntimeError):
    """A step did not converge even after the allowed cuts; `stop` says why."""

    def __init__(self, stop: Stop, message: str):
        super().__init__(message)
        self.stop = stop


@dataclass(slots=True)
class Record:
    """What the steps cost: iterations of positions and of contact problems, impacts, cuts."""

    iterations: int = 0
    contact_iterations: int = 0
    impacts: int = 0
    cuts: int = 0


class Stepper:
    """Advances a system by steps of HHT-alpha.

    impact = "plastic" (default). Contact forces act at the end of the step and are kept out of the accelerations that HHT
    blends (Kane, Repetto, Ortiz and Marsden 1999):

        x1 = x0 + dt v0 + dt^2 [(1/2 - beta) a0 + beta a1 + w1 / 2],   w = M^-1 U r
        v1 = v0 + dt [(1 - gamma) a0 + gamma a1 + w1],                 M a1 = (1+al) (F1 - f1) - al (F0 - f0)

    For alpha = 0 the contact's work is r1 (g1 - g0) <= 0 exactly, so that contact only takes energy. When a contact closes
    or slip ends in a step, the velocities are projected at its end: impulses of all touching points are replaced by those
    of a plastic impact with friction (Moreau 1988), the state of least kinetic energy that non-adhesive impulses reach.
    This removes the rebound that the trapezoidal rule invents; in the rigid limit it is Housner's impact.

    impact = "none" is the literal HHT scheme: contact forces are part of the accelerations, without filter or impact law.

    Args:
        system: bodies, contact, loads.
        ledger: energy ledger to book into.
        impact: "plastic" or "none".
        tolerance, max_iterations, max_cuts: of the [integration] section of a case.
    """

    def __init__(self, system, ledger, impact="plastic", tolerance=1e-7, max_iterations=20, max_cuts=4):
        self.system, self.ledger, self.plastic = system, ledger, impact == "plastic"
        self.tolerance, self.max_iterations, self.max_cuts = tolerance, max_iterations, max_cuts
        self.record = Record()

    def step(self, state: State, ground: np.ndarray) -> State:
        """State one dt later, under the ground acceleration `ground` (3,) [m/s2] at that time.

        Raises:
            StepFailed: no convergence after max_cuts halvings; `state` is unharmed.
        """
        return self._advance(state, ground, self.system.hht, 0)

    def _advance(self, state, ground, hht, cuts) -> State:
        booked = dict(self.ledger.work)
        try:
            return self._hht_step(state, ground, hht)
        except StepFailed as failure:
            self.ledger.work.update(booked)
            if cuts == self.max_cuts:
                cut = f" (step cut {cuts} times to {hht.dt:.3g} s)" if cuts else ""
                raise StepFailed(failure.stop, f"t = {state.time:.6g} s: {failure}{cut}") from None
            self.record.cuts += 1
            half = HHT(hht.dt / 2, hht.alpha)
            middle = self._advance(state, (state.ground + ground) / 2, half, cuts + 1)
            return self._advance(middle, ground, half, cuts + 1)

    def _hht_step(self, start, ground, hht, rolls=True) -> State:
        system, column, interface = self.system, self.system.column, self.system.interface
        state, booked = rolled(system, start, hht.dt, rolls), dict(self.ledger.work)
        dt, al, be, ga = hht.dt, hht.alpha, hht.beta, hht.gamma
        F0, F1 = system.load(state.ground), system.load(ground)
        spring = interface.spring(dt, state.indent)
        damping, resistance = system.damping, system.resistance
        damped = damping.force(state.v, state.rotation) if damping else 0.0
        turned = resistance.acceleration(state, dt) if resistance else 0.0
        resisted = column.apply(column.mass, turned) if resistance else 0.0
        stage = Stage(
            target=state.x + dt * state.v + dt**2 * (0.5 - be) * state.a,
            load=(1 + al) * F1 - al * F0 + al * (state.internal + damped) + resisted / (2 * be),
            start=system.kinematics.predicted(state.x, dt * state.v + dt**2 / 2 * (state.a + state.contact_a)),
            scale=1 / (2 * be) if self.plastic else 1.0, anchors=state.anchors, forces=state.forces, spring=spring, rotation=state.rotation,
            velocity=state.v + dt * (1 - ga) * state.a if damping else None)
        operators = system.operators(hht.mass_factor, hht.stiffness_factor, hht.rate_factor)
        outcome = equilibrate(system, operators, stage, self.tolerance, self.max_iterations)
        self.record.iterations += outcome.iterations
        self.record.contact_iterations += outcome.contact_iterations
        if outcome.stop is not Stop.CONVERGED:
            detail = outcome.message or f"residual {outcome.residual:.2e} of the weight after {outcome.iterations} iterations"
            raise StepFailed(outcome.stop, f"{outcome.stop.value}: {detail}")

        R, forces = outcome.halfway, outcome.forces
        after = State(
            time=state.time + dt, x=outcome.x, v=state.v, a=state.a, contact_a=state.contact_a, internal=outcome.internal,
            strain=outcome.strain, rotation=outcome.rotation, forces=forces, anchors=self._anchors(state, outcome, spring),
            relative=outcome.relative, static=outcome.static, ground=np.array(ground, float), indent=spring.indented(forces),
            rim_angle=state.rim_angle, rim_lift=state.rim_lift)
        push = interface.load(forces, R)
        if self.plastic:
            w = interface.acceleration(forces, R) + turned
            worked = push + resisted
        else:
            w = np.zeros_like(state.x)
            worked = (1 - ga) * interface.load(state.forces, R) + ga * push
        after.contact_a = w
        after.a = hht.mass_factor * (after.x - stage.target) - w / (2 * be)
        after.v = state.v + dt * ((1 - ga) * state.a + ga * after.a + w)
        if damping:
            # of the velocity without what of the contact's impulse has not moved the column yet; the same at alpha = 0
            damped = damped + damping.force(after.v - dt * al**2 / (4 * be) * w, after.rotation)
        contact_work = self._book(state, after, hht, F0 + F1, worked, damped, resisted, spring)
        if self.plastic and rolls and state is not start and contact_work > CREATED * system.weight * interface.width:
            # several points of the rim carry while it rolls fast: they stay for this step
            self.ledger.work.update(booked)
            return self._hht_step(start, ground, hht, rolls=False)
        if interface.pad is not None:
            # its springs bring a landing foot to rest in their own time: there is no impact
            return after
        landing = (state.forces[:, 2] <= 0) & (state.relative[:, 2] > OPEN * interface.width) & (forces[:, 2] > 0)
        if self.plastic:
            turning = self._turning(state, after, dt)
            # few points of many turn where a standing foot slips in part: that is elastic, not motion
            if landing.any() or 2 * forces[turning, 2].sum() > forces[:, 2].sum() > 0:
                try:
                    self._impact(state, after, hht, outcome.footing, landing, turning, contact_work)
                except ImpactUnsolved as error:
                    raise StepFailed(Stop.CONTACT, f"{Stop.CONTACT.value}: {error}") from None
        return after

    def _turning(self, state, after, dt) -> np.ndarray:
        """Points (n,) whose slip ends within the step, in stick or in slip the other way.

        Their velocity must be taken anew: the trapezoidal rule would turn a sticking point's velocity round for ever, and
        let friction push a returning point on its way.
        """
        touching = after.forces[:, 2] > 0
        pull = np.linalg.norm(state.forces[:, :2], axis=1)
        slid = (pull > 0) & (pull >= (1 - 1e-9) * self.system.interface.friction * state.forces[:, 2])
        slip = np.where(touching[:, None], after.anchors - state.anchors, 0.0)
        slips = np.any(slip != 0, axis=1)
        if not np.any(touching & (slid | slips)):
            return np.zeros(len(slid), bool)
        start, end = (self.system.interface.dynamic_velocity(v, after.rotation)[:, :2] for v in (state.v, after.v))
        against = np.minimum(np.einsum("na,na->n", start, slip), np.einsum("na,na->n", end, slip)) < 0
        moves = dt * np.linalg.norm(start, axis=1) > SLIDE * self.system.interface.width
        return touching & moves & (slid & ~slips | against & (state.forces[:, 2] > 0))

    def _anchors(self, state, outcome, spring) -> np.ndarray:
        """Where the points stick from now on: a slipping spring of penalty or pad keeps its elastic part."""
        elastic = spring.own[:, :2] * outcome.forces[:, :2] + spring.offset[:, :2]
        here = outcome.relative[:, :2] + elastic
        moved = (np.linalg.norm(here - state.anchors, axis=1) > STUCK * self.system.interface.width) | (outcome.forces[:, 2] <= 0)
        return np.where(moved[:, None], here, state.anchors)

    def _book(self, state, after, hht, load_sum, worked, damped, resisted, spring) -> float:
        """Energy of an HHT step; returns the work of contact [J]. From the identity
        dT = dx.(M a_mean + push) - dt^2 al^2/4 da.(M a_mean + push), a_mean = (1-ga) a0 + ga a1.

        damped: sum of the damping forces at both ends, resisted: rolling resistance, part of `worked`, each (n_owned, 3) [N] or 0;
        spring: of the step.
        """
        column, step = self.system.column, after.x - state.x
        mean = column.apply(column.mass, (1 - hht.gamma) * state.a + hht.gamma * after.a)
        total = mean + worked if self.plastic else mean
        smooth = mean if self.plastic else mean - worked
        algorithmic = column.dot(step, smooth - (load_sum - state.internal - after.internal) / 2)
        algorithmic -= hht.dt**2 * hht.alpha**2 / 4 * column.dot(after.a - state.a, total)
        carried = column.sum(np.einsum("cna,na->c", column.unit_loads, step))
        damping = -column.dot(step, damped) / 2 if self.system.damping else 0.0
        rolling = column.dot(step, resisted) if self.system.resistance else 0.0
        contact = column.dot(step, worked) - rolling + after.static - state.static
        dashpots = self.system.interface.pad_loss(spring, after.forces, after.indent)
        touching = after.forces[:, 2] > 0
        slip = np.where(touching[:, None], after.anchors - state.anchors, 0.0)
        friction = float(np.sum(after.forces[:, :2] * slip))
        landing = touching & (state.forces[:, 2] <= 0) & (self.system.interface.pad is None)
        landed = float(after.forces[landing, 2] @ (after.relative - state.relative)[landing, 2])
        self.ledger.add(base_work=-np.dot((state.ground + after.ground) / 2, carried), algorithmic=algorithmic - damping,
                        friction=friction, impact=landed, contact=contact - friction - landed + dashpots, damping=damping - dashpots, rolling=rolling)
        return contact

    def _impact(self, state, after, hht, footing, landing, turning, contact_work) -> None:
        """Replace the impulses of the step by those of a plastic impact; changes the velocities of `after`.

        The points of the foot that held the column before carry it until the moment of impact, all together from then on:
        two projections, without which the weight's impulse of the whole step would act at the new contact. Where a long step
        would gain energy by them, because its positions know the new contact only, a single projection is made, or none.
        """
        interface, column, R, dt = self.system.interface, self.system.column, after.rotation, hht.dt
        before = np.flatnonzero(state.forces[:, 2] > 0)
        union = np.flatnonzero((after.forces[:, 2] > 0) | (state.forces[:, 2] > 0))
        held = np.searchsorted(union, before)
        mobility = interface.turned(interface.foot.mobility, union, R)
        compliance = mobility + YIELD * 2 / dt**2 * interface.static_compliance(union, R, footing)
        rows = (3 * held[:, None] + np.arange(3)).ravel()
        given = dt * after.forces
        start, end = interface.dynamic_velocity(state.v, R), interface.dynamic_velocity(after.v, R)
        pushed = np.zeros_like(end)
        pushed[union] = (mobility @ given[union].ravel()).reshape(-1, 3)
        end -= pushed
        lands = bool(landing.any())
        moment = self._landing_moment(state, after, -dt * start[:, 2], landing) if lands \
            else self._turning_moment(state, after, start, end, pushed, turning)
        for share in (moment, 0.0) if lands and moment > 0 else (moment,):
            carried, first = interface.impact(before, compliance[np.ix_(rows, rows)], start + share * (end - start), share * dt * state.forces)
            velocity = np.array(end)
            velocity[union] += (mobility @ carried[union].ravel()).reshape(-1, 3)
            impulses, second = interface.impact(union, compliance, velocity, given - carried)
            self.record.contact_iterations += first.iterations + first.sweeps + second.iterations + second.sweeps
            changed = impulses + carried - given
            jump = interface.acceleration(changed, R)
            # judged by velocities relative to the base: whether contact takes energy must not depend on the frame
            taken = contact_work + np.sum(changed * interface.dynamic_velocity(after.v + jump / 2, R))
            if taken <= 0:
                break
        if taken > 0 and not lands:
            return
        if lands and interface.restitution and taken < 0:
            velocity = start + share * (end - start)
            velocity[union] += (mobility @ carried[union].ravel()).reshape(-1, 3)
            blow, third = interface.impact(union, compliance, velocity, impulses)
            self.record.contact_iterations += third.iterations + third.sweeps
            returned = interface.acceleration(blow, R)
            arrived = np.sum(blow * interface.dynamic_velocity(after.v + jump, R))
            jump += returned_share(interface.restitution, taken, arrived, np.sum(blow * interface.dynamic_velocity(returned, R))) * returned
        gained = column.dot(after.v + jump / 2, column.apply(column.mass, jump))
        self.ledger.add(**{"impact" if lands else "friction": gained})
        after.v = after.v + jump
        if self.system.damping:
            after.a = after.a - hht.stiffness_factor * self.system.damping.acceleration(jump, R)
        self.record.impacts += lands

    @staticmethod
    def _landing_moment(state, after, approach, landing) -> float:
        """Fraction of the step at which the landing points (mask) arrive, mean by their forces; `approach` (n,) in the step [m]."""
        gap = state.relative[landing, 2]
        return float(np.average(gap / np.maximum(approach[landing], gap), weights=after.forces[landing, 2]))

    def _turning_moment(self, state, after, start, end, pushed, turning) -> float:
        """Fraction of the step at which full friction ends the slip of the turning points (mask), mean by their forces.

        start, end: (n, 3) velocities at the ends of the step without its contact impulses; pushed: (n, 3) what these gave [m/s].
        """
        slip = (after.anchors - state.anchors)[turning]
        forward = np.einsum("na,na->n", start[turning, :2], slip) > 0
        slip = np.where(forward[:, None], slip, start[turning, :2])
        forces = after.forces[turning]
        # a point found to stick had less than full friction, possibly forwards
        share = np.linalg.norm(forces[:, :2], axis=1) / np.maximum(self.system.interface.friction * forces[:, 2], np.finfo(float).tiny)
        early, free, friction = (np.einsum("na,na->n", velocity[turning, :2], slip) for velocity in (start, end, pushed))
        late = free - np.abs(friction) / np.maximum(share, np.finfo(float).eps)
        fraction = np.divide(early, early - late, out=np.ones_like(early), where=(early > 0) & (late < 0))
        return float(np.average(fraction, weights=forces[:, 2]))
