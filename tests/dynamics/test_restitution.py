"""Restitution of impacts: what comes back, and that contact never makes energy."""

import numpy as np
import pytest
from small_block import ENGINES, block, centre, lowest, trial

from fecolumn.case.case import case_from_tables
from fecolumn.case.sections import GRAVITY, Initial
from fecolumn.engines.dynamics.gravity import begin
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.structures.structure import structure_model
from fecolumn.verification.structures_feet import BLOCK, columns_and_rows
from fecolumn.verification.trial import afloat


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("e", [0.5, 0.9])
def test_a_block_dropped_flat_by_9_mm_rebounds_to_e2_of_it(engine, e):
    system = block(0.1, 0.1, dt=2e-4, restitution=e)
    still, fallen = np.zeros_like(system.body.X), np.sqrt(2 * 0.009 / 9.80665)
    one = trial(
        engine,
        system,
        lambda system: afloat(system, still, still, still + [0.0, 0.0, -9.80665], 0.009),
    )
    heights = []
    for _ in range(round((1 + e) * fallen / 2e-4)):
        one.step()
        heights.append(centre(one)[2] - 0.05)
    assert heights[-1] == pytest.approx(e**2 * 0.009, rel=0.01)
    assert one.energy()["impact"] + one.energy()["contact"] == pytest.approx(
        -(1 - e**2) * 0.009 * system.weight, rel=0.01
    )
    assert abs(one.energy()["closure"]) < 1e-9 * 0.009 * system.weight


@pytest.mark.parametrize("engine", ENGINES)
def test_planar_rocking_gets_back_e2_of_what_housner_s_impact_takes(engine):
    """A plastic impact about the other edge takes 1 - r^2 of the kinetic energy; e of its impulse
    once more returns e^2 of that.
    """
    taken, e = {}, 0.6
    for restitution in (0.0, e):
        system = block(0.2, 0.8, friction=0.8, dt=5e-4, restitution=restitution)
        one = trial(engine, system, lambda system: begin(system, Initial(tilt_rad=0.01)))
        now = one.energy()
        while not now["impact"] < -1e-3 * now["kinetic"] and one.state.time < 1:
            one.step()
            was, now = now, one.energy()
        taken[restitution] = sum(now[term] - was[term] for term in ("impact", "contact"))
    column = system.body
    turn = np.cross([0.0, 1.0, 0.0], column.X - [0.1, 0.0, 0.0])
    housner = 1 - 2 * column.total_mass * 0.1**2 / column.dot(turn, column.momentum(turn))
    assert taken[e] - taken[0.0] == pytest.approx(
        e**2 * (1 - housner**2) * was["kinetic"], rel=0.02
    )


@pytest.mark.parametrize("engine", ENGINES)
def test_bounces_on_corners_with_friction_never_make_energy(engine):
    """A tilted, spinning block dropped on a corner, e = 0.9, mu = 0.5: a dozen impacts at one to
    four corners.
    """
    system = block(0.1, 0.1, friction=0.5, restitution=0.9)
    arm = system.body.X - system.body.center
    turn = rotation_matrix([0.15, 0.1, 0.3])

    def start(system):
        displacement = arm @ (turn - np.eye(3)).T
        rates = np.cross([0.5, -1.0, 3.0], arm @ turn.T) + [0.4, 0.2, 0.0]
        return afloat(system, displacement, rates, 0 * arm + [0.0, 0.0, -9.80665], 0.012)

    one = trial(engine, system, start)
    taken = [0.0]
    for _ in range(200):
        one.step()
        energy = one.energy()
        taken.append(energy["friction"] + energy["impact"] + energy["contact"])
    scale = 0.01 * system.weight
    assert lowest(one) > -1e-4
    assert np.diff(taken).max() < 1e-9 * scale and taken[-1] < -scale
    assert one.energy()["friction"] < -0.1 * scale


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
@pytest.mark.parametrize("e", [0.3, 0.8])
def test_a_dropped_block_lies_still_after_the_time_of_all_its_bounces(engine, e):
    """They take t (1 + e) / (1 - e), t being the time of the fall: the first half bounce and a
    geometric series. The last ones are shorter than a step.
    """
    dt, fall = 1e-3, 0.01
    case = case_from_tables(
        dict(
            bodies=dict(block=BLOCK | dict(at_m=[0.0, 0.0, fall])),
            joints=dict(foot=dict(between=["block", "ground"])),
            contact=dict(friction_coefficient=0.4, restitution=e, interior_points=4),
            integration=dict(dt_s=dt, duration_s=9.0, engine=engine, start="drawn"),
        ),
        "drop",
    )
    rows, _ = columns_and_rows(case, 1.0)
    speed = np.abs(np.diff(rows["body/block/displacement"][:, 2])) / dt
    still = rows["time"][np.flatnonzero(speed > 1e-5)[-1] + 1]
    assert still == pytest.approx(np.sqrt(2 * fall / GRAVITY) * (1 + e) / (1 - e), abs=15 * dt)


@pytest.mark.parametrize(
    "height, dt, engine, ground, told",
    [
        (6.0, 1e-3, "reduced", {}, "depends on integration.dt_s"),
        (1.2, 1e-4, "reduced", {}, "vibrate for up to"),
        (1.2, 5e-3, "reduced", {}, ""),
        (6.0, 1e-3, "rigid", {}, ""),
        (1.2, 1e-3, "rigid", dict(kind="plate", thickness_m=0.1), "ground that gives"),
    ],
)
def test_restitution_that_depends_on_the_step_is_told(height, dt, engine, ground, told, recwarn):
    case = case_from_tables(
        dict(
            bodies=dict(block=BLOCK | dict(height_m=height)),
            grounds=dict(ground=ground) if ground else {},
            joints=dict(foot=dict(between=["block", "ground"], restitution=0.5)),
            contact=dict(friction_coefficient=0.4, interior_points=4),
            integration=dict(dt_s=dt, duration_s=1.0, engine=engine),
        ),
        "case.toml",
    )
    structure_model(case, "case.toml")
    found = [str(one.message) for one in recwarn if "restitution" in str(one.message)]
    assert len(found) == bool(told)
    assert all(told in one and "joints.foot: restitution = 0.5" in one for one in found)
