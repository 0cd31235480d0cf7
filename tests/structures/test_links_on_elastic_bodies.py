"""Links pull at the surface of elastic bodies in the reduced engine: a rod on a spring, a post
pulled at its top, and what a body's shape is between its nodes.
"""

import numpy as np
import pytest
from scipy.optimize import brentq
from small_structures import structure

from fecolumn.foundation.toml_file import merge
from fecolumn.structures.made_layout import kept_keys
from fecolumn.structures.store import kept_body, shape_at
from fecolumn.structures.structure import structure_model
from fecolumn.verification.structures_feet import columns_and_rows

LENGTH, SIDE, YOUNG, DENSITY = 2.0, 0.4, 1e8, 2000.0
MASS = LENGTH * SIDE**2 * DENSITY
STIFFNESS = YOUNG * SIDE**2 / LENGTH  # of the spring: that of the rod


def rod(**tables):
    """A rod that lies on a frictionless floor, a spring of its own stiffness at its end."""
    bar = dict(
        kind="block",
        length_m=LENGTH,
        width_m=SIDE,
        height_m=SIDE,
        density_kg_m3=DENSITY,
        youngs_modulus_pa=YOUNG,
        poissons_ratio=0.0,
        element_size_m=0.1,
    )
    spring = dict(
        kind="spring",
        body="rod",
        point_m=[LENGTH / 2, 0, SIDE / 2],
        to_point_m=[LENGTH / 2 + 3.0, 0, SIDE / 2],
        stiffness_n_m=STIFFNESS,
    )
    return structure(
        **merge(
            dict(
                bodies=dict(rod=bar),
                joints=dict(foot=dict(between=["rod", "ground"])),
                links=dict(spring=spring),
                contact=dict(friction_coefficient=0.0, interior_points=0),
                integration=dict(dt_s=2e-4, n_modes=30, alpha_hht=0.0, start="drawn"),
                initial=dict(rod=dict(velocity_m_s=[0.05, 0, 0])),
            ),
            tables,
        )
    )


def test_a_spring_at_the_end_of_a_rod_swings_at_the_frequency_of_the_elastic_rod():
    """x tan x = k L / EA, x = w L / c: 0.8603 where both are as stiff; of the rigid rod x = 1. With
    the modes that are kept 1 - k / (m w^2) + k sum phi^2 / (w_i^2 - w^2) = 0.
    """
    case = rod()
    model = structure_model(case)
    own = model.parts[0].model.frequencies
    along = model.links[0].shape_a[0]
    speed = np.sqrt(YOUNG / DENSITY) / LENGTH
    axial = np.flatnonzero(np.abs(along) > 0.5 * np.sqrt(2 / MASS))
    assert len(axial) >= 1
    assert own[axial[0]] == pytest.approx(np.pi * speed, rel=0.01)
    assert abs(along[axial[0]]) == pytest.approx(np.sqrt(2 / MASS), rel=0.01)

    def left(w):
        return 1 - STIFFNESS / (MASS * w**2) + STIFFNESS * np.sum(along**2 / (own**2 - w**2))

    expected = brentq(left, 0.3 * speed, 0.99 * own[axial[0]])
    columns, _ = columns_and_rows(case, 0.3)
    force, time = columns["link/spring/tension"], columns["time"]
    crossed = np.flatnonzero(force[:-1] * force[1:] < 0)
    times = time[crossed] - force[crossed] * 2e-4 / (force[crossed + 1] - force[crossed])
    found = np.pi * (len(times) - 1) / (times[-1] - times[0])
    assert found == pytest.approx(expected, rel=0.01)
    exact = brentq(lambda x: x * np.tan(x) - 1, 0.1, 1.5)
    assert exact == pytest.approx(0.8603, abs=1e-4)
    assert exact < found / speed < 1.06 * exact
    kinetic = np.ptp(columns["energy/kinetic"])
    assert np.ptp(columns["energy/closure"]) < 1e-11 * kinetic
    end = columns["body/rod/displacement"][:, 0] + columns["link/spring/elongation"]
    assert np.abs(end).max() > 0.1 * np.abs(columns["link/spring/elongation"]).max()


@pytest.mark.long
def test_a_glued_post_pulled_at_its_top_bends_as_a_cantilever():
    """F L^3 / 3 E I + F L / (5/6 G A), and the turn of its foot on a layer of k, F L^2 / k I; with
    the weight's own moment and what the modes leave out within a tenth.
    """
    height, side, young, pull = 2.0, 0.2, 1e9, 200.0
    post = dict(
        kind="block",
        length_m=side,
        width_m=side,
        height_m=height,
        density_kg_m3=2000.0,
        youngs_modulus_pa=young,
        poissons_ratio=0.0,
        element_size_m=0.05,
    )
    wire = dict(
        kind="tendon",
        body="post",
        point_m=[0, 0, height],
        to_point_m=[100.0, 0, height],
        stiffness_n_m=20.0,
        prestress_n=pull,
    )
    stiff = 1e9
    glue = dict(bond_tension_pa=1e7, bond_stiffness_n_m3=stiff, stiffness_n_m3=stiff)
    case = structure(
        bodies=dict(post=post),
        joints=dict(foot=dict(between=["post", "ground"]) | glue),
        links=dict(wire=wire),
        contact=dict(friction_coefficient=0.7, interior_points=25),
        integration=dict(dt_s=1e-4, n_modes=30, start="drawn"),
    )
    columns, _ = columns_and_rows(case, 0.3)
    (joint,) = structure_model(case).joints
    own = structure_model(case).parts[0].model
    face = own.surfaces[joint.slave_surface]
    turned = stiff * (face.areas @ own.arms[face.nodes, 0] ** 2)
    force = columns["link/wire/tension"][0]
    bent = force * height**3 / (3 * young * side**4 / 12)
    bent += force * height / (5 / 6 * young / 2 * side**2) + force * height**2 / turned
    # pulled at once it swings to twice as far and back
    moved = columns["mark/post.top/displacement"][:, 0]
    assert moved.max() / 2 == pytest.approx(bent, rel=0.1) and bent > 1e-3
    assert np.abs(moved[-1000:]).min() < 0.2 * moved.max()


def test_shapes_between_nodes_are_those_of_a_linear_field_exactly_at_nodes():
    case = rod()
    (key,) = set(kept_keys(case).values())
    body = kept_body(key)
    node = body.surfaces["foot"].nodes[3]
    found = shape_at(key, body.arms[node])
    np.testing.assert_allclose(found, body.shapes[node], atol=1e-12 * np.abs(found).max())
    # the axial mode is sin(pi x / L) from the middle: between nodes as at them, by linear parts
    along = np.abs(shape_at(key, np.array([LENGTH / 2, 0, 0]))[0])
    axial = int(np.flatnonzero(along > 0.5 * np.sqrt(2 / MASS))[0])
    for x in (0.33, 0.47, 0.98):
        end = shape_at(key, np.array([LENGTH / 2, 0, 0]))[0, axial]
        between = shape_at(key, np.array([x, 0.03, -0.07]))[0, axial]
        assert between == pytest.approx(end * np.sin(np.pi * x / LENGTH), rel=0.02)


def test_a_rigid_body_and_the_rigid_engine_have_no_shapes():
    for tables in (
        dict(bodies=dict(rod=dict(rigid=True))),
        dict(integration=dict(engine="rigid", n_modes=0)),
    ):
        (link,) = structure_model(rod(**tables)).links
        assert link.shape_a is None or link.shape_a.shape[1] == 0
