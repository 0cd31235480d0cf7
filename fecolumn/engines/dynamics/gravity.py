"""State at t = 0: gravity equilibrium of the standing column, or a rigid tilt; at rest, or with a
velocity and a spin.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.contact.tolerances import (
    AHEAD_AFTER,
    AHEAD_STEADY,
    FIRMNESS,
    LINKS_FIRM,
    LINKS_PROGRESS,
    REST_ITERATIONS,
    REST_PROGRESS,
    REST_WAY,
)
from fecolumn.engines.dynamics.cuts import Stop
from fecolumn.engines.dynamics.stage import Stage, equilibrate
from fecolumn.engines.dynamics.system import State
from fecolumn.fem.free_body import rigid_fields
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.case.sections import Initial
    from fecolumn.engines.dynamics.system import System
    from fecolumn.fem.composite import Composite


class NoEquilibrium(RuntimeError):
    """The structure does not stand: a centre of mass is not over its foot, or contact does not
    converge.

    Attributes
    ----------
    mover
        place of the body that moved furthest in the last proximal step, None where that is not
        known; `engines.no_rest` names it to the user.
    """

    mover: int | None = None


def pseudo_inertia(weight: float, depth: float, inertia: Array) -> float:
    """Inertia factor [1/s2] of the proximal steps of a column of `weight` [N] with its centre of
    mass `depth` [m] above its foot.

    Parameters
    ----------
    inertia
        (3, 3) about the centre of mass [kg m2].
    """
    return FIRMNESS * weight * depth / float(np.linalg.eigvalsh(inertia[:2, :2])[0])


def iterate_to_rest(
    proximal_step: Callable[..., Any], height: float, progress: float | None = None
) -> None:
    """Make proximal steps until one moves the structure by less than the rounding of its `height`
    [m] allows to tell; a step returns by how much it moved.

    Backward-Euler steps without velocity: each is a proximal-point iteration on the energy with
    contact and contracts by the ratio of inertia to stiffness, about 1e-4, so that a handful
    reaches rounding. On a pad that tilts under a small moment, or held by a soft link alone, it is
    nearer to 1, and many are needed.

    progress: share of the least step among REST_ITERATIONS of them to which one of the next as many
    must come; REST_PROGRESS unless given.

    Raises
    ------
    NoEquilibrium
        it does not come to rest, or all too slowly: its pad hardly holds it upright.
    """
    steps, least, yardstick = 0, np.inf, np.inf
    progress = REST_PROGRESS if progress is None else progress
    while True:
        moved, steps = proximal_step(), steps + 1
        if moved < REST_WAY * height:
            return
        least = min(least, moved)
        if steps % REST_ITERATIONS == 0:
            if not least < progress * yardstick:
                break
            least, yardstick = np.inf, least
    raise NoEquilibrium(
        f"gravity equilibrium: still moving by {moved:.2e} m after {steps} iterations"
    )


class Ahead:
    """How far ahead of its place the next proximal step of a linked structure begins.

    Firm links make steps short where soft ground leaves a body free, each the same share of the
    last. After REST_ITERATIONS the next one begins where all that would follow lead, once their
    share is steady (Irons and Tuck 1969, as `contact.frozen_slips.extrapolate`).
    """

    def __init__(self) -> None:
        self.way: Any = 0.0  # (n, 3) [m]
        self._steps, self._since = 0, 0
        self._moved, self._share = 0.0, 0.0

    def follow(self, change: Array, bodies: Composite) -> None:
        """Find the way of the next step after one that changed the places by (n, 3) [m]."""
        moved, before = bodies.max(np.abs(change).max(initial=0.0)), self._share
        self._steps, self._since, self.way = self._steps + 1, self._since + 1, 0.0
        self._share, self._moved = moved / self._moved if self._moved else 0.0, moved
        left = 1 - self._share
        steady = abs(self._share - before) < AHEAD_STEADY * left
        if self._steps > REST_ITERATIONS and self._since >= AHEAD_AFTER and steady:
            self.way, self._since = self._share / left * change, 0


def standing(system: System, tolerance: float = 1e-9) -> State:
    """Gravity equilibrium on the elastic base with friction.

    Raises
    ------
    NoEquilibrium
        no equilibrium, for example of a column whose centre of mass does not stand over its foot.
    """
    bodies, interface, links = system.bodies, system.interface, system.links
    state, mover = system.unstrained(bodies.placed), None
    firmness = _firmness(system)
    factors, load, pulls, straight = (firmness, 1.0), system.load(np.zeros(3)), None, 0.0
    ahead = Ahead()

    def proximal_step() -> float:
        nonlocal state, pulls, straight, mover
        before, rims = interface.lay(state)
        stage = Stage(
            target=state.x + ahead.way,
            load=load,
            start=state.x,
            scale=1.0,
            before=before,
            dt=np.inf,
            rotation=state.rotation,
            centers=bodies.centers(state.x) if links else None,
            grounds=(state.grounds, state.grounds),
            ties=state.ties,
            turns=interface.foot.filtered,
        )
        outcome = equilibrate(system, system.operators(*factors), stage, tolerance, 20)
        if links:
            ahead.follow(outcome.x - state.x, bodies)
        away = np.abs(outcome.x - state.x)
        of_each = [bodies.max(away[rows].max(initial=0.0)) for rows in bodies.rows]
        mover = int(np.argmax(of_each))
        if outcome.stop is not Stop.CONVERGED:
            raise NoEquilibrium(
                f"gravity equilibrium: {outcome.stop.value} {outcome.message} (residual "
                f"{outcome.residual:.2e} of the weight)"
            )
        outcome.contact["anchor"] = before["anchor"]
        state = replace(
            state,
            x=outcome.x,
            rims=rims,
            internal=outcome.internal,
            strain=outcome.strain,
            rotation=outcome.rotation,
            contact=outcome.contact,
            static=outcome.static,
        )
        straight = sum(
            stage.twist_corrections_at(
                system,
                state.x,
                state.internal,
                state.rotation,
                state.rotation,
                state.forces,
                interface.load(state.forces, state.rotation),
            )
        )
        if links:
            pulls, state.ties = (
                links.pulls(stage, state.x, state.rotation),
                links.ties(bodies.centers(state.x), state.rotation),
            )
        return max(of_each)

    try:
        iterate_to_rest(proximal_step, bodies.extent, LINKS_PROGRESS if links else None)
    except NoEquilibrium as error:
        error.mover = mover
        raise
    system.forget(*factors)
    push = (
        interface.acceleration(state.forces, state.rotation) + straight
        if interface.foot.filtered
        else np.zeros_like(state.x)
    )
    if links:
        push = push + links.acceleration(pulls, state.rotation)
        state.static += links.stored(state)
    return replace(state, a=-push, contact_a=push)


def _firmness(system: System) -> float:
    """Inertia factor [1/s2] of the proximal steps of a system."""
    bodies = system.bodies
    depths = bodies.of_each(lambda part, _: part.center[2] - part.all_X[:, 2].min())
    inertias = bodies.of_each(lambda part, _: rigid_fields(part)[2][3:, 3:])
    firmness = max(
        pseudo_inertia(system.weight, depth, inertia) for depth, inertia in zip(depths, inertias)
    )
    # links answer the motion of a step at once: the motion must not answer them as strongly
    return max(firmness, LINKS_FIRM * system.links.stiffest if system.links else 0.0)


def leaning(
    foot: Array, round_rim: bool, tilt: float, direction: float
) -> tuple[Array, Array, float]:
    """Rotation (3, 3) of a column that leans by `tilt` [rad] towards `direction` [rad], the point
    (3,) [m] of the foot's circle about which it is turned, and the lift [m] that then puts its
    lowest point on the base; foot: (n, 3) nodes.
    """
    turn = rotation_matrix(tilt * np.array([-np.sin(direction), np.cos(direction), 0.0]))
    pivot = (
        np.array([np.cos(direction), np.sin(direction), 0.0])
        * np.linalg.norm(foot[:, :2], axis=1).max()
    )
    # a round rim stands on the pivot itself, between nodes
    return turn, pivot, 0.0 if round_rim else -((foot - pivot) @ turn.T + pivot)[:, 2].min()


def spun(
    foot: Array, round_rim: bool, tilt: float, direction: float, spin: Array
) -> tuple[Array, Array]:
    """Points (3,) [m] about which a column at t = 0 turns, by the horizontal and by the vertical
    part of its `spin` (3,) [rad/s].

    Both are the point of the foot (nodes (n, 3) [m]) on which a tilted column stands, so that it
    neither slips nor strikes. An upright one tips over the point of its foot towards which the spin
    leans it, and spins about its axis.
    """
    upright = tilt == 0
    if upright:
        direction = np.arctan2(-spin[0], spin[1])
    turn, pivot, lift = leaning(foot, round_rim, tilt, direction)
    ahead = foot[:, :2] @ pivot[:2]
    # a foot with corners stands on one, or on the edge between two
    edge = foot[ahead > ahead.max() - 1e-9 * pivot[:2] @ pivot[:2]].mean(axis=0)
    toe = pivot if round_rim else (edge - pivot) @ turn.T + pivot + [0.0, 0.0, lift]
    return toe, np.zeros(3) if upright else toe


def moving(foot: Array, round_rim: bool, initial: Initial, x: Array) -> Array:
    """Velocities (n, 3) [m/s] at positions x (n, 3) of a column that the [initial] section of a
    case sets moving; further arguments as of `spun`.
    """
    spin = np.array(initial.spin_rad_s)
    tip, axis = spun(foot, round_rim, initial.tilt_rad, np.radians(initial.direction_deg), spin)
    level = spin * [1.0, 1.0, 0.0]
    return (
        np.asarray(initial.velocity_m_s)
        + np.cross(level, x - tip)
        + np.cross(spin - level, x - axis)
    )


def begin(system: System, initial: Initial) -> State:
    """The state that the [initial] section of a case describes."""
    state = (
        tilted(system, initial.tilt_rad, np.radians(initial.direction_deg))
        if initial.tilt_rad
        else standing(system)
    )
    if initial.moves:
        state.v = moving(system.interface.reference, _is_round(system), initial, state.x)
    return state


def _is_round(system: System) -> bool:
    """Whether a column stands on a round rim."""
    return bool(system.interface.interfaces[0]["rim_count"])


def tilted(system: System, tilt: float, direction: float) -> State:
    """The unstrained column turned rigidly by `tilt` [rad] towards `direction` [rad], its lowest
    point on the base.
    """
    bodies, interface = system.bodies, system.interface
    turn, pivot, lift = leaning(interface.reference, _is_round(system), tilt, direction)
    state = system.unstrained((bodies.X - pivot) @ turn.T + pivot + [0.0, 0.0, lift])
    return replace(state, a=np.tile(system.gravity, (len(state.x), 1)))
