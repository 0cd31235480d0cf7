"""One implicit stage: positions of the bodies and contact forces in equilibrium at the end of a
step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from petsc4py import PETSc

from fecolumn.engines.dynamics.cuts import Stop
from fecolumn.fem.effective import FACTORIZATION_FAILED
from fecolumn.fem.rotation import into_frames, out_of_frames, polar_rotation, vector_product
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.interface import ContactInterface
    from fecolumn.engines.dynamics.places import Nodal
    from fecolumn.fem.composite import Composite


@dataclass(slots=True)
class Stage:
    """What an implicit stage asks for: m M (x - target) + s T1 [f(x) + C (velocity + rate (x -
    target))] = load + scale U r.

    Bodies turn within a step. What internal forces bring to it at its start and at its end acts in
    the frame halfway, to which T1 turns those of the end, and `middle` what the start brings. So
    the work of the mean internal force is the change of the strain energy, however far a body
    turns.

    target: (n_owned, 3) where the bodies would go without internal forces at the end, but for
    `memory` [m]. load: (n_owned, 3) effective forces known beforehand, but for `held` [N]. start:
    (n_owned, 3) first guess of the positions [m]. scale: effective force per contact force, beside:
    per force of links. before: (n,) of CONTACT, what the points bring to the stage; the forces are
    the first guess. dt: length of the step [s], inf at rest. rotation: (nb, 3, 3) of the bodies at
    the start. Contact forces act on a body in the rotation halfway, so that their work over a turn
    of it by t is that of the foot's path up to t^3. velocity: (n_owned, 3) that the damping C of
    the elastic modes meets at the target, but for `memory` [m/s]; None where nothing is damped.
    centers: (nb, 3) of mass at the start [m], grounds: (G,) of GROUND_STATE at start and end, ties:
    (nl,) of TIE at the start; None of a structure without links. memory: (n_owned, 3) acceleration
    that the start brings [m/s2], None at rest; shares: of it in target [s2] and velocity [s]; held:
    (n_owned, 3) internal forces that the start brings to the load [N]. turns: whether internal
    forces and what the start brings turn with the bodies; not in the literal HHT scheme, whose
    accelerations hold contact forces.
    place, internal: (n_owned, 3) positions [m] and internal forces [N] at the start; levers: (P, 2,
    3) of the points there, as of `ContactInterface.levers`. surface_a, surface_forces: of the State
    at the start, the first guess of what contact forces do; None: it is found.
    """

    target: Array
    load: Array
    start: Array
    scale: float
    before: Array
    dt: float
    rotation: Array
    velocity: Array | None = None
    centers: Array | None = None
    grounds: tuple = ()
    ties: Any = None
    memory: Array | None = None
    shares: tuple[float, float] = (0.0, 0.0)
    held: Any = None
    turns: bool = False
    beside: float = 1.0
    place: Any = None
    internal: Any = None
    levers: Any = None
    surface_a: Array | None = None
    surface_forces: Array | None = None

    def middle(self, bodies: Composite, halfway: Array) -> Middle:
        """What the stage asks for, with all that its start brings, in the frame `halfway`."""
        if self.memory is None:
            return Middle(self.target, self.load, self.velocity, None)
        memory, held, (way, rate) = self.memory, self.held, self.shares
        if self.turns:
            turn = halfway @ self.rotation.swapaxes(-1, -2)
            memory, held = carried(bodies, memory, turn), out_of_frames(held, turn, bodies.rows)
        return Middle(
            self.target + way * memory,
            self.load + held,
            None if self.velocity is None else self.velocity + rate * memory,
            memory,
        )

    def twist_corrections_at(
        self,
        system: Any,
        x: Array,
        internal: Array,
        rotation: Array,
        halfway: Array,
        forces: Array,
        push: Array,
    ) -> tuple[Any, Any]:
        """Two corrections (n_owned, 3) of accelerations in a step to positions x, or at rest there.

        They balance moments that are right to first order in the strain only; 0 where nothing
        turns. The first correction cancels the moment of the internal forces: K d at displacements
        d has the moment sum d x K d, which would turn a body that nothing touches. The second gives
        contact forces (P, 3) their moment about the places of the points. Their nodal forces `push`
        (n_owned, 3) act on nodes chosen by the filter, which have moved otherwise than the points.
        """
        if not self.turns:
            return 0.0, 0.0
        bodies, interface = system.bodies, system.interface
        ends = (
            [(x, internal, rotation)]
            if self.memory is None
            else [(self.place, self.internal, self.rotation), (x, internal, rotation)]
        )
        inner: Any
        arms: Any
        arms, inner = (
            sum(into_frames(values, R, bodies.rows) for values, R in each) / len(ends)
            for each in zip(
                *(((arms_of(bodies, place), R), (force, R)) for place, force, R in ends)
            )
        )
        levers = (
            interface.levers() if self.memory is None else (self.levers + interface.levers()) / 2
        )
        pushed = into_frames(push, halfway, bodies.rows)
        turning = [vector_product(arms, acting) for acting in (inner, pushed)]
        products, *moments = (
            bodies.sum(np.stack(each))
            for each in zip(
                *(
                    (
                        bodies.mass_arms[rows].T @ arms[rows],
                        *(acting[rows].sum(axis=0) for acting in turning),
                    )
                    for rows in bodies.rows
                )
            )
        )
        mended = moments[0], interface.moments(forces, halfway, levers) - moments[1]
        internal_part, contact_part = (
            out_of_frames(
                vector_product(of_nodes(bodies, turns_of(products, each)), bodies.arms),
                halfway,
                bodies.rows,
            )
            for each in mended
        )
        return internal_part, contact_part


class Middle(NamedTuple):
    """Target, load and velocity of a Stage with all that its start brings, and its memory, in the
    frame halfway.
    """

    target: Array
    load: Array
    velocity: Array | None
    memory: Array | None


def arms_of(bodies: Composite, x: Array) -> Array:
    """Arms (n_owned, 3) [m] of positions x (n_owned, 3) from the centres of mass."""
    return x - of_nodes(bodies, bodies.centers(x))


def of_nodes(bodies: Composite, values: Array) -> Array:
    """Values (n_owned, 3) at the nodes from those of their bodies (nb, 3)."""
    return np.repeat(values, [rows.stop - rows.start for rows in bodies.rows], axis=0)


def turns_of(products: Array, moments: Array) -> Array:
    """Find nu (nb, 3) [1/s2] such that the forces M (nu x X) on a body have the moment [N m], that
    of each in moments (nb, 3).

    X are the reference arms of the body, p its present arms about which the moment is taken, and
    its product (3, 3) the sum of (M X) p^T. The forces act on the rigid motion alone: by the
    definition of the mean rotation (`corotated.mean_rotation`) they do no work on a deformation.
    """
    traces = np.trace(products, axis1=1, axis2=2)[:, None, None]
    return np.linalg.solve(traces * np.eye(3) - products, moments[..., None])[..., 0]


def carried(bodies: Composite, accelerations: Array, turn: Array) -> Array:
    """Accelerations (n_owned, 3) of bodies by internal forces and gravity, after they turn by
    `turn` (nb, 3, 3).

    Internal forces turn with a body. They have no resultant: the mean is that of gravity and the
    ground, and stays.
    """
    own = arms_of(bodies, accelerations)
    return accelerations - own + out_of_frames(own, turn, bodies.rows)


@dataclass(slots=True)
class Outcome:
    """Positions, internal forces and strain energy of the bodies, what its points carry now (n,) of
    CONTACT, the energy `static` [J] of base, foot's static rest, penalty springs and pad, and the
    record; surface_forces: (N, 3) of the contact forces, as of `ContactInterface.surface_forces`,
    push: (n_owned, 3) their nodal forces [N] and surface_a: (n_owned, 3) their acceleration [m/s2],
    as of `ContactInterface.answer`; twist_corrections: of `Stage.twist_corrections_at`.
    """

    stop: Stop
    x: Array
    internal: Array
    strain: float
    rotation: Array
    halfway: Array
    contact: Array
    static: float
    iterations: int
    residual: float
    surface_forces: Array
    push: Array
    surface_a: Array | None
    twist_corrections: tuple
    message: str = ""


def equilibrate(
    system: Any, operators: Any, stage: Stage, tolerance: float, max_iterations: int
) -> Outcome:
    """Newton iteration with the factored operators turned into the bodies' present rotations.

    The strains are small, so that the turned operator is an almost exact tangent: one or two
    iterations reach the tolerance. Total Lagrangian bodies whose residual falls too slowly get
    their tangents afresh. Within an iteration the bodies answer contact forces linearly, and the
    contact problem is solved on the points alone; at its end the laws hold for the exact positions.

    Parameters
    ----------
    tolerance
        largest unbalanced nodal force allowed, relative to the larger of weight and contact forces;
        never below the rounding of the internal forces.
    """
    interface, bodies, links, scale = system.interface, system.bodies, system.links, stage.scale
    x, contact, static = np.array(stage.start), stage.before.copy(), 0.0
    surface_forces: Any = None
    push = surface_a = twist_corrections = surface_forces
    first = previous = size = np.inf

    def ended(stop: Stop, message: str = "") -> Outcome:
        # a point that is far from the base was found by nothing but its place, and would stick
        # there
        far = ~contact["located"]
        if iteration and far.any():
            contact["relative"][far] = interface.positions(x, rotation, poses)[far]
            contact["anchor"][far] = contact["relative"][far, :2]
        contact["located"] = True
        return Outcome(
            stop,
            x,
            internal,
            strain,
            rotation,
            halfway,
            contact,
            static,
            iteration,
            size,
            surface_forces,
            push,
            surface_a,
            twist_corrections,
            message,
        )

    for iteration in range(max_iterations + 1):
        rotation, internal, strain = system.kinematics.internal(x)
        halfway = polar_rotation(rotation + stage.rotation)
        middle, inner = stage.middle(bodies, halfway), internal
        acts_halfway = stage.turns and middle.memory is not None
        if middle.velocity is not None:
            inner = internal + system.damping.force(
                middle.velocity + operators.rate_factor * (x - middle.target), rotation
            )
        if acts_halfway:
            inner = out_of_frames(inner, halfway @ rotation.swapaxes(-1, -2), bodies.rows)
        acceleration = operators.mass_factor * (middle.target - x)
        if iteration == 0 and stage.surface_a is not None:
            # nothing large is read for a guess
            surface_forces, total = (
                stage.surface_forces,
                scale * bodies.momentum(out_of_frames(stage.surface_a, halfway, bodies.rows)),
            )
        else:
            poses = interface.poses(x, rotation)
            positions, surface_forces = (
                interface.positions(x, rotation, poses),
                interface.surface_forces(contact["force"], halfway),
            )
            push, surface_a = interface.answer(surface_forces, halfway)
            twist_corrections = stage.twist_corrections_at(
                system, x, internal, rotation, halfway, contact["force"], push
            )
            acceleration, total = acceleration + scale * sum(twist_corrections), scale * push
        total = (
            total + bodies.momentum(acceleration) + middle.load - operators.stiffness_factor * inner
        )
        if links:
            total += stage.beside * links.load(links.pulls(stage, x, rotation), halfway)
        reference = max(system.weight, scale * np.abs(contact["force"]).max(initial=0.0))
        size = bodies.max(np.abs(total).max(initial=0.0)) / reference
        nodal, violation = _nodal(interface, operators, scale), np.inf
        if iteration:
            stop, violation = interface.solve(
                nodal, poses, positions, stage.dt, stage.before, contact, 0
            )
            if stop is not Stop.CONVERGED:
                return ended(stop)
            static = interface.stored(stage.dt, stage.before, contact)
            if (
                size <= max(tolerance, system.rounding(operators.mass_factor) / reference)
                and violation <= 1.0
            ):
                return ended(Stop.CONVERGED)
        if iteration == max_iterations:
            break
        first = size if iteration == 1 else first
        if not np.isfinite(size) or (iteration > 1 and size > 1e3 * max(first, 1.0)):
            return ended(Stop.DIVERGED)
        if (
            iteration > 1
            and size > 0.3 * previous
            and size > tolerance
            and system.kinematics.has_tangent
        ):
            try:
                operators = system.refresh(operators, x)
            except PETSc.Error as error:
                if error.ierr not in FACTORIZATION_FAILED:
                    raise
                return ended(Stop.DIVERGED)  # the tangent is singular
            nodal = _nodal(interface, operators, scale)
        previous = size

        # Newton about the present forces, so that a slightly turned compliance does not matter at
        # convergence
        turn = rotation @ operators.rotation.swapaxes(-1, -2)
        # forces act in the frame halfway: as the body's own they meet the stiffness as it is, by
        # which a turned one would be multiplied
        acts = halfway @ operators.rotation.swapaxes(-1, -2) if acts_halfway else turn
        x = system.kinematics.moved(
            x,
            out_of_frames(
                operators.factor.solve(into_frames(total, acts, bodies.rows)), turn, bodies.rows
            ),
        )
        poses = interface.poses(x, rotation)
        positions = interface.positions(x, rotation, poses)
        # the forces act elsewhere now, and in frames that have turned
        positions += interface.shifts(
            nodal,
            interface.surface_forces(contact["force"], halfway) - surface_forces,
            rotation,
            poses,
        )
        stop, violation = interface.solve(nodal, poses, positions, stage.dt, stage.before, contact)
        if stop is not Stop.CONVERGED:
            return ended(
                stop,
                ""
                if stop is Stop.OFF_BASE
                else f"contact residual {violation:.2e} of what is allowed",
            )
        answered = interface.surface_forces(contact["force"], halfway) - surface_forces
        x = system.kinematics.moved(
            x,
            interface.displacement(
                operators.response, scale, answered, halfway, operators.rotation
            ),
        )
    return ended(Stop.ITERATIONS)


def _nodal(interface: ContactInterface, operators: Any, scale: float) -> Nodal:
    """Compliance of the foot's nodes in a stage, found once for its operators."""
    if operators.nodal is None:
        operators.nodal = interface.nodal(operators.response.compliance, scale, operators.rotation)
    return operators.nodal
