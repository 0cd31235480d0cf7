"""The share of the rigid loss that impacts take: closed forms of blocks and bents, and what elastic
faces make of it.
"""

import numpy as np
import pytest
from small_structures import BLOCK, block, stack, structure
from test_rigid_engine import BREADTH, HEIGHT, TILT, bent

from fecolumn.engines.reduced.ledger import RIGID_LOSS
from fecolumn.engines.reduced.rigid_loss import loss_share
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.foundation.toml_file import merge
from fecolumn.simulation import run
from fecolumn.structures.structure import structure_model

ALPHA = np.arctan(BLOCK["length_m"] / BLOCK["height_m"])
KEPT = (1 - 1.5 * np.sin(ALPHA) ** 2) ** 2  # of the kinetic energy (Housner 1963)
G = 9.80665


def rocked(case, seconds: float):
    """The engine after so long."""
    engine = engine_of(case, structure_model(case), "case")
    engine.advance(np.zeros((round(seconds / case.integration.dt_s), 3)))
    return engine


def share_of(engine):
    """Share of the rigid loss that its impacts have taken."""
    return loss_share(engine.ledger, engine.structure.interfaces)


def let_go(engine: str, dt: float, modes: int = 0, **contact):
    """A block let go from 0.05 rad; its first impact is at 0.176 s, the second at 0.466 s."""
    return structure(
        **block(),
        initial=dict(block=dict(tilt_rad=0.05)),
        contact=dict(friction_coefficient=0.7, interior_points=0) | contact,
        integration=dict(engine=engine, dt_s=dt, n_modes=modes),
    )


def rigid_energy(engine) -> float:
    """Of the rigid motion of one body, and of its weight [J]."""
    body, frame = engine.structure.bodies.body[0], engine.motion.frames[0]
    return (
        body["mass"] * (frame["velocity"] @ frame["velocity"] / 2 + G * frame["center"][2])
        + frame["spin"] @ body["inertia"] @ frame["spin"] / 2
    )


@pytest.mark.parametrize("dt", [1e-3, 2.5e-4])
def test_an_impact_of_a_rigid_block_takes_housners_loss(dt):
    engine = rocked(let_go("rigid", dt), 0.4)
    mass, diagonal = (
        engine.structure.bodies.body[0]["mass"],
        np.hypot(BLOCK["length_m"], BLOCK["height_m"]) / 2,
    )
    fallen = mass * G * diagonal * (np.cos(ALPHA - 0.05) - np.cos(ALPHA))
    assert engine.ledger[RIGID_LOSS] == pytest.approx(fallen * (1 - KEPT), rel=2e-3)
    assert share_of(engine) == pytest.approx(1.0, abs=1e-3)


def test_elastic_faces_give_back_what_the_share_lacks():
    """Until the block lands again, 10 ms later, its rigid motion has lost that part of Housner's
    loss; 1e-4 s resolve how its faces give back.
    """
    before = rocked(let_go("reduced", 1e-4, 10), 0.1763)
    after = rocked(let_go("reduced", 1e-4, 10), 0.1863)
    body, spin = before.structure.bodies.body[0], before.motion.frames[0]["spin"]
    turned = (
        (
            body["inertia"][1, 1]
            + body["mass"] * (BLOCK["length_m"] ** 2 + BLOCK["height_m"] ** 2) / 4
        )
        * spin[1] ** 2
        / 2
    )
    share = (rigid_energy(before) - rigid_energy(after)) / (turned * (1 - KEPT))
    assert 0.4 < share < 0.6 and share_of(after) == pytest.approx(share, abs=0.01)


@pytest.mark.parametrize("dt, cap_kg", [(1e-3, 400e3), (2.5e-4, 400e3), (1e-3, 6e3)])
def test_feet_and_heads_of_a_bent_are_one_impact(dt, cap_kg):
    """Four joints at once, with the loss of Makris and Vassiliou (2013)."""
    engine = rocked(bent("rigid", dt, cap_kg), 0.85)
    alpha, mass = np.arctan(BREADTH / HEIGHT), 2 * 2500.0 * BREADTH**2 * HEIGHT
    ratio = cap_kg / mass
    kept = (1 - 1.5 * np.sin(alpha) ** 2 + 3 * ratio * np.cos(2 * alpha)) / (1 + 3 * ratio)
    fallen = (
        G * np.hypot(BREADTH, HEIGHT) * (np.cos(alpha - TILT) - np.cos(alpha)) * (cap_kg + mass / 2)
    )
    assert engine.ledger[RIGID_LOSS] == pytest.approx(fallen * (1 - kept**2), rel=5e-3)
    assert share_of(engine) == pytest.approx(1.0, abs=5e-3)


def test_a_bent_with_elastic_faces_loses_less():
    """The heavy cap makes them give; the rigid problem has all four joints though they land one
    after the other.
    """
    assert 0.5 < share_of(rocked(bent("reduced", 1e-3, 400e3), 0.85)) < 0.95


@pytest.mark.parametrize("leans", ["upper", "lower"])
def test_blocks_on_each_other_lose_as_rigid_bodies_do(leans):
    case = structure(
        **stack(
            initial={leans: dict(tilt_rad=0.05)},
            contact=dict(friction_coefficient=0.7),
            integration=dict(engine="rigid", dt_s=5e-4),
        )
    )
    engine = rocked(case, 0.6)
    assert engine.ledger[RIGID_LOSS] > 0 and share_of(engine) == pytest.approx(1.0, abs=0.01)


def test_without_an_impact_that_counts_or_with_restitution_there_is_no_share():
    stands = structure(**block(), integration=dict(engine="rigid", dt_s=1e-3))
    assert share_of(rocked(stands, 0.05)) is None
    assert share_of(rocked(let_go("rigid", 1e-3, restitution=0.5), 0.2)) is None


def test_nothing_is_told_where_any_foot_stands_on_a_pad(tmp_path):
    """One of two blocks rocks on rigid ground; the pad below the other always takes energy."""
    other = dict(bodies=dict(other=BLOCK | dict(at_m=[2.0, 0.0, 0.0])))
    joints = dict(other=dict(between=["other", "ground"]))
    case = structure(
        **merge(block(joints), other),
        initial=dict(block=dict(tilt_rad=0.05)),
        contact=dict(friction_coefficient=0.7, interior_points=0),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=0.4),
    )
    told = run(case, tmp_path / "both", quiet=True)["rigid_loss_share"]
    assert told == pytest.approx(1.0, abs=1e-3)
    padded = case.replace({"joints.other.stiffness_n_m3": 1e9})
    assert run(padded, tmp_path / "padded", quiet=True)["rigid_loss_share"] is None
