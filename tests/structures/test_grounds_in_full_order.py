"""Grounds and laws of joints with all degrees of freedom of the bodies, against the closed forms
that rigid bodies have: marble on soil hardly deforms.
"""

import numpy as np
import pytest
from small_grounds import BLOCK as RIGID_BLOCK
from small_grounds import (
    HEIGHT,
    MASS,
    SETTLED,
    SIDE,
    SUBGRADE,
    VERTICAL,
    WEIGHT,
    bridge,
    frequency,
    wave,
)
from small_grounds import analysed as analysed_by

from fecolumn.case.sections import GRAVITY
from fecolumn.foundation.toml_file import merge

BLOCK = RIGID_BLOCK | dict(rigid=False, element_size_m=0.3)
SOFT = dict(youngs_modulus_pa=5e7, poissons_ratio=0.3, thickness_m=0.6, element_size_m=0.15)


def analysed(folder, **tables):
    full = dict(integration=dict(engine="full"))
    return analysed_by(folder, **merge(full, tables))


def on_pad(folder, soil=None, **tables):
    stands = dict(
        bodies=dict(block=BLOCK),
        joints=dict(foot=dict(between=["block", "soil"])),
        grounds=dict(soil=dict(kind="pad", stiffness_n_m3=SUBGRADE) | (soil or {})),
    )
    return analysed(folder, **merge(stands, tables))


def test_a_block_settles_on_a_pad_and_bounces_at_its_frequency(tmp_path):
    _, rows = on_pad(
        tmp_path / "run",
        soil=dict(damping_ratio=0.05),
        initial=dict(block=dict(velocity_m_s=[0.0, 0.0, -0.01])),
        integration=dict(duration_s=0.2),
    )
    rise = rows["interface/foot: block on soil/rise"]
    assert rise[0] == pytest.approx(-SETTLED, rel=1e-3)
    times, w = rows["time"], VERTICAL * np.sqrt(1 - 0.05**2)
    exact = -0.01 / w * np.exp(-0.05 * VERTICAL * times) * np.sin(w * times)
    assert np.abs(rise - rise[0] - exact).max() < 1e-2 * np.abs(exact).max()


def test_a_pulled_block_rests_leaning_on_its_pad(tmp_path):
    """The pull's moment is held by the springs less that of the weight, which has moved out; half
    of the latter was missing at the start, and the block rocked about where it should have stood.
    """
    pull, middle = 1000.0, HEIGHT / 2
    _, rows = on_pad(
        tmp_path / "run",
        links=dict(
            rope=dict(kind="tendon", body="block", to="soil", point_m=[0, 0, middle])
            | dict(to_point_m=[50.0, 0, middle], stiffness_n_m=1.0, prestress_n=pull)
        ),
        integration=dict(duration_s=0.1),
    )
    tilt = rows["body/block/rotation"][:, 1]
    exact = pull * middle / (SUBGRADE * SIDE**4 / 12 - WEIGHT * middle)
    assert tilt[0] == pytest.approx(exact, rel=5e-3)
    assert np.ptp(tilt) < 1e-5 * exact


def test_a_body_on_soil_that_a_firm_bar_holds_rests_as_its_springs_bear(tmp_path):
    """The bar makes the steps to rest short, and the soil leaves the body to sway between them."""
    high = 0.9 * HEIGHT
    _, rows = on_pad(
        tmp_path / "run",
        links=dict(
            bar=dict(
                kind="spring",
                body="block",
                point_m=[0.0, 0.0, high],
                to="soil",
                to_point_m=[-2.0, 0.0, high],
                stiffness_n_m=20 * SUBGRADE * SIDE**2,
            )
        ),
        integration=dict(duration_s=0.02),
    )
    assert rows["interface/foot: block on soil/rise"] == pytest.approx(-SETTLED, rel=1e-3)
    assert np.abs(rows["link/bar/tension"]).max() < 1e-4 * WEIGHT
    assert rows["energy/kinetic"].max() < 1e-12 * WEIGHT * SETTLED


@pytest.mark.long
def test_a_pad_that_yields_bears_no_more_and_keeps_its_settlement(tmp_path):
    """As of the rigid engine: springs hold what they do at the yield force, the flow takes the
    rest.
    """
    bears, speed = 1.8 * WEIGHT, 0.3
    summary, rows = on_pad(
        tmp_path / "run",
        soil=dict(yield_pa=bears / SIDE**2),
        initial=dict(block=dict(velocity_m_s=[0.0, 0.0, -speed])),
        integration=dict(duration_s=0.6),
    )
    force, rise = (rows[f"interface/foot: block on soil/{name}"] for name in ("force", "rise"))
    assert force.max() == pytest.approx(bears, rel=1e-5)
    left = speed**2 - (VERTICAL * 0.8 * SETTLED) ** 2
    flow = MASS * left / 2 / (bears - WEIGHT)
    settled = (rise[-700:].max() + rise[-700:].min()) / 2
    assert settled == pytest.approx(-SETTLED - flow, rel=1e-2)
    assert summary["energy_j"]["damping"] == pytest.approx(-bears * flow, rel=1e-2)
    assert summary["energy_closure_rel"] < 1e-6


def test_a_pad_lies_between_two_bodies_as_well(tmp_path):
    _, rows = analysed(
        tmp_path / "run",
        bodies=dict(low=BLOCK, up=BLOCK | dict(at_m=[0, 0, HEIGHT])),
        joints=dict(
            foot=dict(between=["low", "ground"]),
            joint=dict(between=["up", "low"], stiffness_n_m3=SUBGRADE),
        ),
        initial=dict(up=dict(velocity_m_s=[0.0, 0.0, -0.005])),
        integration=dict(duration_s=0.2),
    )
    rise = rows["interface/joint: up on low/rise"]
    assert rise[0] == pytest.approx(-SETTLED, rel=1e-2)
    assert frequency(rows["time"], rise) == pytest.approx(VERTICAL, rel=5e-3)


@pytest.mark.filterwarnings("ignore:.*resolves the ground's own vibration")
@pytest.mark.parametrize("kind", ["unbounded", "plate"])
def test_two_blocks_settle_on_elastic_ground_as_rigid_ones(tmp_path, kind):
    ground = SOFT | dict(kind=kind)
    if kind == "plate":
        ground |= dict(length_m=3.0, width_m=1.8, coarse_size_m=0.3)
    found = []
    for name, engine, block in (("rigid", "rigid", RIGID_BLOCK), ("full", "full", BLOCK)):
        names = ("left", "right")
        _, rows = analysed(
            tmp_path / name,
            bodies={
                one: block | dict(at_m=[x, 0, 0], element_size_m=0.3)
                for one, x in zip(names, (-0.5, 0.5))
            },
            joints={one: dict(between=[one, "soil"]) for one in names},
            grounds=dict(soil=ground),
            integration=dict(duration_s=1e-3, dt_s=1e-3, engine=engine),
        )
        found.append([rows[f"interface/{one}: {one} on soil/rise"][0] for one in names])
    assert found[0][0] < -1e-5
    assert found[1] == pytest.approx(found[0], rel=2e-2)


@pytest.mark.filterwarnings("ignore:.*resolves the ground's own vibration")
def test_a_block_that_slides_over_the_edge_of_its_plate_is_told_by_name(tmp_path):
    summary, _ = analysed(
        tmp_path / "run",
        bodies=dict(block=BLOCK),
        joints=dict(foot=dict(between=["block", "slab"])),
        grounds=dict(slab=SOFT | dict(kind="plate", length_m=0.8, width_m=1.0)),
        initial=dict(block=dict(velocity_m_s=[1.0, 0, 0])),
        contact=dict(friction_coefficient=0.05),
        integration=dict(duration_s=0.4, dt_s=2e-3),
    )
    assert summary["slid_off"] and '"block"' in summary["ended_by"]
    way = 1.0 / (0.05 * GRAVITY) * (1 - np.sqrt(1 - 2 * 0.05 * GRAVITY * 0.1))
    assert summary["duration_s"] == pytest.approx(way, abs=0.02)


@pytest.fixture(scope="module")
def shaken(tmp_path_factory):
    return wave(tmp_path_factory.mktemp("motion"))


def test_a_bridge_on_unlike_supports_is_stretched_by_their_relative_displacement(tmp_path, shaken):
    file, times, displacement = shaken
    stiffness = 1e5
    summary, rows = analysed(tmp_path / "run", **bridge(file, BLOCK, stiffness))
    apart = np.interp(rows["time"], times, -1.5 * displacement)
    for link in ("deck", "anchor"):
        assert rows[f"link/{link}/tension"] == pytest.approx(
            stiffness * apart, abs=5e-3 * stiffness * np.abs(apart).max()
        )
    assert rows["body/right/displacement"][:, 0] == pytest.approx(apart, abs=4e-6)
    assert np.abs(rows["interface/right: right on hill/slide"]).max() < 4e-6
    assert np.abs(rows["body/left/displacement"][:, 0]).max() < 4e-6
    assert summary["energy_closure_rel"] < 1e-6
    assert abs(summary["energy_j"]["contact"]) < 1e-3 * MASS * 1e-4


@pytest.mark.long
def test_a_block_slides_on_a_ground_that_moves_by_itself_as_by_the_motion_of_all(tmp_path, shaken):
    """On the second ground, the first at rest, it does what it does on the only one."""
    motion = dict(source=str(shaken[0]), units="m/s2", free_vibration_s=0.1, scale=15.0)
    sliding = dict(
        contact=dict(friction_coefficient=0.1), integration=dict(duration_s=0.0, dt_s=1e-3)
    )
    _, alone = analysed(
        tmp_path / "alone",
        bodies=dict(block=BLOCK),
        joints=dict(foot=dict(between=["block", "ground"])),
        motion=motion,
        **sliding,
    )
    summary, rows = analysed(
        tmp_path / "two",
        bodies=dict(still=BLOCK | dict(at_m=[3.0, 0, 0]), block=BLOCK | dict(at_m=[0, 0, 0.5])),
        joints=dict(rest=dict(between=["still", "rock"]), foot=dict(between=["block", "table"])),
        grounds=dict(rock={}, table=dict(level_m=0.5, motion=motion)),
        motion=motion | dict(scale=0.0),
        **sliding,
    )
    slide = rows["interface/foot: block on table/slide"][:, 0]
    exact = alone["interface/foot: block on ground/slide"][:, 0]
    assert np.abs(exact).max() > 1e-3
    assert slide == pytest.approx(exact, abs=2e-3 * np.abs(exact).max())
    assert summary["energy_closure_rel"] < 1e-6
    assert rows["energy/friction"][-1] == pytest.approx(alone["energy/friction"][-1], rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("below", ["ground", "drum"])
def test_a_drum_loses_the_resistance_times_its_weight_per_length_rolled(tmp_path, below):
    """On the ground and on another drum, much heavier, wobbling steadily."""
    radius, tilt, resistance = 0.3, 0.05, 1e-3
    sizes = dict(kind="cylinder", element_size_m=0.15, density_kg_m3=2700.0)
    stone = dict(youngs_modulus_pa=5e10, poissons_ratio=0.2)
    small = dict(outer_diameter_m=2 * radius, height_m=0.6) | sizes | stone
    large = small | dict(outer_diameter_m=1.2, height_m=0.9, density_kg_m3=9e4)
    drums = dict(up=small | (dict(at_m=[0, 0, 0.9]) if below == "drum" else {}))
    joints = dict(joint=dict(between=["up", below], rolling_resistance=resistance))
    if below == "drum":
        drums["drum"] = large
        joints["foot"] = dict(between=["drum", "ground"])
    summary, rows = analysed(
        tmp_path / "run",
        bodies=drums,
        joints=joints,
        initial=dict(up=dict(tilt_rad=tilt, spin_rad_s=[20 * tilt, 0.0, 0.0])),
        contact=dict(friction_coefficient=0.8, interior_points=0),
        integration=dict(duration_s=0.3, dt_s=1e-3),
        observed="up",
    )
    top = rows["u_top"][:, :2] - rows["interface/joint: up on " + below + "/slide"]
    ahead = np.unwrap(np.arctan2(top[:, 1], top[:, 0])) - rows["twist"]
    rolled = radius * np.abs(np.diff(ahead))
    force = rows["interface/joint: up on " + below + "/force"]
    lost = resistance * np.sum(rolled * (force[1:] + force[:-1]) / 2)
    assert rolled.sum() > radius / 2
    assert rows["energy/rolling"][-1] == pytest.approx(-lost, rel=0.07)
    assert summary["energy_closure_rel"] < 1e-6
