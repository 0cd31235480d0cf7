"""What the reduced engine knows of column and base: numbers of a mesh, independent of the time
step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fecolumn.contact.bodies import Bodies
from fecolumn.contact.overlap import Overlaps
from fecolumn.contact.pad import Springs, springs_of
from fecolumn.engines.reduced.found import Found
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.hht import HHT


class Structure(NamedTuple):
    """What moves and how it touches, for compiled code, filtered to the step.

    With F = 2 s - s^2, s = 1 / (1 + beta (1 + alpha) w^2 dt^2) of each mode (`fem.foot`), w = 0
    where a body has fewer modes than another: bodies: static part of the nodes, flexibility - sum
    F^2 phi phi / w^2, and mobility of the modes, sum F^2 phi phi; its pushes: (N, 3, m) F phi, by
    which contact forces drive modes and modes move the nodes. squares: (nb, m) w^2 [1/s2]; damping:
    (nb, m) [1/s] damping force on a mode over its rate, 2 zeta w. reach: (N,) [m/sqrt(J)] largest
    displacement of a node by modes that store the energy 1/2 J. interfaces: (ni,) of INTERFACE;
    rim: points on the circles of all of them; overlaps: joints of two sides; links: (nl,) of LINK,
    those of bonded joints last; ends: (nl, 2, 3, m) F phi at the ends of each; gravity: (3,)
    [m/s2]. found: contact that is found, whose interfaces and
    points come after those of the joints.
    """

    bodies: Bodies
    squares: Array
    damping: Array
    reach: Array
    interfaces: Array
    rim: Array
    overlaps: Overlaps
    links: Array
    ends: Array
    gravity: Array
    found: Found


class Scheme(NamedTuple):
    """HHT-alpha coefficients of one step size; `half` is dt^2 / 2 [s2], `shrink`: (nb, m) s of each
    mode, here with its damping, dynamic: (3 N, 3 n) [m/N] modal and static compliance of the nodes
    within a step; springs: of the points alone. rolls: whether the points of round rims may go
    along with the lowest one; else they stay, as those of a polygon.
    """

    dt: float
    half: float
    alpha: float
    beta: float
    gamma: float
    shrink: Array
    dynamic: Array
    springs: Springs
    rolls: bool = True


def scheme(structure: Structure, points: Array, hht: HHT) -> Scheme:
    """Coefficients of a step of `hht`; the filter of the contact stays that of the structure."""
    half, stiffness = hht.dt**2 / 2, structure.squares * hht.stiffness_factor / hht.mass_factor
    stiffness = (
        stiffness + structure.damping * hht.rate_factor * hht.stiffness_factor / hht.mass_factor
    )
    return _scheme(structure, points, hht.dt, half, hht.alpha, hht.beta, hht.gamma, stiffness)


def resting_scheme(structure: Structure, points: Array, pseudo_inertia: float) -> Scheme:
    """Coefficients of a proximal step towards equilibrium: (pseudo_inertia M + K) x =
    pseudo_inertia M x0 + F + U r.
    """
    return _scheme(
        structure,
        points,
        np.inf,
        1 / pseudo_inertia,
        0.0,
        0.25,
        0.5,
        structure.squares / pseudo_inertia,
    )


def _scheme(
    structure: Structure,
    points: Array,
    dt: float,
    half: float,
    alpha: float,
    beta: float,
    gamma: float,
    stiffness: Array,
) -> Scheme:
    shrink = 1 / (1 + stiffness)
    dynamic = structure.bodies.static.copy()
    for body, factors in zip(structure.bodies.body, shrink):
        nodes = slice(body["first"], body["first"] + body["count"])
        dynamic[3 * nodes.start : 3 * nodes.stop, : 3 * body["count"]] += half * modal_sum(
            structure.bodies.pushes[nodes], factors
        )
    return Scheme(
        dt,
        half,
        alpha,
        beta,
        gamma,
        shrink,
        dynamic,
        springs_of(points, structure.interfaces, dt),
    )


def modal_sum(shapes: Array, factors: Array) -> Array:
    """Sum of factor phi phi^T over the modes, (3 n, 3 n)."""
    flat = shapes.reshape(3 * len(shapes), -1)
    return (flat * factors) @ flat.T
