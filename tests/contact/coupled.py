"""Compliances of points that do not all move one another."""

import numpy as np

# Between which of the blocks W is not zero: joints of a stack; heads of three columns on a slab,
# then their feet; feet on rigid ground
CHAIN = [(k, k + 1) for k in range(4)]
FRAME = [(0, 1), (0, 2), (1, 2), (0, 3), (1, 4), (2, 5)]


def compliance(sizes, pairs, seed=0):
    """Symmetric positive definite, of points in blocks of so many, those of `pairs` coupled."""
    random, of = np.random.default_rng(seed), np.repeat(np.arange(len(sizes)), sizes)
    touching = np.eye(len(sizes), dtype=bool)
    for one, other in pairs:
        touching[one, other] = touching[other, one] = True
    W = random.standard_normal((3 * len(of), 3 * len(of))) * np.kron(
        touching[np.ix_(of, of)], np.ones((3, 3))
    )
    return W + W.T + np.diag(2 * np.abs(W + W.T).sum(axis=1))
