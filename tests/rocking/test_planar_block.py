"""The planar block, free and held, against closed forms, energy and a solver of another kind."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from fecolumn.case.model_sections import BlockModel
from fecolumn.case.sections import GRAVITY
from fecolumn.engines.rocking.block import RockingBlock
from fecolumn.engines.rocking.impact import (
    body_restitution,
    housner_restitution,
    rectangular_restitution,
)
from fecolumn.foundation.schema import InputError
from fecolumn.motions.pulses import Pulse, sample
from fecolumn.motions.record import GroundMotion

TALL = dict(width_m=0.4, height_m=1.2, density_kg_m3=2700.0)


def block(**keys):
    return RockingBlock.of_section(BlockModel(**{**TALL, **keys}), "block.toml")


def still(duration, dt=1e-3):
    return GroundMotion(np.zeros((round(duration / dt) + 1, 3)), dt, "still", "made up")


def shaken(seed=1, peak=5.0, duration=6.0, dt=2e-3):
    """Three components of smooth noise that rock the marble block."""
    rng, n = np.random.default_rng(seed), round(duration / dt)
    window = np.hanning(40) / np.hanning(40).sum()
    noise = np.column_stack([np.convolve(rng.normal(size=n), window, "same") for _ in range(3)])
    return GroundMotion(
        noise * [peak, peak, peak / 3] / np.abs(noise).max(axis=0), dt, "noise", "made up"
    )


HELD = [
    dict(),
    dict(spring_n_m=2e4),
    dict(bed_n_m2=3e4, bed_from_m=0.2),
    dict(tendon_n_m=4e5, tendon_prestress_n=2e3),
    dict(roof_mass_kg=120.0, roof_eccentricity_m=0.1),
    dict(roof_thrust_n=200.0),
    dict(sides=1),
    dict(restitution=0.8),
    dict(
        spring_n_m=1e4,
        tendon_n_m=1e5,
        roof_mass_kg=60.0,
        roof_eccentricity_m=-0.15,
        roof_thrust_n=-100.0,
    ),
]


@pytest.mark.parametrize("keys", HELD, ids=str)
def test_energy_of_every_block_closes_under_three_components(keys):
    found = block(**keys).respond(shaken(), free_s=1.0)
    assert len(found.impact_times) > 2
    moved = found.energy["kinetic"].max()
    assert np.abs(found.energy["closure"]).max() < 1e-7 * moved
    assert (np.diff(found.energy["impact"]) <= 1e-9 * moved).all()


def test_density_of_a_free_block_changes_no_motion():
    light, heavy = (block(density_kg_m3=rho).respond(shaken()) for rho in (500.0, 8000.0))
    assert light.tilt == pytest.approx(heavy.tilt, abs=1e-12)


@pytest.mark.parametrize("alpha, radius", [(0.1, 0.5), (0.3, 2.0)])
def test_slenderness_and_half_diagonal_make_the_block_of_that_width_and_height(alpha, radius):
    found = RockingBlock.of_section(
        BlockModel(slenderness_rad=alpha, half_diagonal_m=radius), "block.toml"
    ).describe()
    assert found["slenderness alpha"][0] == pytest.approx(alpha) and found["R"][0] == pytest.approx(
        radius
    )
    assert found["frequency parameter p"][0] == pytest.approx(math.sqrt(3 * GRAVITY / (4 * radius)))
    assert found["restitution of the angular velocity"][0] == pytest.approx(
        housner_restitution(alpha)
    )
    assert found["uplift at"][0] == pytest.approx(math.tan(alpha))


@pytest.mark.parametrize("keys", HELD, ids=str)
def test_restoring_moment_is_the_slope_of_the_potential(keys):
    plane = block(**keys).planes[0]
    for side in (1, -1):
        for lean in (0.05, 0.2, 0.6):
            work = quad(
                lambda phi, side=side: float(plane.restoring(phi, side)), 0, lean, epsabs=1e-9
            )[0]
            assert sum(plane.potential(lean, side)) == pytest.approx(work, rel=1e-9)


def test_spring_bed_and_tendon_hold_with_the_force_of_their_stretch():
    """Virtual work, dU = F du, with the lengths drawn from the geometry by hand."""
    b, h, lean, d = 0.2, 1.2, 0.3, 1e-6

    def at(phi, inside, up):  # displacement of a point, edge at the origin, body leaning over it
        return inside - inside * math.cos(phi) + up * math.sin(phi), inside * math.sin(
            phi
        ) + up * math.cos(phi) - up

    def energy(phi):
        top = at(phi, b, h)[0]
        gap = math.hypot(*at(phi, b, 0.0))
        bed = quad(lambda y: 0.5 * 3e4 * at(phi, b, y)[0] ** 2, 0.2, h)[0]
        return 0.5 * 2e4 * top**2 + bed + 0.5 * 4e5 * gap**2 + 2e3 * gap - 200.0 * top

    free, held = (
        block(),
        block(
            spring_n_m=2e4,
            bed_n_m2=3e4,
            bed_from_m=0.2,
            tendon_n_m=4e5,
            tendon_prestress_n=2e3,
            roof_thrust_n=200.0,
        ),
    )
    moment = [float(one.planes[0].restoring(lean, 1)) for one in (free, held)]
    assert moment[1] - moment[0] == pytest.approx(
        (energy(lean + d) - energy(lean - d)) / (2 * d), rel=1e-7
    )


def test_roof_mass_on_the_axis_raises_the_centre_and_adds_its_inertia():
    """Eqs 5 and 6 of the masonry review, halves there: h_Gc = (m + 2 m_r) h/(m + m_r), I_0c = 4/3 m
    R^2 + m_r R_r^2.
    """
    plane, m, roof = block(roof_mass_kg=500.0).planes[0], 2700 * 0.48, 500.0
    assert plane.height == pytest.approx((m + 2 * roof) * 0.6 / (m + roof))
    assert plane.inertia[0] == pytest.approx(
        4 / 3 * m * (0.2**2 + 0.6**2) + roof * (0.2**2 + 1.2**2)
    )


def test_eccentric_roof_makes_the_block_fall_to_its_side_and_other_impacts():
    plane = block(roof_mass_kg=500.0, roof_eccentricity_m=0.15).planes[0]
    assert plane.edges[0] < plane.edges[1] and plane.uplift(1) < plane.uplift(-1)
    mirrored = block(roof_mass_kg=500.0, roof_eccentricity_m=-0.15)
    motion = shaken(3)
    one = RockingBlock((plane,)).respond(motion)
    other = mirrored.respond(GroundMotion(motion.acceleration * [-1, 1, 1], motion.dt, "", ""))
    assert one.coordinates["theta_x"] == pytest.approx(-other.coordinates["theta_x"], abs=1e-9)


@pytest.mark.parametrize("mu, printed", [(1, 0.25), (2, 0.70), (4, 0.91), (8, 0.98)])
def test_restitution_of_lipscombe_and_pellegrinos_blocks(mu, printed):
    assert rectangular_restitution(mu) == pytest.approx(printed, abs=0.006)
    assert rectangular_restitution(mu) == pytest.approx(housner_restitution(math.atan(1 / mu)))
    assert body_restitution(1.0, (1 + mu**2) / 3, (-1, mu), (1, mu)) == pytest.approx(
        rectangular_restitution(mu)
    )


def test_block_stops_at_its_first_impact_where_it_is_squat():
    assert housner_restitution(math.asin(math.sqrt(2 / 3)) + 1e-9) == 0.0
    squat = block(width_m=3.0, height_m=1.0).respond(still(6.0), tilt=0.3)
    assert len(squat.impact_times) == 1 and squat.tilt[-1] == 0.0


def test_vertical_acceleration_changes_what_gravity_restores():
    """Free fall of the ground leaves no restoring moment: a tilted block stays as it is."""
    ground = np.zeros((500, 3))
    ground[:, 2] = -GRAVITY
    floating = block().respond(GroundMotion(ground, 1e-3, "", ""), tilt=0.1)
    assert floating.tilt == pytest.approx(np.full(500, 0.1), abs=1e-9)


def test_vertical_acceleration_lowers_the_uplift():
    along = np.linspace(0, 2 * GRAVITY / 3, 2001)
    for vertical in (-0.3, 0.0, 0.3):
        ground = np.column_stack([along, 0 * along, 0 * along + vertical * GRAVITY])
        found = block().respond(GroundMotion(ground, 1e-3, "", ""))
        assert along[np.argmax(found.tilt > 0) - 1] == pytest.approx(
            (1 + vertical) * GRAVITY / 3, abs=2 * (along[1] - along[0])
        )


def test_one_sided_block_leans_to_its_side_alone_and_rebounds():
    found = block(sides=1).respond(still(5.0), tilt=0.2)
    assert (found.coordinates["theta_x"] >= 0).all() and len(found.impact_times) > 3
    first = np.argmax(found.time > found.impact_times[0])
    lost = found.energy["impact"][first] / found.energy["gravity"][0]
    s2 = 0.4**2 / (0.4**2 + 1.2**2)  # of the slenderness: its sine squared
    kept = (1 - 1.5 * s2) ** 2 * (1.5 * (1 - s2) - 1)
    assert 1 + lost == pytest.approx(kept**2, rel=1e-6)


@pytest.mark.parametrize("roof, eccentricity", [(0.0, 0.0), (8000.0, 0.0), (4000.0, 0.2)])
def test_a_roof_takes_part_in_the_impacts_of_a_block_before_a_wall(roof, eccentricity):
    """The three impacts, each by the angular momentum of all points about where it lands."""
    keys = dict(width_m=0.6, height_m=3.0, roof_mass_kg=roof, roof_eccentricity_m=eccentricity)
    own = 2700.0 * 0.6 * 3.0
    masses = np.array([own, roof])
    places = np.array([[0.0, 1.5], [eccentricity, 3.0]])
    spins = np.array([own * (0.6**2 + 3.0**2) / 12, 0.0])

    def ratio(left, landed):
        a, b = places - left, places - landed
        kept = spins.sum() + masses @ (a * b).sum(axis=1)
        return kept / (spins.sum() + masses @ (b * b).sum(axis=1))

    lean, foot, top = np.array([[0.3, 0.0], [-0.3, 0.0], [-0.3, 3.0]])
    exact = ratio(lean, foot) * -ratio(foot, top) * ratio(foot, lean)
    model = block(sides=1, **keys)
    (plane,) = model.planes
    assert plane.restitution[0] == pytest.approx(exact, rel=1e-12) and 0.2 < exact < 0.4


def test_friction_is_demanded_as_the_rectangular_block_of_zhang_and_makris():
    """Eq. 24 of Makris' review, of a rectangular block, at every state of a motion."""
    model, motion = block(), shaken(5)
    found, plane = model.respond(motion), model.planes[0]
    alpha, p2 = plane.alpha[0], plane.p2[0]
    theta, ground = found.coordinates["theta_x"], motion.acceleration[:, 0] / GRAVITY
    motion = GroundMotion(motion.acceleration * [1, 0, 0], motion.dt, "", "")
    states = plane.respond(motion, 0.0, 0.0, 0.0)
    theta, rate = states.states[:, 1], states.states[:, 2]
    rocks = np.abs(theta) > 1e-3
    lever = alpha * np.sign(theta) - theta
    above = (
        ground * (5 - 3 * np.cos(2 * lever))
        - 3 * np.sin(2 * lever)
        + 6 * rate**2 / p2 * np.sin(lever)
    )
    below = (
        5
        - 3 * ground * np.sin(2 * lever)
        + 3 * np.cos(2 * lever)
        - 6 * rate**2 / p2 * np.cos(lever)
    )
    force = states.base_force(motion.acceleration[:, [0, 2]])
    assert rocks.sum() > 500
    assert (force[:, 0] / force[:, 1])[rocks] == pytest.approx((above / below)[rocks], rel=1e-9)


def test_sliding_is_told_with_its_time_and_only_where_friction_does_not_suffice():
    motion = sample(Pulse("one_cosine", 0.5 * GRAVITY, 0.5), 1e-3, lead=0.5)
    # Eq. 17: friction demanded as a jump of acceleration sets the block to rocking
    alpha = math.atan2(0.4, 1.2)
    push = 0.75 * (0.5 / math.tan(alpha) - 1)
    needed = (0.5 - push * math.cos(alpha) * math.sin(alpha)) / (1 + push * math.sin(alpha) ** 2)
    assert 0.3 < needed < 0.5
    slides = block(friction_coefficient=0.9 * needed).respond(motion)
    assert (
        len(slides.notes) == 1
        and "from 0.50" in slides.notes[0]
        and f"there is {0.9 * needed:g}" in slides.notes[0]
    )
    assert not block(friction_coefficient=5.0).respond(motion).notes
    assert slides.peaks["friction_demanded_x"] > needed * (1 - 1e-2)


def test_no_friction_is_told_of_a_block_that_leaves_the_ground():
    """Thrown up by the ground: what is written of it are numbers."""
    one = block()
    states = one.respond(sample(Pulse("one_sine", 0.5 * GRAVITY, 0.5), 1e-3))
    assert all(math.isfinite(value) for value in states.peaks.values())
    up = np.zeros((400, 3))
    up[100:200, 2] = -2.0 * GRAVITY
    up[:200, 0] = 0.6 * GRAVITY
    thrown = one.respond(GroundMotion(up, 1e-3, "thrown", "made"))
    assert "leave the ground" in thrown.notes[0]
    assert "friction_demanded_x" not in thrown.peaks


def test_overturned_block_ends_flat_with_its_rows():
    found = block().respond(sample(Pulse("one_sine", 1.5 * GRAVITY, 1.5), 2e-3))
    assert found.overturned and found.outcome(1.0) == "overturned"
    assert found.tilt[-1] > math.pi / 2 - 1e-9 and found.time[-1] < 6.0
    assert len(found.time) == len(found.tilt) == len(found.u_top) == len(found.energy["kinetic"])


def test_block_with_a_depth_rocks_in_both_planes_as_if_alone():
    motion = shaken(2)
    both = block(depth_m=0.5).respond(motion)
    alone = block().respond(GroundMotion(motion.acceleration * [1, 0, 1], motion.dt, "", ""))
    across = block(width_m=0.5).respond(
        GroundMotion(motion.acceleration[:, [1, 0, 2]] * [1, 0, 1], motion.dt, "", "")
    )
    assert both.coordinates["theta_x"] == pytest.approx(alone.coordinates["theta_x"], abs=1e-12)
    assert both.coordinates["theta_y"] == pytest.approx(across.coordinates["theta_x"], abs=1e-12)
    assert both.tilt == pytest.approx(np.hypot(alone.tilt, across.tilt))


@pytest.mark.parametrize(
    "keys, said",
    [
        (dict(width_m=None), "state block.width_m and block.height_m, or"),
        (dict(slenderness_rad=0.2), "state block.width_m and"),
        (
            dict(spring_n_m=1.0, spring_height_m=2.0),
            "block.spring_height_m = 2.0: must be at most 1.2 m",
        ),
        (dict(roof_mass_kg=1.0, roof_eccentricity_m=0.3), "must lie on the top, within 0.2 m"),
        (dict(roof_thrust_n=1e5), "overturns the block by itself towards +x"),
        (dict(sides=1, depth_m=1.0), "must be left out where block.sides = 1"),
    ],
)
def test_impossible_block_is_refused_with_file_key_and_range(keys, said):
    with pytest.raises(InputError) as told:
        block(**keys)
    assert said in str(told.value) and "block.toml" in str(told.value)
