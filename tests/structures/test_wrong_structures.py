"""Structures that cannot be are refused by name, in one line, before anything is computed."""

import math
import warnings

import numpy as np
import pytest
from small_structures import BLOCK, FOOT, RIGID, STONE, block, frame, stack, structure

from fecolumn.case.case import case_from_tables, load_case
from fecolumn.foundation.schema import InputError
from fecolumn.foundation.toml_file import merge
from fecolumn.structures.structure import structure_model

LINK = dict(
    kind="spring",
    body="upper",
    point_m=[0, 0, 0.3],
    to="ground",
    to_point_m=[0, 1, 0.3],
    stiffness_n_m=1e5,
)
STOREYS = dict(
    kind="storeys",
    length_m=1.0,
    width_m=1.0,
    thickness_m=0.2,
    floors=3,
    floor_masses_kg=[1.0, 2.0],
    storey_heights_m=[1.0],
    period_s=1.0,
)
WRONG = [
    (
        stack(bodies=dict(upper=dict(at_m=[0, 0, 0.803])), joints=dict(joint=dict(open=False))),
        "joints.joint",
        "gap of 0.003 m",
    ),
    (stack(bodies=dict(upper=dict(at_m=[0, 0, 0.797]))), "joints.joint", "overlap by 0.003 m"),
    (
        stack(bodies=dict(upper=dict(at_m=[0, 0, 1.5])), joints=dict(joint=dict(open=False))),
        "joints.joint",
        "does not touch",
    ),
    (stack(bodies=dict(upper=dict(at_m=[0.6, 0, 0.8]))), "joints.joint", "does not touch"),
    (stack(bodies=dict(upper=dict(at_m=[0.35, 0, 0.8]))), "joints", '"upper" cannot rest'),
    (
        frame(bodies=dict(column=dict(copies_m=[[1, 0.8, 0], [1, -0.8, 0]]))),
        "joints",
        '"slab" cannot rest',
    ),
    (
        frame(
            bodies=dict(
                column=dict(copies_m=[[1, 0.8, 0], [-1, 0.8, 0], [-1, -0.8, 0], [1, -0.8, -0.002]])
            )
        ),
        "joints.feet",
        "overlap by 0.002 m",
    ),
    (frame(joints=dict(feet=False)), "joints", "no contact path to the ground"),
    (
        dict(
            bodies=dict(one=BLOCK, row=BLOCK | dict(at_m=[0.6, 0, 0])),
            joints=dict(foot=dict(between=["one", "ground"]), side=dict(between=["one", "row"])),
        ),
        "joints",
        'nothing carries "row"',
    ),
    (
        stack(
            bodies=dict(
                side=dict(
                    kind="block",
                    length_m=0.4,
                    width_m=0.4,
                    height_m=0.5,
                    at_m=[2, 0, 0],
                    rigid=True,
                )
            )
        ),
        "joints",
        'no contact path to the ground from "side"',
    ),
    (
        stack(
            bodies=dict(
                side=dict(
                    kind="block",
                    length_m=0.4,
                    width_m=0.4,
                    height_m=0.5,
                    at_m=[0.4, 0, 0],
                    rigid=True,
                )
            ),
            joints=dict(other=dict(between=["side", "ground"])),
        ),
        "bodies.side",
        '"side" and "lower" overlap',
    ),
    # they cross by a strip without a node of one in the other
    (
        stack(
            bodies=dict(
                side=dict(
                    kind="block",
                    length_m=0.6,
                    width_m=0.6,
                    height_m=0.8,
                    at_m=[0.59, 0, 0],
                    element_size_m=0.6,
                    coarse_size_m=0.8,
                )
                | STONE
                | RIGID,
                lower=dict(element_size_m=0.6, coarse_size_m=0.8),
            ),
            joints=dict(other=dict(between=["side", "ground"])),
        ),
        "bodies.side",
        '"side" and "lower" overlap',
    ),
    (
        stack(bodies=dict(lower=dict(at_m=[0, 0, -0.1]), upper=dict(at_m=[0, 0, 0.7]))),
        "joints.foot",
        "does not touch",
    ),
    (
        stack(links=dict(tie=LINK | dict(point_m=[0.3, 0, 0.3]))),
        "links.tie.point_m",
        'a point of "upper": it lies 0.1 m outside',
    ),
    (
        stack(links=dict(tie=LINK | dict(to="lower"))),
        "links.tie.to_point_m",
        'm outside, counted from the foot of "upper" as point_m is',
    ),
    (
        stack(links=dict(tie=LINK | dict(stiffness_n_m=0))),
        "links.tie.stiffness_n_m",
        "greater than 0",
    ),
    (
        stack(links=dict(tie=LINK | dict(to_point_m=[0, 0, 0.3]))),
        "links.tie.to_point_m",
        "no length",
    ),
    (
        stack(links=dict(tie=LINK | dict(kind="dashpot"))),
        "links.tie.damping_n_s_m",
        "greater than 0",
    ),
    (
        stack(joints=dict(joint=dict(between=["upper", "lwoer"]))),
        "joints.joint.between",
        "did you mean lower",
    ),
    (
        stack(joints=dict(joint=dict(between=["upper", "upper"]))),
        "joints.joint.between",
        "no other copy",
    ),
    (stack(initial=dict(middle=dict(tilt_rad=0.1))), "initial.middle", "no such body"),
    (stack(bodies=dict(upper=dict(kind="ball"))), "bodies.upper.kind", "must be one of tube"),
    (
        stack(bodies=dict(upper=dict(heigth_m=1.0))),
        "bodies.upper.heigth_m",
        "did you mean bodies.upper.height_m",
    ),
    (stack(bodies=dict(upper=dict(material="gold"))), "bodies.upper.material", "no such table"),
    (stack(bodies=dict(upper=dict(cap_size_m=0.1))), "bodies.upper.cap_size_m", "without a cap"),
    (
        stack(
            bodies=dict(
                drum=dict(kind="cylinder", outer_diameter_m=0.3, height_m=0.5, cap_size_m=0.1)
                | dict(cap=dict(length_m=0.4, width_m=0.4, thickness_m=0.05))
                | STONE
            )
        ),
        "bodies.drum.cap_size_m",
        "state fine_height_m",
    ),
    (stack(bodies=dict(upper=dict(mass_kg=3.0))), "bodies.upper.mass_kg", "without density_kg_m3"),
    (stack(bodies=dict(upper=dict(at_m=[0, 1]))), "bodies.upper.at_m", "three numbers"),
    (
        stack(bodies=dict(upper=dict(copies_m=[[0, 1, "x"]], at_m=[0, 0, 0]))),
        "bodies.upper.copies_m",
        "a list of lists of numbers",
    ),
    (
        stack(bodies=dict(upper=dict(copies_m=[[0, 0, float("nan")]], at_m=[0, 0, 0]))),
        "bodies.upper.copies_m",
        "[-10000, 10000]",
    ),
    (stack(column=dict(height_m=1.0)), "bodies", "beside [column]"),
    (
        stack(
            bodies=dict(upper=STOREYS | dict(floor_masses_kg=[9.0], at_m=[0, 0, 0.8])),
            integration=dict(engine="rigid"),
        ),
        "integration.engine",
        '"upper" their springs and no inertia',
    ),
    (
        stack(bodies=dict(upper=STOREYS | dict(floor_masses_kg=[9.0], modes=0, at_m=[0, 0, 0.8]))),
        "bodies.upper.modes",
        '"upper" their springs and no inertia',
    ),
    (
        stack(bodies=dict(upper=STOREYS | dict(at_m=[0, 0, 0.8]))),
        "bodies.upper.floor_masses_kg",
        "floors = 3 numbers",
    ),
    (stack(observed="lower.floor 1"), "observed", "no such mark"),
    (
        stack(joints=dict(joint=False, foot=dict(between=["lower", "upper"]))),
        "joints",
        "no contact path",
    ),
    # one joint stated twice: in each direction, by another name, and of one copy beside all of them
    (
        stack(joints=dict(again=dict(between=["lower", "upper"]))),
        "joints.again",
        'the joint of joints.joint again: the same faces of "upper" and "lower"',
    ),
    (
        stack(joints=dict(again=dict(between=["upper", "lower"], friction_coefficient=0.1))),
        "joints.again",
        'the joint of joints.joint again: the same faces of "upper" and "lower"',
    ),
    (
        stack(joints=dict(again=dict(between=["lower", "ground"]))),
        "joints.again",
        'the joint of joints.foot again: the same faces of "lower" and the ground',
    ),
    (
        frame(joints=dict(again=dict(between=["column 2", "slab"]))),
        "joints.again",
        'the joint of joints.heads again: the same faces of "column 2" and "slab"',
    ),
    (
        stack(links=dict(tie=LINK | dict(to="upper"))),
        "links.tie.to",
        "another body than links.tie.body",
    ),
    (
        frame(
            links=dict(
                tie=LINK
                | dict(body="column", to="column 2", point_m=[0, 0, 1.4], to_point_m=[0, 0, 0.4])
            )
        ),
        "links.tie.to",
        "another body than links.tie.body",
    ),
    (block(kind=["block"]), "bodies.block.kind", "must be one of"),
    (block(kind={}), "bodies.block.kind", "must be one of"),
    (
        stack(joints=dict(joint=dict(friction=0.3))),
        "joints.joint.friction",
        "did you mean joints.joint.friction_coefficient?",
    ),
    (
        stack(overturn=dict(displacement_m=5e-324)),
        "overturn.displacement_m",
        "and 1e-60 in magnitude unless it is 0",
    ),
    (
        stack(overturn=dict(displacement_m=1e-9)),
        "overturn.displacement_m",
        "must be 0 for none, or at least 0.00014 m",
    ),
    (
        stack(overturn=dict(displacement_m=1e-5)),
        "overturn.displacement_m",
        "at least 0.00014 m, 0.0001 of the height",
    ),
    # weighs 2542 N
    (
        stack(links=dict(tie=LINK | dict(breaking_n=0.001))),
        "links.tie.breaking_n",
        "must be at least 0.00254 N",
    ),
    (
        stack(links=dict(tie=LINK | dict(yield_n=0.001))),
        "links.tie.yield_n",
        "must be at least 0.00254 N",
    ),
    # 2700 x 9.81 x 1.2 Pa at its foot
    (
        block(youngs_modulus_pa=2700 * 9.81 * 1.2 / 0.29),
        "bodies.block.youngs_modulus_pa",
        "which strains it by 29 %",
    ),
    (
        dict(
            bodies=dict(
                tube=dict(kind="tube", outer_diameter_m=1.0, height_m=3.0, wall_m=4e-5) | STONE
            ),
            joints=dict(foot=dict(between=["tube", "ground"])),
        ),
        "bodies.tube",
        "its elements measure 4e-05 m across",
    ),
]


def _case(tables):
    bodies = dict(tables["bodies"])
    if bodies.get("upper", {}).get("kind") == "storeys":  # its own keys, none of the block's
        bodies["upper"] = {
            key: value
            for key, value in bodies["upper"].items()
            if key in (*STOREYS, "at_m", "modes")
        }
    return structure(**tables | dict(bodies=bodies))


@pytest.mark.parametrize(
    "tables, key, said",
    WRONG,
    ids=[f"{number}-{said}" for number, (_, _, said) in enumerate(WRONG)],
)
def test_wrong_structure_is_refused_in_one_line(tables, key, said):
    with pytest.raises(InputError) as caught:
        structure_model(_case(tables), "small.toml")
    assert caught.value.key == key and said in str(caught.value) and "\n" not in str(caught.value)


def test_bodies_that_do_not_meet_are_told_how_they_would():
    """How far an overlap is to be moved; by how much faces are inclined to one another."""
    with pytest.raises(InputError, match=r'move "upper" by \[0, 0, 0.003\] m, bodies.upper.at_m'):
        structure_model(_case(stack(bodies=dict(upper=dict(at_m=[0, 0, 0.797])))), "small.toml")
    wedge = dict(kind="prism", width_m=0.5, element_size_m=0.25) | RIGID
    tables = dict(
        bodies=dict(
            left=wedge | dict(outline_m=[[0, 0], [0.5, 0], [0.4, 0.5], [0, 0.5]]),
            right=wedge | dict(outline_m=[[0.5, 0], [1.0, 0], [1.0, 0.5], [0.42, 0.5]]),
        ),
        joints=dict(
            one=dict(between=["left", "ground"]),
            other=dict(between=["right", "ground"]),
            side=dict(between=["left", "right"]),
        ),
    )
    with pytest.raises(InputError, match="are inclined to one another by 2.22 degrees"):
        structure_model(structure(**tables), "small.toml")


def _prisms(**outlines):
    """Case of rigid prisms 0.5 m wide, each on the ground, the first two joined."""
    wedge = dict(kind="prism", width_m=0.5, element_size_m=5.0) | RIGID | STONE
    one, other, *_ = outlines
    return structure(
        bodies={name: wedge | dict(outline_m=outline) for name, outline in outlines.items()},
        joints={name: dict(between=[name, "ground"]) for name in outlines}
        | dict(side=dict(between=[one, other])),
    )


def test_faces_that_look_away_from_one_another_do_not_overlap():
    square, beyond = [[0, 0], [1, 0], [1, 1], [0, 1]], [[2, 0], [3, 0], [3, 1]]
    with pytest.raises(InputError, match="no faces of theirs look at one another") as caught:
        structure_model(_prisms(left=square, right=beyond), "small.toml")
    assert "overlap" not in str(caught.value)


@pytest.mark.parametrize(
    "outline, way, inclined",
    [
        # the largest ball in both: in a triangle, area over half its circumference; in a wedge
        ([[0.1, 0], [0.9, 0], [0.5, 0.6]], 0.48 / (0.4 + math.hypot(0.4, 0.6)), ""),
        ([[1, 0], [2, 0], [2, 1], [0.96, 1]], 0.0392, "inclined to one another by 2.29 degrees"),
    ],
)
def test_bodies_of_a_joint_that_lie_in_one_another_are_told_so(outline, way, inclined):
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    with pytest.raises(InputError, match='"left" and "right" overlap at the start') as caught:
        structure_model(_prisms(left=square, right=outline), "small.toml")
    told = str(caught.value)
    assert float(told.split("by ")[1].split(" m or more")[0]) == pytest.approx(way, rel=0.01)
    assert inclined in told


@pytest.mark.parametrize(
    "keys, key",
    [
        (dict(density_kg_m3=2.4), "density_kg_m3"),
        (dict(density_kg_m3=26e3), "density_kg_m3"),
        (dict(density_kg_m3=None, mass_kg=0.26), "mass_kg"),
    ],
)
def test_densities_of_no_stone_or_metal_are_warned_of(keys, key):
    body = {name: value for name, value in (BLOCK | keys).items() if value is not None}
    tables = dict(bodies=dict(block=body), joints=dict(foot=FOOT))
    with pytest.warns(UserWarning, match=rf"small.toml: bodies.block.{key}: .* kg/m3"):
        structure_model(structure(**tables), "small.toml")


@pytest.mark.parametrize("keys", [{}, dict(density_kg_m3=2.4, youngs_modulus_pa=1e7)])
def test_densities_of_stone_and_of_what_is_soft_are_not(keys):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        structure_model(structure(**block(**keys)), "small.toml")


def test_several_wrong_keys_are_told_together():
    with pytest.raises(InputError) as caught:
        structure(
            **stack(
                bodies=dict(upper=dict(height_m=-1.0), lower=dict(heigth_m=1.0)),
                contact=dict(friction_coefficient=-1),
            )
        )
    assert {error.key for error in caught.value.all} == {
        "bodies.upper.height_m",
        "bodies.lower.heigth_m",
        "contact.friction_coefficient",
    }


def test_leaning_structure_need_not_rest():
    tables = stack(
        bodies=dict(upper=dict(at_m=[0.35, 0, 0.8])), initial=dict(upper=dict(tilt_rad=0.01))
    )
    assert len(structure_model(structure(**tables)).parts) == 2


def test_tendon_may_hold_what_would_fall():
    tables = stack(
        bodies=dict(upper=dict(at_m=[0.35, 0, 0.8])),
        links=dict(
            tie=dict(
                kind="tendon",
                body="upper",
                point_m=[-0.2, 0, 0.6],
                to="ground",
                to_point_m=[-0.5, 0, -0.8],
                stiffness_n_m=1e6,
            )
        ),
    )
    (link,) = structure_model(structure(**tables)).links
    assert (
        link.b == -1
        and link.arm_b == pytest.approx([-0.15, 0.0, 0.0])
        and link.arm_a == pytest.approx([-0.2, 0.0, 0.3])
    )
    assert link.pulls and not link.pushes and np.isinf(link.breaking_n)


def test_case_is_named_by_content_and_survives_its_own_tables():
    case = structure(**frame(), materials=dict(steel=dict(density_kg_m3=7850.0)))
    again = case_from_tables(case.tables(), "other.toml")
    assert again.id == case.id and again == case
    longer = case.replace({"bodies.slab.length_m": 3.2})
    assert (
        longer.bodies["slab"].length_m == 3.2
        and longer.id != case.id
        and longer.replace({"bodies.slab.length_m": 3.0}).id == case.id
    )
    assert case.replace({"output.history_every_s": 0.1}).id == case.id
    assert case.replace({"joints.feet.friction_coefficient": 0.5}).id != case.id
    with pytest.raises(InputError, match="must be greater than 0"):
        case.replace({"bodies.slab.length_m": 0.0})


def test_mesh_file_of_a_body_counts_by_content_and_from_the_cases_folder(tmp_path):
    import meshio

    points = (
        np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
        * 0.3
    )
    meshio.Mesh(points, [("hexahedron", [list(range(8))])]).write(tmp_path / "cube.vtk")
    (tmp_path / "case.toml").write_text(
        '[bodies.cube]\nkind = "mesh"\nmesh_file = "cube.vtk"\nrigid = '
        'true\n[joints.foot]\nslave = "cube"\non = "ground"\n'
    )
    case = load_case(tmp_path / "case.toml")
    assert structure_model(case).parts[0].model.mass == pytest.approx(7850 * 0.027)
    before = case.id
    meshio.Mesh(2 * points, [("hexahedron", [list(range(8))])]).write(tmp_path / "cube.vtk")
    assert load_case(tmp_path / "case.toml").id != before
    (tmp_path / "cube.vtk").unlink()
    with pytest.raises(InputError, match="no such file"):
        load_case(tmp_path / "case.toml")


def test_coarse_plate_on_columns_stands_on_their_heads_whichever_is_named_first():
    case = structure(
        **merge(
            frame(slab=dict(element_size_m=0.6)),
            dict(joints=dict(heads=dict(between=["slab", "column"]))),
        )
    )
    made = structure_model(case)
    heads = [joint for joint in made.joints if joint.name.startswith("heads: column")]
    assert len(heads) == 4 and all(joint.round and joint.master == 4 for joint in heads)


@pytest.mark.parametrize(
    "joint, message",
    [
        (dict(between=["upper"]), "joint.between.*two names"),
        (dict(between=["ground", "ground"]), "joint.between.*must name a body"),
        (dict(between=["upper", "lower"], on="lower"), "joint.on.*must be left out beside between"),
        (dict(on="lower"), "joint.slave.*missing; or give"),
        (dict(between=["upper", "nobody"]), "joints.joint.*no such body"),
    ],
)
def test_wrong_bodies_of_a_joint_are_refused(joint, message):
    tables = stack()
    tables["joints"]["joint"] = joint
    with pytest.raises(InputError, match=message):
        structure(**tables)


def test_block_alone_is_a_structure():
    (part,), (joint,) = (lambda made: (made.parts, made.joints))(
        structure_model(structure(**block(rigid=True)))
    )
    assert (
        part.name == "block"
        and joint.master == -1
        and joint.law.shape == (len(part.model.surfaces["foot"].nodes), 3)
        and not joint.round
    )


def test_what_cannot_be_is_refused_before_models_are_made(monkeypatch):
    from fecolumn.structures import made_layout as made

    monkeypatch.setattr(made, "keep_body", lambda *_: pytest.fail("a reduced model was asked for"))
    tables = stack(
        links=dict(tie=LINK | dict(point_m=[0.3, 0, 0.3])), bodies=dict(upper=dict(height_m=0.6123))
    )
    with pytest.raises(InputError, match="links.tie.point_m"):
        structure_model(structure(**tables), "small.toml")


def test_a_link_at_the_circle_of_a_round_body_drawn_with_few_sides_is_taken():
    """Of a facet's middle it lies outside by r (1 - cos(pi / sides)), which is not told apart."""
    drum = dict(kind="cylinder", outer_diameter_m=1.2, height_m=6.0, element_size_m=0.3)
    tie = dict(kind="spring", body="drum", to="ground", to_point_m=[3.0, 0, 0], stiffness_n_m=1e6)
    for angle in np.linspace(0.0, np.pi / 4, 7):
        point = [0.6 * np.cos(angle), 0.6 * np.sin(angle), 1.0]
        case = case_from_tables(
            dict(
                bodies=dict(drum=drum | STONE),
                joints=dict(foot=dict(between=["drum", "ground"])),
                links=dict(tie=tie | dict(point_m=point)),
                integration=dict(engine="rigid", dt_s=1e-3, duration_s=0.1),
            ),
            "drum.toml",
        )
        assert len(structure_model(case).links) == 1


@pytest.mark.long
@pytest.mark.parametrize("wide", [0.5, 1.0])
@pytest.mark.parametrize("gap", [0.0, 0.02])
def test_a_slab_beside_a_wall_is_meshed_as_alone(wide, gap):
    """A side of the slab that another body meets needs no finer elements in its plan."""
    stone = dict(density_kg_m3=2400.0, youngs_modulus_pa=3e10, poissons_ratio=0.2)
    slab = dict(kind="slab", length_m=1.0, width_m=1.0, thickness_m=0.2) | stone
    wall = dict(kind="block", length_m=0.3, width_m=wide, height_m=0.2, element_size_m=0.1) | stone
    between = dict(between=["slab", "wall"]) | (dict(open=True) if gap else {})
    case = case_from_tables(
        dict(
            bodies=dict(slab=slab, wall=wall | dict(at_m=[0.65 + gap, 0, 0])),
            joints=dict(
                foot=dict(between=["slab", "ground"]),
                stands=dict(between=["wall", "ground"]),
                side=between,
            ),
            integration=dict(engine="rigid", duration_s=0.01),
        ),
        "case.toml",
    )
    model = structure_model(case)
    assert {part.name for part in model.parts} == {"slab", "wall"}


def test_what_is_glued_to_a_body_that_is_dropped_is_carried_by_it():
    tables = dict(
        bodies=dict(one=BLOCK | dict(at_m=[0, 0, 0.2]), row=BLOCK | dict(at_m=[0.4, 0, 0.2])),
        joints=dict(
            foot=dict(between=["one", "ground"]),
            glue=dict(
                between=["one", "row"],
                bond_tension_pa=1e6,
                bond_cohesion_pa=1e6,
                bond_stiffness_n_m3=1e8,
                bond_shear_stiffness_n_m3=1e8,
            ),
        ),
        integration=dict(engine="rigid"),
    )
    with pytest.warns(UserWarning, match="begin 0.2 m apart"):
        assert all(part.airborne for part in structure_model(structure(**tables)).parts)
    tables["joints"]["glue"] = dict(between=["one", "row"])
    with pytest.raises(InputError, match='nothing carries "row"'):
        structure_model(structure(**tables))
