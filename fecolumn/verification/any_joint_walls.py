"""Walls of dry stones in running bond whose head joints touch (gap 0): weight in equilibrium, and
the balance of energy while they are shaken in their plane.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.points import GROUND
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced.engine import Engine
from fecolumn.verification.boxes import sine_pulse
from fecolumn.verification.joint_bodies import engines
from fecolumn.verification.result import Row

#: Length, width and height of a stone [m]; a half stone at the end of a course lifts at the
#: acceleration of length / 2 height before it slides
STONE, _FRICTION = (0.3, 0.25, 0.25), 0.7
# Amplitude of the sine over that which lifts a half stone, its period [s] and how long it lasts [s]
_SHAKEN, _PERIOD, _LASTS = 1.5, 0.4, 0.2
# What the last proximal step, of less than tolerances.REST_WAY over the height, leaves of the
# weight
_AT_REST = 1e-7
# Courses and stones of the lowest one, of 10 and 32 stones in all
_SMALL, _WALL = (3, 3), (5, 6)


def wall_tables(courses: int, stones: int, engine: str, gap: float = 0.0) -> dict:
    """Tables of a case: a wall of so many courses of so many stones, half stones at the ends of
    every second one; gap: of its head joints [m].
    """
    length, width, height = STONE
    ends = length * (stones / 2 - 0.25)
    odd, even = range(1, courses, 2), range(0, courses, 2)
    whole = [
        [length * (k - (stones - 1) / 2), 0.0, height * c] for c in even for k in range(stones)
    ]
    whole += [
        [length * (k - (stones - 2) / 2), 0.0, height * c] for c in odd for k in range(stones - 1)
    ]
    halves = [[side * ends, 0.0, height * c] for c in odd for side in (-1, 1)]
    opened = dict(open=True) if gap else {}
    stone = dict(
        kind="block",
        width_m=width,
        height_m=height,
        density_kg_m3=2400.0,
        youngs_modulus_pa=30e9,
        poissons_ratio=0.2,
    )
    return dict(
        bodies=dict(
            stone=stone | dict(length_m=length - gap, element_size_m=height, copies_m=whole),
            half=stone | dict(length_m=length / 2 - gap, element_size_m=0.1, copies_m=halves),
        ),
        joints=dict(
            feet=dict(between=["stone", "ground"]),
            stones=dict(between=["stone", "stone"]) | opened,
            halves=dict(between=["stone", "half"]) | opened,
        ),
        contact=dict(friction_coefficient=_FRICTION, interior_points=0),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=10.0)
        | (dict(n_modes=5) if engine == "reduced" else {}),
    )


def wall(courses: int, stones: int, engine: str, gap: float = 0.0) -> Engine:
    """Engine of `wall_tables`, at rest."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return engines(wall_tables(courses, stones, engine, gap))()


def wall_shaking(made: Engine, factor: float, lasts: float = _LASTS) -> np.ndarray:
    """Accelerations [m/s2] of a sine along the wall, of `factor` times what lifts a half stone."""
    lifts = STONE[0] / 2 / STONE[2]
    dt = made.hht.dt
    return sine_pulse(factor * lifts * GRAVITY, _PERIOD, round(lasts / dt), dt)


def sunk_depth(made: Engine) -> float:
    """Depth [m] of the contact point that is farthest below the surface it is over, now."""
    contact = made.motion.contact
    over = contact["located"] & ~made.work.points["idle"]
    return max(-float(contact["relative"][over, 2].min(initial=0.0)), 0.0)


def wall_rows(engine: str) -> Iterator[Row]:
    """Rows of one engine; the large wall is shaken with rigid stones alone, for its cost."""
    for name, size in (("10", _SMALL), ("32", _WALL)):
        if engine != "rigid" and size == _WALL:
            continue
        made = wall(*size, engine)
        bodies = made.structure.bodies.body
        weight = bodies["mass"].sum() * GRAVITY
        # of the points on the ground, whose axes are those of the table frame
        on_ground = made.points["master"] == GROUND
        carried = made.motion.contact["force"][on_ground].sum(axis=0)
        told = f"wall of {name} stones, gap 0"
        yield Row(
            f"{told}: what the ground carries over its weight", 1.0, carried[2] / weight, _AT_REST
        )
        yield Row(
            f"{told}: thrust on the ground over its weight",
            0.0,
            np.hypot(*carried[:2]) / weight,
            _AT_REST,
        )
        closures, moved, depth = 0.0, 0.0, 0.0
        for part in np.array_split(wall_shaking(made, _SHAKEN), 20):
            rows, _ = made.advance(part)
            columns = columns_of(rows, made.model)
            closures = max(closures, np.abs(columns["energy/closure"]).max())
            moved = max(moved, columns["energy/kinetic"].max())
            depth = max(depth, sunk_depth(made))
        told += f", a sine of {_SHAKEN:g} times what lifts its half stones"
        yield Row(
            f"{told}: error of the energy balance over the energy that moved",
            0.0,
            closures / moved,
            1e-12,
        )
        yield Row(f"{told}: how deep any point sinks [m]", 0.0, depth, 1e-8)
