"""One implicit stage: positions of the column and contact forces in equilibrium at the end of a step."""

from __future__ import annotations

import enum
from dataclasses import dataclass

import numpy as np

from fecolumn.contact.base_top import OffBase
from fecolumn.contact.interface import NEAR, Footing, Spring
from fecolumn.fem.rotation import polar_rotation

# Lengths over the foot's width: points of the foot that are not in the contact problem may not sink deeper than this,
PENETRATION = 1e-10
# and the residual of the contact laws above which a stage has failed
CONTACT_TOLERANCE = 1e-9


class Stop(enum.Enum):
    """Why the iteration of a stage ended."""

    CONVERGED = "converged"
    ITERATIONS = "no convergence within max_iterations"
    CONTACT = "the contact problem did not converge"
    DIVERGED = "the residual grew without bound"
    OFF_BASE = "the foot reached the edge of the base plate"


@dataclass(slots=True)
class Stage:
    """What an implicit stage asks for: m M (x - target) + s [f(x) + C (velocity + rate (x - target))] = load + scale U r.

    target: (n_owned, 3) where the column would go without internal forces at the end [m].
    load: (n_owned, 3) effective forces known beforehand [N].
    start: (n_owned, 3) first guess of the positions [m].
    scale: effective force per contact force.
    anchors: (n, 2) stick positions [m]. forces: (n, 3) first guess of the contact forces [N].
    spring: what the contact points give alone.
    rotation: (3, 3) of the column at the start. Contact forces act on the column in the rotation halfway, so that their
        work over a turn of the column by t is that of the foot's path up to t^3.
    velocity: (n_owned, 3) that the damping C of the elastic modes meets at the target [m/s]; None where nothing is damped.
    """

    target: np.ndarray
    load: np.ndarray
    start: np.ndarray
    scale: float
    anchors: np.ndarray
    forces: np.ndarray
    spring: Spring
    rotation: np.ndarray
    velocity: np.ndarray | None = None


@dataclass(slots=True)
class Outcome:
    """Positions, internal forces and strain energy of the column, contact forces and kinematics, the energy `static` [J]
    of base, foot's static rest, penalty springs and pad, and the record."""

    stop: Stop
    x: np.ndarray
    internal: np.ndarray
    strain: float
    rotation: np.ndarray
    halfway: np.ndarray
    forces: np.ndarray
    relative: np.ndarray | None
    static: float
    footing: Footing | None
    iterations: int
    residual: float
    contact_iterations: int
    message: str = ""


def equilibrate(system, operators, stage: Stage, tolerance: float, max_iterations: int) -> Outcome:
    """Newton iteration with the factored operators turned into the column's present rotation.

    The strains are small, so that the turned operator is an almost exact tangent: one or two iterations reach the
    tolerance. A total Lagrangian column whose residual falls too slowly gets its tangent afresh.

    Args:
        tolerance: largest unbalanced nodal force allowed, relative to the larger of weight and contact forces;
            never below the rounding of the internal forces.
    """
    interface, column, scale = system.interface, system.column, stage.scale
    x, forces, active = np.array(stage.start), stage.forces, np.zeros(0, np.int64)
    first = previous = size = np.inf
    contact_iterations, relative, footing, static_energy = 0, None, None, 0.0

    def ended(stop, message=""):
        return Outcome(stop, x, internal, strain, rotation, halfway, forces, relative, static_energy, footing, iteration, size, contact_iterations, message)

    for iteration in range(max_iterations + 1):
        rotation, internal, strain = system.kinematics.internal(x)
        halfway = polar_rotation(rotation + stage.rotation)
        residual = operators.mass_factor * column.apply(column.mass, stage.target - x) + stage.load - operators.stiffness_factor * internal
        if stage.velocity is not None:
            residual -= operators.stiffness_factor * system.damping.force(stage.velocity + operators.rate_factor * (x - stage.target), rotation)
        position = interface.dynamic_position(x, rotation)
        try:
            footing = interface.project(position, forces)
        except OffBase as error:
            return ended(Stop.OFF_BASE, str(error))
        total = residual + scale * interface.load(forces, halfway)
        reference = max(system.weight, scale * np.abs(forces).max(initial=0.0))
        size = column.max(np.abs(total).max(initial=0.0)) / reference
        sunk = np.zeros(interface.size, bool)
        if iteration:
            given = interface.static_displacement(forces, rotation, footing)
            relative = position + given
            static_energy = interface.stored(forces, given, stage.spring.indented(forces))
            sunk = relative[:, 2] < -PENETRATION * interface.width
            sunk[active] = False
            if size <= max(tolerance, system.rounding(operators.mass_factor) / reference) and not sunk.any():
                return ended(Stop.CONVERGED)
        if iteration == max_iterations:
            break
        first = size if iteration == 1 else first
        if not np.isfinite(size) or (iteration > 1 and size > 1e3 * max(first, 1.0)):
            return ended(Stop.DIVERGED)
        if iteration > 1 and size > 0.3 * previous and not sunk.any() and hasattr(system.kinematics, "tangent"):
            operators = system.refresh(operators, x)
        previous = size

        # Newton about the present forces, so that a slightly turned compliance does not matter at convergence
        turn, along = rotation @ operators.rotation.T, halfway @ operators.rotation.T
        x = system.kinematics.moved(x, operators.factor.solve(total @ turn) @ turn.T)
        position = interface.dynamic_position(x, rotation)
        active = np.flatnonzero((position[:, 2] < NEAR * interface.width) | (forces[:, 2] > 0) | sunk)
        dynamic = scale * interface.turned(operators.response.compliance, active, along)
        static = interface.static_compliance(active, rotation, footing, stage.spring.own)
        moved = position + interface.static_displacement(forces, rotation, footing)
        old = forces
        forces, solution = interface.solve(active, dynamic + static, moved, stage.anchors, old, stage.spring)
        contact_iterations += solution.iterations + solution.sweeps
        if solution.residual > CONTACT_TOLERANCE * interface.width:
            return ended(Stop.CONTACT, f"contact residual {solution.residual:.2e} m")
        x = system.kinematics.moved(x, scale * operators.response.displacement(interface.at_nodes(forces - old) @ along) @ along.T)
    return ended(Stop.ITERATIONS)
