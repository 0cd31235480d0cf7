"""Contact forces and motion at the end of a step: laws of contact on the moved points, laws of
motion under the forces.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.arrays import put, put_matrix
from fecolumn.contact.forces import find_forces, find_residual, stored_energy
from fecolumn.contact.outline import lower_raised, raise_or_leave, was_beyond
from fecolumn.contact.pad import begin_yielding, find_yielding
from fecolumn.contact.points import CONTACT, GROUND, OVER
from fecolumn.contact.pose import POSE, find_poses
from fecolumn.contact.problem import (
    ASSEMBLED,
    ITERATIONS_SPENT,
    N_ITERATIONS,
    OFF_PATCH,
    OK,
    STICKS_STILL,
    WORTH_STICK,
    Problem,
    begin_problem,
    list_near_points,
    near_points,
    present_points,
    room,
)
from fecolumn.contact.stick import Stick, holds, is_worth, no_stick, same_points
from fecolumn.contact.tolerances import (
    IN_PLACE_LEFT,
    IN_PLACE_SLOW,
    IN_PLACE_TURN,
    ITERATIONS,
    LEVEL,
    STALLED,
    STALLED_BY,
)
from fecolumn.engines.reduced.elastic import (
    END,
    START,
    Elastic,
    find_elastic,
    find_on_master,
    find_position,
    no_elastic,
)
from fecolumn.engines.reduced.follow import begin_frames, follow
from fecolumn.engines.reduced.motion import Action, no_action
from fecolumn.engines.reduced.positions import Positions, find_positions, no_positions
from fecolumn.engines.reduced.secant import Secant, no_secant, predict_slips, update_secant
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.contact.projection import GroundTops
    from fecolumn.engines.reduced.model import Scheme, Structure
    from fecolumn.engines.reduced.motion import MotionState


class Work(NamedTuple):
    """Room and memory of steps. points: (P,) of POINT in the step; before: (P,) of CONTACT, what
    the start brings to them; problem, stick: of `contact`; secant: of `reduced.secant`; action,
    elastic: of `reduced.motion`; poses: (2, ni) of POSE at START and END of a step;
    positions: of `reduced.positions`; early, late: (P, 3); places: (N, 3); wanted: (N,), landing:
    (P,), turning: (P,) masks.
    """

    points: Array
    before: Array
    problem: Problem
    stick: Stick
    secant: Secant
    action: Action
    elastic: Elastic
    poses: Array
    positions: Positions
    early: Array
    late: Array
    places: Array
    wanted: Array
    landing: Array
    turning: Array


def work_of(structure: Structure, points: Array) -> Work:
    """For the points (P,) of a Structure."""
    n, nodes = len(points), len(structure.bodies.arms)
    bodies, modes = structure.squares.shape
    return Work(  # type: ignore[call-arg]  # of unknown number
        points.copy(),
        np.zeros(n, CONTACT),
        room(points),
        no_stick(n, len(structure.interfaces)),
        no_secant(n),
        no_action(modes, bodies, len(structure.interfaces), len(structure.links)),
        no_elastic(nodes, n),
        np.zeros((2, len(structure.interfaces)), POSE),
        no_positions(n, len(structure.interfaces), bodies),
        *(np.zeros((n, 3)) for _ in range(2)),
        np.zeros((nodes, 3)),
        np.zeros(nodes, bool),
        np.zeros(n, bool),
        np.zeros(n, bool),
    )


@njit
def stays(
    interfaces: Array,
    points: Array,
    before: Array,
    poses: Array,
    start: MotionState,
    rims: Array,
    free_center: Array,
    advance: Array,
    reach: float,
) -> bool:
    """Whether all feet stay in their places long enough for finding their stick operator to pay;
    poses: at the start, rims: (ni,) of RIM at the end, reach: as of `stick.is_worth`.

    Faces that are not level may touch without any load, where points open and close and the
    operator costs more than it saves: all points of theirs must carry.
    """
    for i in range(len(points)):
        level = abs(interfaces[points[i].interface].axes[2, 2]) > LEVEL
        if not (level or points[i].idle or before[i].force[2] > 0):
            return False
    for k in range(len(interfaces)):
        if rims[k].apart:
            continue
        way, turn, b = 0.0, 0.0, interfaces[k].slave
        if not same_points(start.rims[k].angle, rims[k].angle):
            # they rolled in this step, and would in the next
            return False
        for a in range(3):
            turn = max(turn, abs(advance[b, a]))
            if a < 2:
                way = max(way, abs(free_center[b, a] - start.frames[b].center[a]))
        if not is_worth(interfaces[k], poses[k], turn, way, reach):
            return False
    return True


@njit
def find_sunk(
    structure: Structure, base: GroundTops, work: Work, start: MotionState, rims: Array
) -> None:
    """Raise the points that come from beyond an outline and are below the surface at the START of a
    step, or mark them as SUNK, and lower those that were raised before; see `contact.outline`.
    """
    points, before, problem, poses, place = (
        work.points,
        work.before,
        work.problem,
        work.poses[START],
        work.places[0],
    )
    loaded = problem.count[0]
    count = loaded
    for i in present_points(problem):
        k, now = points[i].interface, before[i]
        comes = was_beyond(now, start.rims[k], rims[k])
        if not comes and not now.raised > 0.0:
            continue
        if not comes and now.force[2] > 0:
            lower_raised(points[i], now, 0.0, structure.interfaces[k].width)
            continue
        find_elastic(structure, points, i, start, work.elastic, START)
        find_position(points, i, start, work.elastic, START, place)
        find_on_master(structure, points, i, start, poses, work.elastic, START, place)
        if not comes:
            lower_raised(points[i], now, place[2], structure.interfaces[k].width)
            continue
        now.raised = 0.0
        if points[i].beyond == OVER and place[2] < 0.0:
            problem.near[count] = i
            put(place, problem.slack[i])
            count += 1
    if count > loaded:
        for i in problem.near[:loaded]:
            if points[i].master != GROUND:
                find_position(points, i, start, work.elastic, START, problem.slack[i])
                find_on_master(
                    structure, points, i, start, poses, work.elastic, START, problem.slack[i]
                )
        raise_or_leave(
            structure.bodies,
            base,
            points,
            structure.interfaces,
            poses,
            before,
            problem.near[:count],
            loaded,
            problem.slack,
            problem.displaced,
        )


@njit
def find_arms(structure: Structure, work: Work, end: MotionState) -> None:
    """Elastic displacements and seats at the END of the step of the points that carry, on which
    their moments depend.
    """
    points, elastic, poses, place = work.points, work.elastic, work.poses[END], np.empty(3)
    find_poses(structure.interfaces, end.grounds, end.frames, end.rotation, poses, end.rims)
    for i in near_points(work.problem):
        if end.contact[i].force[2] > 0:
            find_elastic(structure, points, i, end, elastic, END)
            if points[i].master != GROUND:
                find_position(points, i, end, elastic, END, place)
                find_on_master(structure, points, i, end, poses, elastic, END, place)


@njit
def find_equilibrium(
    structure: Structure,
    base: GroundTops,
    scheme: Scheme,
    work: Work,
    start: MotionState,
    free_center: Array,
    free_modal: Array,
    advance: Array,
    rims: Array,
    end: MotionState,
    counts: Array,
) -> int:
    """Find forces and motion at the end of a step; the motion is exact for the forces at every
    iteration of `contact.problem`.

    Parameters
    ----------
    start
        MotionState at the start; work.points and work.before bring the first guess of the forces,
        and the anchors.
    free_center, free_modal, advance
        see `follow.follow`.
    rims
        (ni,) of RIM at the end.
    end
        gets center, rotation, modal coordinates, contact, static energy.

    Returns: OK, or the code of what failed.
    """
    interfaces, points, before, problem, elastic, poses = (
        structure.interfaces,
        work.points,
        work.before,
        work.problem,
        work.elastic,
        work.poses,
    )
    carrying, came, foreseen, found = 0, False, False, structure.found.interface
    last, again, anew = np.inf, False, False
    # of joints they are known
    find_poses(
        interfaces[found:],
        start.grounds,
        start.frames,
        start.rotation,
        poses[START][found:],
        None,
    )
    for i in range(len(points)):
        end.contact[i] = before[i]
    for i in present_points(problem):
        points[i].beyond = OVER
        came |= before[i].beyond or before[i].raised > 0.0
        if before[i].force[2] > 0:
            problem.near[carrying] = i
            carrying += 1
    problem.count[0] = carrying
    # several elastic bodies bend at their joints by more than a foot on the ground turns; where
    # most points are open, those that carry are cheaper alone
    bends = len(interfaces) > 1 and start.modal.shape[2] > 0 and 2 * carrying > problem.count[2]
    reach = IN_PLACE_TURN if bends else 1.0
    still = holds(work.stick, interfaces, rims, scheme.half, poses[START], 1.0)
    in_place = (
        bends
        and not still
        and holds(work.stick, interfaces, rims, scheme.half, poses[START], reach)
    )
    put_matrix(advance, work.action.turn)
    for i in near_points(problem):
        find_elastic(structure, points, i, start, elastic, START)
        if points[i].master != GROUND:
            find_position(points, i, start, elastic, START, work.places[0])
            find_on_master(
                structure, points, i, start, poses[START], elastic, START, work.places[0]
            )
        for a in range(3):
            elastic.point[END, i, a], elastic.seat[END, i, a] = (
                elastic.point[START, i, a],
                elastic.seat[START, i, a],
            )
    if came:  # over an outline, in this step or before
        find_sunk(structure, base, work, start, rims)
    begin_problem(
        problem,
        still or in_place,
        not still
        and not in_place
        and stays(
            interfaces, points, before, poses[START], start, rims, free_center, advance, reach
        ),
        in_place,
    )
    begin_frames(structure, start, free_center, advance, end, work.action)
    begin_yielding(points, scheme.springs)
    for iteration in range(ITERATIONS):
        counts[N_ITERATIONS] += 1
        if not follow(
            structure,
            scheme,
            points,
            near_points(problem),
            start,
            free_center,
            free_modal,
            advance,
            elastic,
            end,
            work.action,
        ):
            return ITERATIONS_SPENT
        if iteration == 1 and len(interfaces) > 1 and (in_place or not problem.flags[STICKS_STILL]):
            # the first forces found in the step bend the bodies: with the arms that these then
            # have, else there would be one iteration more
            find_arms(structure, work, end)
            if not follow(
                structure,
                scheme,
                points,
                near_points(problem),
                start,
                free_center,
                free_modal,
                advance,
                elastic,
                end,
                work.action,
            ):
                return ITERATIONS_SPENT
        known, placed = find_positions(structure, work, start, end, iteration == 0)
        if not known:
            return OFF_PATCH
        if iteration == 0 or not problem.flags[STICKS_STILL]:
            list_near_points(
                problem, placed, points, interfaces, work.positions.place, before, end.contact
            )
        if find_yielding(points, scheme.springs, near_points(problem), end.contact):
            # the operator of feet that stick is that of pads that do not yield
            problem.flags[ASSEMBLED] = problem.flags[STICKS_STILL] = False
            problem.flags[WORTH_STICK] = False
        answer, residual = find_residual(
            problem,
            structure.bodies,
            base,
            points,
            interfaces,
            scheme.springs,
            scheme.dynamic,
            scheme.half,
            work.stick,
            rims,
            poses[END],
            work.positions.place,
            iteration == 0,
            before,
            end.contact,
            counts,
        )
        if answer != OK:
            return answer
        if foreseen and iteration == 1:
            update_secant(work.secant, points, near_points(problem), problem.slack, end.contact)
        by_operator = problem.flags[STICKS_STILL] and in_place
        if residual <= 1.0 and (not by_operator or again or residual <= IN_PLACE_LEFT):
            for i in present_points(problem):
                end.contact[i].beyond = points[i].beyond != OVER
                end.contact[i].raised = before[i].raised
            end.whole[0].static = stored_energy(
                problem, points, interfaces, scheme.springs, before, end.contact
            )
            return OK
        slow = iteration > 2 and residual > max(IN_PLACE_SLOW * last, 1.0)
        stalled = iteration >= STALLED and residual > STALLED_BY * last
        again, last = residual <= 1.0, residual
        if iteration == 0 and problem.flags[STICKS_STILL]:
            predict_slips(work.secant, near_points(problem), problem.slack)
            foreseen = True
        answer = find_forces(problem, points, interfaces, work.stick, end.contact, stalled, counts)
        if by_operator and (answer != OK or slow and anew):
            problem.flags[STICKS_STILL], work.stick.key[1] = False, 0.0
        elif answer != OK:
            return answer
        elif by_operator and slow:
            # found where the feet are now, once
            problem.flags[WORTH_STICK] = anew = True
    return ITERATIONS_SPENT
