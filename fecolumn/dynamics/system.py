"""The mechanical system of one analysis and its state."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from fecolumn.contact.interface import rims_at_rest
from fecolumn.contact.points import CONTACT
from fecolumn.dynamics.hht import HHT
from fecolumn.dynamics.interface import Interface, Nodal
from fecolumn.dynamics.resistance import Resistance
from fecolumn.fem.damping import DampedFactor
from fecolumn.fem.effective import Factor, effective_factor
from fecolumn.fem.foot import FilteredFoot, PlainFoot, Response


@dataclass(slots=True)
class State:
    """Everything the next step needs, in the table frame.

    x, v: (n_owned, 3) positions [m] and velocities [m/s] of the column.
    a: (n_owned, 3) acceleration that HHT remembers [m/s2]; with the plastic impact law it is that of all forces but the
        contact's. contact_a: (n_owned, 3) that of the contact forces.
    internal: (n_owned, 3) internal forces [N]; strain: their energy [J]. rotation: (3, 3) mean rotation.
    contact: (n,) of CONTACT, what the foot's points carry. static: strain energy of base, foot's static rest, penalty springs and pad [J].
    ground: (3,) acceleration of the base [m/s2]. rims: (1,) of RIM.
    """

    time: float
    x: np.ndarray
    v: np.ndarray
    a: np.ndarray
    contact_a: np.ndarray
    internal: np.ndarray
    strain: float
    rotation: np.ndarray
    contact: np.ndarray
    static: float
    ground: np.ndarray
    rims: np.ndarray = field(default_factory=rims_at_rest)

    @property
    def forces(self) -> np.ndarray:
        """Contact forces (n, 3) on the foot [N]."""
        return self.contact["force"]

    @property
    def anchors(self) -> np.ndarray:
        """Positions (n, 2) at which the foot's points stick [m]."""
        return self.contact["anchor"]

    @property
    def relative(self) -> np.ndarray:
        """Positions (n, 3) of the foot's points relative to the base, the third column the gap [m]."""
        return self.contact["relative"]

    def copy(self) -> "State":
        return replace(self, **{name: getattr(self, name).copy() for name in ("x", "v", "a", "contact_a", "internal", "rotation", "contact", "ground", "rims")})


@dataclass(slots=True)
class Operators:
    """Factored effective matrix of one stage and what contact forces do in it; `rotation` is the frame of the matrix, `nodal` the compliance of the
    foot's nodes once it has been asked for."""

    mass_factor: float
    stiffness_factor: float
    rate_factor: float
    factor: Factor | DampedFactor
    response: Response
    rotation: np.ndarray
    nodal: Nodal | None = None


class System:
    """Column, its kinematics, its contact with the base, and the operators of each step size.

    Args:
        column: Body.
        kinematics: Corotated or TotalLagrangian of the column.
        base: BasePlate.
        foot: Footprint, the column nodes that may touch.
        friction, law, pad: of the Interface.
        gravity: (3,) [m/s2].
        hht: time integration whose step decides the filter of the contact.
        filtered: contact by FilteredFoot, as the plastic impact law needs it, or PlainFoot.
        rim, restitution: of the Interface.
        damping: ModalDamping of the column, or None. rolling: coefficient of the rim's Resistance [-].
    """

    def __init__(self, column, kinematics, base, foot, friction, law, gravity, hht: HHT, filtered=True,
                 rim=None, damping=None, restitution: float = 0.0, rolling: float = 0.0, pad=None):
        self.column, self.kinematics, self.base, self.damping = column, kinematics, base, damping
        self.footprint, self.foot_nodes, self.areas = foot, foot.nodes, foot.areas
        self.gravity, self.hht = np.asarray(gravity, float), hht
        self.weight = column.total_mass * np.linalg.norm(self.gravity)
        self.factorizations = 1  # the base's
        self._operators: dict[tuple, Operators] = {}
        factor = self._factor(hht.mass_factor, hht.stiffness_factor)
        response = FilteredFoot(column, foot.nodes, factor, hht.mass_factor, hht.stiffness_factor) if filtered \
            else PlainFoot(column, foot.nodes)
        self.interface = Interface(response, column.all_X[foot.nodes], base, friction, law, rim, restitution, rolling, pad)
        self._add(hht.mass_factor, hht.stiffness_factor, hht.rate_factor, factor, np.eye(3))
        self.rolling, self.resistance = rolling, Resistance(column, rim, rolling) if rim and rolling else None

    def unstrained(self, x: np.ndarray) -> State:
        """The column at rest at positions x (n_owned, 3) to which a rigid motion has carried it; nothing touches yet."""
        interface = self.interface
        rotation, internal, strain = self.kinematics.internal(x)
        contact = np.zeros(interface.size, CONTACT)
        contact["relative"], contact["located"] = interface.node_positions(x, rotation), True
        contact["anchor"] = contact["relative"][:, :2]
        zero = np.zeros_like(x)
        return State(time=0.0, x=x.copy(), v=zero, a=zero.copy(), contact_a=zero.copy(), internal=internal, strain=strain, rotation=rotation, contact=contact,
                     static=0.0, ground=np.zeros(3))

    def _factor(self, mass_factor, stiffness_factor, tangent=None) -> Factor:
        self.factorizations += 1
        return effective_factor(self.column, mass_factor, stiffness_factor, tangent)

    def _add(self, mass_factor, stiffness_factor, rate_factor, factor, rotation) -> Operators:
        if self.damping and rate_factor:
            factor = self.damping.damped(factor, mass_factor, stiffness_factor, rate_factor)
        operators = Operators(mass_factor, stiffness_factor, rate_factor, factor, Response(self.interface.foot, factor), rotation)
        self._operators[mass_factor, stiffness_factor, rate_factor] = operators
        return operators

    def operators(self, mass_factor: float, stiffness_factor: float, rate_factor: float = 0.0) -> Operators:
        """Operators of mass_factor M + stiffness_factor (K + rate_factor C), C the damping, built once."""
        factors = mass_factor, stiffness_factor, rate_factor
        return self._operators.get(factors) or self._add(*factors, self._factor(mass_factor, stiffness_factor), np.eye(3))

    def refresh(self, old: Operators, x: np.ndarray) -> Operators:
        """Operators with the column's tangent at positions x; only where the kinematics has one."""
        tangent = self.kinematics.tangent(x)
        factors = old.mass_factor, old.stiffness_factor, old.rate_factor
        self.forget(*factors)
        fresh = self._add(*factors, self._factor(*factors[:2], tangent), self.kinematics.rotation(x))
        tangent.destroy()
        return fresh

    def forget(self, mass_factor: float, stiffness_factor: float, rate_factor: float = 0.0) -> None:
        """Free the operators of a stage."""
        self._operators.pop((mass_factor, stiffness_factor, rate_factor)).factor.destroy()

    def rounding(self, mass_factor: float) -> float:
        """Nodal force [N] that rounding leaves: internal and inertial forces are matrix times (position - position)."""
        column = self.column
        scale = column.stiffness_scale + mass_factor * column.mass_scale
        return 4 * np.finfo(float).eps * scale * np.ptp(column.all_X, axis=0).max()

    def load(self, ground: np.ndarray) -> np.ndarray:
        """Gravity and base-motion forces (n_owned, 3) on the column for a ground acceleration (3,)."""
        return np.einsum("c,cna->na", self.gravity - ground, self.column.unit_loads)
