"""One implicit stage: positions of the bodies and contact forces in equilibrium at the end of a step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.dynamics.cuts import Stop
from fecolumn.fem.rotation import into_frames, out_of_frames, polar_rotation


@dataclass(slots=True)
class Stage:
    """What an implicit stage asks for: m M (x - target) + s [f(x) + C (velocity + rate (x - target))] = load + scale U r.

    target: (n_owned, 3) where the column would go without internal forces at the end [m].
    load: (n_owned, 3) effective forces known beforehand [N].
    start: (n_owned, 3) first guess of the positions [m].
    scale: effective force per contact force.
    before: (n,) of CONTACT, what the points bring to the stage; the forces are the first guess. dt: length of the step [s], inf at rest.
    rotation: (3, 3) of the column at the start, (nb, 3, 3) of several bodies. Contact forces act on the column in the rotation halfway, so that their
        work over a turn of the column by t is that of the foot's path up to t^3.
    velocity: (n_owned, 3) that the damping C of the elastic modes meets at the target [m/s]; None where nothing is damped.
    centers: (nb, 3) of mass at the start [m], ties: (nl,) of TIE there; None of a structure without links.
    """

    target: np.ndarray
    load: np.ndarray
    start: np.ndarray
    scale: float
    before: np.ndarray
    dt: float
    rotation: np.ndarray
    velocity: np.ndarray | None = None
    centers: np.ndarray | None = None
    ties: np.ndarray | None = None


@dataclass(slots=True)
class Outcome:
    """Positions, internal forces and strain energy of the column, what its points carry now (n,) of CONTACT, the energy `static` [J]
    of base, foot's static rest, penalty springs and pad, and the record."""

    stop: Stop
    x: np.ndarray
    internal: np.ndarray
    strain: float
    rotation: np.ndarray
    halfway: np.ndarray
    contact: np.ndarray
    static: float
    iterations: int
    residual: float
    message: str = ""


def equilibrate(system, operators, stage: Stage, tolerance: float, max_iterations: int) -> Outcome:
    """Newton iteration with the factored operators turned into the column's present rotation.

    The strains are small, so that the turned operator is an almost exact tangent: one or two iterations reach the
    tolerance. A total Lagrangian column whose residual falls too slowly gets its tangent afresh. Within an iteration the column answers contact
    forces linearly, and the contact problem is solved on the points alone; at its end the laws hold for the exact positions.

    Args:
        tolerance: largest unbalanced nodal force allowed, relative to the larger of weight and contact forces;
            never below the rounding of the internal forces.
    """
    interface, column, links, scale = system.interface, system.column, system.links, stage.scale
    x, contact, static = np.array(stage.start), stage.before.copy(), 0.0
    first = previous = size = np.inf

    def ended(stop, message=""):
        # a point that is far from the base was found by nothing but its place, and would stick there
        far = ~contact["located"]
        if iteration and far.any():
            contact["relative"][far] = interface.positions(x, rotation, poses)[far]
            contact["anchor"][far] = contact["relative"][far, :2]
        contact["located"] = True
        return Outcome(stop, x, internal, strain, rotation, halfway, contact, static, iteration, size, message)

    for iteration in range(max_iterations + 1):
        rotation, internal, strain = system.kinematics.internal(x)
        halfway = polar_rotation(rotation + stage.rotation)
        residual = operators.mass_factor * column.apply(column.mass, stage.target - x) + stage.load - operators.stiffness_factor * internal
        if stage.velocity is not None:
            residual -= operators.stiffness_factor * system.damping.force(stage.velocity + operators.rate_factor * (x - stage.target), rotation)
        if links:
            residual += scale * links.load(links.pulls(stage, x, rotation), halfway)
        total = residual + scale * interface.load(contact["force"], halfway)
        reference = max(system.weight, scale * np.abs(contact["force"]).max(initial=0.0))
        size = column.max(np.abs(total).max(initial=0.0)) / reference
        nodal, poses, violation = _nodal(interface, operators, scale), interface.poses(x, rotation), np.inf
        if iteration:
            stop, violation = interface.solve(nodal, poses, interface.positions(x, rotation, poses), stage.dt, stage.before, contact, 0)
            if stop is not Stop.CONVERGED:
                return ended(stop)
            static = interface.stored(stage.dt, stage.before, contact)
            if size <= max(tolerance, system.rounding(operators.mass_factor) / reference) and violation <= 1.0:
                return ended(Stop.CONVERGED)
        if iteration == max_iterations:
            break
        first = size if iteration == 1 else first
        if not np.isfinite(size) or (iteration > 1 and size > 1e3 * max(first, 1.0)):
            return ended(Stop.DIVERGED)
        if iteration > 1 and size > 0.3 * previous and size > tolerance and system.kinematics.has_tangent:
            operators = system.refresh(operators, x)
            nodal = _nodal(interface, operators, scale)
        previous = size

        # Newton about the present forces, so that a slightly turned compliance does not matter at convergence
        turn = rotation @ operators.rotation.swapaxes(-1, -2)
        x = system.kinematics.moved(x, out_of_frames(operators.factor.solve(into_frames(total, turn, column.rows)), turn, column.rows))
        old = contact["force"].copy()
        poses = interface.poses(x, rotation)
        stop, violation = interface.solve(nodal, poses, interface.positions(x, rotation, poses), stage.dt, stage.before, contact)
        if stop is not Stop.CONVERGED:
            return ended(stop, "" if stop is Stop.OFF_BASE else f"contact residual {violation:.2e} of what is allowed")
        x = system.kinematics.moved(x, interface.displacement(operators.response, scale, contact["force"] - old, halfway, operators.rotation))
    return ended(Stop.ITERATIONS)


def _nodal(interface, operators, scale):
    """Compliance of the foot's nodes in a stage, found once for its operators."""
    if operators.nodal is None:
        operators.nodal = interface.nodal(operators.response.compliance, scale, operators.rotation)
    return operators.nodal
