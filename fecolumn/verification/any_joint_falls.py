"""Contact that is found while bodies move: falls that end at rest, collisions, and the same rocking
as at a joint.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.convex import hulls_of
from fecolumn.contact.nearby import pair_keys
from fecolumn.contact.through import ThroughCheck
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced.engine import Engine
from fecolumn.structures.hulls import hulls_of_parts
from fecolumn.verification.joint_bodies import engines
from fecolumn.verification.result import Row

# Length, width and height of a block [m]; the spin [rad/s] that overturns it
_SIDES, _SPIN = (0.3, 0.4, 1.0), 2.5
_STONE = dict(density_kg_m3=2500.0, youngs_modulus_pa=30e9, poissons_ratio=0.2)
# Columns of a colonnade, drums of each, diameter and height of a drum, distance [m]; height of the
# stones on them [m]; amplitude [g] and period [s] of the cycle of a sine that throws them down
_COLONNADE, _ARCHITRAVE, _CYCLE = (3, 3, 0.8, 1.3, 2.4), 0.6, (0.7, 1.2)
# Time after which the colonnade is looked at [s]; corners of a drum's outline, over which it rolls
_LATER, _CORNERS = 40.0, 20


def fall_rows(engine: str) -> Iterator[Row]:
    """Rows of an engine."""
    yield from _lying_rows(engine)
    if engine == "rigid":
        yield from _same_as_at_a_joint()
        yield from _collision_rows()
        yield from _colonnade_rows()


def _block(**more: Any) -> dict:
    length, width, height = _SIDES
    size = dict(length_m=length, width_m=width, height_m=height, element_size_m=0.1)
    return dict(kind="block", **_STONE) | size | dict(coarse_size_m=0.2) | more


def _made(engine: str, bodies: dict, between: str | list, **more: Any) -> Engine:
    """Engine of bodies of which those of `between` may meet anywhere."""
    tables = dict(
        bodies=bodies,
        joints={},
        contact=dict(friction_coefficient=0.7, interior_points=0, between=between),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=5.0, start="drawn")
        | (dict(n_modes=5) if engine == "reduced" else {}),
    )
    return engines(tables | more)()


def _balance(columns: dict) -> float:
    """Error of the energy balance over the energy that moved."""
    return np.abs(columns["energy/closure"]).max() / np.ptp(columns["energy/gravity"])


def _lying_rows(engine: str) -> Iterator[Row]:
    """A block that overturns lies on its side, its middle at half its length, and stays there."""
    foot = dict(foot=dict(between=["block", "ground"]))
    start = dict(block=dict(spin_rad_s=[0.0, _SPIN, 0.0]))
    made = _made(engine, dict(block=_block()), "all", joints=foot, initial=start)
    columns = columns_of(made.advance(np.zeros((3000, 3)))[0], made.model)
    label = "block that overturns and falls on its side, contact found"
    if engine == "rigid":
        yield Row(
            f"{label}: height of its middle [m] after 3 s",
            _SIDES[0] / 2,
            float(made.motion.frames["center"][0, 2]),
            1e-7,
        )
        speed = np.linalg.norm(made.motion.frames["velocity"][0])
        yield Row(f"{label}: velocity then [m/s]", 0.0, float(speed), 1e-7)
    yield Row(f"{label}: error of the energy balance", 0.0, _balance(columns), 1e-12)


def _same_as_at_a_joint() -> Iterator[Row]:
    """A block rocks on a block as it does at their joint: the same until the first impact, which
    takes the same but for what points give, of which a joint has more.
    """
    bodies = dict(lower=_block(height_m=0.5), upper=_block(at_m=[0.0, 0.0, 0.5]))
    joints = dict(foot=dict(between=["lower", "ground"]), middle=dict(between=["lower", "upper"]))
    start, each = dict(upper=dict(tilt_rad=0.15)), []
    ways: tuple[str | list, ...] = ("all", [])
    for between in ways:
        made = _made("rigid", bodies, between, joints=joints, initial=start)
        each.append(columns_of(made.advance(np.zeros((500, 3)))[0], made.model))
    joint = each[1]
    turns = [columns["body/upper/rotation"] for columns in each]
    hits = int(np.argmax(joint["energy/impact"] < -1.0)) - 1
    label = "block let go from 0.15 rad on a block, contact found and at their joint"
    yield Row(
        f"{label}: largest difference of the rotation until the first impact, over its peak",
        0.0,
        float(np.abs(turns[0][:hits] - turns[1][:hits]).max() / np.abs(turns[1]).max()),
        1e-6,
    )
    loss = [float(columns["energy/impact"][-1]) for columns in each]
    yield Row(
        f"{label}: what the impact takes over that at the joint", 1.0, loss[0] / loss[1], 1e-2
    )


def _collision_rows() -> Iterator[Row]:
    """Two blocks without a joint meet in flight, face to face: they go on together."""
    bodies = dict(
        one=_block(at_m=[0.0, 0.0, 5.0]), other=_block(at_m=[0.4, 0.0, 5.0], mass_kg=90.0)
    )
    del bodies["other"]["density_kg_m3"]
    start = dict(one=dict(velocity_m_s=[2.0, 0.0, 0.0]))
    for restitution in (0.0, 0.5):
        contact = dict(
            friction_coefficient=0.7, interior_points=0, between="all", restitution=restitution
        )
        made = _made("rigid", bodies, "all", initial=start, contact=contact)
        made.advance(np.zeros((100, 3)))
        masses = made.structure.bodies.body["mass"]
        together = 2.0 * masses[0] / masses.sum()
        away = restitution * 2.0 / masses.sum()
        exact = np.array([together - away * masses[1], together + away * masses[0]])
        off = np.abs(made.motion.frames["velocity"][:, 0] - exact).max()
        yield Row(
            f"two blocks that meet in flight without a joint, restitution {restitution:g}: "
            "velocities after over that before, largest error",
            0.0,
            float(off / 2.0),
            # of what points give (RIGID_GIVE) that much is left
            3e-3,
        )


def _colonnade_rows() -> Iterator[Row]:
    """A colonnade collapses onto the ground and lies there; no stone is in another."""
    columns, drums, diameter, height, apart = _COLONNADE
    bodies, joints = {}, dict(foot=dict(between=["drum_1", "ground"]))
    for number in range(drums):
        bodies[f"drum_{number + 1}"] = _STONE | dict(
            kind="cylinder",
            outer_diameter_m=diameter,
            height_m=height,
            element_size_m=0.15 * diameter,
            copies_m=[[apart * column, 0.0, height * number] for column in range(columns)],
        )
        if number:
            joints[f"bed_{number}"] = dict(between=[f"drum_{number}", f"drum_{number + 1}"])
    bodies["stone"] = _STONE | dict(
        kind="block",
        length_m=apart,
        width_m=0.7,
        height_m=_ARCHITRAVE,
        copies_m=[[apart * (span + 0.5), 0.0, height * drums] for span in range(columns - 1)],
    )
    joints["head"] = dict(between=[f"drum_{drums}", "stone"])
    made = _made("rigid", bodies, "all", joints=joints)
    time = np.arange(1, round(_LATER / 1e-3) + 1) * 1e-3
    amplitude, period = _CYCLE
    ground = np.zeros((len(time), 3))
    ground[:, 0] = amplitude * GRAVITY * np.sin(2 * np.pi * time / period) * (time < period)
    rows, _ = made.advance(ground)
    columns_made = columns_of(rows, made.model)
    parts, centers = made.model.parts, made.motion.frames["center"]
    label = f"colonnade of {len(parts)} stones that collapses"
    low = [1.01 * half for half in [diameter / 2] * columns * drums + [0.7 / 2] * (columns - 1)]
    yield Row(
        f"{label}: stones whose middles are within a stone of the ground after {_LATER:g} s",
        float(len(parts)),
        float((centers[:, 2] < np.array(low) + diameter).sum()),
        0.0,
    )
    check = ThroughCheck(
        hulls_of(hulls_of_parts(made.model.outlines)), pair_keys([], len(parts)), -np.inf
    )
    deepest = check.deepest(
        np.ascontiguousarray(centers), np.ascontiguousarray(made.motion.rotation)
    )
    depth = max((one[2] for one in deepest), default=0.0)
    yield Row(f"{label}: depth of any stone in another [m]", 0.0, max(depth, 0.0), 1e-5)
    fastest = float(np.linalg.norm(made.motion.frames["velocity"], axis=1).max())
    # a drum that is slower rocks in its place, for it climbs over no corner of its outline
    climbs = np.sqrt(GRAVITY * diameter * (1 - np.cos(np.pi / _CORNERS)) / 1.5)
    yield Row(
        f"{label}: fastest stone then [m/s], none rolls on",
        0.0,
        fastest,
        float(climbs),
    )
    yield Row(f"{label}: error of the energy balance", 0.0, _balance(columns_made), 1e-12)
