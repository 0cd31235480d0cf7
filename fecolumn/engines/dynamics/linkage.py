"""Links between bodies in full order: forces on their rigid motion, which strain nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import frames_at
from fecolumn.engines.dynamics.links import TIE, Held, Linked, end_links, pull_links
from fecolumn.fem.free_body import rigid_fields
from fecolumn.fem.rotation import out_of_frames
from fecolumn.foundation.arrays import Array, Record

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.stage import Stage
    from fecolumn.fem.composite import Composite


class Linkage:
    """Forces of links, a Linked, as nodal forces and accelerations of a Composite.

    A link is held by the rigid motion of its bodies: by the places that its ends have from the
    centres of mass, turned by the mean rotations.
    """

    def __init__(self, bodies: Composite, linked: Linked) -> None:
        self._bodies, self.linked, self.links = bodies, linked, linked.links
        made = bodies.of_each(lambda part, _: rigid_fields(part))
        self._fields, self._momenta, masses = zip(*made)
        self._inverse = [np.linalg.inv(one) for one in masses]
        #: Bound of the square of the fastest frequency of the bodies on their links [1/s2].
        self.stiffest = sum(
            float(link["stiffness"]) * sum(self._gives(b, arm) for b, arm in ends_of(link))
            for link in self.links
        )

    def _gives(self, b: int, arm: Array) -> float:
        """Bound of the acceleration of an end per force on it [1/kg]."""
        return (
            0.0
            if b == GROUND
            else self._inverse[b][0, 0]
            + arm @ arm * np.linalg.eigvalsh(self._inverse[b][3:, 3:])[-1]
        )

    def stored(self, state: Any) -> float:
        """Strain energy [J] of the links at rest in a State, whose ties become those of the links
        at rest.
        """
        kept, _ = self.end(state.ties.copy(), state, np.inf)
        state.ties["work"] = 0.0  # what they lose on the way there is not of the motion
        return kept

    def end(self, ties: Array, state: Any, dt: float) -> tuple[float, float]:
        """`end_links` of a step dt [s] from `ties` to a State, whose ties become those of its
        end.
        """
        centers = self._bodies.centers(state.x)
        after = self._held(state.grounds, centers, state.rotation, state.ties)
        return end_links(self.linked, after._replace(ties=ties), after, dt)

    def _held(self, grounds: Array, centers: Any, rotation: Array, ties: Any) -> Held:
        modal = np.zeros((len(centers), 3, 0))
        return Held(grounds, frames_at(centers), rotation, modal, ties)

    def ties(self, centers: Array, rotation: Array) -> Array:
        """Ties (nl,) of TIE of links that have not been loaded, of bodies with centres of mass (nb,
        3) [m] turned by (nb, 3, 3).
        """
        ties, frames = np.zeros(len(self.links), TIE), frames_at(centers)
        for tie, link in zip(ties, self.links):
            first, other = (
                np.array(arm) if b == GROUND else frames["center"][b] + rotation[b] @ arm
                for b, arm in ends_of(link)
            )
            tie["length"] = np.linalg.norm(other - first)
        return ties

    def pulls(self, stage: Stage, x: Array, rotation: Array) -> Array:
        """Forces (nl, 3) [N] on the ends a in a Stage that ends at positions x (n_owned, 3) with
        the bodies turned by `rotation`.
        """
        pulls = np.zeros((len(self.links), 3))
        start = self._held(stage.grounds[0], stage.centers, stage.rotation, stage.ties)
        end = self._held(stage.grounds[1], self._bodies.centers(x), rotation, stage.ties)
        pull_links(self.linked, start, end, float(stage.dt), pulls)
        return pulls

    def carried(self, pulls: Array, start: Array, end: Array) -> float:
        """Work [J] that grounds, (G,) of GROUND_STATE at start and end of a step, do by the links'
        forces (nl, 3) on the ends a.
        """
        ways = (end["place"] - start["place"])[self.links["ground"]]
        return float(np.vdot(pulls, ways * (self.links["b"] == GROUND)[:, None]))

    def _rigid(self, pulls: Array, halfway: Array) -> list[Array]:
        """Rigid accelerations (6,) of each body in its frame, turned by `halfway` (nb, 3, 3)."""
        wrenches = np.zeros((len(halfway), 6))
        for link, force in zip(self.links, pulls):
            for (b, arm), on in zip(ends_of(link), (force, -force)):
                if b != GROUND:
                    along = on @ halfway[b]
                    wrenches[b] += [*along, *np.cross(arm, along)]
        return [inverse @ wrench for inverse, wrench in zip(self._inverse, wrenches)]

    def load(self, pulls: Array, halfway: Array) -> Array:
        """Nodal forces (n_owned, 3) [N] of the links' forces (nl, 3) on bodies turned by
        `halfway`.
        """
        return self._spread(self._momenta, pulls, halfway)

    def acceleration(self, pulls: Any, halfway: Array) -> Array:
        """Accelerations (n_owned, 3) [m/s2] of the links' forces."""
        return self._spread(self._fields, pulls, halfway)

    def _spread(self, fields: tuple[Array], pulls: Array, halfway: Array) -> Array:
        rows = np.concatenate(
            [
                (field @ rigid).reshape(-1, 3)
                for field, rigid in zip(fields, self._rigid(pulls, halfway))
            ]
        )
        return out_of_frames(rows, halfway, self._bodies.rows)


def ends_of(link: Record) -> tuple:
    """Body and arm of both ends of a LINK."""
    return (int(link["a"]), link["arm_a"]), (int(link["b"]), link["arm_b"])
