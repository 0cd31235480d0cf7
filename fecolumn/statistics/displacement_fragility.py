"""Peak displacement over intensity, where overturned runs tell only that it exceeds the overturn
displacement.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import log_ndtr, ndtr

from fecolumn.statistics.bands import normal_quantile
from fecolumn.statistics.binary_regression import DegenerateData, maximize
from fecolumn.statistics.ecdf import censored, largest_peak
from fecolumn.statistics.fragility import Probability, log_columns


@dataclass(frozen=True, slots=True)
class DisplacementFragility:
    """ln u_max = c0 + c1 ln im_1 + ... + sigma e, e standard normal.

    The law is meant for u up to the cap; beyond it nothing was seen.

    Attributes
    ----------
    coefficients
        (k + 1,) c, with u in m.
    sigma
        logarithmic standard deviation [-].
    covariance
        (k + 2, k + 2) of (c, sigma), inverse of the observed information by the delta method.
    loglik
        log-likelihood of ln u at the maximum.
    n, overturned
        runs, and how many were censored.
    cap_m
        displacement at which overturned runs are censored [m].
    """

    coefficients: NDArray[Any]
    sigma: float
    covariance: NDArray[Any]
    loglik: float
    n: int
    overturned: int
    cap_m: float

    def median_m(self, im: ArrayLike) -> NDArray[Any]:
        """Median of u_max [m] at im (m, k), or (m,) of one measure."""
        return np.asarray(np.exp(log_columns(im, len(self.coefficients) - 1) @ self.coefficients))

    def exceedance(self, u_m: float, im: ArrayLike, confidence: float = 0.95) -> Probability:
        """P(u_max > u_m | im), with its band by the delta method on the scale of Phi's argument.

        Raises
        ------
        ValueError
            u_m outside (0, cap_m].
        """
        if not 0 < u_m <= self.cap_m:
            raise ValueError(
                f"u_m = {u_m}: must lie in (0, {self.cap_m:g}] m, as overturned runs "
                "are censored there"
            )
        x = log_columns(im, len(self.coefficients) - 1)
        eta = (x @ self.coefficients - np.log(u_m)) / self.sigma
        gradient = np.column_stack([x, -eta]) / self.sigma
        reach = normal_quantile(confidence) * np.sqrt(
            np.einsum("ni,ij,nj->n", gradient, self.covariance, gradient)
        )
        return Probability(ndtr(eta), ndtr(eta - reach), ndtr(eta + reach))


def displacement(
    im: ArrayLike, u_max: ArrayLike, overturned: ArrayLike, cap_m: float | None = None
) -> DisplacementFragility:
    """Lognormal regression of u_max on intensity, overturned runs censored at the right (Tobin
    1958, Econometrica 26).

    In the form of Olsen (1978, Econometrica 46), c / sigma and 1 / sigma, the likelihood is
    concave.

    Parameters
    ----------
    im
        (n, k) or (n,) positive intensities.
    u_max
        (n,) [m] positive; ignored where the run overturned.
    overturned
        (n,) True where the column overturned.
    cap_m
        displacement that every overturned run exceeded [m], overturn.displacement_m of a study that
        has one; the largest peak of those that stood unless given.

    Raises
    ------
    DegenerateData
        too few runs that stood, or intensities that do not vary among them.
    ValueError
        lengths that differ, or a displacement that is not positive.
    """
    x, u, overturned = log_columns(im), censored(u_max, overturned), np.asarray(overturned, bool)
    if len(x) != u.size:
        raise ValueError(f"im of {len(x)} runs and u_max of {u.size}: must have one length")
    cap_m = largest_peak((u_max, overturned)) if cap_m is None else cap_m
    if (u <= 0).any() or cap_m <= 0:
        raise ValueError("displacements must be positive; a run that never moves has no logarithm")
    p, stood = x.shape[1], x[~overturned]
    if len(stood) < p + 1 or np.linalg.matrix_rank(stood) < p:
        raise DegenerateData(
            f"{len(stood)} of {u.size} runs stood, too few or too alike in intensity to "
            f"fit {p + 1} parameters"
        )
    y = np.log(np.where(overturned, cap_m, u))
    z = np.column_stack([x, -y])

    def likelihood(q: NDArray[Any]) -> tuple[float, NDArray[Any], NDArray[Any]]:
        gamma, beyond = q[-1], z @ q  # beyond = (c x - y) / sigma
        log_p, slope, weight = -0.5 * beyond**2 - 0.5 * np.log(2 * np.pi), -beyond, np.ones(y.size)
        tail = beyond[overturned]
        log_p[overturned] = log_ndtr(tail)
        slope[overturned] = hazard = np.exp(-0.5 * tail**2 - log_p[overturned]) / np.sqrt(2 * np.pi)
        weight[overturned] = hazard * (hazard + tail)
        gradient, information = z.T @ slope, z.T @ (weight[:, None] * z)
        gradient[-1] += len(stood) / gamma
        information[-1, -1] += len(stood) / gamma**2
        return float(log_p.sum() + len(stood) * np.log(gamma)), gradient, information

    start = np.linalg.lstsq(x, y, rcond=None)[0]
    scatter = np.std(y - x @ start)
    if not scatter > 1e-9:
        raise DegenerateData("displacements follow the intensities without scatter: sigma is 0")
    q, covariance, loglik = maximize(
        likelihood, np.append(start, 1.0) / scatter, inside=lambda q: bool(q[-1] > 0)
    )
    gamma = q[-1]
    to_shape = np.eye(p + 1) / gamma
    to_shape[:, -1] = -q / gamma**2
    to_shape[-1, -1] = -1 / gamma**2
    return DisplacementFragility(
        q[:-1] / gamma,
        float(1 / gamma),
        to_shape @ covariance @ to_shape.T,
        loglik,
        u.size,
        int(overturned.sum()),
        cap_m,
    )
