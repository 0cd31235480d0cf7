"""Friction problems of assemblies of rigid bodies, from the geometry and a seed alone: W = H M^-1
H^T, q = H v.

Of the kind of the Friction Contact Library (Acary, Bremond, Koziara and Perignon 2014): stacks,
walls, arches, heaps. Blocks touch at more corners than they have degrees of freedom, so W is only
semidefinite and the forces are not unique, while the velocities mostly are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from benchmarks.friction.problem import Problem

# Limestone [kg/m3]; gravity [m/s2] acts for a time step [s]
DENSITY, GRAVITY, STEP_S = 2700.0, 9.81, 5e-3
COEFFICIENTS = (0.0, 0.3, 0.6, 1.2)
LOADS = ("rest", "shake", "impact")
FLOOR = -1


@dataclass(slots=True)
class Assembly:
    """Rigid bodies and the points at which they touch.

    Attributes
    ----------
    name
        in tables. masses [kg], inertias (3, 3) [kg m2], centres (3,) [m]: of each body.
    contacts
        slave, master (FLOOR: the fixed one), place (3,) [m], frame (3, 3) with rows t1, t2, n, n
        from master to slave.
    """

    name: str
    masses: list = field(default_factory=list)
    inertias: list = field(default_factory=list)
    centres: list = field(default_factory=list)
    contacts: list = field(default_factory=list)

    def body(self, mass, inertia, centre) -> int:
        """Add a body; its number."""
        (
            self.masses.append(mass),
            self.inertias.append(np.asarray(inertia, float)),
            self.centres.append(np.asarray(centre, float)),
        )
        return len(self.masses) - 1

    def box(self, centre, size, turn=None) -> int:
        """Add a block of size (3,) [m] whose edges are the columns of `turn`; its number."""
        turn = np.eye(3) if turn is None else turn
        mass, squares = DENSITY * np.prod(size), np.square(size)
        return self.body(
            mass, turn @ np.diag(mass / 12 * (squares.sum() - squares)) @ turn.T, centre
        )

    def touch(self, slave, master, place, normal=(0.0, 0.0, 1.0)) -> None:
        """Add a contact."""
        n = np.asarray(normal, float) / np.linalg.norm(normal)
        first = np.eye(3)[np.abs(n).argmin()]
        t1 = first - n * (n @ first)
        t1 /= np.linalg.norm(t1)
        self.contacts.append(
            (slave, master, np.asarray(place, float), np.array([t1, np.cross(n, t1), n]))
        )

    def problem(self, load: str, mu: float, seed: int = 0) -> Problem:
        """The friction problem of one step: from rest, on a floor shaken at 0.45 g, or of bodies
        that fly at random into each other.
        """
        random, nb = np.random.default_rng(seed), len(self.masses)
        roots = [np.linalg.cholesky(np.linalg.inv(inertia)) for inertia in self.inertias]
        velocity = np.zeros((nb, 6))
        velocity[:, 2] = -STEP_S * GRAVITY
        if load == "shake":
            velocity[:, :2] = STEP_S * GRAVITY * np.array([0.4, 0.2])
        if load == "impact":
            velocity += random.standard_normal((nb, 6)) * [0.2, 0.2, 0.2, 1, 1, 1] - [
                0,
                0,
                0.5,
                0,
                0,
                0,
            ]
        half, q = np.zeros((3 * len(self.contacts), 6 * nb)), np.zeros((len(self.contacts), 3))
        for i, (slave, master, place, frame) in enumerate(self.contacts):
            for body, sign in ((slave, 1), (master, -1)):
                if body == FLOOR:
                    continue
                x, y, z = place - self.centres[body]
                spin = np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])
                q[i] += sign * frame @ (velocity[body, :3] + spin @ velocity[body, 3:])
                half[3 * i : 3 * i + 3, 6 * body : 6 * body + 3] = (
                    sign * frame / np.sqrt(self.masses[body])
                )
                half[3 * i : 3 * i + 3, 6 * body + 3 : 6 * body + 6] = (
                    sign * frame @ spin @ roots[body]
                )
        return Problem(f"{self.name}, {load}", half @ half.T, q, mu)


def boxes(name: str, spans) -> Assembly:
    """Blocks (lower corner, upper corner), which touch the floor and each other at the corners of
    their common rectangles.
    """
    assembly, spans = Assembly(name), [np.array(span, float) for span in spans]
    for low, high in spans:
        assembly.box((low + high) / 2, high - low)
    for i, upper in enumerate(spans):
        below = (
            [(FLOOR, upper)]
            if upper[0, 2] == 0
            else [(j, s) for j, s in enumerate(spans) if abs(s[1, 2] - upper[0, 2]) < 1e-9]
        )
        for j, lower in below:
            low, high = np.maximum(upper[0], lower[0]), np.minimum(upper[1], lower[1])
            if (high - low)[:2].min() > 1e-9:
                for x, y in (
                    (low[0], low[1]),
                    (high[0], low[1]),
                    (high[0], high[1]),
                    (low[0], high[1]),
                ):
                    assembly.touch(i, j, (x, y, upper[0, 2]))
    return assembly


def stack(count: int) -> Assembly:
    """Blocks on top of each other, each a little aside: 4 points a joint."""
    aside = [0.03 * np.array([np.cos(2.4 * k), np.sin(2.4 * k)]) for k in range(count)]
    return boxes(
        f"stack of {count}",
        [((*(a - 0.2), 0.3 * k), (*(a + 0.2), 0.3 * (k + 1))) for k, a in enumerate(aside)],
    )


def wall(courses: int, width: int) -> Assembly:
    """Bricks in running bond: every brick lies on two, 8 points."""
    spans = []
    for course in range(courses):
        starts = [0.4 * k + 0.2 * (course % 2) for k in range(width - course % 2)]
        spans += [((x, 0.0, 0.2 * course), (x + 0.4, 0.2, 0.2 * (course + 1))) for x in starts]
    return boxes(f"wall of {courses} courses", spans)


def arch(count: int, inner: float = 1.0, outer: float = 1.25, depth: float = 0.3) -> Assembly:
    """Semicircular arch of voussoirs between two fixed springings: 4 points a joint."""
    assembly = Assembly(f"arch of {count}")
    for k in range(count):
        angle = np.pi * (k + 0.5) / count
        radial, along = (
            np.array([np.cos(angle), 0, np.sin(angle)]),
            np.array([-np.sin(angle), 0, np.cos(angle)]),
        )
        size = (outer - inner, depth, (inner + outer) / 2 * np.pi / count)
        assembly.box(
            (inner + outer) / 2 * radial, size, np.column_stack([radial, [0, 1, 0], along])
        )
    for k in range(count + 1):
        angle = np.pi * k / count
        for radius in (inner, outer):
            for y in (-depth / 2, depth / 2):
                place = (radius * np.cos(angle), y, radius * np.sin(angle))
                assembly.touch(
                    k if k < count else FLOOR,
                    k - 1 if k else FLOOR,
                    place,
                    (-np.sin(angle), 0, np.cos(angle)),
                )
    return assembly


def heap(layers: int, radius: float = 0.05) -> Assembly:
    """Pyramid of spheres that touch, the lowest on the floor."""
    assembly, mass = Assembly(f"heap of {layers} layers"), DENSITY * 4 / 3 * np.pi * radius**3
    for layer in range(layers):
        for i in range(layers - layer):
            for j in range(layers - layer):
                centre = radius * np.array([2 * i + layer, 2 * j + layer, 1 + np.sqrt(2) * layer])
                assembly.body(mass, 0.4 * mass * radius**2 * np.eye(3), centre)
    for i, centre in enumerate(assembly.centres):
        if centre[2] < 1.01 * radius:
            assembly.touch(i, FLOOR, centre - [0, 0, radius])
        for j in range(i):
            apart = centre - assembly.centres[j]
            if np.linalg.norm(apart) < 2.01 * radius:
                assembly.touch(i, j, assembly.centres[j] + apart / 2, apart)
    return assembly


def drum(points: int, radius: float = 0.25, height: float = 1.6) -> Assembly:
    """A solid cylinder on points of its rim: W has rank 6 at most."""
    assembly, mass = Assembly(f"drum on {points}"), DENSITY * np.pi * radius**2 * height
    across = mass * (3 * radius**2 + height**2) / 12
    assembly.body(mass, np.diag([across, across, mass * radius**2 / 2]), (0, 0, height / 2))
    for angle in 2 * np.pi * np.arange(points) / points:
        assembly.touch(0, FLOOR, (radius * np.cos(angle), radius * np.sin(angle), 0))
    return assembly


def scatter(points: int, bodies: int, seed: int) -> Assembly:
    """Bodies of random mass, and contacts at random places with random normals between random pairs
    of them and the floor.
    """
    random, assembly = np.random.default_rng(seed), Assembly(f"{bodies} at random, seed {seed}")
    for _ in range(bodies):
        turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
        assembly.box(random.uniform(-1, 1, 3), random.uniform(0.1, 0.5, 3), turn)
    for k in range(points):
        slave = k % bodies
        master = (
            FLOOR if k < bodies else random.choice([j for j in range(-1, bodies) if j != slave])
        )
        place = assembly.centres[slave] + random.uniform(-0.3, 0.3, 3)
        assembly.touch(
            slave,
            int(master),
            place,
            random.standard_normal(3) + ([0, 0, 2] if master == FLOOR else [0, 0, 0]),
        )
    return assembly


def assemblies() -> Iterator[Assembly]:
    """Those of the benchmark: 1 to 108 points."""
    yield heap(1)
    yield scatter(2, 1, 1)
    yield scatter(3, 2, 2)
    yield from (stack(1), stack(3), stack(10), stack(25))
    yield from (wall(2, 2), wall(4, 4))
    yield from (arch(7), arch(20))
    yield from (heap(2), heap(3), heap(4))
    yield from (drum(8), drum(32), drum(96))
    yield from (scatter(8, 4, 3), scatter(20, 5, 4), scatter(60, 20, 5))


def problems() -> list[Problem]:
    """Every assembly under every load with every coefficient, always the same."""
    return [
        assembly.problem(load, mu, seed=k)
        for k, assembly in enumerate(assemblies())
        for load in LOADS
        for mu in COEFFICIENTS
    ]
