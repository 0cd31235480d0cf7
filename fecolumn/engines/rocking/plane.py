"""Rocking structures of one degree of freedom in the planes of x and y: from their mass, edges and
restraints to a response.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fecolumn.engines.rocking.model import ModelResponse
from fecolumn.engines.rocking.restraint import Restraint
from fecolumn.engines.rocking.rocker import Rocker
from fecolumn.engines.rocking.swing import (
    EDGE,
    FALL,
    GRAVITY,
    LOSS,
    P2,
    PEAK,
    RATE,
    TILT,
    TIME,
    WORK,
    rock_one,
)
from fecolumn.motions.record import GroundMotion

# Times the free motion that is followed is doubled for a fall that is bound to come
_PATIENCE = 8


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
        side it can lean to alone; 0 both.
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
    def rocker(self) -> Rocker:
        """Its law of motion."""
        springs, tendon, thrust = [], [], []
        for restraint, inertia in zip(self.restraints, self.inertia):
            force, height, inside = restraint.thrust
            springs.append(tuple(one / inertia for one in restraint.moments))
            tendon.append(tuple(one / inertia for one in restraint.tendon))
            thrust.append((force * height / inertia, force * inside / inertia))
        radius = tuple(math.hypot(edge, self.height) for edge in self.edges)
        return Rocker(
            alpha=tuple(math.atan2(edge, self.height) for edge in self.edges),
            p2=tuple(self.mass * GRAVITY * r / inertia for r, inertia in zip(radius, self.inertia)),
            restitution=self.restitution,
            radius=radius,
            mass=self.mass,
            springs=tuple(springs),
            tendon=tuple(tendon),
            thrust=tuple(thrust),
            only=self.only,
        )

    @property
    def sides(self) -> tuple[int, ...]:
        """+1, -1 or both: where it can lean to."""
        return (self.only,) if self.only else (1, -1)

    def moved(self, lean, side) -> np.ndarray:
        """Displacement (n, 2) of the top, along the axis and up [m], at a lean >= 0 on a side; both
        arrays (n,).
        """
        inside = np.where(np.asarray(side) >= 0, *self.top_inside)
        along = self.top * np.sin(lean) + inside * (1 - np.cos(lean))
        return np.column_stack(
            [
                np.where(np.asarray(side) >= 0, along, -along),
                inside * np.sin(lean) - self.top * (1 - np.cos(lean)),
            ]
        )

    def pushover(self, displacement, side: int = 1) -> np.ndarray:
        """Horizontal force at the top [N] that holds the structure at a displacement of the top >=
        0 [m], from virtual work.
        """
        rocker, inside = self.rocker, self.top_inside[0 if side > 0 else 1]
        reach = math.hypot(self.top, inside)
        start = math.atan2(inside, self.top)
        lean = start - np.arcsin(
            np.clip(math.sin(start) - np.asarray(displacement, float) / reach, -1, 1)
        )
        return rocker.restoring(lean, side) / (self.top * np.cos(lean) + inside * np.sin(lean))

    def uplift(self, side: int = 1) -> float:
        """Ground acceleration against a side that lifts the structure onto it [g], without vertical
        motion.
        """
        rocker, k = self.rocker, 0 if side > 0 else 1
        return float(rocker.restoring(0.0, side)) / (
            self.mass * GRAVITY * rocker.radius[k] * math.cos(rocker.alpha[k])
        )

    def verge(self) -> tuple[float, float, float]:
        """Least critical tilt of its sides [rad], displacement of the top there [m], energy that
        takes it there [J].
        """
        rocker = self.rocker
        found = []
        for side in self.sides:
            tilt = rocker.critical(side)
            found.append(
                (
                    tilt,
                    abs(float(self.moved(tilt, side)[0, 0])),
                    float(sum(rocker.potential(tilt, side))),
                )
            )
        return min(found)

    def respond(
        self, motion: GroundMotion, free_s: float, tilt: float, rate: float
    ) -> PlaneResponse:
        """Motion in this plane, at every sample of the motion; a fall that is bound to come is
        followed to its end.
        """
        ground, row = motion.acceleration[:, [self.axis, 2]], self.rocker.row
        for patience in range(_PATIENCE):
            longer = free_s if patience == 0 else free_s + 2.0**patience / row[P2] ** 0.5
            states, impacts, found = rock_one(
                ground, motion.dt, row, free_s=longer, tilt=tilt, tilt_rate=rate
            )
            fallen = bool(found[PEAK] > math.pi / 2)
            if not fallen or found[FALL] >= 0:
                break
        return PlaneResponse(self, states, impacts, fallen)


@dataclass(frozen=True, slots=True, eq=False)
class PlaneResponse:
    """States (n, 6) of `swing`, impact times, and whether it fell, of one plane."""

    plane: Plane
    states: np.ndarray
    impacts: np.ndarray
    fallen: bool

    def cut(self, n: int) -> PlaneResponse:
        """Its first n states."""
        return PlaneResponse(
            self.plane,
            self.states[:n],
            self.impacts[self.impacts <= self.states[n - 1, TIME]],
            self.fallen,
        )

    @property
    def energy(self) -> dict[str, np.ndarray]:
        """Terms of the energy [J]."""
        plane, rocker, states = self.plane, self.plane.rocker, self.states
        lean, side = np.abs(states[:, TILT]), np.where(states[:, EDGE] < 0, -1, 1)
        gravity, strain = np.zeros(len(lean)), np.zeros(len(lean))
        for one in (1, -1):
            gravity[side == one], strain[side == one] = rocker.potential(lean[side == one], one)
        kinetic = 0.5 * np.where(side > 0, *plane.inertia) * states[:, RATE] ** 2
        work, impact = plane.mass * states[:, WORK], plane.mass * states[:, LOSS]
        total = kinetic + strain + gravity
        return dict(
            kinetic=kinetic,
            strain=strain,
            gravity=gravity,
            base_work=work,
            impact=impact,
            closure=total - total[0] - work - impact,
        )

    def base_force(self, ground: np.ndarray) -> np.ndarray:
        """Force of the base (n, 2) along the axis and up [N], between impacts, from the momentum of
        the whole; `ground` (n, 2) [m/s2].
        """
        plane, rocker, states = self.plane, self.plane.rocker, self.states
        side = np.sign(states[:, EDGE])
        k = np.where(side < 0, 1, 0)
        lean, rate = np.abs(states[:, TILT]), states[:, RATE] * side
        alpha, radius, p2 = (
            np.array(values)[k] for values in (rocker.alpha, rocker.radius, rocker.p2)
        )
        lever = alpha - lean
        held = (
            np.where(k == 0, rocker.restoring(lean, 1), rocker.restoring(lean, -1))
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


def respond(
    planes: tuple[Plane, ...],
    motion: GroundMotion,
    free_s: float,
    every_s: float,
    tilt: float,
    rate: float,
    direction: float,
) -> ModelResponse:
    """Response of structures that rock in planes of their own, each as if the other did not move;
    arguments as of Model.respond.

    The tilts of two planes add as the legs of a right angle. It ends where the first of them falls.
    """
    lean = (math.cos(direction), math.sin(direction))
    found = [
        plane.respond(motion, free_s, tilt * lean[plane.axis], rate * lean[plane.axis])
        for plane in planes
    ]
    lengths = [len(one.states) for one in found if one.fallen] or [
        min(len(one.states) for one in found)
    ]
    rows, fallen = min(lengths), any(one.fallen for one in found)
    found = [one.cut(rows) if len(one.states) >= rows else one for one in found]
    found = [one if len(one.states) == rows else _held(one, rows, motion.dt) for one in found]
    ground = np.zeros((rows, 3))
    ground[: min(rows, len(motion.acceleration))] = motion.acceleration[:rows]
    peaks: dict[str, float] = {}
    notes, u_top, tilts = [], np.zeros((rows, 3)), np.zeros(rows)
    for one in found:
        states, axis = one.states, one.plane.axis
        moved = one.plane.moved(np.abs(states[:, TILT]), states[:, EDGE])
        u_top[:, axis], u_top[:, 2] = moved[:, 0], u_top[:, 2] + moved[:, 1]
        tilts = np.hypot(tilts, states[:, TILT])
        notes += _forces(one, ground[:, [axis, 2]], peaks)
    steps = max(1, round(every_s / motion.dt)) if every_s else 1
    kept = np.unique(np.append(np.arange(0, rows, steps), rows - 1))
    energies = [one.energy for one in found]
    return ModelResponse(
        time=max(found, key=lambda one: one.states[-1, TIME]).states[kept, TIME],
        coordinates={f"theta_{'xy'[one.plane.axis]}": one.states[kept, TILT] for one in found},
        units={f"theta_{'xy'[one.plane.axis]}": "rad" for one in found},
        tilt=tilts[kept],
        u_top=u_top[kept],
        overturned=fallen,
        impact_times=np.sort(np.concatenate([one.impacts for one in found])),
        energy={name: sum(one[name] for one in energies)[kept] for name in energies[0]},
        notes=tuple(notes),
        peaks=peaks,
    )


def _held(one: PlaneResponse, rows: int, dt: float) -> PlaneResponse:
    """States followed by their last one, where another plane's fall took longer."""
    more = np.repeat(one.states[-1:], rows - len(one.states), axis=0)
    more[:, TIME] += dt * np.arange(1, len(more) + 1)
    return PlaneResponse(one.plane, np.concatenate([one.states, more]), one.impacts, one.fallen)


def _forces(one: PlaneResponse, ground, peaks: dict) -> list[str]:
    """Note the largest friction and tension demanded in `peaks`, and tell of more friction than
    there is.
    """
    force, name, mu = one.base_force(ground), "xy"[one.plane.axis], one.plane.friction
    upward = np.abs(one.states[:, TILT]) < math.pi / 4  # what has fallen slides as it likes
    with np.errstate(divide="ignore", invalid="ignore"):
        demanded = np.where(force[:, 1] > 0, np.abs(force[:, 0]) / force[:, 1], math.inf)[upward]
    if np.isfinite(demanded.max()):
        # of one that leaves the ground there is none
        peaks[f"friction demanded along {name} [-]"] = float(demanded.max())
    if any(restraint.tendons for restraint in one.plane.restraints):
        lean = np.abs(one.states[:, TILT])
        peaks[f"tension of the tendons, {name} [N]"] = float(
            one.plane.restraints[0].tension(lean).max()
        )
    if not demanded.max() > mu:
        return []
    first = int(np.argmax(demanded > mu))
    most = "more than any" if math.isinf(demanded.max()) else f"{demanded.max():.3g}"
    return [
        f"rocking along {name} demands a friction coefficient of {most}, from "
        f"{one.states[upward][first, TIME]:.3f} s on for {(demanded > mu).mean():.1%} "
        "of the time; "
        f"there is {mu:g}: it would "
        f"slide{' or leave the ground' if math.isinf(demanded.max()) else ''}"
    ]
