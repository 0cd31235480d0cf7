"""A friction problem, and one measure of how well forces solve it, for every solver."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# Singular values of W below this share of the largest count as zero
RANK = 1e-10


@dataclass(frozen=True, slots=True)
class Problem:
    """Find r with u = W r + q, r in Coulomb's cone, u opposed by it: a velocity problem, or one of
    displacements.

    Attributes
    ----------
    name
        in tables.
    W
        (3 n, 3 n) symmetric, positive semidefinite [1/kg].
    q
        (n, 3) relative velocity without forces [m/s]; x, y tangential, z normal, opening positive.
    mu
        friction coefficient of all points, or (n,).
    start
        (n, 3) forces that are a first guess, where there is one.
    """

    name: str
    W: np.ndarray
    q: np.ndarray
    mu: float | np.ndarray
    start: np.ndarray | None = None

    @property
    def points(self) -> int:
        """Number of points."""
        return len(self.q)

    @property
    def rank(self) -> int:
        """Rank of W."""
        return int(
            np.linalg.matrix_rank(self.W, tol=RANK * np.linalg.norm(self.W, 2), hermitian=True)
        )

    def relative(self, forces) -> np.ndarray:
        """u (n, 3) under forces (n, 3)."""
        return (self.W @ np.ravel(forces)).reshape(-1, 3) + self.q

    def softened(self, share: float) -> Problem:
        """The same with a compliance of each point's own, a share of W's mean diagonal: W becomes
        definite.
        """
        own = share * np.trace(self.W) / len(self.W)
        return Problem(self.name, self.W + own * np.eye(len(self.W)), self.q, self.mu, self.start)


def on_cone(x, mu) -> np.ndarray:
    """Nearest points (n, 3) of Coulomb's cone |x_t| <= mu x_n, mu (n,), to x (n, 3)."""
    tangential = np.hypot(x[:, 0], x[:, 1])
    # without friction the cone is a line, and half of the other one it would lie in, too
    inside, polar = (tangential <= mu * x[:, 2]) & (x[:, 2] >= 0), mu * tangential <= -x[:, 2]
    normal = (mu * tangential + x[:, 2]) / (1 + mu**2)
    factor = np.divide(mu * normal, tangential, out=np.zeros_like(normal), where=tangential > 0)
    nearest = np.column_stack([factor * x[:, 0], factor * x[:, 1], normal])
    return np.where(inside[:, None], x, np.where(polar[:, None], 0.0, nearest))


def violation(problem: Problem, forces) -> float:
    """Natural map of the bipotential (De Saxce and Feng 1998): largest |r - P(r - rho (u + mu |u_t|
    n))| / rho over max |q|.

    P: on Coulomb's cone; rho: 3 over the trace of the point's own block of W. Zero exactly at a
    solution. The project's own residual projects on the disk of the present normal force instead:
    the two agree at solutions only. Infinite where forces are no numbers, or too large for one.
    """
    forces, mu = np.reshape(forces, (-1, 3)), np.broadcast_to(problem.mu, problem.points)
    if not np.abs(forces).max() < 1e100:
        return np.inf
    u = problem.relative(forces)
    u[:, 2] += mu * np.hypot(u[:, 0], u[:, 1])
    rho = 3 / np.diag(problem.W).reshape(-1, 3).sum(1)[:, None]
    distance = np.linalg.norm(forces - on_cone(forces - rho * u, mu), axis=1)
    return float((distance / rho[:, 0]).max() / np.abs(problem.q).max())
