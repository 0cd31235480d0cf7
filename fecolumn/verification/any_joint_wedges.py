"""A wedge between two abutments, one fixed, the other pushed towards it: at which thrust and which
friction it sinks or is squeezed up, and how fast.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.engines.dynamics.gravity import NoEquilibrium
from fecolumn.engines.reduced.engine import Engine
from fecolumn.verification.any_joint_slopes import OFF_LIMIT, acceleration_of, begun, places
from fecolumn.verification.result import Row

#: By how much a thrust or a friction is farther within its limit than OFF_LIMIT, and far within it
FARTHER, _FAR = 1e-4, 0.1
# Masses [kg] of the wedge and of the abutment that is pushed, height [m] of the wedge's middle
_WEDGE, _ABUTMENT, _LEVEL = 100.0, 40.0, 1.0
# Inclination [deg] of its faces from the vertical, positive where it narrows downwards, and mu
_SINKING = ((20.0, 0.5), (10.0, 0.7), (-20.0, 0.5), (-10.0, 0.7))
_SQUEEZED = ((35.0, 0.3), (50.0, 0.5))
# Thrust over the weight at which mu decides, not the thrust, and inclinations [deg] there
_JAMMED, _JAMS = 1e3, (10.0, 20.0)
# Young's modulus [Pa] of elastic wedges and of stiff ones, area [m2] of a face where they touch
_STONE, _STIFF, _FACE = 200e9, 50e12, 0.4 * 0.4
#: Slope [rad], friction, thrust over the weight, and 1 where the wedge sinks, -1 where it rises
WedgeTrial = tuple[float, float, float, int]


def wedge_rows(engine: str) -> Iterator[Row]:
    """Rows of one engine."""
    yield from _thrust_rows(engine)
    yield from _jam_rows(engine)


def thrust_limits(slope: float, friction: float) -> tuple[float, float]:
    """Thrusts over the weight below which a wedge sinks and above which it is squeezed up.

    slope: of its faces from the vertical [rad], positive where it narrows downwards.
    """
    phi = np.arctan(friction)
    up = 1 / (2 * np.tan(slope - phi)) if slope > phi else np.inf
    return 1 / (2 * np.tan(slope + phi)) if slope + phi > 0 else np.inf, up


def _by_thrust(off: float) -> Iterator[WedgeTrial]:
    """Wedges whose thrust is within the limit at which they move by a share of it."""
    for kinds, way in ((_SINKING, 1), (_SQUEEZED, -1)):
        for degrees, friction in kinds:
            slope = np.radians(degrees)
            limit = thrust_limits(slope, friction)[0 if way > 0 else 1]
            yield float(slope), friction, limit * (1 - way * off), way


def _by_friction(off: float) -> Iterator[WedgeTrial]:
    """As `_by_thrust`, whose friction is within the limit: widening downwards a wedge falls below
    mu = tan(theta) and a little, narrowing it is squeezed up below mu = tan(theta) less a little.
    """
    for degrees in _JAMS:
        for way in (1, -1):
            theta = np.radians(degrees)
            limit = np.tan(theta + way * np.arctan(0.5 / _JAMMED))
            yield float(-way * theta), float(limit * (1 - off)), _JAMMED, way


def _thrust_rows(engine: str) -> Iterator[Row]:
    label = (
        "wedge between abutments, its faces 20, 10, -20, -10 deg from the vertical (narrowing "
        "downwards > 0), mu 0.5, 0.7: about the thrusts below which it sinks; 35, 50 deg, mu 0.3, "
        "0.5: above which it is squeezed up"
    )
    yield from _limit_rows(engine, _by_thrust, label, "thrust")
    errors = []
    for trial in _by_thrust(_FAR):
        made = wedge(engine, *trial[:3])
        errors.append(_upwards(made, 0.02, trial) / wedge_acceleration(*trial) - 1)
    yield Row(
        "the same, a tenth within: acceleration over the closed form, largest error",
        0.0,
        np.abs(errors).max(),
        1e-6,
    )
    crept, stood = [], 0
    for outside, within in _two(_by_thrust, -OFF_LIMIT, OFF_LIMIT):
        found = places(wedge(engine, *outside[:3], start="rest"), "wedge", 0.0, 0.5)
        crept.append(np.linalg.norm(found[2] - found[0]) / abs(wedge_acceleration(*within)))
        stood += _stands(engine, *within[:3])
    yield Row("the same: starts at rest that are found", 0, stood, 0.5)
    yield Row(
        "the same, 1e-6 outside, from rest: velocity in the first second over that 1e-6 within "
        "after one, largest",
        0.0,
        float(max(crept)),
        1e-3,
    )


def _jam_rows(engine: str) -> Iterator[Row]:
    """The thrust of 1000 W strains elastic bodies, whose faces turn by that: the limit moves by
    about the strain. So theirs is beside that of stiff ones; how fast they go is told of rigid
    ones alone.
    """
    label = (
        "wedge with mu = tan(theta), theta 10, 20 deg, thrust 1000 W: about the friction below "
        "which it falls or is squeezed up"
    )
    if engine == "rigid":
        yield from _limit_rows(engine, _by_friction, label, "friction")
        errors = []
        for trial in _by_friction(_FAR):
            # at up to 600 m/s2, which lifts the abutment, and soon turns the tendon
            made = wedge(engine, *trial[:3], dt=5e-6)
            errors.append(_upwards(made, 1e-4, trial) / wedge_acceleration(*trial) - 1)
        yield Row(
            "the same, a tenth within: acceleration over the closed form, largest error",
            0.0,
            np.abs(errors).max(),
            1e-6,
        )
    else:
        strain = _JAMMED * _WEDGE * GRAVITY / (_STONE * _FACE)
        off = [_limit(engine, two, 0.01, _STONE) for two in _two(_by_friction, 1e-3, 2e-3)]
        yield Row(
            f"{label}: friction of the limit off that of statics, over the strain by the thrust",
            0.0,
            float(np.abs(off).max()) / strain,
            2.0,
        )
        off = [_limit(engine, two, 0.01, _STIFF) for two in _two(_by_friction, 1e-3, 2e-3)]
        yield Row(
            "the same of bodies 250 times as stiff: friction of the limit over that of statics, "
            "largest error",
            0.0,
            np.abs(off).max(),
            1e-6,
        )
    crept = []
    for outside, within in _two(_by_friction, -OFF_LIMIT, OFF_LIMIT):
        found = places(wedge(engine, *outside[:3]), "wedge", 2.0, 0.5)
        crept.append(np.linalg.norm(found[2] - found[0]) / abs(wedge_acceleration(*within)))
    yield Row(
        "the same, 1e-6 outside, begun as drawn: velocity in the third second over that 1e-6 "
        "within after one, largest",
        0.0,
        float(max(crept)),
        1e-3,
    )


def _two(kinds: Callable, first: float, second: float) -> Iterator[tuple[WedgeTrial, WedgeTrial]]:
    """Pairs of wedges that are so far within their limits."""
    return zip(kinds(first), kinds(second))


def _limit(engine: str, two: tuple[WedgeTrial, WedgeTrial], each: float, modulus: float) -> float:
    """By how much the limit of two wedges is off, where their accelerations, on a line, say that it
    is; they are a thousandth and two within it. modulus: Young's [Pa].
    """
    one, other = (
        _upwards(wedge(engine, *trial[:3], modulus=modulus), each, trial) for trial in two
    )
    return 1e-3 - one * 1e-3 / (other - one)


def _limit_rows(engine: str, kinds: Callable, label: str, what: str) -> Iterator[Row]:
    """Where accelerations OFF_LIMIT and FARTHER within the limit, on a line, say that the limit is,
    and the first beside the closed form.
    """
    limits, errors = [], []
    for near, more in _two(kinds, OFF_LIMIT, FARTHER):
        one, other = (_upwards(wedge(engine, *trial[:3]), 0.05, trial) for trial in (near, more))
        limits.append(OFF_LIMIT - one * (FARTHER - OFF_LIMIT) / (other - one))
        errors.append(one / wedge_acceleration(*near) - 1)
    yield Row(
        f"{label}: {what} of the limit over that of statics, largest error",
        0.0,
        np.abs(limits).max(),
        1e-6,
    )
    yield Row(
        f"the same, {what} 1e-6 within: acceleration over the closed form, largest error",
        0.0,
        np.abs(errors).max(),
        0.1,
    )


def _upwards(made: Engine, each: float, trial: WedgeTrial) -> float:
    """Acceleration [m/s2] of the wedge the way it goes."""
    return float(acceleration_of(made, "wedge", each)[2] * -trial[3])


def _stands(engine: str, slope: float, friction: float, thrust: float) -> bool:
    """Whether gravity equilibrium of the wedge is found."""
    try:
        wedge(engine, slope, friction, thrust, start="rest")
    except NoEquilibrium:
        return False
    return True


def wedge(
    engine: str,
    slope: float,
    friction: float,
    thrust: float,
    dt: float = 1e-3,
    start: str = "drawn",
    modulus: float = _STONE,
) -> Engine:
    """Engine of a wedge between a fixed abutment and one on a frictionless floor, which a long
    tendon pushes towards it with `thrust` over the wedge's weight.

    The abutment is short and light: one much heavier than the wedge may let go of a wedge that
    widens downwards, whatever its thrust, for then forces by Coulomb's law are not unique.
    """

    def half(z: float) -> float:
        return float(0.3 + (z - _LEVEL) * np.tan(slope))

    low, high, bottom, top = _LEVEL - 0.3, _LEVEL + 0.3, _LEVEL - 0.2, _LEVEL + 0.2
    far = 0.3 + half(high) + half(low)
    prism = dict(kind="prism", element_size_m=2.0, width_m=0.4, youngs_modulus_pa=modulus)
    left = [[-half(low), low], [-half(high), high], [-far, high], [-far, low]]
    right = [
        [far, 0.0],
        [far, high],
        [half(high), high],
        [half(low), low],
        [0.05, 0.5],
        [0.05, 0.0],
    ]
    middle = [[half(bottom), bottom], [half(top), top], [-half(top), top], [-half(bottom), bottom]]
    tendon = dict(
        kind="tendon",
        body="right",
        point_m=[far, 0.0, _LEVEL],
        to_point_m=[-100.0, 0.0, _LEVEL],
        stiffness_n_m=1e-3,
        prestress_n=float(thrust * _WEDGE * GRAVITY),
    )
    tables = dict(
        bodies=dict(
            left=prism | dict(fixed=True, outline_m=left),
            right=prism | dict(mass_kg=_ABUTMENT, outline_m=right),
            wedge=prism | dict(mass_kg=_WEDGE, outline_m=middle),
        ),
        joints=dict(
            left_face=dict(between=["left", "wedge"]),
            right_face=dict(between=["right", "wedge"]),
            floor=dict(between=["right", "ground"], friction_coefficient=0.0),
        ),
        links=dict(push=tendon),
    )
    return begun(tables, engine, friction, dt, start)


def wedge_acceleration(slope: float, friction: float, thrust: float, way: int) -> float:
    """Acceleration [m/s2] with which the wedge of `wedge` goes down (way 1) or up (-1), both faces
    sliding.

    Each face pushes with a force at the angle of friction from its normal; the wedge goes along the
    fixed face, and stays at the other. The abutment goes along the floor, or leaves it where a
    wedge that falls fast pushes it up.
    """
    tangent, angle = np.tan(slope), slope + way * np.arctan(friction)
    weight, across, up = _WEDGE * GRAVITY, np.cos(angle), np.sin(angle)
    # of the wedge along x and z, of the abutment along x and z, of the face between them; unknown
    # are the forces of both faces, the accelerations of the wedge downwards and of the abutment
    # along x and z, and the force of the floor
    equations = np.array(
        [
            [across, -across, -_WEDGE * tangent, 0.0, 0.0, 0.0],
            [up, up, _WEDGE, 0.0, 0.0, 0.0],
            [0.0, across, 0.0, -_ABUTMENT, 0.0, 0.0],
            [0.0, -up, 0.0, 0.0, -_ABUTMENT, 1.0],
            [0.0, 0.0, 2 * tangent, -1.0, tangent, 0.0],
            [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        ]
    )
    known = [0.0, weight, thrust * weight, _ABUTMENT * GRAVITY, 0.0, 0.0]
    found = np.linalg.solve(equations, known)
    if found[5] < 0.0:
        equations[5, 4:] = 0.0, 1.0
        found = np.linalg.solve(equations, known)
    return float(way * found[2])
