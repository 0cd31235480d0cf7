"""A rigid structure that rocks in a plane with one degree of freedom: block, restrained block,
block with a roof mass, rocking frame.

`swing_equations` has its equation of motion, `swing_motion` solves it from impact to impact; the
manual derives all of it (fecolumn help rocking).
"""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.engines.rocking.swing_equations import N_PARAMETERS
from fecolumn.engines.rocking.swing_motion import SWING_TIME, rock_motions
from fecolumn.foundation.arrays import Array
from fecolumn.foundation.cores import usable_cores


def rock_all(
    grounds: list[Array],
    steps: ArrayLike,
    which: ArrayLike,
    scales: ArrayLike,
    parameters: Array,
    *,
    threads: int | None = None,
) -> Array:
    """Rock many structures in many motions, from rest, until nothing can overturn them any more;
    one row an analysis.

    Parameters
    ----------
    grounds
        arrays (n_samples, 2) of ground accelerations along x and z [m/s2].
    steps
        sampling step of each [s].
    which, scales
        (n,) motion of each analysis, and the factor on its accelerations.
    parameters
        (n, N_PARAMETERS), or (1, N_PARAMETERS) for all.
    threads
        at work at once; left out, as many as the machine has, or NUMBA_NUM_THREADS.

    Returns
    -------
    (n, 6) in the columns PEAK_TILT, IMPACT_COUNT, ...
    """
    lengths = np.array([len(ground) for ground in grounds], np.int64)
    offsets = np.concatenate([[0], np.cumsum(lengths)])[:-1]
    whole = np.ascontiguousarray(
        np.concatenate([np.asarray(ground, float).reshape(-1, 2) for ground in grounds])
    )
    motions = np.ascontiguousarray(which, np.int64)
    factors = np.ascontiguousarray(np.broadcast_to(scales, motions.shape), float)
    parameters = np.ascontiguousarray(
        np.broadcast_to(parameters, (len(motions), N_PARAMETERS)), float
    )
    samples = np.ascontiguousarray(np.broadcast_to(steps, lengths.shape), float)
    out = np.empty((len(motions), 6))
    starts, nothing = np.zeros((len(motions), 2)), np.zeros((len(motions), 0, 6))

    def some(part: slice) -> None:
        rock_motions(
            whole,
            offsets[motions[part]],
            lengths[motions[part]],
            lengths[motions[part]],
            samples[motions[part]],
            factors[part],
            parameters[part],
            starts[part],
            nothing[part],
            np.zeros((len(out[part]), 0)),
            out[part],
        )

    threads = threads or int(os.environ.get("NUMBA_NUM_THREADS", 0)) or usable_cores()
    parts = [
        slice(begin, begin + max(1, math.ceil(len(motions) / (8 * threads))))
        for begin in range(0, len(motions), max(1, math.ceil(len(motions) / (8 * threads))))
    ]
    if threads == 1 or len(motions) < 64:
        some(slice(None))
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(some, parts))
    return out


def rock_one(
    ground: Array,
    step: float,
    parameters: Array,
    *,
    free_s: float = 0.0,
    tilt: float = 0.0,
    tilt_rate: float = 0.0,
) -> tuple[Array, Array, Array]:
    """Rock one structure and record it.

    Parameters
    ----------
    ground
        (n_samples, 2) along x and z [m/s2].
    step
        [s].
    parameters
        (N_PARAMETERS,).
    free_s
        followed after the motion [s].
    tilt, tilt_rate
        theta and theta' at the start [rad, rad/s].

    Returns
    -------
    (n, 6) states in the columns SWING_TIME, SWING_TILT, ..., one a sample, the fall last; impact
        times (k,) [s]; results (6,), of which PEAK_TILT is inf where
    the structure fell, or is bound to.
    """
    ground = np.ascontiguousarray(ground, float)
    total = len(ground) + math.ceil(free_s / step - 1e-9)
    states, impacts, out = np.zeros((1, total + 1, 6)), np.zeros((1, 200_000)), np.empty((1, 6))
    one = np.zeros(1, np.int64)
    rock_motions(
        ground,
        one,
        one + len(ground),
        one + total,
        np.array([step]),
        np.ones(1),
        np.ascontiguousarray(parameters[None], float),
        np.array([[tilt, tilt_rate]]),
        states,
        impacts,
        out,
    )
    filled = 1 + np.flatnonzero(states[0, 1:, SWING_TIME])
    n_impacts = np.count_nonzero(impacts[0])
    return states[0, : 1 + len(filled)], impacts[0, :n_impacts], out[0]
