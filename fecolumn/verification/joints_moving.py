"""Joints with two sides in motion: drums in all directions, bodies exchanged, blocks that slide
over edges; energy and depth of each.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fecolumn.engines.dynamics.energy import TERMS
from fecolumn.engines.reduced.observe import ENERGY, PER_BODY, WIDTH
from fecolumn.verification.joint_bodies import (
    BELOW,
    DISPLACED,
    JOINT_DT,
    TILT,
    B,
    block_tables,
    engines,
    tips,
    two,
)
from fecolumn.verification.result import Row

_IMPACTS = 3


def moving_joint_rows(engine: str) -> Iterator[Row]:
    """Rows of one engine."""
    yield from _drums(engine)
    yield from _exchanged(engine)
    yield from _slides(engine)
    yield from _keeps(engine)


def drum_of(engine: str) -> dict:
    """A round drum with 24 points; with modes one with a hole, for the mesh of a solid one is
    square inside, and so are its modes: 2e-6 of a tilt.
    """
    return dict(outer_diameter_m=0.9) | (
        dict(kind="cylinder") if engine == "rigid" else dict(kind="tube", wall_m=0.3)
    )


def _drums(engine: str) -> Iterator[Row]:
    """A round drum on an equal one rocks alike whichever way it leans, after a slide as before."""
    drum = drum_of(engine)
    for slide, way in ((0.0, 0.0), (1e-6, 0.0), (1e-6, 0.6), (1e-6, 2.0)):
        leans = []
        for k in range(24):
            made = two(
                engine,
                drum | dict(height_m=1.6, at_m=[slide * np.cos(way), slide * np.sin(way), BELOW]),
                drum,
                initial=dict(up=dict(tilt_rad=TILT, direction_deg=15.0 * k)),
            )
            made.advance(np.zeros((160, 3)))
            leans.append(np.linalg.norm(made.motion.rotation[1][:2, 2]))
        yield Row(
            f"equal drums, the upper slid by {slide:g} "
            f"m{f' at {way:g} rad' if slide else ''}: tilt in 24 directions 0.08 s "
            "after its release, largest distance from their mean over it",
            0.0,
            float(np.abs(leans - np.mean(leans)).max() / np.mean(leans)),
            1e-6,
        )


def _structures(engine: str) -> dict[str, dict]:
    """Tables of cases whose bodies are named in one order."""
    drum, stone = (
        drum_of(engine),
        dict(youngs_modulus_pa=5e10, poissons_ratio=0.2, density_kg_m3=2670.0),
    )
    frame = dict(feet=dict(between=["column", "ground"]), heads=dict(between=["column", "slab"]))
    plan = dict(
        integration=dict(engine=engine, dt_s=JOINT_DT, duration_s=5.0)
        | (dict(n_modes=10) if engine == "reduced" else {}),
        contact=dict(friction_coefficient=0.6, interior_points=0),
    )
    pillar = stone | dict(kind="block", length_m=0.22, width_m=0.22, height_m=0.8)
    return {
        "two blocks": block_tables(
            engine,
            dict(at_m=[0.03, 0.01, BELOW]),
            initial=dict(up=dict(tilt_rad=TILT, direction_deg=20.0)),
        ),
        "drum on drum": block_tables(
            engine,
            drum | dict(height_m=1.6, at_m=[0.01, 0.004, BELOW]),
            drum,
            initial=dict(up=dict(tilt_rad=TILT, direction_deg=20.0)),
        ),
        "a slab on four columns": plan
        | dict(
            joints=frame,
            initial=dict(column=dict(tilt_rad=0.05, direction_deg=20.0)),
            bodies=dict(
                column=pillar
                | dict(copies_m=[[x, y, 0.0] for x in (-0.5, 0.5) for y in (-0.4, 0.4)]),
                slab=stone
                | dict(
                    kind="plate", length_m=1.3, width_m=1.1, thickness_m=0.14, at_m=[0.0, 0.0, 0.8]
                ),
            ),
        ),
        # as in meshes/trilith.toml
        "trilith": plan
        | dict(
            joints=frame,
            initial=dict(column=dict(tilt_rad=0.1)),
            bodies=dict(
                column=pillar | dict(width_m=0.65, copies_m=[[-0.4, 0.0, 0.0], [0.4, 0.0, 0.0]]),
                slab=stone
                | dict(
                    kind="plate",
                    length_m=1.1,
                    width_m=0.65,
                    thickness_m=0.139,
                    at_m=[0.0, 0.0, 0.8],
                ),
            ),
        ),
    }


def _exchanged(engine: str) -> Iterator[Row]:
    """Whoever is named first in `between`, displacements and tilts of all bodies are the same until
    the third impact.
    """
    for name, one in _structures(engine).items():
        turned = one | dict(
            joints={
                key: dict(between=joint["between"][::-1]) for key, joint in one["joints"].items()
            }
        )
        histories, last = [], np.inf
        for order in (one, turned):
            made = engines(order)()
            history, _ = made.advance(np.zeros((1000, 3)))
            taken = np.diff(history[:, ENERGY + TERMS.index("impact")])
            hits = np.flatnonzero(taken < -1e-6 * np.abs(history[:, ENERGY]).max())
            last = min(last, hits[_IMPACTS - 1] + 2 if len(hits) >= _IMPACTS else len(history))
            histories.append(history[:, WIDTH : WIDTH + PER_BODY * len(made.motion.frames)])
        first, second = (history[: int(last)] for history in histories)
        yield Row(
            f"{name}, bodies of every joint exchanged, {int(last)} steps to the third "
            "impact: displacements and tilts, largest difference over the peak",
            0.0,
            float(np.abs(second - first).max() / np.abs(first).max()),
            1e-6,
        )


def _slides(engine: str) -> Iterator[Row]:
    """A shorter block slides flat over the edge below and tips about it, sliding on: time and rate
    at which it leans by 0.02 rad.
    """
    for friction in (0.0, 0.05):
        half, over, speed, tilt = 0.15, 0.16, 0.5, 0.02
        time, rate, _ = tips(half, over, speed, friction, tilt)
        made = two(
            engine,
            dict(length_m=2 * half, at_m=[B - over, 0.0, BELOW]),
            contact=dict(friction_coefficient=friction, interior_points=0),
            joints=dict(
                feet=dict(between=["low", "ground"]),
                joint=dict(between=["low", "up"], allowance_m=0.3),
            ),
            initial=dict(up=dict(velocity_m_s=[speed, 0.0, 0.0])),
            dt=1e-4,
        )
        leans = []
        steps = int(time / 1e-4)
        for more in (steps - 20, 10, 10, 10, 10):
            made.advance(np.zeros((more, 3)))
            leans.append(np.arctan2(made.motion.rotation[1][0, 2], made.motion.rotation[1][2, 2]))
        now = 1e-4 * (steps + 10 * np.arange(-2, 3))
        found = float(np.interp(tilt, leans, now))
        yield Row(
            f"a block that slides over the edge below at friction {friction:g}: time at "
            "which it leans by 0.02 rad [s]",
            time,
            found,
            1e-4,
        )
        yield Row(
            "its rate then [rad/s]",
            rate,
            float(
                np.interp(
                    found, now[1:-1], (np.array(leans[2:]) - leans[:-2]) / (now[2:] - now[:-2])
                )
            ),
            1e-4,
        )


def _keeps(engine: str) -> Iterator[Row]:
    """Energy and depth in steps of 1e-3 s: blocks and drums let go, one shaken over the edge of a
    smaller one and back.
    """
    still, time = np.zeros((500, 3)), 1e-3 * np.arange(1, 2001)
    drum, lean, coarse = (
        drum_of(engine),
        dict(up=dict(tilt_rad=TILT, direction_deg=20.0)),
        dict(dt=1e-3),
    )
    shaken = 6.0 * np.sin(2 * np.pi * 1.5 * time)[:, None] * [1.0, 0.4, 0.0]
    kinds: dict[str, list[tuple[dict, dict, dict, np.ndarray]]] = {
        "blocks displaced by up to 10 mm, let go": [
            (dict(at_m=[sign * way, 0.0, BELOW]), {}, dict(initial=lean), still)
            for way in DISPLACED
            for sign in (1, -1)
        ],
        "blocks turned by 0.1, 5 and 45 deg, let go": [
            (dict(turned_deg=angle), {}, dict(initial=lean), still) for angle in (0.1, 5.0, 45.0)
        ],
        "drums slid by 0 and 1e-6 m, let go": [
            (drum | dict(height_m=1.6, at_m=[slide, 0.0, BELOW]), drum, dict(initial=lean), still)
            for slide in (0.0, 1e-6)
        ],
        "a block shaken and sliding over the edges of another": [
            (
                dict(length_m=0.44, width_m=0.28),
                {},
                dict(contact=dict(friction_coefficient=0.25, interior_points=0)),
                shaken,
            )
        ],
        "a block turned by 45 deg, shaken and sliding": [
            (
                dict(turned_deg=45.0),
                {},
                dict(contact=dict(friction_coefficient=0.25, interior_points=0)),
                shaken,
            )
        ],
    }
    for name, runs in kinds.items():
        errors, depths = [], []
        for above, below, more, ground in runs:
            history, _ = two(engine, above, below, **coarse, **more).advance(ground)
            moved = max(np.ptp(history[:, ENERGY : WIDTH - 1], axis=0))
            errors.append(np.abs(history[:, WIDTH - 1]).max() / moved)
            depths.append(history[:, 12].max())
        yield Row(
            f"{name}, steps of 1e-3 s: error of the energy balance over the largest "
            "energy that moves",
            0.0,
            float(max(errors)),
            1e-12,
        )
        yield Row(f"{name}: how deep a point sinks [m]", 0.0, float(max(*depths, 0.0)), 1e-10)
