"""Gravity equilibrium where proximal steps alone hardly move: reactions are those of statics."""

import numpy as np
import pytest
from small_structures import STONE, structure

from fecolumn.case.sections import GRAVITY
from fecolumn.contact.points import GROUND
from fecolumn.contact.pose import poses_of
from fecolumn.engines.dynamics.links import span
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.foundation._compiled import interpreted
from fecolumn.structures.structure import structure_model

# what is not balanced, over the weight (`tolerances.BALANCED`), and what it makes of reactions
EXACT = 1e-7
COARSE = dict(kind="block", element_size_m=0.1, modes=6)


def standing(**tables):
    """Engine of a structure in gravity equilibrium."""
    case = structure(contact=dict(interior_points=9), **tables)
    return engine_of(case, structure_model(case), "small.toml")


def force(engine, joint: int) -> np.ndarray:
    """Force (3,) of a joint on its slave [N] in the table frame."""
    motion, structure = engine.motion, engine.structure
    poses = poses_of(structure.interfaces, motion.frames["center"], motion.rotation, motion.grounds)
    own = engine.points["interface"] == joint
    return poses["frame"][joint] @ motion.contact["force"][own].sum(axis=0)


def carried(engine, joint: int) -> float:
    """What a joint carries [N]."""
    return abs(float(force(engine, joint)[2]))


def weights(engine) -> np.ndarray:
    """Of each body [N]."""
    return engine.structure.bodies.body["mass"] * GRAVITY


def heavy_on_light(engine: str, density: float, modulus: float):
    """A cube of lead of 1 m on a block of 0.3 m of so many kg/m3 and Pa."""
    light = COARSE | dict(length_m=0.3, width_m=0.3, height_m=0.3, density_kg_m3=density)
    cube = COARSE | dict(length_m=1.0, width_m=1.0, height_m=1.0, element_size_m=0.25)
    lead = dict(youngs_modulus_pa=16e9, poissons_ratio=0.4, density_kg_m3=11340.0)
    return standing(
        bodies=dict(
            light=light | dict(youngs_modulus_pa=modulus, poissons_ratio=0.2),
            heavy=cube | lead | dict(at_m=[0, 0, 0.3]),
        ),
        joints=dict(foot=dict(between=["light", "ground"]), top=dict(between=["light", "heavy"])),
        integration=dict(engine=engine, dt_s=5e-4),
    )


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:.*density_kg_m3")
@pytest.mark.parametrize(
    "engine, density, modulus",
    [("rigid", 400.0, 1e9), ("rigid", 0.4, 1e9), ("reduced", 20.0, 1e8), ("reduced", 0.4, 2e10)],
)
def test_a_light_body_carries_a_heavy_one_up_to_a_million_times_its_mass(engine, density, modulus):
    made = heavy_on_light(engine, density, modulus)
    light, heavy = weights(made)
    assert carried(made, 0) == pytest.approx(light + heavy, rel=EXACT)
    assert carried(made, 1) == pytest.approx(heavy, rel=EXACT)
    # and it stays where it is: nothing is let go at the start
    rows, _ = made.advance(np.zeros((20, 3)))
    assert carried(made, 0) == pytest.approx(light + heavy, rel=1e-5)


def test_a_tendon_between_a_post_on_a_pad_and_a_lintel_is_in_balance():
    """Of each body the forces of joints and of the tendon, which has lost some of its prestress to
    the pad, hold the weight.
    """
    post = COARSE | STONE | dict(length_m=0.3, width_m=0.5, height_m=1.2)
    made = standing(
        bodies=dict(
            left=post | dict(at_m=[-0.5, 0, -0.4]),
            right=post | dict(height_m=0.8, at_m=[0.5, 0, 0]),
            lintel=COARSE
            | STONE
            | dict(length_m=1.4, width_m=0.5, height_m=0.15, at_m=[0, 0, 0.8]),
        ),
        grounds=dict(
            lower=dict(
                level_m=-0.4, kind="pad", stiffness_n_m3=5e8, yield_pa=6e4, damping_ratio=0.2
            ),
            upper=dict(kind="rigid"),
        ),
        joints=dict(
            l=dict(between=["left", "lower"]),
            r=dict(between=["right", "upper"]),
            heads=dict(between=["left", "lintel"], stiffness_n_m3=1e9),
            other=dict(between=["right", "lintel"]),
        ),
        links=dict(
            t=dict(
                kind="tendon",
                body="left",
                point_m=[0, 0.2, 0.6],
                to="lintel",
                to_point_m=[0, 0.2, 1.3],
                stiffness_n_m=1e6,
                prestress_n=500.0,
            )
        ),
        integration=dict(engine="reduced", dt_s=5e-4),
    )
    left, right, lintel = weights(made)
    (tie,), way = made.motion.ties, np.empty(3)
    length = interpreted(span)(made.structure, 0, made.motion, way)
    pull = way * tie["force"] / length
    assert 400.0 < tie["force"] < 500.0
    on = np.zeros((3, 3))
    for k, joint in enumerate(made.structure.interfaces):
        for b, sign in ((joint["slave"], 1.0), (joint["master"], -1.0)):
            if b != GROUND:
                on[b] += sign * force(made, k)
    balance = on + np.outer([1.0, 0.0, -1.0], pull)
    balance[:, 2] -= [left, right, lintel]
    np.testing.assert_allclose(balance, 0.0, atol=EXACT * (left + right + lintel))
    feet = carried(made, 0) + carried(made, 1)
    assert feet == pytest.approx(left + right + lintel, rel=EXACT)


@pytest.mark.long
@pytest.mark.parametrize("modulus, layer", [(1e9, 1e10), (2e7, 1e10), (5e7, 1e11)])
def test_a_soft_post_stands_on_stiff_glue(modulus, layer):
    """Pressure goes through the contact, whatever the glue: it carries both weights, and the post
    becomes shorter by its own weight's half and the cap's on E A / h.
    """
    soft = dict(youngs_modulus_pa=modulus, poissons_ratio=0.0, density_kg_m3=500.0)
    made = standing(
        bodies=dict(
            post=COARSE | soft | dict(length_m=0.3, width_m=0.3, height_m=1.5),
            cap=COARSE | STONE | dict(length_m=0.4, width_m=0.4, height_m=0.4, at_m=[0, 0, 1.5]),
        ),
        joints=dict(
            foot=dict(between=["post", "ground"], bond_tension_pa=1e6, bond_stiffness_n_m3=layer),
            top=dict(between=["post", "cap"]),
        ),
        integration=dict(engine="reduced", dt_s=2e-5),
    )
    post, cap = weights(made)
    assert carried(made, 0) == pytest.approx(post + cap, rel=1e-5)
    assert carried(made, 1) == pytest.approx(cap, rel=EXACT)
    sunk = -(made.motion.frames["center"] - made.view.center)[1, 2]
    assert sunk == pytest.approx((cap + post / 2) * 1.5 / (modulus * 0.09), rel=0.05)


SECTIONS = dict(
    tube=dict(kind="tube", outer_diameter_m=0.5, wall_m=0.03),
    drum=dict(kind="cylinder", outer_diameter_m=0.5),
    block=dict(kind="block", length_m=0.4, width_m=0.3),
)


@pytest.mark.long
@pytest.mark.parametrize("layer, interior", [(1e10, 0), (1e10, 9), (3e12, 9)])
@pytest.mark.parametrize("section", SECTIONS)
def test_stone_stands_on_stone_and_a_thin_layer_of_glue(section, layer, interior):
    """3e12 N/m3 is a millimetre of epoxy; the foot slides a little as the weight spreads it."""
    body = SECTIONS[section] | STONE | dict(height_m=0.6, element_size_m=0.1)
    case = structure(
        bodies=dict(low=body, up=body | dict(at_m=[0, 0, 0.6])),
        joints=dict(
            foot=dict(between=["low", "ground"]),
            glue=dict(between=["low", "up"], bond_tension_pa=1e6, bond_stiffness_n_m3=layer),
        ),
        contact=dict(interior_points=interior),
        integration=dict(engine="reduced", dt_s=2e-6),
    )
    made = engine_of(case, structure_model(case), "small.toml")
    low, up = weights(made)
    assert carried(made, 0) == pytest.approx(low + up, rel=2e-4)


@pytest.mark.parametrize("engine", ["reduced", "rigid"])
@pytest.mark.parametrize("aside", [(0.1, 0.0), (0.0, 0.1), (0.1, 0.1), (0.1003, 0.05)])
def test_a_block_that_overhangs_an_equal_one_by_whole_elements_rests(engine, aside):
    """Nodes inside the upper face lie on edges of the lower one, which has its own points there."""
    body = STONE | dict(kind="block", length_m=0.4, width_m=0.3, height_m=0.4, element_size_m=0.1)
    made = standing(
        bodies=dict(low=body, up=body | dict(at_m=[*aside, 0.4])),
        joints=dict(
            foot=dict(between=["low", "ground"]),
            top=dict(between=["low", "up"], friction_coefficient=0.5),
        ),
        integration=dict(engine=engine, dt_s=1e-3),
    )
    low, up = weights(made)
    assert carried(made, 0) == pytest.approx(low + up, rel=EXACT)


def test_points_far_beyond_the_outline_of_what_is_known_only_along_its_edges_touch_nothing():
    """A pad below outline points alone, a quarter of which overhang: the middle of the face below
    has no nodes in the contact, and it is not asked for them.
    """
    body = STONE | dict(kind="block", length_m=0.4, width_m=0.3, height_m=0.4)
    case = structure(
        bodies=dict(low=body, up=body | dict(at_m=[0.1, 0, 0.4])),
        joints=dict(
            foot=dict(between=["low", "ground"]),
            pad=dict(between=["low", "up"], stiffness_n_m3=1e9),
        ),
        contact=dict(interior_points=0),
        integration=dict(engine="rigid", dt_s=1e-3),
    )
    with pytest.warns(UserWarning, match="joints.pad: the 20 contact points"):
        made = engine_of(case, structure_model(case), "small.toml")
    assert force(made, 1)[2] == pytest.approx(weights(made)[1], rel=EXACT)


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
def test_bodies_as_far_apart_as_they_may_be_placed_come_to_rest(engine):
    low = COARSE | STONE | dict(length_m=0.1, width_m=0.1, height_m=0.1)
    made = standing(
        bodies={name: low | dict(at_m=[x, x, 0.0]) for name, x in (("one", -1e4), ("other", 1e4))},
        joints={name: dict(between=[name, "ground"]) for name in ("one", "other")},
        integration=dict(engine=engine, dt_s=1e-3),
    )
    for joint, weight in enumerate(weights(made)):
        assert carried(made, joint) == pytest.approx(weight, rel=EXACT)


@pytest.mark.long
@pytest.mark.parametrize("body, stiffness", [("column", 1e8), ("column 1", 1e8), ("column 1", 1e9)])
def test_friction_dampers_that_slip_while_a_bent_settles_hold_their_slip_force(body, stiffness):
    """On soil that settles by millimetres stiff dampers slip all the way: with their force of
    slipping the soil carries all weights. One of them makes its column alone firm in the search.
    """
    column = dict(kind="cylinder", outer_diameter_m=1.2, height_m=6.0, element_size_m=0.3)
    made = standing(
        bodies=dict(
            column=column | dict(density_kg_m3=2500, copies_m=[[-3, 0, 0], [3, 0, 0]]),
            cap=COARSE
            | dict(length_m=8.5, width_m=1.6, height_m=1.2, element_size_m=0.4, at_m=[0, 0, 6])
            | dict(mass_kg=150e3),
        ),
        grounds=dict(soil=dict(kind="pad", stiffness_n_m3=1e8, damping_ratio=0.2)),
        joints=dict(
            feet=dict(between=["column", "soil"], friction_coefficient=0.7),
            heads=dict(between=["column", "cap"], friction_coefficient=0.7),
        ),
        links=dict(
            damper=dict(
                kind="friction",
                body=body,
                point_m=[0.5, 0, 0.5],
                to="soil",
                to_point_m=[1.5, 0, 0],
                slip_n=5e4,
                stiffness_n_m=stiffness,
            )
        ),
        integration=dict(engine="rigid", dt_s=1e-3),
    )
    soil, way = carried(made, 0) + carried(made, 1), np.empty(3)
    for number, tie in enumerate(made.motion.ties):
        length = interpreted(span)(made.structure, number, made.motion, way)
        # one alone may be unloaded after it has slipped: statics allow any force that friction does
        assert -5e4 <= tie["force"] < (-4.99e4 if body == "column" else 5e4)
        soil += tie["force"] * way[2] / length
    # of a search that was made twice a little more of the way of 8 mm is left
    exact = EXACT if body == "column" else 2 * EXACT
    assert soil == pytest.approx(weights(made).sum(), rel=exact)


@pytest.mark.parametrize("engine", ["rigid", "reduced"])
@pytest.mark.parametrize("dt_s", [2.5e-4, 2e-4, 1e-4])
def test_a_block_beside_a_spring_stands_at_any_step(engine, dt_s):
    """Short steps make what bodies give small, and contact is solved to a length: it went on by
    less than that in each iteration and was never at rest.
    """
    for friction, stiffness in ((0.02, 1e6), (0.1, 1e3), (0.3, 2e4), (0.5, 2e4)):
        made = standing(
            bodies=dict(
                block=COARSE
                | STONE
                | dict(length_m=1.0, width_m=0.8, height_m=0.4, density_kg_m3=625.0)
            ),
            joints=dict(foot=dict(between=["block", "ground"], friction_coefficient=friction)),
            links=dict(
                spring=dict(
                    kind="spring",
                    body="block",
                    point_m=[0.0, 0.0, 0.2],
                    to_point_m=[-1.5, 0.0, 0.2],
                    stiffness_n_m=stiffness,
                )
            ),
            integration=dict(engine=engine, dt_s=dt_s),
        )
        assert carried(made, 0) == pytest.approx(200 * GRAVITY, rel=EXACT)
