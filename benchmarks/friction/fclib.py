"""Friction problems from files: HDF5 of the Friction Contact Library, and the text of Siconos' own
test problems.

The library is at https://frictionalcontactlibrary.github.io; its problems are not part of this
project.
"""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from benchmarks.friction.problem import Problem


def read_problem(path: Path) -> Problem:
    """A problem in three dimensions of either kind of file.

    Raises
    ------
    ValueError
        not such a problem; the message says which file and why.
    """
    try:
        W, q, mu = _hdf5(path) if path.suffix == ".hdf5" else _text(path)
    except (OSError, KeyError, IndexError, ValueError) as error:
        raise ValueError(f"{path}: no friction problem in three dimensions: {error}") from None
    # both have the normal component first
    order = (3 * np.arange(len(mu))[:, None] + [1, 2, 0]).ravel()
    mu = float(mu[0]) if np.ptp(mu) == 0 else mu
    # stored W is symmetric to its writer's rounding only
    W = (W + W.T) / 2
    return Problem(path.name.split(".")[0], W[np.ix_(order, order)], q[order].reshape(-1, 3), mu)


def _hdf5(path):
    with h5py.File(path) as file:
        local = "fclib_local" in file
        group = file["fclib_local" if local else "fclib_global"]
        if group["spacedim"][0] != 3:
            raise ValueError(f"spacedim is {group['spacedim'][0]}")
        vectors = {name: data[:] for name, data in group["vectors"].items()}
        if local:
            return _matrix(group["W"]).toarray(), vectors["q"], vectors["mu"]
        H, M = _matrix(group["H"]), _matrix(group["M"]).tocsc()
        inverse = splu(M).solve(np.column_stack([H.toarray(), vectors["f"]]))
        return H.T @ inverse[:, :-1], H.T @ inverse[:, -1] + vectors["w"], vectors["mu"]


def _matrix(group):
    """Of FCLIB: triplets, or compressed columns or rows where nz is -1 or -2."""
    m, n, nz = (int(group[name][0]) for name in ("m", "n", "nz"))
    p, i, x = (group[name][:] for name in ("p", "i", "x"))
    if nz >= 0:
        return sparse.coo_array((x[:nz], (i[:nz], p[:nz])), (m, n)).tocsr()
    return (sparse.csc_array if nz == -1 else sparse.csr_array)((x, i, p), (m, n))


def _text(path):
    """Dimension, points, storage (0 dense by columns, 1 blocks by rows), W, q, mu."""
    every = path.read_text().split()
    words = iter(every)

    def take(count, kind=float):
        return np.array([kind(next(words)) for _ in range(count)])

    try:
        dimension, n, storage = take(3, int)
        if dimension != 3 or storage not in (0, 1):
            raise ValueError(f"dimension {dimension}, storage {storage}")
        rows, columns = take(2, int)
        if (rows, columns) != (3 * n, 3 * n):
            raise ValueError(f"a matrix of {rows} x {columns} for {n} points")
        if storage == 0:
            if len(every) >= 5 + 2 + rows * columns + rows + n:
                take(2, int)  # most files repeat the size
            W = take(rows * columns).reshape(columns, rows).T
        else:
            count, height, width = take(3, int)
            ends = [np.concatenate([[0], take(k, int)]) for k in (height, width)]
            starts, where = (take(k, int) for k in take(2, int))
            W = np.zeros((rows, columns))
            for row in range(len(starts) - 1):
                for block in range(starts[row], starts[row + 1]):
                    if int(next(words)) != block:
                        raise ValueError(f"block {block} of {count} is not where it should be")
                    top, end = ends[0][row : row + 2]
                    left, right = ends[1][where[block] : where[block] + 2]
                    W[top:end, left:right] = (
                        take((end - top) * (right - left)).reshape(right - left, end - top).T
                    )
        q, mu = take(rows), take(n)
        # older files end with a flag
        if len(rest := list(words)) > 1:
            raise ValueError(f"{len(rest)} numbers too many")
        return W, q, mu
    except (StopIteration, RuntimeError):
        raise ValueError("it ends too early") from None
