"""State at t = 0: gravity equilibrium of the standing column, or a rigid tilt released at rest."""

from __future__ import annotations

import numpy as np

from fecolumn.dynamics.rotation import rotation_matrix
from fecolumn.dynamics.stage import Stage, Stop, equilibrate
from fecolumn.dynamics.system import State

# Inertia factor of the pseudo-time iteration [1/s2]: it only holds what contact and friction leave free.
PSEUDO_INERTIA = 400.0
# A step that moves the column less is at rest, above the rounding of positions [m]
REST = 1e-11


def standing(system, tolerance: float = 1e-9, max_iterations: int = 50) -> State:
    """Gravity equilibrium on the elastic base with friction.

    Backward-Euler steps without velocity: each is a proximal-point iteration on the energy with contact and contracts
    by the ratio of inertia to stiffness, about 1e-4, so that a handful reaches rounding.

    Raises:
        RuntimeError: no equilibrium, for example of a column whose centre of mass does not stand over its foot.
    """
    column, interface = system.column, system.interface
    interface.place(None)
    load, x = system.load(np.zeros(3)), column.X.copy()
    anchors = interface.reference[:, :2].copy()
    forces = np.zeros((interface.size, 3))
    factors = PSEUDO_INERTIA, 1.0
    for _ in range(max_iterations):
        stage = Stage(target=x, load=load, start=x, scale=1.0, anchors=anchors, forces=forces,
                      spring=interface.spring(np.inf, np.zeros_like(forces)), rotation=np.eye(3))
        outcome = equilibrate(system, system.operators(*factors), stage, tolerance, 20)
        if outcome.stop is not Stop.CONVERGED:
            raise RuntimeError(f"gravity equilibrium: {outcome.stop.value} {outcome.message} (residual {outcome.residual:.2e} of the weight)")
        moved = column.max(np.abs(outcome.x - x).max(initial=0.0))
        x, forces = outcome.x, outcome.forces
        if moved < REST:
            break
    else:
        raise RuntimeError(f"gravity equilibrium: still moving by {moved:.2e} m after {max_iterations} iterations")
    system.forget(*factors)
    push = interface.acceleration(forces, outcome.rotation) if interface.foot.filtered else np.zeros_like(x)
    return State(
        time=0.0, x=x, v=np.zeros_like(x), a=-push, contact_a=push, internal=outcome.internal, strain=outcome.strain,
        rotation=outcome.rotation, forces=forces, anchors=anchors, relative=outcome.relative,
        static=outcome.static, ground=np.zeros(3), indent=stage.spring.indented(forces))


def tilted(system, tilt: float, direction: float) -> State:
    """The unstrained column turned rigidly by `tilt` [rad] towards `direction` [rad], its lowest point on the base."""
    column, interface = system.column, system.interface
    interface.place(None)
    turn = rotation_matrix(tilt * np.array([-np.sin(direction), np.cos(direction), 0.0]))
    foot = interface.reference
    pivot = np.array([np.cos(direction), np.sin(direction), 0.0]) * np.linalg.norm(foot[:, :2], axis=1).max()
    # a round rim stands on the pivot itself, between nodes
    lift = 0.0 if interface.rim else -((foot - pivot) @ turn.T + pivot)[:, 2].min()
    x = (column.X - pivot) @ turn.T + pivot + [0.0, 0.0, lift]
    rotation, internal, strain = system.kinematics.internal(x)
    relative = interface.dynamic_position(x, rotation)
    fall = np.tile(system.gravity, (len(x), 1))
    return State(
        time=0.0, x=x, v=np.zeros_like(x), a=fall, contact_a=np.zeros_like(x), internal=internal, strain=strain, rotation=rotation,
        forces=np.zeros((interface.size, 3)), anchors=relative[:, :2].copy(), relative=relative, static=0.0, ground=np.zeros(3),
        indent=np.zeros((interface.size, 3)))
