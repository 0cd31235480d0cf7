"""The interface between the column's foot and the base: gaps, slips and the frictional contact problem."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fecolumn.contact.delassus import below, turned
from fecolumn.contact.friction import ContactSolution, solve_contact
from fecolumn.contact.pad import Pad, dashpot_work, indent
from fecolumn.contact.rim import Rim, RimPoints

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


@dataclass(slots=True)
class Spring:
    """Compliance `own` (n, 3) [m/N] of contact law and pad at the points in a step, and how far the pad is moved before, `offset` (n, 3) [m].

    give, kept: of the pad, see `contact.pad.Pad`; before: (n, 3) its indentation at the start.
    """

    own: np.ndarray
    offset: np.ndarray
    give: np.ndarray
    kept: float
    before: np.ndarray

    def indented(self, forces: np.ndarray) -> np.ndarray:
        """Indentation (n, 3) [m] of the pad at the end of the step under forces (n, 3)."""
        after = np.zeros_like(self.before)
        if self.before.any() or self.give.any():
            indent(self.give, self.kept, forces, self.before, after)
        return after


class Interface:
    """Contact points of the column's foot on the deformed top of the base, in the table frame.

    The points are the foot's nodes, but for those of a round rim, which may have turned along it (`place`).

    Args:
        foot: FilteredFoot or PlainFoot: what the time integration shows of the column.
        reference: (n, 3) reference positions of its nodes [m].
        base: BasePlate.
        friction: Coulomb coefficient.
        own: (n, 3) compliance of the contact law [m/N].
        rim: the foot's round rim, None to take it as the polygon of its nodes.
        restitution: see `contact.restitution`.
        pad: Pad below its points, None for a base without.
    """

    def __init__(self, foot, reference, base, friction: float, own: np.ndarray, rim: Rim | None = None,
                 restitution: float = 0.0, pad: Pad | None = None):
        self.restitution, self.pad = restitution, pad
        self.foot, self.reference, self.base, self.friction, self.own, self.rim = foot, reference, base, friction, own, rim
        self.size = len(reference)
        self._turned: RimPoints | None = None
        self._lift: np.ndarray | float = 0.0
        self._rim_number = np.full(self.size, -1)
        if rim is not None:
            self._rim_number[rim.nodes] = np.arange(len(rim.nodes))
        #: Width of the foot [m], to which tolerances are related.
        self.width = float(np.ptp(reference[:, 0]))

    def spring(self, dt: float, before: np.ndarray) -> Spring:
        """What the points give alone in a step dt [s] that finds the pad indented by `before` (n, 3) [m]."""
        if self.pad is None:
            return Spring(self.own, np.zeros_like(self.own), np.zeros_like(self.own), 0.0, before)
        give, kept = self.pad.give(dt)
        return Spring(self.own + give, kept * before, give, kept, before)

    def place(self, points: RimPoints | None, lift=0.0) -> None:
        """Put the rim's points where `points` has them, `lift` (n_rim,) [m] above the rim there; None: on its nodes."""
        self._turned, self._lift = points, lift

    def _at_points(self, values: np.ndarray) -> np.ndarray:
        """Values (n, ...) at the points from those at the nodes."""
        if self._turned is None:
            return values
        at_points = values.copy()
        at_points[self._turned.slots] = self._turned.of(values)
        return at_points

    def at_nodes(self, forces: np.ndarray) -> np.ndarray:
        """Forces (n, 3) on the nodes from those on the points."""
        points = self._turned
        if points is None:
            return forces
        shared = forces.copy()
        shared[points.slots] = 0.0
        loaded = np.flatnonzero(forces[points.slots].any(axis=1))
        np.add.at(shared, points.carriers[loaded], points.weights[:, None] * forces[points.slots[loaded], None])
        return shared

    def turned(self, compliance: np.ndarray, active: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Compliance (3 k, 3 k) of the active points, turned into the table frame, from that of the nodes (n, n, 3, 3)."""
        at, on_rim = self._rim_points(active)
        if not len(at):
            return turned(compliance, active, rotation)
        carriers, weights = self._turned.carriers[on_rim], self._turned.weights
        nodes = np.union1d(active, carriers)
        W = turned(compliance, nodes, rotation).reshape(len(nodes), 3, len(nodes), 3)
        rows, carriers = np.searchsorted(nodes, active), np.searchsorted(nodes, carriers)
        half = W[rows]
        half[at] = np.einsum("q,rqaib->raib", weights, W[carriers])
        whole = half[:, :, rows]
        whole[:, :, at] = np.einsum("q,iarqb->iarb", weights, half[:, :, carriers])
        return whole.reshape(3 * len(active), 3 * len(active))

    def _rim_points(self, active: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Which of the active points are turned points of the rim, and their numbers there."""
        if self._turned is None:
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        number = self._rim_number[active]
        at = np.flatnonzero(number >= 0)
        return at, number[at]

    def node_positions(self, x: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Positions (n, 3) of the foot's nodes from the column's positions x (n_owned, 3), without the static part."""
        return (self.reference + self.foot.position(x @ rotation - self.foot.body.X)) @ rotation.T

    def dynamic_position(self, x: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Positions (n, 3) of the points from the column's positions x (n_owned, 3), without the static part."""
        positions = self._at_points(self.node_positions(x, rotation))
        if self._turned is not None:
            positions[self._turned.slots, 2] += self._lift
        return positions

    def dynamic_velocity(self, v: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Velocities (n, 3) of the points from the column's velocities."""
        return self._at_points(self.foot.position(v @ rotation) @ rotation.T)

    def load(self, forces: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Nodal forces (n_owned, 3) of contact forces (n, 3) on the column turned by `rotation`."""
        return self.foot.load(self.at_nodes(forces) @ rotation) @ rotation.T

    def acceleration(self, forces: np.ndarray, rotation: np.ndarray) -> np.ndarray:
        """Accelerations (n_owned, 3) of contact forces, or velocity jumps of contact impulses (n, 3)."""
        return self.foot.acceleration(self.at_nodes(forces) @ rotation) @ rotation.T

    def project(self, positions: np.ndarray, forces: np.ndarray | None = None) -> Footing:
        """Base nodes under positions (n, 3); raises OffBase where a point that touches is outside the plate.

        Points touch that are low or bear one of the forces (n, 3); all of them without forces.
        """
        touching = None if forces is None else (positions[:, 2] < NEAR * self.width) | (forces[:, 2] > 0)
        return Footing(*self.base.grid.project(positions, touching))

    def static_compliance(self, active: np.ndarray, rotation: np.ndarray, footing: Footing, own: np.ndarray | None = None) -> np.ndarray:
        """Compliance (3 k, 3 k) of the active points that follows the forces at once: foot's rest, base, and `own` (n, 3) of the points alone, the contact law's if not given."""
        nodes = footing.nodes[active]
        self.base.need(nodes.ravel())
        W = self.turned(self.foot.static, active, rotation) + below(self.base.compliance, self.base.slot[nodes], footing.weights[active])
        W[np.diag_indices(len(W))] += (self.own if own is None else own)[active].ravel()
        at, on_rim = self._rim_points(active)
        if len(at):
            rows = 3 * at[:, None] + np.arange(3)
            W[rows[:, :, None], rows[:, None, :]] += self._evened(on_rim, rotation, footing)
        return W

    def _evened(self, on_rim: np.ndarray, rotation: np.ndarray, footing: Footing) -> np.ndarray:
        """Compliance (k, 3, 3) by which forces at points of the rim, spread over nodes of foot and base, meet less than at a node.

        Given back so that the indentation of a rolling rim is even: it would otherwise store and return energy at each node.
        """
        near, share = self._turned.carriers[on_rim, :2], self._turned.weights[:2]
        first, second = near.T
        foot = self.foot.static
        apart = foot[first, first] + foot[second, second] - foot[first, second] - foot[second, first]
        even = share[0] * share[1] * np.einsum("ab,kbc,dc->kad", rotation, apart, rotation)
        points = self._turned.slots[on_rim]
        slots, share = self.base.slot[footing.nodes[points]], footing.weights[points]
        base = self.base.compliance[slots[:, :, None], slots[:, None]]
        return even + np.einsum("kp,kppab->kab", share, base) - np.einsum("kp,kq,kpqab->kab", share, share, base)

    def static_displacement(self, forces: np.ndarray, rotation: np.ndarray, footing: Footing) -> np.ndarray:
        """Displacement (n, 3) of every point relative to the base from the static compliance of foot and base.

        The base's part is known where its compliance has been built, which is wherever the foot comes near it.
        """
        loaded = np.flatnonzero(forces[:, 2] > 0)
        if not len(loaded):
            return np.zeros_like(forces)
        on_nodes = self.at_nodes(forces)
        pressed = np.flatnonzero(on_nodes.any(axis=1))
        moved = self._at_points(np.einsum("ijab,jb->ia", self.foot.static[:, pressed], on_nodes[pressed] @ rotation) @ rotation.T)
        slots = self.base.slot[footing.nodes]
        share = np.zeros((len(self.base.compliance), 3))
        np.add.at(share, slots[loaded].ravel(), (footing.weights[loaded, :, None] * forces[loaded, None, :]).reshape(-1, 3))
        touched = np.flatnonzero(np.any(share != 0, axis=1))
        sunk = np.einsum("ijab,jb->ia", self.base.compliance[:, touched], share[touched])
        sunk = np.vstack([sunk, np.zeros(3)])  # slot -1: not built, far away
        moved += np.einsum("np,npa->na", footing.weights, sunk[slots])
        at, on_rim = self._rim_points(loaded)
        if len(at):
            moved[loaded[at]] += np.einsum("kab,kb->ka", self._evened(on_rim, rotation, footing), forces[loaded[at]])
        return moved

    def stored(self, forces: np.ndarray, given: np.ndarray, indented: np.ndarray) -> float:
        """Strain energy [J] of base, foot's static rest and contact law by `static_displacement` given (n, 3), and of an indented pad."""
        energy = np.sum(forces * (given + self.own * forces))
        if self.pad is not None:
            energy += np.sum(self.pad.stiffness * indented**2)
        return float(energy) / 2

    def pad_loss(self, spring: Spring, forces: np.ndarray, indented: np.ndarray) -> float:
        """Energy [J] that the pad's dashpots take in a step."""
        return 0.0 if self.pad is None else dashpot_work(self.pad.stiffness, spring.give, spring.kept, forces, spring.before, indented)

    def solve(self, active, compliance, moved, anchors, forces, spring: Spring) -> tuple[np.ndarray, ContactSolution]:
        """New contact forces (n, 3) [N] and the solver's record.

        Args:
            active: (k,) points of the problem; the others carry no force.
            compliance: (3 k, 3 k) dynamic and static compliance [m/N].
            moved: (n, 3) positions relative to the base under the present forces, without what the points give alone [m].
            anchors: (n, 2) horizontal positions at which the points stick [m].
            forces: (n, 3) present forces, the first guess [N].
            spring: what the points give alone.
        """
        q = moved[active] + spring.own[active] * forces[active] + spring.offset[active]
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
