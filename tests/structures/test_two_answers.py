"""Where Coulomb's law has two answers, the one that continues the step before is found (Painleve
1895): a point that carries jams, and one that is open stays open.
"""

import numpy as np
import pytest
from small_structures import STONE, structure

from fecolumn.contact.friction import solve_contact
from fecolumn.engines.reduced import motion as motions
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.structures.structure import structure_model

# A point whose slip along x presses it against the ground: without friction of more than 1 / 0.8
# the answer would be one
W, MU = np.array([[1.0, 0.0, 0.8], [0.0, 1.0, 0.0], [0.8, 0.0, 1.0]]), 2.0
# The tip of a slender rod that leans by this tilt is such a point at MU, too: 3 MU sin cos > 1 + 3
# sin^2
LENGTH, BREADTH, TILT, G, DT = 1.0, 0.02, float(np.arctan(0.5)), 9.80665, 1e-4


def answers(slip: float, gap: float) -> dict:
    """Forces that obey the laws for a point which moves so far [m] without contact, in closed
    form.
    """
    found = dict(open=np.zeros(3))
    stuck = -np.linalg.solve(W, [slip, 0.0, gap])
    if stuck[2] > 0 and abs(stuck[0]) <= MU * stuck[2]:
        found["stuck"] = stuck
    way = np.array([-MU, 0.0, 1.0])
    normal = gap / -(W[2] @ way)
    if slip + normal * (W[0] @ way) >= 0:
        found["sliding"] = normal * way
    return found


@pytest.mark.parametrize("name", ["open", "stuck", "sliding"])
@pytest.mark.parametrize("change", [0.0, 1e-6, 0.01, -0.01, 0.3, -0.3])
def test_a_point_stays_in_the_answer_it_was_in(name, change):
    forces = solve_contact(W, [[3.0 + change, 0.0, 1.0]], MU, answers(3.0, 1.0)[name][None]).forces
    assert forces[0] == pytest.approx(answers(3.0 + change, 1.0)[name], abs=1e-12)


def test_it_leaves_its_answer_where_that_ends_and_does_not_return():
    """Stuck while slip >= gap (MU - 0.8) / (0.8 MU - 1) = 2 gap: from 2.95 down to 1.45 and
    back.
    """
    there, forces, found = np.arange(2.95, 1.4, -0.1), answers(3.0, 1.0)["stuck"][None], []
    for slip in (*there, *there[::-1]):
        forces = solve_contact(W, [[slip, 0.0, 1.0]], MU, forces).forces
        found.append(forces[0, 2] > 0)
    assert found == [slip > 2 for slip in there] + [False] * len(there)


@pytest.mark.parametrize("points", [2, 6, 12, 40])
def test_each_of_many_points_stays_in_its_own_answer(points):
    """Coupled by a thousandth of what each gives."""
    random, two = np.random.default_rng(points), answers(3.0, 1.0)
    for _ in range(10):
        root, carries = (
            random.standard_normal((3 * points, 3 * points)),
            random.random(points) < 0.5,
        )
        start = np.where(carries[:, None], two["stuck"], two["open"])
        found = solve_contact(
            np.kron(np.eye(points), W) + 1e-3 * root @ root.T / (3 * points),
            np.tile([3.0, 0.0, 1.0], (points, 1)),
            MU,
            start,
        )
        assert found.residual <= 1e-12 and ((found.forces[:, 2] > 0) == carries).all()


def test_a_rod_that_jams_stays_jammed_and_one_that_is_free_stays_free():
    """The ground is pushed to the side under the tip, and sinks faster than things fall.

    A tip that carried meanwhile is held, the rod turns about it; the same rod in the same motion,
    whose tip carries nothing at the start of the step, is left behind. Both obey the laws.
    """
    rod = (
        dict(kind="block", length_m=BREADTH, width_m=0.1, height_m=LENGTH, element_size_m=BREADTH)
        | STONE
    )
    case = structure(
        bodies=dict(rod=rod),
        joints=dict(tip=dict(between=["rod", "ground"])),
        initial=dict(rod=dict(tilt_rad=TILT)),
        contact=dict(friction_coefficient=MU, interior_points=0),
        integration=dict(engine="rigid", dt_s=DT, alpha_hht=0.0, n_modes=0),
    )
    engine, side, up = engine_of(case, structure_model(case), "case"), 10.0, 0.5
    ground = np.array([side, 0.0, -G - up])
    engine.advance(np.linspace(0.0, 1.0, 41)[:, None] * ground)
    saved = engine.motion_at_rest()
    motions.copy(engine.motion, saved)
    velocity = engine.motion.frames["velocity"][0].copy()
    engine.advance(np.tile(ground, (5, 1)))
    # of a rigid body that turns about its tip, at rest nearly: arm from its centre of mass to the
    # tip, force = -(mobility of the tip)^-1 acceleration without it
    body, R = engine.structure.bodies.body[0], engine.motion.rotation[0]
    x, z = (R @ [BREADTH / 2, 0.0, -LENGTH / 2])[[0, 2]]
    turning = body["inverse_inertia"][1, 1]
    mobility = np.eye(2) / body["mass"] + turning * np.array([[z * z, -x * z], [-x * z, x * x]])
    force = -np.linalg.solve(mobility, [-side, up])
    assert (
        engine.motion.forces.sum(axis=0)[[0, 2]] == pytest.approx(force, rel=0.02)
        and abs(force[0]) < MU * force[1]
    )
    motions.copy(saved, engine.motion)
    engine.motion.contact["force"] = 0.0
    engine.advance(np.tile(ground, (5, 1)))
    assert not engine.motion.forces.any() and engine.motion.contact["relative"][:, 2].min() > 0
    assert engine.motion.frames["velocity"][0] - velocity == pytest.approx(
        [-5 * DT * side, 0.0, 5 * DT * up], abs=1e-12
    )
