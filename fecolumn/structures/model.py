"""What an engine needs of a structure: bodies reduced to their contact surfaces, how they stand on
one another, what links them.

Plain numbers in SI units, independent of the time step. Copies of a body share one `BodyModel`
object.

Frames: the table frame, z up, in which the ground rests; the frame of a body, axes parallel to the
table's in the drawing the body was made from, arms measured from its centre of mass.
`Part.rotation` turns the one into the other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
from numpy.typing import NDArray

from fecolumn.contact.pad import Pad
from fecolumn.contact.points import GROUND
from fecolumn.fem.whole_groups import with_group

if TYPE_CHECKING:
    from fecolumn.contact.base_plate import BasePlate
    from fecolumn.contact.known_base import KnownBase
    from fecolumn.contact.unbounded_base import UnboundedBase


@dataclass(frozen=True)
class Surface:
    """One plane face of a body where it may touch another, in the body's frame.

    nodes: (k,) rows among the model's nodes. origin: (3,) [m] a point of the plane, from the centre
    of mass. axes: (3, 3) columns: two tangents and the normal out of the body, right-handed. areas:
    (k,) [m2] tributary to the nodes. outlines: (k,) mask of the nodes on the outlines of the face.
    triangles: (t, 3) places in `nodes`: the face in triangles, holes left out, counter-clockwise
    seen from outside; how a master finds what lies on it. (0, 3) where the surface is never a
    master. region: (r, 3, 2) [m] corners of the triangles that make up the whole face, along the
    tangents from the origin; (0, 3, 2) where it is not known.
    """

    nodes: NDArray[Any]
    origin: NDArray[Any]
    axes: NDArray[Any]
    areas: NDArray[Any]
    outlines: NDArray[Any]
    triangles: NDArray[Any]
    region: NDArray[Any] = field(default_factory=lambda: np.zeros((0, 3, 2)))

    @property
    def normal(self) -> NDArray[Any]:
        """Unit normal (3,) out of the body."""
        normal: NDArray[Any] = self.axes[:, 2]
        return normal

    def plane(self, arms: NDArray[Any]) -> NDArray[Any]:
        """Coordinates (..., 3) [m] along tangents and normal of points with arms (..., 3) [m] in
        the body's frame.
        """
        places: NDArray[Any] = (arms - self.origin) @ self.axes
        return places


@dataclass(frozen=True)
class StoreyDrifts:
    """What the modes of a building say of its storeys, from below, along x and y of the body.

    drifts: (n, 2, m) [1/sqrt(kg)] displacement of each floor relative to the one below it, without
    what the slab's tilt adds. stiffness: (n, 2) [N/m]: a storey's shear is its stiffness times its
    drift.
    """

    drifts: NDArray[Any]
    stiffness: NDArray[Any]


@dataclass(frozen=True)
class BodyModel:
    """A body reduced to the nodes of all its surfaces, in its own frame, arms measured from the
    centre of mass.

    mass [kg]; inertia: (3, 3) [kg m2] about the centre of mass; center: (3,) [m] of mass in the
    drawing of the body. frequencies: (m,) [rad/s], rising, of the free-free elastic modes with unit
    modal mass; shapes: (n, 3, m) [1/sqrt(kg)] at the nodes. flexibility: (n, n, 3, 3) [m/N] of the
    nodes by all elastic modes, the exact static one of the free body; zero of a body that does not
    deform. arms: (n, 3) [m] of the nodes. dofs: of the mesh it was made from, 0 where there was
    none. surfaces: by name, such as "foot" and "head". marks: points observed, by name: arm (3,)
    [m] and shape (3, m) [1/sqrt(kg)]; "top" is the mean over the highest face, "floor 1" ... and
    "storey 1" ... those of a
        building.
    damping: (m,) ratios of the modes where the body brings its own, as `storeys` with Rayleigh
    damping do; None where `Part.damping_ratio` says all. storeys: of a building, None of any other
    body.
    """

    mass: float
    inertia: NDArray[Any]
    center: NDArray[Any]
    frequencies: NDArray[Any]
    shapes: NDArray[Any]
    flexibility: NDArray[Any]
    arms: NDArray[Any]
    dofs: int
    surfaces: dict[str, Surface]
    marks: dict[str, tuple[NDArray[Any], NDArray[Any]]]
    damping: NDArray[Any] | None = None
    storeys: StoreyDrifts | None = None

    @property
    def reference(self) -> NDArray[Any]:
        """Positions (n, 3) [m] of the nodes in the drawing of the body."""
        positions: NDArray[Any] = self.arms + self.center
        return positions

    def with_modes(self, count: int) -> BodyModel:
        """The body with its `count` lowest elastic modes, or all it has, and those of the same
        frequency as the last; the others stay in the flexibility.
        """
        count = with_group(self.frequencies, count)
        return replace(
            self,
            frequencies=self.frequencies[:count],
            shapes=np.ascontiguousarray(self.shapes[:, :, :count]),
            marks={
                name: (arm, np.ascontiguousarray(shape[:, :count]))
                for name, (arm, shape) in self.marks.items()
            },
            damping=None if self.damping is None else self.damping[:count],
            storeys=self.storeys
            and replace(
                self.storeys, drifts=np.ascontiguousarray(self.storeys.drifts[:, :, :count])
            ),
        )

    def undeformed(self) -> BodyModel:
        """The body without modes and without any give."""
        return replace(self.with_modes(0), flexibility=np.zeros_like(self.flexibility))


@dataclass(frozen=True)
class Part:
    """A body in its place at the start.

    name: such as "slab", or "column 2" of copies. model: the same object for all copies. center:
    (3,) [m] place of the centre of mass in the table frame; rotation: (3, 3) of the body's frame
    into the table's. damping_ratio: (m,) or one number, of the elastic modes kept; rigid motion is
    never damped. velocity: (3,) [m/s] of the centre of mass relative to the ground; spin: (3,)
    [rad/s] in the table frame. held: place of the ground that a fixed body moves with, -1 of a body
    that is free. airborne: whether no joint that is closed at the start, and no link, holds it up.
    """

    name: str
    model: BodyModel
    center: NDArray[Any]
    rotation: NDArray[Any]
    damping_ratio: float | NDArray[Any]
    velocity: NDArray[Any]
    spin: NDArray[Any]
    held: int = -1
    airborne: bool = False


@dataclass(frozen=True)
class Ball:
    """A slave's foot that is not flat: its nodes are the centres of balls with which it touches,
    see `contact.ball`.

    radius: [m]. edge: (2,) [m] of a dome, which is a part of one ball: the radius of the circle
    where it ends and 0, or half the sides of a rectangle. The
        surface then has one node, the centre of the ball, which moves as the foot does on the mean;
            the two rows after it are the foot's tilts,
        by which its places along x and y move. (0, 0) where each node is the centre of a ball of
            its own.
    """

    radius: float
    edge: tuple[float, float] = (0.0, 0.0)

    @property
    def is_dome(self) -> bool:
        """Whether it is a dome, else a rounded edge."""
        return self.edge[0] > 0.0


@dataclass(frozen=True)
class Bond:
    """What glues the faces of a joint together: wax, putty or mortar.

    rows: (k,) places of the points that it holds in the slave's surface; areas: (k,) [m2] of each,
    see `structures.spring_areas`. stiffness, shear_stiffness [N/m3] of the layer per area; tension,
    cohesion [Pa]: its strengths across and along the faces;
    energy [J/m2]: that it takes to fail, 0 of one that fails at once.
    """

    rows: NDArray[Any]
    areas: NDArray[Any]
    stiffness: float
    shear_stiffness: float
    tension: float
    cohesion: float
    energy: float


@dataclass(frozen=True)
class JointModel:
    """A surface of one body on a surface of another, or on the ground: it may open, slide and roll.

    slave: place among the parts of the body whose nodes are the contact points, slave_surface of it
    with k nodes; a column is slave at its foot on
        the ground and at its head below a slab, of two blocks the upper one is.
    master: place of the other part, or GROUND; master_surface: None of the ground. friction:
    Coulomb's coefficient. law: (k, 3) [m/N] compliance of the contact law at each point, zero for a
    rigid interface. round: whether the slave's outer outline is a round rim, on which it rolls.
    restitution: ratio of the normal velocity after an impact to that before it. ball: of a slave
    whose foot is not flat.
    ground: place of the ground among those of the case, of a joint with one. gap: between the faces
    at the start [m]. rolling: coefficient
    of the rim's resistance, see `contact.rolling`; pad: what lies between, see
    `contact.pad`, None where nothing does; bond: what glues the faces together, None where nothing
    does.
    pair, outlines: of a joint with the roles exchanged, by which a joint has two sides: place of
        the joint that it belongs to, -1 of others; (n, 2, 3), (m, 2, 3) [m] ends of the sides of
        the outlines of the slave's and the master's face from the centres of mass,
        counter-clockwise seen from outside.
    border: (k, 2, 3) [m] likewise of the master's face, holes left out, of a joint with one side on
        another part: it has no contact points there.
    """

    name: str
    slave: int
    slave_surface: str
    master: int
    master_surface: str | None
    friction: float
    law: NDArray[Any]
    round: bool
    restitution: float
    ball: Ball | None = None
    pair: int = -1
    outlines: tuple[NDArray[Any], ...] = ()
    rolling: float = 0.0
    pad: Pad | None = None
    ground: int = 0
    gap: float = 0.0
    bond: Bond | None = None
    border: NDArray[Any] = field(default_factory=lambda: np.zeros((0, 2, 3)))

    @property
    def on_dome(self) -> bool:
        """Whether the slave's foot is a dome."""
        return self.ball is not None and self.ball.is_dome


@dataclass(frozen=True)
class LinkModel:
    """A tendon, spring, strut, stop, restrainer, dashpot or friction damper between a point of one
    part and a point of another or of the ground.

    Its elongation e [m] is the distance of the points less its unstressed length: that as the
    structure stands upright, less prestress / stiffness. Its force [N], positive in tension, is
    stiffness (e - y) + damping |de/dt|^power sign(de/dt), the spring's part of it only beyond the
    slack and only where it pulls or pushes; y is what has yielded: it grows where the spring's part
    less what has hardened, hardening / (1 - hardening) stiffness y, would exceed yield_n, and
    shrinks where it would be below -yield_n; see `engines.dynamics.link_law`.

    kind: as in the case. a: place of a part; arm_a: (3,) [m] in its
    frame from its centre of mass. b: place of another part, or GROUND; arm_b: (3,) [m] likewise, in
    the
        table frame for the ground.
    stiffness [N/m]; damping [N] at 1 m/s; prestress [N] at the start, below 0 compression; slack
    [m] of elongation to each side before the spring acts. pushes, pulls: whether it takes
    compression, tension. yield_n [N]: force at which it yields, breaking_n [N]: at which it breaks
    for good, of one that yields at the elongation at which it would have that force had it not;
    both infinite where it never does. ground: place of the ground that holds it, where b is one.
    hardening: stiffness after yielding over that before. bends: exponent of the curve between them,
    infinite of a corner. power: of the rate, in the dashpot's force; slow: rate [m/s] below which a
    power below 1 gives way to proportion. shape_a, shape_b: (3, m) [1/sqrt(kg)] of the bodies'
    modes at its ends, None where these follow the rigid motion alone.
    """

    name: str
    kind: str
    a: int
    arm_a: NDArray[Any]
    b: int
    arm_b: NDArray[Any]
    stiffness: float
    damping: float
    prestress: float
    slack: float
    pushes: bool
    pulls: bool
    yield_n: float
    breaking_n: float
    ground: int = 0
    hardening: float = 0.0
    bends: float = math.inf
    power: float = 1.0
    slow: float = 0.0
    shape_a: NDArray[Any] | None = None
    shape_b: NDArray[Any] | None = None


class HullOutline(TypedDict):
    """Corners (n, 3) [m] of the convex hull of a body, arrays or as JSON has them, from the middle
    of its drawing or from its centre of mass; its volume [m3].
    """

    points: NDArray[Any] | list[list[float]]
    volume: float


@dataclass(frozen=True)
class FoundContact:
    """Contact that is found while bodies move, with one another and with the grounds.

    parts: their places. friction: Coulomb's coefficient, restitution: ratio of the normal velocity
    after an impact to that before it, both of pairs without a joint; a joint between two of them,
    or of one with a ground, says its own.
    """

    parts: tuple[int, ...]
    friction: float
    restitution: float


@dataclass(frozen=True)
class StructureModel:
    """A structure at its start.

    parts, joints, links: in the order of the case; joints and links name parts by their places.
    base: what the ground is to those that stand on it, as `structures.ground.bases_of` makes it;
    more: those of further grounds; levels: heights of all grounds [m].
    outlines: of each part, from its centre of mass, None of one without elements. found: contact
    that is found, None where bodies meet at their joints alone. observed: place of the part and
    name of its mark whose horizontal displacement is u_top.
    """

    parts: tuple[Part, ...]
    joints: tuple[JointModel, ...]
    links: tuple[LinkModel, ...]
    base: BasePlate | KnownBase | UnboundedBase
    observed: tuple[int, str]
    more: tuple[BasePlate | KnownBase | UnboundedBase, ...] = ()
    levels: tuple[float, ...] = (0.0,)
    outlines: tuple[HullOutline | None, ...] = ()
    found: FoundContact | None = None

    @property
    def bases(self) -> tuple[BasePlate | KnownBase | UnboundedBase, ...]:
        """What each ground is to those that stand on it."""
        return (self.base, *self.more)

    @property
    def replaced(self) -> frozenset[int]:
        """Places of the joints in whose stead contact is found."""
        meet = frozenset(self.found.parts) if self.found else frozenset()
        return frozenset(
            place
            for place, joint in enumerate(self.joints)
            if joint.slave in meet and (joint.master == GROUND or joint.master in meet)
        )

    def place(self, name: str) -> int:
        """Place of the part of a name."""
        return next(i for i, part in enumerate(self.parts) if part.name == name)
