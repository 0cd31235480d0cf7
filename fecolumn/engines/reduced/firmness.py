"""Inertia of the iteration to gravity equilibrium, body by body."""

from __future__ import annotations

import numpy as np

from fecolumn.contact.tolerances import LINKS_FIRM
from fecolumn.engines.dynamics.gravity import pseudo_inertia
from fecolumn.engines.dynamics.links_of_model import fastest_of_each
from fecolumn.engines.reduced.model import Structure
from fecolumn.foundation.arrays import Array

# Times that the inertia of iterations is found anew from what modes give in one of that inertia
_PASSES = 5


def firmness_of(structure: Structure, centers: Array) -> Array:
    """Inertia factors (nb,) [1/s2] of the proximal steps of bodies with centres of mass `centers`
    (nb, 3) [m]: each is as firm as it has to be by itself.

    With the largest for all, a heavy body on a light one would hardly move in a step: by the ratio
    of their masses less than its support asks for.
    """
    bodies = structure.bodies.body
    free = bodies["held"] < 0
    weight = bodies["mass"].sum() * np.linalg.norm(structure.gravity)
    # of a dome the place of contact moves by its radius times the tilt, as far as the centre of
    # mass at that height would
    levers = [
        max(
            np.abs(structure.bodies.arms[body["first"] : body["first"] + body["count"], 2]).max(),
            structure.interfaces["ball"][structure.interfaces["slave"] == b].max(initial=0.0),
        )
        for b, body in enumerate(bodies)
    ]
    found = np.array(
        [
            pseudo_inertia(weight, lever, body["inertia"]) if own else 0.0
            for body, lever, own in zip(bodies, levers, free)
        ]
    )
    # those that a ground holds do not move
    found[~free] = found.max()
    # links answer the motion of a step at once: the motion must not answer them as strongly
    held = [
        (body["mass"], body["inertia"], center, np.eye(3)) for body, center in zip(bodies, centers)
    ]
    for _ in range(_PASSES if len(structure.links) else 0):
        # modes give the less in an iteration the less firm it is
        shrinks = list(found[:, None] / (found[:, None] + structure.squares))
        swings = fastest_of_each(structure, structure.links["stiffness"], held, shrinks)
        found = np.maximum(found, LINKS_FIRM * swings)
    return found


def with_masses(structure: Structure, shares: Array) -> Structure:
    """The structure with `shares` (nb,) of its bodies' masses and of their densities: as heavy and
    as stiff as it is, for the search for rest (Underwood 1983, fictitious masses).

    Coordinates of its modes, of unit modal mass, are those of the structure times the root of the
    share.
    """
    if (shares == 1.0).all():
        return structure
    roots = np.sqrt(shares)
    body = structure.bodies.body.copy()
    body["inverse_mass"] /= shares
    body["inertia"] *= shares[:, None, None]
    body["inverse_inertia"] /= shares[:, None, None]
    of_nodes = np.repeat(roots, body["count"])
    ends = structure.ends.copy()
    for n, link in enumerate(structure.links):
        for side, b in enumerate((link["a"], link["b"])):
            if b >= 0:
                ends[n, side] /= roots[b]
    bodies = structure.bodies._replace(
        body=body,
        mobility=structure.bodies.mobility / np.repeat(of_nodes, 3)[:, None] ** 2,
        pushes=structure.bodies.pushes / of_nodes[:, None, None],
        mobility_factor=structure.bodies.mobility_factor / of_nodes[:, None, None],
    )
    return structure._replace(bodies=bodies, squares=structure.squares / shares[:, None], ends=ends)
