"""A step of the reduced engine obeys the equations of the manual's algorithm page (section 3),
written here once more from that page.
"""

import numpy as np
import pytest
from pair import tilted_motion

from fecolumn.contact.unbounded_base import rigid_base
from fecolumn.engines.dynamics.hht import HHT
from fecolumn.engines.reduced import motion as motions
from fecolumn.engines.reduced_engine import engine_on
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.structures.model import BodyModel
from fecolumn.verification.models import level_foot, on_ground

ALPHA, DT, ZETA, GRAVITY = -0.2, 1e-3, 0.05, np.array([0.0, 0.0, -9.81])
MASS, INERTIA = 10.0, np.diag([0.9, 1.0, 0.1])
FREQUENCIES = np.array([500.0, 900.0, 2500.0])
N = 12


@pytest.fixture(scope="module")
def model():
    """A column that stands on a ring of nodes, with modes of no particular shape."""
    angles = 2 * np.pi * np.arange(N) / N
    arms = np.column_stack([0.1 * np.cos(angles), 0.1 * np.sin(angles), np.full(N, -0.5)])
    shapes = 0.3 * np.random.default_rng(3).standard_normal((N, 3, 3))
    flat = shapes.reshape(3 * N, 3)
    flexibility = (
        ((flat / FREQUENCIES**2) @ flat.T + 1e-9 * np.eye(3 * N))
        .reshape(N, 3, N, 3)
        .transpose(0, 2, 1, 3)
    )
    return BodyModel(
        mass=MASS,
        inertia=INERTIA,
        center=np.array([0.0, 0.0, 0.5]),
        frequencies=FREQUENCIES,
        shapes=shapes,
        flexibility=np.ascontiguousarray(flexibility),
        arms=arms,
        dofs=0,
        surfaces={"foot": level_foot(arms, np.full(N, 1e-3))},
        marks={"top": (np.array([0.0, 0.0, 0.5]), np.zeros((3, 3)))},
    )


@pytest.fixture(scope="module")
def engine(model):
    def begin(engine):
        motion = tilted_motion(engine, 0.004, 0.3)
        motion.frames["spin"][0] = [0.3, -0.9, 0.2]
        return motion

    structure = on_ground(model, rigid_base(model.reference), 0.7, ZETA, round=True)
    return engine_on(structure, HHT(DT, ALPHA), begin, gravity=GRAVITY)


def slides(forces):
    return bool(np.any(np.hypot(forces[:, 0], forces[:, 1]) > 0.699 * forces[:, 2]))


def test_a_step_is_that_of_the_manual(engine, model):
    beta, gamma, w, c = (1 - ALPHA) ** 2 / 4, 0.5 - ALPHA, FREQUENCIES, 2 * ZETA * FREQUENCIES
    s = 1 / (1 + beta * (1 + ALPHA) * w**2 * DT**2)
    pushed = model.shapes * (2 * s - s**2)
    eta = 1 / (1 + beta * (1 + ALPHA) * w**2 * DT**2 + gamma * (1 + ALPHA) * c * DT)
    inverse, before, carrying, free = np.linalg.inv(INERTIA), engine.motion_at_rest(), 0, 0
    for k in range(150):
        motions.copy(engine.motion, before)
        ground, impacts = (
            np.array([3 * np.sin(0.03 * k), np.cos(0.02 * k), 0.0]),
            engine.record.impacts,
        )
        engine.advance(ground[None])
        after, points, turn = engine.motion, engine.work.points, engine.work.action.turn[0]
        r, carries = after.forces, after.forces[:, 2] > 0
        carrying += carries.any()
        old, new = before.frames[0], after.frames[0]
        # translation
        a1 = (1 + ALPHA) * (GRAVITY - ground) - ALPHA * (GRAVITY - before.whole["ground"][0])
        memory, push = (0.5 - beta) * old["acceleration"] + beta * a1, r.sum(axis=0) / MASS
        assert new["center"] == pytest.approx(
            old["center"] + DT * old["velocity"] + DT**2 * (memory + push / 2), abs=1e-14
        )
        # modes
        halfway = before.rotation[0] @ rotation_matrix(turn / 2)
        shape = np.einsum("iq,iqam->iam", points["weights"], pushed[points["carriers"]])
        force = np.einsum("iam,ia->m", shape[carries], (r @ halfway)[carries])
        (q0, rate0, a0), (q1, rate1, _) = before.modal[0], after.modal[0]
        way, later = q0 + DT * rate0 + DT**2 * (0.5 - beta) * a0, rate0 + DT * (1 - gamma) * a0
        damped = (
            c * DT * (beta * DT * (ALPHA * rate0 - (1 + ALPHA) * later) + (1 + ALPHA) * gamma * way)
        )
        assert q1 == pytest.approx(
            eta * (way + DT**2 * beta * ALPHA * w**2 * q0 + damped + DT**2 / 2 * force),
            rel=1e-9,
            abs=1e-15,
        )
        # rotation; the arms are those of the last iteration but one
        arms = (
            np.einsum("iq,iqa->ia", points["weights"], model.arms[points["carriers"]])
            + shape @ (q0 + q1) / 2
        )
        moment = (
            np.sinc(np.linalg.norm(turn) / 2 / np.pi)
            * before.rotation[0].T
            @ np.cross(arms @ halfway.T, r)[carries].sum(axis=0)
        )
        momentum = INERTIA @ old["spin"]
        solved = DT * old["spin"] / 2 + inverse @ rotation_matrix(-turn) @ (
            DT * momentum / 2 + DT**2 / 2 * moment
        )
        assert turn == pytest.approx(solved, abs=1e-10)
        assert after.rotation[0] == pytest.approx(
            before.rotation[0] @ rotation_matrix(turn), abs=1e-14
        )
        # velocities where nothing lands and nothing slips
        if engine.record.impacts == impacts and not (slides(r) or slides(before.forces)):
            free += 1
            assert new["velocity"] == pytest.approx(
                old["velocity"] + DT * ((1 - gamma) * old["acceleration"] + gamma * a1 + push),
                abs=1e-14,
            )
            assert new["spin"] == pytest.approx(
                inverse @ rotation_matrix(-turn) @ (momentum + DT * moment), abs=1e-7
            )
            met = later + gamma * (q1 - way) / (beta * DT)
            a1 = w**2 * (ALPHA * q0 - (1 + ALPHA) * q1) + c * (ALPHA * rate0 - (1 + ALPHA) * met)
            assert rate1 == pytest.approx(
                rate0 + DT * ((1 - gamma) * a0 + gamma * a1 + force), rel=1e-9, abs=1e-12
            )
    assert carrying > 100 and free > 50 and engine.record.impacts
