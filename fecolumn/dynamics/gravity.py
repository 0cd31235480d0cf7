"""State at t = 0: gravity equilibrium of the standing column, or a rigid tilt; at rest, or with a velocity and a spin."""

from __future__ import annotations

import numpy as np

from fecolumn.fem.free_body import rigid_fields
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.dynamics.stage import Stage, Stop, equilibrate
from fecolumn.dynamics.system import State

# Inertia factor of the pseudo-time iteration over the rate of falling, see `pseudo_inertia`: it only holds what contact and friction leave
# free. The contact's compliance leaves out that a tilt moves the weight; the iteration that mends this contracts by the inverse
FIRMNESS = 10.0
# A step that moves the column less is at rest, above the rounding of positions [m]
REST = 1e-11


class NoEquilibrium(RuntimeError):
    """The column does not stand: its centre of mass is not over its foot, or contact does not converge."""


def pseudo_inertia(weight: float, depth: float, inertia: np.ndarray) -> float:
    """Inertia factor [1/s2] of the proximal steps of a column of `weight` [N] with its centre of mass `depth` [m] above its foot.

    Args:
        inertia: (3, 3) about the centre of mass [kg m2].
    """
    return FIRMNESS * weight * depth / float(np.linalg.eigvalsh(inertia[:2, :2])[0])


def standing(system, tolerance: float = 1e-9, max_iterations: int = 50) -> State:
    """Gravity equilibrium on the elastic base with friction.

    Backward-Euler steps without velocity: each is a proximal-point iteration on the energy with contact and contracts
    by the ratio of inertia to stiffness, about 1e-4, so that a handful reaches rounding.

    Raises:
        NoEquilibrium: no equilibrium, for example of a column whose centre of mass does not stand over its foot.
    """
    column, interface = system.column, system.interface
    interface.place(None)
    load, x = system.load(np.zeros(3)), column.X.copy()
    anchors = interface.reference[:, :2].copy()
    forces = np.zeros((interface.size, 3))
    depth = column.center[2] - interface.reference[:, 2].mean()
    factors = pseudo_inertia(system.weight, depth, rigid_fields(column)[2][3:, 3:]), 1.0
    for _ in range(max_iterations):
        stage = Stage(target=x, load=load, start=x, scale=1.0, anchors=anchors, forces=forces,
                      spring=interface.spring(np.inf, np.zeros_like(forces)), rotation=np.eye(3))
        outcome = equilibrate(system, system.operators(*factors), stage, tolerance, 20)
        if outcome.stop is not Stop.CONVERGED:
            raise NoEquilibrium(f"gravity equilibrium: {outcome.stop.value} {outcome.message} (residual {outcome.residual:.2e} of the weight)")
        moved = column.max(np.abs(outcome.x - x).max(initial=0.0))
        x, forces = outcome.x, outcome.forces
        if moved < REST:
            break
    else:
        raise NoEquilibrium(f"gravity equilibrium: still moving by {moved:.2e} m after {max_iterations} iterations")
    system.forget(*factors)
    push = interface.acceleration(forces, outcome.rotation) if interface.foot.filtered else np.zeros_like(x)
    return State(
        time=0.0, x=x, v=np.zeros_like(x), a=-push, contact_a=push, internal=outcome.internal, strain=outcome.strain,
        rotation=outcome.rotation, forces=forces, anchors=anchors, relative=outcome.relative,
        static=outcome.static, ground=np.zeros(3), indent=stage.spring.indented(forces))


def leaning(foot, round_rim: bool, tilt: float, direction: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Rotation (3, 3) of a column that leans by `tilt` [rad] towards `direction` [rad], the point (3,) [m] of the foot's circle about
    which it is turned, and the lift [m] that then puts its lowest point on the base; foot: (n, 3) nodes."""
    turn = rotation_matrix(tilt * np.array([-np.sin(direction), np.cos(direction), 0.0]))
    pivot = np.array([np.cos(direction), np.sin(direction), 0.0]) * np.linalg.norm(foot[:, :2], axis=1).max()
    # a round rim stands on the pivot itself, between nodes
    return turn, pivot, 0.0 if round_rim else -((foot - pivot) @ turn.T + pivot)[:, 2].min()


def spun(foot, round_rim: bool, tilt: float, direction: float, spin) -> tuple[np.ndarray, np.ndarray]:
    """Points (3,) [m] about which a column at t = 0 turns, by the horizontal and by the vertical part of its `spin` (3,) [rad/s].

    Both are the point of the foot (nodes (n, 3) [m]) on which a tilted column stands, so that it neither slips nor strikes. An upright one tips over
    the point of its foot towards which the spin leans it, and spins about its axis.
    """
    upright = tilt == 0
    if upright:
        direction = np.arctan2(-spin[0], spin[1])
    turn, pivot, lift = leaning(foot, round_rim, tilt, direction)
    ahead = foot[:, :2] @ pivot[:2]
    # a foot with corners stands on one, or on the edge between two
    edge = foot[ahead > ahead.max() - 1e-9 * pivot[:2] @ pivot[:2]].mean(axis=0)
    toe = pivot if round_rim else (edge - pivot) @ turn.T + pivot + [0.0, 0.0, lift]
    return toe, np.zeros(3) if upright else toe


def begin(system, initial) -> State:
    """The state that the [initial] section of a case describes."""
    tilt, direction, spin = initial.tilt_rad, np.radians(initial.direction_deg), np.array(initial.spin_rad_s)
    state = tilted(system, tilt, direction) if tilt else standing(system)
    if initial.moves:
        tip, axis = spun(system.interface.reference, system.interface.rim is not None, tilt, direction, spin)
        level = spin * [1.0, 1.0, 0.0]
        state.v = initial.velocity_m_s + np.cross(level, state.x - tip) + np.cross(spin - level, state.x - axis)
    return state


def tilted(system, tilt: float, direction: float) -> State:
    """The unstrained column turned rigidly by `tilt` [rad] towards `direction` [rad], its lowest point on the base."""
    column, interface = system.column, system.interface
    interface.place(None)
    turn, pivot, lift = leaning(interface.reference, interface.rim is not None, tilt, direction)
    x = (column.X - pivot) @ turn.T + pivot + [0.0, 0.0, lift]
    rotation, internal, strain = system.kinematics.internal(x)
    relative = interface.dynamic_position(x, rotation)
    fall = np.tile(system.gravity, (len(x), 1))
    return State(
        time=0.0, x=x, v=np.zeros_like(x), a=fall, contact_a=np.zeros_like(x), internal=internal, strain=strain, rotation=rotation,
        forces=np.zeros((interface.size, 3)), anchors=relative[:, :2].copy(), relative=relative, static=0.0, ground=np.zeros(3),
        indent=np.zeros((interface.size, 3)))
