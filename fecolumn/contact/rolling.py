"""Rolling on a round rim: where its contact points are in a step, and what resists.

A polygon rolls from corner to corner, and each corner that lands takes energy as a plastic impact
does. The contact points of the circle roll along with its lowest one: in steady rolling none lands.

The points turn with the lowest one of the circle. For a step they are those of the rotation
halfway, lifted to the height at which steady rolling has them at both its ends. The lowest point's
gap then changes by its displacement (a discrete gradient, Gonzalez 1996), those before and behind
it do opposite work: rolling takes no energy up to dt^3, and what is left of the third order stays
in the lift while the rim carries, so that it makes none either. Where the points stick moves on by
the length of rim rolled.

Where the lowest point leaps, in a column that rocks over, they stay until the part of the rim that
carried is free, as in a foot that stands. One that passes upright beside planar rocking does not
leap: its lowest point runs to the other side of the rim, faster the flatter the foot becomes. Such
a step is made in parts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.rim import lowest, on_circle
from fecolumn.contact.tolerances import FLAT, PARTS, REACH, ROLL, ROLL_STEP
from fecolumn.foundation._compiled import njit
from fecolumn.foundation.arrays import Array, Record


@njit
def part_of_step(x: float, y: float, u: float, v: float, dt: float, done: int) -> int:
    """How much of a step to make at once, in dt / PARTS, so that the lowest point of a rim runs
    along it by ROLL_STEP at most: PARTS for the whole of it.

    The way down, seen along the foot, hardly changes its rate (u, v) within a step: a straight way
    on which the rim's lowest point runs at the rate
    |(x, y) x (u, v)| / (x^2 + y^2), fastest where the foot is flattest. Where that is below FLAT,
    or faster than the smallest part tells, the lowest point leaps: planar rocking over, an impact.

    Parameters
    ----------
    x, y
        way down along the column's axes x and y, the tilt [rad] towards it.
    u, v
        its rate [rad/s].
    dt
        of the whole step [s].
    done
        parts of it that are made.
    """
    across, speed = abs(x * v - y * u), np.hypot(u, v)
    whole = PARTS
    if across > FLAT * speed and PARTS * ROLL_STEP * across > dt * speed**2:
        while whole > 1:
            within = dt * whole / PARTS
            nearest = min(max(-(x * u + y * v) / speed**2, 0.0), within)
            if across * within <= ROLL_STEP * ((x + nearest * u) ** 2 + (y + nearest * v) ** 2):
                break
            whole //= 2
    # parts end where larger ones do, the last at the end of the step
    while done % whole:
        whole //= 2
    return whole


class Roll(NamedTuple):
    """How the points of a rim move at the start of a step: `old` as they are, `like` those of the
    present rotation, `new` those of the rotation halfway.

    offsets, weights: (3, 4) of the carriers, as of `rim.on_circle`; index: (3,) and phase: (3,) of
    the point at the angle; passed: nodes by which the points' places move; strongest: number of the
    point that carries most of those within reach, -1 where none carries.
    """

    offsets: Array
    weights: Array
    index: Array  # type: ignore[assignment]  # hides that of tuples
    phase: Array
    angle: float
    passed: int
    leaps: bool
    strongest: int


OLD, LIKE, NEW = range(3)


@njit
def plan_roll(
    interface: Record,
    rim: Array,
    rim_state: Record,
    contact: Array,
    rotation: Array,
    halfway: Array,
    allowed: bool,
) -> tuple[bool, float, Roll]:
    """Whether the points of a rim roll in a step, and their Roll.

    Parameters
    ----------
    interface
        of INTERFACE.
    rim
        (n,) its points.
    rim_state
        of RIM at the start.
    contact
        (P,) of CONTACT at the start.
    rotation, halfway
        (3, 3) of the slave to the frame of the interface at the start and in the middle of the
        step.
    allowed
        False: they stay in any case.
    """
    n, first, sector, before = len(rim), interface.rim_angle, interface.sector, rim_state.angle
    offsets, weights, index, phase = (
        np.empty((3, 4), np.int64),
        np.empty((3, 4)),
        np.empty(3, np.int64),
        np.empty(3),
    )
    angle, tilt = lowest(halfway)
    index[OLD], phase[OLD] = on_circle(
        first if np.isnan(before) else before, first, sector, n, offsets[OLD], weights[OLD]
    )
    index[LIKE], phase[LIKE] = on_circle(
        lowest(rotation)[0], first, sector, n, offsets[LIKE], weights[LIKE]
    )
    index[NEW], phase[NEW] = on_circle(angle, first, sector, n, offsets[NEW], weights[NEW])
    turned = _sectors(index[NEW] + phase[NEW] - index[OLD] - phase[OLD], n)
    leaps = np.isnan(before) or abs(turned) * sector > ROLL
    loaded, stands, strongest, most = False, False, -1, 0.0
    for k in range(n):
        force = contact[rim[k]].force[2]
        if force > 0:
            loaded = True
            # across the foot from its lowest point
            stands |= abs(_sectors(k + phase[OLD] - index[NEW] - phase[NEW], n)) > n / 4
            past = k + phase[OLD] - (index[NEW] + phase[NEW] if leaps else index[OLD] + phase[OLD])
            if abs(_sectors(past, n)) <= REACH and force > most:
                strongest, most = k, force
    rolls = allowed and tilt >= FLAT and not stands and not (leaps and loaded and strongest < 0)
    if leaps:
        # a part of the rim that rested takes over: the nearest of its points goes to the lowest
        # place
        turned -= np.rint(turned)
    return (
        rolls,
        tilt,
        Roll(
            offsets,
            weights,
            index,
            phase,
            angle,
            int(np.rint(turned - phase[NEW] + phase[OLD])),
            leaps,
            strongest,
        ),
    )


@njit
def mark_rolling(roll: Roll, rim: Array, points: Array, contact: Array, wanted: Array) -> None:
    """Mark in `wanted` (N,) the nodes whose positions `roll_points` needs."""
    n = len(rim)
    passed = roll.passed % n
    for off in range(-REACH, REACH + 1):
        for q in range(4):
            wanted[points[rim[_around(roll.index[LIKE] + off + roll.offsets[LIKE, q], n)]].node] = (
                True
            )
            wanted[points[rim[_around(roll.index[NEW] + off + roll.offsets[NEW, q], n)]].node] = (
                True
            )
            wanted[
                points[
                    rim[
                        _around(
                            _around(roll.index[NEW] + off - passed, n) + roll.offsets[OLD, q], n
                        )
                    ]
                ].node
            ] = True
    for k in range(n):
        if contact[rim[k]].located:
            for q in range(4):
                wanted[points[rim[_around(k + roll.offsets[OLD, q], n)]].node] = True
                wanted[points[rim[_around(k + passed + roll.offsets[NEW, q], n)]].node] = True


@njit
def roll_points(
    roll: Roll,
    rim: Array,
    rim_state: Record,
    arms: Array,
    places: Array,
    contact: Array,
    points: Array,
    before: Array,
) -> None:
    """Roll the points of a rim on: their places on the rim, and in `before` (P,) what `contact`
    (P,) at the start brings to them.

    A point takes its force, anchor and relative position along, where that was located; another one
    starts from where it is. Those within reach of the lowest one get heights at which steady
    rolling works without loss.

    Parameters
    ----------
    rim_state
        of RIM, changed.
    arms
        (N, 3) of the nodes from their centre of mass.
    places
        (N, 3) their positions at the start in the frame of the interface [m], where `mark_rolling`
        wants them.
    """
    n, index = len(rim), roll.index[NEW]
    passed = roll.passed % n
    place_points(roll, NEW, rim, arms, points)
    # The heights are those of steady rolling up to an error of third order in the step. While the
    # rim carries, this error is kept in the lift; else the gap would jump.
    held = 0.0
    if roll.strongest >= 0:
        taken = roll.strongest if roll.leaps else _around(index - passed, n)
        held = _height(roll, OLD, taken, rim, points, places) - _height(
            roll, LIKE, roll.index[LIKE], rim, points, places
        )
        held += 0.0 if roll.leaps else rim_state.lift[REACH]
    for k in range(n):
        i, number, apart = rim[k], _around(k - passed, n), abs(k - index)
        # a contact that carries widens and narrows as it rolls: nothing lands there
        points[i].rolls = (
            roll.strongest >= 0 and not roll.leaps and min(apart, n - apart) * 2 * np.pi <= ROLL * n
        )
        taken = rim[number]
        before[i] = contact[taken]
        near = min(apart, n - apart) <= REACH
        if contact[taken].located or near:
            for a in range(3):
                way = 0.0
                for q in range(4):
                    way += (
                        roll.weights[NEW, q]
                        * places[points[rim[_around(k + roll.offsets[NEW, q], n)]].node, a]
                    )
                    way -= (
                        roll.weights[OLD, q]
                        * places[points[rim[_around(number + roll.offsets[OLD, q], n)]].node, a]
                    )
                before[i].relative[a] += way
                if a < 2:
                    before[i].anchor[a] += way
        else:
            before[i].located = False
    for off in range(-REACH, REACH + 1):
        k = _around(index + off, n)
        i, number = rim[k], _around(k - passed, n)
        like = _height(roll, LIKE, roll.index[LIKE] + off, rim, points, places)
        # steady rolling: at the end of the step a point ahead of the lowest one is as high as the
        # point equally far behind it is now
        points[i].lift = rim_state.lift[REACH + off] = (
            like - _height(roll, NEW, index - off, rim, points, places) + held
        )
        up = like - _height(roll, OLD, number, rim, points, places) if roll.leaps else 0.0
        before[i].relative[2] = contact[rim[number]].relative[2] + up
    rim_state.angle = roll.angle


@njit
def _height(roll: Roll, which: int, k: int, rim: Array, points: Array, places: Array) -> float:
    """Height [m] of point k of the rim where it is on the circle `which`."""
    total, n = 0.0, len(rim)
    for q in range(4):
        total += (
            roll.weights[which, q]
            * places[points[rim[_around(k + roll.offsets[which, q], n)]].node, 2]
        )
    return total


@njit
def place_points(roll: Roll, which: int, rim: Array, arms: Array, points: Array) -> None:
    """Put the points of a rim on the circle `which`, without lift."""
    n = len(rim)
    for k in range(n):
        i = rim[k]
        points[i].count, points[i].lift, points[i].rolls = 4, 0.0, False
        for a in range(3):
            points[i].arm[a] = 0.0
        for q in range(4):
            node, w = (
                points[rim[_around(k + roll.offsets[which, q], n)]].node,
                roll.weights[which, q],
            )
            points[i].carriers[q], points[i].weights[q] = node, w
            for a in range(3):
                points[i].arm[a] += w * arms[node, a]


@njit
def stay(
    roll: Roll, rim: Array, rim_state: Record, tilt: float, arms: Array, points: Array
) -> None:
    """Leave the points of a rim where they are, at the heights that they have there."""
    n = len(rim)
    if tilt < FLAT:
        # nothing stands on a point below the rim; one above it only carries less
        for off in range(2 * REACH + 1):
            rim_state.lift[off] = max(rim_state.lift[off], 0.0)
    if np.isnan(rim_state.angle):
        for k in range(n):
            i = rim[k]
            points[i].count = 1
            for q in range(4):
                points[i].carriers[q], points[i].weights[q] = points[i].node, 1.0 if q == 0 else 0.0
            for a in range(3):
                points[i].arm[a] = arms[points[i].node, a]
    else:
        place_points(roll, OLD, rim, arms, points)
    for k in range(n):
        points[rim[k]].lift, points[rim[k]].rolls = 0.0, False
    for off in range(-REACH, REACH + 1):
        points[rim[_around(roll.index[OLD] + off, n)]].lift = rim_state.lift[REACH + off]


@njit
def least_rim_width(interfaces: Array) -> float:
    """Width [m] of the narrowest foot with a round rim; infinite where there is none."""
    width = np.inf
    for k in range(len(interfaces)):
        if interfaces[k].rim_count > 0:
            width = min(width, interfaces[k].width)
    return width


@njit
def _around(number: int, n: int) -> int:
    """Number, -n to 3 n - 1, modulo n: a division takes longer than all else here."""
    if number < 0:
        return number + n
    while number >= n:
        number -= n
    return number


@njit
def _sectors(number: float, n: int) -> float:
    """Distance along the rim, -n/2 to n/2, of a number of sectors."""
    return (number + n / 2) % n - n / 2


@njit
def rolling_moment(
    rotation: Array,
    spin: Array,
    load: float,
    radius: float,
    coefficient: float,
    inverse: Array,
    dt: float,
) -> Array:
    """Moment (3,) [N m] in the column's frame by which a rim resists to roll: it takes coefficient
    * load per length rolled.

    With d the way down seen from the column and s its part along the foot's plane, the lowest point
    runs along the rim by the angle a.w dt, w the spin and a = (dz dx / s^2, dz dy / s^2, -1). The
    moment is -coefficient load radius sign(a.w) a: to first order a load that acts coefficient
    radius / s ahead of the lowest point, at most the radius. It does not turn the rolling round
    within the step.

    Parameters
    ----------
    rotation
        (3, 3) column to the frame of the interface.
    spin
        (3,) relative to the master, in the column's frame [rad/s].
    load
        normal contact force [N].
    radius
        of the rim [m].
    inverse
        (3, 3) of the inertia about the centre of mass [1/(kg m2)].
    """
    moment, x, y, z = np.zeros(3), -rotation[2, 0], -rotation[2, 1], -rotation[2, 2]
    sine = np.hypot(x, y)
    if sine < FLAT or load <= 0.0:
        return moment
    along = np.array([z * x / sine**2, z * y / sine**2, -1.0])
    rate = along[0] * spin[0] + along[1] * spin[1] + along[2] * spin[2]
    yielding = 0.0
    for a in range(3):
        for b in range(3):
            yielding += along[a] * inverse[a, b] * along[b]
    size = min(min(coefficient, sine) * load * radius, abs(rate) / (yielding * dt))
    for a in range(3):
        moment[a] = -size * np.sign(rate) * along[a]
    return moment
