"""Bodies that answer as one: whatever is asked of a body is asked of each, rows of one below those
of the other.

Copies of a body are the same `fem.body.Body` object. What is made of it, a factor, the filter of
its surface, is made once for all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from fecolumn.fem.damping import ModalDamping
from fecolumn.fem.effective import effective_factor
from fecolumn.fem.foot import FilteredFoot, PlainFoot, Response
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.fem.body import Body


class Composite:
    """Bodies, each in its place.

    Owned arrays (n_owned, 3) hold the owned nodes of this rank, body by body.

    Parameters
    ----------
    parts
        of Body, copies the same object.
    centers
        (nb, 3) [m] their centres of mass, rotations: (nb, 3, 3) their turns, in the table frame,
        unstrained.
    """

    def __init__(
        self, parts: list, centers: Sequence[Array] | Array, rotations: Sequence[Array] | Array
    ) -> None:
        self.parts, self.comm = list(parts), parts[0].comm
        self.rows = slices([part.n_owned for part in parts])
        self.n_owned, self.n_nodes = (
            sum(getattr(part, name) for part in parts) for name in ("n_owned", "n_nodes")
        )
        self.X, self.arms, self.mass_arms = (
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("X", "arms", "mass_arms")
        )
        self.unturned = np.tile(np.eye(3), (len(parts), 1, 1))
        #: As they are placed (nb, 3, 3).
        self.rotations = np.array(rotations, float)
        #: Unstrained positions (n_owned, 3) in the table frame [m].
        self.placed = self.places(centers, rotations)
        places = np.concatenate(
            [
                center + (part.all_X - part.center) @ R.T
                for part, center, R in zip(parts, centers, rotations)
            ]
        )
        #: Largest extent along an axis [m].
        self.extent = np.ptp(places, axis=0).max()
        self.stiffness_scale, self.mass_scale = (
            max(getattr(part, name) for part in parts) for name in ("stiffness_scale", "mass_scale")
        )
        self.unit_loads = np.concatenate([part.unit_loads for part in parts], axis=1)
        self.node_mass = np.concatenate([part.node_mass for part in parts])
        self.total_mass = sum(part.total_mass for part in parts)
        self.sum, self.max, self.dot = parts[0].sum, parts[0].max, parts[0].dot

    def places(self, centers: Sequence[Array] | Array, rotations: Sequence[Array] | Array) -> Array:
        """Positions (n_owned, 3) [m] of the nodes of unstrained bodies, with centres of mass
        (nb, 3) [m] and rotations (nb, 3, 3).

        A body that is where it is drawn has the drawn positions to the last digit.
        """
        drawn = [
            np.array_equal(center, part.center) and np.array_equal(R, np.eye(3))
            for part, center, R in zip(self.parts, centers, rotations)
        ]
        return np.concatenate(
            [
                part.X if is_drawn else center + (part.X - part.center) @ R.T
                for part, center, R, is_drawn in zip(self.parts, centers, rotations, drawn)
            ]
        )

    def momentum(self, values: Array) -> Array:
        """Product of each body's mass with its rows of an owned array (n_owned, 3)."""
        return np.concatenate(
            [part.momentum(values[rows]) for part, rows in zip(self.parts, self.rows)]
        )

    def centers(self, x: Array) -> Array:
        """Centres of mass (nb, 3) of positions x (n_owned, 3) [m]."""
        return self.sum(
            np.stack([part.node_mass @ x[rows] for part, rows in zip(self.parts, self.rows)])
        ) / np.array([[part.total_mass] for part in self.parts])

    def of_each(self, make: Callable[..., Any]) -> list:
        """What `make` gives of each body (and its first rows), made once for all copies."""
        made = {}
        for part, rows in zip(self.parts, self.rows):
            if part not in made:
                made[part] = make(part, rows)
        return [made[part] for part in self.parts]


def slices(counts: list[int]) -> list[slice]:
    """Rows of bodies with so many rows each."""
    ends = np.cumsum([0, *counts]).tolist()
    return [slice(first, last) for first, last in zip(ends, ends[1:])]


def copies_of(each: list) -> Iterator[Any]:
    """Each different one and the places where it is."""
    for one in dict.fromkeys(each):
        yield one, [place for place, other in enumerate(each) if other is one]


def of_copies(each: list, rows: list, values: Array, name: str) -> Array:
    """What the methods `name` of `each` give of rows of values (n, 3), one below the other; copies
    are asked at once, so that what is large is read once.
    """
    found: dict = {}
    for one, mine in copies_of(each):
        given = (
            values[rows[mine[0]]]
            if len(mine) == 1
            else np.stack([values[rows[place]] for place in mine])
        )
        found |= zip(mine, getattr(one, name)(given).reshape(len(mine), -1, 3))
    return np.concatenate([found[place] for place in range(len(each))])


class CompositeKinematics:
    """Kinematics of each body by itself.

    Parameters
    ----------
    make
        function of a Body that returns its kinematics, Corotated or TotalLagrangian.
    """

    def __init__(self, bodies: Composite, make: Any) -> None:
        self._rows, self.each = bodies.rows, bodies.of_each(lambda part, _: make(part))
        #: As of each.
        self.name, self.has_tangent = self.each[0].name, self.each[0].has_tangent

    def _rowwise(self, name: str, *arrays: Array) -> Array:
        return np.concatenate(
            [
                getattr(one, name)(*(array[rows] for array in arrays))
                for one, rows in zip(self.each, self._rows)
            ]
        )

    def rotation(self, x: Array) -> Array:
        """(nb, 3, 3)."""
        return np.stack([one.rotation(x[rows]) for one, rows in zip(self.each, self._rows)])

    def internal(self, x: Array) -> tuple[Array, Array, float]:
        """Rotations (nb, 3, 3), internal forces (n_owned, 3) [N] and strain energy [J] at positions
        x.
        """
        found: dict = {}
        for one, mine in copies_of(self.each):
            found |= zip(mine, one.internal_of_copies([x[self._rows[place]] for place in mine]))
        rotations, forces, strains = zip(*(found[place] for place in range(len(self.each))))
        return np.stack(rotations), np.concatenate(forces), sum(strains)

    def tangents(self, x: Array) -> list:
        """Tangent stiffness of each body at positions x (n_owned, 3), in the table frame."""
        return [one.tangent(x[rows]) for one, rows in zip(self.each, self._rows)]

    def moved(self, x: Array, step: Array) -> Array:
        """Positions (n_owned, 3) [m] after an increment of an iteration."""
        return self._rowwise("moved", x, step)

    def predicted(self, x: Array, step: Array) -> Array:
        """First guess of positions (n_owned, 3) [m] after a time step's increment."""
        return self._rowwise("predicted", x, step)

    def local_displacement(self, x: Array) -> Array:
        """Displacement (n_owned, 3) [m] of each node in the frame of its own body."""
        return self._rowwise("local_displacement", x)


class CompositeFactor:
    """Factors of each body's effective matrix, the same object for copies."""

    def __init__(self, bodies: Composite, each: list) -> None:
        self.bodies, self.each = bodies, each

    @classmethod
    def of(
        cls,
        bodies: Composite,
        mass_factor: float,
        stiffness_factor: float,
        tangents: list[Any] | None = None,
    ) -> CompositeFactor:
        """Factors of mass_factor M + stiffness_factor K, with the reference stiffness of each body
        or with its own one of `tangents`.
        """
        if tangents is None:
            return cls(
                bodies,
                bodies.of_each(
                    lambda part, _: effective_factor(part, mass_factor, stiffness_factor)
                ),
            )
        return cls(
            bodies,
            [
                effective_factor(part, mass_factor, stiffness_factor, tangent)
                for part, tangent in zip(bodies.parts, tangents)
            ],
        )

    def solve(self, forces: Array) -> Array:
        """Displacements (n_owned, 3), rows in the frames of their bodies."""
        return of_copies(self.each, self.bodies.rows, forces, "solve")

    def destroy(self) -> None:
        """Free the factors, each once."""
        for factor in dict.fromkeys(self.each):
            factor.destroy()


class CompositeFoot:
    """Surface nodes of all bodies: `fem.foot` of each, found once for all copies.

    `static` and `mobility` are lists of each body's: nothing is ever made of the size of all
    together.

    Parameters
    ----------
    nodes
        of each body, node numbers (n,) of its surfaces; those of the first serve all copies.
    factor
        CompositeFactor of mass_factor M + stiffness_factor K, by which the filter is found.
    filtered
        FilteredFoot of each, as the plastic impact law needs it, or PlainFoot.
    """

    def __init__(
        self,
        bodies: Composite,
        nodes: list,
        factor: CompositeFactor,
        mass_factor: float,
        stiffness_factor: float,
        filtered: bool,
    ) -> None:
        self.bodies, self.nodes = bodies, nodes
        known, factors = (
            dict(zip(reversed(bodies.parts), reversed(each))) for each in (nodes, factor.each)
        )

        def make(part: Body, _: slice) -> FilteredFoot | PlainFoot:
            return (
                FilteredFoot(part, known[part], factors[part], mass_factor, stiffness_factor)
                if filtered
                else PlainFoot(part, known[part])
            )

        self.each = bodies.of_each(make)
        self.rows, self.filtered = slices([len(one) for one in nodes]), self.each[0].filtered
        self.static = [one.static for one in self.each]
        self.mobility = [one.mobility for one in self.each] if self.filtered else None

    def position(self, displacement: Array) -> Array:
        """As of each body's, rows in the frames of their bodies."""
        return of_copies(self.each, self.bodies.rows, displacement, "position")

    def load(self, forces: Array) -> Array:
        """Nodal forces (n_owned, 3) [N] of forces on the surface nodes."""
        return of_copies(self.each, self.rows, forces, "load")

    def acceleration(self, forces: Array) -> Array:
        """Accelerations (n_owned, 3) [m/s2] of all nodes by forces [N] on the surface nodes."""
        return of_copies(self.each, self.rows, forces, "acceleration")


class CompositeResponse:
    """`fem.foot.Response` of each body."""

    def __init__(self, foot: CompositeFoot, factor: CompositeFactor) -> None:
        made, pairs = {}, list(zip(foot.each, factor.each))
        for pair in pairs:
            if pair not in made:
                made[pair] = Response(*pair)
        self._rows, self.each = foot.rows, [made[pair] for pair in pairs]
        self.compliance = [one.compliance for one in self.each]

    def displacement(self, forces: Array) -> Array:
        """Displacements (n_owned, 3) [m] of all nodes by forces [N] on the surface nodes."""
        return of_copies(self.each, self._rows, forces, "displacement")


class CompositeDamping:
    """Modal damping of each body, with a ratio of its own.

    Parameters
    ----------
    counts
        of each body, modes that are damped, the lowest.
    ratios
        of each body, a number or one of each mode; copies the same.
    """

    def __init__(self, bodies: Composite, counts: list[int], ratios: list[float]) -> None:
        known = dict(zip(bodies.parts, zip(counts, ratios)))
        self._rows, self.each = (
            bodies.rows,
            bodies.of_each(lambda part, _: ModalDamping(part, *known[part])),
        )

    def _rowwise(self, name: str, velocity: Array, rotation: Array) -> Array:
        return np.concatenate(
            [
                getattr(one, name)(velocity[rows], R)
                for one, rows, R in zip(self.each, self._rows, rotation)
            ]
        )

    def force(self, velocity: Array, rotation: Array) -> Array:
        """Damping forces (n_owned, 3) [N] at velocities (n_owned, 3) [m/s]."""
        return self._rowwise("force", velocity, rotation)

    def acceleration(self, velocity: Array, rotation: Array) -> Array:
        """M^-1 of `force`, (n_owned, 3) [m/s2]."""
        return self._rowwise("acceleration", velocity, rotation)

    def damped(self, factor: CompositeFactor, *factors: float) -> CompositeFactor:
        """Factor of the damped effective matrix of each body; see `fem.damping`."""
        made = {}
        for damping, own in zip(self.each, factor.each):
            if own not in made:
                made[own] = damping.damped(own, *factors)
        return CompositeFactor(factor.bodies, [made[own] for own in factor.each])
