"""The interface between the column's foot and the base: gaps, slips and the frictional contact problem."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.contact.delassus import below, turned
from fecolumn.contact.friction import ContactSolution, solve_contact

# Points nearer than this, over the foot's width, join the contact problem before they touch
NEAR = 2e-4
# Residual of the contact laws at which a contact problem is solved, over the foot's width
SOLVED = 1e-11
# Residual velocity above which an impact is not solved, over the largest velocity of the points but at least 1e-3 m/s
IMPACT_TOLERANCE = 1e-8


class ImpactUnsolved(RuntimeError):
    """No impulses were found that satisfy the laws of impact and friction."""


@dataclass(slots=True)
class Footing:
    """Where the foot stands: base nodes (n, 4) and weights (n, 4) under each of its points."""

    nodes: np.ndarray
    weights: np.ndarray


class Interface:
    """Contact points of the column's foot on the deformed top of the base, in the table frame.

    Args:
        foot: FilteredFoot or PlainFoot: what the time integration shows of the column.
        reference: (n, 3) reference positions of its points [m].
        base: BasePlate.
        friction: Coulomb coefficient.
        own: (n, 3) compliance of the contact law [m/N].
    """

    def __init__(self, foot, reference, base, friction: float, own: np.ndarray):
        self.foot, self.reference, self.base, self.friction, self.own = foot, reference, base, friction, own
        self.size = len(reference)
        #: Width of the foot [m], to which tolerances are related.
        self.width = float(np.ptp(reference[:, 0]))

    def dynamic_position(self, x: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Positions (n, 3) of the foot from the column's positions x (n_owned, 3), without the static part."""
        return (self.reference + self.foot.position(x @ rotation - self.foot.body.X)) @ rotation.T

    def dynamic_velocity(self, v: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Velocities (n, 3) of the foot from the column's velocities."""
        return self.foot.position(v @ rotation) @ rotation.T

    def project(self, positions: np.ndarray) -> Footing:
        """Base nodes under positions (n, 3); raises OffBase outside the plate."""
        return Footing(*self.base.grid.project(positions))

    def static_compliance(self, active: np.ndarray, rotation: np.ndarray, footing: Footing) -> np.ndarray:
        """Compliance (3 k, 3 k) of the active points that follows the forces at once: foot's rest, base, contact law."""
        nodes = footing.nodes[active]
        self.base.need(nodes.ravel())
        W = turned(self.foot.static, active, rotation) + below(self.base.compliance, self.base.slot[nodes], footing.weights[active])
        W[np.diag_indices(len(W))] += self.own[active].ravel()
        return W

    def static_displacement(self, forces: np.ndarray, rotation: np.ndarray, footing: Footing) -> np.ndarray:
        """Displacement (n, 3) of every point relative to the base from the static compliance of foot and base.

        The base's part is known where its compliance has been built, which is wherever the foot comes near it.
        """
        loaded = np.flatnonzero(forces[:, 2] > 0)
        if not len(loaded):
            return np.zeros_like(forces)
        local = forces[loaded] @ rotation
        moved = np.einsum("ijab,jb->ia", self.foot.static[:, loaded], local) @ rotation.T
        slots = self.base.slot[footing.nodes]
        share = np.zeros((len(self.base.compliance), 3))
        np.add.at(share, slots[loaded].ravel(), (footing.weights[loaded, :, None] * forces[loaded, None, :]).reshape(-1, 3))
        touched = np.flatnonzero(np.any(share != 0, axis=1))
        sunk = np.einsum("ijab,jb->ia", self.base.compliance[:, touched], share[touched])
        sunk = np.vstack([sunk, np.zeros(3)])  # slot -1: not built, far away
        return moved + np.einsum("np,npa->na", footing.weights, sunk[slots])

    def solve(self, active, compliance, moved, anchors, forces) -> tuple[np.ndarray, ContactSolution]:
        """New contact forces (n, 3) [N] and the solver's record.

        Args:
            active: (k,) points of the problem; the others carry no force.
            compliance: (3 k, 3 k) dynamic and static compliance [m/N].
            moved: (n, 3) positions relative to the base under the present forces, without the contact law's own give [m].
            anchors: (n, 2) horizontal positions at which the points stick [m].
            forces: (n, 3) present forces, the first guess [N].
        """
        q = moved[active] + self.own[active] * forces[active]
        q[:, :2] -= anchors[active]
        q -= (compliance @ forces[active].ravel()).reshape(-1, 3)
        solution = solve_contact(compliance, q, self.friction, forces[active], SOLVED * self.width)
        updated = np.zeros((self.size, 3))
        updated[active] = solution.forces
        return updated, solution

    def impact(self, active, mobility, velocity, start) -> tuple[np.ndarray, ContactSolution]:
        """Impulses (n, 3) [N s] of a plastic impact with friction (Moreau 1988), and the solver's record.

        Args:
            active: (k,) points that touch.
            mobility: (3 k, 3 k) velocity jump per impulse [m/(N s)].
            velocity: (n, 3) of the points without the impulses of the step [m/s].
            start: (n, 3) first guess [N s].
        """
        allowed = IMPACT_TOLERANCE * max(np.abs(velocity[active]).max(initial=0.0), 1e-3)
        # a guess far off can trap the iteration: zero is the second
        for guess in (start[active], np.zeros((len(active), 3))):
            solution = solve_contact(mobility, velocity[active], self.friction, guess)
            if solution.residual <= allowed:
                break
        else:
            raise ImpactUnsolved(f"impact residual {solution.residual:.2e} m/s")
        impulses = np.zeros((self.size, 3))
        impulses[active] = solution.forces
        return impulses, solution
