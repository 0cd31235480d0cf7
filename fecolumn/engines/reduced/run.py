"""Steps of a reduced structure, many at a time: all that Python calls of the reduced engine's
compiled code. `engine` has what calls it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.arrays import put, put_matrix
from fecolumn.contact.ball import remove_lift
from fecolumn.contact.overturning import STANDS
from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import find_poses
from fecolumn.contact.problem import (
    ENDED,
    N_IMPACTS,
    N_ITERATIONS,
    N_PARTS,
    NO_ROOM,
    OK,
    ROLLS_FAST,
)
from fecolumn.contact.rolling import part_of_step
from fecolumn.contact.tolerances import PARTS
from fecolumn.contact.two_sided import mark_unused
from fecolumn.engines.dynamics.cuts import IMPACT_PARTS, ROLLING_PARTS
from fecolumn.engines.dynamics.links import end_links
from fecolumn.engines.reduced import motion as motions
from fecolumn.engines.reduced.balls import roll_balls
from fecolumn.engines.reduced.elastic import COORDINATE, END, START
from fecolumn.engines.reduced.equilibrium import find_equilibrium
from fecolumn.engines.reduced.found import has_pairs, lay_found
from fecolumn.engines.reduced.observe import ENERGY, observe, outcome_of_row
from fecolumn.engines.reduced.step import lay_points, step
from fecolumn.foundation._borrowed import borrowed
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.contact.projection import GroundTops
    from fecolumn.engines.reduced.elastic import Elastic
    from fecolumn.engines.reduced.equilibrium import Work
    from fecolumn.engines.reduced.model import Scheme, Structure
    from fecolumn.engines.reduced.motion import MotionState
    from fecolumn.engines.reduced.observe import View

# step lengths from a whole step to its smallest part
LENGTHS = PARTS.bit_length()


@njit
def is_lost_or_at_rest(
    view: View, motion: MotionState, row: Array, steepest: float, rest: tuple[float, float]
) -> bool:
    """Whether the column is lost or at rest after a step; rest: as of `Engine.advance`."""
    return (
        outcome_of_row(view, motion, row, steepest) != STANDS
        or max(row[ENERGY], row[ENERGY] + row[ENERGY + 1] + row[ENERGY + 2] - rest[0]) <= rest[1]
    )


@njit
def to_make_at_once(
    structure: Structure, motion: MotionState, dt: float, done: int, substeps: int
) -> int:
    """As `rolling.part_of_step`, of the rims of a structure where these are followed; substeps: a
    number of `case.sections.SUBSTEPS`.
    """
    part = PARTS
    while done % part:
        part //= 2
    for k in range(len(structure.interfaces) if substeps == ROLLING_PARTS else 0):
        if structure.interfaces[k].rim_count > 0 and not motion.rims[k].unused:
            x, y, u, v = lowest_direction(structure.interfaces[k], motion)
            part = min(part, part_of_step(x, y, u, v, dt, done))
    return part


@njit
def lowest_direction(interface: Record, motion: MotionState) -> tuple[float, float, float, float]:
    """Way down to the master's surface along the slave's axes x and y, and its rate [1/s]."""
    b, m, axes = interface.slave, interface.master, interface.axes
    R, spin, normal, rate = motion.rotation[b], motion.frames[b].spin, np.empty(3), np.empty(3)
    for a in range(3):
        normal[a], rate[a] = R[2, a], spin[a]
    if m != GROUND:
        M, other = motion.rotation[m], motion.frames[m].spin
        for a in range(3):
            normal[a] = 0.0
            for c in range(3):
                up = M[c, 0] * axes[0, 2] + M[c, 1] * axes[1, 2] + M[c, 2] * axes[2, 2]
                normal[a] += up * R[c, a]
                rate[a] -= R[c, a] * (M[c, 0] * other[0] + M[c, 1] * other[1] + M[c, 2] * other[2])
    return (
        -normal[0],
        -normal[1],
        normal[2] * rate[1] - normal[1] * rate[2],
        normal[0] * rate[2] - normal[2] * rate[0],
    )


@njit
def begin_anew(elastic: Elastic) -> None:
    """Copy what is known at the end of a step to the start of the next."""
    elastic.now[START] += 1
    for i in range(elastic.node.shape[1]):
        if elastic.stamp[END, i] == elastic.now[END]:
            elastic.stamp[START, i] = elastic.now[START]
            for a in range(3):
                elastic.node[START, i, a] = elastic.node[END, i, a]


class StepState(NamedTuple):
    """State that steps go on from. motion: MotionState, after them; spare, kept: room for one;
    ledger: (N_PLACES,); counts: (N_COUNTS,).
    """

    motion: motions.MotionState
    spare: motions.MotionState
    kept: motions.MotionState
    ledger: Array
    counts: Array


class StepBatch(NamedTuple):
    """The steps that are asked for. grounds: (k, 3 G) [m/s2] accelerations of the G grounds at
    their ends. steepest: (k,) as of `overturning.fallen` after each. rest: as of `Engine.advance`.
    substeps: for what a step is made in parts, a number of `case.sections.SUBSTEPS`. rows: (k,
    width) of the history, to be filled.
    """

    grounds: Array
    steepest: Array
    rest: tuple[float, float]
    substeps: int
    rows: Array


@njit
def advance(
    structure: Structure,
    base: GroundTops,
    schemes: tuple[Scheme, Scheme, Scheme, Scheme, Scheme, Scheme, Scheme],
    work: Work,
    view: View,
    course: StepState,
    chunk: StepBatch,
) -> tuple[int, int]:
    """Make the steps of a StepBatch: how many were made, and why they ended. `motion` of the
    StepState is then the state after them.

    schemes: of a whole step, its half, its quarter ... down to 1/PARTS of it. The caller may give
    the first one in the place of all: the answer ROLLS_FAST then asks for the others. Where impacts
    are located, a part of a step in which a point lands is halved, down to the smallest part.

    A StepBatch without steps asks for one of two other things. Where it has a row, the row of the
    present `motion` is filled. Else one proximal step towards gravity equilibrium is made by the
    first scheme, from `motion` to `spare` (`start.gravity_equilibrium`). Both are made here because
    a function that Python calls is compiled together with all that it calls: one such function
    compiles sooner than three.
    """
    structure, base, schemes, work, view, course, chunk = borrowed(
        (structure, base, schemes, work, view, course, chunk)
    )
    motion, spare, kept, ledger, counts = course
    grounds, steepest, rest, substeps, rows = chunk
    elastic, bodies, scheme, longest = (
        work.elastic,
        len(motion.frames),
        schemes[0],
        len(schemes) - 1,
    )
    elastic.now[START] += 1
    if len(grounds) == 0:
        if len(rows):
            observe(structure, work.points, work.poses[END], view, motion, ledger, 0, rows[0])
            return 0, OK
        fall, still, bent = (
            np.empty((bodies, 3)),
            np.zeros((bodies, 3)),
            np.empty((bodies, motion.modal.shape[2])),
        )
        for b in range(bodies):
            put(motion.modal[b, COORDINATE], bent[b])
            for a in range(3):
                fall[b, a] = motion.frames[b].center[a]
                if structure.bodies.body[b].held < 0 and not structure.bodies.body[b].airborne:
                    # its weight over the mass that the search for rest gives it
                    heavier = structure.bodies.body[b].mass * structure.bodies.body[b].inverse_mass
                    fall[b, a] += scheme.half * structure.gravity[a] * heavier
        return 0, proximal_step(
            structure, base, scheme, work, motion, fall, bent, still, spare, counts
        )
    booked, held, now, then, swapped, made, answer, target = (
        ledger.copy(),
        ledger.copy(),
        motion,
        spare,
        False,
        0,
        OK,
        np.empty(grounds.shape[1]),
    )
    for a in range(3):
        motion.grounds[0].acceleration[a] = motion.whole[0].ground[a]
    for k in range(len(grounds)):
        before, struck_before, parts_before = (
            counts[N_ITERATIONS],
            counts[N_IMPACTS],
            counts[N_PARTS],
        )
        put(ledger, booked)
        part, done = to_make_at_once(structure, now, scheme.dt, 0, substeps), 0
        if part < PARTS or substeps == IMPACT_PARTS:
            if schemes[longest].dt == scheme.dt:
                answer = ROLLS_FAST
                break
            motions.copy(now, kept)
        while done < PARTS:
            halved, whole = 0, PARTS
            while whole > part:
                halved, whole = halved + 1, whole // 2
            for a in range(grounds.shape[1]):
                first = kept.grounds[a // 3].acceleration[a % 3] if part < PARTS else 0.0
                target[a] = first + (done + part) / PARTS * (grounds[k, a] - first)
            struck = counts[N_IMPACTS]
            put(ledger, held)
            answer = step(structure, base, schemes[halved], work, now, target, then, ledger, counts)
            if answer != OK:
                break
            if substeps == IMPACT_PARTS and part > 1 and counts[N_IMPACTS] > struck:
                put(held, ledger)
                counts[N_IMPACTS], part = struck, part // 2
                continue
            now, then, swapped, done = then, now, not swapped, done + part
            counts[N_PARTS] += part < PARTS
            begin_anew(elastic)
            if done < PARTS:
                part = to_make_at_once(structure, now, scheme.dt, done, substeps)
        if answer != OK:  # the step is made again
            put(booked, ledger)
            counts[N_IMPACTS], counts[N_PARTS] = struck_before, parts_before
            if done > 0:
                motions.copy(kept, now)
                elastic.now[START] += 1
            break
        now.whole[0].time = now.whole[0].time if part == PARTS else kept.whole[0].time + scheme.dt
        observe(
            structure,
            work.points,
            work.poses[END],
            view,
            now,
            ledger,
            counts[N_ITERATIONS] - before,
            rows[made],
        )
        made += 1
        if is_lost_or_at_rest(view, now, rows[made - 1], steepest[k], rest):
            answer = ENDED
            break
    if swapped:
        # a step that failed for want of the base's compliance tells by its end in `spare` where it
        # is wanted
        for b in range(bodies):
            for a in range(3):
                work.action.push[b, a] = motion.frames[b].center[a]
            put_matrix(motion.rotation[b], work.action.halfway[b])
        motions.copy(spare, motion)
        for b in range(bodies):
            for a in range(3):
                spare.frames[b].center[a] = work.action.push[b, a]
            put_matrix(work.action.halfway[b], spare.rotation[b])
    return made, answer


@njit
def proximal_step(
    structure: Structure,
    base: GroundTops,
    scheme: Scheme,
    work: Work,
    motion: MotionState,
    fall: Array,
    bent: Array,
    still: Array,
    spare: MotionState,
    counts: Array,
) -> int:
    """A proximal step towards equilibrium: OK, or the code of what failed.

    The places of points on balls and the links are brought along, which a step does elsewhere.
    """
    for i in range(len(motion.contact)):
        work.before[i] = motion.contact[i]
    for when in (START, END):
        find_poses(
            structure.interfaces,
            motion.grounds,
            motion.frames,
            motion.rotation,
            work.poses[when],
            None,
        )
    motions.copy_grounds(motion, spare)
    for k in range(len(structure.interfaces)):
        spare.rims[k] = motion.rims[k]
        if structure.interfaces[k].ball > 0.0:
            remove_lift(work.points, k)
            roll_balls(structure, k, work, motion, spare)
    # once, as those of joints below
    if has_pairs(motion.meetings):
        motions.copy_meetings(motion.meetings, spare.meetings)
    elif lay_found(structure, 0.0, work, motion, spare) != OK:
        return NO_ROOM
    for joint in structure.overlaps.joints:
        if not spare.rims[joint.forward].placed:
            # once: the points stay while the bodies come to rest, by micrometres
            mark_unused(
                structure.overlaps,
                structure.interfaces,
                motion.frames,
                work.poses[START],
                spare.rims,
            )
            lay_points(structure, 0.0, work, motion, spare)
            break
    answer = find_equilibrium(
        structure, base, scheme, work, motion, fall, bent, still, spare.rims, spare, counts
    )
    if answer == OK:
        spare.whole[0].static += end_links(structure, motion, spare, scheme.dt)[0]
    return answer
