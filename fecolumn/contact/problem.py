"""The contact problem of a step: which points take part in it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.points import OVER
from fecolumn.contact.tolerances import CLOSE
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array

# Ways a step can end; FAR_BASE asks for more of the base's compliance, ROLLS_FAST for shorter
# steps, ENDED ends the analysis; OFF_PATCH: a point stands on a part of a moving master that has no
# nodes in the contact; NO_ROOM: more pairs of bodies are near each other than there is room for
(
    OK,
    FAR_BASE,
    OFF_BASE,
    CONTACT_FAILED,
    ITERATIONS_SPENT,
    IMPACT_FAILED,
    ENDED,
    ROLLS_FAST,
    OFF_PATCH,
    NO_ROOM,
) = range(10)
# Places in a record of counts
N_ITERATIONS, N_CONTACT, N_IMPACTS, N_CUTS, N_PARTS, N_IMPACT_CONTACT, N_ASSEMBLED = range(7)
N_COUNTS = 7


class Problem(NamedTuple):
    """Room and memory of the contact problem of n points within a step.

    near: (n,) points that are low or carry force, as many as the first of `count` (3,) says: those
    of which more than the place matters; active: (n,) those that take part, `count[1]` of them;
    evened: (n,) those whose `uneven` is found. present: (n,) points that are not idle, `count[2]`
    of them. displaced: (n, 3) static displacement, slack: (n, 3) slips and gaps [m]; rho: (n,)
    stiffness by which the laws are measured [N/m], allowed: (n,) by how much they may be violated
    [m]. W: (9 n^2,) room for the compliance of the active points, own, levers, moved: of
    bodies that do not deform, as `own`, `levers` and `bodies` of Coupling. flags: (5,) whether it
    is assembled, the foot stays where its stick operator holds, it stays long enough for finding
    one, the active points are of bodies that do not deform, and the operator tells only how forces
    change: displacement and laws are those of where the points are.
    """

    near: Array
    present: Array
    count: Array  # type: ignore[assignment]  # hides that of tuples
    active: Array
    evened: Array
    displaced: Array
    slack: Array
    rho: Array
    allowed: Array
    W: Array
    own: Array
    levers: Array
    moved: Array
    flags: Array


ASSEMBLED, STICKS_STILL, WORTH_STICK, ALL_STIFF, IN_PLACE = range(5)


def room(points: Array) -> Problem:
    """For points (n,) of POINT."""
    n, present = len(points), np.zeros(len(points), np.int64)
    taking = np.flatnonzero(~points["idle"])
    present[: len(taking)] = taking
    return Problem(  # type: ignore[call-arg]  # of unknown number
        np.zeros(n, np.int64),
        present,
        np.array([0, 0, len(taking)]),
        *(np.zeros(n, bool) for _ in range(2)),
        np.zeros((n, 3)),
        np.zeros((n, 3)),
        np.zeros(n),
        np.zeros(n),
        np.zeros(9 * n * n),
        np.zeros((n, 3)),
        np.zeros((n, 3, 12)),
        np.zeros((n, 2), np.int64),
        np.zeros(5, bool),
    )


@njit
def begin_problem(problem: Problem, holds_still: bool, worth: bool, in_place: bool = False) -> None:
    """A new step: whether the stick operator holds where the foot is, whether finding one pays, and
    whether it tells only how forces change.
    """
    for i in range(len(problem.active)):
        problem.active[i] = problem.evened[i] = False
    problem.flags[ASSEMBLED], problem.flags[STICKS_STILL], problem.flags[WORTH_STICK] = (
        False,
        holds_still,
        worth,
    )
    problem.flags[IN_PLACE] = in_place


@njit
def list_present(problem: Problem, points: Array) -> None:
    """List the points (P,) of POINT that are not idle."""
    count = 0
    for i in range(len(points)):
        if not points[i].idle:
            problem.present[count] = i
            count += 1
    problem.count[2] = count


@njit
def present_points(problem: Problem) -> Array:
    """The points (k,) that are not idle."""
    return problem.present[: problem.count[2]]


@njit
def list_near_points(
    problem: Problem,
    placed: Array,
    points: Array,
    interfaces: Array,
    positions: Array,
    before: Array,
    after: Array,
) -> None:
    """List the points that are low or carry force: those of which more than the place matters;
    placed: (k,) points of which some may, all others are known to be high.
    """
    count, everyone = 0, problem.flags[STICKS_STILL]
    for i in placed:
        height = CLOSE * interfaces[points[i].interface].width
        close = (
            everyone or positions[i, 2] < height or after[i].force[2] > 0 or before[i].force[2] > 0
        )
        # one beyond an outline is high above the surface, which is not where it will be when it is
        # over that again
        after[i].located = close and points[i].beyond == OVER
        if close:
            problem.near[count] = i
            count += 1
        else:
            problem.active[i] = False
    problem.count[0] = count


@njit
def near_points(problem: Problem) -> Array:
    """The listed points (k,)."""
    return problem.near[: problem.count[0]]
