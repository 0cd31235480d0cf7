"""Steps of a structure in time: Moreau's midpoint scheme with the gap at the end of the step, cut
where a corner lands.

    q_m = q + dt/2 v;   M (v' - v) = dt F(q_m) + J(q_m)^T p;   q' = q_m + dt/2 v'

A corner on a face may approach it by no more than its gap: g(q_m + dt v') >= 0. What it moves
across and along the face in a step is measured on the circles on which it turns, with the
velocities of a first solution on their tangents: a pivot neither opens nor creeps. Between impacts
this is the scheme SHAKE, of second order. A step in which a corner would land is cut there, an
impact (e = 0) takes no time, and the rest of the step follows: so an impact errs by dt^2, too, and
none sinks in. Sources: Moreau (1988), Unilateral contact and dry friction in finite freedom
dynamics, CISM 302; Jean (1999), The non-smooth contact dynamics method, Comput. Methods Appl. Mech.
Eng. 177.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from benchmarks.planar.bodies import GRAVITY, Structure
from benchmarks.planar.contact import DEEPEST, EDGE, NEAR, jacobian, locate, near
from benchmarks.planar.nsgs import OPEN, TOLERANCE, solve

#: Tilt of a body at which the structure has fallen [rad]
FALLEN = np.pi / 4
#: What has sunk in is lifted by so much in a whole step at most [m]
_LIFTED = 1e-9
#: Landings in a step at most; corners that would land after these approach by their gaps
_CUTS = 20
#: Gap over g dt^2 below which a corner is on its face; the pivot of a fast turn opens by less
_CLOSED = 0.1


@dataclass(frozen=True)
class History:
    """Motion of a structure.

    Attributes
    ----------
    time
        (n,) [s].
    place
        (n, nb, 3) [m, m, rad] and velocity: (n, nb, 3) of the centres of mass, relative to the
        ground.
    energy
        (n, 5) [J]: kinetic, of gravity, work of the ground so far, of contacts so far across and
        along their faces.
    fallen
        whether a body tilted by more than FALLEN, which ends it.
    unsolved
        steps whose friction problem was solved to more than TOLERANCE only.
    cpu_s, steps
        processor time of the steps [s], and their number, where a program tells them.
    """

    structure: Structure
    time: np.ndarray
    place: np.ndarray
    velocity: np.ndarray
    energy: np.ndarray
    fallen: bool
    unsolved: int
    cpu_s: float = np.nan
    steps: int = 0

    @property
    def tilt(self) -> np.ndarray:
        """Of the bodies, positive towards +x: (n, nb) [rad]."""
        return -self.place[..., 2]

    @property
    def closure(self) -> float:
        """Largest error of the energy balance [J]."""
        balance = self.energy[:, 0] + self.energy[:, 1] - self.energy[:, 2:].sum(axis=1)
        return float(np.abs(balance - balance[0]).max())

    def top(self, body: int) -> np.ndarray:
        """Displacement along x of the middle of the top of a quadrilateral: (n,) [m]."""
        middle = np.mean(self.structure.ends(body, 2), axis=0)
        return (
            self.structure.point(body, middle, self.place)[:, 0]
            - self.structure.point(body, middle, self.structure.place)[0]
        )


def advance(
    structure: Structure,
    ground: np.ndarray,
    dt: float,
    *,
    place=None,
    velocity=None,
    every: int = 1,
) -> History:
    """Motion under horizontal accelerations (n + 1,) of the ground [m/s2] at the ends of n steps of
    dt [s], straight lines between them.

    Parameters
    ----------
    place, velocity
        (nb, 3) at the start; left out: standing.
    every
        steps between rows of the history.
    """
    place = (structure.place if place is None else place).copy()
    velocity = np.zeros_like(place) if velocity is None else np.array(velocity, float)
    rows, energy, fallen, unsolved = _advance(
        1 / structure.mass,
        1 / structure.inertia,
        structure.pairs,
        structure.shape,
        structure.friction,
        place,
        velocity,
        np.ascontiguousarray(ground, float),
        dt,
        every,
    )
    return History(
        structure,
        dt * every * np.arange(len(rows)),
        rows[:, 0],
        rows[:, 1],
        energy,
        bool(fallen),
        int(unsolved),
    )


@njit(cache=True)
def _advance(lightness, ease, pairs, shape, friction, place, velocity, ground, dt, every):
    """Rows (k, 2, nb, 3) of places and velocities, energies (k, 5), whether it fell, steps left
    unsolved; lightness, ease: 1 over mass and inertia.
    """
    bodies, most, steps = len(place), len(pairs), len(ground) - 1
    rows, energy, made, unsolved, fallen = (
        np.empty((steps // every + 1, 2, bodies, 3)),
        np.zeros((steps // every + 1, 5)),
        1,
        0,
        False,
    )
    found, state, impulse, work = (
        np.empty(most, np.int64),
        np.zeros(most, np.int64),
        np.zeros((most, 2)),
        np.zeros(3),
    )
    rows[0, 0], rows[0, 1] = place, velocity
    measure(lightness, ease, place, velocity, work, energy[0])
    for k in range(steps):
        if not step(
            lightness,
            ease,
            pairs,
            shape,
            friction,
            place,
            velocity,
            (ground[k] + ground[k + 1]) / 2,
            dt,
            found,
            state,
            impulse,
            work,
        ):
            unsolved += 1
        if (k + 1) % every == 0:
            rows[made, 0], rows[made, 1] = place, velocity
            measure(lightness, ease, place, velocity, work, energy[made])
            made += 1
            if np.abs(place[:, 2]).max() > FALLEN:
                fallen = True
                break
    return rows[:made], energy[:made], fallen, unsolved


@njit(cache=True)
def measure(lightness, ease, place, velocity, work, row):
    """Put kinetic energy, energy of gravity and the works so far [J] into row (5,)."""
    row[:2] = 0.0
    for b in range(len(place)):
        if lightness[b] > 0.0:
            row[0] += (
                (velocity[b, 0] ** 2 + velocity[b, 1] ** 2) / lightness[b]
                + velocity[b, 2] ** 2 / ease[b]
            ) / 2
            row[1] += GRAVITY * place[b, 1] / lightness[b]
    row[2:] = work


@njit(cache=True)
def step(
    lightness,
    ease,
    pairs,
    shape,
    friction,
    place,
    velocity,
    shaken,
    dt,
    found,
    state,
    impulse,
    work,
):
    """One step in place; shaken: acceleration of the ground in it [m/s2]. state (nc,), impulse (nc,
    2): of the step before. Whether all friction was solved.

    Corners whose gap is below a fifth of what a fall from rest covers in a step are on their faces.
    """
    left, error, closed = dt, 0.0, _CLOSED * GRAVITY * dt * dt
    for cut in range(_CUTS + 1):
        n = near(place, pairs, shape, closed if cut < _CUTS else NEAR * dt, found)
        h, share, done, then, booked = left, 1.0, velocity, velocity, work
        for _ in range(2):
            then, booked, done = velocity.copy(), work.copy(), place + h / 2 * velocity
            missed = kick(
                lightness,
                ease,
                pairs,
                shape,
                friction,
                done,
                then,
                shaken,
                h,
                dt,
                found[:n],
                state,
                impulse,
                booked,
            )
            done += h / 2 * then
            if share < 1.0 or cut == _CUTS:
                break
            share = landing(place, done, pairs, shape, closed)
            if share == 1.0:
                break
            h *= share
        place[:], velocity[:], work[:], error = done, then, booked, max(error, missed)
        left -= h
        if share == 1.0:
            break
        n = near(place, pairs, shape, closed, found)
        error = max(
            error,
            kick(
                lightness,
                ease,
                pairs,
                shape,
                friction,
                place,
                velocity,
                shaken,
                0.0,
                dt,
                found[:n],
                state,
                impulse,
                work,
            ),
        )
    return error <= TOLERANCE


@njit(cache=True)
def landing(place, ahead, pairs, shape, closed):
    """Share of the way from `place` to `ahead` at which the first open corner lands, 1 if none
    does.
    """
    share = 1.0
    for c in range(len(pairs)):
        s, g = locate(ahead, pairs[c], shape[c])
        if -EDGE <= s <= shape[c, 6] + EDGE and -DEEPEST < g < 0.0:
            before = locate(place, pairs[c], shape[c])[1]
            if before > closed:
                share = min(share, before / (before - g))
    return share


@njit(cache=True)
def kick(
    lightness,
    ease,
    pairs,
    shape,
    friction,
    place,
    velocity,
    shaken,
    h,
    dt,
    found,
    state,
    impulse,
    work,
):
    """Put the velocities after forces of a time h of a step dt and the impulses at the corners
    `found` into `velocity`: error of the impulses [m/s].

    h = 0: an impact.
    """
    before, free, n = velocity.copy(), velocity.copy(), len(found)
    for b in range(len(place)):
        if lightness[b] > 0.0:
            free[b, 0] -= h * shaken
            free[b, 1] -= h * GRAVITY
    J, q, bent, mu, p, states = (
        np.empty((n, 2, 2, 3)),
        np.empty(2 * n),
        np.zeros(2 * n),
        np.empty(n),
        np.empty(2 * n),
        np.empty(n, np.int64),
    )
    for i in range(n):
        c = found[i]
        jacobian(place, pairs[c], shape[c], J[i])
        q[2 * i], q[2 * i + 1] = along(J[i, 0], pairs[c], free), along(J[i, 1], pairs[c], free)
        if h > 0.0:
            gap = locate(place, pairs[c], shape[c])[1]
            q[2 * i] += gap / h if gap > 0.0 else max(gap, -_LIFTED) / dt
        mu[i], p[2 * i], p[2 * i + 1], states[i] = (
            friction[c],
            impulse[c, 0],
            impulse[c, 1],
            state[c],
        )
    W = delassus(J, pairs, found, lightness, ease)
    error = solve(W, q, mu, p, states)
    push(free, J, pairs, found, p, lightness, ease, velocity)
    if h > 0.0:
        bend(place, pairs, shape, found, J, velocity, h, bent)
        error = solve(W, q + bent, mu, p, states)
        push(free, J, pairs, found, p, lightness, ease, velocity)
    state[:] = OPEN
    impulse[:] = 0.0
    mean = (before + velocity) / 2
    for i in range(n):
        state[found[i]], impulse[found[i], 0], impulse[found[i], 1] = (
            states[i],
            p[2 * i],
            p[2 * i + 1],
        )
        for a in range(2):
            work[1 + a] += p[2 * i + a] * along(J[i, a], pairs[found[i]], mean)
    for b in range(len(place)):
        if lightness[b] > 0.0:
            work[0] -= h * shaken * mean[b, 0] / lightness[b]
    return error


@njit(cache=True)
def push(free, J, pairs, found, p, lightness, ease, velocity):
    """Put the velocities after the impulses p (2 n,) into `velocity`; free: (nb, 3) without
    them.
    """
    velocity[:] = free
    for i in range(len(J)):
        for a in range(2):
            for e in range(2):
                b = pairs[found[i], e]
                velocity[b, 0] += lightness[b] * J[i, a, e, 0] * p[2 * i + a]
                velocity[b, 1] += lightness[b] * J[i, a, e, 1] * p[2 * i + a]
                velocity[b, 2] += ease[b] * J[i, a, e, 2] * p[2 * i + a]


@njit(cache=True)
def bend(place, pairs, shape, found, J, velocity, dt, bent):
    """Put into bent (2 n,) the mean rates [m/s] of the gaps and ways of a step with that velocity
    over those at its middle, circles over tangents.
    """
    ahead = place + dt * velocity
    for i in range(len(J)):
        c = found[i]
        (s, g), (s_ahead, g_ahead) = (
            locate(place, pairs[c], shape[c]),
            locate(ahead, pairs[c], shape[c]),
        )
        bent[2 * i] = (g_ahead - g) / dt - along(J[i, 0], pairs[c], velocity)
        bent[2 * i + 1] = (s_ahead - s) / dt - along(J[i, 1], pairs[c], velocity)


@njit(cache=True)
def along(rows, pair, velocity):
    """Rate of a coordinate of gradients (2, 3) at velocities (nb, 3)."""
    rate = 0.0
    for e in range(2):
        for a in range(3):
            rate += rows[e, a] * velocity[pair[e], a]
    return rate


@njit(cache=True)
def delassus(J, pairs, found, lightness, ease):
    """W (2 n, 2 n) = J M^-1 J^T of the contacts found [1/kg]."""
    n = len(J)
    W = np.zeros((2 * n, 2 * n))
    for i in range(n):
        for j in range(i + 1):
            for e in range(2):
                b = pairs[found[i], e]
                for f in range(2):
                    if pairs[found[j], f] == b:
                        for a in range(2):
                            for c in range(2):
                                W[2 * i + a, 2 * j + c] += (
                                    lightness[b]
                                    * (
                                        J[i, a, e, 0] * J[j, c, f, 0]
                                        + J[i, a, e, 1] * J[j, c, f, 1]
                                    )
                                    + ease[b] * J[i, a, e, 2] * J[j, c, f, 2]
                                )
            for a in range(2):
                for c in range(2):
                    W[2 * j + c, 2 * i + a] = W[2 * i + a, 2 * j + c]
    return W
