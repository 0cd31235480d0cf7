"""The reduced engine behind the interface of `trial.Trial`: a system's finite elements, their modes and static flexibility."""

from __future__ import annotations

from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from fecolumn.dynamics.energy import TERMS
from fecolumn.fem.free_body import rigid_fields
from fecolumn.dynamics.gravity import standing
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.dynamics.system import State
from fecolumn.reduced import start as starts
from fecolumn.reduced.build import column_model
from fecolumn.reduced.motion import RIM_ANGLE, RIM_LIFT, STATIC, TIME, at_rest, copy, foot_displacement
from fecolumn.reduced.observe import COLUMNS, view
from fecolumn.reduced.run import Engine
from fecolumn.verification.trial import N_MODES, Trial

# what is known of a body: making it takes seconds, and one body serves many trials
_REDUCED = WeakKeyDictionary()


class Reduction:
    """A system's column as the reduced engine knows it.

    Attributes:
        model: ColumnModel. shapes: (m, n_owned, 3) of its modes. rigid, momentum: (3 n_owned, 6) rigid motions and M times them.
    """

    def __init__(self, system, n_modes: int):
        body, free = system.column, 3 * (system.column.n_nodes - len(system.column.constraint.nodes)) - 6
        height = body.all_X[:, 2]
        top = np.flatnonzero(height > height.max() - 1e-9 * np.ptp(height))
        self.model, self.shapes = column_model(body, system.foot_nodes, system.areas, top, np.full(len(top), 1 / len(top)), min(n_modes, free))
        self.rigid, self.momentum, self.masses = rigid_fields(body)

    @classmethod
    def of(cls, system, n_modes: int) -> Reduction:
        """That of a system, made once."""
        known = _REDUCED.setdefault(system.column, {})
        if n_modes not in known:
            known[n_modes] = cls(system, n_modes)
        return known[n_modes]

    def projected(self, engine, state, system):
        """The Motion that a full-order State is, seen by the rigid motions and the modes: their momenta, not their values at nodes."""
        model, body = self.model, system.column
        motion = at_rest(len(model.arms), len(model.frequencies))

        def modal(field):
            return np.tensordot(self.shapes, body.apply(body.mass, field), axes=2)

        motion.center[:] = body.node_mass @ state.x / body.total_mass
        rotation = state.rotation
        for _ in range(3):
            elastic = (state.x - motion.center) @ rotation - (body.X - body.center)
            rotation = rotation @ rotation_matrix(np.linalg.solve(self.masses, self.momentum.T @ elastic.ravel())[3:])
        motion.rotation[:] = rotation
        rates = np.linalg.solve(self.masses, self.momentum.T @ (state.v @ rotation).ravel())
        motion.velocity[:], motion.spin[:] = rotation @ rates[:3], rates[3:]
        motion.acceleration[:] = body.node_mass @ state.a / body.total_mass
        motion.modal[:] = modal((state.x - motion.center) @ rotation - (body.X - body.center))
        motion.modal_rate[:], motion.modal_acceleration[:] = modal(state.v @ rotation), modal(state.a @ rotation)
        foot_displacement(engine.column.pushes, motion.modal, motion.elastic)
        motion.forces[:], motion.anchors[:], motion.relative[:] = state.forces, state.anchors, state.relative
        motion.ground[:], motion.indent[:] = state.ground, state.indent
        motion.scalars[TIME], motion.scalars[STATIC] = state.time, state.static
        motion.scalars[RIM_ANGLE], motion.scalars[RIM_LIFT:] = state.rim_angle, state.rim_lift
        return motion


class Expanded:
    """A Motion as a `dynamics.system.State` is read; fields all over the column by its rigid motion and modes."""

    def __init__(self, motion, reduction: Reduction, column):
        self._motion, self._reduction, self._column = at_rest(len(motion.forces), len(motion.modal)), reduction, column
        copy(motion, self._motion)
        self.time, self.static = float(motion.scalars[TIME]), float(motion.scalars[STATIC])
        own = self._motion
        self.rotation, self.forces, self.anchors, self.relative, self.ground, self.indent = own.rotation, own.forces, own.anchors, own.relative, own.ground, own.indent

    def copy(self) -> State:
        """A full-order State of these fields, to start another trial from; without internal forces, which a projection does not ask for."""
        still, scalars = np.zeros_like(self.x), self._motion.scalars
        return State(self.time, self.x.copy(), self.v.copy(), self.a.copy(), still, still, 0.0, self.rotation.copy(), self.forces.copy(),
                     self.anchors.copy(), self.relative.copy(), self.static, self.ground.copy(), self.indent.copy(), float(scalars[RIM_ANGLE]), scalars[RIM_LIFT:].copy())

    def _modal(self, coordinates) -> np.ndarray:
        return np.tensordot(coordinates, self._reduction.shapes, axes=1)

    @cached_property
    def _arms(self) -> np.ndarray:
        return self._column.X - self._column.center + self._modal(self._motion.modal)

    @cached_property
    def x(self) -> np.ndarray:
        return self._motion.center + self._arms @ self.rotation.T

    @cached_property
    def v(self) -> np.ndarray:
        motion = self._motion
        return motion.velocity + (np.cross(motion.spin, self._arms) + self._modal(motion.modal_rate)) @ self.rotation.T

    @cached_property
    def a(self) -> np.ndarray:
        """Of translation and modes: the rotation has no memory of its acceleration."""
        return self._motion.acceleration + self._modal(self._motion.modal_acceleration) @ self.rotation.T


class ReducedTrial(Trial):
    """Steps the reduced engine made from a full-order system.

    Args:
        system: what is reduced.
        start: as of `Trial`. Gravity equilibrium is found by the reduced engine itself, any other start is made in full order and projected.
        n_modes: elastic modes with inertia, at most those there are.
    """

    def __init__(self, system, start=standing, n_modes: int = N_MODES):
        self.system, self.penetration = system, 0.0
        self.reduction = Reduction.of(system, n_modes)
        interface = system.interface
        first = None if start is standing else start(system)

        def begin(engine):
            return starts.standing(engine) if first is None else self.reduction.projected(engine, first, system)

        eye = view(self.reduction.model, system.weight, interface.friction)
        self.engine = Engine(self.reduction.model, system.base, eye, system.hht, system.gravity, interface.friction, interface.own, interface.rim, begin, 4,
                             system.damping.ratio if system.damping else 0.0, interface.restitution, system.rolling, interface.pad)
        self.state = self.start = self._state()

    def _state(self) -> Expanded:
        return Expanded(self.engine.motion, self.reduction, self.system.column)

    def step(self, ground=(0.0, 0.0, 0.0)):
        self.engine.advance(np.asarray(ground, float)[None])
        self.state = self._state()
        self.penetration = max(self.penetration, -float(self.state.relative[:, 2].min()))
        return self.state

    def energy(self) -> dict[str, float]:
        first = sum(width for name, width in COLUMNS if not name.startswith("energy/"))
        return dict(zip(TERMS, self.engine.row()[first:].tolist()))

    def mechanical(self) -> float:
        return float(self.engine.mechanical())
