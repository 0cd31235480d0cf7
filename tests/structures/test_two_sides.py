"""Joints of equal faces: bodies pivot on the outline of the region where both faces overlap, in
every engine, whichever body is named first.
"""

import numpy as np
import pytest

from fecolumn.case.case import case_from_tables
from fecolumn.contact.tolerances import SAME_OUTLINE
from fecolumn.engines.reduced.observe import PER_BODY, WIDTH
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.simulation import run
from fecolumn.structures.structure import structure_model
from fecolumn.verification.joint_bodies import arms, region, rocked_block, rocks, two
from fecolumn.verification.joints import displaced as errors_of
from fecolumn.verification.multi_drum import drum_case, drum_pulse


@pytest.mark.parametrize("displaced", [0.0, 1e-12, -1e-9, 1e-6, -1e-6, 1e-3, 1e-2, -1e-2])
def test_a_displaced_block_rocks_as_its_closed_form_says(displaced):
    """The arm is that of the nearer edge of either block; the upper one fell over where it was
    displaced by a nanometre.
    """
    assert np.abs(errors_of("rigid", displaced)).max() < 1e-4


@pytest.mark.long
@pytest.mark.parametrize(
    "angle, displaced, corners",
    [
        (0.0, (0.0, 0.0), 4),
        (5.0, (0.0, 0.0), 8),
        (45.0, (0.0, 0.0), 8),
        (0.0, (1e-6, 1e-6), 4),
        (5.0, (0.02, 0.013), 6),
    ],
)
def test_a_standing_block_has_points_on_all_corners_of_the_region(angle, displaced, corners):
    made = two("rigid", dict(turned_deg=angle, at_m=[*displaced, 0.1]))
    exact = region(angle, displaced)
    taking = np.flatnonzero((made.work.points["interface"] > 0) & ~made.work.points["idle"])
    bodies = np.where(made.work.points["slave"][taking] == 1, 1, 0)
    places = np.array(
        [
            made.motion.frames["center"][b] + made.motion.rotation[b] @ arm
            for b, arm in zip(bodies, made.work.points["arm"][taking])
        ]
    )[:, :2]
    apart = np.linalg.norm(places[None] - (exact + displaced)[:, None], axis=2).min(axis=1)
    assert len(exact) == corners and apart.max() < 1e-8


@pytest.mark.parametrize("share", [0.4, 0.5, 0.6, 0.999999, 1.0, 1.000001, 1.5])
@pytest.mark.parametrize("turned", [0.0, 90.0, 180.0])
def test_no_corner_is_lost_where_a_face_sticks_out_by_what_counts_as_the_same_outline(
    share, turned
):
    """Stones of one element, 1 m long: a corner that rounding lost left the upper one on three."""
    stone = dict(
        kind="block",
        length_m=1.0,
        width_m=1.0,
        height_m=1.0,
        element_size_m=1.0,
        turned_deg=turned,
        density_kg_m3=2700.0,
    )
    displaced = share * SAME_OUTLINE
    case = case_from_tables(
        dict(
            bodies=dict(low=stone, up=stone | dict(at_m=[displaced, 0.0, 1.0])),
            contact=dict(interior_points=0),
            joints=dict(feet=dict(between=["low", "ground"]), joint=dict(between=["low", "up"])),
            integration=dict(engine="rigid", dt_s=1e-3, duration_s=1.0),
        ),
        "two.toml",
    )
    made = engine_of(case, structure_model(case), "two.toml")
    joint = made.work.points["interface"] > 0
    carried = made.motion.contact["force"][joint, 2]
    assert carried[carried > 0] == pytest.approx([2700 * 9.80665 / 4] * 4, rel=1e-3)


@pytest.mark.long
@pytest.mark.parametrize(
    "dt, below, above",
    [
        (1e-4, dict(fixed=True), dict(turned_deg=5.0)),
        (1e-5, dict(fixed=True), dict(turned_deg=30.0)),
        (1e-3, dict(height_m=0.8), dict(at_m=[0.12, 0.0, 0.8])),
        (1e-4, dict(height_m=0.8), dict(at_m=[-0.13, 0.0, 0.8])),
    ],
)
def test_rigid_blocks_are_found_at_rest_whatever_the_step_and_where_they_stand(dt, below, above):
    equal = dict(density_kg_m3=2600.0)
    joints = dict(joint=dict(between=["low", "up"]))
    if "fixed" not in below:
        joints["feet"] = dict(between=["low", "ground"])
    made = two("rigid", equal | above, equal | below, dt=dt, joints=joints)
    on = (made.work.points["slave"] == 1) | (made.work.points["master"] == 1)
    weight = made.structure.bodies.body["mass"][1] * 9.80665
    assert made.motion.contact["force"][on, 2].sum() == pytest.approx(weight, rel=1e-6)


@pytest.mark.long
@pytest.mark.parametrize(
    "displaced, tilt",
    [
        (0.0, -0.011416),
        (1e-9, -0.011416),
        (1e-3, -0.011426),
        (-1e-3, -0.011542),
        (1e-2, -0.011525),
        (-1e-2, -0.012634),
    ],
)
def test_two_free_equal_blocks_move_as_an_independent_planar_program_says(displaced, tilt):
    """Let go from 0.05 rad, the upper block sets the lower one rocking, too; after their impact
    both turn as one. Tilt after 0.2 s by `benchmarks.planar` at 1e-4 s.
    """
    block = dict(
        kind="block",
        length_m=0.4,
        width_m=0.3,
        height_m=0.8,
        density_kg_m3=2700.0,
        youngs_modulus_pa=5e10,
        poissons_ratio=0.2,
    )
    case = case_from_tables(
        dict(
            bodies=dict(low=block, up=block | dict(at_m=[displaced, 0.0, 0.8])),
            contact=dict(friction_coefficient=0.7, interior_points=0),
            joints=dict(feet=dict(between=["low", "ground"]), joint=dict(between=["low", "up"])),
            initial=dict(up=dict(tilt_rad=0.05)),
            integration=dict(engine="rigid", dt_s=5e-4, duration_s=1.0),
        ),
        "two.toml",
    )
    made = engine_of(case, structure_model(case), "two.toml")
    made.advance(np.zeros((400, 3)))
    assert [np.arctan2(R[0, 2], R[2, 2]) for R in made.motion.rotation] == pytest.approx(
        [tilt] * 2, rel=3e-4
    )


def test_who_is_named_first_decides_nothing():
    rows = [
        two(
            "rigid",
            dict(at_m=[0.03, 0.01, 0.1]),
            joints=dict(feet=dict(between=["low", "ground"]), joint=dict(between=order)),
            initial=dict(up=dict(tilt_rad=0.05, direction_deg=20.0)),
        ).advance(np.zeros((400, 3)))[0]
        for order in (["low", "up"], ["up", "low"])
    ]
    assert np.array_equal(*rows)


@pytest.mark.long
@pytest.mark.parametrize("engine", ["rigid", "reduced"])
def test_a_block_that_slides_over_the_edges_of_another_keeps_its_energy(engine):
    """Shaken along both axes with little friction; points go from one body to the other and back,
    and none sinks.
    """
    made = two(
        engine,
        dict(length_m=0.44, width_m=0.28),
        contact=dict(friction_coefficient=0.2, interior_points=0),
    )
    time = 5e-4 * np.arange(1, 1001)
    rows, _ = made.advance(8.0 * np.sin(4 * np.pi * time)[:, None] * [1.0, 0.5, 0.0])
    assert np.abs(rows[:, WIDTH - 1]).max() < 1e-11 * np.abs(rows[:, 17]).max()
    assert rows[:, 12].max() < 1e-10 and np.abs(rows[:, WIDTH + PER_BODY]).max() > 0.01


@pytest.mark.long
@pytest.mark.parametrize("time, stands, falls", [(0.5, 0.25, 0.26), (1.0, 0.203, 0.207)])
def test_the_multi_drum_column_overturns_where_three_other_programs_say(
    tmp_path, time, stands, falls
):
    """UDEC .27 and .20, HybriDFEM .25 and .21, LMGC90 .25 and .21 g; an independent planar program
    .253 and .205.
    """
    case = drum_case(tmp_path)
    model = structure_model(case)
    for level, overturns in ((stands, False), (falls, True)):
        assert (
            engine_of(case, model, "drums.toml").advance(drum_pulse(level, time, 7.0 - 3 * time))[1]
            == overturns
        )


@pytest.mark.long
@pytest.mark.parametrize("displaced", [0.0, 1e-6, -1e-2, 1e-2])
def test_the_full_order_pivots_where_the_region_ends(tmp_path, displaced):
    """Until the first impact; the block's own bending lets it swing a little slower than a rigid
    one.
    """
    block = dict(
        kind="block",
        length_m=0.4,
        width_m=0.3,
        element_size_m=0.1,
        youngs_modulus_pa=5e10,
        poissons_ratio=0.2,
    )
    tables = dict(
        bodies=dict(
            low=block | dict(height_m=0.1, density_kg_m3=1e5),
            up=block | dict(height_m=0.8, density_kg_m3=100.0, at_m=[displaced, 0.0, 0.1]),
        ),
        contact=dict(friction_coefficient=0.8, interior_points=0),
        joints=dict(feet=dict(between=["low", "ground"]), joint=dict(between=["low", "up"])),
        initial=dict(up=dict(tilt_rad=0.05)),
        integration=dict(engine="full", dt_s=1e-3, duration_s=0.1),
    )
    summary = run(case_from_tables(tables, "two.toml"), tmp_path / "run", quiet=True)
    import h5py

    with h5py.File(tmp_path / "run" / "history.h5") as file:
        tilt = file["body/up/tilt"][()]
    exact = rocks(*arms(displaced)).of(0.1)[0]
    assert tilt[-1] == pytest.approx(exact, rel=2e-3) and summary["energy_closure_rel"] < 1e-9


@pytest.mark.parametrize("friction, displaced", [(1.5, 1e-3), (2.0, 1e-6), (3.0, 1e-3)])
def test_a_light_stone_rests_on_a_heavy_one_that_spreads_below_it(friction, displaced):
    """All points of their joint slide while they come to rest; the iteration went to and fro where
    friction was of its whole way.
    """
    soft = dict(youngs_modulus_pa=5e10)
    made = two(
        "reduced",
        soft | dict(turned_deg=45.0, at_m=[displaced, displaced, 0.1]),
        soft,
        contact=dict(friction_coefficient=friction, interior_points=0),
    )
    centers = made.motion.frames["center"].copy()
    made.advance(np.zeros((200, 3)))
    assert np.abs(made.motion.frames["center"] - centers).max() < 1e-10


@pytest.mark.parametrize("displaced", [0.0, 1e-2])
def test_a_landing_in_a_part_of_a_step_is_plastic(displaced):
    """Tilt at 0.2 s: in a sixty-fourth of a step bodies gave four times what they moved, and the
    block jumped off with 0.4 of its approach.
    """
    made = two(
        "rigid",
        dict(at_m=[displaced, 0.0, 0.1]),
        initial=dict(up=dict(tilt_rad=0.05)),
        integration=dict(engine="rigid", dt_s=5e-4, duration_s=1.0, substeps="impacts"),
    )
    assert abs(rocked_block(made, rocks(*arms(displaced)), 0.0)[3]) < 1e-5
