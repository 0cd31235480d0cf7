"""Bodies on domes and rounded edges roll, and those that are wider than what they stand on pivot on
the edge of that.
"""

import numpy as np
import pytest
from small_structures import STONE, block, structure

from fecolumn.case.sections import GRAVITY, Material
from fecolumn.contact.arrays import arrays_of
from fecolumn.contact.ball import from_center
from fecolumn.contact.interface import interface_of
from fecolumn.engines.reduced_engine import engine_of
from fecolumn.fem.rotation import rotation_matrix
from fecolumn.foundation._compiled import interpreted
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.jacobian import scaled_jacobian
from fecolumn.mesh.mass import mass_properties
from fecolumn.structures.barrier import stances
from fecolumn.structures.bodies import drawing
from fecolumn.structures.feet import hertz
from fecolumn.structures.standing import loads
from fecolumn.structures.structure import standing_of, structure_model
from fecolumn.verification.structures_feet import BLOCK as WIDE
from fecolumn.verification.structures_feet import (
    CLOSED,
    DRUM,
    TUBE,
    Rolling,
    alone_on_ground,
    closure_over_kinetic,
    columns_and_rows,
    falls,
    kept,
    narrower_case,
    passages,
)

RADIUS = 0.9
DOMED = WIDE | dict(foot_radius_m=RADIUS)


def _touches(radius, edge, turn):
    """Offset in the table frame from the centre of a ball to where a body turned by (3,) [rad]
    touches level ground.
    """
    interface, offset, rotation = (
        interface_of(np.zeros((1, 3))),
        np.zeros(3),
        rotation_matrix(np.array(turn)),
    )
    interface["ball"], interface["edge"] = radius, edge
    interpreted(from_center)(interface[0], rotation[2], offset)
    return rotation @ offset, offset


@pytest.mark.parametrize("edge", [(0.0, 0.0), (0.25, 0.0), (0.3, 0.2)])
@pytest.mark.parametrize(
    "turn", [(0, 0, 0.4), (0.1, 0, 0), (0, 0.6, 0.2), (0.5, 0.1, 0), (-0.5, 0.7, 1.0)]
)
def test_a_dome_touches_the_ground_with_its_lowest_point(edge, turn):
    """No other point of the ball within the edge is lower."""
    radius = 0.8
    found, own = _touches(radius, edge, turn)
    x, y = np.meshgrid(np.linspace(-1, 1, 201), np.linspace(-1, 1, 201))
    plan = np.column_stack([x.ravel(), y.ravel()]) * (
        edge[0] or radius,
        edge[1] or edge[0] or radius,
    )
    within = np.hypot(*plan.T) <= ((edge[0] or radius) if not edge[1] else np.inf)
    points = np.column_stack(
        [plan[within], -np.sqrt(np.maximum(radius**2 - (plan[within] ** 2).sum(axis=1), 0.0))]
    )
    lowest = (points @ rotation_matrix(np.array(turn)).T)[:, 2].min()
    assert found[2] <= lowest + 1e-12 and found[2] > lowest - 2e-3 * radius
    assert np.linalg.norm(own) == pytest.approx(radius, rel=1e-12)
    assert np.all(
        np.abs(own[:2]) <= (np.array([edge[0], edge[1] or edge[0]]) if edge[0] else radius) + 1e-12
    )


def test_small_swings_on_a_dome_have_the_closed_form():
    """w^2 = m g (rho - h) / (I + m h^2), and nothing is lost in three periods."""
    case = alone_on_ground(DOMED, "rigid", 2e-3)
    rolling = Rolling(structure_model(case).parts[0].model, RADIUS)
    period, amplitude = 2 * np.pi / rolling.rate, 0.02
    rows, columns = columns_and_rows(
        alone_on_ground(
            DOMED, "rigid", 2e-3, spin_rad_s=[0.0, rolling.spin(rolling.potential(amplitude)), 0.0]
        ),
        3.6 * period,
    )
    found = passages(rows)
    assert (found[5] - found[1]) / 2 == pytest.approx(period, rel=1e-3)
    assert kept(rows, columns, 2e-3) == pytest.approx(1.0, abs=1e-5)
    assert closure_over_kinetic(columns) < CLOSED


def test_the_foot_of_a_swing_stays_where_it_rolls():
    """The slide of the foot's lowest point is what turning takes it along; a body that rolls comes
    back to it.
    """
    rows, _ = columns_and_rows(
        alone_on_ground(DOMED, "rigid", 2e-3, spin_rad_s=[0.3, 0.5, 0.0]), 4.0
    )
    turned = rows["body/body/tilt"]
    way = np.linalg.norm(rows["interface/foot: body on ground/slide"], axis=1)
    # of a cycloid: rho (q - sin q)
    assert turned.max() > 0.05 and way == pytest.approx(
        RADIUS * (turned - np.sin(turned)), abs=2e-4 * RADIUS
    )


def test_a_body_whose_centre_is_above_that_of_its_sphere_falls():
    case = alone_on_ground(TUBE | dict(foot_radius_m=0.01), "rigid", 1e-3)
    rolling = Rolling(structure_model(case).parts[0].model, 0.01)
    rows, _ = columns_and_rows(
        alone_on_ground(TUBE | dict(foot_radius_m=0.01), "rigid", 1e-3, spin_rad_s=[0.0, 0.5, 0.0]),
        0.6,
    )
    leaned, tilt = rows["body/body/tilt"], 0.5
    end = int(np.argmax(leaned > tilt)) + 1
    assert np.interp(tilt, leaned[:end], rows["time"][:end]) == pytest.approx(
        rolling.reaches(tilt, 0.5), rel=1e-3
    )
    # lost at 45 degrees, before the 0.6 s are over
    assert rows["time"][-1] < 0.55 and leaned[-1] > np.pi / 4


def test_a_drum_goes_over_the_edge_of_its_dome_and_back_without_loss():
    body = DRUM | dict(foot_radius_m=1.2)
    rolling = Rolling(
        structure_model(alone_on_ground(body, "rigid", 2e-3)).parts[0].model, 1.2, 0.25
    )
    tilt = np.arcsin(0.25 / 1.2) + 0.03
    rows, columns = columns_and_rows(
        alone_on_ground(
            body, "rigid", 2e-3, spin_rad_s=[0.0, rolling.spin(rolling.potential(tilt)), 0.0]
        ),
        4.5,
    )
    assert rows["body/body/tilt"].max() == pytest.approx(tilt, rel=1e-3)
    assert len(passages(rows)) >= 2 and kept(rows, columns, 2e-3) == pytest.approx(1.0, abs=1e-4)
    assert closure_over_kinetic(columns) < CLOSED


def test_what_slides_on_a_dome_is_braked_by_coulombs_law():
    rows, _ = columns_and_rows(
        alone_on_ground(
            DRUM | dict(foot_radius_m=1.2), "rigid", 2e-4, 0.1, velocity_m_s=[0.6, 0.8, 0.0]
        ),
        0.02,
    )
    lost = np.array([0.6, 0.8]) * rows["time"][-1] - rows["body/body/displacement"][-1, :2]
    assert lost == pytest.approx(
        0.1 * GRAVITY * rows["time"][-1] ** 2 / 2 * np.array([0.6, 0.8]), rel=5e-3
    )


def test_a_block_rolls_on_its_rounded_edge():
    body = WIDE | dict(edge_radius_m=0.05)
    rows, columns = columns_and_rows(alone_on_ground(body, "rigid", 1e-3, tilt_rad=0.1), 0.4)
    model = structure_model(alone_on_ground(body, "rigid", 1e-3)).parts[0].model
    assert passages(rows)[0] == pytest.approx(falls(model, 0.15, 0.05, 0.1), abs=2e-3)
    # with a sharp edge it takes 0.05 s less
    assert passages(rows)[0] > falls(model, 0.2, 0.0, 0.1) + 0.04
    assert closure_over_kinetic(columns) < CLOSED


def test_a_drum_with_a_rounded_edge_tips_where_its_centre_is_over_that_of_the_edge():
    case = alone_on_ground(DRUM | dict(edge_radius_m=0.04), "rigid", 1e-3)
    model = structure_model(case)
    assert stances(model, standing_of(case, model))[0].critical == pytest.approx(
        np.arctan(0.21 / (0.8 - 0.04)), rel=1e-4
    )
    assert model.joints[0].round


def test_a_solid_on_a_dome_has_the_mass_of_its_shape():
    """pi R^2 H less the paraboloid-like space below the cap, whose volume is exact: pi R^2 s - pi
    s^2 (rho - s / 3).
    """
    radius, height, rho = 0.25, 1.6, 0.3
    mesh = drawing(
        alone_on_ground(DRUM | dict(foot_radius_m=rho, element_size_m=0.05), "rigid", 1e-3),
        "body",
        "case",
    ).shape.mesh
    rise = rho - np.sqrt(rho**2 - radius**2)
    exact = np.pi * radius**2 * (height - rise) + np.pi * rise**2 * (rho - rise / 3)
    assert mass_properties(mesh, 2700.0).mass == pytest.approx(2700 * exact, rel=4e-3)
    assert (
        mesh.points[:, 2].min() == pytest.approx(0.0, abs=1e-12)
        and scaled_jacobian(mesh).min() > 0.1
    )
    # a closed tube: a shell of half a sphere and of the cylinder around it weigh the same
    tube = (
        structure_model(alone_on_ground(TUBE | dict(foot_radius_m=0.01), "rigid", 1e-3))
        .parts[0]
        .model
    )
    assert tube.mass == pytest.approx(
        2500 * np.pi * (0.01**2 - 0.0085**2) * 0.15, rel=1e-6
    ) and tube.center[2] == pytest.approx(0.075, rel=1e-6)


def test_a_dome_gives_as_hertz_says():
    """Halving the load about which it is linear makes it 2^(1/3) as soft; of one cap on another
    plane of the same stuff twice as much, E* being half.
    """
    stone = Material(youngs_modulus_pa=50e9, poissons_ratio=0.2, density_kg_m3=2700.0)
    load, radius, modulus = 5000.0, 0.9, 50e9 / (1 - 0.2**2)

    def approach(force):
        return (9 * force**2 / (16 * modulus**2 * radius)) ** (1 / 3)

    assert hertz(radius, load, stone)[2] == pytest.approx(
        (approach(1.001 * load) - approach(0.999 * load)) / (0.002 * load), rel=1e-5
    )
    assert hertz(radius, load / 2, stone) == pytest.approx(
        2 ** (1 / 3) * hertz(radius, load, stone), rel=1e-12
    )
    assert hertz(radius, load, stone, stone)[2] == pytest.approx(
        2 ** (2 / 3) * hertz(radius, load, stone)[2], rel=1e-12
    )
    case = alone_on_ground(DOMED, "reduced", 1e-3)
    model = structure_model(case)
    assert model.joints[0].law[0] == pytest.approx(
        hertz(RADIUS, model.parts[0].model.mass * GRAVITY, stone), rel=1e-12
    )


@pytest.mark.parametrize("foot", [dict(foot_radius_m=RADIUS), dict(edge_radius_m=0.05)])
def test_what_goes_on_from_a_saved_motion_rolls_on_as_if_nothing_had_been(foot):
    case = alone_on_ground(WIDE | foot, "rigid", 2e-3, spin_rad_s=[0.3, 0.5, 0.0])
    whole, first, second = (engine_of(case, structure_model(case), "case") for _ in range(3))
    exact, _ = whole.advance(np.zeros((80, 3)))
    first.advance(np.zeros((40, 3)))
    for name, values in arrays_of(first.motion).items():
        arrays_of(second.motion)[name][...] = values
    second.ledger[:] = first.ledger
    going_on, _ = second.advance(np.zeros((40, 3)))
    assert np.abs(going_on[:, 1:8] - exact[40:, 1:8]).max() < 1e-12


def test_a_leaning_body_has_rolled_there():
    part = structure_model(
        alone_on_ground(DOMED, "rigid", 1e-3, tilt_rad=0.1, direction_deg=30.0)
    ).parts[0]
    center = part.center - part.rotation @ part.model.center + part.rotation @ [0.0, 0.0, RADIUS]
    assert center == pytest.approx(
        [0.1 * RADIUS * np.cos(np.pi / 6), 0.1 * RADIUS * np.sin(np.pi / 6), RADIUS], abs=1e-12
    )


def test_a_leaning_rounded_edge_has_rolled_there():
    part = structure_model(
        alone_on_ground(WIDE | dict(edge_radius_m=0.05), "rigid", 1e-3, tilt_rad=0.1)
    ).parts[0]
    center = part.center + part.rotation @ (np.array([0.15, 0.0, 0.05]) - part.model.center)
    assert center == pytest.approx([0.15 + 0.1 * 0.05, 0.0, 0.05], abs=1e-9)


@pytest.mark.parametrize(
    "keys, message",
    [
        (dict(foot_radius_m=0.2), "foot_radius_m.*at least 0.223607 m, the half diagonal"),
        (
            dict(foot_radius_m=1.0, edge_radius_m=0.01),
            "edge_radius_m.*must be 0 where foot_radius_m",
        ),
        (dict(edge_radius_m=0.1), "edge_radius_m.*must be less than 0.1 m"),
        (dict(foot_radius_m=-1.0), "foot_radius_m.*greater than 0"),
    ],
)
def test_feet_that_cannot_be_are_refused(keys, message):
    with pytest.raises(InputError, match=message):
        structure(**block(rigid=True, **keys))


def test_feet_that_are_not_flat_are_refused_where_they_cannot_be_computed():
    with pytest.raises(
        InputError,
        match='bodies.block.foot_radius_m.*must be left out with integration.engine = "full"',
    ):
        structure(**block(foot_radius_m=1.0), integration=dict(engine="full"))
    with pytest.raises(InputError, match="foot_radius_m.*without a flange"):
        structure(
            bodies=dict(
                one=dict(
                    kind="tube",
                    outer_diameter_m=0.2,
                    wall_m=0.02,
                    height_m=1.0,
                    foot_radius_m=1.0,
                    flange=dict(outer_diameter_m=0.4, thickness_m=0.05),
                )
            ),
            joints=dict(foot=dict(between=["one", "ground"])),
        )
    tables = block(rigid=True, foot_radius_m=1.0, at_m=[0.0, 0.0, 0.5])
    pedestal = dict(kind="block", length_m=0.6, width_m=0.6, height_m=0.5, rigid=True) | STONE
    # whichever is named first, the foot that is not flat has the points
    model = structure_model(
        structure(
            bodies=tables["bodies"] | dict(pedestal=pedestal),
            joints=dict(
                foot=dict(between=["pedestal", "ground"]), joint=dict(between=["pedestal", "block"])
            ),
        )
    )
    assert [joint.name for joint in model.joints if joint.ball] == ["joint: block on pedestal"]


def test_a_flat_foot_leaves_a_case_its_name():
    flat = structure(**block(rigid=True))
    assert (
        structure(**block(rigid=True, edge_radius_m=0.0)).id
        == flat.id
        != structure(**block(rigid=True, edge_radius_m=0.01)).id
    )


@pytest.fixture(scope="module")
def overhanging():
    case = narrower_case("rigid", 1e-3, 0.05)
    return case, structure_model(case)


def test_a_block_on_a_narrower_one_rocks_about_the_edge_of_that(overhanging):
    """Housner's block with the narrow half width b = 0.2 m, h = 0.6 m."""
    case, model = overhanging
    wide, half, height = model.parts[1].model, 0.2, 0.6
    assert stances(model, standing_of(case, model))[1].critical == pytest.approx(
        np.arctan(half / height), rel=1e-9
    )
    edge = model.parts[1].center + model.parts[1].rotation @ [half, 0.0, -height]
    assert edge == pytest.approx([half, 0.0, 0.3], abs=1e-12)
    rows, columns = columns_and_rows(case, 0.45)
    upright = passages(rows, "wide")[0]
    assert upright == pytest.approx(falls(wide, half, 0.0, 0.05), abs=2e-3)
    inertia, mass = wide.inertia[1, 1], wide.mass
    again, slope = (
        rows["body/wide/tilt"][round(upright / 1e-3) + 5 :].max(),
        np.arctan(half / height),
    )
    left = (np.cos(slope - again) - np.cos(slope)) / (np.cos(slope - 0.05) - np.cos(slope))
    assert left == pytest.approx(
        ((inertia + mass * (height**2 - half**2)) / (inertia + mass * (height**2 + half**2))) ** 2,
        rel=5e-3,
    )
    assert closure_over_kinetic(columns) < CLOSED


def test_the_edge_below_a_face_is_an_interface_of_its_own_name():
    """Here nodes of the wide face are at the edges: they make place for those of the edges."""
    model = structure_model(
        narrower_case("rigid", 1e-3, 0.05).replace({"bodies.wide.length_m": 0.8})
    )
    # the narrow block's face is the smaller one and has the points; where it comes to the wide
    # one's edge, that is the other side of the joint
    assert [joint.name for joint in model.joints] == [
        "foot: narrow on ground",
        "joint: narrow on wide",
        "joint, edge: wide on narrow",
    ]
    edge, other = model.joints[2], model.parts[1].model
    assert edge.pair == 1 and [len(sides) for sides in edge.outlines] == [4, 4]
    places = other.arms[other.surfaces[edge.slave_surface].nodes]
    # both blocks are equally deep: sides that the narrow one may slide over
    assert np.abs(places[:, 1]).max() == pytest.approx(0.2)


def test_a_drum_on_a_smaller_one_has_a_round_edge():
    drum = dict(kind="cylinder", height_m=0.3, rigid=True) | STONE
    case = structure(
        bodies=dict(
            low=drum | dict(outer_diameter_m=0.5),
            up=drum | dict(outer_diameter_m=0.8, at_m=[0, 0, 0.3]),
        ),
        joints=dict(foot=dict(between=["low", "ground"]), joint=dict(between=["up", "low"])),
        initial=dict(up=dict(tilt_rad=0.05)),
    )
    model = structure_model(case)
    # the smaller one has the points, however far the other overhangs
    assert (
        model.joints[1].name == "joint: low on up"
        and model.joints[1].round
        and len(model.joints) == 2
    )
    touched = model.parts[1].center + model.parts[1].rotation @ [0.25, 0.0, -0.15]
    assert touched == pytest.approx([0.25, 0.0, 0.3], abs=1e-9)


def test_an_edge_need_not_be_stated_and_the_joint_in_the_other_direction_is_refused():
    case = narrower_case("rigid", 1e-3, 0.05)
    stated = case.replace({"joints.edge.between": ["narrow", "wide"]})
    with pytest.raises(InputError, match="joints.edge: states the joint of joints.joint again"):
        structure_model(stated)


@pytest.mark.parametrize("upper", [0.4, 0.3])
def test_faces_that_end_with_or_near_the_masters_edge_have_two_sides(upper):
    stone = dict(kind="block", rigid=True) | STONE
    case = structure(
        bodies=dict(
            low=stone | dict(length_m=0.4, width_m=0.4, height_m=0.3),
            up=stone | dict(length_m=upper, width_m=upper, height_m=0.6, at_m=[0, 0, 0.3]),
        ),
        joints=dict(foot=dict(between=["low", "ground"]), joint=dict(between=["up", "low"])),
    )
    joints = structure_model(case).joints
    assert [joint.pair for joint in joints] == [-1, -1, 1]


def test_a_face_far_within_the_masters_has_one_side():
    stone = dict(kind="block", rigid=True) | STONE
    case = structure(
        bodies=dict(
            low=stone | dict(length_m=0.9, width_m=0.9, height_m=0.3),
            up=stone | dict(length_m=0.3, width_m=0.3, height_m=0.6, at_m=[0, 0, 0.3]),
        ),
        joints=dict(foot=dict(between=["low", "ground"]), joint=dict(between=["up", "low"])),
    )
    assert len(structure_model(case).joints) == 2


def test_a_slab_that_overhangs_rests_and_its_weight_is_shared():
    """With its centre beyond the middle of the block, but over it, it stands; both interfaces
    together carry its weight.
    """
    stone = dict(rigid=True) | STONE
    case = structure(
        bodies=dict(
            low=dict(kind="block", length_m=0.4, width_m=0.4, height_m=0.6) | stone,
            slab=dict(kind="slab", length_m=1.2, width_m=0.4, thickness_m=0.1, at_m=[0.1, 0, 0.6])
            | stone,
        ),
        joints=dict(foot=dict(between=["low", "ground"]), joint=dict(between=["slab", "low"])),
        contact=dict(interior_points=4),
    )
    rows, columns = columns_and_rows(case, 0.1)
    carried = sum(
        values[-1]
        for name, values in rows.items()
        if name.startswith("interface/joint") and name.endswith("/force")
    )
    assert carried == pytest.approx(2700 * 1.2 * 0.4 * 0.1 * GRAVITY, rel=1e-6)
    assert np.ptp(columns[:, 1:4], axis=0).max() < 1e-9


def test_bodies_carry_what_stands_on_them():
    column = (
        dict(
            kind="cylinder",
            outer_diameter_m=0.2,
            height_m=1.5,
            foot_radius_m=2.0,
            rigid=True,
            copies_m=[[x, y, 0] for x in (-1, 1) for y in (-1, 1)],
        )
        | STONE
    )
    case = structure(
        bodies=dict(
            column=column,
            slab=dict(
                kind="slab",
                length_m=3.0,
                width_m=3.0,
                thickness_m=0.3,
                at_m=[0, 0, 1.5],
                rigid=True,
            )
            | STONE,
        ),
        joints=dict(
            feet=dict(between=["column", "ground"]), heads=dict(between=["column", "slab"])
        ),
        initial=dict(column=dict(tilt_rad=0.01)),
    )
    model = structure_model(case)
    forces = loads(standing_of(case, model), model.joints)
    slab, one = model.parts[4].model.mass * GRAVITY, model.parts[0].model.mass * GRAVITY
    assert forces == pytest.approx([slab / 4 + one] * 4 + [slab / 4] * 4)
