"""Laws of each joint of a structure, against closed forms: pads and soil springs, their yield,
restitution, rolling resistance.
"""

import numpy as np
import pytest
from small_grounds import (
    BLOCK,
    HEIGHT,
    MASS,
    SETTLED,
    SIDE,
    SUBGRADE,
    VERTICAL,
    WEIGHT,
    analysed,
    frequency,
    on_pad,
)
from small_structures import RIGID, STONE, structure

from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.schema import InputError


def test_a_block_settles_by_its_weight_over_the_subgrade_and_bounces_at_its_frequency(tmp_path):
    _, rows = on_pad(
        tmp_path / "run",
        soil=dict(damping_ratio=0.05),
        initial=dict(block=dict(velocity_m_s=[0.0, 0.0, -0.01])),
        integration=dict(duration_s=0.4),
    )
    rise = rows["interface/foot: block on soil/rise"]
    assert rise[0] == pytest.approx(-SETTLED, rel=1e-6)
    times, w = rows["time"], VERTICAL * np.sqrt(1 - 0.05**2)
    exact = -0.01 / w * np.exp(-0.05 * VERTICAL * times) * np.sin(w * times)
    assert np.abs(rise - rise[0] - exact).max() < 5e-3 * np.abs(exact).max()


def test_a_block_rocks_on_springs_at_the_frequency_of_its_foot(tmp_path):
    """Along the foot so stiff that it turns about the middle of that: w^2 = (k I - m g h) / J."""
    _, rows = on_pad(
        tmp_path / "run",
        soil=dict(shear_stiffness_n_m3=100 * SUBGRADE),
        initial=dict(block=dict(velocity_m_s=[1e-3, 0.0, 0.0])),
        integration=dict(duration_s=1.0, dt_s=2e-4),
    )
    spring = SUBGRADE * SIDE**4 / 12 - WEIGHT * HEIGHT / 2
    inertia = MASS * ((SIDE**2 + HEIGHT**2) / 12 + HEIGHT**2 / 4)
    # seven points a side, each with its area: their second moment is 3 % larger
    assert frequency(rows["time"], rows["u_top"][:, 0]) == pytest.approx(
        np.sqrt(spring / inertia), rel=0.03
    )


def leaning(folder, pull, **soil):
    """Rotation [rad] of a block on springs that a horizontal force of `pull` times its weight pulls
    at half its height, and the moment about the middle of its foot [N m].
    """
    _, rows = on_pad(
        folder,
        soil=soil,
        bodies=dict(block=dict(element_size_m=0.03)),
        contact=dict(interior_points=400),
        links=dict(
            jack=dict(
                kind="tendon",
                body="block",
                point_m=[0, 0, HEIGHT / 2],
                to="soil",
                to_point_m=[50.0, 0, HEIGHT / 2],
                stiffness_n_m=1.0,
                prestress_n=pull * WEIGHT,
            )
        ),
        integration=dict(duration_s=1e-3),
    )
    angle = rows["body/block/tilt"][0]
    return angle, WEIGHT * HEIGHT / 2 * (pull + angle)


@pytest.mark.long
@pytest.mark.parametrize("pull", [0.12, 0.22, 0.3])
def test_moment_and_rotation_of_a_footing_that_lifts(tmp_path, pull):
    """A rectangle on springs that push only: beyond W B / 6 the length in contact is c = 3 (B / 2 -
    M / W), and the rotation 2 W / (k B c^2).
    """
    angle, moment = leaning(tmp_path / "run", pull)
    contact = 3 * (SIDE / 2 - moment / WEIGHT)
    exact = (
        12 * moment / (SUBGRADE * SIDE**4)
        if moment < WEIGHT * SIDE / 6
        else 2 * WEIGHT / (SUBGRADE * SIDE * contact**2)
    )
    assert angle == pytest.approx(exact, rel=0.02)


@pytest.mark.long
def test_moment_and_rotation_of_a_footing_that_lifts_and_yields(tmp_path):
    """Pressure min(k theta (x - x0), q) above the weight's: where it lifts and yields, with l the
    length from there to where it yields, W = q B (B / 2 - x0 - l / 2) and so on.
    """
    q = 2 * WEIGHT / SIDE**2
    angle, moment = leaning(tmp_path / "run", 0.25, yield_pa=q)
    ramp = q / (SUBGRADE * angle)
    # from the far edge: q over a length f, falling to 0 over `ramp`
    full = WEIGHT / (q * SIDE) - ramp / 2
    assert 0 < full and full + ramp < SIDE
    exact = q * SIDE * (full * (SIDE - full) / 2 + ramp / 2 * (SIDE / 2 - full - ramp / 3))
    assert moment == pytest.approx(exact, rel=0.01)


def test_a_pad_that_yields_under_the_weight_at_rest_is_refused(tmp_path):
    with pytest.raises(
        InputError, match=r"grounds.soil.yield_pa = 20000.0: must be more than 2.383e"
    ):
        on_pad(tmp_path / "run", soil=dict(yield_pa=2e4), integration=dict(duration_s=1e-3))


def test_a_pad_that_yields_bears_no_more_and_keeps_its_settlement(tmp_path):
    """Pushed down without damping: the springs take what they hold at the yield force, the flow
    takes the rest of the energy at that force; then it bounces about where it has come to.
    """
    bears, speed = 1.8 * WEIGHT, 0.3
    summary, rows = on_pad(
        tmp_path / "run",
        soil=dict(yield_pa=bears / SIDE**2),
        initial=dict(block=dict(velocity_m_s=[0.0, 0.0, -speed])),
        integration=dict(duration_s=1.0),
    )
    force, rise = (rows[f"interface/foot: block on soil/{name}"] for name in ("force", "rise"))
    assert force.max() == pytest.approx(bears, rel=1e-5)
    left = speed**2 - (VERTICAL * 0.8 * SETTLED) ** 2
    flow = MASS * left / 2 / (bears - WEIGHT)
    settled = (rise[-700:].max() + rise[-700:].min()) / 2
    assert settled == pytest.approx(-SETTLED - flow, rel=5e-3)
    assert summary["energy_j"]["damping"] == pytest.approx(-bears * flow, rel=5e-3)
    assert summary["energy_closure_rel"] < 1e-9


def test_two_blocks_that_land_in_one_step_each_have_their_own_restitution(tmp_path):
    speed, given = 0.2, dict(one=0.3, two=0.8)
    lands = 2 * speed / GRAVITY
    _, rows = analysed(
        tmp_path / "run",
        bodies=dict(one=BLOCK, two=BLOCK | dict(at_m=[2.0, 0, 0])),
        joints={name: dict(between=[name, "ground"], restitution=e) for name, e in given.items()},
        initial={name: dict(velocity_m_s=[0, 0, speed]) for name in given},
        integration=dict(duration_s=lands + 0.01, dt_s=1e-4),
    )
    now = rows["time"] - lands
    after = now > 1e-3
    for name, e in given.items():
        height = rows[f"body/{name}/displacement"][:, 2]
        exact = e * speed * now - GRAVITY * now**2 / 2
        assert np.abs(height - exact)[after].max() < 0.02 * speed * 0.01


def test_a_pad_lies_between_two_bodies_as_well(tmp_path):
    _, rows = analysed(
        tmp_path / "run",
        bodies=dict(low=BLOCK, up=BLOCK | dict(at_m=[0, 0, HEIGHT])),
        joints=dict(
            foot=dict(between=["low", "ground"]),
            joint=dict(between=["up", "low"], stiffness_n_m3=SUBGRADE),
        ),
        initial=dict(up=dict(velocity_m_s=[0.0, 0.0, -0.005])),
        integration=dict(duration_s=0.3),
    )
    rise = rows["interface/joint: up on low/rise"]
    assert rise[0] == pytest.approx(-SETTLED, rel=1e-6)
    assert frequency(rows["time"], rise) == pytest.approx(VERTICAL, rel=2e-3)


@pytest.mark.parametrize("below", ["ground", "drum"])
def test_a_drum_loses_the_resistance_times_its_weight_per_length_rolled(tmp_path, below):
    """On the ground and on another drum, much heavier, wobbling steadily."""
    radius, height, tilt, resistance = 0.3, 0.6, 0.05, 1e-3
    small = dict(kind="cylinder", outer_diameter_m=2 * radius, height_m=height) | STONE | RIGID
    large = small | dict(outer_diameter_m=1.6, height_m=1.5, density_kg_m3=9e4)
    drums = dict(up=small | (dict(at_m=[0, 0, 1.5]) if below == "drum" else {}))
    joints = dict(joint=dict(between=["up", below], rolling_resistance=resistance))
    if below == "drum":
        drums["drum"] = large
        joints["foot"] = dict(between=["drum", "ground"])
    # steady precession of a cylinder on its rim, about: a spin along the lowest generator
    spin = 2.0
    summary, rows = analysed(
        tmp_path / "run",
        bodies=drums,
        joints=joints,
        initial=dict(up=dict(tilt_rad=tilt, spin_rad_s=[spin * tilt * 10, 0.0, 0.0])),
        contact=dict(friction_coefficient=0.8, interior_points=0),
        integration=dict(duration_s=0.6, dt_s=1e-3),
        observed="up",
    )
    top = rows["u_top"][:, :2] - rows["interface/joint: up on " + below + "/slide"]
    ahead = np.unwrap(np.arctan2(top[:, 1], top[:, 0])) - rows["twist"]
    rolled = radius * np.abs(np.diff(ahead))
    force = rows["interface/joint: up on " + below + "/force"]
    lost = resistance * np.sum(rolled * (force[1:] + force[:-1]) / 2)
    assert rolled.sum() > radius
    assert rows["energy/rolling"][-1] == pytest.approx(-lost, rel=0.01)
    assert summary["energy_closure_rel"] < 1e-6


def test_laws_that_exclude_one_another_are_refused_by_name():
    tables = dict(
        bodies=dict(block=BLOCK),
        joints=dict(foot=dict(between=["block", "soil"], restitution=0.5)),
        grounds=dict(soil=dict(kind="pad", stiffness_n_m3=SUBGRADE)),
    )
    with pytest.raises(InputError, match=r"joints.foot.restitution = 0.5.*must be 0 on a pad"):
        structure(**tables)
    with pytest.raises(InputError, match=r"grounds.soil.stiffness_n_m3.*greater than 0 N/m3"):
        structure(**tables | dict(grounds=dict(soil=dict(kind="pad"))))
    rock = dict(tables["grounds"], rock=dict(level_m=1.0))
    with pytest.raises(InputError, match=r"grounds.rock.*nothing stands on it"):
        structure(**tables | dict(grounds=rock))
