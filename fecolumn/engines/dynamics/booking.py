"""What the energy ledger is told of a step: who did what work, and what was lost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.contact.work import losses
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.system import State
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.energy import Ledger
    from fecolumn.engines.dynamics.system import System


@dataclass(slots=True)
class StepMade:
    """A step of HHT from one State to another, before the impulses of an impact.

    Attributes
    ----------
    start, after
        the states. before: (P,) of CONTACT, what the points brought to the step.
    ends
        a0 and a1 (n_owned, 3) as they act in the step [m/s2].
    load_sum
        sum of loads less internal forces at both ends, (n_owned, 3) [N]; so are, or 0: untwists,
        what takes the moment of these away; beside, contact and all else that is no part of a0 and
        a1; within, contact that is; damped, sum of damping forces at both ends; resisted, rolling
        resistance, part of `beside`.
    carried
        work of grounds that move [J].
    springs
        what the points gave alone.
    """

    start: State
    before: Array
    after: State
    hht: HHT
    ends: tuple[Array, Array]
    load_sum: Array
    untwists: Array | float
    beside: Array | float
    within: Array | float
    carried: float
    damped: Array | float
    resisted: Array | float
    springs: Any


def book_step(system: System, made: StepMade, ledger: Ledger) -> float:
    """Energy of a step into the ledger; returns the work of contact but that of dashpots [J].

    From the identity dT = dx.(M a_mean + push) - dt^2 al^2/4 da.(M a_mean + push), a_mean = (1-ga)
    a0 + ga a1, push of contact and of what takes the moment of the internal forces away, which does
    no work but theirs.
    """
    bodies, interface = system.bodies, system.interface
    start, before, after, hht = made.start, made.before, made.after, made.hht
    step = after.x - start.x
    mean = bodies.momentum((1 - hht.gamma) * made.ends[0] + hht.gamma * made.ends[1])
    worked = made.within + made.beside
    algorithmic = bodies.dot(step, mean - made.within - made.load_sum / 2)
    algorithmic -= (
        hht.dt**2
        * hht.alpha**2
        / 4
        * bodies.dot(made.ends[1] - made.ends[0], mean + made.beside + made.untwists)
    )
    shaken = bodies.sum(bodies.unit_loads.reshape(3, -1) @ step.ravel())
    damping = -bodies.dot(step, made.damped) / 2 if system.damping else 0.0
    rolling = bodies.dot(step, made.resisted) if system.resistance else 0.0
    taken = 0.0
    if system.links:
        tied, taken = system.links.end(start.ties, after, hht.dt)
        after.static += tied
    contact = bodies.dot(step, worked) - rolling + after.static - start.static + taken
    contact -= made.carried
    friction, landed, dashpots = losses(
        interface.points,
        interface.interfaces,
        made.springs,
        interface.near,
        before,
        after.contact,
        contact,
    )
    ledger.add(
        base_work=made.carried - np.dot((start.ground + after.ground)[:3] / 2, shaken),
        algorithmic=algorithmic - damping,
        friction=friction,
        impact=landed,
        contact=contact - friction - landed + dashpots,
        damping=damping - dashpots,
        rolling=rolling,
        links=-taken,
    )
    return contact + dashpots
