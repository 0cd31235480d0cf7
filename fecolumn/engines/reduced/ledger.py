"""Energy ledger of the reduced engine: the terms of `dynamics.energy` in compiled code."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fecolumn.contact.points import GROUND
from fecolumn.contact.problem import near_points
from fecolumn.contact.work import losses
from fecolumn.engines.dynamics.links import end_links
from fecolumn.engines.reduced.elastic import ACCELERATION, COORDINATE, RATE, modal_strain
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.reduced.equilibrium import Work
    from fecolumn.engines.reduced.model import Scheme, Structure
    from fecolumn.engines.reduced.motion import MotionState

# Places in a ledger: the energy at the start, then the works in the order of dynamics.energy.TERMS
# [J]
(
    START_ENERGY,
    BASE_WORK,
    FRICTION_WORK,
    IMPACT_WORK,
    CONTACT_WORK,
    ALGORITHMIC_WORK,
    DAMPING_WORK,
    ROLLING_WORK,
    LINKS_WORK,
) = range(9)
N_TERMS = LINKS_WORK + 1
# then the places of `reduced.rigid_loss`. Of all impacts that are over: energy that they have taken
# from the rigid motion, energy that rigid bodies would have lost, and what friction took meanwhile
# [J]. Of the impact that goes on: its rigid loss, 0 if there is none; energy of the rigid motion
# and work of friction before it [J]; its beginning and end [s]; fastest approach [m/s], 0 once
# nothing approaches
(
    TAKEN,
    RIGID_LOSS,
    RUBBED,
    IMPACT_LOSS,
    LEFT,
    RUBBED_BEFORE,
    BEGAN,
    ENDS,
    APPROACH_SPEED,
) = range(N_TERMS, N_TERMS + 9)
N_PLACES = APPROACH_SPEED + 1


@njit
def rigid_kinetic(structure: Structure, motion: MotionState) -> float:
    """Kinetic energy of the bodies' rigid motion [J]."""
    total = 0.0
    for b in range(len(motion.frames)):
        v, w, J = motion.frames[b].velocity, motion.frames[b].spin, structure.bodies.body[b].inertia
        for a in range(3):
            total += structure.bodies.body[b].mass * v[a] * v[a] + w[a] * (
                J[a, 0] * w[0] + J[a, 1] * w[1] + J[a, 2] * w[2]
            )
    return total / 2


@njit(fastmath={"reassoc", "contract"})
def kinetic(structure: Structure, motion: MotionState) -> float:
    """Kinetic energy [J]."""
    total = 0.0
    for b in range(len(motion.frames)):
        for k in range(motion.modal.shape[2]):
            total += motion.modal[b, RATE, k] ** 2
    return total / 2 + rigid_kinetic(structure, motion)


@njit
def strain(structure: Structure, motion: MotionState) -> float:
    """Strain energy of the modes, and of what responds statically [J]."""
    total = motion.whole[0].static
    for b in range(len(motion.frames)):
        total += modal_strain(structure.squares[b], motion.modal[b, COORDINATE])
    return total


@njit
def weight_energy(structure: Structure, reference: Array, motion: MotionState) -> float:
    """Gravity energy relative to the centres of mass at `reference` (nb, 3) [J]."""
    total = 0.0
    for b in range(len(motion.frames)):
        for a in range(3):
            total -= (
                structure.bodies.body[b].mass
                * structure.gravity[a]
                * (motion.frames[b].center[a] - reference[b, a])
            )
    return total


@njit
def _work_of_grounds(
    structure: Structure, work: Work, start: MotionState, end: MotionState
) -> float:
    """Energy [J] that grounds which move relative to the first one bring in a step."""
    done = 0.0
    if len(start.grounds) == 1:
        return done
    for i in near_points(work.problem):
        if work.points[i].master == GROUND and end.contact[i].force[2] > 0.0:
            before, after = start.grounds[work.points[i].ground], end.grounds[work.points[i].ground]
            for a in range(3):
                done += end.contact[i].force[a] * (after.place[a] - before.place[a])
    for n in range(len(structure.links)):
        if structure.links[n].b == GROUND:
            before = start.grounds[structure.links[n].ground]
            after = end.grounds[structure.links[n].ground]
            for a in range(3):
                done += work.action.pulls[n, a] * (after.place[a] - before.place[a])
    return done


@njit
def _work_of_held(structure: Structure, work: Work, start: MotionState, end: MotionState) -> float:
    """Energy [J] that grounds which move relative to the first one bring in a step through the
    bodies that they hold: as much as contact and links take from these.
    """
    done = 0.0
    for b in range(len(structure.bodies.body)):
        if structure.bodies.body[b].held >= 0:
            for a in range(3):
                moved = end.frames[b].center[a] - start.frames[b].center[a]
                done -= work.action.push[b, a] * moved
    return done


@njit
def book(
    structure: Structure,
    scheme: Scheme,
    work: Work,
    start: MotionState,
    end: MotionState,
    ledger: Array,
) -> float:
    """Book a step before its impact; returns the work of contact but that of dashpots [J].

    Of the bodies as `dynamics.stepper`, of contact as `contact.work`.
    """
    al, ga, dt, action, done, algorithmic, moved_base = (
        scheme.alpha,
        scheme.gamma,
        scheme.dt,
        work.action,
        0.0,
        0.0,
        0.0,
    )
    numerical = dt**2 * al**2 / 4
    damping = rolling = 0.0
    for b in range(len(start.frames)):
        mass, before, after = structure.bodies.body[b].mass, start.frames[b], end.frames[b]
        for a in range(3):
            moved, push = after.center[a] - before.center[a], action.push[b, a]
            mean = mass * ((1 - ga) * before.acceleration[a] + ga * after.acceleration[a])
            shaken = (start.whole[0].ground[a] + end.whole[0].ground[a]) / 2
            algorithmic += moved * (mean - mass * (structure.gravity[a] - shaken)) - numerical * (
                after.acceleration[a] - before.acceleration[a]
            ) * (mean + push)
            done += moved * push + action.turn[b, a] * action.moment[b, a]
            rolling += action.turn[b, a] * action.resistance[b, a]
            moved_base -= shaken * mass * moved
        for k in range(start.modal.shape[2]):
            q0, q1 = start.modal[b, COORDINATE, k], end.modal[b, COORDINATE, k]
            a0, a1, push = (
                start.modal[b, ACCELERATION, k],
                end.modal[b, ACCELERATION, k],
                action.modal[b, k],
            )
            mean = (1 - ga) * a0 + ga * a1
            algorithmic += (q1 - q0) * (
                mean + structure.squares[b, k] * (q0 + q1) / 2
            ) - numerical * (a1 - a0) * (mean + push)
            done += (q1 - q0) * push
            # with the rate that the damping meets, see dynamics.stepper
            rate = end.modal[b, RATE, k] - dt * al**2 / (4 * scheme.beta) * push
            damping -= (q1 - q0) * structure.damping[b, k] * (start.modal[b, RATE, k] + rate) / 2
    tied, taken = end_links(structure, start, end, dt)
    carried = _work_of_grounds(structure, work, start, end)
    moved_base += carried + _work_of_held(structure, work, start, end)
    done -= carried
    contact = done - rolling + end.whole[0].static + tied - start.whole[0].static + taken
    end.whole[0].static += tied
    friction, landed, dashpots = losses(
        work.points,
        structure.interfaces,
        scheme.springs,
        near_points(work.problem),
        work.before,
        end.contact,
        contact,
    )
    ledger[BASE_WORK] += moved_base
    ledger[FRICTION_WORK] += friction
    ledger[IMPACT_WORK] += landed
    ledger[CONTACT_WORK] += contact - friction - landed + dashpots
    ledger[ALGORITHMIC_WORK] += algorithmic - damping
    ledger[DAMPING_WORK] += damping - dashpots
    ledger[ROLLING_WORK] += rolling
    ledger[LINKS_WORK] -= taken
    return contact + dashpots
