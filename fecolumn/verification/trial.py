"""A system, its state and its ledger, advanced without result files."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.case.sections import GRAVITY, Integration
from fecolumn.engines.dynamics.energy import TERMS, Ledger
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.stepper import Stepper
from fecolumn.engines.dynamics.system import State, System
from fecolumn.fem.body import Body
from fecolumn.structures.model import BodyModel

#: Elastic modes with inertia of the engine "reduced": a case's default.
N_MODES = Integration().n_modes


def highest_nodes(body: Body) -> np.ndarray:
    """Nodes (n,) of a `fem.body.Body` at its greatest height."""
    height = body.all_X[:, 2]
    return np.flatnonzero(height > height.max() - 1e-9 * np.ptp(height))


def contact_nodes(system: System) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (n,) of a column that are its contact points, and the areas (n,) [m2] that belong to
    them, in the order of the contact forces of a State.
    """
    surface = system.model.parts[0].model.surfaces["foot"]
    return system.interface.foot.nodes[0][surface.nodes], surface.areas


def afloat(
    system: System,
    displacement: np.ndarray,
    velocity: ArrayLike,
    acceleration: ArrayLike,
    height: float,
) -> State:
    """A body `height` [m] above its reference place, touching nothing, with fields (n_owned, 3) in
    SI units at t = 0.

    The acceleration must be that of gravity and internal forces: HHT remembers it.
    """
    state = system.unstrained(system.body.X + [0.0, 0.0, height] + displacement)
    return replace(state, v=np.array(velocity, float), a=np.array(acceleration, float))


class TrialState(Protocol):
    """What is read of the state of a trial; `dynamics.system.State` is one."""

    @property
    def time(self) -> float:
        """[s]."""

    @property
    def x(self) -> np.ndarray:
        """Positions (n, 3) [m] of the nodes."""

    @property
    def v(self) -> np.ndarray:
        """Velocities (n, 3) [m/s] of the nodes."""

    @property
    def a(self) -> np.ndarray:
        """Accelerations (n, 3) [m/s2] of the nodes, as of State."""

    @property
    def rotation(self) -> np.ndarray:
        """Mean rotations (nb, 3, 3) of the bodies."""

    @property
    def forces(self) -> np.ndarray:
        """Contact forces (P, 3) [N] on the slaves."""

    @property
    def anchors(self) -> np.ndarray:
        """Positions (P, 2) [m] at which the points stick."""

    @property
    def relative(self) -> np.ndarray:
        """Positions (P, 3) [m] of the points relative to ground or master."""

    def copy(self) -> State:
        """A full-order State with arrays of its own."""


class Trial:
    """Steps a system from a start.

    Parameters
    ----------
    system
        what to step.
    start
        function of the system that returns the first state; gravity equilibrium unless given.
    impact
        "plastic" or, for a system built with filtered=False, "none".

    Attributes
    ----------
    state
        the present state.
    penetration
        deepest so far [m].
    """

    def __init__(
        self, system: System, start: Callable[[System], State] = standing, impact: str = "plastic"
    ) -> None:
        self.system = system
        self.state: TrialState = start(system)
        self.start: TrialState = self.state
        self.ledger = Ledger(system)
        self.ledger.open(self.state)
        self.stepper = Stepper(system, self.ledger, impact)
        self.penetration = 0.0

    def step(self, ground: ArrayLike = (0.0, 0.0, 0.0)) -> TrialState:
        """Advance by the system's dt under a ground acceleration [m/s2] at the new time; returns
        the state.
        """
        assert isinstance(self.state, State)
        self.state = self.stepper.step(self.state, np.asarray(ground, float))
        self.penetration = max(self.penetration, -float(self.state.relative[:, 2].min()))
        return self.state

    def shake(self, accelerations: Iterable[ArrayLike]) -> np.ndarray:
        """Displacements (n, 2, 3) [m] of the middles of top and foot after each step under ground
        accelerations (n, 3) [m/s2].
        """
        ends = [highest_nodes(self.system.body), contact_nodes(self.system)[0]]
        path = []
        for ground in accelerations:
            moved = self.step(ground).x - self.system.body.X
            path.append([moved[nodes].mean(axis=0) for nodes in ends])
        return np.array(path)

    def energy(self) -> dict[str, float]:
        """The ledger now [J], by the names of energy.TERMS."""
        return dict(zip(TERMS, self.ledger.row(self.state).tolist()))

    def mechanical(self) -> float:
        """Kinetic, strain and gravity energy now [J]."""
        return float(sum(self.ledger.state_terms(self.state).values()))

    def top(self) -> np.ndarray:
        """Displacement (3,) [m] of the highest node: any one serves to compare analyses of one
        mesh.
        """
        node = np.lexsort(self.system.body.all_X.T)[-1]
        return self.state.x[node] - self.system.body.X[node]


def solver_drift(system: System, times: ArrayLike, tolerance: float = 1e-7) -> np.ndarray:
    """Velocity (n,) [m/s] by which the solver may let an analysis that began at 0 drift until
    `times` (n,) [s].

    A step ends with an unbalanced force of at most eps times the weight. Left in every step it
    accelerates the column by eps g, and the rocking column, unstable about its rim, lets that grow
    at most by cosh(p t). Displacements differ by half of this times t.
    """
    eps = max(tolerance, system.rounding(system.hht.mass_factor) / system.weight)
    times = np.asarray(times, float)
    return eps * np.linalg.norm(system.gravity) * times * np.cosh(RigidRocking(system).p * times)


class RigidRocking:
    """Planar rocking about the rim of a system's mesh, taken as rigid (Housner 1963), from the
    mesh's own masses.

    Attributes
    ----------
    slenderness
        critical tilt alpha [rad].
    diagonal
        R from rim to centre of mass [m].
    inertia
        I_O about the rim [kg m2].
    p
        sqrt(m g R / I_O) [rad/s].
    restitution
        1 - 2 m R^2 sin^2(alpha) / I_O [-].
    """

    def __init__(self, system: System) -> None:
        column = system.body
        radius = np.linalg.norm(system.interface.reference[:, :2], axis=1).max()
        turn = np.cross([0.0, 1.0, 0.0], column.X - column.center)
        about_center = float(column.dot(turn, column.momentum(turn)))
        self._of(column.total_mass, system.weight, radius, float(column.center[2]), about_center)

    @classmethod
    def of_body(cls, body: BodyModel) -> RigidRocking:
        """Of the nodes of a `BodyModel`'s foot, along x."""
        made, arms = cls.__new__(cls), body.arms[body.surfaces["foot"].nodes]
        made._of(
            body.mass,
            body.mass * GRAVITY,
            arms[:, 0].max(),
            -arms[:, 2].min(),
            float(body.inertia[1, 1]),
        )
        return made

    def _of(
        self, mass: float, weight: float, radius: float, height: float, about_center: float
    ) -> None:
        """From mass, weight, the distance of the edge from the axis, the height of the centre of
        mass and the inertia about it.
        """
        self.slenderness = float(np.arctan2(radius, height))
        self.diagonal = float(np.hypot(radius, height))
        self.inertia = float(about_center + mass * self.diagonal**2)
        self.p = float(np.sqrt(weight * self.diagonal / self.inertia))
        self.restitution = (
            1 - 2 * mass * self.diagonal**2 * np.sin(self.slenderness) ** 2 / self.inertia
        )
        self.moment = float(weight * self.diagonal)

    def energy(self, tilt: float) -> float:
        """Gravity energy of a tilt [rad] above standing [J]."""
        return self.moment * float(np.cos(self.slenderness - tilt) - np.cos(self.slenderness))

    def quarter_period(self, tilt: float) -> float:
        """From release at `tilt` [rad] to upright [s], slender block."""
        return float(np.arccosh(1 / (1 - tilt / self.slenderness)) / self.p)
