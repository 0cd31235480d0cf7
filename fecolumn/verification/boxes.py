"""Structures of boxes that are rigid, most of them but for their contact points: every number of
them is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.overturning import Limits
from fecolumn.contact.points import GROUND
from fecolumn.contact.unbounded_base import rigid_base
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced.start import of_parts
from fecolumn.engines.reduced_engine import engine_on
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.structures.model import (
    BodyModel,
    JointModel,
    LinkModel,
    Part,
    StructureModel,
    Surface,
)

# each point gives way by this [m/N]
GIVES = 1e-10


def box_model(
    length: float,
    width: float,
    height: float,
    density: float = 2700.0,
    gives: float = GIVES,
    per_side: int = 2,
) -> BodyModel:
    """A BodyModel of length x width x height [m], its foot and head touching with `per_side` x
    `per_side` nodes.
    """
    mass = density * length * width * height
    inertia = (
        mass / 12 * np.diag([width**2 + height**2, length**2 + height**2, length**2 + width**2])
    )
    x, y = (
        grid.ravel()
        for grid in np.meshgrid(
            np.linspace(-length / 2, length / 2, per_side),
            np.linspace(-width / 2, width / 2, per_side),
            indexing="ij",
        )
    )
    n = per_side**2
    arms = np.concatenate(
        [np.column_stack([x, y, np.full(n, z)]) for z in (-height / 2, height / 2)]
    )
    cells = [
        (i * per_side + j, (i + 1) * per_side + j, (i + 1) * per_side + j + 1, i * per_side + j + 1)
        for i in range(per_side - 1)
        for j in range(per_side - 1)
    ]
    triangles = np.array([triangle for a, b, c, d in cells for triangle in ((a, b, c), (a, c, d))])
    down = np.array([[1.0, 0, 0], [0, -1.0, 0], [0, 0, -1.0]])
    areas, outlines = np.full(n, length * width / n), np.ones(n, bool)
    surfaces = {
        "foot": Surface(
            np.arange(n), np.array([0.0, 0, -height / 2]), down, areas, outlines, triangles[:, ::-1]
        ),
        "head": Surface(
            n + np.arange(n), np.array([0.0, 0, height / 2]), np.eye(3), areas, outlines, triangles
        ),
    }
    flexibility = np.zeros((2 * n, 2 * n, 3, 3))
    flexibility[np.arange(2 * n), np.arange(2 * n)] = gives * np.eye(3)
    return BodyModel(
        mass,
        inertia,
        np.array([0.0, 0, height / 2]),
        np.zeros(0),
        np.zeros((2 * n, 3, 0)),
        flexibility,
        arms,
        0,
        surfaces,
        {"top": (np.array([0.0, 0, height / 2]), np.zeros((3, 0)))},
    )


def part(
    name: str,
    model: BodyModel,
    at: ArrayLike,
    rotation: np.ndarray | None = None,
    spin: ArrayLike = (0.0, 0, 0),
    velocity: ArrayLike = (0.0, 0, 0),
) -> Part:
    """A Part whose drawing stands at `at` (3,)."""
    return Part(
        name,
        model,
        np.asarray(at, float) + model.center,
        np.eye(3) if rotation is None else rotation,
        0.0,
        np.array(velocity, float),
        np.array(spin, float),
    )


def joint(
    slave: int,
    master: int,
    model: BodyModel,
    surface: str = "foot",
    on: str = "head",
    friction: float = 0.7,
    restitution: float = 0.0,
) -> JointModel:
    """Joint of body `slave` on body `master`, or on GROUND; `model`: the slave's BodyModel."""
    n = len(model.surfaces[surface].nodes)
    return JointModel(
        f"{slave} on {master}",
        slave,
        surface,
        master,
        None if master == GROUND else on,
        friction,
        np.zeros((n, 3)),
        False,
        restitution,
    )


def engine(
    parts: Sequence[Part],
    joints: Sequence[JointModel],
    links: Sequence[LinkModel] = (),
    dt: float = 1e-3,
    alpha: float = -0.05,
    stands: bool = True,
    observed: int = 0,
) -> Engine:
    """An Engine of a StructureModel of these, of which a body beyond 45 degrees is lost."""
    base = rigid_base(np.concatenate([p.center + p.model.arms for p in parts]))
    model = StructureModel(tuple(parts), tuple(joints), tuple(links), base, (observed, "top"))
    limits = Limits.of_tilt(len(model.parts))
    begin = partial(of_parts, parts=tuple(parts), stands=stands)
    return engine_on(model, HHT(dt, alpha), begin, limits=limits)


def stack(dt: float = 1e-3, alpha: float = -0.05) -> Engine:
    """Engine with a box of 0.3 x 0.3 x 0.9 m on one of 0.4 x 0.4 x 0.8 m, the upper observed."""
    low, up = box_model(0.4, 0.4, 0.8), box_model(0.3, 0.3, 0.9)
    return engine(
        [part("low", low, (0, 0, 0)), part("up", up, (0, 0, 0.8))],
        [joint(0, GROUND, low), joint(1, 0, up)],
        dt=dt,
        alpha=alpha,
        observed=1,
    )


def block_on_a_heavy_one(dt: float) -> tuple[Engine, float, float]:
    """A block set rocking on one of 46 times its mass; its slenderness [rad] and frequency
    parameter [rad/s].
    """
    breadth, height = 0.3, 0.9
    up, low = box_model(breadth, breadth, height), box_model(1.0, 1.0, 0.5, density=2e4)
    alpha = np.arctan(breadth / height)
    p = np.sqrt(0.75 * GRAVITY / (np.hypot(breadth, height) / 2))
    spin, toe = np.array([0, 0.5 * alpha * p, 0]), np.array([breadth / 2, 0, 0])
    tipped = part("up", up, (0, 0, 0.5), spin=spin, velocity=np.cross(spin, up.center - toe))
    return (
        engine(
            [part("low", low, (0, 0, 0)), tipped],
            [joint(0, GROUND, low), joint(1, 0, up)],
            observed=1,
            dt=dt,
        ),
        alpha,
        p,
    )


def frame(
    columns: int,
    order: Sequence[int] | None = None,
    dt: float = 1e-3,
    at: ArrayLike = (0.0, 0.0, 0.0),
) -> tuple[Engine, BodyModel, BodyModel]:
    """A slab on two or four columns; order: places of the columns, then of the slab, among the
    bodies; at: (3,) [m] where it stands.
    """
    column, slab = (
        box_model(0.2, 0.2, 1.2),
        box_model(2.4, 2.4 if columns == 4 else 0.6, 0.3, per_side=9),
    )
    places = (
        [(-1, 0, 0), (1, 0, 0)]
        if columns == 2
        else [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    )
    number = order or list(range(columns + 1))
    parts: dict[int, Part] = {}
    joints = []
    for i in range(columns):
        parts[number[i]] = part(f"column {i}", column, np.add(places[i], at))
    parts[number[-1]] = part("slab", slab, np.add((0, 0, 1.2), at))
    for i in range(columns) if order is None else reversed(range(columns)):
        joints += [
            joint(number[i], GROUND, column),
            joint(number[i], number[-1], column, surface="head", on="foot"),
        ]
    every = [parts[k] for k in range(columns + 1)]
    return engine(every, joints, observed=number[-1], dt=dt), slab, column


def bent(
    ratio: float, dt: float, tilt: float, breadth: float = 1.2, height: float = 8.0
) -> tuple[Engine, float, float]:
    """A cap of `ratio` times the mass of the two piers that it lies on, all without any give, let
    go where the piers lean by `tilt` [rad].

    Returns: an Engine, the gravity energy of the upright bent less that at the start [J], the
    slenderness of a pier [rad].
    """
    pier, span = box_model(breadth, breadth, height, gives=0.0), 6.0
    cap = box_model(
        2 * span,
        2 * breadth,
        1.5,
        density=2 * ratio * pier.mass / (2 * span * 2 * breadth * 1.5),
        gives=0.0,
        per_side=9,
    )
    turn, edge = rotation_matrix(np.array([0.0, tilt, 0.0])), np.array([breadth / 2, 0, 0])
    # the inner corner of the head, on which the cap lies
    corner = np.array([-breadth / 2, 0, height])
    carried = turn @ (corner - edge) + edge - corner
    parts = [part(f"pier {k}", pier, (x, 0, 0)) for k, x in enumerate((-span / 2, span / 2))] + [
        part("cap", cap, (0, 0, height))
    ]
    upright = [one.center for one in parts]
    leaning = [
        replace(
            one, center=turn @ (pier.center - edge) + edge + one.center - pier.center, rotation=turn
        )
        for one in parts[:2]
    ]
    leaning.append(replace(parts[2], center=parts[2].center + carried))
    joints = [
        one
        for k in range(2)
        for one in (joint(k, GROUND, pier), joint(k, 2, pier, surface="head", on="foot"))
    ]
    below = sum(
        one.model.mass * GRAVITY * (there[2] - one.center[2])
        for one, there in zip(leaning, upright)
    )
    return (
        engine(leaning, joints, dt=dt, stands=False, observed=2),
        below,
        np.arctan(breadth / height),
    )


def sine_pulse(amplitude: float, period: float, steps: int, dt: float = 1e-3) -> np.ndarray:
    """Accelerations (steps, 3) [m/s2] of one sine of that amplitude and period [s] along x."""
    t = np.arange(1, steps + 1) * dt
    return np.column_stack(
        [amplitude * np.sin(2 * np.pi * t / period) * (t < period), np.zeros((steps, 2))]
    )
