"""A block on a slope: it sticks, slides and comes to rest as Coulomb's law says, a millionth from
its limit.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.gravity import NoEquilibrium
from fecolumn.engines.reduced.engine import Engine
from fecolumn.verification.joint_bodies import engines
from fecolumn.verification.result import Row

# Inclinations [deg] of slopes, directions [deg] of their fall lines from x to y
_SLOPES, _DIRECTIONS = (10.0, 25.0, 40.0), (0.0, 90.0, 33.0)
#: By how much what decides whether something slides is off its limit
OFF_LIMIT = 1e-6


def slope_rows(engine: str) -> Iterator[Row]:
    """A block on a slope slides at tan(angle) = mu, and with g (sin - mu cos) from there on.

    Begun where it is drawn, it falls into its contact by nanometres, which gives it a velocity of
    micrometres a second along the slope: within the limit it has it until friction has taken it, at
    a millionth of g sin, and then stands.
    """
    slides, stays, stops, far, stood = [], [], [], [], 0
    for degrees in _SLOPES:
        angle = np.radians(degrees)
        each = OFF_LIMIT * GRAVITY * np.sin(angle)
        for direction in _DIRECTIONS:
            limit = np.tan(angle)
            one = acceleration_of(
                slope(engine, degrees, limit * (1 - OFF_LIMIT), direction), "block"
            )
            slides.append(np.linalg.norm(one) / each - 1)
            less, more = limit * (1 - OFF_LIMIT), limit * (1 + OFF_LIMIT)
            stays.append(_creeps(slope(engine, degrees, more, direction, "rest"), 0.0) / each)
            stops.append(_creeps(slope(engine, degrees, more, direction), 10.0) / each)
            stood += _stands(engine, degrees, less, direction)
            for share in (0.0, 0.5, 0.9):
                exact = GRAVITY * (1 - share) * np.sin(angle)
                made = slope(engine, degrees, share * limit, direction)
                far.append(
                    np.linalg.norm(acceleration_of(made, "block", 0.02)) / GRAVITY - exact / GRAVITY
                )
    label = "block on slopes of 10, 25, 40 deg, falling along x, y and askew"
    yield Row(
        f"{label}, mu = tan(angle) (1 - 1e-6): acceleration over g (sin - mu cos), largest error",
        0.0,
        np.abs(slides).max(),
        1e-2,
    )
    yield Row(f"{label}, the same: starts at rest that are found", 0, stood, 0.5)
    yield Row(
        f"{label}, mu = tan(angle) (1 + 1e-6), from rest: velocity in the first second over that "
        "of the first row after one",
        0.0,
        np.abs(stays).max(),
        1e-3,
    )
    yield Row(
        f"{label}, the same begun as drawn: velocity in the eleventh second", 0.0, max(stops), 1e-3
    )
    yield Row(
        f"{label}, mu 0, 0.5, 0.9 of tan(angle): acceleration [g], largest error",
        0.0,
        np.abs(far).max(),
        1e-6,
    )


def slope(
    engine: str, degrees: float, friction: float, direction: float, start: str = "drawn"
) -> Engine:
    """Engine of a block, 0.2 m long and 0.1 m high, on a fixed prism inclined by an angle [deg]
    that falls towards a direction [deg].
    """
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))

    def at(along: float, above: float) -> list[float]:
        return [float(along * cosine + above * sine), float(above * cosine - along * sine)]

    prism = dict(kind="prism", density_kg_m3=2500.0, turned_deg=direction, at_m=[0.0, 0.0, 2.0])
    down = [float(-cosine), float(-sine)]
    below = dict(fixed=True, width_m=1.0, element_size_m=2.0, outline_m=[at(-1, 0), at(1, 0), down])
    block = dict(
        width_m=0.2,
        element_size_m=0.2,
        outline_m=[at(-0.1, 0), at(0.1, 0), at(0.1, 0.1), at(-0.1, 0.1)],
    )
    return begun(
        dict(
            bodies=dict(slope=prism | below, block=prism | block),
            joints=dict(face=dict(between=["slope", "block"])),
        ),
        engine,
        friction,
        start=start,
    )


def begun(
    tables: dict, engine: str, friction: float, dt: float = 1e-3, start: str = "drawn"
) -> Engine:
    """Engine of bodies and joints, of elastic bodies with ten modes, that begin at rest or where
    they are drawn.
    """
    return engines(
        tables
        | dict(
            contact=dict(friction_coefficient=float(friction), interior_points=0),
            integration=dict(engine=engine, dt_s=dt, duration_s=5.0, start=start)
            | (dict(n_modes=10) if engine == "reduced" else {}),
        )
    )()


def places(made: Engine, name: str, waits: float, each: float) -> np.ndarray:
    """Places (3, 3) [m] of a body's centre after a while, `each` [s] apart."""
    number, found = [part.name for part in made.model.parts].index(name), []
    for time in (waits, each, each):
        made.advance(np.zeros((round(time / made.hht.dt), 3)))
        found.append(made.motion.frames["center"][number].copy())
    return np.array(found)


def acceleration_of(made: Engine, name: str, each: float = 0.1) -> np.ndarray:
    """Acceleration (3,) [m/s2] of a body, by second differences of its places: at the start its
    contact gives way by nanometres, which is over by then.
    """
    return np.diff(places(made, name, 2 * each, each), 2, axis=0)[0] / each**2


def _creeps(made: Engine, waits: float) -> float:
    """Velocity [m/s] of the block in the second after a while [s]."""
    found = places(made, "block", waits, 0.5)
    return float(np.linalg.norm(found[2] - found[0]))


def _stands(engine: str, degrees: float, friction: float, direction: float) -> bool:
    """Whether gravity equilibrium of the block is found."""
    try:
        slope(engine, degrees, friction, direction, "rest")
    except NoEquilibrium:
        return False
    return True
