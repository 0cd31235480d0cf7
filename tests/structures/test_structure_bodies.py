"""Bodies of a structure have the mass, inertia, frequencies and statics of what they stand for."""

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.spatial import cKDTree
from small_structures import BLOCK, STONE, block, frame, structure

from fecolumn.contact.rim import Rim
from fecolumn.fem.modes import elastic_modes
from fecolumn.foundation.schema import InputError
from fecolumn.mesh.bending import free_free_bending_frequency, rectangle_bending_frequency
from fecolumn.structures.bodies import drawing
from fecolumn.structures.faces import apart_from_side
from fecolumn.structures.patches import master_patch
from fecolumn.structures.reduction import body_of
from fecolumn.structures.structure import structure_model


def _masses(**body):
    """Mass [kg], centre and inertia of a body, reduced rigidly: its mesh alone."""
    case = structure(
        bodies=dict(body=body | STONE | dict(rigid=True)),
        joints=dict(foot=dict(between=["body", "ground"])),
    )
    model = structure_model(case).parts[0].model
    return model.mass, model.center, model.inertia, model


@pytest.mark.parametrize("wall", [0.02, None])
def test_round_body_has_the_mass_and_inertia_of_the_circle(wall):
    outer, height = 0.25, 1.6
    inner = outer - wall if wall else 0.0
    mass, center, inertia, model = _masses(
        outer_diameter_m=2 * outer,
        height_m=height,
        **(dict(kind="tube", wall_m=wall) if wall else dict(kind="cylinder")),
    )
    exact = 2700 * np.pi * (outer**2 - inner**2) * height
    assert mass == pytest.approx(exact, rel=1e-12) and center == pytest.approx(
        [0, 0, height / 2], abs=1e-12
    )
    across = exact * ((outer**2 + inner**2) / 4 + height**2 / 12)
    assert np.diag(inertia) == pytest.approx(
        [across, across, exact * (outer**2 + inner**2) / 2], rel=2e-3
    )
    foot = model.surfaces["foot"]
    assert Rim.find(foot.plane(model.arms[foot.nodes])).radius == pytest.approx(outer, rel=1e-10)


def test_body_of_a_stated_mass_has_it_flange_included():
    mass, center, _, model = _masses(
        kind="tube",
        outer_diameter_m=0.2,
        wall_m=0.02,
        height_m=1.0,
        flange=dict(outer_diameter_m=0.4, thickness_m=0.05),
    )
    tube, plate = np.pi * (0.1**2 - 0.08**2) * 1.0, np.pi * 0.2**2 * 0.05
    assert mass == pytest.approx(2700 * (tube + plate), rel=1e-3)
    assert center[2] == pytest.approx((tube * 0.55 + plate * 0.025) / (tube + plate), rel=1e-3)
    assert model.surfaces["foot"].areas.sum() == pytest.approx(np.pi * 0.2**2, rel=0.03)
    case = structure(
        bodies=dict(
            body=dict(kind="cylinder", outer_diameter_m=0.2, height_m=1.0, mass_kg=77.0, rigid=True)
        ),
        joints=dict(foot=dict(between=["body", "ground"])),
    )
    assert structure_model(case).parts[0].model.mass == pytest.approx(77.0, rel=1e-12)


@pytest.fixture(scope="module")
def pillar():
    """A block between the ground and a rigid block that is a little wider, so that all nodes of
    both ends are contact points.
    """
    top = dict(
        kind="block", length_m=0.41, width_m=0.21, height_m=0.2, at_m=[0, 0, 1.2], rigid=True
    )
    case = structure(
        **block(dict(head=dict(between=["block", "top"])))
        | dict(bodies=dict(block=BLOCK | dict(element_order=2, coarse_size_m=0.3), top=top))
    )
    return structure_model(case).parts[0].model


def test_block_has_its_mass_inertia_and_bending_frequency(pillar):
    mass = 2700 * 0.4 * 0.2 * 1.2
    assert pillar.mass == pytest.approx(mass, rel=1e-12)
    assert np.diag(pillar.inertia) == pytest.approx(
        mass / 12 * np.array([0.2**2 + 1.2**2, 0.4**2 + 1.2**2, 0.4**2 + 0.2**2]), rel=1e-12
    )
    assert pillar.frequencies[0] / 2 / np.pi == pytest.approx(
        rectangle_bending_frequency(0.2, 0.4, 1.2, 50e9, 0.0, 2700), rel=0.01
    )


@pytest.mark.parametrize(
    "body, exact",
    [
        (
            dict(kind="block", length_m=0.4, width_m=0.4, height_m=2.0),
            lambda *material: rectangle_bending_frequency(0.4, 0.4, 2.0, *material),
        ),
        (
            dict(kind="cylinder", outer_diameter_m=0.3, height_m=2.0),
            lambda *material: free_free_bending_frequency(0.15, 0.0, 2.0, *material),
        ),
        (
            dict(kind="tube", outer_diameter_m=0.3, wall_m=0.02, height_m=2.0),
            lambda *material: free_free_bending_frequency(0.15, 0.13, 2.0, *material),
        ),
    ],
)
def test_bodies_bend_as_beams_do_at_the_sizes_they_are_given(body, exact):
    case = structure(
        bodies=dict(body=body | STONE | dict(poissons_ratio=0.2)),
        joints=dict(foot=dict(between=["body", "ground"])),
    )
    one = drawing(case, "body", "small.toml")
    assert elastic_modes(body_of(one.shape, one.material), 1)[0][0] / 2 / np.pi == pytest.approx(
        exact(50e9, 0.2, 2700.0), rel=0.02
    )


def test_pressed_pillar_shortens_by_hookes_law(pillar):
    """Equal pressure p on both ends of a bar with Poisson's ratio 0 shortens it by p L / E,
    whatever its mesh.
    """
    foot, head = pillar.surfaces["foot"], pillar.surfaces["head"]
    force = np.zeros((len(pillar.arms), 3))
    force[foot.nodes, 2], force[head.nodes, 2] = 1e6 * foot.areas, -1e6 * head.areas
    moved = np.einsum("ijab,jb->ia", pillar.flexibility, force)
    assert foot.areas.sum() == pytest.approx(0.08, rel=1e-12)
    assert moved[foot.nodes, 2] - moved[head.nodes, 2][:, None] == pytest.approx(
        np.full((len(foot.nodes),) * 2, 1e6 * 1.2 / 50e9), rel=1e-6
    )


def test_pushed_pillar_is_compressed_as_a_rocket_is(pillar):
    """Pressure on one end accelerates the bar; it falls linearly to 0 at the other, and shortens
    the bar by half as much.
    """
    foot, head = pillar.surfaces["foot"], pillar.surfaces["head"]
    force = np.zeros((len(pillar.arms), 3))
    force[foot.nodes, 2] = 1e6 * foot.areas
    moved = np.einsum("ijab,jb->ia", pillar.flexibility, force)[:, 2]
    assert foot.areas @ moved[foot.nodes] / 0.08 - head.areas @ moved[
        head.nodes
    ] / 0.08 == pytest.approx(1e6 * 1.2 / 50e9 / 2, rel=1e-5)


def test_modes_are_part_of_the_flexibility(pillar):
    """What the modes kept leave of the flexibility is that of the others: no direction is stiffer
    than nothing.
    """
    modal = np.einsum("iam,jbm,m->ijab", pillar.shapes, pillar.shapes, 1 / pillar.frequencies**2)
    rest = (pillar.flexibility - modal).transpose(0, 2, 1, 3).reshape(3 * len(pillar.arms), -1)
    assert np.linalg.eigvalsh((rest + rest.T) / 2).min() > -1e-8 * np.abs(pillar.flexibility).max()


def test_rigid_body_gives_as_a_punch_does():
    case = structure(**block(rigid=True))
    model = structure_model(case).parts[0].model
    springs = 1 / np.array([model.flexibility[i, i, 2, 2] for i in range(len(model.arms))])
    assert springs.sum() == pytest.approx(2 * 50e9 * np.sqrt(0.4 * 0.2 / np.pi), rel=1e-12)
    assert (
        len(model.frequencies) == 0
        and model.dofs == 0
        and model.mass == pytest.approx(2700 * 0.4 * 0.2 * 1.2)
    )
    stated = (
        structure_model(structure(**block(rigid=True, contact_stiffness_n_m3=1e9))).parts[0].model
    )
    assert (
        1 / np.array([stated.flexibility[i, i, 0, 0] for i in range(len(stated.arms))])
    ).sum() == pytest.approx(1e9 * 0.08, rel=1e-12)


def test_copies_share_one_model_and_equal_bodies_have_equal_ones():
    tables = frame()
    parts = structure_model(structure(**tables)).parts
    assert [part.name for part in parts] == ["column 1", "column 2", "column 3", "column 4", "slab"]
    assert all(part.model is parts[0].model for part in parts[:4])
    twin = dict(block(rigid=True)["bodies"]["block"], at_m=[1.0, 0.0, 0.0])
    case = structure(
        **block(dict(other=dict(between=["twin", "ground"])), rigid=True)
        | dict(bodies=dict(block=BLOCK | dict(rigid=True), twin=twin))
    )
    block_part, twin_part = structure_model(case).parts
    for name in ("arms", "flexibility", "inertia"):
        assert np.array_equal(getattr(block_part.model, name), getattr(twin_part.model, name))


def test_slab_has_contact_points_only_around_its_columns():
    structured = structure_model(structure(**frame()))
    model = structured.parts[4].model
    surface = model.surfaces["foot, master"]
    plane = surface.plane(model.arms[surface.nodes])
    assert np.abs(plane[:, 2]).max() < 1e-12 and surface.axes[:, 2] == pytest.approx([0, 0, -1])
    # heads of 0.2 m, and a quarter of that to each side
    assert np.all(
        np.abs(np.abs(model.arms[surface.nodes][:, :2]) - [1.0, 0.8]).max(axis=1)
        < 0.1 + 0.05 + 1e-9
    )
    a, b, c = (plane[surface.triangles[:, k], :2] for k in range(3))
    areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    # of elements at the corners of that, one of two triangles may lie farther away
    assert areas.min() > 0 and areas.sum() == pytest.approx(4 * 0.3**2 - 8 * 0.05**2 / 2, rel=1e-9)


def test_distances_of_triangles_from_a_side_are_those_of_their_points():
    rng = np.random.default_rng(1)
    triangles, shares = (
        rng.uniform(-1, 1, (40, 3, 2)),
        np.array(
            [(a, b, 1 - a - b) for a in np.linspace(0, 1, 80) for b in np.linspace(0, 1 - a, 80)]
        ),
    )
    for side in ([[-0.9, -1.2], [1.1, 0.4]], [[0.2, 0.1], [0.2, 0.1]], [[1.5, 1.5], [1.6, 1.5]]):
        along = np.linspace(side[0], side[1], 300)
        sampled = np.array([cKDTree(shares @ one).query(along)[0].min() for one in triangles])
        found = apart_from_side(triangles, np.array(side))
        assert found == pytest.approx(sampled, abs=0.03) and np.all(found <= sampled + 1e-12)


@pytest.mark.parametrize("way", [0.02, 0.05])
def test_a_master_is_known_as_far_as_its_slave_may_slide_and_no_farther(way):
    one = drawing(structure(**block(rigid=False, element_size_m=0.02)), "block", "small.toml")
    face = next(face for face in one.faces if face.normal[2] > 0.5)
    # no element ends just there
    spot = face.box.mean(axis=0) + [0.0031, 0.0017]
    whole, patch = (master_patch(face, 1, [(*spot, *spot, reach)]) for reach in (2.0, way))
    corners = [(each.positions @ each.axes[:, :2])[each.triangles] for each in (whole, patch)]
    near = [apart_from_side(triangles, np.stack([spot, spot])) < way for triangles in corners]
    assert near[1].all() and near[0].sum() == len(near[1]) < len(near[0])


@pytest.mark.parametrize("order", [1, 2])
def test_triangles_cover_a_face_of_any_order(order):
    case = structure(**block(element_order=order, rigid=False))
    one = drawing(case, "block", "small.toml")
    face = next(face for face in one.faces if face.normal[2] > 0.5)
    patch = master_patch(face, order, [(0, 0, 0, 0, 2.0)])
    a, b, c = (patch.positions[patch.triangles[:, k], :2] for k in range(3))
    areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert (
        areas.min() > 0
        and areas.sum() == pytest.approx(0.08)
        and patch.areas.sum() == pytest.approx(0.08)
    )
    assert patch.outlines.sum() == 2 * order * (4 + 2)


def test_labels_of_a_picture_stand_on_the_side_of_what_they_name():
    """So that no line from a label to a column crosses another column: left ones are named to the
    left.
    """
    from fecolumn.pictures.mesh_picture import _labels
    from fecolumn.pictures.off_screen import projection_axes
    from fecolumn.structures.structure import structure_model

    tendon = dict(
        kind="tendon", body="column", to="slab", to_point_m=[0, 0, 1.5], stiffness_n_m=1e5
    )
    right = projection_axes()[0]
    labels = _labels(
        structure_model(structure(**frame(links=dict(tendon=tendon)))), right, 0.0, 2.0
    )
    sides = {text: (point @ right, side) for text, point, _, side in labels}
    assert len(labels) == 5 + 4 + 8 and sides["slab"][1] == "left"
    assert all(
        side == ("left" if along < 0 else "right")
        for text, (along, side) in sides.items()
        if text != "slab"
    )
    named = {text: tuple(np.round(point, 6)) for text, point, _, _ in labels}
    # a tendon in a column is named beside the column's name
    assert len(set(named.values())) == len(labels)


def test_labels_that_do_not_fit_beside_a_picture_are_counted_and_bodies_numbered():
    from fecolumn.pictures.mesh_picture import _fitted, _labels
    from fecolumn.structures.structure import structure_model

    labels = _labels(structure_model(structure(**frame())), np.array([1.0, 0, 0]), 0.0, 2.0)
    assert _fitted(labels, len(labels)) == (labels, [])
    few, numbers = _fitted(labels, 3)
    texts = {text for text, *_ in few}
    assert texts >= {"column (4)", "slab"} and len(few) == 4
    assert [number for number, _ in numbers] == ["1", "2", "3", "4"]


@pytest.mark.parametrize("bottom, top", [(0.5, 0.5), (0.5, 0.35), (0.3, 0.8)])
def test_cone_has_the_mass_centre_and_feet_of_the_frustum(bottom, top):
    height = 1.2
    mass, center, inertia, model = _masses(
        kind="cone", bottom_diameter_m=2 * bottom, top_diameter_m=2 * top, height_m=height
    )
    z = np.linspace(0, height, 20001)
    radius = bottom + (top - bottom) * z / height
    exact = 2700 * np.pi * height * (bottom**2 + bottom * top + top**2) / 3
    middle = 2700 * np.pi * trapezoid(radius**2 * z, z) / exact
    about = 2700 * np.pi * trapezoid(radius**4 / 4 + radius**2 * (z - middle) ** 2, z)
    assert mass == pytest.approx(exact, rel=1e-12)
    assert center == pytest.approx([0, 0, middle], abs=1e-3 * height)
    assert np.diag(inertia) == pytest.approx(
        [about, about, 2700 * np.pi * trapezoid(radius**4 / 2, z)], rel=3e-3
    )
    foot = model.surfaces["foot"]
    assert Rim.find(foot.plane(model.arms[foot.nodes])).radius == pytest.approx(bottom, rel=1e-10)


def test_cones_stand_on_one_another_with_round_rims_that_fit():
    drum = dict(kind="cone", height_m=0.5, rigid=True) | STONE
    case = structure(
        bodies=dict(
            low=drum | dict(bottom_diameter_m=0.6, top_diameter_m=0.5),
            up=drum | dict(bottom_diameter_m=0.5, top_diameter_m=0.4, at_m=[0, 0, 0.5]),
        ),
        joints=dict(foot=dict(between=["low", "ground"]), bed=dict(between=["low", "up"])),
    )
    joints = structure_model(case).joints
    assert [joint.round for joint in joints if joint.pair < 0] == [True, True]
    with pytest.raises(InputError, match="top_diameter_m = 0.0: must be greater than 0"):
        case.replace({"bodies.up.top_diameter_m": 0.0})
    with pytest.raises(InputError, match="element_size_m.*fewer than 12 elements around"):
        case.replace({"bodies.up.element_size_m": 0.2})
