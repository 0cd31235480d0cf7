"""Contact forces and motion at the end of a step: laws of contact on the moved points, laws of motion under the forces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn._compiled import njit
from fecolumn.contact.arrays import put_matrix
from fecolumn.contact.points import CONTACT
from fecolumn.contact.problem import (
    ITERATIONS_SPENT,
    N_ITERATIONS,
    OK,
    STICKS_STILL,
    Problem,
    begin_problem,
    find_forces,
    find_residual,
    mark_close,
    near_points,
    room,
    stored_energy,
)
from fecolumn.contact.stick import Stick, holds, no_stick
from fecolumn.contact.tolerances import CLOSE, ITERATIONS, PAD_TURN, STICK_STAYS, STICK_TURN, STICK_WAY
from fecolumn.reduced.elastic import COORDINATE, END, Elastic, START, find_all_elastic, find_elastic, find_position, locate_start, no_elastic
from fecolumn.reduced.motion import Action, follow, no_action


class Work(NamedTuple):
    """Room and memory of steps. points: (P,) of POINT in the step; before: (P,) of CONTACT, what the start brings to them; problem, stick: of
    `contact`; action, elastic: of `reduced.motion`; positions, early, late: (P, 3); places: (N, 3); marked, landing, turning: (P,) or (N,) masks."""

    points: np.ndarray
    before: np.ndarray
    problem: Problem
    stick: Stick
    action: Action
    elastic: Elastic
    positions: np.ndarray
    early: np.ndarray
    late: np.ndarray
    places: np.ndarray
    wanted: np.ndarray
    landing: np.ndarray
    turning: np.ndarray


def work_of(structure, points) -> Work:
    """For the points (P,) of a Structure."""
    n, nodes = len(points), len(structure.bodies.arms)
    bodies, modes = structure.squares.shape
    return Work(points.copy(), np.zeros(n, CONTACT), room(n), no_stick(n), no_action(modes, bodies), no_elastic(nodes, n),
                *(np.zeros((n, 3)) for _ in range(3)), np.zeros((nodes, 3)), np.zeros(nodes, bool), np.zeros(n, bool), np.zeros(n, bool))


@njit
def stays(interface, start, free_center, advance):
    """Whether the foot stays in its place long enough for finding its stick operator to pay."""
    way, turn = 0.0, 0.0
    for a in range(3):
        turn = max(turn, abs(advance[0, a]))
        if a < 2:
            way = max(way, abs(free_center[0, a] - start.frames[0].center[a]))
    if interface.on_pad:
        return turn < STICK_STAYS * PAD_TURN
    flat = np.hypot(start.rotation[0, 2, 0], start.rotation[0, 2, 1]) < STICK_TURN
    return flat and turn < STICK_STAYS * STICK_TURN and way < STICK_STAYS * STICK_WAY * interface.width


@njit
def find_positions(structure, work, start, end):
    """Positions of the points at the END of the step; those of points too high to matter without their elastic displacement."""
    interface, points, elastic, positions = structure.interfaces[0], work.points, work.elastic, work.positions
    all_of_them = work.problem.flags[STICKS_STILL]
    for b in range(len(end.frames)):
        stored = 0.0
        for k in range(end.modal.shape[2]):
            stored += structure.squares[b, k] * end.modal[b, COORDINATE, k] ** 2
        # no node moves farther than the modes' energy allows
        reach = np.sqrt(stored)
        if all_of_them and end.modal.shape[2] > 0:
            find_all_elastic(structure, b, end, elastic, END)
        for i in range(len(points)):
            if points[i].slave != b:
                continue
            arm, R = points[i].arm, end.rotation
            for a in range(3):
                positions[i, a] = end.frames[b].center[a] + R[b, a, 0] * arm[0] + R[b, a, 1] * arm[1] + R[b, a, 2] * arm[2]
            positions[i, 2] += points[i].lift
            # a point of the rim moves with nodes near to its own, which may reach farther, but not twice as far
            high = positions[i, 2] > CLOSE * interface.width + 2 * reach * structure.reach[points[i].node]
            if high and not all_of_them and not (work.before[i].force[2] > 0 or end.contact[i].force[2] > 0):
                continue
            if work.before[i].force[2] <= 0:
                locate_start(structure, points, i, start, elastic, work.before, work.places[0])
            find_elastic(structure, points, i, end, elastic, END)
            find_position(points, i, end, elastic, END, positions[i])


@njit
def equilibrate(structure, base, scheme, work, start, free_center, free_modal, advance, rim_angle, end, counts):
    """Find forces and motion at the end of a step; the motion is exact for the forces at every iteration of `contact.problem`.

    Args:
        start: Motion at the start; work.points and work.before bring the first guess of the forces, and the anchors.
        free_center, free_modal, advance: see `motion.follow`. rim_angle: of the first interface.
        end: gets center, rotation, modal coordinates, contact, static energy.
    Returns: a way to end.
    """
    interface, points, before, problem, elastic = structure.interfaces[0], work.points, work.before, work.problem, work.elastic
    carrying = 0
    for i in range(len(points)):
        end.contact[i] = before[i]
        if before[i].force[2] > 0:
            problem.near[carrying] = i
            carrying += 1
    problem.count[0] = carrying
    still = holds(work.stick, interface, rim_angle, scheme.half, points[0].arm[2], start.frames[0].center, start.rotation[0])
    put_matrix(advance, work.action.turn)
    for i in near_points(problem):
        find_elastic(structure, points, i, start, elastic, START)
        for a in range(3):
            elastic.point[END, i, a] = elastic.point[START, i, a]
    begin_problem(problem, still, not still and stays(interface, start, free_center, advance))
    for iteration in range(ITERATIONS):
        counts[N_ITERATIONS] += 1
        follow(structure, scheme, points, near_points(problem), start, free_center, free_modal, advance, elastic, end, work.action)
        find_positions(structure, work, start, end)
        if iteration == 0 or not problem.flags[STICKS_STILL]:
            mark_close(problem, interface, work.positions, before, end.contact)
        answer, residual = find_residual(problem, structure.bodies, base, points, interface, scheme.springs, scheme.dynamic, scheme.half, work.stick,
                                         rim_angle, end.frames[0].center, end.rotation, work.positions, iteration == 0, before, end.contact, counts)
        if answer != OK:
            return answer
        if residual <= 1.0:
            end.whole[0].static = stored_energy(problem, points, interface, scheme.springs, before, end.contact)
            return OK
        answer = find_forces(problem, points, interface, work.stick, end.contact, counts)
        if answer != OK:
            return answer
    return ITERATIONS_SPENT
