"""Rocking spectra: how far free-standing rigid blocks of every size tilt in a motion (Makris and
Konstantinidis 2003).

The law of the block is that of `rocking.swing`; a rectangular block has p^2 = 3 g/(4 R), R half its
diagonal, and at its plastic impact r = 1 - 3/2 sin^2 alpha.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.engines.rocking.impact import housner_restitution
from fecolumn.engines.rocking.swing import rock_all
from fecolumn.engines.rocking.swing_equations import row_of_block
from fecolumn.engines.rocking.swing_motion import PEAK_TILT
from fecolumn.foundation.arrays import Array
from fecolumn.motions.processing import rotate
from fecolumn.motions.record import GroundMotion


def rocking_spectrum(
    motion: GroundMotion,
    periods: ArrayLike,
    slenderness: ArrayLike,
    restitution: float | None = None,
    angle_deg: float = 0.0,
) -> Array:
    """Peak tilt over slenderness of planar rigid blocks.

    After the motion's end the free rocking that is left is followed by its energy. A block may pass
    |theta| = alpha and come back: that is its peak then, above 1.

    Parameters
    ----------
    motion
        its horizontal component along `angle_deg` (from x towards y) counts.
    periods
        (n_periods,) 2 pi/p [s], greater than 0.
    slenderness
        alpha, one or (n_slendernesses,) [rad], in (0, pi/2).
    restitution
        of the angular velocity at an impact, in [0, 1]; None for that of a rectangular block.

    Returns
    -------
    (n_periods,) or (n_slendernesses, n_periods) max |theta| / alpha; 0 where the block stands
    still, inf where it overturns.

    Raises
    ------
    ValueError
        a value outside its range.
    """
    ground = rotate(motion, -angle_deg).acceleration[:, 0]
    ground = np.column_stack([ground, np.zeros(len(ground))])
    periods, slendernesses = (
        np.atleast_1d(np.asarray(periods, dtype=np.float64)),
        np.atleast_1d(slenderness),
    )
    blocks = np.array(
        [_block(period, alpha, restitution) for alpha in slendernesses for period in periods]
    )
    peaks = rock_all([ground], motion.dt, np.zeros(len(blocks), int), 1.0, blocks)[:, PEAK_TILT]
    result = peaks.reshape(len(slendernesses), len(periods)) / slendernesses[:, None]
    found: Array = result if np.ndim(slenderness) else result[0]
    return found


def larger_rocking_spectrum(motion: GroundMotion, periods: ArrayLike, slenderness: float) -> Array:
    """Peak tilt over slenderness (n_periods,) of planar rectangular blocks along x or y, whichever
    tilts more; as rocking_spectrum.
    """
    along = [
        rocking_spectrum(motion, periods, slenderness, angle_deg=90.0 * axis)
        for axis in motion.horizontal_axes or (0,)
    ]
    larger: Array = np.max(along, axis=0)
    return larger


def tilt_quantile(peaks: Array, share: float) -> Array:
    """Least tilt within which at least `share` of the motions stay, inf where too many overturn.

    An order statistic: nothing is interpolated between a tilt and an overturning.

    Parameters
    ----------
    peaks
        (n_motions, n_periods) of rocking spectra.
    share
        in (0, 1].
    """
    tilts: Array = np.sort(peaks, axis=0)[math.ceil(share * len(peaks) - 1e-9) - 1]
    return tilts


def _block(period: float, slenderness: float, restitution: float | None) -> Array:
    if not 0 < period < math.inf:
        raise ValueError(f"period 2 pi/p = {period:g} s must be finite and greater than 0")
    if not 0 < slenderness < math.pi / 2:
        raise ValueError(f"slenderness = {slenderness:g} rad must lie between 0 and pi/2")
    if restitution is None:
        restitution = housner_restitution(slenderness)
    if not 0 <= restitution <= 1:
        raise ValueError(f"restitution = {restitution:g} must lie in [0, 1]")
    return row_of_block(float(slenderness), 2 * math.pi / float(period), float(restitution))
