"""Bodies as contact sees them: how far their surface nodes move under forces, whatever else they
are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fecolumn.contact.record import record
from fecolumn.foundation.arrays import Array

#: A body: mass [kg], inertia about its centre of mass [kg m2] and their inverses, which are zero
#: where the mobility of rigid motion is part of the nodal one; first, count: its rows among the
#: surface nodes of all bodies. held: number of the ground that a fixed body moves with, which has
#: neither mass nor mobility, -1 of a body that is free; airborne: whether nothing carries it at the
#: start, so that it is left out of the search for rest; stiff: whether it does not deform, gives:
#: what each contact point on it then gives alone [m/N].
BODY = record(
    ("mass", "f8"),
    ("inverse_mass", "f8"),
    ("inertia", "f8", (3, 3)),
    ("inverse_inertia", "f8", (3, 3)),
    ("first", "i8"),
    ("count", "i8"),
    ("held", "i8"),
    ("airborne", "?"),
    ("stiff", "?"),
    ("gives", "f8"),
)


#: A triangle of a body's surface on which others stand: nodes (3,), rows of all bodies; neighbours
#: (3,): across the side opposite to each, -1 at an outline, GOES_ON where the body's face goes on
#: without nodes that are known; corners: (3, 2) [m] in the frame of the surface.
GOES_ON = -2
FACET = record(("nodes", "i8", 3), ("neighbours", "i8", 3), ("corners", "f8", (3, 2)))


class Bodies(NamedTuple):
    """Bodies that move, and their surface nodes, N in all, n at most on one body.

    body: (nb,) of BODY. arms: (N, 3) [m] of the nodes from the body's centre of mass, in its frame.
    static: (3 N, 3 n) [m/N] displacement that follows forces at once. mobility: (3 N, 3 n) [1/kg]
    velocity per impulse beside that of rigid motion. Both have rows by node and columns by node of
    the same body, in its frame. facets: of FACET, of the surfaces on which others stand. pushes:
    (N, 3, m) [1/sqrt(kg)] shapes of m modes a body at its nodes, scaled so that pushes pushes^T is
    the mobility; (0, 3, 0) where the mobility is not of modes. mobility_factor: (N, 3, r), in as
    few columns a body as give the same product.
    """

    body: Array
    arms: Array
    static: Array
    mobility: Array
    facets: Array = np.zeros(0, FACET)
    pushes: Array = np.zeros((0, 3, 0))
    mobility_factor: Array = np.zeros((0, 3, 0))


def one_body(
    arms: Array, static: Array, mobility: Array, mass: float = np.inf, inertia: Array | None = None
) -> Bodies:
    """A single body; without mass and inertia (3, 3) its mobility holds its rigid motion."""
    body = np.zeros(1, BODY)
    body["mass"], body["count"], body["held"] = mass, len(arms), -1
    if inertia is not None:
        body["inverse_mass"], body["inertia"], body["inverse_inertia"] = (
            1 / mass,
            inertia,
            np.linalg.inv(inertia),
        )
    return Bodies(body, *(np.ascontiguousarray(array, float) for array in (arms, static, mobility)))


def joined(parts: list[Bodies]) -> Bodies:
    """Several bodies as one set, their nodes one after another."""
    width = max(part.static.shape[1] for part in parts)
    body, first = np.concatenate([part.body for part in parts]), 0
    for row, part in zip(body, parts):
        row["first"], first = first, first + len(part.arms)

    def wide(array: Array) -> Array:
        return np.pad(array, ((0, 0), (0, width - array.shape[1])))

    return Bodies(
        body,
        np.concatenate([part.arms for part in parts]),
        *(
            np.ascontiguousarray(np.concatenate([wide(getattr(part, name)) for part in parts]))
            for name in ("static", "mobility")
        ),
    )


def node_matrix(blocks: Array) -> Array:
    """Node blocks (n, n, 3, 3) as a matrix (3 n, 3 n)."""
    n = len(blocks)
    return np.ascontiguousarray(blocks.transpose(0, 2, 1, 3)).reshape(3 * n, 3 * n)


def fewest_columns(shapes: Array, share: float) -> Array:
    """Columns (n, 3, r) whose products with one another are those of the shapes (n, 3, m), up to a
    share of the largest: what many modes do to a few nodes beside each other is done by few.
    """
    if not shapes.any():
        return shapes[..., :0]
    whole = shapes.reshape(3 * len(shapes), shapes.shape[2])
    left, sizes, _ = np.linalg.svd(whole, full_matrices=False)
    taken = sizes**2 > share * sizes[0] ** 2
    found: Array = (left * sizes)[:, taken].reshape(*shapes.shape[:2], -1)
    return found if found.shape[2] < shapes.shape[2] else shapes
