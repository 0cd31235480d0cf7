"""The energy ledger: where every joule comes from and where it goes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.system import System

#: State terms, then accumulated terms, in the order they are written.
TERMS = (
    "kinetic",
    "strain",
    "gravity",
    "base_work",
    "friction",
    "impact",
    "contact",
    "algorithmic",
    "damping",
    "rolling",
    "links",
    "closure",
)


class Ledger:
    """Energy in the table frame [J].

    kinetic + strain + gravity = start + base_work + friction + impact + contact + algorithmic +
    damping + rolling + links + closure

    base_work is the work of the base motion's inertia forces; friction, impact, contact,
    algorithmic (HHT), damping (of elastic modes, and the dashpots of a pad), rolling (resistance of
    the rim) and links (their yielding, breaking and dashpots) are what these add, so a loss is
    negative. Each is computed from forces and displacements of the step, independent of the state's
    energy; closure is what is left over, the error of solver and bookkeeping.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.work = dict.fromkeys(TERMS[3:-1], 0.0)
        self.start: float | None = None

    def state_terms(self, state: Any) -> dict[str, float]:
        """Kinetic, strain and gravity energy now; gravity is relative to the reference
        configuration.
        """
        system, bodies = self.system, self.system.bodies
        weight = system.load(np.zeros(3))
        return dict(
            kinetic=0.5 * bodies.dot(state.v, bodies.momentum(state.v)),
            strain=state.strain + state.static,
            gravity=-bodies.dot(weight, state.x - bodies.placed),
        )

    def open(self, state: Any) -> None:
        """Take the energy now as the start."""
        self.start = sum(self.state_terms(state).values())

    def add(self, **terms: float) -> None:
        """Book the work of one step."""
        for name, value in terms.items():
            self.work[name] += float(value)

    def row(self, state: Any) -> Array:
        """All terms in the order of TERMS."""
        now = self.state_terms(state)
        assert self.start is not None
        closure = sum(now.values()) - self.start - sum(self.work.values())
        return np.array([*now.values(), *self.work.values(), closure])
