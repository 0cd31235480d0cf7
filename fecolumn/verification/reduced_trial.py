"""The reduced engine behind the interface of `trial.Trial`: a system's finite elements, their modes
and static flexibility.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.engines.dynamics.system import State, System
from fecolumn.engines.reduced import start as starts
from fecolumn.engines.reduced.elastic import ACCELERATION, COORDINATE, RATE
from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced.motion import MotionState, copy
from fecolumn.engines.reduced.observe import COLUMNS
from fecolumn.engines.reduced_engine import engine_on
from fecolumn.fem.body import Body
from fecolumn.fem.free_body import rigid_fields
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.structures.reduction import with_elasticity
from fecolumn.verification import FULL
from fecolumn.verification.trial import N_MODES, Trial, TrialState, highest_nodes

# what is known of a body: making it takes seconds, and one body serves many trials
_REDUCED: WeakKeyDictionary = WeakKeyDictionary()


class ReducedColumn:
    """A system's column as the reduced engine knows it.

    Attributes
    ----------
    model
        BodyModel.
    shapes
        (m, n_owned, 3) of its modes.
    rigid, momentum
        (3 n_owned, 6) rigid motions and M times them.
    """

    def __init__(self, system: System, n_modes: int) -> None:
        body, top = system.body, highest_nodes(system.body)
        free = 3 * (body.n_nodes - len(body.constraint.nodes)) - 6
        self.model, self.shapes = with_elasticity(
            system.model.parts[0].model,
            body,
            system.interface.foot.nodes[0],
            min(n_modes, free),
            (top, np.full(len(top), 1 / len(top))),
        )
        self.rigid, self.momentum, self.masses = rigid_fields(body)

    @classmethod
    def of(cls, system: System, n_modes: int) -> ReducedColumn:
        """That of a system, made once."""
        known = _REDUCED.setdefault(system.body, {})
        if n_modes not in known:
            known[n_modes] = cls(system, n_modes)
        return known[n_modes]

    def projected(self, engine: Engine, state: State, system: System) -> MotionState:
        """The MotionState that a full-order State is, seen by the rigid motions and the modes:
        their momenta, not their values at nodes.
        """
        body = system.body
        motion, whole = (
            engine.motion_at_rest(),
            {"time": state.time, "static": state.static, "ground": state.ground},
        )

        def modal(field: np.ndarray) -> np.ndarray:
            return np.tensordot(self.shapes, body.momentum(field), axes=2)

        center, rotation = body.node_mass @ state.x / body.total_mass, state.rotation[0]
        for _ in range(3):
            elastic = (state.x - center) @ rotation - (body.X - body.center)
            rotation = rotation @ rotation_matrix(
                np.linalg.solve(self.masses, self.momentum.T @ elastic.ravel())[3:]
            )
        rates = np.linalg.solve(self.masses, self.momentum.T @ (state.v @ rotation).ravel())
        motion.rotation[:] = rotation
        for name, values in (
            ("center", center),
            ("velocity", rotation @ rates[:3]),
            ("spin", rates[3:]),
            ("acceleration", body.node_mass @ state.a / body.total_mass),
        ):
            motion.frames[name] = values
        for row, field in (
            (COORDINATE, (state.x - center) @ rotation - (body.X - body.center)),
            (RATE, state.v @ rotation),
            (ACCELERATION, state.a @ rotation),
        ):
            motion.modal[0, row] = modal(field)
        motion.contact[:], motion.rims[:] = state.contact, state.rims
        for name, value in whole.items():
            motion.whole[name] = value
        return motion


class Expanded:
    """A MotionState as a `dynamics.system.State` is read; fields all over the column by its rigid
    motion and modes.
    """

    def __init__(self, engine: Engine, reduction: ReducedColumn, column: Body) -> None:
        self._motion, self._reduction, self._column = engine.motion_at_rest(), reduction, column
        copy(engine.motion, self._motion)
        motion = self._motion
        self.time, self.static, self.ground = (
            motion.time,
            float(motion.whole["static"][0]),
            motion.whole["ground"][0],
        )
        self.rotation, self.contact, self.rims, self._frame = (
            motion.rotation,
            motion.contact,
            motion.rims,
            motion.frames[0],
        )
        self.forces, self.anchors, self.relative = (
            motion.contact[name] for name in ("force", "anchor", "relative")
        )

    def copy(self) -> State:
        """A full-order State of these fields, to start another trial from; without internal forces,
        which a projection does not ask for.
        """
        still = np.zeros_like(self.x)
        return State(
            self.time,
            self.x.copy(),
            self.v.copy(),
            self.a.copy(),
            still,
            still,
            0.0,
            self.rotation.copy(),
            self.contact.copy(),
            self.static,
            self.ground.copy(),
            self.rims.copy(),
        )

    def _modal(self, row: int) -> np.ndarray:
        return np.tensordot(self._motion.modal[0, row], self._reduction.shapes, axes=1)

    @cached_property
    def _arms(self) -> np.ndarray:
        return self._column.X - self._column.center + self._modal(COORDINATE)

    @cached_property
    def x(self) -> np.ndarray:
        """Positions (n, 3) [m] of the nodes."""
        return self._frame.center + self._arms @ self.rotation[0].T

    @cached_property
    def v(self) -> np.ndarray:
        """Velocities (n, 3) [m/s] of the nodes."""
        return (
            self._frame.velocity
            + (np.cross(self._frame.spin, self._arms) + self._modal(RATE)) @ self.rotation[0].T
        )

    @cached_property
    def a(self) -> np.ndarray:
        """Of translation and modes: the rotation has no memory of its acceleration."""
        return self._frame.acceleration + self._modal(ACCELERATION) @ self.rotation[0].T


class ReducedTrial(Trial):
    """Steps the reduced engine made from a full-order system.

    Parameters
    ----------
    system
        what is reduced.
    start
        as of `Trial`. Gravity equilibrium is found by the reduced engine itself, any other start is
        made in full order and projected.
    n_modes
        elastic modes with inertia, at most those there are.
    """

    def __init__(
        self, system: System, start: Callable[[System], State] = standing, n_modes: int = N_MODES
    ) -> None:
        self.system, self.penetration = system, 0.0
        self.reduction = ReducedColumn.of(system, n_modes)
        first = None if start is standing else start(system)

        def begin(engine: Engine) -> MotionState:
            return (
                starts.gravity_equilibrium(engine)
                if first is None
                else self.reduction.projected(engine, first, system)
            )

        (part,) = system.model.parts
        structure = replace(system.model, parts=(replace(part, model=self.reduction.model),))
        self.engine = engine_on(structure, system.hht, begin, gravity=system.gravity)
        self.state = self.start = self._state()

    def _state(self) -> Expanded:
        return Expanded(self.engine, self.reduction, self.system.body)

    def step(self, ground: ArrayLike = (0.0, 0.0, 0.0)) -> TrialState:
        """Advance by one step under a ground acceleration (3,) [m/s2]; the new state."""
        self.engine.advance(np.asarray(ground, float)[None])
        self.state = self._state()
        self.penetration = max(self.penetration, -float(self.state.relative[:, 2].min()))
        return self.state

    def energy(self) -> dict[str, float]:
        """Terms of the energy ledger [J] by name."""
        first = sum(width for name, width in COLUMNS if not name.startswith("energy/"))
        return dict(zip(TERMS, self.engine.row()[first:].tolist()))

    def mechanical(self) -> float:
        """Kinetic, strain and potential energy [J] together."""
        return float(self.engine.mechanical())


def begin_trial(
    engine: str,
    system: System,
    start: Callable[[System], State] = standing,
    impact: str = "plastic",
    n_modes: int = N_MODES,
) -> Trial:
    """A trial of a system in an engine of `verification.ELEMENTS`; arguments as of `Trial`, n_modes
    of `ReducedTrial`.
    """
    if engine in FULL:
        return Trial(system, start, impact)
    return ReducedTrial(system, start, n_modes if engine == "reduced" else 0)
