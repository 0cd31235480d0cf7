"""What the reduced engine knows of column and base: numbers of a mesh, independent of the time step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fecolumn.contact.pad import Pad
from fecolumn.contact.rim import Rim


@dataclass(frozen=True)
class ColumnModel:
    """A column reduced to its foot, in its own frame, arms measured from the centre of mass.

    mass [kg]; inertia: (3, 3) [kg m2] about the centre of mass; center: (3,) [m] in the reference configuration.
    frequencies: (m,) [rad/s], rising, of the free-free elastic modes with unit modal mass; shapes: (n, 3, m) [1/sqrt(kg)] at the
        foot's nodes.
    flexibility: (n, n, 3, 3) [m/N] of the foot's nodes by all elastic modes, the exact static one of the free body.
    arms: (n, 3) [m] of the foot's nodes; areas: (n,) [m2] tributary to them.
    top_arm: (3,) [m] and top_shape: (3, m): mean over the top's face.
    dofs: of the mesh it was made from.
    """

    mass: float
    inertia: np.ndarray
    center: np.ndarray
    frequencies: np.ndarray
    shapes: np.ndarray
    flexibility: np.ndarray
    arms: np.ndarray
    areas: np.ndarray
    top_arm: np.ndarray
    top_shape: np.ndarray
    dofs: int

    @property
    def reference(self) -> np.ndarray:
        """Reference positions (n, 3) [m] of the foot's nodes."""
        return self.arms + self.center

    def with_modes(self, count: int) -> "ColumnModel":
        """The column with its `count` lowest elastic modes; the others stay in the flexibility."""
        if not 0 <= count <= len(self.frequencies):
            raise ValueError(f"n_modes = {count}: the model has {len(self.frequencies)} elastic modes")
        from dataclasses import replace

        return replace(self, frequencies=self.frequencies[:count], shapes=np.ascontiguousarray(self.shapes[:, :, :count]),
                       top_shape=np.ascontiguousarray(self.top_shape[:, :count]))


class Column(NamedTuple):
    """A ColumnModel as a time step sees it, for compiled code.

    With F = 2 s - s^2, s = 1 / (1 + beta (1 + alpha) w^2 dt^2) of each mode (`fem.foot`): pushes: (n, 3, m) F phi, by which
    contact forces drive modes and modes move the foot; static: (3 n, 3 n) = flexibility - sum F^2 phi phi / w^2, the memoryless
    rest; mobility: (3 n, 3 n) = sum F^2 phi phi, velocity per impulse of the modes.
    own: (n, 3) [m/N] of the contact law at each point; springs: (n, 3) [N/m] and relaxation [s] of a pad (`contact.pad`), soft: whether there is one.
    rim: (n_rim,) foot nodes on the circle, none if the foot is not round; on_rim: (n,) their numbers there, -1 off the rim.
    damping: (m,) [1/s] damping force on a mode over its rate, 2 zeta w. restitution: see `contact.restitution`. rolling: see
    `dynamics.rolling.rolling_moment`.
    """

    mass: float
    inertia: np.ndarray
    inverse: np.ndarray
    gravity: np.ndarray
    arms: np.ndarray
    squares: np.ndarray
    pushes: np.ndarray
    static: np.ndarray
    mobility: np.ndarray
    own: np.ndarray
    springs: np.ndarray
    relaxation: float
    soft: bool
    friction: float
    width: float
    rim: np.ndarray
    on_rim: np.ndarray
    rim_first: float
    rim_sector: float
    rim_radius: float
    damping: np.ndarray
    restitution: float
    rolling: float


class Scheme(NamedTuple):
    """HHT-alpha coefficients of one step size; `half` is dt^2 / 2 [s2], `shrink`: (m,) s of each mode, here with its damping,
    elastic: (3 n, 3 n) [m/N] modal and static compliance of the foot within a step.
    own: (n, 3) [m/N] of contact law and pad at each point; give, kept: of the pad, see `contact.pad.Pad`."""

    dt: float
    half: float
    alpha: float
    beta: float
    gamma: float
    shrink: np.ndarray
    elastic: np.ndarray
    own: np.ndarray
    give: np.ndarray
    kept: float


def step_column(model: ColumnModel, hht, gravity, friction: float, own: np.ndarray, rim: Rim | None, damping_ratio: float = 0.0,
                restitution: float = 0.0, rolling: float = 0.0, pad: Pad | None = None) -> Column:
    """The column as steps of `hht` see it; further arguments as of `contact.interface.Interface` and `dynamics.system.System`."""
    squares = model.frequencies**2
    shrink = 1 / (1 + squares * hht.stiffness_factor / hht.mass_factor)
    pushes = model.shapes * (2 * shrink - shrink**2)
    nodes = rim.nodes if rim else np.zeros(0, np.int64)
    on_rim = np.full(len(model.arms), -1)
    on_rim[nodes] = np.arange(len(nodes))
    springs = pad.stiffness if pad else np.zeros_like(model.arms)
    return Column(
        mass=float(model.mass), inertia=np.ascontiguousarray(model.inertia), inverse=np.linalg.inv(model.inertia), gravity=np.array(gravity, float),
        arms=np.ascontiguousarray(model.arms), squares=squares, pushes=pushes, static=_flat(model.flexibility) - _modal(pushes, 1 / squares),
        mobility=_modal(pushes, np.ones_like(squares)), own=np.ascontiguousarray(own, float),
        springs=np.ascontiguousarray(springs, float), relaxation=pad.relaxation if pad else 0.0, soft=pad is not None, friction=float(friction),
        width=float(np.ptp(model.arms[:, 0])), rim=nodes.astype(np.int64), on_rim=on_rim, rim_first=rim.first if rim else 0.0,
        rim_sector=rim.sector if rim else 1.0, rim_radius=rim.radius if rim else 0.0, damping=2 * damping_ratio * model.frequencies,
        restitution=float(restitution), rolling=float(rolling) if rim else 0.0)


def scheme(column: Column, hht) -> Scheme:
    """Coefficients of a step of `hht`; the filter of the contact stays that of the column."""
    half, stiffness = hht.dt**2 / 2, column.squares * hht.stiffness_factor / hht.mass_factor
    stiffness = stiffness + column.damping * hht.rate_factor * hht.stiffness_factor / hht.mass_factor
    return _scheme(column, hht.dt, half, hht.alpha, hht.beta, hht.gamma, stiffness)


def resting_scheme(column: Column, pseudo_inertia: float) -> Scheme:
    """Coefficients of a proximal step towards equilibrium: (pseudo_inertia M + K) x = pseudo_inertia M x0 + F + U r."""
    return _scheme(column, np.inf, 1 / pseudo_inertia, 0.0, 0.25, 0.5, column.squares / pseudo_inertia)


def _scheme(column, dt, half, alpha, beta, gamma, stiffness) -> Scheme:
    shrink = 1 / (1 + stiffness)
    give, kept = np.zeros_like(column.own), 0.0
    if column.soft:
        give, kept = Pad(column.springs, column.relaxation).give(dt)
    return Scheme(dt, half, alpha, beta, gamma, shrink, column.static + half * _modal(column.pushes, shrink), column.own + give, give, kept)


def _modal(shapes: np.ndarray, factors: np.ndarray) -> np.ndarray:
    """Sum of factor phi phi^T over the modes, (3 n, 3 n)."""
    flat = shapes.reshape(3 * len(shapes), -1)
    return (flat * factors) @ flat.T


def _flat(blocks: np.ndarray) -> np.ndarray:
    """Node blocks (n, n, 3, 3) as a matrix (3 n, 3 n)."""
    n = len(blocks)
    return np.ascontiguousarray(blocks.transpose(0, 2, 1, 3)).reshape(3 * n, 3 * n)
