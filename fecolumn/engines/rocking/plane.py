"""Rigid structures that rock in vertical planes with one degree of freedom in each: from mass,
edges and restraints to a response. `swing` has the law of motion and integrates it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.model import (
    ModelResponse,
    balanced,
    check_friction,
    free_times,
    moved_about_edge,
)
from fecolumn.engines.rocking.restraint import Restraint
from fecolumn.engines.rocking.swing import rock_one
from fecolumn.engines.rocking.swing_equations import (
    FASTEST,
    HELD,
    N_PARAMETERS,
    ONLY,
    P2,
    PER_MASS,
    RESTITUTION,
    SLENDERNESS,
    SPRING,
    TENDON,
    TENDON_THRUST,
    look,
)
from fecolumn.engines.rocking.swing_motion import (
    FALL_TIME,
    PEAK_TILT,
    SWING_EDGE,
    SWING_LOSS,
    SWING_RATE,
    SWING_TILT,
    SWING_TIME,
    SWING_WORK,
)
from fecolumn.foundation.arrays import Array
from fecolumn.motions.record import GroundMotion


@dataclass(frozen=True, slots=True, eq=False)
class Plane:
    """A structure that rocks in the vertical plane of one axis; pairs are of the sides + and -.

    Attributes
    ----------
    axis
        0 for x, 1 for y.
    mass
        [kg].
    edges
        horizontal distance of the centre of mass from each edge (2,) [m]
    height
        of that centre over the edges [m].
    inertia
        about each edge (2,) [kg m2].
    restitution
        of the angular velocity as it leaves a side (2,).
    top
        height y [m] of the point whose displacement counts.
    top_inside
        its distance c inside each edge (2,) [m].
    restraints
        (2,) of each side.
    friction
        Coulomb coefficient, which is only checked.
    only
        side it can lean to alone, +1 or -1; 0 for both.
    """

    axis: int
    mass: float
    edges: tuple[float, float]
    height: float
    inertia: tuple[float, float]
    restitution: tuple[float, float]
    top: float
    top_inside: tuple[float, float]
    restraints: tuple[Restraint, Restraint] = (Restraint(), Restraint())
    friction: float = math.inf
    only: int = 0

    @property
    def alpha(self) -> tuple[float, ...]:
        """Angle of the line from each edge to the centre of mass to the vertical (2,) [rad]."""
        return tuple(math.atan2(edge, self.height) for edge in self.edges)

    @property
    def radius(self) -> tuple[float, ...]:
        """R: distance of the centre of mass from each edge (2,) [m]."""
        return tuple(math.hypot(edge, self.height) for edge in self.edges)

    @property
    def p2(self) -> tuple[float, ...]:
        """Square p^2 of the frequency parameter about each edge (2,) [1/s2]."""
        return tuple(self.mass * GRAVITY * r / i for r, i in zip(self.radius, self.inertia))

    @property
    def row(self) -> Array:
        """(N_PARAMETERS,) for `swing.rock_all`."""
        row, inertia = np.zeros(N_PARAMETERS), np.array(self.inertia)[:, None]
        springs = np.array([one.moments for one in self.restraints]) / inertia
        tendon = np.array([one.tendon for one in self.restraints]) / inertia
        thrust = np.array([one.thrust_moments for one in self.restraints]) / inertia
        row[SLENDERNESS : SLENDERNESS + 2], row[P2 : P2 + 2] = self.alpha, self.p2
        row[RESTITUTION : RESTITUTION + 2], row[ONLY] = self.restitution, self.only
        row[SPRING : SPRING + 6], row[TENDON : TENDON + 4] = springs.ravel(), tendon.ravel()
        row[TENDON_THRUST : TENDON_THRUST + 4] = thrust.ravel()
        row[PER_MASS : PER_MASS + 2] = GRAVITY * np.array(self.radius) / self.p2
        stiff = np.abs(springs).sum(axis=1) + np.abs(tendon[:, 0]) + np.abs(thrust).sum(axis=1)
        row[FASTEST] = math.sqrt(max(self.p2 + stiff))
        row[HELD] = float(np.any(springs) or np.any(tendon) or np.any(thrust))
        return row

    @property
    def sides(self) -> tuple[int, ...]:
        """+1, -1 or both: where it can lean to."""
        return (self.only,) if self.only else (1, -1)

    def moved(self, lean: ArrayLike, side: ArrayLike) -> Array:
        """Displacement (n, 2) of the top, along the axis and up [m], at a lean >= 0 on a side; both
        arrays (n,).
        """
        inside = np.where(np.asarray(side) >= 0, *self.top_inside)
        along, up = moved_about_edge(lean, self.top, inside)
        return np.column_stack([np.where(np.asarray(side) >= 0, along, -along), up])

    def pushover(self, displacement: ArrayLike, side: int = 1) -> Array:
        """Horizontal force at the top [N] that holds the structure at a displacement of the top >=
        0 [m], from virtual work.
        """
        inside = self.top_inside[0 if side > 0 else 1]
        reach = math.hypot(self.top, inside)
        start = math.atan2(inside, self.top)
        lean = start - np.arcsin(
            np.clip(math.sin(start) - np.asarray(displacement, float) / reach, -1, 1)
        )
        force: Array = self.restoring(lean, side) / (
            self.top * np.cos(lean) + inside * np.sin(lean)
        )
        return force

    def uplift(self, side: int = 1) -> float:
        """Ground acceleration against a side that lifts the structure onto it [g], without vertical
        motion.
        """
        k = 0 if side > 0 else 1
        return float(self.restoring(0.0, side)) / (
            self.mass * GRAVITY * self.radius[k] * math.cos(self.alpha[k])
        )

    def critical_state(self) -> tuple[float, float, float]:
        """Least critical tilt of its sides [rad], displacement of the top there [m], energy that
        takes it there [J].
        """
        found = []
        for side in self.sides:
            tilt = self.critical(side)
            moved = abs(float(self.moved(tilt, side)[0, 0]))
            found.append((tilt, moved, float(sum(self.potential(tilt, side)))))
        return min(found)

    def restoring(self, tilt: ArrayLike, side: int = 1) -> Array:
        """Restoring moment at lean `tilt` >= 0 on a side [N m], without ground motion."""
        found: Array = self._along(tilt, side)[..., 0]
        return found

    def potential(self, tilt: ArrayLike, side: int = 1) -> tuple[Array, Array]:
        """Gravity energy, and that of springs, tendon and thrust, at lean `tilt` >= 0 on a side,
        from upright [J].
        """
        found = self._along(tilt, side)
        return found[..., 1], found[..., 2]

    def _along(self, tilt: ArrayLike, side: int) -> Array:
        """Restoring moment [N m], gravity energy and energy of the restraints [J], (..., 3)."""
        row, k, found = self.row, 0 if side > 0 else 1, np.empty((np.size(tilt), 4))
        look(row, k, np.ascontiguousarray(np.ravel(tilt), float), found)
        along: Array = self.mass * row[PER_MASS + k] * found[:, :3]
        return along.reshape(*np.shape(tilt), 3)

    def critical(self, side: int = 1) -> float:
        """Lean at which the restoring moment vanishes [rad]; pi/2 where it never does."""
        found = np.empty((1, 4))
        look(self.row, 0 if side > 0 else 1, np.zeros(1), found)
        return float(found[0, 3])

    def respond(
        self, motion: GroundMotion, free_s: float, tilt: float, rate: float
    ) -> PlaneResponse:
        """Motion in this plane, at every sample of the motion; a fall that is bound to come is
        followed to its end.
        """
        ground, row = motion.acceleration[:, [self.axis, 2]], self.row
        for longer in free_times(free_s, row[P2] ** 0.5):
            states, impacts, found = rock_one(
                ground, motion.dt, row, free_s=longer, tilt=tilt, tilt_rate=rate
            )
            fallen = bool(found[PEAK_TILT] > math.pi / 2)
            if not fallen or found[FALL_TIME] >= 0:
                break
        return PlaneResponse(self, states, impacts, fallen)


@dataclass(frozen=True, slots=True, eq=False)
class PlaneResponse:
    """States (n, 6) of `swing`, impact times, and whether it fell, of one plane."""

    plane: Plane
    states: Array
    impacts: Array
    fallen: bool

    def cut(self, n: int) -> PlaneResponse:
        """Its first n states."""
        return PlaneResponse(
            self.plane,
            self.states[:n],
            self.impacts[self.impacts <= self.states[n - 1, SWING_TIME]],
            self.fallen,
        )

    def held(self, n: int, dt: float) -> PlaneResponse:
        """Its states followed by the last one up to n, where another plane's fall took longer."""
        more = np.repeat(self.states[-1:], n - len(self.states), axis=0)
        more[:, SWING_TIME] += dt * np.arange(1, len(more) + 1)
        states = np.concatenate([self.states, more])
        return PlaneResponse(self.plane, states, self.impacts, self.fallen)

    @property
    def energy(self) -> dict[str, Array]:
        """Terms of the energy [J]."""
        plane, states = self.plane, self.states
        lean, side = np.abs(states[:, SWING_TILT]), np.where(states[:, SWING_EDGE] < 0, -1, 1)
        gravity, strain = np.zeros(len(lean)), np.zeros(len(lean))
        for one in (1, -1):
            gravity[side == one], strain[side == one] = plane.potential(lean[side == one], one)
        kinetic = 0.5 * np.where(side > 0, *plane.inertia) * states[:, SWING_RATE] ** 2
        work, impact = plane.mass * states[:, SWING_WORK], plane.mass * states[:, SWING_LOSS]
        return balanced(
            kinetic=kinetic, strain=strain, gravity=gravity, base_work=work, impact=impact
        )

    def base_force(self, ground: Array) -> Array:
        """Force of the base (n, 2) along the axis and up [N], between impacts, from the momentum of
        the whole; `ground` (n, 2) [m/s2].
        """
        plane, states = self.plane, self.states
        side = np.sign(states[:, SWING_EDGE])
        k = np.where(side < 0, 1, 0)
        lean, rate = np.abs(states[:, SWING_TILT]), states[:, SWING_RATE] * side
        alpha, radius, p2 = (
            np.array(values)[k] for values in (plane.alpha, plane.radius, plane.p2)
        )
        lever = alpha - lean
        held = (
            np.where(k == 0, plane.restoring(lean, 1), plane.restoring(lean, -1))
            / np.array(plane.inertia)[k]
        )
        turn = np.where(
            side == 0,
            0.0,
            -p2 / GRAVITY * (ground[:, 1] * np.sin(lever) + side * ground[:, 0] * np.cos(lever))
            - held,
        )
        along = radius * (turn * np.cos(lever) + rate**2 * np.sin(lever)) * side
        up = radius * (turn * np.sin(lever) - rate**2 * np.cos(lever)) * np.abs(side)
        pull = np.where(k == 0, plane.restraints[0].pull(lean), plane.restraints[1].pull(lean))
        tension = np.where(
            k == 0, plane.restraints[0].tension(lean), plane.restraints[1].tension(lean)
        )
        return np.column_stack(
            [
                plane.mass * (ground[:, 0] + along) + np.where(side < 0, -1, 1) * pull,
                plane.mass * (GRAVITY + ground[:, 1] + up) + tension,
            ]
        )


class PlanarModel:
    """Base of the models that rock in vertical planes, each as if the other did not move.

    A subclass has `planes`, one for each axis along which it can rock.
    """

    __slots__ = ()
    planes: tuple[Plane, ...]

    @property
    def critical_tilt(self) -> float:
        """As of Model, the least of its planes."""
        return min(plane.critical_state()[0] for plane in self.planes)

    @property
    def critical_displacement(self) -> float:
        """As of Model, of the plane with the least critical tilt."""
        return min(plane.critical_state() for plane in self.planes)[1]

    @property
    def energy_to_overturn(self) -> float:
        """As of Model, the least of its planes."""
        return min(plane.critical_state()[2] for plane in self.planes)

    def respond(
        self,
        motion: GroundMotion,
        *,
        free_s: float = 0.0,
        tilt: float = 0.0,
        tilt_rate: float = 0.0,
        direction: float = 0.0,
    ) -> ModelResponse:
        """As of Model.

        The tilts of two planes add as the legs of a right angle. It ends where the first of them
        falls.
        """
        lean = (math.cos(direction), math.sin(direction))
        found = [
            plane.respond(motion, free_s, tilt * lean[plane.axis], tilt_rate * lean[plane.axis])
            for plane in self.planes
        ]
        lengths = [len(one.states) for one in found]
        ended = [n for n, one in zip(lengths, found) if one.fallen]
        rows = min(ended or lengths)
        found = [one.cut(rows) if len(one.states) >= rows else one for one in found]
        found = [one if len(one.states) == rows else one.held(rows, motion.dt) for one in found]
        ground = np.zeros((rows, 3))
        ground[: min(rows, len(motion.acceleration))] = motion.acceleration[:rows]
        peaks: dict[str, float] = {}
        notes, u_top, tilts = [], np.zeros((rows, 3)), np.zeros(rows)
        base = np.zeros((rows, 3))
        for one in found:
            states, axis = one.states, one.plane.axis
            moved = one.plane.moved(np.abs(states[:, SWING_TILT]), states[:, SWING_EDGE])
            u_top[:, axis], u_top[:, 2] = moved[:, 0], u_top[:, 2] + moved[:, 1]
            tilts = np.hypot(tilts, states[:, SWING_TILT])
            force = one.base_force(ground[:, [axis, 2]])
            # what carries the weight in each plane is one and the same
            carries = one.plane.mass * (GRAVITY + ground[:, 2]) if base.any() else 0.0
            base[:, axis], base[:, 2] = force[:, 0], base[:, 2] + force[:, 1] - carries
            notes += _check_forces(one, force, peaks)
        energies = [one.energy for one in found]
        thetas = {f"theta_{'xy'[one.plane.axis]}": one.states[:, SWING_TILT] for one in found}
        return ModelResponse(
            time=max(found, key=lambda one: one.states[-1, SWING_TIME]).states[:, SWING_TIME],
            coordinates=thetas,
            units=dict.fromkeys(thetas, "rad"),
            tilt=tilts,
            u_top=u_top,
            overturned=bool(ended),
            impact_times=np.sort(np.concatenate([one.impacts for one in found])),
            energy={
                name: sum((one[name] for one in energies), np.zeros(rows)) for name in energies[0]
            },
            notes=tuple(notes),
            peaks=peaks,
            base_force=base,
        )


def _check_forces(one: PlaneResponse, force: Array, peaks: dict[str, float]) -> list[str]:
    """Add the largest friction and tension demanded to `peaks`; notes on friction that lacks;
    force: (n, 2) of the base, along the axis and up [N].
    """
    name, plane = "xy"[one.plane.axis], one.plane
    lean = np.abs(one.states[:, SWING_TILT])
    notes, found = check_friction(
        f"rocking along {name}",
        f"friction_demanded_{name}",
        np.abs(force[:, 0]),
        force[:, 1],
        one.states[:, SWING_TIME],
        lean < math.pi / 4,  # what has fallen slides as it likes
        plane.friction,
    )
    peaks |= found
    if any(restraint.tendons for restraint in plane.restraints):
        tension = plane.restraints[0].tension(lean).max()
        peaks[f"tendon_tension_{name}_n"] = float(tension)
    return notes
