"""Densities of elements with which a mesh has a mass, a centre and an inertia that are told."""

from __future__ import annotations

import numpy as np

from fecolumn.mesh.bricks import BrickMesh
from fecolumn.mesh.mass import element_moments

# Steps of Newton's method, and of halving one of them; relative error of the moments at its end
_STEPS, _HALVINGS, _ERROR = 200, 60, 1e-12
# Rounding of the value that they make least, over it: a sum of elements' shares of 1
_ROUNDING = 1e-14
# Largest exponent of a density over the mean: e^12 is no matter any more
_STEEPEST = 12.0


class NoSuchDensity(ValueError):
    """No body within the outline has the mass, centre and inertia; the message says why."""


def relative_densities(
    mesh: BrickMesh, mass: float, centre: np.ndarray, inertia: np.ndarray | None
) -> np.ndarray:
    """Density of each element (n_cells,) over that of the material.

    Of all densities with these moments the one that is nearest to an even one: it maximises the
    entropy, and is exp(p(x)) with a polynomial p of second degree, of first degree without
    `inertia`. There is one wherever any positive density has these moments.

    Parameters
    ----------
    mass
        over the material's density [m3].
    centre
        (3,) [m].
    inertia
        (3, 3) about the centre of mass, over the material's density [m5]; None leaves it free.

    Raises
    ------
    NoSuchDensity
        none has.
    """
    volumes, first, second = element_moments(mesh)
    origin = first.sum(axis=0) / volumes.sum()
    size = float(np.sqrt(np.trace(second.sum(axis=0)) / volumes.sum() - origin @ origin))
    middle = first / volumes[:, None]
    arms = (middle - origin) / size
    terms, wanted = [np.ones(len(volumes)), *arms.T], [1.0, *((centre - origin) / size)]
    if inertia is not None:
        about = np.trace(inertia) / 2 * np.eye(3) - inertia
        if np.linalg.eigvalsh(about)[0] <= 0:
            raise NoSuchDensity(
                "no body has this inertia: each of its principal values must be less than the sum "
                "of the other two"
            )
        spread = second / volumes[:, None, None] - middle[:, :, None] * middle[:, None, :]
        product = arms[:, :, None] * arms[:, None, :] + spread / size**2
        reach = (centre - origin) / size
        moment = about / (mass * size**2) + np.outer(reach, reach)
        pairs = np.triu_indices(3)
        terms += list(product[:, pairs[0], pairs[1]].T)
        wanted += list(moment[pairs])
    found = _of_largest_entropy(np.array(terms), np.array(wanted), volumes / volumes.sum())
    return found * (mass / volumes.sum())


def _of_largest_entropy(terms: np.ndarray, wanted: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """exp(factors @ terms) (n,) with the sums `wanted` (k,) of shares times terms (k, n) times it.

    The factors minimise sum(shares exp(factors terms)) - factors wanted, which is convex.
    """
    factors = np.zeros(len(terms))

    def value(trial: np.ndarray) -> float:
        power = trial @ terms
        return np.inf if power.max() > 50 else shares @ np.exp(power) - trial @ wanted

    for _ in range(_STEPS):
        weights = shares * np.exp(factors @ terms)
        slope = terms @ weights - wanted
        if np.abs(slope).max() < _ERROR:
            break
        step = -np.linalg.lstsq((terms * weights) @ terms.T, slope, rcond=None)[0]
        # near its end a step gains less than the value is rounded by: it is Newton's then
        length, before = 1.0, value(factors)
        allowed = before + _ROUNDING * (1 + abs(before))
        for _ in range(_HALVINGS):
            if value(factors + length * step) <= allowed + 1e-4 * length * (slope @ step):
                break
            length /= 2
        factors = factors + length * step
    density = np.exp(factors @ terms)
    left = np.abs(terms @ (shares * density) - wanted).max()
    if not left < 1e3 * _ERROR or density.max() > np.exp(_STEEPEST):
        raise NoSuchDensity(
            "no matter within its outline has this centre and inertia: they lie too far out, or "
            "are of a body that is hollow, or full, beyond what the elements can be; smaller "
            "elements (element_size_m, mesh_size_m) can be more"
        )
    return density
