"""A block that falls by a tenth of a metre onto the ground or a plate, on a face, an edge and a
corner; and a column that leans and is caught.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced.engine import Engine
from fecolumn.verification.joint_bodies import engines
from fecolumn.verification.result import Row

# Length, width, height of the block, gap below it, thickness of the plate [m]
_SIDES, _GAP, _PLATE = np.array([0.3, 0.4, 1.0]), 0.1, 0.1
# What it falls on: tilt [rad] and direction [deg] in which it leans
_ON = {"a face": (0.0, 0.0), "an edge": (0.1, 0.0), "a corner": (0.1, 30.0)}
# Column that leans: side and height [m], tilt [rad], distance of what catches it [m]
_COLUMN, _LEANS, _STOP = (0.3, 2.0), 0.17, 0.45


def drop_rows(engine: str) -> Iterator[Row]:
    """Rows of an engine; in the reduced one a block is elastic and springs back, so that of it only
    the energy is known.
    """
    for plate in (False, True):
        label = f"block that falls 0.1 m onto {'a plate' if plate else 'the ground'}"
        if engine == "rigid":
            yield from _landing_rows(label, plate)
        energies = []
        for lean, direction in _ON.values():
            for restitution in (0.0, 0.5):
                made = _falls(engine, restitution, lean, direction, plate)
                columns = columns_of(made.advance(np.zeros((1000, 3)))[0], made.model)
                moved = np.ptp(columns["energy/gravity"])
                energies.append(np.abs(columns["energy/closure"]).max() / moved)
        yield Row(
            f"{label} on {', '.join(_ON)}: error of the energy balance over the energy that moved",
            0.0,
            max(energies),
            1e-12,
        )
    if engine == "rigid":
        yield from _caught_rows()


def _landing_rows(label: str, plate: bool) -> Iterator[Row]:
    """How high a rigid block rises from a face, and its velocities after each kind of landing."""
    for restitution, allowed in ((0.0, 1e-6), (0.5, 1e-3), (0.8, 1e-3)):
        made = _falls("rigid", restitution, *_ON["a face"], plate)
        columns = columns_of(made.advance(np.zeros((450, 3)))[0], made.model)
        yield Row(
            f"{label}, restitution {restitution:g}: height to which it rises [m], e^2 h",
            restitution**2 * _GAP,
            _rise(columns["body/block/displacement"][:, 2]),
            allowed,
        )
    for name, on in _ON.items():
        off = [_impact_error(*on, plate, restitution) for restitution in (0.0, 0.5)]
        yield Row(
            f"{label} on {name}, restitution 0 and 0.5: velocities after the impact, angular "
            "momentum about what lands kept, over that of landing, largest error",
            0.0,
            max(off),
            1e-3,
        )


def _falls(
    engine: str, restitution: float, lean: float, direction: float, plate: bool, dt: float = 1e-3
) -> Engine:
    """Engine of a block above the ground, or above a plate on it."""
    length, width, height = map(float, _SIDES)
    level = _PLATE if plate else 0.0
    stone = dict(density_kg_m3=2500.0, youngs_modulus_pa=30e9, poissons_ratio=0.2)
    bodies = dict(
        block=stone
        | dict(
            kind="block",
            length_m=length,
            width_m=width,
            height_m=height,
            element_size_m=0.3 if engine == "rigid" else 0.1,
            coarse_size_m=0.3,
            at_m=[0.0, 0.0, level + _GAP],
        )
    )
    on = "plate" if plate else "ground"
    joints = dict(face=dict(between=["block", on], restitution=restitution))
    if plate:
        bodies["plate"] = stone | dict(
            kind="plate", length_m=1.0, width_m=1.0, thickness_m=_PLATE, element_size_m=0.5
        )
        joints["base"] = dict(between=["plate", "ground"])
    tables = dict(
        bodies=bodies,
        joints=joints,
        contact=dict(friction_coefficient=0.7, interior_points=0),
        integration=dict(engine=engine, dt_s=dt, duration_s=5.0)
        | (dict(n_modes=10) if engine == "reduced" else {}),
    )
    if lean:
        tables["initial"] = dict(block=dict(tilt_rad=lean, direction_deg=direction))
    return _begun(tables)


def _begun(tables: dict) -> Engine:
    """Engine of a case whose joints begin apart, without being told so."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return engines(tables)()


def _rise(height: np.ndarray) -> float:
    """Way [m] up from where it first has landed."""
    lowest = int(np.argmax(np.diff(height) > 0))
    return float(height[lowest:].max() - height[lowest])


def _impact_error(lean: float, direction: float, plate: bool, restitution: float) -> float:
    """Largest error of a block's velocities, of its centre and over half its height, after it has
    landed, over the velocity of landing.

    The middle of what lands leaves upwards with the restitution times the velocity of landing, and
    does not slide: momentum and angular momentum then tell all others.
    """
    made = _falls("rigid", restitution, lean, direction, plate, 1e-4)
    block = made.model.parts[0]
    mass, turned = block.model.mass, block.rotation
    signs = np.array([[x, y, -1] for x in (-1, 1) for y in (-1, 1)]) / 2
    corners = (signs * _SIDES) @ turned.T
    arm = corners[corners[:, 2] < corners[:, 2].min() + 1e-9].mean(axis=0)
    lands = block.center[2] + arm[2] - (_PLATE if plate else 0.0)
    steps = int(np.sqrt(2 * lands / GRAVITY) / made.hht.dt) + 1
    made.advance(np.zeros((steps, 3)))
    speed = np.sqrt(2 * GRAVITY * lands)
    about = turned @ block.model.inertia @ turned.T / mass
    about += arm @ arm * np.eye(3) - np.outer(arm, arm)
    leaves = np.array([0.0, 0.0, restitution * speed])
    came = np.array([0.0, 0.0, -speed])
    spin = np.linalg.solve(about, np.cross(-arm, came - leaves))
    exact = leaves + np.cross(spin, -arm)
    velocity = made.motion.frames["velocity"][0]
    found = made.motion.rotation[0] @ made.motion.frames["spin"][0]
    off = np.concatenate([velocity - exact, (found - spin) * _SIDES[2] / 2])
    return float(np.abs(off).max() / speed)


def _caught_rows() -> Iterator[Row]:
    """A column that leans too far to come back is stopped by a fixed beam and rests on it."""
    side, height = _COLUMN
    stone = dict(kind="block", density_kg_m3=2500.0)
    bodies = dict(
        column=stone | dict(length_m=side, width_m=side, height_m=height, element_size_m=side),
        beam=stone
        | dict(
            length_m=0.4,
            width_m=1.2,
            height_m=0.4,
            element_size_m=0.4,
            fixed=True,
            at_m=[side / 2 + _STOP + 0.2, 0.0, height - 0.3],
        ),
    )
    made = _begun(
        dict(
            bodies=bodies,
            joints=dict(
                foot=dict(between=["column", "ground"]), stop=dict(between=["column", "beam"])
            ),
            initial=dict(column=dict(tilt_rad=_LEANS)),
            contact=dict(friction_coefficient=0.7, interior_points=0),
            integration=dict(engine="rigid", dt_s=1e-3, duration_s=10.0),
        )
    )
    rows, ended = made.advance(np.zeros((5000, 3)))
    columns = columns_of(rows, made.model)
    label = "column that leans by 0.17 rad, caught by a fixed beam 0.45 m away"
    yield Row(
        f"{label}: tilt [rad] at which it rests, asin(0.45 / 2)",
        float(np.arcsin(_STOP / height)),
        np.nan if ended else columns["body/column/tilt"][-1],
        1e-4,
    )
    yield Row(f"{label}: kinetic energy at 5 s [J]", 0.0, columns["energy/kinetic"][-1], 1e-9)
    yield Row(
        f"{label}: error of the energy balance over the energy that moved",
        0.0,
        np.abs(columns["energy/closure"]).max() / np.ptp(columns["energy/gravity"]),
        1e-12,
    )
