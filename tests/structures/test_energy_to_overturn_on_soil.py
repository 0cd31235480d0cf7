"""Bodies that lean slowly on soil and pads: energy and tilt at which they are lost, refusals."""

from __future__ import annotations

import h5py
import numpy as np
import pytest
from small_structures import STONE, structure

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.overturning import barrier, stance
from fecolumn.foundation.schema import InputError
from fecolumn.simulation import run
from fecolumn.structures.foot_on_springs import FootOnSprings
from fecolumn.structures.structure import structure_model

SIDE, HEIGHT, MASS = 0.4, 1.2, 1500.0
BLOCK = dict(kind="block", length_m=SIDE, width_m=SIDE, height_m=HEIGHT, mass_kg=MASS)


def on_springs(stiffness: float, count: int = 80) -> FootOnSprings:
    """A block on count x count springs of a stiffness per area [N/m3]."""
    places = SIDE * ((np.arange(count) + 0.5) / count - 0.5)
    x, y = np.meshgrid(places, places)
    arms = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, -HEIGHT / 2)])
    half = SIDE / 2
    corners = np.array([[sx * half, sy * half, -HEIGHT / 2] for sx in (-1, 1) for sy in (-1, 1)])
    foot = stance(corners, np.eye(3), MASS * GRAVITY, 0.5, 0.0)
    return FootOnSprings(foot, arms, np.full(x.size, stiffness * SIDE**2 / x.size))


def test_on_stiff_springs_it_is_that_of_rigid_ground():
    half = SIDE / 2 * (1 - 1 / 80)  # the outermost springs
    corners = np.array([[x, y, -HEIGHT / 2] for x in (-half, half) for y in (-half, half)])
    foot, soft = stance(corners, np.eye(3), MASS * GRAVITY, 0.5, 0.0), on_springs(1e12)
    assert soft.critical == pytest.approx(foot.critical, rel=0.01)
    assert soft.barrier == pytest.approx(barrier(foot), rel=1e-3)


@pytest.mark.parametrize("stiffness", [1e7, 2e7, 1e8])
def test_the_least_moment_is_where_the_springs_and_the_weight_turn_it_no_more(stiffness):
    """The foot touches over a length c from its edge: k w c^2 tan(t) / 2 = W, and the weight stands
    over the springs' resultant, a third of c from the edge, at the critical tilt.
    """
    found = on_springs(stiffness)
    tangent = np.tan(found.critical)
    touches = np.sqrt(2 * MASS * GRAVITY / (stiffness * SIDE * tangent))
    assert touches < SIDE
    # along the foot; the resultant acts across it, with little friction's help, along the weight
    assert SIDE / 2 - touches / 3 == pytest.approx(HEIGHT / 2 * tangent, rel=0.03)
    assert found.sinks == pytest.approx(MASS * GRAVITY / (stiffness * SIDE**2))
    whole = stiffness * SIDE**4 / 12 / (MASS * GRAVITY * HEIGHT / 2)
    assert found.holds == pytest.approx(whole, rel=1e-3)


def on_soil(stiffness: float, **tables):
    return structure(
        bodies=dict(block=BLOCK),
        grounds=dict(soil=dict(kind="pad", stiffness_n_m3=stiffness, damping_ratio=0.0)),
        joints=dict(foot=dict(between=["block", "soil"], friction_coefficient=5.0)),
        contact=dict(interior_points=60),
        **tables,
    )


@pytest.mark.long
@pytest.mark.parametrize("share, outcome", [(0.95, "still rocking"), (1.1, "overturned")])
def test_a_spin_of_more_than_that_energy_overturns_a_block_on_soil(share, outcome, tmp_path):
    def spun(spin: float, seconds: float):
        return on_soil(
            1e7,
            integration=dict(engine="rigid", dt_s=1e-3, duration_s=seconds),
            initial=dict(block=dict(spin_rad_s=[0.0, spin, 0.0])),
        )

    trial = run(spun(0.1, 2e-3), tmp_path / "trial", quiet=True)
    with h5py.File(tmp_path / "trial" / "history.h5") as file:
        kinetic = float(file["energy/kinetic"][0])
    spin = 0.1 * np.sqrt(share * trial["energy_to_overturn_j"] / kinetic)
    made = spun(float(spin), 3.0)
    summary = run(made, tmp_path / "run", quiet=True)
    assert summary["outcome"] == outcome
    assert summary["critical_tilt_rad"] < 0.75 * np.arctan(SIDE / HEIGHT)


@pytest.mark.parametrize(
    "stiffness, said",
    [
        (3e6, r'grounds.soil.stiffness_n_m3 = 3000000.0.*"block" with what stands on it would tip'),
        (1e4, r"would sink by 9.19 m, more than its height of 1.2 m"),
        (1e-3, r"would sink by"),
    ],
)
def test_soil_on_which_nothing_can_stand_is_refused_in_a_line(stiffness, said):
    with pytest.raises(InputError, match=said) as caught:
        structure_model(on_soil(stiffness), "small.toml")
    assert "\n" not in str(caught.value)


@pytest.mark.long
def test_rest_waits_for_what_still_falls_beside_a_large_body(tmp_path):
    vase = STONE | dict(kind="block", length_m=0.06, width_m=0.06, height_m=0.2)
    times = "\n".join(f"{0.01 * n:.2f},0.0" for n in range(20))
    (tmp_path / "still.csv").write_text("time_s,ax_m_s2\n" + times + "\n")
    made = structure(
        bodies=dict(
            large=STONE | dict(kind="block", length_m=1.0, width_m=1.0, height_m=1.0),
            vase=vase | dict(at_m=[2.0, 0.0, 0.3]),
        ),
        joints=dict(
            l=dict(between=["large", "ground"]),
            v=dict(between=["vase", "ground"]),
        ),
        motion=dict(source=str(tmp_path / "still.csv"), free_vibration_s="rest"),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=0.0),
    )
    summary = run(made, tmp_path / "run", quiet=True)
    with h5py.File(tmp_path / "run" / "history.h5") as file:
        assert file["body/vase/displacement"][-1, 2] == pytest.approx(-0.3, abs=1e-6)
    assert summary["outcome"] == "at rest" and summary["duration_s"] > np.sqrt(2 * 0.3 / GRAVITY)
