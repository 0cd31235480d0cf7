"""Where bodies are at the start when some of them lean."""

import numpy as np
import pytest
from small_structures import BLOCK, RIGID, STONE, block, frame, stack, structure

from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge
from fecolumn.structures.barrier import least_barrier
from fecolumn.structures.layout import layout_of
from fecolumn.structures.structure import standing_of, structure_model


def _lowest(part):
    return (part.center + part.model.arms @ part.rotation.T)[:, 2].min()


@pytest.mark.parametrize("direction", [0.0, 30.0, 45.0])
def test_leaning_block_stands_on_its_lowest_point(direction):
    part = structure_model(
        structure(
            **block(rigid=True), initial=dict(block=dict(tilt_rad=0.1, direction_deg=direction))
        )
    ).parts[0]
    assert _lowest(part) == pytest.approx(0.0, abs=1e-12)
    up = part.rotation[:, 2]
    assert np.arccos(up[2]) == pytest.approx(0.1) and np.degrees(
        np.arctan2(up[1], up[0])
    ) == pytest.approx(direction, abs=1e-9)


def test_frame_leans_as_a_parallelogram():
    """All columns alike: the slab stays level, on the highest points of the heads, 2 R cos(alpha -
    tilt) above the ground.
    """
    tilt, direction = 0.05, 37.0
    parts = structure_model(
        structure(**frame(), initial=dict(column=dict(tilt_rad=tilt, direction_deg=direction)))
    ).parts
    slab = parts[4]
    assert slab.rotation == pytest.approx(np.eye(3))
    size, alpha = np.hypot(1.5, 0.2), np.arctan(0.2 / 1.5)
    assert slab.center[2] - 0.15 == pytest.approx(size * np.cos(alpha - tilt), abs=1e-9)
    ahead = np.array([np.cos(np.radians(direction)), np.sin(np.radians(direction))])
    # the pivot of the foot ahead, the pivot of the head behind
    assert slab.center[:2] == pytest.approx(ahead * (0.2 - size * np.sin(alpha - tilt)), abs=1e-9)


def test_block_on_a_leaning_block_stays_level_or_leans_with_it():
    level = structure_model(structure(**stack(), initial=dict(lower=dict(tilt_rad=0.1)))).parts
    assert level[1].rotation == pytest.approx(np.eye(3))
    # the upper block's foot, 0.4 m wide, is met by the lower one's head behind, at x = -0.2
    behind = level[0].center + level[0].rotation @ [-0.2, 0.0, 0.4]
    assert _lowest(level[1]) == pytest.approx(behind[2], abs=1e-12)
    both = structure_model(
        structure(**stack(), initial=dict(lower=dict(tilt_rad=0.1), upper=dict(tilt_rad=0.1)))
    ).parts
    assert both[0].rotation == pytest.approx(both[1].rotation)
    assert both[0].rotation.T @ (both[1].center - both[0].center) == pytest.approx(
        [0.0, 0.0, 0.7], abs=1e-12
    )


def test_upper_block_leans_alone_about_its_own_edge():
    lower, upper = structure_model(
        structure(**stack(), initial=dict(upper=dict(tilt_rad=0.1)))
    ).parts
    assert lower.center == pytest.approx([0, 0, 0.4]) and _lowest(upper) == pytest.approx(
        0.8, abs=1e-12
    )
    assert upper.center + upper.rotation @ [0.2, 0.0, -0.3] == pytest.approx([0.2, 0.0, 0.8])


def test_slab_on_columns_that_lean_differently_is_refused():
    with pytest.raises(InputError, match="cannot stand on bodies that lean differently"):
        structure_model(
            structure(
                **frame(), initial={"column": dict(tilt_rad=0.05), "column 2": dict(tilt_rad=0.02)}
            )
        )


def test_spin_tips_a_standing_block_over_its_edge():
    part = structure_model(
        structure(
            **block(rigid=True),
            initial=dict(block=dict(spin_rad_s=[0.0, 0.5, 0.0], velocity_m_s=[0.1, 0.0, 0.0])),
        )
    ).parts[0]
    edge = np.array([0.2, 0.0, 0.0])
    assert part.velocity + np.cross(part.spin, edge - part.center) == pytest.approx([0.1, 0.0, 0.0])
    turning = structure_model(
        structure(**block(rigid=True), initial=dict(block=dict(spin_rad_s=[0.0, 0.0, 2.0])))
    ).parts[0]
    assert turning.velocity == pytest.approx(
        np.zeros(3), abs=1e-12
    ) and turning.spin == pytest.approx([0, 0, 2.0])


def test_energy_to_overturn_a_frame_lifts_its_slab_twice_as_far_as_its_columns():
    case = structure(**frame(column=dict(density_kg_m3=2500.0)))
    model = structure_model(case)
    column, slab = model.parts[0].model.mass, model.parts[4].model.mass
    lift = np.hypot(0.1, 0.75) - 0.75
    assert least_barrier(model, standing_of(case, model)) == pytest.approx(
        9.80665 * (4 * column * lift + slab * 2 * lift), rel=1e-6
    )


def test_energy_to_overturn_a_stack_is_that_of_its_upper_block():
    case = structure(**stack())
    model = structure_model(case)
    assert least_barrier(model, standing_of(case, model)) == pytest.approx(
        9.80665 * model.parts[1].model.mass * (np.hypot(0.2, 0.3) - 0.3), rel=1e-9
    )


def test_faces_meet_whose_nodes_all_lie_on_edges_of_the_others_elements():
    """Bridge piers of 0.8 m elements below a deck that is meshed in 0.8 m around them: every node
    and middle of the one lies on an edge or a diagonal of the other.
    """
    stone = dict(
        youngs_modulus_pa=30e9, poissons_ratio=0.2, density_kg_m3=2500.0, element_size_m=0.8
    )
    case = structure(
        bodies=dict(
            pier=dict(
                kind="block",
                length_m=1.6,
                width_m=1.6,
                height_m=9.6,
                coarse_size_m=4.8,
                copies_m=[[-8.0, 0, 0], [8.0, 0, 0]],
            )
            | stone,
            deck=dict(
                kind="slab",
                length_m=20.0,
                width_m=4.0,
                thickness_m=2.5,
                element_order=1,
                at_m=[0, 0, 9.6],
            )
            | stone,
        ),
        joints=dict(feet=dict(between=["pier", "ground"]), heads=dict(between=["pier", "deck"])),
    )
    assert len(layout_of(case, "case").contacts) == 4


def test_a_face_is_known_to_contact_where_points_of_a_slave_may_come():
    """Drums with contact points on their rims alone: 50 mm around the rim, not the middle of the
    head.
    """
    drum = dict(
        kind="cylinder",
        outer_diameter_m=1.6,
        height_m=0.5,
        element_size_m=0.1,
        copies_m=[[0.0, 0.0, 0.0], [0.0, 0.0, 0.5]],
    )
    reach, known = {}, {}
    for points in (0, 60):
        case = structure(
            bodies=dict(
                drum=drum | dict(youngs_modulus_pa=50e9, poissons_ratio=0.2, density_kg_m3=2700.0)
            ),
            contact=dict(interior_points=points),
            joints=dict(
                foot=dict(between=["drum", "ground"]),
                joint=dict(between=["drum", "drum"], allowance_m=0.05),
            ),
        )
        head = layout_of(case, "case").patches["drum"]["head, master"]
        reach[points], known[points] = np.hypot(*head.positions[:, :2].T).min(), len(head.positions)
    assert reach[0] > 0.8 - 0.05 - 2 * 0.1 and reach[60] < 0.1 and known[0] < known[60] / 2


def test_a_block_of_a_million_tonnes_stands_and_so_does_a_gram_on_it():
    """Forces are found in weights, whatever these are."""
    heavy = dict(length_m=90.0, width_m=90.0, height_m=45.0, element_size_m=45.0)
    light = BLOCK | dict(length_m=0.01, width_m=0.01, height_m=0.01, element_size_m=0.01)
    case = structure(
        **merge(
            block(**heavy, rigid=True),
            dict(
                bodies=dict(light=light | dict(at_m=[0.0, 0.0, 45.0], rigid=True)),
                joints=dict(upper=dict(between=["light", "block"])),
            ),
        ),
        contact=dict(interior_points=0),
    )
    structure_model(case)


GATE = dict(
    bodies=dict(
        pier=dict(kind="block", length_m=0.2, width_m=0.6, height_m=0.8)
        | STONE
        | RIGID
        | dict(copies_m=[[-0.4, 0, 0], [0.4, 0, 0]]),
        lintel=dict(kind="block", length_m=1.1, width_m=0.6, height_m=0.14, at_m=[0, 0, 0.8])
        | STONE
        | RIGID,
    ),
    joints=dict(feet=dict(between=["pier", "ground"]), heads=dict(between=["pier", "lintel"])),
)


@pytest.mark.parametrize("way", [1, -1])
def test_a_lintel_tips_over_the_pier_ahead_by_spin_and_by_tilt(way):
    """The mirror image of a start is the mirror image of its motion."""
    spun = structure_model(
        structure(**GATE, initial=dict(lintel=dict(spin_rad_s=[0.0, 0.5 * way, 0.0])))
    ).parts[2]
    edge = np.array([0.5 * way, 0.0, 0.8])
    assert spun.velocity + np.cross(spun.spin, edge - spun.center) == pytest.approx(np.zeros(3))
    leans = dict(tilt_rad=0.05, direction_deg=0 if way > 0 else 180)
    tilted = structure_model(structure(**GATE, initial=dict(lintel=leans))).parts[2]
    corner = tilted.center + tilted.rotation @ [0.5 * way, 0.0, -0.07]
    assert corner[[0, 2]] == pytest.approx([0.5 * way, 0.8], abs=1e-12)
    assert tilted.rotation[0, 2] == pytest.approx(way * np.sin(0.05))


def test_a_lintel_turns_about_the_middle_of_its_piers():
    part = structure_model(
        structure(**GATE, initial=dict(lintel=dict(spin_rad_s=[0.0, 0.0, 1.0])))
    ).parts[2]
    assert part.velocity == pytest.approx(np.zeros(3), abs=1e-12)


@pytest.mark.parametrize("x, touches", [(0.2, True), (2.8, True), (3.1, False)])
def test_beams_of_one_element_touch_where_they_cross(x, touches):
    """Neither corners nor middles of their elements lie on the other: a log crib."""
    beam = dict(kind="prism", width_m=0.3, element_size_m=100.0) | RIGID | STONE
    low = dict(outline_m=[[0.0, 0.0], [4.0, 0.0], [4.0, 0.3], [0.0, 0.3]], at_m=[-1.0, 0.0, 0.0])
    high = dict(outline_m=[[0.0, 0.0], [0.3, 0.0], [0.3, 4.0], [0.0, 4.0]], along="z")
    case = structure(
        bodies=dict(low=beam | low, high=beam | high | dict(at_m=[x, -1.0, 0.3])),
        joints=dict(foot=dict(between=["low", "ground"]), cross=dict(between=["high", "low"])),
        integration=dict(engine="rigid", start="drawn"),
    )
    if touches:
        assert any(joint.name.startswith("cross") for joint in structure_model(case).joints)
    else:
        with pytest.raises(InputError, match="touch"):
            structure_model(case)
