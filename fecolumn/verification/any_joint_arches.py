"""Semicircular arches, alone and on piers, beside limit analysis: what thickness and what
horizontal acceleration make them a mechanism, and where its hinges are.

Sources: Heyman (1966), The stone skeleton; Livesley (1978), Limit analysis of structures formed
from rigid blocks, by linear programming.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import linprog

from fecolumn.case.case import Case, case_from_tables
from fecolumn.case.sections import GRAVITY
from fecolumn.contact.points import GROUND
from fecolumn.engines.dynamics.cuts import StepFailed
from fecolumn.engines.dynamics.gravity import NoEquilibrium
from fecolumn.engines.history_columns import columns_of
from fecolumn.engines.reduced.engine import Engine
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.foundation.schema import InputError
from fecolumn.structures.model import StructureModel
from fecolumn.structures.structure import structure_model
from fecolumn.verification.boxes import sine_pulse
from fecolumn.verification.result import Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure


#: Least thickness over the mean radius of semicircular arches of N equal voussoirs, mu 0.7
LEAST = {9: 0.102134, 11: 0.104910, 13: 0.102836, 17: 0.105593, 27: 0.106776}
#: Horizontal acceleration [g] that makes an arch of 11 voussoirs a mechanism: thickness over the
#: radius, pier (width, height over the radius, blocks) or None, acceleration
PUSHED = (
    (0.12, None, 0.053960),
    (0.15, None, 0.159858),
    (0.2, (0.4, 1.0, 1), 0.088335),
    (0.2, (0.4, 1.0, 4), 0.088335),
    (0.2, (0.6, 2.0, 1), 0.136962),
    (0.2, (0.6, 2.0, 4), 0.136962),
)
_FRICTION, _DT = 0.7, 1e-3
# Time [s] in which a horizontal acceleration grows and during which it stays
_GROWS, _STAYS = 3.0, 3.0
# Displacement [m] below which an arch of 1 m radius stands, rotation [rad] by which hinges are told
_STANDS, _TURNED = 1e-4, 0.02
# Over the largest relative rotation: from which a joint is a hinge
_HINGE = 0.1


def arch_rows(engine: str, long: bool = False) -> Iterator[Row]:
    """Rows of one engine. Stone of 30 GPa is strained by a millionth by its weight: elastic arches
    have the limits of rigid ones. Begun as drawn, though, they fall into their strain, and those of
    1.005 of the least thickness on to the ground: they begin at rest.
    """
    yield from _thickness_rows(engine, long)
    yield from _pushed_rows(engine)
    yield from _shaken_rows(engine)


def arch_case(
    thickness: float,
    voussoirs: int,
    pier: tuple[float, float, int] | None = None,
    start: str = "rest",
    engine: str = "rigid",
) -> Case:
    """Case of a semicircular arch of radius 1 m on the ground, or on piers (width, height, blocks)
    whose axes are below its springings.
    """
    stone = dict(density_kg_m3=2400.0, youngs_modulus_pa=30e9, poissons_ratio=0.2, width_m=0.5)
    level = pier[1] if pier else 0.0
    bodies = dict(
        arch=stone
        | dict(
            kind="arch",
            mean_radius_m=1.0,
            thickness_m=float(thickness),
            voussoirs=voussoirs,
            arc_sides=8,
            at_m=[0.0, 0.0, level],
            element_size_m=1.0,
        )
    )
    joints = dict(
        ring=dict(between=["arch", "arch"]),
        springings=dict(between=["arch", "pier" if pier else "ground"]),
    )
    if pier:
        width, height, blocks = pier
        bodies["pier"] = stone | dict(
            kind="block",
            length_m=width,
            height_m=height / blocks,
            element_size_m=min(width, height / blocks, 0.5),
            copies_m=[[x, 0.0, k * height / blocks] for x in (1.0, -1.0) for k in range(blocks)],
        )
        joints["feet"] = dict(between=["pier", "ground"])
        if blocks > 1:
            joints["beds"] = dict(between=["pier", "pier"])
    return case_from_tables(
        dict(
            bodies=bodies,
            joints=joints,
            contact=dict(friction_coefficient=_FRICTION, interior_points=0),
            integration=dict(engine=engine, dt_s=_DT, duration_s=60.0, start=start)
            | (dict(n_modes=10) if engine == "reduced" else {}),
        ),
        "arch.toml",
    )


class Statics(NamedTuple):
    """Blocks in the plane of x and z: centres (nb, 2) [m], weights (nb,) over that of all, 0 of one
    that is held; of each joint the two blocks, -1 the ground, the ends (2, 2) [m] of its face, its
    normal out of the first (2,) and mu.
    """

    centers: np.ndarray
    weights: np.ndarray
    joints: list[tuple[int, int, np.ndarray, np.ndarray, float]]


def limit_analysis(
    blocks: Statics, push: float | None = None
) -> tuple[float, np.ndarray | None, np.ndarray | None]:
    """Forces of joints within friction that hold blocks, by a linear programme (Livesley 1978).

    push: horizontal acceleration [g]; left out: the largest that can be held is looked for.

    Returns: that acceleration [g], nan where nothing holds them; of each joint the share of its
    force at either end of its face; of each block its angular velocity in the mechanism, 0 where
    `push` is given.
    """
    count, joints = len(blocks.centers), len(blocks.joints)
    rows, inside = np.zeros((3 * count, 3 * joints + 1)), np.zeros((2 * joints, 3 * joints + 1))
    for k, (one, other, ends, normal, friction) in enumerate(blocks.joints):
        along = np.array([-normal[1], normal[0]])
        for column, (force, point) in enumerate(
            ((-normal, ends[0]), (-normal, ends[1]), (along, ends[0])), 3 * k
        ):
            for place, sign in ((one, 1.0), (other, -1.0)):
                if place >= 0 and blocks.weights[place]:
                    arm = point - blocks.centers[place]
                    turn = arm[1] * force[0] - arm[0] * force[1]
                    rows[3 * place : 3 * place + 3, column] += [*(sign * force), sign * turn]
        inside[2 * k : 2 * k + 2, 3 * k : 3 * k + 2] = -friction
        inside[2 * k : 2 * k + 2, 3 * k + 2] = 1.0, -1.0
    load, cost = np.zeros(3 * count), np.zeros(3 * joints + 1)
    load[1::3] = blocks.weights
    if push is None:
        rows[0::3, -1], cost[-1] = blocks.weights, -1.0
    else:
        load[0::3] = -push * blocks.weights
    found = linprog(
        cost,
        A_ub=inside,
        b_ub=np.zeros(2 * joints),
        A_eq=rows,
        b_eq=load,
        bounds=[(0, None), (0, None), (None, None)] * joints + [(0, None)],
        method="highs",
    )
    if not found.success:
        return np.nan, None, None
    carried = found.x[:-1].reshape(-1, 3)[:, :2]
    return found.x[-1], carried / carried.sum(axis=1)[:, None], found.eqlin.marginals[2::3]


def statics_of(model: StructureModel) -> Statics:
    """Blocks of a structure whose faces stand across the plane of x and z."""
    joints = []
    for joint in _faces(model):
        slave = model.parts[joint.slave]
        surface = slave.model.surfaces[joint.slave_surface]
        points = (slave.center + slave.model.arms[surface.nodes])[:, [0, 2]]
        normal = surface.normal[[0, 2]]
        order = np.argsort(points @ [-normal[1], normal[0]])
        master = -1 if joint.master == GROUND else joint.master
        joints.append((joint.slave, master, points[order[[0, -1]]], normal, joint.friction))
    weights = np.array([part.model.mass * (part.held < 0) for part in model.parts])
    centers = np.array([part.center[[0, 2]] for part in model.parts])
    return Statics(centers, weights / weights.sum(), joints)


def _faces(model: StructureModel) -> list:
    """Joints of a structure, of those with two sides the first."""
    return [joint for joint in model.joints if joint.pair < 0]


def sectors(
    thickness: float, voussoirs: int, pier: tuple[float, float, int] | None = None
) -> Statics:
    """Blocks of `arch_case` with true curved outlines and a radius of 1 m; of a pier one."""
    inner, outer, half = 1 - thickness / 2, 1 + thickness / 2, np.pi / voussoirs / 2
    radius = 2 / 3 * np.sin(half) / half * (outer**3 - inner**3) / (outer**2 - inner**2)
    level = pier[1] if pier else 0.0

    def way(turns: float) -> np.ndarray:
        return np.array([np.cos(turns * half), np.sin(turns * half)])

    centers = [radius * way(2 * k + 1) + [0.0, level] for k in range(voussoirs)]
    weights, joints = [half * (outer**2 - inner**2)] * voussoirs, []
    for k in range(voussoirs + 1):
        out, here = way(2 * k), np.clip(k, 1, voussoirs) - 1
        normal = np.array([-out[1], out[0]]) * (-1 if k == 0 else 1)
        on = k if 0 < k < voussoirs else -1 if not pier else voussoirs + (k > 0)
        ends = np.outer([inner, outer], out) + [0.0, level]
        joints.append((int(here), int(on), ends, normal, _FRICTION))
    if pier:
        for k, x in enumerate((1.0, -1.0)):
            centers.append(np.array([x, level / 2]))
            weights.append(pier[0] * level)
            ends = np.array([[x - pier[0] / 2, 0.0], [x + pier[0] / 2, 0.0]])
            joints.append((voussoirs + k, -1, ends, np.array([0.0, -1.0]), _FRICTION))
    return Statics(np.array(centers), np.array(weights) / np.sum(weights), joints)


def hinges(blocks: Statics, turns: np.ndarray) -> dict[int, int]:
    """Places of the joints at which blocks turn against each other, and which way, of rotations of
    all blocks.
    """
    full = np.append(np.where(blocks.weights > 0, turns, 0.0), 0.0)
    found = np.array([full[one] - full[other] for one, other, *_ in blocks.joints])
    large = np.flatnonzero(np.abs(found) > _HINGE * np.abs(found).max())
    return {int(k): int(np.sign(found[k])) for k in large}


def _rotations(made: Engine) -> np.ndarray:
    """Rotation of each body about y [rad]."""
    return np.arctan2(made.motion.rotation[:, 0, 2], made.motion.rotation[:, 2, 2])


def _collapses(made: Engine, grounds: np.ndarray) -> tuple[bool, np.ndarray]:
    """Whether bodies that had not moved do, and their rotations [rad] when one has turned by
    _TURNED.
    """
    begins, turns, each = made.motion.frames["center"].copy(), np.zeros(len(made.model.parts)), 20
    for first in range(0, len(grounds), each):
        try:
            ended = made.advance(grounds[first : first + each])[1]
        except StepFailed:
            ended = True
        if not turns.any() and np.abs(_rotations(made)).max() > _TURNED:
            turns = _rotations(made)
            break
        if ended:
            break
    return bool(np.abs(made.motion.frames["center"] - begins).max() > _STANDS), turns


def _standing(thickness: float, voussoirs: int, engine: str) -> bool:
    """Whether an arch is taken, and its gravity equilibrium found."""
    case = arch_case(thickness, voussoirs, engine=engine)
    try:
        engine_of(case, structure_model(case), "verify")
    except (InputError, NoEquilibrium):
        return False
    return True


def _thickness_rows(engine: str, long: bool) -> Iterator[Row]:
    wrong, falls, edges, limits, elastic = 0, 0, 0, [], engine == "reduced"
    for voussoirs, least in LEAST.items():
        wrong += _standing(0.995 * least, voussoirs, engine)
        wrong += not _standing(1.005 * least, voussoirs, engine)
        close = (0.9995, 1.0005) if long else ()
        for share in (0.995, 1.005, *close):
            start = "rest" if elastic and share > 1 else "drawn"
            case = arch_case(share * least, voussoirs, None, start, engine)
            made = engine_of(case, structure_model(case), "verify")
            fell, turns = _collapses(made, np.zeros((round((4.0 if share < 1 else 2.0) / _DT), 3)))
            falls += fell != (share < 1)
            if share == 0.995:
                edges += hinges(statics_of(made.model), turns).keys() != thrust_at_edges(voussoirs)
        limits.append(_least_thickness(voussoirs) / least - 1)
    label = f"arches of {', '.join(map(str, LEAST))} voussoirs"
    yield Row(
        f"{label}: least thickness by an own linear programme over that of the table, largest "
        "error",
        0.0,
        np.abs(limits).max(),
        1e-5,
    )
    yield Row(
        f"{label} that are taken with 0.995 of the least thickness, or find no rest with 1.005",
        0,
        wrong,
        0.5,
    )
    yield Row(
        f"{label} begun as drawn: that stand with 0.995 of it, or{' from rest' * elastic} fall "
        "with 1.005",
        0,
        falls,
        0.5,
    )
    yield Row(
        f"{label}, collapsing with 0.995 of it: that turn at other joints than those at whose "
        "edges the thrust line of limit analysis is",
        0,
        edges,
        0.5,
    )


def _least_thickness(voussoirs: int) -> float:
    """By bisection over the linear programme."""
    low, high = 0.08, 0.12
    while high - low > 1e-8:
        middle = (low + high) / 2
        stands = np.isfinite(limit_analysis(sectors(middle, voussoirs), 0.0)[0])
        low, high = (low, middle) if stands else (middle, high)
    return high


@cache
def thrust_at_edges(voussoirs: int) -> frozenset[int]:
    """Places of the joints of an arch of hardly more than its least thickness, at an edge of which
    its thrust line is.
    """
    case = arch_case(LEAST[voussoirs] * 1.0002, voussoirs, start="drawn")
    _, shares, _ = limit_analysis(statics_of(structure_model(case)), 0.0)
    assert shares is not None
    return frozenset(np.flatnonzero(shares.min(axis=1) < 0.01).tolist())


def push(acceleration: float) -> np.ndarray:
    """Accelerations (n, 3) [m/s2] of a ground that comes to an acceleration [g] along -x slowly."""
    time = _DT * np.arange(1, round((_GROWS + _STAYS) / _DT) + 1)
    level = np.where(time < _GROWS, (1 - np.cos(np.pi * time / _GROWS)) / 2, 1.0)
    return np.outer(-acceleration * GRAVITY * level, [1.0, 0.0, 0.0])


def _pushed_rows(engine: str) -> Iterator[Row]:
    for thickness, pier, exact in PUSHED:
        case = arch_case(thickness, 11, pier, engine=engine)
        model = structure_model(case)
        blocks = statics_of(model)
        limit, turning = limit_analysis(sectors(thickness, 11, pier))[0], limit_analysis(blocks)[2]
        label = f"arch, t/R {thickness:g}" + (
            f", on piers of {pier[0]:g} x {pier[1]:g} R in {pier[2]} blocks" if pier else ""
        )
        differ = 0
        for share in (0.99, 1.01):
            made = engine_of(case, model, "verify")
            fell, turns = _collapses(made, push(share * exact))
            differ += fell != (share > 1)
        yield Row(
            f"{label}: horizontal acceleration [g] of a mechanism by an own linear programme",
            exact,
            limit,
            2e-5,
        )
        yield Row(
            f"{label}: stands at 0.99 of it and falls at 1.01; outcomes that differ", 0, differ, 0.5
        )
        assert turning is not None
        exact_hinges, found = hinges(blocks, turning), hinges(blocks, turns)
        sign = 1 if sum(one == found.get(k) for k, one in exact_hinges.items()) else -1
        yield Row(
            f"{label}, collapsing at 1.01 of it: hinges other than the {len(exact_hinges)} of "
            "limit analysis",
            0,
            len({(k, sign * one) for k, one in exact_hinges.items()} ^ set(found.items())),
            0.5,
        )


def _shaken_rows(engine: str) -> Iterator[Row]:
    """An arch on piers of four blocks, 2.5 times as large as those above, under a sine pulse."""
    case = arch_case(0.2, 11, (0.4, 1.0, 4), engine=engine)
    made = engine_of(case, structure_model(case), "verify")
    grounds = sine_pulse(0.15 * GRAVITY, 0.5, 4000, _DT)
    rows, ended = made.advance(grounds)
    columns = columns_of(rows, made.model)
    moved = np.ptp(columns["energy/gravity"]) + columns["energy/kinetic"].max()
    yield Row(
        "arch on two piers of four blocks, one sine of 0.15 g, 0.5 s: steps short of 4000",
        0,
        len(grounds) - len(rows) + ended,
        0.5,
    )
    yield Row(
        "the same: error of the energy balance over the energy that moved",
        0.0,
        np.abs(columns["energy/closure"]).max() / moved,
        1e-12,
    )


def draw_arches(figure: Figure) -> None:
    """Hinges of limit analysis on arches as they collapse."""
    for axes, (thickness, pier, exact) in zip(
        figure.subplots(1, 3), (PUSHED[1], PUSHED[3], PUSHED[5])
    ):
        case = arch_case(thickness, 11, pier)
        model = structure_model(case)
        blocks = statics_of(model)
        for _, _, ends, *_ in blocks.joints:
            axes.plot(*ends.T, color="0.6", linewidth=0.8)
        _, shares, turning = limit_analysis(blocks)
        assert shares is not None and turning is not None
        for k in hinges(blocks, turning):
            axes.plot(*blocks.joints[k][2][np.argmax(shares[k])], "o", color="C3", markersize=4)
        axes.set_aspect("equal")
        axes.set_title(f"{exact:.4f} g", fontsize=8)
        axes.set_axis_off()
    figure.tight_layout()
