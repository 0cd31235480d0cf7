"""Two free rigid blocks, one above the other, with contact points between them, as the contact core
takes them; and the same by dense matrices.
"""

import numpy as np
from plain import no_pads, poses_on_base

from fecolumn.contact.bodies import joined, one_body
from fecolumn.contact.interface import interface_of
from fecolumn.contact.points import CONTACT, node_points
from fecolumn.contact.pose import MASTER
from fecolumn.contact.projection import base_of
from fecolumn.fem.rotation import rotation_matrix

NO_BASE = base_of(
    np.zeros(2), np.zeros(2), np.zeros((2, 2), np.int64), np.zeros(4, np.int64), np.zeros((0, 0))
)


def compliance(rng, n, size=1e-9):
    """Some symmetric positive definite matrix (3 n, 3 n)."""
    root = rng.normal(size=(3 * n, 3 * n))
    return size * (root @ root.T / n + 0.1 * np.eye(3 * n))


class Blocks:
    """An upper block whose lower nodes stand on the facets of a lower one's upper nodes.

    Parameters
    ----------
    n
        contact points.
    mobile
        whether rigid motion is given by mass and inertia, as in the reduced engine, or within the
        nodal mobility, as in full order.
    """

    def __init__(self, n: int, mobile: bool, seed: int = 1):
        rng = np.random.default_rng(seed)
        self.rotations = np.stack([rotation_matrix(0.3 * rng.normal(size=3)) for _ in range(2)])
        self.masses, self.inertias = (
            [2.0, 5.0],
            [np.diag([0.1, 0.2, 0.15]), np.diag([0.5, 0.6, 0.7])],
        )
        self.arms = [rng.normal(size=(n, 3)), rng.normal(size=(n + 3, 3))]
        self.static, self.elastic = (
            [compliance(rng, len(arms)) for arms in self.arms] for _ in range(2)
        )
        self.elastic = [1e8 * one for one in self.elastic]
        parts = []
        for mass, inertia, arms, static, elastic in zip(
            self.masses, self.inertias, self.arms, self.static, self.elastic
        ):
            rigid = self.rigid(mass, inertia, arms)
            parts.append(
                one_body(arms, static, elastic, mass, inertia)
                if mobile
                else one_body(arms, static, elastic + rigid)
            )
        self.bodies = joined(parts)
        self.points = node_points(self.arms[0], 0.4, slave=0, master=1)
        self.points["below"] = n + np.stack([rng.permutation(n + 3)[:4] for _ in range(n)])
        self.points["shares"] = rng.dirichlet(np.ones(4), n)
        self.points["seat"] = np.einsum(
            "pq,pqa->pa", self.points["shares"], self.bodies.arms[self.points["below"]]
        )
        #: The frame of the interface is the table frame.
        self.poses = poses_on_base(self.rotations[:1])
        self.poses["turned"][:, MASTER] = self.rotations[1]
        self.own = rng.uniform(1e-10, 1e-9, (n, 3))
        self.springs, self.interface = (
            no_pads(self.own),
            interface_of(self.arms[0], master=1),
        )
        self.before, self.after = np.zeros(n, CONTACT), np.zeros(n, CONTACT)

    @staticmethod
    def rigid(mass, inertia, arms):
        """Velocity per impulse (3 n, 3 n) of rigid motion at arms."""
        rows = np.concatenate(
            [np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]]) for x, y, z in arms]
        )
        inverse = np.zeros((6, 6))
        inverse[:3, :3], inverse[3:, 3:] = np.eye(3) / mass, np.linalg.inv(inertia)
        return rows @ inverse @ rows.T

    def dense(self, nodal, rigid: float) -> np.ndarray:
        """W (3 n, 3 n) by whole matrices: relative motion of the points in the table frame; nodal:
        of each block in its frame.
        """
        n, total = len(self.points), 0.0
        for b, (arms, one) in enumerate(zip(self.arms, nodal)):
            pick = np.zeros((n, len(arms)))
            if b == 0:
                pick[np.arange(n), np.arange(n)] = 1.0
            else:
                np.add.at(
                    pick, (np.arange(n)[:, None], self.points["below"] - n), -self.points["shares"]
                )
            H = np.kron(pick, self.rotations[b])
            total = (
                total + H @ (one + rigid * self.rigid(self.masses[b], self.inertias[b], arms)) @ H.T
            )
        return total
