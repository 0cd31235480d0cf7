"""How rigid bodies went in a motion, and what of it is measured: the same in every program."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.planar.bodies import GRAVITY
from benchmarks.programs.structures import OVERTURNED, RigidBodies

#: Between rows, and between those at which energies are compared, as of fecolumn's histories [s]
EVERY, _JUDGED = 1e-3, 5e-3


@dataclass(frozen=True)
class Course:
    """Rows of a motion in a program.

    Attributes
    ----------
    place, velocity
        (n, nb, 3) of the centres of mass [m], [m/s], relative to the ground.
    turn
        (n, nb, 4) unit quaternions, w first.
    spin
        (n, nb, 3) angular velocity in the body's frame [rad/s].
    ground
        (n, 3) acceleration [m/s2] at the rows.
    row_s
        time between rows [s].
    cpu_s, steps, unsolved
        processor time of the steps [s], their number, and those whose contact was not solved to the
        program's tolerance.
    """

    place: np.ndarray
    velocity: np.ndarray
    turn: np.ndarray
    spin: np.ndarray
    ground: np.ndarray
    row_s: float
    cpu_s: float
    steps: int
    unsolved: int = 0


def in_plane(place: np.ndarray, velocity: np.ndarray) -> dict:
    """Fields of a Course of places and velocities (n, nb, 3) in the plane: x, z, angle
    counterclockwise.
    """
    zero = np.zeros_like(place[..., 0])
    half = -place[..., 2] / 2
    return dict(
        place=np.stack([place[..., 0], zero, place[..., 1]], axis=-1),
        velocity=np.stack([velocity[..., 0], zero, velocity[..., 1]], axis=-1),
        turn=np.stack([np.cos(half), zero, np.sin(half), zero], axis=-1),
        spin=np.stack([zero, -velocity[..., 2], zero], axis=-1),
    )


def turned(turn: np.ndarray, arm: np.ndarray) -> np.ndarray:
    """A vector (3,) of the body's frame in the ground's: (..., 3), turn (..., 4)."""
    w, axis = turn[..., :1], turn[..., 1:]
    return arm + 2 * np.cross(axis, np.cross(axis, arm) + w * arm)


def way_of_top(bodies: RigidBodies, course: Course) -> np.ndarray:
    """Horizontal displacement (n, 2) [m] of the observed top."""
    one, arm = bodies.observed, bodies.top
    here = course.place[:, one] + turned(course.turn[:, one], arm)
    return (here - bodies.place[one] - arm)[:, :2]


def tilts(course: Course) -> np.ndarray:
    """(n, nb) [rad] of the bodies to the vertical."""
    return np.arccos(np.clip(turned(course.turn, np.array([0.0, 0.0, 1.0]))[..., 2], -1, 1))


def fed_in(bodies: RigidBodies, course: Course) -> tuple[float, float]:
    """Largest rise of kinetic energy and that of gravity, less the work of the ground [J]: friction
    and impacts only take; and what our sum of that work may be off by.

    In the frame of the ground each body is pushed by -m a, whose work is -m a dx with the mean of a
    over a row; the error is a third of what rows twice as long change.
    """
    speed, spin = (course.velocity**2).sum(axis=-1), course.spin**2
    kinetic = (speed @ bodies.mass + (spin * bodies.inertia).sum(axis=(1, 2))) / 2
    balance = kinetic + GRAVITY * course.place[..., 2] @ bodies.mass
    middle = np.einsum("nbi,b->ni", course.place, bodies.mass)
    work = work_of(middle, course.ground)
    twice = work_of(middle[::2], course.ground[::2])
    off = float(np.abs(twice - work[::2]).max()) / 3
    balance = (balance - work)[:: max(1, round(_JUDGED / course.row_s))]
    return float((balance - np.minimum.accumulate(balance)).max()), off


def work_of(moment: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Work (n,) [J] so far of a ground with accelerations a (n, 3) [m/s2] on bodies whose masses
    times places are (n, 3) [kg m].
    """
    each = -((a[1:] + a[:-1]) / 2 * np.diff(moment, axis=0)).sum(axis=1)
    return np.concatenate([[0.0], np.cumsum(each)])


def measured(bodies: RigidBodies, course: Course) -> dict:
    """Of the summary: overturned once a body tilts by more than OVERTURNED, or at the end by more
    than the critical tilt.
    """
    tilt, (rise, off) = tilts(course), fed_in(bodies, course)
    overturned = bool(tilt.max() > OVERTURNED or tilt[-1].max() > bodies.critical)
    peak = float(np.linalg.norm(way_of_top(bodies, course), axis=1).max())
    return dict(
        u_max_m=peak,
        overturned=overturned,
        fed_in=rise / bodies.barrier,
        energy_closure_rel=off / bodies.barrier,
        steps=course.steps,
        cpu_s=course.cpu_s,
        unsolved=course.unsolved,
    )
