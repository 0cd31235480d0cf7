"""Joints of any inclination, and bodies that do not touch yet, beside closed forms and limit
analysis.

Slopes and wedges; `verification.any_joint_arches` has arches, `verification.any_joint_gaps` what
begins apart.
"""

from __future__ import annotations

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.verification.any_joint_arches import arch_rows, draw_arches
from fecolumn.verification.any_joint_drops import drop_rows
from fecolumn.verification.any_joint_falls import fall_rows
from fecolumn.verification.any_joint_gaps import gap_rows
from fecolumn.verification.joint_bodies import engines
from fecolumn.verification.result import CaseRows, Row

# Inclinations [deg] of slopes, directions [deg] of their fall lines from x to y
_SLOPES, _DIRECTIONS = (10.0, 25.0, 40.0), (0.0, 90.0, 33.0)
#: By how much what decides whether something slides is off its limit
OFF, FARTHER = 1e-6, 1e-4
# Masses [kg] of the wedge and of the abutment that is pushed, height [m] of the wedge's middle
_WEDGE, _ABUTMENT, _LEVEL = 100.0, 40.0, 1.0
# Inclination [deg] of its faces from the vertical, positive where it narrows downwards, and mu
_SINKING = ((20.0, 0.5), (10.0, 0.7), (-20.0, 0.5), (-10.0, 0.7))
_SQUEEZED = ((35.0, 0.3), (50.0, 0.5))
# Thrust over the weight at which mu decides, not the thrust
_JAMMED = 1e3


def run(engine: str, long: bool = False) -> CaseRows:
    """Rows of one engine."""
    rows = [*_slopes(engine), *_wedges(engine), *drop_rows(engine), *fall_rows(engine)]
    if engine == "reduced":
        return CaseRows(rows)
    rows += [*arch_rows(long), *gap_rows()]
    return CaseRows(rows, draw_arches, (7.2, 3.2))


def _slopes(engine: str):
    """A block on a slope slides at tan(angle) = mu, and with g (sin - mu cos) from there on."""
    slides, stays, far = [], [], []
    for degrees in _SLOPES:
        angle = np.radians(degrees)
        for direction in _DIRECTIONS:
            limit = np.tan(angle)
            one = _accelerations(_slope(engine, degrees, limit * (1 - OFF), direction), "block")
            slides.append(np.linalg.norm(one) / (OFF * GRAVITY * np.sin(angle)) - 1)
            stays.append(
                _creeps(_slope(engine, degrees, limit * (1 + OFF), direction), "block")
                / (OFF * GRAVITY * np.sin(angle))
            )
            for share in (0.0, 0.5, 0.9):
                exact = GRAVITY * (1 - share) * np.sin(angle)
                made = _slope(engine, degrees, share * limit, direction)
                far.append(
                    np.linalg.norm(_accelerations(made, "block", 0.02)) / GRAVITY - exact / GRAVITY
                )
    told = "block on slopes of 10, 25, 40 deg, falling along x, y and askew"
    yield Row(
        f"{told}, mu = tan(angle) (1 - 1e-6): acceleration over g (sin - mu cos), largest error",
        0.0,
        np.abs(slides).max(),
        1e-2,
    )
    yield Row(
        f"{told}, mu = tan(angle) (1 + 1e-6): velocity in the third second over that of the row "
        "above after one",
        0.0,
        np.abs(stays).max(),
        1e-3,
    )
    yield Row(
        f"{told}, mu 0, 0.5, 0.9 of tan(angle): acceleration [g], largest error",
        0.0,
        np.abs(far).max(),
        1e-6,
    )


def _slope(engine: str, degrees: float, friction: float, direction: float):
    """Engine of a block, 0.2 m long and 0.1 m high, on a fixed prism inclined by an angle [deg]
    that falls towards a direction [deg].
    """
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))

    def at(along: float, above: float) -> list[float]:
        return [float(along * cosine + above * sine), float(above * cosine - along * sine)]

    prism = dict(kind="prism", density_kg_m3=2500.0, turned_deg=direction, at_m=[0.0, 0.0, 2.0])
    down = [float(-cosine), float(-sine)]
    slope = dict(fixed=True, width_m=1.0, element_size_m=2.0, outline_m=[at(-1, 0), at(1, 0), down])
    block = dict(
        width_m=0.2,
        element_size_m=0.2,
        outline_m=[at(-0.1, 0), at(0.1, 0), at(0.1, 0.1), at(-0.1, 0.1)],
    )
    return _begins_drawn(
        engine, dict(slope=prism | slope, block=prism | block), friction, face=["slope", "block"]
    )


def _begins_drawn(engine: str, bodies: dict, friction: float, links=None, floor=None, **joints):
    """Engine of bodies that begin where they are drawn. joints: pairs of bodies; floor: body that
    stands on the ground without friction.
    """
    stated = {name: dict(between=pair) for name, pair in joints.items()}
    if floor:
        stated["floor"] = dict(between=[floor, "ground"], friction_coefficient=0.0)
    return engines(
        dict(
            bodies=bodies,
            joints=stated,
            contact=dict(friction_coefficient=float(friction), interior_points=0),
            integration=dict(engine=engine, dt_s=1e-3, duration_s=5.0, start="drawn")
            | (dict(n_modes=4) if engine == "reduced" else {}),
        )
        | (dict(links=links) if links else {})
    )()


def _number(made, name: str) -> int:
    return [part.name for part in made.model.parts].index(name)


def _places(made, name: str, waits: float, each: float) -> np.ndarray:
    """Places (3, 3) [m] of a body's centre after a while, `each` [s] apart."""
    number, found = _number(made, name), []
    for time in (waits, each, each):
        made.advance(np.zeros((round(time / made.hht.dt), 3)))
        found.append(made.motion.frames["center"][number].copy())
    return np.array(found)


def _accelerations(made, name: str, each: float = 0.1) -> np.ndarray:
    """Acceleration (3,) [m/s2] of a body, by second differences of its places: at the start its
    contact gives way by nanometres, which is over by then.
    """
    return np.diff(_places(made, name, 2 * each, each), 2, axis=0)[0] / each**2


def _creeps(made, name: str) -> float:
    """Velocity [m/s] of a body in the third second."""
    places = _places(made, name, 2.0, 0.5)
    return float(np.linalg.norm(places[2] - places[0]))


def thrust_limits(slope: float, friction: float) -> tuple[float, float]:
    """Thrusts over the weight below which a wedge sinks and above which it is squeezed up.

    slope: of its faces from the vertical [rad], positive where it narrows downwards.
    """
    phi = np.arctan(friction)
    up = 1 / (2 * np.tan(slope - phi)) if slope > phi else np.inf
    return 1 / (2 * np.tan(slope + phi)) if slope + phi > 0 else np.inf, up


def _wedges(engine: str):
    """A wedge between two abutments, one fixed, the other pushed towards it by a tendon."""
    found: list[tuple[float, float]] = []
    for kinds, way in ((_SINKING, 1), (_SQUEEZED, -1)):
        for degrees, friction in kinds:
            slope = np.radians(degrees)
            limit = thrust_limits(slope, friction)[0 if way > 0 else 1]
            trials = [(slope, friction, limit * (1 - way * off)) for off in (OFF, FARTHER)]
            found.append(_about(trials, way, engine))
    yield from _wedge_rows(
        found,
        "wedge between abutments, its faces 20, 10, -20, -10 deg from the vertical (narrowing "
        "downwards > 0), mu 0.5, 0.7: about the thrusts below which it sinks; 35, 50 deg, mu 0.3, "
        "0.5: above which it is squeezed up",
        "thrust",
    )
    found = []
    for degrees in (10.0, 20.0):
        for way in (1, -1):
            # widening downwards it falls below mu = tan(theta) and a little, narrowing it is
            # squeezed up below mu = tan(theta) less a little
            slope = -way * np.radians(degrees)
            limit = np.tan(np.radians(degrees) + way * np.arctan(0.5 / _JAMMED))
            trials = [(slope, limit * (1 - off), _JAMMED) for off in (OFF, FARTHER)]
            found.append(_about(trials, way, engine))
    yield from _wedge_rows(
        found,
        "wedge with mu = tan(theta), theta 10, 20 deg, thrust 1000 W: about the friction below "
        "which it falls or is squeezed up",
        "friction",
    )


def _about(trials: list, way: int, engine: str) -> tuple[float, float]:
    """Errors of a wedge about its limit: of the limit, and of the acceleration OFF within it over
    that of the closed form, less 1.

    trials: slope [rad], friction and thrust over the weight, OFF and FARTHER within the limit.
    """
    near, more = (
        _accelerations(_wedge(engine, *trial), "wedge", 0.05)[2] * -way for trial in trials
    )
    slope, friction, thrust = trials[0]
    exact = wedge_acceleration(slope, friction, thrust, way)
    return OFF - near * (FARTHER - OFF) / (more - near), near / exact - 1


def _wedge_rows(found, told: str, what: str):
    errors = np.abs(found).max(axis=0)
    yield Row(
        f"{told}: {what} of the limit over that of statics, largest error", 0.0, errors[0], 1e-6
    )
    yield Row(
        f"the same, {what} 1e-6 within: acceleration over the closed form, largest error",
        0.0,
        errors[1],
        0.1,
    )


def _wedge(engine: str, slope: float, friction: float, thrust: float):
    """Engine of a wedge between a fixed abutment and one on a frictionless floor, which a long
    tendon pushes towards it with `thrust` over the wedge's weight.

    The abutment is short and light: one much heavier than the wedge may let go of a wedge that
    widens downwards, whatever its thrust, for then forces by Coulomb's law are not unique.
    """

    def half(z: float) -> float:
        return float(0.3 + (z - _LEVEL) * np.tan(slope))

    low, high, bottom, top = _LEVEL - 0.3, _LEVEL + 0.3, _LEVEL - 0.2, _LEVEL + 0.2
    far = 0.3 + half(high) + half(low)
    prism = dict(kind="prism", element_size_m=2.0, width_m=0.4)
    bodies = dict(
        left=dict(
            fixed=True,
            outline_m=[[-half(low), low], [-half(high), high], [-far, high], [-far, low]],
        ),
        right=dict(
            mass_kg=_ABUTMENT,
            outline_m=[
                [far, 0.0],
                [far, high],
                [half(high), high],
                [half(low), low],
                [0.05, 0.5],
                [0.05, 0.0],
            ],
        ),
        wedge=dict(
            mass_kg=_WEDGE,
            outline_m=[
                [half(bottom), bottom],
                [half(top), top],
                [-half(top), top],
                [-half(bottom), bottom],
            ],
        ),
    )
    tendon = dict(
        kind="tendon",
        body="right",
        point_m=[far, 0.0, _LEVEL],
        to_point_m=[-100.0, 0.0, _LEVEL],
        stiffness_n_m=1e-3,
        prestress_n=float(thrust * _WEDGE * GRAVITY),
    )
    return _begins_drawn(
        engine,
        {name: prism | keys for name, keys in bodies.items()},
        friction,
        dict(push=tendon),
        "right",
        left_face=["left", "wedge"],
        right_face=["right", "wedge"],
    )


def wedge_acceleration(slope: float, friction: float, thrust: float, way: int) -> float:
    """Acceleration [m/s2] with which the wedge of `_wedge` goes down (way 1) or up (-1), both
    faces sliding.

    Each face pushes with a force at the angle of friction from its normal; the wedge goes along the
    fixed face, and the abutment twice as far sideways.
    """
    tangent, angle = np.tan(slope), slope + way * np.arctan(friction)
    forces = np.array(
        [
            [np.cos(angle), -np.cos(angle), -_WEDGE * tangent],
            [np.sin(angle), np.sin(angle), _WEDGE],
            [0.0, np.cos(angle), -2 * _ABUTMENT * tangent],
        ]
    )
    weight = _WEDGE * GRAVITY
    return float(way * np.linalg.solve(forces, [0.0, weight, thrust * weight])[2])
