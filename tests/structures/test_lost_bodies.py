"""When bodies of a structure are lost: at their point of no return, and not before."""

import math

import numpy as np
import pytest
from small_structures import RIGID, STONE, frame, stack, structure

from fecolumn.simulation import run
from fecolumn.structures.lost import limits_of
from fecolumn.structures.structure import standing_of, structure_model


def limits(case):
    model = structure_model(case)
    found = limits_of(model, standing_of(case, model))
    return dict(zip([part.name for part in model.parts], found.standing)), found.tilts


def alone(length, height, tilt, engine="rigid", **initial):
    """One block on the ground, let go from a tilt."""
    body = dict(kind="block", length_m=length, width_m=length, height_m=height) | STONE
    return structure(
        bodies=dict(block=body | dict(element_size_m=min(length, height) / 2)),
        joints=dict(foot=dict(between=["block", "ground"])),
        initial=dict(block=dict(tilt_rad=tilt) | initial),
        integration=dict(engine=engine, dt_s=1e-3, duration_s=1.5),
        contact=dict(friction_coefficient=1.0, interior_points=0),
    )


@pytest.mark.parametrize("engine", ["rigid", "full"])
def test_a_body_wider_than_high_comes_back_from_beyond_45_degrees(engine, tmp_path):
    critical = math.atan2(1.0, 0.5)
    case = alone(1.0, 0.5, 0.9, engine).replace({"integration.duration_s": 0.3})
    summary = run(case, tmp_path, quiet=True)
    assert summary["critical_tilt_rad"] == pytest.approx(critical, rel=1e-6)
    assert not summary["overturned"] and summary["tilt_max_rad"] == pytest.approx(0.9, abs=0.01)


@pytest.mark.parametrize("engine", ["rigid", "full"])
@pytest.mark.parametrize("tilt, overturns", [(0.19, False), (0.205, True)])
def test_a_slender_body_is_followed_to_its_point_of_no_return_alone(
    engine, tilt, overturns, tmp_path
):
    """Nothing moves the ground: it is lost once it leans beyond its critical tilt and falls."""
    critical = math.atan2(0.2, 1.0)
    case = alone(0.2, 1.0, tilt, engine).replace({"integration.duration_s": 0.3})
    summary = run(case, tmp_path, quiet=True)
    assert summary["overturned"] == overturns
    if overturns:
        assert summary["tilt_max_rad"] < critical + 0.02
        assert '"block" has tilted by' in summary["ended_by"]
        assert f"critical {critical:.3g} rad" in summary["ended_by"]


def test_equal_columns_below_a_slab_are_lost_where_one_of_them_would_be(tmp_path):
    tables = frame(
        initial=dict(column=dict(tilt_rad=0.14)),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=2.0),
    )
    leans = structure(**tables)
    rows, tilts = limits(leans)
    alpha = math.atan2(0.2, 1.5)
    for name, row in rows.items():
        assert row["ground"] == name.startswith("column")
    assert rows["column 1"]["critical"] == pytest.approx(alpha, rel=0.02) and np.isinf(tilts).all()
    summary = run(leans, tmp_path, quiet=True)
    found = summary["bodies"]["column 1"]["tilt_max_rad"]
    assert summary["overturned"] and alpha < found < alpha + 0.02


def test_a_block_of_a_stack_is_judged_by_its_tilt_from_what_it_stands_on():
    rows, tilts = limits(structure(**stack()))
    assert (rows["lower"]["below"], rows["upper"]["below"]) == (-1, 0)
    assert rows["upper"]["critical"] == pytest.approx(math.atan2(0.4, 0.6), rel=1e-6)
    assert not rows["upper"]["ground"] and not rows["lower"]["ground"] and np.isinf(tilts).all()


def test_a_tendon_decides_whether_a_body_comes_back():
    """It is lost at its critical tilt and the angle of friction; wider than high, on its side."""
    tendon = dict(kind="tendon", body="block", to="ground", stiffness_n_m=1e5)
    for length, height in ((0.2, 1.0), (1.0, 0.5)):
        held = dict(tendon, point_m=[0.0, 0.0, height], to_point_m=[0.0, 0.0, 0.0])
        case = alone(length, height, 0.0)
        rows, tilts = limits(case.replace({f"links.held.{key}": one for key, one in held.items()}))
        most = math.pi / 2 if length > height else math.atan2(length, height) + math.pi / 4
        assert tilts[0] == pytest.approx(most) and np.isinf(rows["block"]["critical"])


def test_the_upper_of_two_blocks_ends_the_analysis_when_it_tips_off(tmp_path):
    """It is pushed over on the lower one, which stays: friction of 0.6 holds no block that leans by
    its critical tilt and 31 degrees.
    """
    case = structure(
        **stack(
            bodies=dict(upper=dict(length_m=0.1, width_m=0.1) | RIGID),
            initial=dict(upper=dict(tilt_rad=0.2)),
            contact=dict(friction_coefficient=0.6, interior_points=0),
            integration=dict(engine="rigid", dt_s=1e-3, duration_s=3.0),
        )
    )
    summary = run(case, tmp_path, quiet=True)
    critical = math.atan2(0.1, 0.6)
    assert summary["overturned"] and summary["ended_by"].startswith('point of no return: "upper"')
    assert summary["tilt_max_rad"] == pytest.approx(critical + math.atan(0.6), abs=0.03)


def test_a_tendon_pulls_a_wide_block_back_from_beyond_its_critical_tilt(tmp_path):
    """4800 N/m at 0.5 m from the edge over which a block of 12 kN leans by 83.7 degrees."""
    case = alone(1.0, 0.5, 1.46).replace(
        {
            "bodies.block.density_kg_m3": 2500.0,
            "contact.friction_coefficient": 0.35,
            "links.tendon.kind": "tendon",
            "links.tendon.body": "block",
            "links.tendon.to": "ground",
            "links.tendon.point_m": [-0.5, 0.0, 0.5],
            "links.tendon.to_point_m": [-0.5, 0.0, 0.0],
            "links.tendon.stiffness_n_m": 4800.0,
            "integration.duration_s": 4.0,
        }
    )
    summary = run(case, tmp_path, quiet=True)
    assert not summary["overturned"] and summary["energy_closure_rel"] < 1e-12
    assert summary["outcome"] == "at rest"


def test_a_wide_slab_beside_another_body_is_not_lost_while_it_may_fall_back(tmp_path):
    """It leans by 74 degrees, beyond its critical tilt and the angle of friction, and falls back
    onto its foot, as it does without the post.
    """
    slab = dict(kind="block", length_m=1.0, width_m=1.0, height_m=0.6, element_size_m=0.3) | STONE
    joints = dict(foot=["slab", "ground"], other=["post", "ground"], side=["post", "slab"])
    case = structure(
        bodies=dict(slab=slab, post=slab | dict(height_m=0.5, at_m=[-1.2, 0.0, 0.0])),
        joints={name: dict(between=between) for name, between in joints.items()},
        initial=dict(slab=dict(tilt_rad=1.3, spin_rad_s=[0.0, -4.0, 0.0])),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=1.5),
        contact=dict(friction_coefficient=0.25, interior_points=0),
    )
    summary = run(case, tmp_path, quiet=True)
    assert not summary["overturned"] and summary["duration_s"] == pytest.approx(1.5)
    assert summary["bodies"]["slab"]["tilt_max_rad"] == pytest.approx(1.3, abs=0.01)


def test_the_direction_of_the_fall_is_that_of_the_body_that_fell(tmp_path):
    """The observed body is the higher one, which leans towards y and stands."""
    body = dict(kind="block", length_m=0.2, width_m=0.2, element_size_m=0.2) | STONE
    case = structure(
        bodies=dict(
            high=body | dict(height_m=0.8), low=body | dict(height_m=0.6, at_m=[2.0, 0.0, 0.0])
        ),
        joints=dict(one=dict(between=["high", "ground"]), other=dict(between=["low", "ground"])),
        initial=dict(
            low=dict(tilt_rad=0.5, direction_deg=180.0),
            high=dict(tilt_rad=0.05, direction_deg=90.0),
        ),
        integration=dict(engine="rigid", dt_s=1e-3, duration_s=1.0),
        contact=dict(interior_points=0),
    )
    summary = run(case, tmp_path, quiet=True)
    assert '"low" has tilted' in summary["ended_by"]
    assert abs(summary["overturn_direction_deg"]) == pytest.approx(180.0, abs=0.1)


def test_what_a_bond_or_a_held_slab_holds_is_followed_beyond_its_critical_tilt():
    bond = dict(bond_tension_pa=5e4, bond_cohesion_pa=5e4, bond_stiffness_n_m3=4e6)
    glued = alone(0.2, 1.0, 0.0).replace({f"joints.foot.{key}": v for key, v in bond.items()})
    rows, tilts = limits(glued)
    steepest = math.atan2(0.2, 1.0) + math.pi / 4
    assert tilts[0] == pytest.approx(steepest) and np.isinf(rows["block"]["critical"])
    tendon = dict(kind="tendon", body="slab", to="ground", stiffness_n_m=1e6)
    tendon |= dict(point_m=[0.0, 0.0, 0.15], to_point_m=[0.0, 0.0, -2.5])
    rows, tilts = limits(structure(**frame(), links=dict(tendon=tendon)))
    assert np.isfinite(tilts).all()
    assert all(np.isinf(row["critical"]) for row in rows.values())


def test_the_motion_to_come_bounds_the_push_on_the_edge_of_a_body_that_is_alone():
    """The force that tells whether an edge sticks is that of the ground on all bodies."""
    one = alone(0.2, 1.0, 0.0)
    other = one.tables(defaults=False)["bodies"]["block"] | dict(at_m=[2.0, 0.0, 0.0])
    joint = {"joints.other": dict(between=["other", "ground"])}
    for fixed, joints in ((False, joint), (True, {})):
        both = one.replace({"bodies.other": other | dict(fixed=fixed)} | joints)
        assert limits(both)[0]["block"]["ground"] == fixed
    assert limits(one)[0]["block"]["ground"]
