"""Prisms, and arches of them: what they weigh, where their faces are, what is refused."""

import math

import numpy as np
import pytest
from small_structures import RIGID, STONE, structure

from fecolumn.case.case import case_from_tables
from fecolumn.case.case_text import full_form
from fecolumn.fem.modes import elastic_modes
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bending import rectangle_bending_frequency
from fecolumn.mesh.jacobian import corner_jacobians
from fecolumn.mesh.mass import mass_properties
from fecolumn.mesh.prism import polygon_counts, polygon_mesh
from fecolumn.simulation import run
from fecolumn.structures.bodies import drawing
from fecolumn.structures.layout import layout_of
from fecolumn.structures.reduction import body_of
from fecolumn.structures.shapes import counts_of
from fecolumn.structures.structure import structure_model

WEDGE = [[0.2, 0.0], [0.8, 0.0], [1.1, 1.3], [-0.1, 1.3]]
TRIANGLE = [[0.0, 0.0], [1.0, 0.2], [0.3, 0.9]]
NOTCHED = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.2, 1.0], [1.2, 0.4], [0.5, 0.4], [0.5, 1.5]]
DENSITY = 2700.0
RING = dict(
    kind="arch", mean_radius_m=2.0, thickness_m=0.3, width_m=0.5, voussoirs=7, element_size_m=1.0
)


def _case(joints=None, **body):
    return structure(
        bodies=dict(body=dict(rigid=True) | STONE | body),
        joints=joints or dict(foot=dict(between=["body", "ground"])),
    )


def _prism(outline, **keys):
    return dict(kind="prism", outline_m=outline, width_m=0.6, element_size_m=0.2) | keys


def _arch(joints=None, **keys):
    return case_from_tables(
        dict(
            bodies=dict(ring=RING | STONE | keys),
            joints=joints
            or dict(
                joints=dict(between=["ring", "ring"]), springings=dict(between=["ring", "ground"])
            ),
            contact=dict(friction_coefficient=0.7, interior_points=0),
            integration=dict(engine="rigid", duration_s=0.1),
        ),
        "arch.toml",
    )


def _of_polygon(corners):
    """Area, centre and second moments about it (xx, zz, xz) of a polygon by Green's formula."""
    x, z = np.array(corners).T
    u, w = np.roll(x, -1), np.roll(z, -1)
    cross = x * w - u * z
    area = cross.sum() / 2
    cx, cz = ((x + u) @ cross / 6 / area, (z + w) @ cross / 6 / area)
    xx = (x * x + x * u + u * u) @ cross / 12 - area * cx * cx
    zz = (z * z + z * w + w * w) @ cross / 12 - area * cz * cz
    xz = (x * w + 2 * x * z + 2 * u * w + u * z) @ cross / 24 - area * cx * cz
    sign = math.copysign(1.0, area)
    return sign * area, cx, cz, sign * xx, sign * zz, sign * xz


@pytest.mark.parametrize("outline", [WEDGE, TRIANGLE, NOTCHED], ids=["wedge", "triangle", "notch"])
@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("size", [0.1, 5.0])
def test_prism_has_the_mass_centre_and_inertia_of_greens_formula(outline, sense, size):
    one = drawing(_case(**_prism(outline[::sense], element_size_m=size)), "body", "small.toml")
    found = mass_properties(one.shape.mesh, DENSITY)
    area, x, z, xx, zz, xz = _of_polygon(outline)
    mass, across = DENSITY * area * 0.6, 0.6**2 / 12
    assert found.mass == pytest.approx(mass, rel=1e-12)
    assert found.centre == pytest.approx([x, 0.0, z], abs=1e-12)
    exact = mass * (np.array([[zz, 0, -xz], [0, xx + zz, 0], [-xz, 0, xx]]) / area)
    exact += mass * across * np.diag([1.0, 0.0, 1.0])
    assert found.inertia == pytest.approx(exact, rel=1e-11, abs=1e-11 * mass)
    assert corner_jacobians(one.shape.mesh).min() > 0


@pytest.mark.parametrize("outline", [WEDGE, TRIANGLE, NOTCHED], ids=["wedge", "triangle", "notch"])
def test_prism_has_the_faces_of_its_outline(outline):
    one = drawing(_case(**_prism(outline, at_m=[3.0, 1.0, 0.0])), "body", "small.toml")
    ends = np.array(outline)
    assert len(one.faces) == len(outline) + 2
    for start, end in zip(ends, np.roll(ends, -1, axis=0)):
        way = (end - start) / np.linalg.norm(end - start)
        normal = np.array([way[1], 0.0, -way[0]])
        (face,) = [
            face
            for face in one.faces
            if np.abs(face.normal - normal).max() < 1e-9
            and abs(face.offset - normal[[0, 2]] @ start) < 1e-12
        ]
        assert face.area == pytest.approx(0.6 * np.linalg.norm(end - start), rel=1e-12)


def test_corners_are_nodes_and_coarse_prisms_have_one_element_a_side():
    one = drawing(_case(**_prism(WEDGE, element_size_m=9.0)), "body", "small.toml")
    assert len(one.shape.mesh.cells) == 1
    assert {tuple(p) for p in np.round(one.points, 12).tolist()} == {
        (x, y, z) for x, z in WEDGE for y in (-0.3, 0.3)
    }
    for outline in (TRIANGLE, NOTCHED):
        points, _ = polygon_mesh(np.array(outline), 0.3)
        assert all(np.abs(points - corner).sum(axis=1).min() == 0.0 for corner in outline)


def test_a_symmetric_outline_has_a_symmetric_mesh():
    points, _ = polygon_mesh(np.array([[-0.3, 0.0], [0.3, 0.0], [0.7, 1.0], [-0.7, 1.0]]), 0.13)
    there = {tuple(np.round(point, 14) + 0.0) for point in points}
    assert there == {tuple(np.round(point, 14) + 0.0) for point in points * [-1.0, 1.0]}


def test_prism_along_z_stands_on_its_outline():
    one = drawing(_case(**_prism(TRIANGLE, along="z", width_m=1.5)), "body", "small.toml")
    assert one.points[:, 2].min() == 0.0 and one.points[:, 2].max() == 1.5
    foot = min(one.faces, key=lambda face: face.normal[2])
    assert foot.normal == pytest.approx([0, 0, -1]) and foot.area == pytest.approx(
        _of_polygon(TRIANGLE)[0], rel=1e-12
    )


def test_turned_prism_is_turned_about_its_place():
    straight, turned = (
        drawing(_case(**_prism(WEDGE, turned_deg=angle)), "body", "small.toml").points
        for angle in (0.0, 90.0)
    )
    assert turned == pytest.approx(straight[:, [1, 0, 2]] * [-1, 1, 1], abs=1e-15)


def test_upright_prism_bends_as_a_beam_does():
    case = _case(
        kind="prism",
        outline_m=[[-0.2, 0], [0.2, 0], [0.2, 4.0], [-0.2, 4.0]],
        width_m=0.4,
        rigid=False,
    )
    one = drawing(case, "body", "small.toml")
    assert elastic_modes(body_of(one.shape, one.material), 1)[0][0] / 2 / np.pi == pytest.approx(
        rectangle_bending_frequency(0.4, 0.4, 4.0, 50e9, 0.0, DENSITY), rel=0.02
    )


def test_counts_are_told_before_the_mesh_is_made():
    for order in (1, 2):
        body = _case(**_prism(WEDGE, element_order=order)).bodies["body"]
        cells, nodes = counts_of("body", body, "small.toml")
        made = drawing(_case(**_prism(WEDGE)), "body", "small.toml").shape.mesh
        assert cells == len(made.cells) and (order == 2 or nodes == len(made.points))
    for outline in (TRIANGLE, NOTCHED):
        for size in (0.05, 0.5):
            _, quads = polygon_mesh(np.array(outline), size)
            assert polygon_counts(np.array(outline), size, 1)[0] == pytest.approx(
                len(quads), rel=0.6, abs=4
            )
    with pytest.raises(InputError, match=r"element_size_m = 0.001: .* would fit"):
        layout_of(_case(**_prism(NOTCHED, element_size_m=0.001)), "small.toml")


@pytest.mark.parametrize(
    "keys, words",
    [
        (dict(width_m=-0.1), r"bodies.body.width_m = -0.1: must be greater than 0"),
        (dict(outline_m=[[0, 0], [1, 0]]), "outline_m.*at least three corners"),
        (dict(outline_m=[[0, 0], [1, 0, 0], [1, 1]]), "outline_m.*two numbers"),
        (dict(outline_m=[[0, 0], [1, 0], [1, 1], [0, 0]]), "1 and 4 are both"),
        (dict(outline_m=[[0, 0], [1, 0], [2, 0]]), "on a line"),
        (
            dict(outline_m=[[0, 0], [1, 1], [1, 0], [0, 1.5]]),
            "the side from corner 1 to 2 meets that from corner 3 to 4",
        ),
        (dict(outline_m=[[0, 0], [2, 0], [1, 0], [1, 1]]), "cross or touch itself"),
        (dict(outline_m=[[0, 0], [2, 0], [2, 1], [1, 0], [0, 1]]), "cross or touch itself"),
        (dict(outline_m=[[0, 0], [1, 0], [1, math.inf]]), "outline_m.*must lie in"),
        (dict(along="x"), "along.*one of y, z"),
        (dict(coarse_size_m=1.0), "coarse_size_m = 1.0: says nothing of a prism"),
        (dict(at_m=[0, 0]), "at_m.*three numbers"),
    ],
)
def test_prisms_that_cannot_be_are_refused(keys, words):
    with pytest.raises(InputError, match=words):
        _case(**_prism(WEDGE) | keys)


@pytest.mark.parametrize("sides", [1, 4])
def test_arch_has_the_mass_of_its_ring_and_neighbours_have_equal_faces(sides):
    case = _arch(arc_sides=sides, from_deg=20.0, to_deg=155.0)
    assert list(case.bodies) == [f"ring {number}" for number in range(1, 8)]
    drawings = [drawing(case, name, "arch.toml") for name in case.bodies]
    masses = [mass_properties(one.shape.mesh, DENSITY).mass for one in drawings]
    exact = DENSITY * 0.5 * 2.0 * 0.3 * math.radians(135.0)
    assert masses == pytest.approx([exact / 7] * 7, rel=1e-12)
    assert all(len(one.faces) == 2 * sides + 4 for one in drawings)
    for number, (one, other) in enumerate(zip(drawings, drawings[1:]), 1):
        angle = math.radians(20.0 + 135.0 / 7 * number)
        normal = np.array([-math.sin(angle), 0.0, math.cos(angle)])
        faces = [
            next(f for f in each.faces if np.abs(f.normal - sign * normal).max() < 1e-9)
            for each, sign in ((one, 1), (other, -1))
        ]
        assert all(abs(face.offset) < 1e-9 for face in faces), "a joint is radial"
        corners = [np.unique(np.round(face.corners.reshape(-1, 3), 9), axis=0) for face in faces]
        assert corners[0] == pytest.approx(corners[1], abs=2e-9)


def test_a_joint_of_an_arch_is_of_each_voussoir_and_its_neighbours():
    layout = layout_of(_arch(), "arch.toml")
    pairs = {
        frozenset((one.slave[0], one.master and one.master[0]))
        for one in layout.contacts
        if one.pair < 0
    }
    ring = [f"ring {number}" for number in range(1, 8)]
    assert pairs == {frozenset(pair) for pair in zip(ring, ring[1:])} | {
        frozenset((end, None)) for end in (ring[0], ring[-1])
    }


def test_an_arch_is_its_voussoirs_written_one_by_one_and_is_replaced_as_an_arch():
    case = _arch(mass_kg=700.0, density_kg_m3=None)
    again = case_from_tables(full_form(case), "arch.toml")
    assert again == case and again.id == case.id and len(again.bodies) == 7
    assert case.bodies["ring 3"].mass_kg == 100.0
    assert set(case.tables()["bodies"]) == {"ring"}
    thicker = case.replace({"bodies.ring.thickness_m": 0.4, "bodies.ring.voussoirs": 9})
    assert len(thicker.bodies) == 9 and thicker.arches["ring"].thickness_m == 0.4
    assert again.copies_of("ring") == case.copies_of("ring")
    assert case.copies_of("ring 2") == (("ring 2", 0),)
    with pytest.raises(KeyError):
        case.copies_of("ring 8")


@pytest.mark.parametrize(
    "keys, words",
    [
        (
            dict(thickness_m=4.0),
            r"bodies.ring.thickness_m = 4.0: must be less than twice mean_radius_m, 4 m",
        ),
        (dict(from_deg=180.0), "to_deg = 180.0: must be greater than from_deg = 180 deg"),
        (dict(from_deg=-180.0, to_deg=180.0), "to_deg.*by less than 360"),
        (dict(voussoirs=1), r"voussoirs = 1: must lie in \[2, 500\]"),
        (dict(voussoirs=2, arc_sides=1), "voussoirs = 2: must be more, or arc_sides"),
        (dict(width_m=0.0), "width_m = 0.0: must be greater than 0"),
        (dict(copies_m=[[0, 0, 0], [0, 2, 0]]), "copies_m.*a name of its own"),
        (dict(material="jade"), "material.*no such table"),
        (dict(thikness_m=0.2), "did you mean bodies.ring.thickness_m"),
    ],
)
def test_arches_that_cannot_be_are_refused(keys, words):
    with pytest.raises(InputError, match=words):
        _arch(**keys)


def test_names_beside_an_arch_are_told():
    with pytest.raises(InputError, match="no such body or ground; did you mean ring"):
        _arch(dict(joints=dict(between=["ring", "rng 3"])))
    with pytest.raises(InputError, match=r"bodies.ring 3: .*ring"):
        _case(**_prism(WEDGE)).replace(
            {"bodies.ring": RING | STONE, "bodies.ring 3": _prism(WEDGE)}
        )
    with pytest.raises(InputError, match=r'observed.*such as "ring 1"'):
        _arch().replace({"observed": "ring"})
    link = dict(kind="spring", stiffness_n_m=1e5, body="ring", to_point_m=[0, 0, 5])
    with pytest.raises(InputError, match=r"links.tie.body = .ring.: must be one body, such as"):
        _arch().replace({"links.tie": link})


@pytest.mark.long
@pytest.mark.parametrize("count, least", [(9, 0.102134), (11, 0.104910), (17, 0.105593)])
def test_an_arch_stands_from_the_thickness_of_limit_analysis_on(count, least):
    """Least thickness over mean radius of a semicircular arch on springers, by a linear programme
    of another program with the true sectors: to 1e-3.
    """
    for share, stands in ((0.999, False), (1.001, True)):
        case = _arch(mean_radius_m=3.0, thickness_m=3.0 * least * share, voussoirs=count)
        if stands:
            assert len(structure_model(case).parts) == count
        else:
            with pytest.raises(InputError, match="cannot rest"):
                structure_model(case)


def _differing(**own):
    """An arch whose third voussoir has keys of its own."""
    return _arch().replace({"bodies": {"ring": RING | STONE, "ring 3": own}})


@pytest.mark.long
def test_a_voussoir_may_have_a_material_of_its_own_and_the_case_is_written_so():
    case = _differing(density_kg_m3=1500.0, youngs_modulus_pa=5e9)
    plain = _arch()
    assert case.bodies["ring 3"].density_kg_m3 == 1500.0
    assert {one: case.bodies[one] for one in plain.bodies if one != "ring 3"} == {
        one: body for one, body in plain.bodies.items() if one != "ring 3"
    }
    assert case.bodies["ring 3"].outline_m == plain.bodies["ring 3"].outline_m
    assert case.tables(defaults=False)["bodies"]["ring 3"] == dict(
        density_kg_m3=1500.0, youngs_modulus_pa=5e9
    )
    assert set(case.tables()["bodies"]) == {"ring", "ring 3"}
    again = case_from_tables(full_form(case), "arch.toml")
    assert again == case and again.id == case.id != plain.id
    thicker = case.replace({"bodies.ring.thickness_m": 0.4})
    assert thicker.bodies["ring 3"].density_kg_m3 == 1500.0
    assert len(structure_model(case).parts) == 7


def test_a_voussoir_of_another_material_has_the_damping_of_that():
    case = _arch().replace(
        {
            "materials": {"stone": {}, "brick": {"damping_ratio": 0.2}},
            "bodies.ring.damping_ratio": 0.05,
            "bodies": {"ring 3": {"material": "brick"}},
        }
    )
    assert case.bodies["ring 3"].damping_ratio is None
    assert case.bodies["ring 2"].damping_ratio == 0.05
    assert case_from_tables(full_form(case), "arch.toml") == case


def test_a_key_of_a_voussoir_stands_instead_of_those_of_its_arch_that_say_the_same():
    light = _differing(mass_kg=10.0).bodies["ring 3"]
    assert light.mass_kg == 10.0 and light.density_kg_m3 is None
    made = _arch().replace(
        {
            "materials.tuff": dict(density_kg_m3=1300.0, youngs_modulus_pa=4e9),
            "bodies": {"ring": RING | STONE, "ring 3": dict(material="tuff")},
        }
    )
    assert made.bodies["ring 3"].material == "tuff"
    assert made.bodies["ring 3"].density_kg_m3 is None


@pytest.mark.parametrize(
    "name, own, words",
    [
        ("ring 3", dict(thickness_m=0.2), "bodies.ring 3: is a voussoir.*which says its thickness"),
        ("ring 3", dict(at_m=[0, 0, 1]), "which says its at_m; of its own are modes, damping"),
        ("ring 3", dict(density_kg_m3=-1.0), "bodies.ring 3.density_kg_m3 = -1.0: must be"),
        ("ring 8", dict(density_kg_m3=1e3), "bodies.ring 8: no such voussoir: ring has 7"),
        ("ring 3", dict(material="jade"), "bodies.ring 3.material.*no such table"),
    ],
)
def test_keys_that_a_voussoir_cannot_have_are_refused(name, own, words):
    with pytest.raises(InputError, match=words):
        _arch().replace({"bodies": {"ring": RING | STONE, name: own}})


def test_a_joint_of_two_voussoirs_stands_beside_that_of_all():
    """The joint between voussoirs 3 and 4 is smoother than the others."""
    joints = dict(_arch().tables()["joints"])
    smooth = dict(between=["ring 3", "ring 4"], friction_coefficient=0.2)
    for order in ({"smooth": smooth} | joints, joints | {"smooth": smooth}):
        model = structure_model(_arch().replace({"joints": order}))
        found = {
            tuple(sorted((model.parts[one.slave].name, model.parts[one.master].name))): one.friction
            for one in model.joints
            if one.master >= 0
        }
        assert len(found) == 6
        assert {pair for pair, mu in found.items() if mu == 0.2} == {("ring 3", "ring 4")}


def test_bodies_that_meet_in_several_faces_have_an_interface_of_its_own_name_for_each(tmp_path):
    """A step: two level faces and an upright one."""
    step = dict(kind="prism", width_m=1.0, element_size_m=0.5) | STONE | RIGID
    case = structure(
        bodies=dict(
            low=step | dict(outline_m=[[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]),
            up=step | dict(outline_m=[[0, 2], [1, 2], [1, 1], [2, 1], [2, 3], [0, 3]]),
        ),
        joints=dict(foot=dict(between=["low", "ground"]), joint=dict(between=["up", "low"])),
        integration=dict(engine="rigid", duration_s=0.01),
    )
    found = run(case, tmp_path / "out", quiet=True)["interfaces"]
    assert list(found) == [
        "foot: low on ground",
        "joint: low on up",
        "joint: up on low",
        "joint: up on low, 2",
    ]
    forces = {name: one["force_max_n"] for name, one in found.items()}
    weight = 3 * 2700 * 9.80665  # of each; the upright face takes little of it
    assert forces["foot: low on ground"] == pytest.approx(2 * weight, rel=1e-3)
    carried = forces["joint: up on low"] + forces["joint: up on low, 2"]
    assert carried == pytest.approx(weight, rel=0.02)
