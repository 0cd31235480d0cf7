"""Bases without edges, in the rigid engine: a pad of springs and dashpots against closed forms, and
a flat on which a column slides far.
"""

import numpy as np
import pytest

from fecolumn.case.sections import GRAVITY, Initial
from fecolumn.engines.dynamics.gravity import begin as begin_state
from fecolumn.engines.dynamics.gravity import standing
from fecolumn.verification.models import column_system
from fecolumn.verification.reduced_trial import begin_trial

# a stout steel tube with 24 bricks around and two through the wall
STOUT = dict(
    column={"outer_diameter_m": 0.2, "wall_m": 0.04, "height_m": 0.4, "fine_height_m": 0.0},
    cap=False,
    mesh={"fine_size_m": 0.02, "coarse_size_m": 0.025, "base_size_m": 0.05},
)
SUBGRADE = 5e7
# of the ring, not of the polygon drawn [m2]
AREA = np.pi * (0.1**2 - 0.06**2)


def system_of(base, **tables):
    return column_system("rigid", **STOUT | {"base": base} | tables)


def pad(**keys):
    return {"kind": "pad", "stiffness_n_m3": SUBGRADE} | keys


def spring_areas(system):
    """Areas (n,) [m2] of the springs of a pad of SUBGRADE."""
    return system.model.joints[0].pad.stiffness[:, 2] / SUBGRADE


def moved(velocity):
    """A standing column of which every node gets velocity(positions) [m/s] at once."""

    def start(system):
        state = standing(system)
        state.v = velocity(state.x)
        return state

    return start


def turning(spin):
    """Rotation about the y axis through the foot's middle [rad/s]."""
    return moved(lambda x: np.cross([0.0, spin, 0.0], x))


@pytest.fixture(scope="module")
def on_pad():
    return system_of(pad(damping_ratio=0.05), integration={"dt_s": 5e-4})


@pytest.mark.long
@pytest.mark.parametrize("times", [3.0, 300.0])
def test_column_stands_on_any_pad_that_holds_it_upright(on_pad, times):
    upright = (
        on_pad.weight
        * on_pad.body.center[2]
        / (spring_areas(on_pad) @ on_pad.interface.reference[:, 0] ** 2)
    )
    soft = system_of(pad(stiffness_n_m3=times * upright))
    state = standing(soft)
    assert state.contact["indentation"][:, 2] == pytest.approx(
        soft.weight / (times * upright * AREA), rel=1e-4
    )


def rocking_of(system):
    """Stiffness I k [N m] of the whole foot, angular frequency [rad/s] and inertia about the foot's
    middle [kg m2] of a column that rocks on a pad.
    """
    interface, column = system.interface, system.body
    stiffness = float(system.model.joints[0].pad.stiffness[:, 2] @ interface.reference[:, 0] ** 2)
    inertia = float(column.node_mass @ (column.X[:, 0] ** 2 + column.X[:, 2] ** 2))
    return stiffness, np.sqrt((stiffness - system.weight * column.center[2]) / inertia), inertia


def test_column_settles_by_its_weight_over_the_subgrade(on_pad):
    assert spring_areas(on_pad).sum() == pytest.approx(AREA)
    state = begin_trial("rigid", on_pad).state
    assert state.contact["indentation"][:, 2] == pytest.approx(
        on_pad.weight / (SUBGRADE * AREA), rel=1e-4
    )
    assert (state.forces[:, 2] > 0).all()


def test_column_bounces_on_its_pad_as_a_damped_oscillator(on_pad):
    """m z'' + c z' + k A z = 0 with the damping ratio of the case, released with 5 mm/s down: z =
    -(v / w_d) exp(-D w t) sin(w_d t).
    """
    trial = begin_trial("rigid", on_pad, moved(lambda x: np.tile([0.0, 0.0, -0.005], (len(x), 1))))
    w = np.sqrt(on_pad.model.joints[0].pad.stiffness[:, 2].sum() / on_pad.body.total_mass)
    damped, times = w * np.sqrt(1 - 0.05**2), 5e-4 * np.arange(1, round(3 * 2 * np.pi / w / 5e-4))
    still = trial.top()[2]
    found = np.array([trial.step() and trial.top()[2] for _ in times]) - still
    exact = -0.005 / damped * np.exp(-0.05 * w * times) * np.sin(damped * times)
    # the step's error in period is (w dt)^2 / 12, 1e-4 a period
    assert np.abs(found - exact).max() < 5e-3 * np.abs(exact).max()
    energy = trial.energy()
    assert energy["damping"] < -0.4 * 0.5 * on_pad.body.total_mass * 0.005**2
    # what the foot's own flexibility loses, 1e-4 of the pad's
    assert abs(energy["contact"]) < 1e-4 * abs(energy["damping"])
    assert abs(energy["closure"]) < 1e-8 * abs(energy["damping"])


def test_rigid_column_on_springs_has_the_frequency_of_its_whole_foot_and_lifts_at_its_moment():
    """Stiff along, undamped: it turns about the foot's middle, I_O q'' + (k I_f - m g h) q = 0,
    until k q R = W / A lifts the rim.
    """
    system = system_of(
        pad(shear_stiffness_n_m3=40 * SUBGRADE),
        integration={"dt_s": 5e-4},
        contact={"friction_coefficient": 5.0},
    )
    stiffness, w, _ = rocking_of(system)
    edge = np.abs(system.interface.reference[:, 0]).max()
    exact = SUBGRADE * np.pi / 4 * (0.1**4 - 0.06**4)
    assert stiffness == pytest.approx(exact, rel=0.003)
    uplift = system.weight / (SUBGRADE * AREA * edge)
    times = 5e-4 * np.arange(1, round(2 * np.pi / w / 5e-4))
    for share, lifts in ((0.97, False), (1.06, True)):
        trial, tilts, least = begin_trial("rigid", system, turning(share * uplift * w)), [], np.inf
        for _ in times:
            state = trial.step()
            tilts.append(state.rotation[0, 0, 2])
            least = min(least, (state.forces[:, 2] > 0).sum())
        assert (least < len(state.forces)) == lifts
        if not lifts:
            assert np.abs(tilts - share * uplift * np.sin(w * times)).max() < 0.03 * uplift
        assert abs(trial.energy()["closure"]) < 1e-8 * trial.start.x[:, 2].max()


def test_column_that_rocks_off_half_its_pad_loses_to_its_dashpots_alone(on_pad):
    trial = begin_trial("rigid", on_pad, turning(1.2))
    lost, moves, least = [0.0], trial.energy()["kinetic"], np.inf
    for _ in range(300):
        least = min(least, (trial.step().forces[:, 2] > 0).sum())
        lost.append(trial.energy()["damping"])
    energy = trial.energy()
    assert least < len(trial.state.forces) / 2
    assert np.diff(lost).max() <= 1e-12 * moves and lost[-1] < -0.02 * moves
    assert (
        energy["impact"] == 0
        and abs(energy["contact"]) < 1e-2 * abs(lost[-1])
        and abs(energy["closure"]) < 1e-8 * moves
    )


def test_flat_without_edges_is_the_plate_near_its_middle():
    """Layer and plate differ by the plate's edges only, here by 1e-3 of micrometres of
    settlement.
    """
    ground = np.array(
        [[8.0 * np.sin(40 * 1e-3 * k), 3.0 * np.sin(55 * 1e-3 * k), 0.0] for k in range(1, 61)]
    )
    paths = []
    for base in (
        {"length_m": 0.4, "width_m": 0.4, "slide_allowance_m": 0.06},
        {"kind": "unbounded"},
    ):
        trial = begin_trial("rigid", system_of(base, integration={"dt_s": 1e-3}))
        for one in ground:
            trial.step(one)
        paths.append(trial.top())
    assert np.linalg.norm(paths[0]) > 1e-3
    np.testing.assert_allclose(paths[1], paths[0], atol=1e-4 * np.linalg.norm(paths[0]))


def test_column_slides_over_a_flat_without_edges_as_newmark_has_it():
    """0.6 m/s against mu g = 0.05 g stop after v^2 / (2 mu g) = 0.367 m, beyond any plate of the
    case's.
    """
    system = system_of(
        {"kind": "unbounded"}, contact={"friction_coefficient": 0.05}, integration={"dt_s": 4e-3}
    )
    trial = begin_trial(
        "rigid", system, lambda system: begin_state(system, Initial(velocity_m_s=(0.6, 0.0, 0.0)))
    )
    start = trial.state.anchors.mean(axis=0)
    stop = 0.6 / (0.05 * GRAVITY)
    for _ in range(round(1.1 * stop / 4e-3)):
        trial.step()
    slide = trial.state.anchors.mean(axis=0) - start
    assert slide == pytest.approx([0.6**2 / (2 * 0.05 * GRAVITY), 0.0], rel=2e-3, abs=1e-6)
    energy = trial.energy()
    assert energy["friction"] == pytest.approx(-0.5 * system.body.total_mass * 0.6**2, rel=2e-3)
    assert abs(energy["closure"]) < 1e-9 * abs(energy["friction"])
