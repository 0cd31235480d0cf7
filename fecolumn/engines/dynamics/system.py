"""The mechanical system of one analysis and its state."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.contact.interface import rims_at_rest
from fecolumn.contact.joints import Joints
from fecolumn.contact.points import CONTACT, may_touch
from fecolumn.contact.pose import grounds_at
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.dynamics.interface import ContactInterface
from fecolumn.engines.dynamics.linkage import Linkage
from fecolumn.engines.dynamics.links import TIE
from fecolumn.engines.dynamics.places import Nodal
from fecolumn.engines.dynamics.resistance import Resistance
from fecolumn.fem.composite import (
    Composite,
    CompositeDamping,
    CompositeFactor,
    CompositeFoot,
    CompositeKinematics,
    CompositeResponse,
)
from fecolumn.foundation.arrays import Array

if TYPE_CHECKING:
    from fecolumn.engines.dynamics.links import Linked
    from fecolumn.fem.body import Body


@dataclass(slots=True)
class State:
    """Everything the next step needs, in the table frame.

    x, v: (n_owned, 3) positions [m] and velocities [m/s] of the bodies, one below the other. a:
    (n_owned, 3) acceleration that HHT remembers [m/s2]: of all forces but those of links and, with
    the plastic impact law, of contact. contact_a: (n_owned, 3) that of these forces.
    internal: (n_owned, 3) internal forces [N]; strain: their energy [J]. rotation: (nb, 3, 3) mean
    rotations.
    contact: (P,) of CONTACT, what the points carry. static: strain energy of base, static rest of
    the bodies, penalty springs, pads and links [J]. ground: (3 G,) accelerations of the grounds
    [m/s2], grounds: (G,) of GROUND_STATE, relative to the first.
    rims: (ni,) of RIM. ties: (nl,) of TIE. surface_a: (n_owned, 3) acceleration of the contact
    forces in the last step, with what gives them and internal forces their moments [m/s2], and
    surface_forces: (N, 3) the forces on the surface nodes that it is of [N], both in the frames of
    the bodies; None before the first step.
    """

    time: float
    x: Array
    v: Array
    a: Array
    contact_a: Array
    internal: Array
    strain: float
    rotation: Array
    contact: Array
    static: float
    ground: Array
    rims: Array = field(default_factory=rims_at_rest)
    ties: Array = field(default_factory=lambda: np.zeros(0, TIE))
    surface_a: Array | None = None
    surface_forces: Array | None = None
    grounds: Array = field(default_factory=lambda: grounds_at([0.0]))

    @property
    def forces(self) -> Array:
        """Contact forces (P, 3) on the slaves [N], in the frames of their interfaces."""
        return self.contact["force"]

    @property
    def anchors(self) -> Array:
        """Positions (P, 2) at which the points stick [m]."""
        return self.contact["anchor"]

    @property
    def relative(self) -> Array:
        """Positions (P, 3) of the points relative to ground or master, the third the gap [m]."""
        return self.contact["relative"]

    def copy(self) -> State:
        """A state with arrays of its own."""
        copies: dict[str, Any] = {
            one.name: value.copy()
            for one in fields(self)
            if isinstance(value := getattr(self, one.name), np.ndarray)
        }
        return replace(
            self,
            **copies,
        )


@dataclass(slots=True)
class Operators:
    """Factored effective matrix of one stage and what contact forces do in it; `rotation` is the
    frame of the matrix, `nodal` the compliance of the surface nodes once it has been asked for.
    """

    mass_factor: float
    stiffness_factor: float
    rate_factor: float
    factor: CompositeFactor
    response: CompositeResponse
    rotation: Array
    nodal: Nodal | None = None


class Touching(NamedTuple):
    """What bodies touch, and with what.

    bases: each ground, a BasePlate or what answers as it does; levels: their heights [m]. nodes: of
    each body, (n,) surface nodes that may touch; joints: where they touch what. filtered: contact
    with a filter, as the plastic impact law needs it.
    """

    bases: tuple
    nodes: list
    joints: Joints
    levels: tuple = (0.0,)
    filtered: bool = True


class System:
    """Bodies, their kinematics, their contact with the base and one another, and the operators of
    each step size.

    Parameters
    ----------
    bodies
        all of them, in their places; a column is the only one.
    touching
        what they touch.
    gravity
        (3,) [m/s2].
    hht
        time integration whose step decides the filter of the contact.
    links
        a `links.Linked`.
    """

    def __init__(
        self,
        bodies: Composite,
        kinematics: CompositeKinematics,
        touching: Touching,
        gravity: ArrayLike,
        hht: HHT,
        damping: CompositeDamping | None = None,
        links: Linked | None = None,
    ) -> None:
        self.bodies, self.kinematics, self.damping = bodies, kinematics, damping
        self.bases, self.levels = tuple(touching.bases), touching.levels
        self.gravity, self.hht = np.asarray(gravity, float), hht
        #: The `structures.model.StructureModel` that it was made of, upright.
        self.model: Any = None
        self.weight = bodies.total_mass * np.linalg.norm(self.gravity)
        self.factorizations = len(self.bases)
        self._operators: dict[tuple, Operators] = {}
        factors = hht.mass_factor, hht.stiffness_factor
        factor = self._factor(*factors)
        foot = CompositeFoot(bodies, touching.nodes, factor, *factors, touching.filtered)
        self.interface = ContactInterface(bodies, foot, self.bases, touching.joints, self.levels)
        self.links = Linkage(bodies, links) if links is not None and len(links.links) else None
        self._add(*factors, hht.rate_factor, factor, bodies.unturned)
        self.resistance = (
            Resistance(self) if (self.interface.interfaces["rolling"] > 0).any() else None
        )

    @property
    def body(self) -> Body:
        """The Body of a column, the first of many."""
        return self.bodies.parts[0]

    @property
    def base(self) -> Any:
        """What a column stands on, the first ground of many."""
        return self.bases[0]

    def unstrained(self, x: Array) -> State:
        """The bodies at rest at positions x (n_owned, 3) to which rigid motions have carried them;
        nothing touches yet.
        """
        interface, grounds = self.interface, grounds_at(self.levels)
        interface.return_points()
        interface.take_grounds(grounds, grounds)
        rotation, internal, strain = self.kinematics.internal(x)
        contact = np.zeros(interface.size, CONTACT)
        places = interface.start_positions(x, rotation, interface.poses(x, rotation))
        contact["relative"], contact["located"] = (
            places,
            may_touch(interface.points, interface.interfaces, places),
        )
        contact["anchor"] = contact["relative"][:, :2]
        zero = np.zeros_like(x)
        ties = self.links.ties(self.bodies.centers(x), rotation) if self.links else np.zeros(0, TIE)
        state = State(
            time=0.0,
            x=x.copy(),
            v=zero,
            a=zero.copy(),
            contact_a=zero.copy(),
            internal=internal,
            strain=strain,
            rotation=rotation,
            contact=contact,
            static=0.0,
            ground=np.zeros(3 * len(grounds)),
            grounds=grounds,
            rims=rims_at_rest(len(interface.interfaces)),
            ties=ties,
        )
        state.static = self.links.stored(state) if self.links else 0.0
        return state

    def _factor(
        self, mass_factor: float, stiffness_factor: float, tangents: list[Any] | None = None
    ) -> CompositeFactor:
        made = CompositeFactor.of(self.bodies, mass_factor, stiffness_factor, tangents)
        self.factorizations += len(set(made.each))
        return made

    def _add(
        self,
        mass_factor: float,
        stiffness_factor: float,
        rate_factor: float,
        factor: CompositeFactor,
        rotation: Array,
    ) -> Operators:
        if self.damping and rate_factor:
            factor = self.damping.damped(factor, mass_factor, stiffness_factor, rate_factor)
        operators = Operators(
            mass_factor,
            stiffness_factor,
            rate_factor,
            factor,
            CompositeResponse(self.interface.foot, factor),
            rotation,
        )
        self._operators[mass_factor, stiffness_factor, rate_factor] = operators
        return operators

    def operators(
        self, mass_factor: float, stiffness_factor: float, rate_factor: float = 0.0
    ) -> Operators:
        """Operators of mass_factor M + stiffness_factor (K + rate_factor C), C the damping, built
        once.
        """
        factors = mass_factor, stiffness_factor, rate_factor
        return self._operators.get(factors) or self._add(
            *factors, self._factor(mass_factor, stiffness_factor), self.bodies.unturned
        )

    def of_step(self, hht: HHT | None = None) -> Operators:
        """Operators of a step of `hht`, of a whole one unless given."""
        hht = hht or self.hht
        return self.operators(hht.mass_factor, hht.stiffness_factor, hht.rate_factor)

    def refresh(self, old: Operators, x: Array) -> Operators:
        """Operators with the tangents of the bodies at positions x; only where the kinematics has
        them.
        """
        tangents = self.kinematics.tangents(x)
        factors = old.mass_factor, old.stiffness_factor, old.rate_factor
        self.forget(*factors)
        try:
            factor = self._factor(*factors[:2], tangents)
        finally:
            for tangent in tangents:
                tangent.destroy()
        return self._add(*factors, factor, self.kinematics.rotation(x))

    def forget(self, mass_factor: float, stiffness_factor: float, rate_factor: float = 0.0) -> None:
        """Free the operators of a stage."""
        self._operators.pop((mass_factor, stiffness_factor, rate_factor)).factor.destroy()

    def rounding(self, mass_factor: float) -> float:
        """Nodal force [N] that rounding leaves: internal and inertial forces are matrix times
        (position - position).
        """
        bodies = self.bodies
        scale = bodies.stiffness_scale + mass_factor * bodies.mass_scale
        return 4 * np.finfo(float).eps * scale * bodies.extent

    def load(self, ground: Array) -> Array:
        """Gravity and base-motion forces (n_owned, 3) on the bodies, in the frame of the first
        ground; ground: (3 G,) accelerations [m/s2].
        """
        loads = self.bodies.unit_loads
        return ((self.gravity - ground[:3]) @ loads.reshape(3, -1)).reshape(loads.shape[1:])
