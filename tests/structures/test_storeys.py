"""A building on a free slab: fixed-base periods, free modes, Rayleigh damping."""

import numpy as np
import pytest
from small_structures import structure

from fecolumn.case.bodies import Storeys
from fecolumn.engines.dynamics.history import read_history
from fecolumn.simulation import run
from fecolumn.structures.storeys import building_of
from fecolumn.structures.structure import structure_model

KEYS = dict(
    kind="storeys",
    length_m=6.0,
    width_m=4.0,
    thickness_m=0.5,
    floors=3,
    floor_masses_kg=[5e4],
    storey_heights_m=[3.0],
    period_s=0.3,
)


# A slab that the floors do not move
HEAVY = dict(mass_kg=1e6, floor_masses_kg=[0.1])


def _model(**keys):
    case = structure(
        bodies=dict(building=KEYS | dict(mass_kg=5e4, youngs_modulus_pa=30e9) | keys),
        joints=dict(foot=dict(between=["building", "ground"])),
    )
    return structure_model(case).parts[0]


@pytest.mark.parametrize("profile", ["uniform", "triangular", "shear", "flexural"])
def test_building_has_its_period_on_a_fixed_slab(profile):
    building = building_of(Storeys(**KEYS | dict(profile=profile)))
    assert building.fixed(0)[0] == pytest.approx(2 * np.pi / 0.3, rel=1e-12)


def test_triangular_building_moves_in_a_triangle():
    """On a slab that is too heavy to move, the drifts of all storeys are alike in the first
    mode.
    """
    model = _model(profile="triangular", **HEAVY).model
    assert model.frequencies[:2] == pytest.approx([2 * np.pi / 0.3] * 2, rel=1e-4)
    drifts = np.linalg.norm(model.storeys.drifts[:, :, 0], axis=1)
    assert drifts == pytest.approx(np.full(3, drifts[0]), rel=1e-4)


def test_free_modes_have_neither_momentum_nor_spin():
    part = _model()
    model, floors = part.model, [f"floor {k}" for k in (1, 2, 3)]
    at_floors = np.array([model.marks[name][1] for name in floors])
    foot = model.surfaces["foot"].nodes
    slab_turn = [
        np.linalg.lstsq(
            np.concatenate(
                [
                    np.concatenate([np.eye(3), -np.cross(np.eye(3), arm).T.T], axis=1)
                    for arm in model.arms[foot]
                ]
            ),
            model.shapes[foot, :, m].ravel(),
            rcond=None,
        )[0]
        for m in range(6)
    ]
    slab_arm = np.array([0.0, 0.0, 0.25]) - model.center
    for m, motion in enumerate(slab_turn):
        slab = motion[:3] + np.cross(motion[3:], slab_arm)
        momentum = 5e4 * (slab + at_floors[:, :, m].sum(axis=0))
        assert np.abs(momentum).max() < 1e-9 * 5e4 * np.abs(at_floors[:, :, m]).max()


def test_one_floor_on_an_equal_slab_is_two_masses_on_a_spring_that_may_turn():
    """A slab so wide that it does not turn: w^2 = k (1 / m1 + 1 / m2)."""
    model = _model(
        floors=1,
        length_m=1000.0,
        width_m=1000.0,
        period_s=None,
        stiffness_x_n_m=[1e8],
        stiffness_y_n_m=[2e8],
        mass_kg=2e4,
    ).model
    assert model.frequencies**2 == pytest.approx(
        np.array([1e8, 2e8]) * (1 / 2e4 + 1 / 5e4), rel=1e-3
    )


def test_rayleigh_damping_has_its_ratio_in_the_two_modes():
    part = _model(damping="rayleigh", damping_ratio=0.05, **HEAVY)
    assert part.damping_ratio[:4] == pytest.approx(np.full(4, 0.05), rel=1e-3) and np.all(
        part.damping_ratio[4:] > 0.05
    )
    assert _model(damping="modal", damping_ratio=0.05).damping_ratio == 0.05
    assert _model(
        floors=1, damping="rayleigh", damping_ratio=0.05, **HEAVY
    ).damping_ratio == pytest.approx(np.full(2, 0.05), rel=1e-3)


def test_a_building_of_one_floor_that_stands_sways_with_its_damping(tmp_path):
    """Its floor is twice as heavy as its slab; its foot stays, and is said to."""
    rows = "".join(f"{0.01 * k:.2f},{1.0 if k <= 20 else 0.0}\n" for k in range(220))
    (tmp_path / "push.csv").write_text("time [s],ax [m/s2]\n" + rows)
    building = KEYS | dict(floors=1, floor_masses_kg=[2e4], period_s=0.4)
    case = structure(
        bodies=dict(building=building | dict(mass_kg=1e4, damping_ratio=0.05)),
        joints=dict(foot=dict(between=["building", "ground"], friction_coefficient=10.0)),
        motion=dict(source=str(tmp_path / "push.csv"), resample_s=0.01, free_vibration_s=0.0),
        integration=dict(engine="reduced", dt_s=1e-3, duration_s=0.0),
    )
    summary = run(case, tmp_path / "out", quiet=True)
    history = read_history(tmp_path / "out" / "history.h5")
    drift = history["storey/building 1/drift"][300:, 0]
    peaks = np.flatnonzero((drift[1:-1] > drift[:-2]) & (drift[1:-1] > drift[2:])) + 1
    decrement = np.log(drift[peaks[0]] / drift[peaks[3]]) / 3
    assert decrement / (2 * np.pi) == pytest.approx(0.05, rel=0.03)
    assert np.diff(peaks).mean() == pytest.approx(400, rel=0.02)
    # the frame of the slab sways with the floor by millimetres, its foot does not
    foot = summary["interfaces"]["foot: building on ground"]
    assert np.abs(history["body/building/displacement"][:, 0]).max() > 1e-3
    assert max(foot["slide_max_m"], foot["residual_slide_m"], foot["tilt_max_rad"]) < 2e-5


def test_shear_of_a_storey_is_the_inertia_above_it():
    """In a free mode the storey above which a mass m moves carries w^2 m times its motion."""
    model = _model().model
    top = model.marks["top"][1]
    shear = model.storeys.stiffness[2][:, None] * model.storeys.drifts[2]
    assert shear == pytest.approx(
        5e4 * model.frequencies**2 * top[:2], rel=1e-6, abs=1e-6 * np.abs(shear).max()
    )
