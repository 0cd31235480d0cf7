"""Rigid polygons in the plane x (right), z (up), and which face of one may touch which face of
another.

SI units, of a slice of 1 m of depth unless a body says otherwise; angles in rad, counterclockwise.
A place is (x, z, angle) of the centre of mass.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

GRAVITY = 9.80665  # [m/s2]
#: Faces of a rectangle or trapezoid of `quadrilateral`
BOTTOM, RIGHT, TOP, LEFT = range(4)


@dataclass(frozen=True)
class Body:
    """A convex polygon where it stands at the start.

    Attributes
    ----------
    name
        of it.
    outline
        (n, 2) corners [m], counterclockwise; face k runs from corner k to corner k + 1.
    density
        [kg/m3].
    depth
        [m].
    fixed
        whether it is part of the ground.
    """

    name: str
    outline: np.ndarray
    density: float = 2500.0
    depth: float = 1.0
    fixed: bool = False

    def mass_properties(self) -> tuple[float, np.ndarray, float]:
        """Mass [kg], centre of mass (2,) [m], moment of inertia about it [kg m2]: sums over the
        triangles between the origin and each face.
        """
        a, b = self.outline, np.roll(self.outline, -1, axis=0)
        twice = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        area = twice.sum() / 2
        if area <= 0:
            raise ValueError(
                f"{self.name}: corners must run counterclockwise; the area they enclose "
                f"is {area:.3g} m2"
            )
        centre = ((a + b) * twice[:, None]).sum(axis=0) / (6 * area)
        polar = ((a * a + a * b + b * b).sum(axis=1) * twice).sum() / 12 - area * (centre @ centre)
        mass_of_area = self.density * self.depth
        return mass_of_area * area, centre, mass_of_area * polar


@dataclass(frozen=True)
class Joint:
    """Face `face` of body `body` that may touch face `other_face` of body `other`, numbers of both;
    friction: coefficient of it.
    """

    body: int
    face: int
    other: int
    other_face: int
    friction: float


@dataclass(frozen=True)
class Structure:
    """Bodies and joints; arrays for the step are made of them.

    Attributes
    ----------
    mass, inertia
        (nb,) [kg], [kg m2], infinite where fixed.
    place
        (nb, 3) at the start.
    pairs
        (nc, 2) of each corner that may touch a face: number of the corner's body, of the face's
        body.
    shape
        (nc, 7) corner; start, direction and length of the face, in the frames of their bodies [m]
    friction
        (nc,).
    """

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    mass: np.ndarray = field(init=False)
    inertia: np.ndarray = field(init=False)
    place: np.ndarray = field(init=False)
    pairs: np.ndarray = field(init=False)
    shape: np.ndarray = field(init=False)
    friction: np.ndarray = field(init=False)

    def __post_init__(self):
        found = [body.mass_properties() for body in self.bodies]

        def put(name, values, kind=float):
            object.__setattr__(self, name, np.array(values, kind))

        put(
            "mass",
            [np.inf if body.fixed else mass for body, (mass, _, _) in zip(self.bodies, found)],
        )
        put(
            "inertia",
            [
                np.inf if body.fixed else inertia
                for body, (_, _, inertia) in zip(self.bodies, found)
            ],
        )
        put("place", [(*centre, 0.0) for _, centre, _ in found])
        pairs, shape, friction = [], [], []
        for joint in self.joints:
            one, two = (joint.body, joint.face), (joint.other, joint.other_face)
            for (b, corner_face), (f, face) in ((one, two), (two, one)):
                start, end = self.ends(f, face)
                length = float(np.linalg.norm(end - start))
                for corner in self.ends(b, corner_face):
                    pairs.append((b, f))
                    shape.append((*corner, *start, *(end - start) / length, length))
                    friction.append(joint.friction)
        put("pairs", pairs, int)
        put("shape", shape)
        put("friction", friction)

    def ends(self, body: int, face: int) -> tuple[np.ndarray, np.ndarray]:
        """First and second corner (2,) of a face from the body's centre of mass [m]."""
        outline = self.bodies[body].outline - self.place[body, :2]
        return outline[face], outline[(face + 1) % len(outline)]

    def number(self, name: str) -> int:
        """Number of the body of that name."""
        return [body.name for body in self.bodies].index(name)

    def point(self, body: int, local, place: np.ndarray) -> np.ndarray:
        """Where a point of a body, `local` (2,) [m] from its centre of mass, is at places (..., nb,
        3): (..., 2) [m].
        """
        x, z, angle = np.moveaxis(place[..., body, :], -1, 0)
        c, s = np.cos(angle), np.sin(angle)
        return np.stack([x + c * local[0] - s * local[1], z + s * local[0] + c * local[1]], axis=-1)

    def turned(self, place: np.ndarray, body: int, about, angle: float) -> np.ndarray:
        """Places (nb, 3) with one body turned by `angle` [rad] about a point (2,) [m] of
        the plane.
        """
        out, arm = place.copy(), place[body, :2] - about
        c, s = np.cos(angle), np.sin(angle)
        out[body] = (
            about[0] + c * arm[0] - s * arm[1],
            about[1] + s * arm[0] + c * arm[1],
            place[body, 2] + angle,
        )
        return out


def quadrilateral(bottom: float, top: float, height: float, at=(0.0, 0.0)) -> np.ndarray:
    """Outline (4, 2) [m] of a rectangle or a trapezoid of two widths; at: middle of its foot."""
    x, z = at
    return np.array(
        [
            (x - bottom / 2, z),
            (x + bottom / 2, z),
            (x + top / 2, z + height),
            (x - top / 2, z + height),
        ]
    )
